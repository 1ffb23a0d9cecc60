#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/chart/lane.h"
#include "app/panels/panels.h"
#include "app/picture/anchor_picture.h"
#include "app/picture/annotations.h"
#include "app/picture/row.h"
#include "app/picture/window_words.h"
#include "app/picture/words.h"
#include "solver/body/model_level.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr int k_samples = 12;  // of a small diagram, per element

ImU32 translucent(ImU32 colour) {
  return (colour & ~IM_COL32_A_MASK) | (90u << IM_COL32_A_SHIFT);
}

/// What the inspector is drawn from.
struct Inspected {
  const Player& player;
  const io::FrameRow& row;
  Histories& histories;
  Inspection& inspection;
  const FrameContext now;
  const Model& model;

  double value(const Subject& subject, std::size_t k) const {
    return values_of(subject.kind)[k].at(now, subject.index);
  }
  /// Least and greatest over the run, 0 included.
  std::pair<double, double> run_range(const Subject& subject, std::size_t k) const {
    double least = 0, most = 0;
    for (const float sample : histories.of(player, subject, k))
      if (std::isfinite(sample)) {
        least = std::min<double>(least, sample);
        most = std::max<double>(most, sample);
      }
    return {least, most};
  }
};

bool is_plotted(const Inspection& inspection, const PlottedValue& plot) {
  return std::ranges::find(inspection.plots, plot) != inspection.plots.end();
}

void toggle_plot(Inspection& inspection, const PlottedValue& plot) {
  if (std::erase(inspection.plots, plot) == 0) inspection.plots.push_back(plot);
}

/// A small curve; filled while the value is plotted.
void add_plot_icon(ImDrawList& list, ImVec2 low, float side, bool on, bool hovered) {
  const ImVec2 high{low.x + side, low.y + side};
  if (on || hovered)
    list.AddRectFilled(low, high, on ? theme().line : ImGui::GetColorU32(ImGuiCol_ButtonHovered), 2);
  const auto at = [&](float x, float y) { return ImVec2(low.x + x * side, low.y + y * side); };
  const ImVec2 curve[] = {at(0.15f, 0.75f), at(0.38f, 0.3f), at(0.6f, 0.6f), at(0.85f, 0.2f)};
  list.AddPolyline(curve, 4, on ? theme().sheet : theme().quiet, 0, 1.5f);
}

void draw_plot_button(Inspection& inspection, const PlottedValue& plot) {
  const float side = ImGui::GetTextLineHeight();
  if (ImGui::InvisibleButton("plot", {side, side})) toggle_plot(inspection, plot);
  const bool on = is_plotted(inspection, plot);
  add_plot_icon(*ImGui::GetWindowDrawList(), ImGui::GetItemRectMin(), side, on, ImGui::IsItemHovered());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(on ? k_unplot : k_plot).c_str());
}

void draw_values(const Inspected& at, const Subject& subject, std::size_t count) {
  if (!ImGui::BeginTable("values", 3, ImGuiTableFlags_RowBg)) return;
  const float line = ImGui::GetTextLineHeight();
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 1.3f);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 1);
  ImGui::TableSetupColumn("plot", ImGuiTableColumnFlags_WidthFixed, line);
  const auto values = values_of(subject.kind);
  for (std::size_t k = 0; k < std::min(count, values.size()); ++k) {
    ImGui::PushID(static_cast<int>(k));
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(say(values[k].name).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted((value_text(at.value(subject, k)) + " " + values[k].unit).c_str());
    ImGui::TableNextColumn();
    draw_plot_button(at.inspection, {subject, k});
    ImGui::PopID();
  }
  ImGui::EndTable();
}

