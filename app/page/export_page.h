// A run as a live page: one HTML file that shows it, and computes it anew in the browser.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "app/support/language.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Of one run on the reader's machine, s: scenes that take longer are replayed only.
inline constexpr double k_most_live = 3;
/// How many times slower a browser is taken to be than this program on one thread.
inline constexpr double k_browser_factor = 3;

/// A run as a page takes it.
struct PageRun {
  std::size_t rows = 0;
  std::function<io::FrameRow(std::size_t)> row = {};               ///< throws io::InputError
  std::function<Parameters(const io::FrameRow&)> parameters = {};  ///< with which a row came about
  std::string summary = {};                                        ///< JSON; empty: there is none
  bool edited = false;                                             ///< parameters were changed while it ran
};

/// The newest branch of a recording. Both must outlive it.
PageRun page_run(const io::Scene& scene, const io::Recording& recording);

/// Why a page cannot be live; empty word: it can. `seconds`: of a run in a browser.
struct ReplayOnly {
  std::string_view
      word;  ///< "replay_only", "replay_stress", "replay_edits", "replay_static": of page_words.h
  double seconds = 0;
};
ReplayOnly why_replay_only(const io::Scene& scene, const PageRun& run);
/// A sentence; empty where the page is live.
std::string in_words(const ReplayOnly& only, Language language);

/// False when this program was built without emscripten, which no page can do without.
bool can_make_pages();
/// Throws BadInput then; `option` asks for a page.
void require_pages(const std::string& option);

/// The page. Scene, records and rows (page_stride()) are within; texts of the scene are escaped. Without
/// OpenGL it has no still pictures. Empty when `proceed` gave it up. Throws io::InputError when no row can be
/// shown.
std::string page_of(const io::Scene& scene, const PageRun& run, Language language,
                    const std::function<bool()>& proceed);

/// The page within another document: HTML of a frame over its whole width. height: px.
std::string in_frame(const std::string& page, const std::string& title, int height);

}  // namespace topple::app
