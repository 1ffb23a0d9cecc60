#include "app/report/svg_chart.h"

#include <fmt/format.h>
#include <utf8.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "render/scene/ticks.h"

namespace topple::app {
namespace {

constexpr double k_width = 720, k_left = 62, k_right = 16, k_top = 12, k_bottom = 40;  // px
constexpr std::size_t k_least_ticks = 3;
constexpr double k_row = 24;           // px, of dots
constexpr double k_name_column = 130;  // px, of dots

struct Stroke {
  const char* colour;
  const char* dashes;
};
// Dark enough for paper; the dashes tell them apart in grey.
constexpr Stroke k_strokes[] = {{"#12355b", ""},         {"#b0471c", "9 3"},    {"#2d6a4f", "2 3"},
                                {"#6a4c93", "10 3 2 3"}, {"#7a5c00", "5 2"},    {"#005f73", "12 4 2 4 2 4"},
                                {"#8c1c3a", "3 2 8 2"},  {"#444444", "1 2 6 2"}};

/// Of one axis: data to px.
struct Axis {
  double from, to, begin, end;
  double at(double value) const { return begin + (value - from) / (to - from) * (end - begin); }
};

Axis axis(double from, double to, double begin, double end) {
  return {from, to > from ? to : from + 1, begin, end};
}

std::string text(double x, double y, const char* how, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, how, escaped(words));
}

std::string line(double x1, double y1, double x2, double y2, const char* how) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2,
                     how);
}

std::string begin(double height) {
  return fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {0:.0f} {1:.0f}\" role=\"img\" font-size=\"12\" fill=\"#222\">\n",
      k_width, height);
}

std::string number(double value, int decimals) {
  const std::string digits = fmt::format("{:.{}f}", value == 0 ? 0. : value, decimals);
  return digits[0] == '-' ? "\u2212" + digits.substr(1) : digits;
}

constexpr const char* k_grid = "stroke=\"#d9dde2\" stroke-width=\"1\"";
constexpr const char* k_frame = "stroke=\"#555\" stroke-width=\"1\"";

std::string x_axis(const Axis& x, double top, double bottom, const std::string& label) {
  std::string out;
  const render::Ticks ticks = render::nice_ticks(x.from, x.to, 10);
  for (const double value : ticks.values) {
    out += line(x.at(value), top, x.at(value), bottom, k_grid);
    out += text(x.at(value), bottom + 15, "text-anchor=\"middle\"", number(value, ticks.decimals));
  }
  out += line(x.begin, bottom, x.end, bottom, k_frame);
  return out + text((x.begin + x.end) / 2, bottom + 33, "text-anchor=\"middle\"", label);
}

std::string y_axis(const Axis& y, double left, double right, const std::string& label, int count) {
  std::string out;
  render::Ticks ticks;
  for (int more = count; ticks.values.size() < k_least_ticks && more < 4 * count; ++more)
    ticks = render::nice_ticks(y.from, y.to, more);  // about 0, steps of 2 and 5 may leave 0 alone
  for (const double value : ticks.values) {
    out += line(left, y.at(value), right, y.at(value), k_grid);
    out += text(left - 6, y.at(value) + 4, "text-anchor=\"end\"", number(value, ticks.decimals));
  }
  out += line(left, y.begin, left, y.end, k_frame);
  const double middle = (y.begin + y.end) / 2;
  return out + fmt::format(
                   "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                   middle, escaped(label));
}

/// The points of a curve, at most the least and the greatest of each pixel.
std::string points(const ChartCurve& curve, const Axis& x, const Axis& y) {
  std::string out;
  const auto add = [&](std::size_t i) {
    if (std::isfinite(curve.y[i])) out += fmt::format("{:.1f},{:.1f} ", x.at(curve.x[i]), y.at(curve.y[i]));
  };
  for (std::size_t i = 0; i < curve.x.size();) {
    const double pixel = std::floor(x.at(curve.x[i]));
    std::size_t least = i, most = i, last = i;
    for (; i < curve.x.size() && std::floor(x.at(curve.x[i])) == pixel; ++i) {
      if (curve.y[i] < curve.y[least]) least = i;
      if (curve.y[i] > curve.y[most]) most = i;
      last = i;
    }
    add(std::min(least, most));
    if (least != most) add(std::max(least, most));
    if (last != least && last != most) add(last);
  }
  return out;
}

double value_at(const ChartCurve& curve, double x) {
  const auto after = std::lower_bound(curve.x.begin(), curve.x.end(), x);
  return curve.y[static_cast<std::size_t>(
      std::min<std::ptrdiff_t>(after - curve.x.begin(), std::ssize(curve.x) - 1))];
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : utf8::replace_invalid(text)) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else if (c == '\n' || c == '\t' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f))
      out += c;
  }
  return out;
}

