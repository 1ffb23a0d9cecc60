// What the window opens: scenes, recordings, accelerograms. And where the program keeps things for its user.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "app/live/live_run.h"
#include "app/support/language.h"

namespace topple::app {

struct ViewOptions {
  std::string source;                  ///< scene or recording; empty: a person chooses
  std::vector<std::string> overrides;  ///< of a scene
  std::string recording;               ///< where a live run is recorded; empty: in the user's state folder
  std::optional<Language> language;    ///< absent: as kept, or that of the locale
  bool force = false;                  ///< in place of files of any kind
};

/// "~/.local/state/topple" or what XDG_STATE_HOME says, created; empty when there is no place for it.
std::string state_folder();
/// "~/.cache/topple" or what XDG_CACHE_HOME says, likewise.
std::string cache_folder();

/// Reads a scene or a recording. Where no file is named for it, a run is recorded in state_folder(); without
/// one, nowhere. `program` as of open_foreign_recording. Throws io::InputError, BadInput.
LiveSource open_source(const ViewOptions& options, const std::string& program = "/proc/self/exe");

/// `present` with accelerograms as the record of its first shake. Throws io::InputError.
LiveSource open_records(const io::Scene& present, const std::vector<std::string>& files);

/// A run of this scene, recorded in state_folder().
LiveSource open_room(io::Scene scene);

/// Files that were opened last, the latest first, at most k_most_recent.
inline constexpr std::size_t k_most_recent = 12;
std::vector<std::string> recent_files();
/// Puts a file in front of them; what cannot be written is not remembered.
void remember_recent(const std::string& path);

/// Something being opened on a thread of its own, which is left to itself when nobody wants it any more.
class Opening {
 public:
  /// `wake` is called from the thread when it is done.
  Opening(std::string what, std::function<LiveSource()> open, std::function<void()> wake);

  const std::string& what() const { return what_; }
  bool done() const { return source_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  /// Once, when done. Throws what the opening threw.
  LiveSource take() { return source_.get(); }

 private:
  std::string what_;
  std::future<LiveSource> source_;
};

}  // namespace topple::app
