#include "app/chart/log_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/chart/lane.h"

namespace topple::app {
namespace {

constexpr double k_few_decades = 3.5;
constexpr float k_width = 1.8f;  // px, of lines
constexpr float k_sign = 1.7f;   // lines of text

struct Mark {
  double value;
  bool decade;
};

std::vector<Mark> marks(const LogAxis& axis) {
  const bool few = std::log10(axis.high / axis.low) < k_few_decades;
  std::vector<Mark> out;
  for (int decade = static_cast<int>(std::floor(std::log10(axis.low))); std::pow(10., decade) <= axis.high;
       ++decade)
    for (const double factor : {1., 2., 5.}) {
      const double value = factor * std::pow(10., decade);
      if (axis.contains(value) && (factor == 1 || few)) out.push_back({value, factor == 1});
    }
  return out;
}

std::string number(double value) {
  return fmt::format("{:g}", value);
}

/// Calls write(value, begin) for the marks whose number has room: powers of ten first.
template <class Place, class Write>
void write_numbers(const LogAxis& axis, float gap, Place place, Write write) {
  std::vector<std::pair<float, float>> taken;
  for (const bool decade : {true, false})
    for (const Mark& mark : marks(axis)) {
      if (mark.decade != decade) continue;
      const std::pair<float, float> room = place(mark.value);
      if (std::ranges::any_of(taken, [&](const auto& other) {
            return room.first < other.second + gap && other.first < room.second + gap;
          }))
        continue;
      taken.push_back(room);
      write(mark.value, room.first);
    }
}

}  // namespace

float LogAxis::part(double value) const {
  return static_cast<float>(std::log(value / low) / std::log(high / low));
}

ImVec2 LogChart::at(double x_value, double y_value) const {
  return {left + x.part(x_value) * (right - left), bottom - y.part(y_value) * (bottom - top)};
}

ImVec2 LogChart::clamped(double x_value, double y_value) const {
  return at(std::clamp(x_value, x.low, x.high), std::clamp(y_value, y.low, y.high));
}

LogChart chart_at_cursor(const LogAxis& x, const LogAxis& y, float height, const std::string& y_title) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  add_text(*ImGui::GetWindowDrawList(), low.x, low.y, theme().text, y_title);
  float numbers = 0;
  for (const Mark& mark : marks(y)) numbers = std::max(numbers, text_width(number(mark.value)));
  return {{.left = low.x + numbers + 8,
           .right = low.x + ImGui::GetContentRegionAvail().x - 4,
           .top = low.y + 1.3f * ImGui::GetTextLineHeight(),
           .bottom = low.y + height},
          x,
          y};
}

void draw_log_grid(ImDrawList& list, const LogChart& chart) {
  const float line = ImGui::GetTextLineHeight();
  list.AddRectFilled({chart.left, chart.top}, {chart.right, chart.bottom}, theme().sheet);
  for (const Mark& mark : marks(chart.x)) {
    const float x = chart.at(mark.value, chart.y.low).x;
    list.AddLine({x, chart.top}, {x, chart.bottom}, theme().faint);
  }
  for (const Mark& mark : marks(chart.y)) {
    const float y = chart.at(chart.x.low, mark.value).y;
    list.AddLine({chart.left, y}, {chart.right, y}, theme().faint);
  }
  write_numbers(
      chart.x, 0.4f * line,
      [&](double value) {
        const float width = text_width(number(value));
        const float x = std::clamp(chart.at(value, chart.y.low).x - width / 2, chart.left - width / 2,
                                   chart.right - width);
        return std::pair(x, x + width);
      },
      [&](double value, float x) { add_text(list, x, chart.bottom + 2, theme().text, number(value)); });
  write_numbers(
      chart.y, 0,
      [&](double value) {
        const float y = std::min(chart.at(chart.x.low, value).y - line / 2, chart.bottom - line);
        return std::pair(y, y + line);
      },
      [&](double value, float y) {
        add_text(list, chart.left - text_width(number(value)) - 4, y, theme().text, number(value));
      });
  list.AddRect({chart.left, chart.top}, {chart.right, chart.bottom}, theme().axis);
}

void add_line(ImDrawList& list, const std::vector<ImVec2>& points, ImU32 colour, float dash) {
  const auto draw = [&](const std::vector<ImVec2>& part, ImU32 ink, float wide) {
    list.AddPolyline(part.data(), static_cast<int>(part.size()), ink, 0, wide);
  };
  draw(points, theme().sheet, k_width + 2.5f);
  if (dash == 0) return draw(points, colour, k_width);
  float way = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const ImVec2 a = points[i], b = points[i + 1];
    const float length = std::hypot(b.x - a.x, b.y - a.y);
    const auto point = [&](float s) {
      return ImVec2(a.x + (b.x - a.x) * s / length, a.y + (b.y - a.y) * s / length);
    };
    for (float s = 0; s < length;) {
      const float phase = std::fmod(way, 2 * dash);
      const float step = std::min((phase < dash ? dash : 2 * dash) - phase + 1e-3f, length - s);
      if (phase < dash) draw({point(s), point(s + step)}, colour, k_width);
      s += step;
      way += step;
    }
  }
}

void add_present(ImDrawList& list, ImVec2 at) {
  const float line = ImGui::GetTextLineHeight();
  list.AddCircleFilled(at, 0.42f * line, theme().sheet, 20);
  list.AddCircleFilled(at, 0.32f * line, theme().cursor, 20);
}

ChartKey::ChartKey(ImDrawList& list, const ChartBox& chart, const std::string& x_title)
    : list_(list),
      chart_(chart),
      line_(ImGui::GetTextLineHeight()),
      x_(chart.left),
      y_(chart.bottom + 1.25f * line_) {
  add_text(list, chart.right - text_width(x_title), y_, theme().text, x_title);
}

void ChartKey::begin_line() {
  x_ = chart_.left;
  y_ += 1.2f * line_;
}

ImVec2 ChartKey::entry(const std::string& words) {
  const float width = k_sign * line_ + text_width(words);
  if (x_ > chart_.left && x_ + width > chart_.right) begin_line();
  const float x = std::exchange(x_, x_ + width + 0.8f * line_);
  add_text(list_, x + k_sign * line_, y_, theme().text, words);
  return {x + (k_sign - 0.3f) / 2 * line_, y_ + line_ / 2};
}

void ChartKey::lines(const std::vector<LogCurve>& curves) {
  begin_line();
  for (const LogCurve& curve : curves) {
    const ImVec2 at = entry(curve.name);
    add_line(list_, {{at.x - 0.7f * line_, at.y}, {at.x + 0.7f * line_, at.y}}, curve.colour, curve.dash);
  }
}

void ChartKey::end() {
  ImGui::Dummy({ImGui::GetContentRegionAvail().x, y_ + 1.3f * line_ - ImGui::GetCursorScreenPos().y});
}

}  // namespace topple::app
