#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/body_colour.h"
#include "app/lane.h"
#include "app/panels.h"
#include "app/window_words.h"
#include "app/words.h"
#include "render/overlay.h"
#include "solver/io/edit_text.h"
#include "solver/ladder.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr double k_degrees = 180 / k_pi;
constexpr double k_tilt_room = 1.35;  // tilts beyond this share of the critical angle leave the lane
constexpr double k_least_gal = 10, k_least_tilt = 1;

ImU32 line_colour(std::size_t body) {
  const auto& [red, green, blue] = body_colour(body);
  return IM_COL32(red, green, blue, 255);
}

using Value = std::function<double(const io::FrameRow&)>;

void add_curve(ImDrawList& list, const Lane& lane, const std::vector<RowPtr>& rows, const Value& value,
               ImU32 colour, float thickness) {
  add_curve(
      list, lane, rows, [&](std::size_t i) { return value(*rows[i]); }, colour, thickness);
}

double peak(const std::vector<RowPtr>& rows, const Value& value) {
  double most = 0;
  for (const RowPtr& row : rows) most = std::max(most, std::abs(value(*row)));
  return most;
}

void add_acceleration(ImDrawList& list, Lane lane, const std::vector<RowPtr>& rows, float label_left) {
  const auto component = [](int k) {
    return [k](const io::FrameRow& row) { return row.floor_acceleration[k] / k_gal; };
  };
  double most = k_least_gal;
  for (int k = 0; k < 3; ++k) most = std::max(most, 1.08 * peak(rows, component(k)));
  lane.low = -most;
  lane.high = most;
  list.AddLine({lane.left, lane.y(0)}, {lane.right, lane.y(0)}, theme().faint);
  std::string moving;
  for (int k = 0; k < 3; ++k) {
    if (!rows.empty() && peak(rows, component(k)) == 0) continue;
    add_curve(list, lane, rows, component(k), theme().floor[k], 1.3f);
    moving += (moving.empty() ? "" : ", ") + std::string(1, "xyz"[k]);
  }
  const float line = ImGui::GetTextLineHeight();
  add_text(list, label_left, lane.top, theme().text, say(k_floor_lane));
  if (!moving.empty()) add_text(list, label_left, lane.top + line, theme().text, moving);
  const std::string top = fmt::format("{:.0f}", most);
  add_text(list, lane.left - text_width(top) - 6, lane.top - 2, theme().text, top);
}

void add_load_factor(ImDrawList& list, Lane lane, const std::vector<RowPtr>& rows, float label_left) {
  const auto factor = [](const io::FrameRow& row) { return row.load_factor; };
  double least = 0, greatest = 0;
  for (const RowPtr& row : rows) {
    least = std::min(least, row->load_factor);
    greatest = std::max(greatest, row->load_factor);
  }
  lane.low = 1.08 * least;
  lane.high = greatest > least ? 1.08 * greatest : 1;
  list.AddLine({lane.left, lane.y(0)}, {lane.right, lane.y(0)}, theme().faint);
  add_curve(list, lane, rows, factor, theme().floor[0], 1.3f);
  add_text(list, label_left, lane.top, theme().text, say(k_load_factor));
  add_text(list, label_left, lane.top + ImGui::GetTextLineHeight(), theme().text, say(k_up_to, greatest));
}

