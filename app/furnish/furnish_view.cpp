#include "app/furnish/furnish_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/chart/theme.h"
#include "app/picture/bridge.h"
#include "app/picture/furnish_words.h"
#include "app/picture/words.h"
#include "render/scene/text_layout.h"

namespace topple::app {
namespace {

constexpr double k_quiet_room = 0.4;  // s without change after which the room is drawn at its best
constexpr render::Float4 k_red = {0.86f, 0.20f, 0.16f, 1}, k_marked = {0.05f, 0.45f, 0.85f, 1},
                         k_light = {0.35f, 0.72f, 1, 1};
constexpr float k_room_to_furnish = 0.6f;  // m, around what stands there
constexpr float k_least_side = 320, k_most_of_width = 0.45f;
constexpr int k_person_corners = 24;  // of the outline where a person is to stand

render::Float4 mixed(render::Float4 a, const render::Float4& b, float share) {
  if (a[3] == 0) a = k_rigid_colour;
  for (std::size_t k = 0; k < 4; ++k) a[k] += share * (b[k] - a[k]);
  return a;
}

}  // namespace

FurnishView::FurnishView(render::Stage& stage, const io::Scene& scene, std::string origin,
                         const std::optional<render::Orbit>& orbit)
    : stage_(stage),
      origin_(std::move(origin)),
      room_(scene, origin_),
      palette_(stage),
      orbit_(orbit.value_or(render::Orbit{})),
      fitted_(orbit.has_value()) {}

void FurnishView::begin_new_room() {
  let_go();
  if (!change([](const io::Scene&) { return new_room(); })) return;
  another_ = true;
  fitted_ = false;
}

void FurnishView::select(const std::string& name) {
  if (name == selected_) return;
  selected_ = name;
  if (!name.empty()) tab_ = Tab::piece;
  frame_changed_ = true;
}

void FurnishView::arm_kind(const std::string& kind) {
  let_go();
  const Palette::Card* const card = palette_.card(kind);
  if (!card) return;
  tool_ = {Tool::Kind::place, kind, {}, {}};
  ghost_ = Ghost{card->shape, {{}, card->half}};
}

void FurnishView::arm_wall() {
  let_go();
  tool_ = {Tool::Kind::wall, {}, {}, {}};
}

void FurnishView::arm_door() {
  let_go();
  tool_ = {Tool::Kind::door, {}, {}, {}};
}

void FurnishView::arm_person() {
  let_go();
  tool_ = {Tool::Kind::person, {}, {}, {}};
}

void FurnishView::arm_fixing(const std::string& kind) {
  let_go();
  tool_ = {Tool::Kind::fixing, kind, {}, {}};
}

bool FurnishView::update(double wall_s) {
  bool news = palette_.update();
  if (room_.update() && ghost_ && room_.answer()) {
    ghost_->red = !room_.answer()->empty();
    ghost_->why = *room_.answer();
    frame_changed_ = true;
  }
  const bool moved = room_changed_ || frame_changed_ || camera_changed_;
  quiet_ = moved ? 0 : quiet_ + wall_s;
  news = news || moved || (!drawn_still_ && quiet_ > k_quiet_room);
  return news;
}

void FurnishView::lay_out(const render::OverlayFonts& fonts) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float side = std::min(k_least_side * scale_, k_most_of_width * size.x);
  const float status = 2 * fonts.small->FontSize * 1.35f + 2 * ImGui::GetStyle().WindowPadding.y;
  const float bar = bar_height_ > 0 ? bar_height_ : 38 * scale_;
  const Box before = scene_;
  scene_ = {0, 0, std::max(size.x - side, 16.f), std::max(size.y - status - bar, 16.f)};
  side_ = {scene_.width, 0, side, scene_.height};
  bar_ = {0, scene_.height, size.x, bar};
  status_ = {0, scene_.height + bar, size.x, status};
  if (before.width != scene_.width || before.height != scene_.height) camera_changed_ = true;
}

render::Surface FurnishView::surface() const {
  return surface_with_scene(scene_);
}

