#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/furnish/furnish_view.h"
#include "app/picture/furnish_words.h"
#include "render/scene/pick.h"
#include "solver/io/scene/fixing_kinds.h"

namespace topple::app {
namespace {

constexpr float k_click_moves = 4;  // px: a press that moves less is no drag

}  // namespace

Sightline FurnishView::sight_at(float x, float y) const {
  return sightline(orbit_.camera(scene_.width / scene_.height), scene_.width, scene_.height, x - scene_.left,
                   y - scene_.top);
}

std::optional<std::size_t> FurnishView::body_at(float x, float y) const {
  const auto found =
      render::pick(frame_, orbit_.camera(scene_.width / scene_.height), static_cast<int>(scene_.width),
                   static_cast<int>(scene_.height), x - scene_.left, y - scene_.top);
  if (!found || found->member >= room_.scene().setup.model.members.size()) return std::nullopt;
  for (const RoomPiece& piece : room_.pieces())
    if (piece.body == found->body) return found->body;
  return std::nullopt;
}

std::vector<Footprint> FurnishView::footprints_but(const std::string& name) const {
  std::vector<Footprint> others;
  for (const RoomPiece& piece : room_.pieces())
    if (piece.name != name) others.push_back({piece.spot, piece.half});
  return others;
}

void FurnishView::hover(const std::optional<std::size_t>& body) {
  if (body == hovered_) return;
  hovered_ = body;
  frame_changed_ = true;
}

void FurnishView::handle_camera(bool inside, bool turn) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool pan = io.MouseDown[1] || io.MouseDown[2] || (turn && io.KeyShift);
  if (dragging_ && dragged_ && (turn || pan) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    if (pan)
      orbit_.pan(io.MouseDelta.x, io.MouseDelta.y, scene_.height);
    else
      orbit_.rotate(io.MouseDelta.x, io.MouseDelta.y);
    camera_changed_ = true;
  }
  if (inside && io.MouseWheel != 0) {
    orbit_.zoom(std::pow(1.15f, io.MouseWheel), io.MousePos.x - scene_.left, io.MousePos.y - scene_.top,
                scene_.width, scene_.height);
    camera_changed_ = true;
  }
}

void FurnishView::handle_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const float x = io.MousePos.x, y = io.MousePos.y;
  const bool over_scene = scene_.contains(x, y);
  const bool inside = over_scene && !io.WantCaptureMouse;
  if (inside && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2))) {
    dragging_ = true;
    dragged_ = from_card_ = false;
    pressed_.clear();
    room_.forget_refusal();
    message_.clear();
    panels_have_keys_ = false;
    ImGui::SetWindowFocus(nullptr);  // arrows are for the room
    if (ImGui::IsMouseClicked(0) && tool_.kind == Tool::Kind::select) begin_drag(x, y);
  }
  for (int button = 0; dragging_ && button < 3; ++button)
    dragged_ =
        dragged_ || io.MouseDragMaxDistanceSqr[button] > k_click_moves * k_click_moves * scale_ * scale_;
  const bool moves_piece = dragging_ && dragged_ && !pressed_.empty() && io.MouseDown[0];
  handle_camera(inside, io.MouseDown[0] && pressed_.empty());
  if (const RoomPiece* const found = room_.piece(pressed_); found && moves_piece && !ghost_) {
    const RoomPiece& piece = *found;
    ghost_ = Ghost{.shape = shape_of(base_, room_.scene().setup.model, piece),
                   .footprint = {piece.spot, piece.half},
                   .floor = piece.floor,
                   .name = piece.name,
                   .spot = piece.spot,
                   .turns = piece.table != "frame" &&
                            backs_wall({piece.spot, piece.half}, wall_lines(room_.scene().setup.model))};
    select(pressed_);
    frame_changed_ = true;
  }
  const bool follows =
      ghost_ && over_scene && (moves_piece || (tool_.kind == Tool::Kind::place && !(dragging_ && dragged_)));
  if (follows) move_ghost(x, y);
  const bool wants_body = tool_.kind == Tool::Kind::select || tool_.kind == Tool::Kind::fixing;
  if (!ghost_ && !dragging_) hover(inside && wants_body ? body_at(x, y) : std::nullopt);
  if (ImGui::IsMouseReleased(0)) {
    if (ghost_ && !ghost_->name.empty())
      put_down();
    else if ((dragging_ && !dragged_) || (from_card_ && over_scene && ghost_))
      click(x, y);
    from_card_ = false;
  }
  if (ImGui::IsAnyMouseDown()) return;
  dragging_ = false;
  pressed_.clear();
}

void FurnishView::begin_drag(float x, float y) {
  const auto body = body_at(x, y);
  if (!body) return;
  for (const RoomPiece& piece : room_.pieces()) {
    if (piece.body != *body) continue;
    // where the line of sight passes its middle
    const Sightline sight = sight_at(x, y);
    const Vec2 level = sight.direction.head<2>(), to = piece.spot.at - sight.from.head<2>();
    const double way = level.dot(to) / std::max(level.squaredNorm(), 1e-12);
    grab_level_ =
        std::clamp(sight.from.z() + way * sight.direction.z(), piece.floor, piece.floor + piece.size.z());
    const auto at = on_level(sight, grab_level_);
    pressed_ = piece.name;
    grab_ = at ? Vec2(*at - piece.spot.at) : Vec2(Vec2::Zero());
  }
}

RoomEdit FurnishView::edit_of_ghost() const {
  if (const RoomPiece* const piece = room_.piece(ghost_->name))
    return [piece = *piece, spot = ghost_->spot](const io::Scene& scene) {
      return with_moved(scene, piece, spot);
    };
  return [kind = tool_.word, spot = ghost_->spot](const io::Scene& scene) {
    return with_piece(scene, kind, spot);
  };
}