void add_tilts(ImDrawList& list, Lane lane, const Player& player, float label_left) {
  const std::vector<RowPtr>& rows = player.way();
  const auto& bodies = player.scene().setup.model.bodies;
  const auto tilt = [](std::size_t b) {
    return [b](const io::FrameRow& row) { return row.body[11 * b + 7] * k_degrees; };
  };
  double critical = 0, most = k_least_tilt;
  const auto furniture = static_cast<std::size_t>(player.scene().setup.model.furniture_total());
  for (std::size_t b = 0; b < furniture; ++b) {
    if (!rows.empty()) critical = std::max(critical, rows.back()->body[11 * b + 10] * k_degrees);
    most = std::max(most, 1.1 * peak(rows, tilt(b)));
  }
  lane.low = 0;
  lane.high = critical > 0 ? k_tilt_room * critical : most;
  list.AddLine({lane.left, lane.bottom}, {lane.right, lane.bottom}, theme().axis);
  if (critical > 0) {
    for (float x = lane.left; x < lane.right; x += 9)
      list.AddLine({x, lane.y(critical)}, {std::min(x + 5, lane.right), lane.y(critical)}, theme().axis);
    const std::string label = fmt::format("{:.1f}°", critical);
    add_text(list, lane.left - text_width(label) - 6, lane.y(critical) - ImGui::GetTextLineHeight() / 2,
             theme().text, label);
  }
  for (std::size_t b = 0; b < furniture; ++b) {
    add_curve(list, lane, player.ghost_way(), tilt(b), theme().ghost, 1);
    add_curve(list, lane, rows, tilt(b), line_colour(b), 1.6f);
  }
  const float line = ImGui::GetTextLineHeight();
  float y = lane.top - 2;
  add_text(list, label_left, y, theme().text, say(k_tilt_lane));
  for (std::size_t b = 0; b < furniture && y + 2 * line < lane.bottom + line; ++b) {
    y += line;
    list.AddRectFilled({label_left, y + line / 2 - 1.5f}, {label_left + 10, y + line / 2 + 1.5f},
                       line_colour(b));
    add_text(list, label_left + 14, y, theme().text, bodies[b].name);
  }
}

/// When, of a step that has a row in a static run.
std::string when(const Player& player, std::int64_t step, double time) {
  if (!is_static(player.scene().setup)) return fmt::format("{:.3f} s", time);
  const auto at = std::find_if(player.way().begin(), player.way().end(),
                               [step](const RowPtr& row) { return row->step == step; });
  return at == player.way().end() ? say(k_load_step_number, step)
                                  : instant_in_words(player.scene().setup, **at);
}

std::string event_text(const Player& player, const io::RecordedEvent& event) {
  if (event.event.kind == Event::Kind::anchor) {
    const Anchor& anchor = player.scene().setup.model.anchors[static_cast<std::size_t>(event.event.anchor)];
    return say(k_anchor_breaks, when(player, event.step, event.time), anchor.name,
               std::abs(event.event.value));
  }
  const Phrase& what = event.event.kind == Event::Kind::uplift     ? k_lifts
                       : event.event.kind == Event::Kind::impact   ? k_strikes
                       : event.event.kind == Event::Kind::hinge    ? k_hinges
                       : event.event.kind == Event::Kind::fracture ? k_breaks
                                                                   : k_passes;
  const std::string words =
      event.event.kind == Event::Kind::model
          ? say(k_computed_as, say(k_rungs[static_cast<std::size_t>(event.event.value)]),
                say(k_rung_reasons[static_cast<std::size_t>(event.event.reason)]))
          : say(what);
  const Model& model = player.scene().setup.model;
  return say(k_event, when(player, event.step, event.time),
             model.bodies[static_cast<std::size_t>(event.event.body)].name, words);
}

std::string edit_text(const Player& player, const LoggedEdit& edit) {
  const io::Key& key = io::key_of(edit.edit.key);
  const Vec3& v = edit.edit.value;
  const std::string value =
      edit.edit.key == Edit::Key::direction ? fmt::format("[{:.3g}, {:.3g}, {:.3g}]", v.x(), v.y(), v.z())
      : key.type == io::KeyType::boolean
          ? std::string(v.x() != 0 ? "true" : "false")
          : fmt::format("{:.4g} {}", v.x() / io::unit_value(key.unit, key.dimension), key.unit);
  return say(k_edited, when(player, edit.step, edit.time), io::edit_key(edit.edit), value);
}