std::string svg_stroke(std::size_t index) {
  const Stroke& stroke = k_strokes[index % std::size(k_strokes)];
  return fmt::format("stroke=\"{}\" stroke-width=\"1.6\" fill=\"none\"{}", stroke.colour,
                     *stroke.dashes ? fmt::format(" stroke-dasharray=\"{}\"", stroke.dashes) : "");
}

std::string svg_chart(const LineChart& chart) {
  const Axis x = axis(chart.x_from, chart.x_to, k_left, k_width - k_right);
  const Axis y = axis(chart.y_from, chart.y_to, chart.height - k_bottom, k_top);
  std::string out = begin(chart.height);
  out += x_axis(x, k_top, y.begin, chart.x_label);
  out += y_axis(y, x.begin, x.end, chart.y_label, chart.height / 40);
  for (const double level : chart.levels)
    out += line(x.begin, y.at(level), x.end, y.at(level), "stroke=\"#000\" stroke-dasharray=\"6 4\"");
  if (!chart.levels.empty())
    out += text(x.end - 4, y.at(chart.levels.front()) - 5, "text-anchor=\"end\" class=\"halo\"",
                chart.level_label);
  for (std::size_t c = 0; c < chart.curves.size(); ++c)
    out += fmt::format("<polyline points=\"{}\" stroke-linejoin=\"round\" {}/>\n",
                       points(chart.curves[c], x, y), svg_stroke(c));
  for (const ChartMark& mark : chart.marks) {
    const double px = x.at(mark.x), py = y.at(mark.y);
    out += fmt::format(
        "<path d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"1.4\"/>\n",
        px, py - 5);
  }
  for (std::size_t c = 0; chart.numbered && c < chart.curves.size(); ++c) {
    if (chart.curves[c].x.empty()) continue;
    // each number at another place, so that those of curves which run together do not hide each other
    const double share = (static_cast<double>(c) + 1) / (static_cast<double>(chart.curves.size()) + 1);
    const double at = x.from + share * (x.to - x.from);
    const double px = x.at(at), py = y.at(value_at(chart.curves[c], at));
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"#fff\" stroke=\"{}\"/>\n", px, py,
                       k_strokes[c % std::size(k_strokes)].colour);
    out += text(px, py + 4, "text-anchor=\"middle\" font-size=\"11\"", std::to_string(c + 1));
  }
  return out + "</svg>\n";
}

std::string svg_dots(const DotChart& chart) {
  const double rows = static_cast<double>(chart.rows.size()), bottom = k_top + k_row * rows;
  const Axis x = axis(chart.x_from, chart.x_to, k_name_column + 20, k_width - k_right - 10);
  std::string out = begin(bottom + k_bottom);
  out += x_axis(x, k_top, bottom, chart.x_label);
  for (std::size_t r = 0; r < chart.rows.size(); ++r) {
    const DotChart::Row& row = chart.rows[r];
    const double y = k_top + k_row * (static_cast<double>(r) + 0.5);
    out += text(k_name_column, y + 4, "text-anchor=\"end\"", row.name);
    for (std::size_t i = 0; i < row.x.size(); ++i)
      out += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" stroke=\"#111\" "
          "stroke-width=\"1.3\"/>\n",
          x.at(row.x[i]), y, row.filled[i] ? "#111" : "#fff");
  }
  return out + "</svg>\n";
}

}  // namespace topple::app
