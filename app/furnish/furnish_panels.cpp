#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "app/chart/theme.h"
#include "app/furnish/furnish_view.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "render/scene/text_layout.h"
#include "solver/io/common/units.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/fixing_kinds.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;
namespace sw = window_words;

constexpr std::array k_materials{"aluminium", "plastic", "stainless steel", "steel", "wood"};
constexpr float k_label_share = 0.46f;  // of the width of the panel

void fill_field(char* to, std::size_t size, const std::string& text) {
  const std::size_t length = std::min(text.size(), size - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

void field_label(const std::string& words) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(words.c_str());
  ImGui::SameLine(k_label_share * ImGui::GetWindowContentRegionMax().x);
  ImGui::SetNextItemWidth(-2.2f * ImGui::GetFrameHeight());
}

/// Takes a value away; true when it was pressed.
bool small_x(const char* id, const Phrase& about) {
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 1.3f * ImGui::GetFrameHeight());
  const bool pressed = ImGui::Button((std::string("x##") + id).c_str(), {1.3f * ImGui::GetFrameHeight(), 0});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(about).c_str());
  return pressed;
}

bool room_button(const Phrase& name, const Phrase& about, bool enabled, bool chosen = false) {
  const float width = ImGui::CalcTextSize(say(name).c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (ImGui::GetCursorPosX() + width > ImGui::GetWindowContentRegionMax().x) ImGui::NewLine();
  ImGui::BeginDisabled(!enabled);
  if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool pressed = ImGui::Button(say(name).c_str());
  if (chosen) ImGui::PopStyleColor();
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", say(about).c_str());
  ImGui::SameLine();
  return pressed;
}

}  // namespace

void FurnishView::draw_side(const render::OverlayFonts& fonts) {
  begin_panel("side", side_);
  static constexpr std::pair<Phrase, Tab> k_tabs_of_room[] = {
      {fw::k_tab_kinds, Tab::kinds}, {fw::k_tab_piece, Tab::piece}, {fw::k_tab_room, Tab::room}};
  for (const auto& [name, tab] : k_tabs_of_room)
    if (room_button(name, name, true, tab == tab_)) tab_ = tab;
  ImGui::NewLine();
  ImGui::Separator();
  ImGui::BeginChild("content", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  if (tab_ == Tab::kinds)
    draw_kinds(fonts);
  else if (tab_ == Tab::piece)
    draw_piece();
  else
    draw_room();
  ImGui::EndChild();
  ImGui::End();
}

void FurnishView::draw_kinds(const render::OverlayFonts& fonts) {
  if (const auto kind = palette_.draw(tool_.kind == Tool::Kind::place ? tool_.word : "", fonts)) {
    arm_kind(*kind);
    from_card_ = true;
  }
  ImGui::Dummy({0, 4});
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::InputTextWithHint("##own", say(fw::k_own_kind).c_str(), own_kind_, sizeof own_kind_,
                                ImGuiInputTextFlags_EnterReturnsTrue))
    return;
  try {
    const std::string file = own_kind_;
    palette_.add(file.ends_with(".toml") ? file : file + ".toml", origin_);
    arm_kind(palette_.cards().back().kind);
  } catch (const io::InputError& error) {
    room_.refuse(error.what());
  }
}

bool FurnishView::number_field(const std::string& words, double value, const char* format, double& changed) {
  field_label(words);
  double now = value;
  ImGui::PushID(words.c_str());
  // who leaves a field by a click may leave it with the value from before
  if (ImGui::InputDouble("##value", &now, 0, 0, format)) typed_ = now;
  ImGui::PopID();
  if (ImGui::IsItemActivated()) typed_.reset();
  if (!ImGui::IsItemDeactivated()) return false;
  now = std::exchange(typed_, std::nullopt).value_or(value);
  if (now == value || !std::isfinite(now)) return false;
  changed = now;
  return true;
}

