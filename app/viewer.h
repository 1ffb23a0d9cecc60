// The window's content: the scene in the middle, the panels around it, mouse and keyboard. It knows neither
// the window nor where its pictures go, so that tests drive it off screen.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "app/panels.h"
#include "app/player.h"
#include "render/font.h"
#include "render/key_press.h"
#include "render/orbit.h"
#include "render/stage.h"

namespace topple::app {

class Viewer {
 public:
  /// Adds its letters to the atlas of the current Dear ImGui context and uploads them. `scale`: of letters
  /// and panels, 1 for 720 lines. Throws std::runtime_error without the font.
  Viewer(Player& player, render::Stage& stage, float scale, render::NamedView view = render::NamedView::iso);

  /// Takes in what is new. True when there is something to draw that was not drawn before.
  bool update(double wall_s);
  /// Does what the key is for.
  void press(const render::KeyPress& press);
  /// Builds one Dear ImGui frame, from NewFrame (which the caller has called) to Render, and draws the scene
  /// when it changed.
  void build();
  /// Where things lie, for Stage::present.
  render::Surface surface() const;

  bool wants_to_close() const { return wants_to_close_; }
  /// Regions in Dear ImGui's coordinates.
  const Box& scene_box() const { return scene_; }
  const Box& timeline_box() const { return timeline_; }
  std::optional<std::size_t> picked_member() const { return picked_; }
  /// How long a frame took, ms, for the status line.
  void report_frame_time(double ms);

 private:
  struct KeyAction;
  static std::span<const KeyAction> key_actions();
  void let_go();
  void lay_out();
  void handle_characters();
  void handle_mouse();
  void look(render::NamedView view);
  void move_camera(double wall_s);
  void draw_scene();
  void draw_words(const io::FrameRow& row);
  void draw_side_panel(const std::optional<io::FrameRow>& row);
  void draw_status();
  void draw_key_table();
  float aspect() const { return scene_.width / scene_.height; }

  Player& player_;
  render::Stage& stage_;
  const float scale_;
  render::OverlayFonts fonts_;
  Bridge bridge_;
  Box scene_, timeline_, transport_, side_, status_;
  render::SceneFrame frame_;
  std::optional<io::FrameRow> row_;
  render::Orbit orbit_, from_, to_;
  double flight_ = 1;  // of the camera from one place to the other, 0..1
  bool fitted_ = false;
  render::NamedView view_;
  std::optional<std::size_t> picked_;
  bool scene_changed_ = true, camera_changed_ = true;
  bool drawn_still_ = false;  // the scene kept is one of best quality
  double quiet_ = 0;          // s since the scene last changed
  bool dragging_ = false, dragged_ = false;
  bool wants_to_close_ = false;
  bool keys_shown_ = false, ghost_shown_ = true;
  std::string refused_;
  double frame_ms_ = 0;
};

}  // namespace topple::app