/// On the floor, or at the foot of the wall that is seen there.
std::optional<Vec2> FurnishView::place_at(float x, float y) const {
  const Sightline sight = sight_at(x, y);
  const auto ground = ground_at(sight, base_.grounds);
  if (!ground || base_.grounds[*ground].is_floor) return on_level(sight, 0);
  const render::Ground& wall = base_.grounds[*ground];
  const Vec3 normal(wall.normal[0], wall.normal[1], wall.normal[2]),
      centre(wall.centre[0], wall.centre[1], wall.centre[2]);
  const double way = (centre - sight.from).dot(normal) / sight.direction.dot(normal);
  return Vec2((sight.from + way * sight.direction).head<2>());
}

std::optional<Vec2> FurnishView::wall_place_at(float x, float y) const {
  const auto at = on_level(sight_at(x, y), 0);
  return at ? std::optional<Vec2>((*at / k_grid).array().round().matrix() * k_grid) : std::nullopt;
}

std::optional<FurnishView::PersonSpot> FurnishView::person_place_at(float x, float y) const {
  double height = 0;
  if (const auto body = body_at(x, y))
    for (const RoomPiece& piece : room_.pieces())
      if (piece.body == *body && piece.floor + piece.size.z() <= k_lies_on)
        height = piece.floor + piece.size.z();
  const auto at = on_level(sight_at(x, y), height);
  if (!at) return std::nullopt;
  return PersonSpot{(*at / k_grid).array().round().matrix() * k_grid, height};
}

std::optional<DoorSpot> FurnishView::door_at(float x, float y) const {
  const auto at = place_at(x, y);
  return at ? door_near(room_.scene().setup.model, *at) : std::nullopt;
}

void FurnishView::move_ghost(float x, float y) {
  const bool fresh = ghost_->name.empty();
  const auto at = fresh ? place_at(x, y) : on_level(sight_at(x, y), grab_level_);
  if (!at) return;
  ghost_->footprint.spot = {fresh ? *at : Vec2(*at - grab_), ghost_->footprint.spot.yaw};
  const std::vector<WallLine> walls = wall_lines(room_.scene().setup.model);
  const Spot spot = snapped(ghost_->footprint, footprints_but(ghost_->name), walls, ghost_->turns);
  if (spot == ghost_->spot && ghost_->seen) return;
  ghost_->spot = spot;
  ghost_->seen = true;
  room_.forget_refusal();
  frame_changed_ = true;
  room_.ask(edit_of_ghost());
}

void FurnishView::put_down() {
  const RoomEdit edit = edit_of_ghost();
  const bool moved = room_.piece(ghost_->name)->spot != ghost_->spot;
  const Spot spot = ghost_->spot;
  ghost_.reset();
  room_.forget_question();
  frame_changed_ = true;
  pressed_.clear();
  if (!moved || !change(edit)) return;
  // one of several copies that was turned has another name
  for (const RoomPiece& piece : room_.pieces())
    if ((piece.spot.at - spot.at).norm() < 1e-3 && piece.name != selected_ && !room_.piece(selected_))
      select(piece.name);
}

void FurnishView::click(float x, float y) {
  const auto at = on_level(sight_at(x, y), 0);
  switch (tool_.kind) {
    case Tool::Kind::select: {
      const auto body = body_at(x, y);
      std::string name;
      for (const RoomPiece& piece : room_.pieces())
        if (body && piece.body == *body) name = piece.name;
      select(name);
      break;
    }
    case Tool::Kind::place: {
      if (!at) return;
      move_ghost(x, y);
      const std::string name = fresh_name(room_.scene(), tool_.word);
      const bool several = ImGui::GetIO().KeyShift;
      if (!change(edit_of_ghost())) return;
      room_.forget_question();
      if (several) {
        room_.ask(edit_of_ghost());
        return;
      }
      let_go();
      selected_ = name;  // the palette stays: another piece may follow
      break;
    }
    case Tool::Kind::wall: {
      const auto place = wall_place_at(x, y);
      if (!place) return;
      if (!tool_.from) {
        tool_.from = place;
      } else if (change([from = *tool_.from, to = *place](const io::Scene& scene) {
                   return with_wall(scene, from, to);
                 })) {
        let_go();
      }
      break;
    }
    case Tool::Kind::door: {
      const auto door = door_at(x, y);
      if (!door)
        room_.refuse(say(furnish_words::k_no_wall));
      else if (change([spot = *door](const io::Scene& scene) { return with_door(scene, spot); }))
        let_go();
      break;
    }
    case Tool::Kind::person: {
      const auto place = person_place_at(x, y);
      if (place && change([at = place->at](const io::Scene& scene) { return with_person(scene, at); }))
        let_go();
      break;
    }
    case Tool::Kind::fixing:
      choose_fixing_end(x, y);
      break;
  }
}

void FurnishView::choose_fixing_end(float x, float y) {
  const auto body = body_at(x, y);
  const Model& model = room_.scene().setup.model;
  std::string to = body ? model.bodies[*body].name : "";
  if (tool_.body.empty()) {
    if (!body) return;
    tool_.body = to;
    const auto* traits = io::k_fixings;
    while (traits->word != tool_.word) ++traits;
    if (!traits->to_ceiling) return;
    to = "ceiling";  // the only one
  } else if (!body || to == tool_.body) {
    const auto ground = ground_at(sight_at(x, y), base_.grounds);
    if (!ground || *ground >= model.planes.size()) return;
    to = model.planes[*ground].name;
  }
  const std::string holds = std::exchange(tool_.body, "");
  if (change([word = tool_.word, holds, to](const io::Scene& scene) {
        return with_fixing(scene, word, holds, to);
      }))
    let_go();
}

}  // namespace topple::app