void FurnishView::draw_piece() {
  const RoomPiece* const found = selected_piece();
  if (!found) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(say(fw::k_nothing_selected).c_str());
    ImGui::PopTextWrapPos();
    return;
  }
  const RoomPiece piece = *found;
  if (named_ != piece.name) fill_field(name_, sizeof name_, named_ = piece.name);
  if (!piece.kind.empty()) ImGui::TextDisabled("%s", fw::in_words(fw::k_kinds, piece.kind).c_str());
  field_label(say(fw::k_name));
  ImGui::InputText("##name", name_, sizeof name_);
  if (ImGui::IsItemDeactivatedAfterEdit() && named_ != name_) {
    const std::string name = name_;
    if (change([piece, name](const io::Scene& scene) { return with_name(scene, piece, name); }))
      selected_ = named_ = name;
    else
      fill_field(name_, sizeof name_, named_);
  }
  const auto stand = [&](const Spot& there) {
    change([piece, there](const io::Scene& scene) { return with_moved(scene, piece, there); });
  };
  const Spot spot = ghost_ && ghost_->name == piece.name ? ghost_->spot : piece.spot;
  double now = 0;
  if (number_field(say(fw::k_x), spot.at.x(), "%.3f", now)) stand({{now, spot.at.y()}, spot.yaw});
  if (number_field(say(fw::k_y), spot.at.y(), "%.3f", now)) stand({{spot.at.x(), now}, spot.yaw});
  if (number_field(say(fw::k_turned), spot.yaw * 180 / k_pi, "%.1f", now))
    stand({spot.at, std::remainder(now * k_pi / 180, 2 * k_pi)});
  ImGui::Separator();
  if (piece.table == "furniture") {
    draw_piece_numbers(piece);
  } else {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", say(fw::k_in_file).c_str());
    ImGui::PopTextWrapPos();
  }
}

void FurnishView::draw_piece_numbers(const RoomPiece& piece) {
  const auto set = [&](const std::string& key, const std::optional<std::string>& value) {
    change([piece, key, value](const io::Scene& scene) { return with_value(scene, piece, key, value); });
  };
  const io::Node root = io::parse_toml(room_.text(), origin_);
  const io::Node& entry = root.find(piece.table)->items.at(piece.number - 1).value;
  const io::Node* const contents = entry.find("contents");
  const auto reset = [&](const char* key, bool written) {
    if (written && small_x(key, fw::k_reset_about)) set(key, std::nullopt);
  };
  double now = 0;
  const std::pair<Phrase, int> sides[] = {{fw::k_depth, 0}, {fw::k_width, 1}, {fw::k_height, 2}};
  for (const auto& [words, axis] : sides) {
    if (number_field(say(words), 1e3 * piece.size[axis], "%.0f", now)) {
      Vec3 size = piece.size;
      size[axis] = now / 1e3;
      set("size",
          "[" + length_text(size.x()) + ", " + length_text(size.y()) + ", " + length_text(size.z()) + "]");
    }
    if (axis == 0) reset("size", entry.find("size"));
  }
  const auto kilograms = [](double kg) { return fmt::format("\"{:g} kg\"", kg); };
  if (number_field(say(fw::k_mass), piece.mass, "%.4g", now)) set("mass", kilograms(now));
  reset("mass", entry.find("mass"));
  if (number_field(say(fw::k_contents), piece.contents, "%.4g", now)) set("contents.mass", kilograms(now));
  reset("contents.mass", contents && contents->find("mass"));
  const io::Node* const friction = entry.find("friction");
  const double present =
      friction && friction->is_number() ? friction->real : room_.scene().setup.parameters.contact.friction;
  if (number_field(say(fw::k_feet_friction), present, "%.2f", now)) set("friction", fmt::format("{:g}", now));
  reset("friction", friction);
  if (piece.becomes == "cabinet") {
    field_label(say(fw::k_material));
    const io::Node* const material = entry.find("material");
    if (ImGui::BeginCombo("##material", material ? material->text.c_str() : say(fw::k_of_kind).c_str())) {
      for (const char* const one : k_materials)
        if (ImGui::Selectable(one, material && material->text == one)) set("material", io::written_text(one));
      ImGui::EndCombo();
    }
    reset("material", material);
  }
  const auto copies = std::ranges::count_if(room_.pieces(), [&](const RoomPiece& other) {
    return other.table == piece.table && other.number == piece.number;
  });
  if (copies > 1) ImGui::TextDisabled("%s", say(fw::k_all_copies, copies).c_str());
}

void FurnishView::draw_room() {
  draw_walls();
  ImGui::Dummy({0, 6});
  draw_fixings();
  ImGui::Dummy({0, 6});
  draw_way_out();
}

