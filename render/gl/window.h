// The desktop window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/gl/context.h"
#include "render/gl/key_press.h"

namespace topple::render {

struct Size {
  int width = 0;
  int height = 0;
};

/// A window with a 3.3 core context, current on the thread that made it. It waits for the screen's
/// refresh when it swaps. All calls but wake() belong on the main thread. One at a time in a process,
/// and none together with an OSMesa context: both share Mesa's dispatch state.
class Window : public Context {
 public:
  /// width, height: in the units of the desktop, where a high-resolution screen has several pixels to
  /// one. Throws std::runtime_error, in one line, without a display or a context that will do.
  explicit Window(const std::string& title, int width = 1280, int height = 720);
  ~Window() override;

  void make_current() override;
  GetProc get_proc() const override;

  /// In pixels.
  Size framebuffer_size() const;
  /// In units of the desktop: those of Dear ImGui's coordinates.
  Size size() const;
  /// How much larger than usual the desktop wants letters, 1 for most screens.
  float content_scale() const;
  /// Nothing of it can be seen.
  bool iconified() const;

  void set_title(const std::string& title);

  /// Fills the first screen, or goes back to where it was.
  void toggle_full_screen();

  /// The person, or close(), wants it closed.
  bool should_close() const;
  void close();

  /// Handles what has happened since.
  void poll_events();
  /// The same, but waits for something to happen, at most `seconds` (> 0).
  void wait_events(double seconds);
  /// Ends a waiting wait_events. Any thread may call it while the window lives.
  static void wake();

  /// True once after anything happened that may change what is to be shown: input, another size, a
  /// part uncovered; true at first. wake() does not count.
  bool take_input();

  /// Keys pressed since the last call, in order; of those held down arrows alone repeat. None is lost when a
  /// picture takes long.
  std::vector<KeyPress> take_keys();

  /// Paths of files dropped on the window since the last call.
  std::vector<std::string> take_drops();

  /// Shows what was drawn to framebuffer 0.
  void swap();

  /// Connects the current Dear ImGui context, which must outlive the window, to keyboard, mouse,
  /// clipboard, clock and size. Once.
  void connect_imgui();
  /// Before every ImGui::NewFrame.
  void new_imgui_frame();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace topple::render
