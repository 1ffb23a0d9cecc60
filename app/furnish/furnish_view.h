// The window while a room is furnished: the room, a palette of furniture, what is selected; mouse and
// keyboard.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/furnish/furnishing.h"
#include "app/furnish/palette.h"
#include "app/furnish/room_edits.h"
#include "app/furnish/snap.h"
#include "app/panels/panels.h"
#include "render/gl/key_press.h"
#include "render/output/stage.h"
#include "render/scene/font.h"
#include "render/scene/orbit.h"

namespace topple::app {

class FurnishView {
 public:
  enum class Tab { kinds, piece, room };

  /// The room of `scene`, seen as by `orbit`; `origin` as of Furnishing, for which it throws.
  FurnishView(render::Stage& stage, const io::Scene& scene, std::string origin,
              const std::optional<render::Orbit>& orbit = {});

  /// Takes in what is new. True when there is something to draw that was not drawn before.
  bool update(double wall_s);
  /// Does what the key is for. False: it is for nothing here.
  bool press(const render::KeyPress& press);
  /// Builds one Dear ImGui frame as Viewer does. `scale`: of letters and panels, 1 for 720 lines.
  void build(const render::OverlayFonts& fonts, float scale, const std::function<void()>& over = {},
             bool covered = false);
  render::Surface surface() const;

  /// Something else was drawn in its place.
  void redraw() { camera_changed_ = true; }
  /// In the status line until the next click or key.
  void show_message(const std::string& words) { message_ = words; }
  const std::string& message() const { return message_; }

  /// What the last frame's buttons asked for.
  ShellRequest asked() const { return asked_; }

  /// Begins with another room in place of this one; undo leads back.
  void begin_new_room();
  /// It began so and was not looked at as a run since.
  bool is_another() const { return another_; }
  void begin_run() { another_ = false; }

  /// As of Furnishing.
  bool change(const RoomEdit& edit);
  Furnishing& room() { return room_; }
  const Furnishing& room() const { return room_; }
  const std::string& origin() const { return origin_; }
  const render::Orbit& orbit() const { return orbit_; }
  const Box& scene_box() const { return scene_; }
  /// The name of the selected body; empty: none.
  const std::string& selected() const { return selected_; }
  void select(const std::string& name);
  void show(Tab tab) { tab_ = tab; }
  /// The pixel, from the upper left corner of the window, at which a place on the floor is seen.
  std::optional<Eigen::Vector2f> pixel_of_floor(const Vec2& at, double height = 0) const;
  /// The next click puts a piece of this kind, a wall's end, a door, a person or a fixing's end.
  void arm_kind(const std::string& kind);
  void arm_wall();
  void arm_door();
  void arm_person();
  void arm_fixing(const std::string& kind);
  bool armed() const { return tool_.kind != Tool::Kind::select; }
  /// Where the piece that follows the mouse would stand; none: there is none.
  std::optional<Spot> ghost_spot() const {
    return ghost_ && ghost_->seen ? std::optional(ghost_->spot) : std::nullopt;
  }
  /// It cannot stand there, as far as it is known.
  bool ghost_is_red() const { return ghost_ && ghost_->red; }

  struct KeyLine {
    Phrase shown, does;
  };
  static std::span<const KeyLine> key_lines();

 private:
  /// What a click in the room does.
  struct Tool {
    enum class Kind { select, place, wall, door, person, fixing };
    Kind kind = Kind::select;
    std::string word = {};          ///< of a kind of furniture or fixing
    std::optional<Vec2> from = {};  ///< m, the first end of a wall
    std::string body = {};          ///< that a fixing holds
  };
  /// A piece that follows the mouse.
  struct Ghost {
    PieceShape shape;
    Footprint footprint;    ///< where the mouse has it
    double floor = 0;       ///< m
    std::string name = {};  ///< of the piece that is moved; empty: a new one
    Spot spot = {};         ///< where it would stand
    bool seen = false;      ///< the mouse has been over the room
    bool turns = true;      ///< its back to a wall that is near
    bool red = false;
    std::string why = {};  ///< it is red
  };

  void lay_out(const render::OverlayFonts& fonts);
  void take_room();
  void compose();
  void draw_scene();
  void fit_view(render::NamedView view);
  void draw_over_scene(const render::OverlayFonts& fonts);
  void draw_outline_at_mouse(const render::OverlayFonts& fonts) const;
  void draw_words_at_mouse(const std::string& words, unsigned colour,
                           const render::OverlayFonts& fonts) const;

  void handle_mouse();
  void handle_camera(bool inside, bool turn);
  void hover(const std::optional<std::size_t>& body);
  void click(float x, float y);
  void choose_fixing_end(float x, float y);
  void begin_drag(float x, float y);
  void move_ghost(float x, float y);
  void put_down();
  RoomEdit edit_of_ghost() const;
  std::vector<Footprint> footprints_but(const std::string& name) const;
  std::optional<std::size_t> body_at(float x, float y) const;
  Sightline sight_at(float x, float y) const;
  std::optional<Vec2> place_at(float x, float y) const;
  /// On the floor, on the grid.
  std::optional<Vec2> wall_place_at(float x, float y) const;
  /// There, or on a low piece that is seen there; and its height, m.
  struct PersonSpot {
    Vec2 at;
    double height;
  };
  std::optional<PersonSpot> person_place_at(float x, float y) const;
  std::optional<DoorSpot> door_at(float x, float y) const;

  bool press_with_control(const render::KeyPress& press);
  void let_go();
  void nudge(int right, int away, bool far);
  void turn(int direction, bool fine);
  void remove_selected();
  void copy_selected();

  void draw_side(const render::OverlayFonts& fonts);
  void draw_kinds(const render::OverlayFonts& fonts);
  void draw_piece();
  bool number_field(const std::string& label, double value, const char* format, double& changed);
  void draw_piece_numbers(const RoomPiece& piece);
  void draw_room();
  void draw_walls();
  void draw_fixings();
  void draw_way_out();
  void draw_bar();
  void draw_status();
  void draw_keys();
  std::string hint() const;
  const RoomPiece* selected_piece() const { return room_.piece(selected_); }

  render::Stage& stage_;
  const std::string origin_;
  Furnishing room_;
  Palette palette_;
  render::SceneFrame base_, frame_;  ///< the room; with what is seen of the mouse
  render::Orbit orbit_;
  bool fitted_;
  render::NamedView view_ = render::NamedView::iso;
  Box scene_, side_, bar_, status_;
  float scale_ = 1, bar_height_ = 0;
  Tab tab_ = Tab::kinds;
  Tool tool_;
  std::optional<Ghost> ghost_;
  std::string selected_, pressed_;  ///< pressed_: the piece on which the button went down
  Vec2 grab_ = Vec2::Zero();        ///< m, from the middle of that piece, at this height
  double grab_level_ = 0;           ///< m
  std::optional<std::size_t> hovered_;
  bool dragging_ = false, dragged_ = false, from_card_ = false;
  bool room_changed_ = true, frame_changed_ = true, camera_changed_ = true, drawn_still_ = false;
  double quiet_ = 0;
  bool keys_shown_ = false, panels_have_keys_ = false, another_ = false;
  ShellRequest asked_ = ShellRequest::none;
  char name_[256] = {}, own_kind_[1024] = {};
  std::string named_, message_;  ///< named_: whose name name_ is
  std::optional<double> typed_;  ///< so far, in the number field that has the keyboard
};

}  // namespace topple::app
