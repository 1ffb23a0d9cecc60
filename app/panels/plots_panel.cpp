#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/chart/lane.h"
#include "app/panels/panels.h"
#include "app/picture/window_words.h"
#include "app/support/terms.h"
#include "render/scene/text_layout.h"

namespace topple::app {
namespace {

constexpr float k_labels = 7.5f;  // lines of text, as wide as those of the timeline
constexpr float k_lane = 4.2f;    // likewise, high
constexpr float k_gap = 0.5f;

void draw_lane(ImDrawList& list, const Player& player, Histories& histories, const PlottedValue& plot,
               Lane lane, float label_left) {
  const std::vector<float>& samples = histories.of(player, plot.subject, plot.value);
  const SubjectValue& value = values_of(plot.subject.kind)[plot.value];
  const float line = ImGui::GetTextLineHeight();
  double least = 0, greatest = 0;
  for (const float sample : samples)
    if (std::isfinite(sample)) {
      least = std::min<double>(least, sample);
      greatest = std::max<double>(greatest, sample);
    }
  const double room = greatest > least ? 0.04 * (greatest - least) : 1;
  lane.low = least < 0 ? least - room : 0;
  lane.high = greatest > 0 || least == 0 ? greatest + room : 0;
  list.AddRectFilled({lane.left, lane.top}, {lane.right, lane.bottom}, theme().sheet);
  list.AddLine({lane.left, lane.y(0)}, {lane.right, lane.y(0)}, theme().faint);
  add_curve(
      list, lane, player.way(), [&](std::size_t i) { return samples[i]; }, theme().line, k_thick_curve);
  if (greatest > 0) add_text(list, lane.left + 4, lane.top + 1, theme().quiet, value_text(greatest));
  if (least < 0) add_text(list, lane.left + 4, lane.bottom - line - 1, theme().quiet, value_text(least));

  const auto row = player.row();
  const ImFont& font = *ImGui::GetFont();
  const float width = lane.left - 6 - label_left;
  const std::string now =
      row ? value_text(value.at(frame_context(player, *row), plot.subject.index)) + " " + value.unit : "";
  float y = lane.top;
  for (const std::string& words : {name_of(player.scene().setup.model, plot.subject), say(value.name), now}) {
    add_text(list, label_left, y, theme().text, render::shortened(font, words, width));
    y += 1.15f * line;
  }
  const float x = lane.x(player.time());
  list.AddLine({x, lane.top}, {x, lane.bottom}, theme().cursor, 1.5f);
}

/// Of the first plot, in a box without a heading.
Lane first_lane(const Player& player, const Box& box) {
  const float line = ImGui::GetTextLineHeight();
  return {box.left + k_labels * line,
          box.left + box.width - 1.2f * ImGui::GetStyle().WindowPadding.x,
          box.top,
          box.top + k_lane * line,
          player.length(),
          0,
          1};
}

}  // namespace

float plots_height(const Inspection& inspection) {
  return static_cast<float>(inspection.plots.size()) * (k_lane + k_gap);
}

void draw_plot_lanes(ImDrawList& list, const Player& player, Histories& histories,
                     const Inspection& inspection, const Box& box) {
  Lane lane = first_lane(player, box);
  const float step = (k_lane + k_gap) * ImGui::GetTextLineHeight(),
              label_left = box.left + ImGui::GetStyle().WindowPadding.x;
  for (const PlottedValue& plot : inspection.plots) {
    draw_lane(list, player, histories, plot, lane, label_left);
    lane.top += step;
    lane.bottom += step;
  }
  lane.bottom -= step;
  add_axis(list, lane, player.scene().setup, label_left);
}

PlotRequest draw_plots(Player& player, Histories& histories, Inspection& inspection, const Box& box) {
  PlotRequest request = PlotRequest::none;
  begin_panel("plots", box);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(window_words::k_plots).c_str());
  ImGui::SameLine(k_labels * ImGui::GetTextLineHeight());
  if (ImGui::Button("CSV")) request = PlotRequest::csv;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(window_words::k_csv_about).c_str());
  ImGui::SameLine();
  if (ImGui::Button("PNG")) request = PlotRequest::png;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(window_words::k_png_about).c_str());
  ImGui::SameLine();
  if (ImGui::Button((say(window_words::k_close_all) + "##close").c_str())) inspection.plots.clear();
  ImGui::BeginChild("lanes");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight(), step = (k_lane + k_gap) * line;
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  Lane lane = first_lane(player, {box.left, origin.y, box.width, 0});
  lane.right = std::min(lane.right, origin.x + ImGui::GetContentRegionAvail().x);  // left of a scroll bar
  std::size_t closed = inspection.plots.size();
  for (std::size_t i = 0; i < inspection.plots.size(); ++i) {
    draw_lane(list, player, histories, inspection.plots[i], lane,
              box.left + ImGui::GetStyle().WindowPadding.x);
    ImGui::PushID(static_cast<int>(i));
    const float side = 1.2f * line;
    ImGui::SetCursorScreenPos({lane.left, lane.top});
    ImGui::InvisibleButton("scrub", {lane.right - lane.left - side, lane.bottom - lane.top});
    if (ImGui::IsItemActive())
      player.scrub((ImGui::GetIO().MousePos.x - lane.left) / (lane.right - lane.left) * player.length());
    ImGui::SetCursorScreenPos({lane.right - side, lane.top});
    if (ImGui::InvisibleButton("close", {side, side})) closed = i;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(window_words::k_close_plot).c_str());
    add_text(list, lane.right - 0.85f * side, lane.top, theme().quiet, "×");
    ImGui::PopID();
    lane.top += step;
    lane.bottom += step;
  }
  ImGui::EndChild();
  ImGui::End();
  if (closed < inspection.plots.size())
    inspection.plots.erase(inspection.plots.begin() + static_cast<std::ptrdiff_t>(closed));
  return request;
}

std::string plots_csv(const Player& player, Histories& histories, const Inspection& inspection) {
  const Model& model = player.scene().setup.model;
  std::string text = is_static(player.scene().setup) ? "part_of_way" : "time_s";
  std::vector<const std::vector<float>*> columns;
  for (const PlottedValue& plot : inspection.plots) {
    const SubjectValue& value = values_of(plot.subject.kind)[plot.value];
    text += fmt::format(",\"{} {}{}{}\"", name_of(model, plot.subject), value.name.english,
                        *value.unit ? ", " : "", value.unit);
    columns.push_back(&histories.of(player, plot.subject, plot.value));
  }
  for (std::size_t i = 0; i < player.way().size(); ++i) {
    text += fmt::format("\n{}", player.way()[i]->time);
    for (const std::vector<float>* column : columns) {
      text += ',';
      if (std::isfinite((*column)[i])) text += fmt::format("{}", (*column)[i]);
    }
  }
  return text + '\n';
}

}  // namespace topple::app
