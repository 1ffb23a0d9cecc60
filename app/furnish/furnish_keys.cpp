#include <imgui.h>

#include <cmath>

#include "app/furnish/furnish_view.h"
#include "app/picture/furnish_words.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;

constexpr double k_step = 0.010, k_far_step = 0.100;                  // m, of an arrow
constexpr double k_turn = 15 * k_pi / 180, k_fine_turn = k_pi / 180;  // rad
constexpr int k_most_copies_tried = 6;                                // to each side

}  // namespace

std::span<const FurnishView::KeyLine> FurnishView::key_lines() {
  static constexpr KeyLine k_lines[] = {
      {{"Space", "Space"}, fw::k_key_shake},
      {fw::k_arrow_keys, fw::k_key_move},
      {{"Q E", "Q E"}, fw::k_key_turn_piece},
      {{"Del", "Del"}, fw::k_key_delete},
      {{"Ctrl+D", "Ctrl+D"}, fw::k_key_copy},
      {{"Ctrl+Z", "Ctrl+Z"}, fw::k_key_undo_room},
      {{"Ctrl+Y, Ctrl+Shift+Z", "Ctrl+Y、Ctrl+Shift+Z"}, fw::k_key_redo_room},
      {{"1 2 3 4 F", "1 2 3 4 F"}, fw::k_key_views},
      {window_words::k_drag, fw::k_key_drag},
      {{"Esc", "Esc"}, fw::k_key_let_go_room},
      {{"F2", "F2"}, fw::k_key_back},
      {{"F6", "F6"}, window_words::k_key_panel},
      {{"Ctrl+S", "Ctrl+S"}, window_words::k_key_save},
      {{"F1", "F1"}, window_words::k_key_table}};
  return k_lines;
}

bool FurnishView::change(const RoomEdit& edit) {
  const bool done = room_.change(edit);
  if (done) room_changed_ = true;
  return done;
}

void FurnishView::let_go() {
  tool_ = {};
  ghost_.reset();
  room_.forget_question();
  hovered_.reset();
  pressed_.clear();
  from_card_ = false;
  frame_changed_ = true;
}

void FurnishView::nudge(int right, int away, bool far) {
  const RoomPiece* const piece = selected_piece();
  if (!piece || ghost_) return;
  const double azimuth = orbit_.sight.azimuth;
  Vec2 way =
      right * Vec2(-std::sin(azimuth), std::cos(azimuth)) - away * Vec2(std::cos(azimuth), std::sin(azimuth));
  int axis = 0;
  way.cwiseAbs().maxCoeff(&axis);  // along the axis of the room that is nearest to what is seen
  Vec2 step = Vec2::Zero();
  step[axis] = std::copysign(far ? k_far_step : k_step, way[axis]);
  change([piece = *piece, step](const io::Scene& scene) {
    return with_moved(scene, piece, {piece.spot.at + step, piece.spot.yaw});
  });
}

void FurnishView::turn(int direction, bool fine) {
  const double by = direction * (fine ? k_fine_turn : k_turn);
  if (ghost_) {
    ghost_->footprint.spot.yaw = std::remainder(ghost_->spot.yaw + by, 2 * k_pi);
    ghost_->spot.yaw = ghost_->footprint.spot.yaw;
    ghost_->turns = false;
    frame_changed_ = true;
    room_.ask(edit_of_ghost());
    return;
  }
  const RoomPiece* const piece = selected_piece();
  if (!piece) return;
  Spot spot{piece->spot.at, std::remainder(piece->spot.yaw + by, 2 * k_pi)};
  spot.at = off_walls({spot, piece->half}, wall_lines(room_.scene().setup.model));
  const Spot before = piece->spot;
  if (!change([piece = *piece, spot](const io::Scene& scene) { return with_moved(scene, piece, spot); }))
    return;
  // one of several copies has become a piece with a name of its own
  for (const RoomPiece& other : room_.pieces())
    if ((other.spot.at - before.at).norm() < 1e-3) selected_ = other.name;
}