/// Marks along the top of the tilt lane; the one under the mouse says what it is.
void add_marks(ImDrawList& list, const Lane& lane, const Player& player) {
  constexpr float k_size = 4;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  std::string hovered;
  const auto mark = [&](double time, float y, const std::function<std::string()>& text, auto shape) {
    const float x = lane.x(time);
    if (x < lane.left || x > lane.right) return;
    shape(ImVec2(x, y));
    if (std::abs(mouse.x - x) < k_size && std::abs(mouse.y - y) < 2 * k_size) hovered = text();
  };
  const float y = lane.bottom + k_size + 2;
  for (const io::RecordedEvent& event : player.events()) {
    const ImU32 colour = line_colour(static_cast<std::size_t>(event.event.body));
    mark(
        event.time, y, [&] { return event_text(player, event); },
        [&](ImVec2 p) {
          if (event.event.kind == Event::Kind::uplift)
            list.AddTriangleFilled({p.x - k_size, p.y + k_size}, {p.x, p.y - k_size},
                                   {p.x + k_size, p.y + k_size}, colour);
          else if (event.event.kind == Event::Kind::impact)
            list.AddLine({p.x, p.y - k_size}, {p.x, p.y + k_size}, colour, 2);
          else if (event.event.kind == Event::Kind::hinge)
            list.AddCircle(p, k_size, colour, 12, 1.5f);
          else if (event.event.kind == Event::Kind::fracture || event.event.kind == Event::Kind::anchor) {
            list.AddLine({p.x - k_size, p.y - k_size}, {p.x + k_size, p.y + k_size}, colour, 1.5f);
            list.AddLine({p.x - k_size, p.y + k_size}, {p.x + k_size, p.y - k_size}, colour, 1.5f);
          } else if (event.event.kind == Event::Kind::model)
            list.AddRect({p.x - k_size, p.y - k_size}, {p.x + k_size, p.y + k_size}, colour);
          else
            list.AddRectFilled({p.x - k_size, p.y - k_size}, {p.x + k_size, p.y + k_size}, colour);
        });
  }
  for (const LoggedEdit& edit : player.edits())
    mark(
        edit.time, lane.top, [&] { return edit_text(player, edit); },
        [&](ImVec2 p) { list.AddNgonFilled(p, k_size, theme().edit, 4); });
  if (player.way().empty()) return;
  for (const Stretch& stretch : player.history().way_to(player.shown_branch()))
    for (const Branch& branch : player.history().branches) {
      if (branch.id != stretch.branch || branch.parent < 0 || branch.fork_step == 0) continue;
      const auto at = std::find_if(player.way().begin(), player.way().end(),
                                   [&](const RowPtr& row) { return row->branch == branch.id; });
      if (at == player.way().end()) continue;
      const float x = lane.x((*at)->time);
      list.AddLine({x, lane.top}, {x, lane.bottom}, theme().axis);
    }
  if (!hovered.empty()) ImGui::SetTooltip("%s", hovered.c_str());
}

}  // namespace

void draw_timeline(Player& player, const Box& box) {
  begin_panel("timeline", box);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  const float label_left = box.left + 10;
  Lane lane{box.left + 7.5f * line,
            box.left + box.width - 12,
            box.top + 8,
            box.top + box.height - line - 14,
            player.length(),
            0,
            1};
  const float height = lane.bottom - lane.top;
  Lane upper = lane, lower = lane;
  upper.bottom = lane.top + 0.4f * height;
  lower.top = lane.top + 0.46f * height;
  if (is_static(player.scene().setup))
    add_load_factor(list, upper, player.way(), label_left);
  else
    add_acceleration(list, upper, player.way(), label_left);
  add_tilts(list, lower, player, label_left);
  add_axis(list, lower, player.scene().setup, label_left);

  const float x = lane.x(player.time());
  list.AddLine({x, lane.top}, {x, lane.bottom}, theme().cursor, 1.5f);
  list.AddTriangleFilled({x - 5, lane.top - 5}, {x + 5, lane.top - 5}, {x, lane.top + 3}, theme().cursor);
  ImGui::SetCursorScreenPos({lane.left, lane.top});
  ImGui::InvisibleButton("scrub", {lane.right - lane.left, height + line});
  if (ImGui::IsItemActive())
    player.scrub((ImGui::GetIO().MousePos.x - lane.left) / (lane.right - lane.left) * player.length());
  add_marks(list, lower, player);
  ImGui::End();
}

}  // namespace topple::app
