#include "app/furnish/palette.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/picture/furnish_words.h"
#include "render/scene/orbit.h"
#include "render/scene/text_layout.h"
#include "solver/io/builtin/builtin.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/scene_file.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;

constexpr int k_card_picture = 144;            // px
constexpr float k_least_card = 86;             // at letters of 14
constexpr render::Sight k_from{-0.5f, 0.28f};  // rad: its front, and a side

io::Scene scene_of(const std::string& kind, const std::string& origin) {
  return io::parse_scene(
      "topple = 1\nfloor = {}\n[[furniture]]\nmodel = \"rigid\"\nkind = " + io::written_text(kind) + "\n",
      origin);
}

}  // namespace

Palette::Palette(render::Stage& stage) : stage_(stage) {
  for (const io::BuiltinScene& kind : io::builtin_furniture()) {
    Card card;
    card.kind = std::string(kind.name);
    cards_.push_back(std::move(card));
  }
}

void Palette::build(Card& card, const std::string& origin) const {
  const io::Scene scene = scene_of(card.kind, origin);
  const RoomPiece piece = pieces_of(scene).at(0);
  const render::SceneFrame frame = start_frame(scene);
  card.shape = shape_of(frame, scene.setup.model, piece);
  card.half = piece.half;
  card.size = piece.size;
  const Vec3 mm = 1e3 * piece.size;
  card.about = fmt::format("{}\n{:.0f} x {:.0f} x {:.0f} mm, {:.4g} kg", fw::in_words(fw::k_kinds, card.kind),
                           mm.x(), mm.y(), mm.z(), piece.mass + piece.contents);
}

bool Palette::update() {
  if (complete()) return false;
  Card& card = cards_[drawn_++];
  if (card.shape.tubes.empty()) build(card, "");
  render::SceneFrame frame;
  add_shape(card.shape, {}, 0, 0, std::nullopt, frame);
  const float side = static_cast<float>(std::max(card.half.x(), card.half.y()));
  frame.grounds.push_back({.centre = {0, 0, 0},
                           .normal = {0, 0, 1},
                           .along = {1, 0, 0},
                           .half_length = 4,
                           .half_width = 4,
                           .is_floor = true});
  frame.bounds_min = {-side, -side, 0};
  frame.bounds_max = {side, side, static_cast<float>(card.size.z())};
  render::Orbit orbit = render::Orbit::fit(render::NamedView::front, frame, 1);
  orbit.sight = k_from;
  orbit.target = {0, 0, frame.bounds_max[2] / 2};
  const float reach = std::hypot(side, frame.bounds_max[2] / 2) + 0.12f;
  orbit.distance = reach / std::tan(render::k_vertical_fov / 2);
  card.picture = stage_.keep(
      stage_.portrait(frame, orbit.camera(1), render::ColourMap::viridis, k_card_picture, k_card_picture));
  return true;
}

const Palette::Card* Palette::card(const std::string& kind) const {
  const auto found = std::ranges::find(cards_, kind, &Card::kind);
  return found == cards_.end() || found->shape.tubes.empty() ? nullptr : &*found;
}

const Palette::Card& Palette::add(const std::string& file, const std::string& origin) {
  Card card;
  card.kind = file;
  build(card, origin);
  std::erase_if(cards_, [&](const Card& one) { return one.kind == file; });
  drawn_ = std::min(drawn_, cards_.size());
  cards_.push_back(std::move(card));
  return cards_.back();
}

std::optional<std::string> Palette::draw(const std::string& armed, const render::OverlayFonts& fonts) const {
  std::optional<std::string> chosen;
  const float line = fonts.small->FontSize, gap = 0.4f * line;
  const float room = ImGui::GetContentRegionAvail().x;
  const int columns = std::max(1, static_cast<int>((room + gap) / (k_least_card / 14 * line + gap)));
  const float width =
      std::floor((room - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns));
  const float height = width + 1.5f * line;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  for (std::size_t i = 0; i < cards_.size(); ++i) {
    const Card& card = cards_[i];
    if (i % static_cast<std::size_t>(columns) != 0) ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos(), end{at.x + width, at.y + height};
    ImGui::PushID(card.kind.c_str());
    const bool pressed = ImGui::InvisibleButton("kind", {width, height});
    ImGui::PopID();
    if (pressed || ImGui::IsItemActivated()) chosen = card.kind;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && !card.about.empty()) ImGui::SetTooltip("%s", card.about.c_str());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, end, ImGui::GetColorU32(hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), 4);
    if (card.picture)
      list.AddImageRounded(card.picture, at, {end.x, at.y + width}, {0, 0}, {1, 1}, IM_COL32_WHITE, 4);
    const std::string name = render::shortened(*fonts.small, fw::in_words(fw::k_kinds, card.kind), width - 4);
    list.AddText(fonts.small, line,
                 {at.x + (width - render::text_width(*fonts.small, name)) / 2, at.y + width + 0.2f * line},
                 ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
    const bool marked = card.kind == armed || (ImGui::IsItemFocused() && ImGui::GetIO().NavVisible);
    list.AddRect(at, end, marked ? IM_COL32(28, 112, 190, 255) : ImGui::GetColorU32(ImGuiCol_Border), 4, 0,
                 marked ? 2.5f : 1);
  }
  ImGui::PopStyleVar();
  return chosen;
}

}  // namespace topple::app