void FurnishView::build(const render::OverlayFonts& fonts, float scale, const std::function<void()>& over,
                        bool covered) {
  scale_ = scale;
  asked_ = ShellRequest::none;
  lay_out(fonts);
  ImGuiIO& io = ImGui::GetIO();
  const bool keys = !covered && panels_have_keys_;
  if (io.BackendPlatformName != nullptr)
    io.ConfigFlags = keys ? io.ConfigFlags | ImGuiConfigFlags_NavEnableKeyboard
                          : io.ConfigFlags & ~ImGuiConfigFlags_NavEnableKeyboard;
  if (room_changed_) take_room();
  if (!covered) handle_mouse();
  draw_over_scene(fonts);
  draw_side(fonts);
  draw_bar();
  draw_status();
  if (keys_shown_) draw_keys();
  if (over) over();
  ImGui::Render();
  draw_scene();
}

void FurnishView::take_room() {
  room_changed_ = false;
  base_ = start_frame(room_.scene());
  frame_changed_ = true;
  if (!selected_.empty() && !room_.piece(selected_)) selected_.clear();
  hovered_.reset();
}

void FurnishView::compose() {
  frame_ = base_;
  frame_.dark = window_is_dark();
  const Model& model = room_.scene().setup.model;
  const auto tint = [&](std::size_t body, float share) {
    for (render::Tube& tube : frame_.tubes)
      if (tube.body == body && tube.member < model.members.size())
        tube.colour = mixed(tube.colour, k_light, share);
  };
  const RoomPiece* const chosen = selected_piece();
  if (ghost_) {
    std::size_t body = model.bodies.size();
    if (const RoomPiece* const moved = room_.piece(ghost_->name))
      hide_body(model, body = moved->body, frame_);
    if (!ghost_->seen) return;
    add_shape(ghost_->shape, ghost_->spot, ghost_->floor, body,
              ghost_->red ? std::optional(k_red) : std::nullopt, frame_);
    add_footprint({ghost_->spot, ghost_->footprint.half}, ghost_->floor, ghost_->red ? k_red : k_marked,
                  frame_);
    return;
  }
  if (hovered_) tint(*hovered_, 0.35f);
  if (!chosen) return;
  if (hovered_ != chosen->body) tint(chosen->body, 0.15f);
  add_footprint({chosen->spot, chosen->half}, chosen->floor, k_marked, frame_);
}

void FurnishView::fit_view(render::NamedView view) {
  view_ = view;
  fitted_ = scene_.height > 0;
  if (!fitted_) return;  // it is once it is laid out
  render::SceneFrame frame = base_;
  for (int k = 0; k < 2; ++k) {
    frame.bounds_min[static_cast<std::size_t>(k)] -= k_room_to_furnish;
    frame.bounds_max[static_cast<std::size_t>(k)] += k_room_to_furnish;
  }
  orbit_ = render::Orbit::fit(view, frame, scene_.width / scene_.height);
  camera_changed_ = true;
}

void FurnishView::draw_scene() {
  if (!fitted_) fit_view(view_);
  const bool changed = frame_changed_ || camera_changed_;
  if (!changed && (drawn_still_ || quiet_ <= k_quiet_room)) return;
  if (frame_changed_) compose();
  orbit_.set_bounds(base_);
  drawn_still_ = !changed;
  stage_.set_budget(camera_changed_ ? std::optional(render::k_scene_budget) : std::nullopt);
  const render::Surface whole = surface();
  const ImVec2 pixel = ImGui::GetIO().DisplayFramebufferScale;
  stage_.draw_scene(frame_, orbit_.camera(scene_.width / scene_.height), render::ColourMap::viridis,
                    std::min(static_cast<int>(std::lround(scene_.width * pixel.x)), whole.width),
                    std::min(static_cast<int>(std::lround(scene_.height * pixel.y)), whole.height),
                    drawn_still_ ? render::Quality::still : render::Quality::interactive);
  frame_changed_ = camera_changed_ = false;
}

std::optional<Eigen::Vector2f> FurnishView::pixel_of_floor(const Vec2& at, double height) const {
  const auto pixel = pixel_of(
      orbit_.camera(scene_.width / scene_.height), scene_.width, scene_.height,
      Eigen::Vector3f(static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(height)));
  if (!pixel) return std::nullopt;
  return Eigen::Vector2f(pixel->x() + scene_.left, pixel->y() + scene_.top);
}

