// The desktop app but for its window: what is open, and choosing, opening, saving and exporting around it.
// Tests drive it off screen.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/furnish/furnish_view.h"
#include "app/window/chooser.h"
#include "app/window/export_dialog.h"
#include "app/window/exports.h"
#include "app/window/file_dialog.h"
#include "app/window/message.h"
#include "app/window/opening.h"
#include "app/window/save_scene.h"
#include "app/window/session.h"

namespace topple::app {

class Shell {
 public:
  /// `scale` as of Viewer. `wake` ends the wait of an idle window; any thread calls it. `program` draws
  /// exports and reads recordings first. The others as of Viewer.
  Shell(render::Stage& stage, float scale, std::function<void()> wake, std::string program = "/proc/self/exe",
        const Appearance& appearance = {}, Viewer::Keep keep = {});
  ~Shell();
  Shell(const Shell&) = delete;
  Shell& operator=(const Shell&) = delete;

  /// Shows what was opened in place of what is open, whose recording is closed. `path`: the file; empty:
  /// none.
  void show(LiveSource source, const std::string& path);
  /// The same of a built-in scene or a file, read in the background; what is open stays until it is read.
  void open(const std::string& source);
  /// Files were dropped on the window: a scene or recording is opened, accelerograms shake a copy of the
  /// scene that is open.
  void drop(const std::vector<std::string>& paths);
  void choose_scene() { chooser_.open(); }
  /// Furnishes the room of what is open, whose run pauses, or one that was furnished since; or goes back to
  /// that run.
  void furnish();
  /// Furnishes a new room.
  void furnish_new_room();
  /// Runs the furnished room; the run before it stays as a ghost.
  void shake_room();

  /// As of Viewer.
  bool update(double wall_s);
  void press(const render::KeyPress& press);
  void build();
  render::Surface surface() const;
  void report_frame_time(double ms);
  bool wants_to_close() const { return wants_to_close_; }
  /// The window is to fill the screen, or no longer, since the last call.
  bool take_full_screen() { return std::exchange(full_screen_, false); }

  /// "topple: paper-a".
  std::string title() const;
  bool playing() const { return !furnishing_ && session_ && session_->player().playing(); }
  /// Closes everything as LiveRun::close does; the last in the list is what was open.
  std::vector<LiveStatus> close(const std::string& status);

  Session* session() { return session_.get(); }
  Chooser& chooser() { return chooser_; }
  SaveDialog& save_dialog() { return save_; }
  ExportDialog& export_dialog() { return export_; }
  Exports& exports() { return exports_; }
  FileDialog& file_dialog() { return files_; }
  const std::optional<Message>& message() const { return message_; }
  bool opening() const { return opening_.has_value(); }
  bool furnishing() const { return furnishing_; }
  /// The room that is or was furnished last; null: none.
  FurnishView* room() { return room_.get(); }

 private:
  bool covered() const;
  const render::OverlayFonts& fonts() const;
  void open_in_background(const std::string& what, const std::string& path, std::function<LiveSource()> read);
  bool finish_opening();
  void ask(ShellRequest request);
  void watch_trouble();
  void build_over();
  void build_room();
  float interface_scale() const;
  std::string text_of_session() const;
  void press_in_room(const render::KeyPress& press);
  void take_sliders();
  void keep_room();
  void draw_opening(const Box& window);
  void answer_message();
  void browse();
  void start_demo();

  render::Stage& stage_;
  const float scale_;
  const std::function<void()> wake_;
  const std::string program_;
  Appearance appearance_;
  std::optional<Appearance> applied_;  ///< as own_fonts_ are; none: a session's have replaced them
  const Viewer::Keep keep_;
  render::OverlayFonts own_fonts_;  ///< of a window without a session
  Chooser chooser_;
  FileDialog files_;
  Exports exports_;
  SaveDialog save_{files_};
  ExportDialog export_{exports_, files_};
  std::optional<Message> message_;
  std::optional<Opening> opening_;
  std::string opening_path_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<FurnishView> room_;
  bool furnishing_ = false;            ///< room_ is shown, not the session
  bool shaking_ = false;               ///< what is being opened is room_
  const io::Scene* shaken_ = nullptr;  ///< the session's that came of room_; null: it did not
  const io::Scene* before_ = nullptr;  ///< the session's of which room_ is a changed one; null: it is none
  std::string ran_;                    ///< the text of room_ as before_ runs it
  Parameters sliders_;                 ///< of before_ that room_ has taken
  std::optional<io::Scene> to_save_;   ///< room_ as it is saved
  std::string kept_room_;              ///< its text when it was written last
  std::vector<std::future<LiveStatus>> closing_;
  std::vector<LiveStatus> ended_;              ///< of those that have closed
  std::string shown_failure_, shown_trouble_;  ///< for which a message was shown
  struct WantedDemo {
    std::size_t which;  ///< of demos()
    bool opened;        ///< its scene
  };
  std::optional<WantedDemo> demo_;  ///< begins when its scene is there
  std::string before_demo_;         ///< what was open when a demo opened its scene; empty: nothing
  std::string scene_before_demo_;   ///< the name of its scene
  int frames_due_ = 0;
  std::array<bool, 5> over_{};  // what lay over the window at the last update: a dialog draws itself anew
  bool wants_to_close_ = false, full_screen_ = false;
};

}  // namespace topple::app