/// One component along a member, with its greatest value; chosen: it is the one drawn in the scene. True when
/// it was clicked to be.
bool draw_component(const Inspected& at, const Subject& subject, std::size_t component, bool chosen,
                    ImVec2 size) {
  ImGui::PushID(static_cast<int>(component));
  const bool pressed = ImGui::InvisibleButton("component", size);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), mouse = ImGui::GetIO().MousePos;
  const float line = ImGui::GetTextLineHeight();
  const bool hovered = ImGui::IsItemHovered();
  const bool on_icon = mouse.x > high.x - line - 4 && mouse.y < low.y + line + 4;
  ImGui::PopID();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, theme().sheet, 3);
  list.AddRect(low, high, chosen ? theme().chosen : theme().frame, 3, 0, chosen ? 2.f : 1.f);
  const std::size_t value = k_first_component_value + component;
  add_text(list, low.x + 5, low.y + 3, theme().text,
           fmt::format("{} {} {}", component_name(component), value_text(at.value(subject, value)),
                       component_unit(component)));
  add_plot_icon(list, {high.x - line - 2, low.y + 3}, line, is_plotted(at.inspection, {subject, value}),
                hovered && on_icon);
  if (hovered) ImGui::SetTooltip("%s", say(on_icon ? k_plot : k_draw_along).c_str());

  const Member& member = at.model.members[subject.index];
  const float left = low.x + 8, right = high.x - 8, top = low.y + line + 8, bottom = high.y - 5;
  std::vector<double> ordinates;
  double most = 0;
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
    for (int i = 0; i <= k_samples; ++i) {
      const double xi = 2. * i / k_samples - 1;
      ordinates.push_back(component_of(forces_at(at.model, at.row, e, xi), component));
      most = std::max(most, std::abs(ordinates.back()));
    }
  const float zero = (top + bottom) / 2;
  const auto place = [&](std::size_t i) {
    const std::size_t element = i / (k_samples + 1), step = i % (k_samples + 1);
    const float t = (static_cast<float>(element) + static_cast<float>(step) / k_samples) /
                    static_cast<float>(member.element_count);
    const float y = most > 0 ? static_cast<float>(ordinates[i] / most) * (bottom - top) / 2 : 0;
    return ImVec2(left + t * (right - left), zero - y);
  };
  const ImDrawListFlags flags = list.Flags;
  list.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // else there are seams between the pieces
  for (std::size_t i = 0; i + 1 < ordinates.size(); ++i) {
    const ImVec2 a = place(i), b = place(i + 1);
    const ImU32 colour = ordinates[i] + ordinates[i + 1] >= 0 ? theme().positive : theme().negative;
    if (b.x > a.x) list.AddQuadFilled({a.x, zero}, a, b, {b.x, zero}, translucent(colour));
    list.AddLine(a, b, colour, 1.4f);
  }
  list.Flags = flags;
  list.AddLine({left, zero}, {right, zero}, theme().axis);
  if (pressed && on_icon) toggle_plot(at.inspection, {subject, value});
  return pressed && !on_icon;
}

/// Where elements are integrated, where their stresses are taken, and their hinges.
void draw_integration_points(const Inspected& at, const Member& member) {
  const float line = ImGui::GetTextLineHeight(), r = 0.28f * line;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float left = low.x + 8, width = ImGui::GetContentRegionAvail().x - 16, y = low.y + 0.8f * line;
  const auto x = [&](int element, double xi) {
    return left + width * (static_cast<float>(element) + static_cast<float>(xi + 1) / 2) /
                      static_cast<float>(member.element_count);
  };
  const auto diamond = [&](float px, float py) { list.AddNgonFilled({px, py}, 1.25f * r, theme().line, 4); };
  const auto circle = [&](float px, float py, ImU32 colour) {
    list.AddCircle({px, py}, r, colour, 16, 1.6f);
  };
  list.AddLine({left, y}, {left + width, y}, theme().quiet, 2);
  std::string places;
  for (int k = 0; k < member.element_count; ++k) {
    const std::size_t e = member.first_element + k;
    for (const double end : {-1., 1.}) list.AddCircleFilled({x(k, end), y}, 0.6f * r, theme().quiet);
    places += fmt::format("{}{:+.3f}", k > 0 ? ", " : "", at.row.s[e] + 0.f);
    const std::uint8_t code = at.row.hinge[e];
    if (code == k_broken) {
      list.AddLine({x(k, 0) - r, y - r}, {x(k, 0) + r, y + r}, theme().hinge, 2);
      list.AddLine({x(k, 0) - r, y + r}, {x(k, 0) + r, y - r}, theme().hinge, 2);
      continue;
    }
    diamond(x(k, at.row.s[e]), y);
    circle(x(k, -at.row.s[e]), y, theme().text);
    for (int place = 0; place < 2; ++place)
      if (io::flows_now(code) && has_hinge(static_cast<Hinge>(code), place))
        list.AddCircleFilled({x(k, at.model.elements[e].hinge_place[place]), y}, r, theme().hinge, 16);
  }
  const float words = y + 0.65f * line;
  diamond(left + r, words + line / 2);
  add_text(list, left + 3.2f * r, words, theme().text, say(k_integrated));
  const bool beside = 7.2f * line + 2.2f * r + text_width(say(k_stresses_at)) <= width;
  const float second = beside ? left + 7.2f * line : left + r, below = beside ? words : words + 1.1f * line;
  circle(second, below + line / 2, theme().text);
  add_text(list, second + 2.2f * r, below, theme().text, say(k_stresses_at));
  ImGui::Dummy({width, below + 1.15f * line - low.y});
  text_wrapped(say(k_s_of_elements, places));
}

bool has_value(const std::vector<float>& samples) {
  return std::ranges::any_of(samples, [](float sample) { return std::isfinite(sample); });
}

