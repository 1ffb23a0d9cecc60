// A run as a live page: one HTML file that shows it, and computes it anew in the browser.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "app/picture/replay.h"
#include "app/support/language.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Of one run on the reader's machine, s: scenes that take longer are replayed only.
inline constexpr double k_most_live = 3;
/// How many times slower a browser is taken to be than this program on one thread.
inline constexpr double k_browser_factor = 3;

/// Why a page cannot be live; empty word: it can. `seconds`: of a run in a browser.
struct ReplayOnly {
  std::string_view word;  ///< "replay_only", "replay_edits", "replay_static": of page_words.h
  double seconds = 0;
};
/// wall: of the run on this machine, s; absent: not known.
ReplayOnly why_replay_only(const io::Scene& scene, const io::Recording& recording,
                           std::optional<double> wall);

/// False when this program was built without emscripten, which no page can do without.
bool can_make_pages();
/// Throws BadInput then; `option` asks for a page.
void require_pages(const std::string& option);

/// The page. Scene, records and rows (page_stride()) are within; texts of the scene are escaped. Without
/// OpenGL it has no still pictures. Empty when `proceed` gave it up. Throws io::InputError when no row can be
/// shown.
std::string page_of(const io::Scene& scene, const io::Recording& recording, Language language,
                    const std::function<bool()>& proceed);

}  // namespace topple::app
