// The window's content: the scene in the middle, the panels around it, mouse and keyboard. It knows neither
// the window nor where its pictures go, so that tests drive it off screen.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/live/player.h"
#include "app/panels/appearance.h"
#include "app/panels/panels.h"
#include "app/panels/precision_panel.h"
#include "app/panels/teaching_panel.h"
#include "app/picture/bridge.h"
#include "app/picture/solid_bodies.h"
#include "app/window/hand.h"
#include "render/gl/key_press.h"
#include "render/output/stage.h"
#include "render/scene/font.h"
#include "render/scene/orbit.h"
#include "render/scene/pick.h"

namespace topple::app {

/// A run that was left for one of another model, beside which it is drawn.
class EarlierRun {
 public:
  /// As the player shows it.
  EarlierRun(std::shared_ptr<const io::Scene> scene, const Player& player);
  /// "pale: the run before the room was changed", and what was changed while it ran.
  const std::string& in_words() const { return words_; }
  /// Its bodies at the time of `beside`, as ghosts on the floor of that; as long as it lasted.
  void add(const io::FrameRow& beside, const PictureSettings& settings, render::SceneFrame& out) const;
  /// Of the pieces that `model` has by the same names.
  GhostCurves curves(const Model& model) const;

 private:
  std::shared_ptr<const io::Scene> scene_;
  std::vector<RowPtr> way_;
  std::string words_;
  std::unique_ptr<const RunExtent> extent_;
  std::unique_ptr<const Bridge> bridge_;
};

class Viewer {
 public:
  /// What the side panel shows.
  enum class Tab { parameters, picture, inspect, teach };

  /// Keeps the appearance for the next start. May throw std::runtime_error.
  using Keep = std::function<void(const Appearance&)>;

  /// Adds its letters to the atlas of the current Dear ImGui context and uploads them. `scale`: of letters
  /// and panels, 1 for 720 lines, times that of `appearance`. `keep` is called when a person changes that.
  /// Throws std::runtime_error without the font.
  Viewer(Player& player, render::Stage& stage, float scale, render::NamedView view = render::NamedView::iso,
         const PictureSettings& settings = {}, const Appearance& appearance = {}, Keep keep = {});

  /// Shows it in the inspector; nothing: none.
  void inspect(const std::optional<Subject>& subject);

  void show(Tab tab) { tab_ = tab; }

  /// From the frame drawn last on the camera follows this body; nothing: it stays.
  void follow(const std::optional<std::size_t>& body);
  /// The body that the camera follows.
  std::optional<std::size_t> followed() const {
    return follows_ ? std::optional(follows_->body) : std::nullopt;
  }

  /// Begins a guided demo; the floor must be one that can_shake_as_sine. `came_from`, `scene`: as of
  /// TeachingState.
  void guide(std::size_t demo, const std::string& came_from = {}, const std::string& scene = {});

  /// Takes in what is new. True when there is something to draw that was not drawn before.
  bool update(double wall_s);
  /// Does what the key is for.
  void press(const render::KeyPress& press);
  /// Builds one Dear ImGui frame, from NewFrame (which the caller has called) to Render, and draws the scene
  /// when it changed. `over` builds what lies over it all; `covered`: that takes the
  /// keyboard.
  void build(const std::function<void()>& over = {}, bool covered = false);
  /// What is done with keyboard and mouse: the lines of F1's table. key 0: a line only; nothing shown:
  /// another key of the line above.
  struct KeyAction {
    Phrase shown, does;
    int key = 0;
    bool control = false, shift = false;
    void (*act)(Viewer&) = nullptr;
  };
  static std::span<const KeyAction> key_actions();

  /// Where things lie, for Stage::present.
  render::Surface surface() const;