void FurnishView::draw_words_at_mouse(const std::string& words, unsigned colour,
                                      const render::OverlayFonts& fonts) const {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!scene_.contains(mouse.x, mouse.y)) return;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const float line = 1.3f * fonts.small->FontSize, pad = 6 * scale_;
  const auto lines = render::wrapped(*fonts.small, words, std::min(420 * scale_, 0.6f * scene_.width), 4);
  float width = 0;
  for (const std::string& one : lines) width = std::max(width, render::text_width(*fonts.small, one));
  const float height = line * static_cast<float>(lines.size());
  const float x = std::clamp(mouse.x + 18 * scale_, scene_.left + pad,
                             std::max(scene_.left + scene_.width - width - 2 * pad, pad));
  float y = std::clamp(mouse.y + 22 * scale_, scene_.top + pad,
                       std::max(scene_.top + scene_.height - height - 2 * pad, pad));
  list.AddRectFilled({x - pad, y - pad}, {x + width + pad, y + height + pad}, theme().sheet, 4);
  list.AddRect({x - pad, y - pad}, {x + width + pad, y + height + pad}, colour, 4);
  for (const std::string& one : lines) {
    list.AddText(fonts.small, fonts.small->FontSize, {x, y}, colour, one.c_str());
    y += line;
  }
}

/// Of the wall, the door or the person that a click would put.
void FurnishView::draw_outline_at_mouse(const render::OverlayFonts& fonts) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!scene_.contains(mouse.x, mouse.y)) return;
  std::vector<Vec2> corners;
  double height = 0;
  std::string words;
  if (tool_.kind == Tool::Kind::wall && tool_.from) {
    const auto to = wall_place_at(mouse.x, mouse.y);
    if (!to) return;
    corners = {*tool_.from, *to};
    words = fmt::format("{:.2f} m", (*to - *tool_.from).norm());
  } else if (tool_.kind == Tool::Kind::door) {
    const auto door = door_at(mouse.x, mouse.y);
    if (!door) return;
    for (const double end : {-0.5, 0.5}) corners.push_back(door->middle + end * k_usual_door * door->along);
    words = fmt::format("{}, {:.2f} m", door->wall, door->at);
  } else if (tool_.kind == Tool::Kind::person) {
    const auto spot = person_place_at(mouse.x, mouse.y);
    if (!spot) return;
    height = spot->height;
    const double radius = room_.scene().setup.room.person / 2;
    for (int k = 0; k <= k_person_corners; ++k) {
      const double turn = 2 * k_pi * k / k_person_corners;
      corners.push_back(spot->at + radius * Vec2(std::cos(turn), std::sin(turn)));
    }
    words = fmt::format("{:.2f} m, {:.2f} m", spot->at.x(), spot->at.y());
  }
  std::vector<ImVec2> line;
  for (const Vec2& corner : corners)
    if (const auto pixel = pixel_of_floor(corner, height)) line.emplace_back(pixel->x(), pixel->y());
  if (line.size() < 2) return;
  list.AddPolyline(line.data(), static_cast<int>(line.size()), theme().line, 0, 3 * scale_);
  draw_words_at_mouse(words, theme().text, fonts);
}

void FurnishView::draw_over_scene(const render::OverlayFonts& fonts) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({scene_.left, scene_.top}, {scene_.left + scene_.width, scene_.top + scene_.height});
  draw_outline_at_mouse(fonts);
  const float margin = 14 * scale_;
  const std::string title = render::shortened(
      *fonts.text, in_window_language(room_.scene().title) + " — " + say(furnish_words::k_furnishing),
      scene_.width - 2 * margin);
  list.AddText(fonts.text, fonts.text->FontSize, {scene_.left + margin, scene_.top + margin}, theme().text,
               title.c_str());
  list.PopClipRect();
  if (ghost_ && ghost_->red) draw_words_at_mouse(ghost_->why, theme().positive, fonts);
}

}  // namespace topple::app