void FurnishView::draw_walls() {
  ImGui::TextUnformatted(say(fw::k_walls).c_str());
  ImGui::Separator();
  std::string removed;
  for (const Plane& plane : room_.scene().setup.model.planes) {
    if (plane.name == "floor") continue;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(plane.name.c_str());
    if (small_x(plane.name.c_str(), fw::k_remove_about)) removed = plane.name;
  }
  if (!removed.empty()) {
    const auto held = [&] {
      const Setup& setup = room_.scene().setup;
      return setup.model.anchors.size() + setup.room.doors.size();
    };
    const std::size_t before = held();
    if (change([removed](const io::Scene& scene) { return without_wall(scene, removed); }) && held() < before)
      show_message(say(fw::k_fixings_went, removed));
  }
  if (room_button(fw::k_add_wall, fw::k_add_wall, true, tool_.kind == Tool::Kind::wall)) arm_wall();
  ImGui::NewLine();
  const io::Node root = io::parse_toml(room_.text(), origin_);
  const io::Node* const ceiling = root.find("ceiling");
  const io::Node* const at = ceiling ? ceiling->find("at") : nullptr;
  const double height = !at ? k_usual_ceiling
                        : at->is_number()
                            ? at->real
                            : io::parse_quantity(at->text, io::Dimension::length).si.value_or(0);
  bool there = at != nullptr;
  if (ImGui::Checkbox("##ceiling", &there))
    change([there](const io::Scene& scene) {
      return with_ceiling(scene, there ? std::optional(k_usual_ceiling) : std::nullopt);
    });
  ImGui::SameLine();
  double now = 0;
  if (number_field(say(fw::k_ceiling), height, "%.2f", now))
    change([now](const io::Scene& scene) { return with_ceiling(scene, now); });
}