  /// What the last frame's buttons asked for.
  ShellRequest asked() const { return asked_; }
  /// Regions in Dear ImGui's coordinates.
  const Box& scene_box() const { return scene_; }
  /// Width / height of the scene.
  float aspect() const { return scene_.width / scene_.height; }
  const Box& timeline_box() const { return timeline_; }
  const Box& path_box() const { return path_; }
  const TeachingState& teaching() const { return teaching_; }
  const PrecisionState& precision() const { return precision_; }
  const Appearance& appearance() const { return appearance_; }
  const render::OverlayFonts& fonts() const { return fonts_; }
  const render::Orbit& orbit() const { return orbit_; }
  /// The scene is seen so, from the next frame on.
  void look(const render::Orbit& orbit);
  /// Of letters and panels, as shown.
  float scale() const { return scale_; }
  /// Something else was drawn in its place.
  void redraw() { scene_changed_ = true; }
  void show_beside(EarlierRun run) { earlier_ = std::move(run); }
  std::optional<EarlierRun> take_earlier() { return std::exchange(earlier_, std::nullopt); }
  const Inspection& inspection() const { return inspection_; }
  const PictureSettings& settings() const { return settings_; }
  void choose_settings(const PictureSettings& settings) {
    settings_ = settings;
    scene_changed_ = true;
  }
  bool keeps_in_picture() const { return keeps_in_picture_; }
  /// The run of the room before it was changed is drawn pale, rather than a branch that was left: until one
  /// goes on from an instant.
  bool shows_earlier() const;
  bool ghost_shown() const { return ghost_shown_; }
  void show_ghost(bool on) {
    ghost_shown_ = on;
    scene_changed_ = true;
  }
  /// In the status line until the next click.
  void show_message(const std::string& words) { message_ = words; }
  const std::string& message() const { return message_; }
  /// Over the scene, until another takes its place; empty: none.
  void show_note(const std::string& words) { note_ = words; }
  const std::string& note() const { return note_; }
  /// The values of now are those of the scene that was saved under this name.
  void saved_as(const std::string& name) { saved_ = {name, player_.parameters()}; }
  /// Of the scene as it is shown, over it.
  std::string title() const;
  /// At the right end of the status line; empty: nothing is at work beside the window.
  void show_work(const std::string& words) { work_ = words; }
  /// How long a frame took, ms, for the status line.
  void report_frame_time(double ms);

 private:
  Appearance fitting() const;
  void apply_appearance();
  void choose_appearance(const Appearance& appearance);
  void resize(int direction);
  void let_go();
  void focus_next_panel();
  void go_on_from_here();
  void next_colour();
  void next_bodies();
  void turn(bool& on);
  void toggle_following();
  void move_with_followed();
  void keep_in_picture();
  void lay_out();
  void handle_characters();
  void handle_mouse();
  std::optional<render::Pick> picked_at(float x, float y) const;
  void pick(const std::optional<render::Pick>& found);
  void handle_hand(bool inside, float x, float y);
  void fit_view(render::NamedView view);
  void move_camera(double wall_s);
  void draw_scene();
  void draw_words(const io::FrameRow& row);
  void draw_side_panel(const std::optional<io::FrameRow>& row);
  void draw_tabs();
  void draw_plots_strip();
  void write_plots(PlotRequest request);
  render::Image picture_of_plots();
  std::string pace() const;
  void write_status();
  void draw_status();
  void draw_key_table();
  void draw_panels();
  GhostCurves ghost_curves() const;

  Player& player_;
  render::Stage& stage_;
  const float desktop_scale_;
  float scale_ = 1;
  Appearance appearance_, applied_;  // as asked for, and as shown, where there is room
  const Keep keep_;
  render::OverlayFonts fonts_;
  Bridge bridge_;
  Box scene_, plots_, timeline_, transport_, side_, path_, status_;
  PictureSettings settings_;
  render::SceneFrame frame_;
  std::optional<io::FrameRow> row_;
  render::Orbit orbit_, from_, to_;
  double flight_ = 1;                    // of the camera from one place to the other, 0..1
  bool fitted_ = false, moved_ = false;  // moved_: by hand since it was fitted
  bool words_due_ = false;               // they were written for another camera or frame
  bool computes_ = false;                // beside the window
  /// The body that the camera follows, and its centre when the camera last moved with it, m.
  struct Followed {
    std::size_t body;
    Eigen::Vector3f centre;
  };
  std::optional<Followed> follows_;
  float words_top_ = 0, words_bottom_ = 0, words_right_ = 0;  // px of the scene that words cover
  float words_left_ = 0;                                      // the same instead of words_top_
  render::NamedView view_;
  Inspection inspection_;
  Histories histories_;
  TiltHistory tilts_;
  TeachingState teaching_;
  PrecisionState precision_;
  std::optional<EarlierRun> earlier_;
  Hand hand_;
  std::optional<SolidBodies> solid_;  ///< once they were wanted
  Tab tab_ = Tab::parameters;
  int failed_element_ = -1;                  // marked; -1: none
  std::optional<std::int32_t> pale_branch_;  // that was left
  bool scene_changed_ = true, camera_changed_ = true;
  std::size_t rows_ = 0;      // of the run that is shown, when the scene was drawn
  bool drawn_still_ = false;  // the scene kept is one of best quality
  double quiet_ = 0;          // s since the scene last changed
  bool dragging_ = false, dragged_ = false;
  static constexpr int k_status_lines = 2;
  float transport_height_ = 0;              // as last drawn
  std::string status_line_, status_words_;  // as far as there is room, and whole
  bool to_next_panel_ = false;
  ShellRequest asked_ = ShellRequest::none;
  bool keys_shown_ = false, ghost_shown_ = true, panels_hidden_ = false, keeps_in_picture_ = false;
  std::string refused_;
  std::string work_;
  std::string message_;  // what was written, or why it was not
  std::string note_;
  std::pair<std::string, Parameters> saved_;  // the name of the scene that was saved last; empty: none
  double frame_ms_ = 0;
};

}  // namespace topple::app
