#include "app/chart/lane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/picture/window_words.h"
#include "app/support/terms.h"
#include "render/scene/text_layout.h"
#include "render/scene/ticks.h"

namespace topple::app {

std::vector<ImVec2> without_straight_points(std::span<const ImVec2> points, float tolerance) {
  if (points.size() < 3) return {points.begin(), points.end()};
  std::vector<ImVec2> kept{points.front()};
  // slopes of the lines from the last point that was kept that pass all since then near enough
  float flattest = -INFINITY, steepest = INFINITY;
  for (std::size_t i = 1; i < points.size(); ++i) {
    float along = points[i].x - kept.back().x;
    const float slope = (points[i].y - kept.back().y) / along;
    if (i > 1 && !(along > 0 && slope >= flattest && slope <= steepest)) {
      kept.push_back(points[i - 1]);
      flattest = -INFINITY;
      steepest = INFINITY;
      along = points[i].x - kept.back().x;
    }
    const float rise = points[i].y - kept.back().y;
    flattest = std::max(flattest, along > 0 ? (rise - tolerance) / along : INFINITY);
    steepest = std::min(steepest, along > 0 ? (rise + tolerance) / along : -INFINITY);
  }
  kept.push_back(points.back());
  return kept;
}

std::vector<float> places_of(const Lane& lane, std::span<const RowPtr> rows) {
  std::vector<float> places;
  places.reserve(rows.size());
  for (const RowPtr& row : rows) places.push_back(lane.x(row->time));
  return places;
}

void add_curve(ImDrawList& list, const Lane& lane, std::span<const RowPtr> rows, const ValueAt& value,
               ImU32 colour, float thickness) {
  add_curve(list, lane, places_of(lane, rows), value, colour, thickness);
}

void add_curve(ImDrawList& list, const Lane& lane, std::span<const float> places, const ValueAt& value,
               ImU32 colour, float thickness) {
  std::vector<ImVec2> points;
  const auto draw = [&] {
    constexpr float k_unseen = 0.1f;  // px
    const std::vector<ImVec2> fewer = without_straight_points(points, k_unseen);
    list.AddPolyline(fewer.data(), static_cast<int>(fewer.size()), colour, 0, thickness);
    points.clear();
  };
  list.PushClipRect({lane.left, lane.top - 1}, {lane.right, lane.bottom + 1}, true);
  // of the pixel column that is being gone through
  struct {
    float from, to;  // px
    double first, last, least, greatest;
  } column{};
  bool any = false;
  const auto end_column = [&] {
    if (!std::exchange(any, false)) return;
    const bool rises = column.last >= column.first;
    points.emplace_back(column.from, lane.y(rises ? column.least : column.greatest));
    if (column.least != column.greatest)
      points.emplace_back(column.to, lane.y(rises ? column.greatest : column.least));
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double v = value(i);
    const float x = places[i];
    if (any && (std::isnan(v) || std::floor(x) != std::floor(column.from))) end_column();
    if (std::isnan(v)) {
      draw();
      continue;
    }
    if (!std::exchange(any, true)) column = {x, x, v, v, v, v};
    column.to = x, column.last = v;
    column.least = std::min(column.least, v), column.greatest = std::max(column.greatest, v);
  }
  end_column();
  draw();
  list.PopClipRect();
}

void add_text(ImDrawList& list, float x, float y, ImU32 colour, const std::string& text) {
  list.AddText({std::round(x), std::round(y)}, colour, text.c_str());
}

void text_wrapped(const std::string& text) {
  std::string lines;
  for (const std::string& line : render::wrapped(*ImGui::GetFont(), text, ImGui::GetContentRegionAvail().x,
                                                 std::numeric_limits<int>::max()))
    lines += (lines.empty() ? "" : "\n") + line;
  ImGui::TextUnformatted(lines.c_str());
}

float text_width(const std::string& text) {
  return ImGui::CalcTextSize(text.c_str()).x;
}

void add_axis(ImDrawList& list, const Lane& lane, const Setup& setup, float label_left) {
  const bool loads = is_static(setup), steps = loads && setup.run.statics.control;
  const double scale = steps ? setup.run.statics.load_steps : 1;
  const float apart = 6 * ImGui::GetTextLineHeight();
  const render::Ticks ticks = render::nice_ticks(
      0, scale * lane.length, std::max(2, static_cast<int>((lane.right - lane.left) / apart)));
  const float label_top =
      lane.bottom + 0.57f * ImGui::GetTextLineHeight() + 3;  // below marks of the timeline
  float written = lane.left;                                 // as far as labels reach
  for (double t : ticks.values) {
    t += 0.;  // makes 0 of -0
    if (steps && t != std::round(t)) continue;
    const float x = lane.x(t / scale);
    list.AddLine({x, lane.bottom}, {x, lane.bottom + 4}, theme().axis);
    const std::string label = fmt::format("{:.{}f}{}", t, steps ? 0 : ticks.decimals, loads ? "" : " s");
    const float at = std::min(x + 3, lane.right - text_width(label));
    if (at < written) continue;
    add_text(list, at, label_top, theme().text, label);
    written = at + text_width(label) + 4;
  }
  if (loads)
    add_text(list, label_left, label_top, theme().text,
             say(steps ? window_words::k_load_step : window_words::k_load_factor));
}

}  // namespace topple::app