void FurnishView::remove_selected() {
  const RoomPiece* const piece = selected_piece();
  if (!piece || ghost_) return;
  if (change([piece = *piece](const io::Scene& scene) { return without_piece(scene, piece); })) {
    selected_.clear();
    tab_ = Tab::kinds;
  }
}

void FurnishView::copy_selected() {
  const RoomPiece* const found = selected_piece();
  if (!found || ghost_) return;
  const RoomPiece piece = *found;
  const Vec2 front(std::cos(piece.spot.yaw), std::sin(piece.spot.yaw)), left(-front.y(), front.x());
  const std::string name = fresh_name(room_.scene(), piece.kind.empty() ? piece.table : piece.kind);
  std::string why;
  for (int times = 1; times <= k_most_copies_tried; ++times)
    for (const Vec2& way : {left, Vec2(-left), front, Vec2(-front)}) {
      const double apart = 2 * std::abs(way.dot(front)) * piece.half.x() +
                           2 * std::abs(way.dot(left)) * piece.half.y() + k_gap_at_piece;
      const Spot spot{piece.spot.at + times * apart * way, piece.spot.yaw};
      const RoomEdit edit = [piece, spot](const io::Scene& scene) { return with_copy(scene, piece, spot); };
      if (!change(edit)) {
        if (why.empty()) why = room_.refused();
        continue;
      }
      if (room_.piece(name)) select(name);
      return;
    }
  room_.refuse(say(fw::k_no_room_for_copy, piece.name) + "; " + why);
}

bool FurnishView::press_with_control(const render::KeyPress& press) {
  switch (press.key) {
    case 'Z':
      let_go();
      press.shift ? room_.redo() : room_.undo();
      room_changed_ = true;
      return true;
    case 'Y':
      let_go();
      room_.redo();
      room_changed_ = true;
      return true;
    case 'D':
      copy_selected();
      return true;
    default:
      return false;
  }
}

bool FurnishView::press(const render::KeyPress& press) {
  const ImGuiIO& io = ImGui::GetIO();
  namespace key = render::key;
  if (io.WantTextInput) {
    if (press.key == key::escape) typed_.reset();
    return press.key != key::f1 && press.key != key::f2;
  }
  if (panels_have_keys_ && io.NavVisible && press.key != key::escape && press.key != key::f6 &&
      !press.control)
    return true;
  room_.forget_refusal();
  message_.clear();
  if (press.control) return press_with_control(press);
  switch (press.key) {
    case key::left:
      nudge(-1, 0, press.shift);
      return true;
    case key::right:
      nudge(1, 0, press.shift);
      return true;
    case key::up:
      nudge(0, 1, press.shift);
      return true;
    case key::down:
      nudge(0, -1, press.shift);
      return true;
    case 'Q':
      turn(1, press.shift);
      return true;
    case 'E':
      turn(-1, press.shift);
      return true;
    case key::del:
      remove_selected();
      return true;
    case '1':
      fit_view(render::NamedView::front);
      return true;
    case '2':
      fit_view(render::NamedView::side);
      return true;
    case '3':
      fit_view(render::NamedView::top);
      return true;
    case '4':
      fit_view(render::NamedView::iso);
      return true;
    case 'F':
      fit_view(view_);
      return true;
    case key::f1:
      keys_shown_ = !keys_shown_;
      return true;
    case key::f6:
      panels_have_keys_ = true;
      ImGui::SetWindowFocus("side");
      return true;
    case key::escape:
      if (keys_shown_)
        keys_shown_ = false;
      else if (panels_have_keys_)
        panels_have_keys_ = false;
      else if (armed())
        let_go();
      else
        select("");
      ImGui::SetWindowFocus(nullptr);
      return true;
    default:
      return false;
  }
}

void FurnishView::draw_keys() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.98f * size.x, 0.95f * size.y});
  ImGui::Begin(
      (say(window_words::k_keys) + "###furnish keys").c_str(), &keys_shown_,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyLine& line : key_lines()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(say(line.shown).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(say(line.does).c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace topple::app