void FurnishView::draw_fixings() {
  ImGui::TextUnformatted(say(fw::k_fixings).c_str());
  ImGui::Separator();
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", say(fw::k_fixings_about).c_str());
  ImGui::PopTextWrapPos();
  for (const Phrase& kind : fw::k_fixing_kinds)
    if (room_button(kind, kind, true, tool_.kind == Tool::Kind::fixing && tool_.word == kind.english))
      arm_fixing(std::string(kind.english));
  ImGui::NewLine();
  const io::Node root = io::parse_toml(room_.text(), origin_);
  const io::Node* const fixings = root.find("fixing");
  std::size_t removed = 0;
  for (std::size_t k = 0; fixings && k < fixings->items.size(); ++k) {
    const io::Node& one = fixings->items[k].value;
    ImGui::AlignTextToFramePadding();
    const io::Node* const on = one.find("on");
    const bool in_place = on == nullptr || on->boolean;
    const std::string words = say(in_place ? fw::k_fixing_line : fw::k_fixing_off_line,
                                  fw::in_words(fw::k_fixing_kinds, one.find("kind")->text),
                                  one.find("body")->text, one.find("to")->text);
    const float room = ImGui::GetContentRegionAvail().x - 1.6f * ImGui::GetFrameHeight();
    ImGui::TextUnformatted(render::shortened(*ImGui::GetFont(), words, room).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", words.c_str());
    if (small_x(std::to_string(k).c_str(), fw::k_remove_about)) removed = k + 1;
  }
  if (removed > 0)
    change([removed](const io::Scene& scene) { return without_entry(scene, "fixing", removed); });
}

void FurnishView::draw_way_out() {
  ImGui::TextUnformatted(say(fw::k_way_out).c_str());
  ImGui::Separator();
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", say(fw::k_way_out_about).c_str());
  ImGui::PopTextWrapPos();
  if (room_button(fw::k_add_door, fw::k_hint_door, true, tool_.kind == Tool::Kind::door)) arm_door();
  if (room_button(fw::k_add_person, fw::k_hint_person, true, tool_.kind == Tool::Kind::person)) arm_person();
  ImGui::NewLine();
  const Room& room = room_.scene().setup.room;
  std::string table;
  std::size_t removed = 0;
  const auto remover = [&](const char* of, std::size_t k) {
    if (!small_x(fmt::format("{} {}", of, k).c_str(), fw::k_remove_about)) return;
    table = of;
    removed = k + 1;
  };
  double now = 0;
  for (std::size_t k = 0; k < room.doors.size(); ++k) {
    if (number_field(say(fw::k_door_width, room.doors[k].name), 1e3 * room.doors[k].width, "%.0f", now)) {
      change([number = k + 1, width = now / 1e3](const io::Scene& scene) {
        return with_door_width(scene, number, width);
      });
      return;
    }
    remover("door", k);
  }
  for (std::size_t k = 0; k < room.places.size(); ++k) {
    const Room::Place& place = room.places[k];
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(say(fw::k_person_line, place.name, place.at.x(), place.at.y()).c_str());
    remover("place", k);
  }
  if (removed > 0)
    change([table, removed](const io::Scene& scene) { return without_entry(scene, table, removed); });
}

void FurnishView::draw_bar() {
  begin_panel("transport", bar_);
  ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  if (room_button(fw::k_shake_it, fw::k_shake_it_about, true)) asked_ = ShellRequest::shake;
  ImGui::PopStyleColor();
  const auto step = [&](void (Furnishing::*way)()) {
    let_go();
    (room_.*way)();
    room_changed_ = true;
  };
  if (room_button(sw::k_undo, fw::k_undo_furnish, room_.can_undo())) step(&Furnishing::undo);
  if (room_button(sw::k_redo, fw::k_redo_furnish, room_.can_redo())) step(&Furnishing::redo);
  if (room_button(fw::k_new_room, fw::k_new_room_about, true)) begin_new_room();
  if (room_button(sw::k_scenes, sw::k_scenes_about, true)) asked_ = ShellRequest::scenes;
  if (room_button(sw::k_save, sw::k_save_about, true)) asked_ = ShellRequest::save;
  if (room_button(fw::k_back, fw::k_back_about, true)) asked_ = ShellRequest::furnish;
  bar_height_ = ImGui::GetCursorPosY() + ImGui::GetFrameHeight() + ImGui::GetStyle().WindowPadding.y;
  ImGui::End();
}

namespace {

// What a fixing of this kind may lead to, but for the ceiling.
std::string fixing_targets(const std::string& kind) {
  const io::FixingTraits& fixing = *std::ranges::find(io::k_fixings, kind, &io::FixingTraits::word);
  std::string targets;
  for (const auto& [may, words] :
       {std::pair(fixing.to_wall, &fw::k_hint_to_wall), std::pair(fixing.to_floor, &fw::k_hint_to_floor),
        std::pair(fixing.to_body, &fw::k_hint_to_piece)})
    if (may) targets = targets.empty() ? say(*words) : say(fw::k_hint_or, targets, say(*words));
  return targets;
}

}  // namespace

std::string FurnishView::hint() const {
  switch (tool_.kind) {
    case Tool::Kind::place:
      return say(fw::k_hint_place, fw::in_words(fw::k_kinds, tool_.word));
    case Tool::Kind::wall:
      return say(tool_.from ? fw::k_hint_wall_to : fw::k_hint_wall_from);
    case Tool::Kind::door:
      return say(fw::k_hint_door);
    case Tool::Kind::person:
      return say(fw::k_hint_person);
    case Tool::Kind::fixing: {
      const std::string kind = fw::in_words(fw::k_fixing_kinds, tool_.word);
      return tool_.body.empty() ? say(fw::k_hint_fixing_from, kind)
                                : say(fw::k_hint_fixing_to, kind, tool_.body, fixing_targets(tool_.word));
    }
    case Tool::Kind::select:
      break;
  }
  return selected_.empty() ? say(fw::k_hint_select) : say(fw::k_hint_selected, selected_);
}

void FurnishView::draw_status() {
  begin_panel("status", status_);
  const std::string& refused = room_.refused();
  const std::string words = !refused.empty()    ? say(sw::k_refused, refused)
                            : !message_.empty() ? message_
                                                : hint();
  const std::string keys = say(sw::k_f1);
  const float right = ImGui::CalcTextSize(keys.c_str()).x + 2 * ImGui::GetStyle().ItemSpacing.x;
  ImGui::PushStyleColor(ImGuiCol_Text, refused.empty() ? theme().text : theme().positive);
  ImGui::BeginGroup();
  for (const std::string& line :
       render::wrapped(*ImGui::GetFont(), words, ImGui::GetContentRegionAvail().x - right, 2))
    ImGui::TextUnformatted(line.c_str());
  ImGui::EndGroup();
  ImGui::PopStyleColor();
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(keys.c_str()).x);
  ImGui::TextDisabled("%s", keys.c_str());
  ImGui::End();
}

}  // namespace topple::app