void draw_history(const Inspected& at, const Subject& subject, std::size_t value) {
  const std::vector<float>& samples = at.histories.of(at.player, subject, value);
  const SubjectValue& what = values_of(subject.kind)[value];
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 4.6f * line;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto [least, most] = at.run_range(subject, value);
  const Lane lane{
      low.x + 6, low.x + width - 6, low.y + line + 8, low.y + height - 5, at.player.length(), least, most};
  list.AddRectFilled(low, {low.x + width, low.y + height}, theme().sheet, 3);
  list.AddRect(low, {low.x + width, low.y + height}, theme().frame, 3);
  add_text(list, low.x + 5, low.y + 3, theme().text,
           say(k_over_run, say(what.name), has_value(samples) ? value_text(std::max(-least, most)) : "-",
               what.unit));
  if (most > least)
    add_curve(
        list, lane, at.player.way(), [&](std::size_t i) { return samples[i]; }, theme().line, k_thick_curve);
  list.AddLine({lane.x(at.player.time()), lane.top}, {lane.x(at.player.time()), lane.bottom}, theme().cursor,
               1.5f);
  ImGui::Dummy({width, height});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_over_run_about).c_str());
}

/// Name, what it is, and a pin. True when the pin was pressed.
bool draw_heading(const Inspected& at, const Subject& subject, bool pinned) {
  ImGui::TextUnformatted(name_of(at.model, subject).c_str());
  const std::string words = say(pinned ? k_unpin : k_pin);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(words.c_str()).x -
                  2 * ImGui::GetStyle().FramePadding.x);
  const bool pressed = ImGui::SmallButton((words + "##pin").c_str());
  if (ImGui::IsItemHovered() && !pinned) ImGui::SetTooltip("%s", say(k_pin_about).c_str());
  bool first = true;
  for (const std::string& line : about(at.now, subject)) {
    ImGui::PushStyleColor(
        ImGuiCol_Text,
        ImGui::GetColorU32(std::exchange(first, false) ? ImGuiCol_TextDisabled : ImGuiCol_Text));
    text_wrapped(line);
    ImGui::PopStyleColor();
  }
  return pressed;
}

/// True when another component is to be drawn in the scene.
bool draw_member(const Inspected& at, const Subject& subject) {
  draw_values(at, subject, k_first_component_value);
  if (is_approximate(at.model, at.row, subject.index)) text_wrapped(say(k_approximate));
  const std::size_t drawn = component_of(at.model, at.row, {subject.index, at.inspection.component});
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{(ImGui::GetContentRegionAvail().x - gap) / 2, 4.3f * ImGui::GetTextLineHeight()};
  bool changed = false;
  for (std::size_t component = 0; component < k_components; ++component) {
    if (draw_component(at, subject, component, component == drawn, size)) {
      at.inspection.component = component;
      changed = true;
    }
    if (component % 2 == 0) ImGui::SameLine();
  }
  draw_history(at, subject, k_stress_value);
  draw_integration_points(at, at.model.members[subject.index]);
  return changed;
}

}  // namespace

bool draw_inspector(const Player& player, const io::FrameRow& row, Histories& histories,
                    Inspection& inspection) {
  const Model& model = player.scene().setup.model;
  const Inspected at{player, row, histories, inspection, frame_context(player, row), model};
  bool changed = false;
  ImGui::BeginChild("inspector");
  if (inspection.picked) {
    const Subject subject = *inspection.picked;
    const bool pinned = std::ranges::find(inspection.pinned, subject) != inspection.pinned.end();
    if (draw_heading(at, subject, pinned)) {
      if (std::erase(inspection.pinned, subject) == 0) inspection.pinned.push_back(subject);
    }
    if (subject.kind == Subject::Kind::member) {
      changed = draw_member(at, subject);
      const std::size_t body = body_of(model, subject);
      if (ImGui::Button((say(k_all_of, model.bodies[body].name) + "##body").c_str())) {
        inspection.picked = Subject{Subject::Kind::body, body};
        changed = true;
      }
    } else {
      draw_values(at, subject, values_of(subject.kind).size());
      draw_history(at, subject, 0);
    }
  } else {
    text_wrapped(say(k_how_to_inspect));
    for (std::size_t b = 0; b < static_cast<std::size_t>(model.furniture_total()); ++b)
      if (ImGui::Selectable(model.bodies[b].name.c_str())) {
        inspection.picked = Subject{Subject::Kind::body, b};
        changed = true;
      }
  }
  std::size_t unpinned = inspection.pinned.size();
  for (std::size_t i = 0; i < inspection.pinned.size(); ++i) {
    if (inspection.pinned[i] == inspection.picked) continue;
    ImGui::Separator();
    ImGui::PushID(static_cast<int>(i));
    if (draw_heading(at, inspection.pinned[i], true)) unpinned = i;
    draw_values(at, inspection.pinned[i], values_of(inspection.pinned[i].kind).size());
    ImGui::PopID();
  }
  if (unpinned < inspection.pinned.size())
    inspection.pinned.erase(inspection.pinned.begin() + static_cast<std::ptrdiff_t>(unpinned));
  const std::vector<std::string>& ways = inspection.ways.of(player, row);
  if (!ways.empty()) ImGui::Separator();
  for (const std::string& line : ways) text_wrapped(line);
  ImGui::EndChild();
  return changed;
}

}  // namespace topple::app
