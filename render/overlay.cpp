#include "render/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <Eigen/Geometry>

#include "render/drawable.h"
#include "render/text_layout.h"

namespace topple::render {
namespace {

struct Colours {
  ImU32 title, text, quiet, frame, sheet, trace, cursor, border, axis;
};
constexpr Colours k_light = {
    IM_COL32(24, 34, 45, 255),  IM_COL32(44, 56, 68, 255),    IM_COL32(84, 97, 110, 255),
    IM_COL32(60, 74, 88, 150),  IM_COL32(255, 255, 255, 205), IM_COL32(38, 92, 140, 255),
    IM_COL32(200, 70, 30, 255), IM_COL32(60, 74, 88, 60),     IM_COL32(60, 74, 88, 90)};
constexpr Colours k_dark = {
    IM_COL32(240, 243, 246, 255), IM_COL32(220, 226, 232, 255), IM_COL32(186, 195, 204, 255),
    IM_COL32(190, 200, 210, 150), IM_COL32(26, 30, 36, 205),    IM_COL32(110, 185, 240, 255),
    IM_COL32(255, 130, 90, 255),  IM_COL32(190, 200, 210, 60),  IM_COL32(190, 200, 210, 90)};

const Colours& colours(bool dark) {
  return dark ? k_dark : k_light;
}

struct Layout {
  ImDrawList& list;
  const OverlayFonts& fonts;
  float width, height;
  float unit;  // px of the picture for one pixel of a design 720 pixels high
  float margin;
  const Colours& colours;
  float line(const ImFont* font) const { return std::round(1.32f * font->FontSize); }

  void text(const ImFont* font, float x, float y, ImU32 colour, const std::string& words) const {
    list.AddText(font, font->FontSize, {std::round(x), std::round(y)}, colour, words.data(),
                 words.data() + words.size());
  }
};

std::string number(double value, int decimals) {
  char digits[64];
  const bool plain = value == 0 || (std::abs(value) < 1e6 && decimals <= 4);
  std::snprintf(digits, sizeof digits, plain ? "%.*f" : "%.*e", plain ? decimals : 1, std::abs(value));
  const bool zero = std::string(digits).find_first_not_of("0.") == std::string::npos;
  return (value < 0 && !zero ? "\xe2\x88\x92" : "") + std::string(digits);
}

// ---- title and lines

float draw_words(const Layout& at, const Caption& caption, float right, float bottom,
                 std::vector<OverlayBox>& boxes) {
  float y = at.margin;
  const float room = right - at.margin;
  const auto add_box = [&](const char* name, float top, float widest) {
    if (y > top) boxes.push_back({name, at.margin, top, at.margin + widest, y});
  };
  float widest = 0;
  float top = y;
  if (!caption.title.empty()) {
    for (const std::string& line : wrapped(*at.fonts.title, caption.title, room, 2)) {
      if (y + at.line(at.fonts.title) > bottom) break;
      at.text(at.fonts.title, at.margin, y, at.colours.title, line);
      widest = std::max(widest, text_width(*at.fonts.title, line));
      y += at.line(at.fonts.title);
    }
    add_box("title", top, widest);
    y += std::round(2 * at.unit);
  }
  top = y;
  widest = 0;
  const float step = at.line(at.fonts.text);
  for (std::size_t i = 0; i < caption.lines.size() && y + step <= bottom; ++i) {
    const bool cut = y + 2 * step > bottom && i + 1 < caption.lines.size();
    const std::string line = shortened(*at.fonts.text, cut ? "\xe2\x80\xa6" : caption.lines[i], room);
    at.text(at.fonts.text, at.margin, y, at.colours.text, line);
    widest = std::max(widest, text_width(*at.fonts.text, line));
    y += step;
  }
  add_box("lines", top, widest);
  return y;
}

/// Returns the note's upper edge.
float draw_note(const Layout& at, const std::string& note, std::vector<OverlayBox>& boxes) {
  float y = at.height - std::round(0.75f * at.margin);
  if (note.empty()) return y;
  const std::vector<std::string> lines = wrapped(*at.fonts.small, note, at.width - 2 * at.margin, 2);
  const float bottom = y;
  y -= static_cast<float>(lines.size()) * at.line(at.fonts.small);
  const float top = y;
  float widest = 0;
  for (const std::string& line : lines) {
    at.text(at.fonts.small, at.margin, y, at.colours.quiet, line);
    widest = std::max(widest, text_width(*at.fonts.small, line));
    y += at.line(at.fonts.small);
  }
  boxes.push_back({"note", at.margin, top, at.margin + widest, bottom});
  return top;
}

// ---- legend

void draw_colour_bar(const Layout& at, ColourMap map, float left, float top, float right, float bottom) {
  const ColourTable& table = colour_table(map);
  const auto colour = [&](int i) {
    const auto& c = table[static_cast<std::size_t>(std::clamp(i, 0, k_colour_map_size - 1))];
    return IM_COL32(c[0], c[1], c[2], 255);
  };
  constexpr int k_pieces = 32;
  for (int i = 0; i < k_pieces; ++i) {
    const auto edge = [&](int n) { return bottom + (top - bottom) * static_cast<float>(n) / k_pieces; };
    const ImU32 low = colour(i * k_colour_map_size / k_pieces);
    const ImU32 high = colour((i + 1) * k_colour_map_size / k_pieces);
    at.list.AddRectFilledMultiColor({left, edge(i + 1)}, {right, edge(i)}, high, high, low, low);
  }
  at.list.AddRect({left - 0.5f, top - 0.5f}, {right + 0.5f, bottom + 0.5f}, at.colours.frame);
}

/// The mark at `value`, from its label at the left of the bar.
void draw_mark(const Layout& at, const Legend& legend, float column_left, float bar_left, float bar_right,
               float top, float bottom) {
  const bool above = legend.mark > legend.maximum;
  const bool below = legend.mark < legend.minimum;
  const float share = legend_position(legend, legend.mark);
  const float y = std::round(bottom + (top - bottom) * share);
  const float size = 6 * at.unit;
  const float tip = bar_left - 2 * at.unit;
  if (above || below) {  // it lies beyond the bar: the triangle points there
    const float toward = above ? -size : size;
    at.list.AddTriangleFilled({tip - size, y - toward / 2}, {tip, y - toward / 2},
                              {tip - size / 2, y + toward / 2}, at.colours.title);
  } else {
    at.list.AddTriangleFilled({tip - size, y - 0.6f * size}, {tip, y}, {tip - size, y + 0.6f * size},
                              at.colours.title);
    at.list.AddRectFilled({bar_left, y - std::max(1.0f, at.unit)}, {bar_right, y + std::max(1.0f, at.unit)},
                          at.colours.title);
  }
  const float right = tip - size - 4 * at.unit;
  const std::vector<std::string> lines = wrapped(*at.fonts.small, legend.mark_label, right - column_left, 2);
  float line_y = y - at.fonts.small->FontSize * 0.5f -
                 static_cast<float>(lines.size() - 1) * at.line(at.fonts.small) / 2;
  line_y =
      std::clamp(line_y, top - at.fonts.small->FontSize * 0.5f, bottom - at.fonts.small->FontSize * 0.5f);
  for (const std::string& line : lines) {
    at.text(at.fonts.small, right - text_width(*at.fonts.small, line), line_y, at.colours.title, line);
    line_y += at.line(at.fonts.small);
  }
}

/// Where a legend may lie, px, and how long its bar may be.
struct LegendRoom {
  float left, top, right, bottom;
  float bar;
};

void draw_legend(const Layout& at, const Legend& legend, ColourMap map, const LegendRoom& room,
                 std::vector<OverlayBox>& boxes) {
  const auto [column_left, top, right, lowest, longest] = room;
  float y = top;
  const auto add_line = [&](const ImFont* font, ImU32 colour, const std::string& words) {
    if (words.empty()) return;
    at.text(font, right - text_width(*font, words), y, colour, words);
    y += at.line(font);
  };
  // What stands above and below the bar is known before it is drawn, so that the bar fits between.
  const std::vector<std::string> heading = wrapped(*at.fonts.text, legend.quantity, right - column_left, 2);
  const float small_line = at.line(at.fonts.small);
  const float bar_top = y + static_cast<float>(heading.size()) * at.line(at.fonts.text) +
                        (legend.unit.empty() ? 0 : small_line) + std::round(12 * at.unit);
  std::vector<std::string> below;
  if (!legend.range_policy.empty()) below.push_back(legend.range_policy);
  below.insert(below.end(), legend.notes.begin(), legend.notes.end());
  const float below_bar = small_line * (below.empty() ? 0.5f : 0.9f + static_cast<float>(below.size()));
  const float bar_bottom = std::round(std::min(bar_top + longest, lowest - below_bar));
  if (bar_bottom - bar_top < 4 * small_line) return;

  for (const std::string& line : heading) add_line(at.fonts.text, at.colours.text, line);
  add_line(at.fonts.small, at.colours.quiet, shortened(*at.fonts.small, legend.unit, right - column_left));

  const Ticks ticks =
      legend.square_root ? root_ticks(legend.maximum) : nice_ticks(legend.minimum, legend.maximum, 5);
  const auto label_of = [&](double tick) {
    // on a scale of roots, 10 and 0.5 stand side by side
    const int decimals =
        tick > 0 && legend.square_root ? static_cast<int>(std::ceil(-std::log10(tick) - 1e-9)) : 0;
    return number(tick, legend.square_root ? std::max(decimals, 0) : ticks.decimals);
  };
  float label_width = 0;
  for (const double tick : ticks.values) {
    label_width = std::max(label_width, text_width(*at.fonts.small, label_of(tick)));
  }
  const float bar_right = std::round(right - label_width - 9 * at.unit);
  const float bar_left = std::round(bar_right - 18 * at.unit);
  draw_colour_bar(at, map, bar_left, bar_top, bar_right, bar_bottom);
  for (const double tick : ticks.values) {
    const float share = legend_position(legend, static_cast<float>(tick));
    const float tick_y = std::round(bar_bottom + (bar_top - bar_bottom) * share);
    at.list.AddRectFilled({bar_right, tick_y},
                          {bar_right + std::round(4 * at.unit), tick_y + std::max(1.0f, std::round(at.unit))},
                          at.colours.quiet);
    at.text(at.fonts.small, bar_right + std::round(8 * at.unit), tick_y - 0.5f * at.fonts.small->FontSize,
            at.colours.text, label_of(tick));
  }
  if (!legend.mark_label.empty() && std::isfinite(legend.mark)) {
    draw_mark(at, legend, column_left, bar_left, bar_right, bar_top, bar_bottom);
  }
  y = bar_bottom + 0.9f * small_line;
  for (const std::string& line : below)
    add_line(at.fonts.small, at.colours.quiet, shortened(*at.fonts.small, line, right - column_left));
  boxes.push_back({"legend", column_left, top, right, std::max(y, bar_bottom + small_line / 2)});
}

/// There is a legend, and its range can be shown.
bool can_be_drawn(const Legend& legend, LeftOut& left_out) {
  if (legend.quantity.empty()) return false;
  const bool drawn = has_value_range(legend);
  if (!drawn) ++left_out.legends;
  return drawn;
}

// ---- labels

/// px from the upper left corner of a picture of width x height; nothing behind the eye.
std::optional<ImVec2> seen_at(const Camera& camera, const Float3& at, float width, float height) {
  if (!drawable(at)) return std::nullopt;
  const Eigen::Vector4f clip = camera.projection * camera.view * Eigen::Vector3f(at.data()).homogeneous();
  if (!(clip.w() > 0) || !clip.allFinite()) return std::nullopt;
  return ImVec2(width * (0.5f + 0.5f * clip.x() / clip.w()), height * (0.5f - 0.5f * clip.y() / clip.w()));
}

// ---- trace

struct Sample {
  float at, value;
};

std::vector<Sample> drawable_samples(const Trace& trace, LeftOut& left_out) {
  std::vector<Sample> samples;
  const std::size_t count = std::min(trace.at.size(), trace.value.size());
  for (std::size_t i = 0; i < count; ++i) {
    const bool ordered = samples.empty() || trace.at[i] > samples.back().at;
    if (std::isfinite(trace.at[i]) && std::abs(trace.value[i]) < 1e30f && ordered) {
      samples.push_back({trace.at[i], trace.value[i]});
    } else {
      ++left_out.trace_points;
    }
  }
  left_out.trace_points += static_cast<int>(std::max(trace.at.size(), trace.value.size()) - count);
  return samples;
}

/// The samples as a line, with no more than the least and greatest of each pixel column.
std::vector<ImVec2> polyline(const std::vector<Sample>& samples, float left, float right, float zero_y,
                             float scale) {
  const float begin = samples.front().at;
  const float span = samples.back().at - begin;
  std::vector<ImVec2> points;
  const auto place = [&](const Sample& s) {
    return ImVec2(left + (right - left) * ((s.at - begin) / span), zero_y - scale * s.value);
  };
  for (std::size_t i = 0; i < samples.size();) {
    const float column = std::floor(place(samples[i]).x);
    std::size_t least = i;
    std::size_t greatest = i;
    std::size_t next = i;
    while (next < samples.size() && std::floor(place(samples[next]).x) == column) {
      if (samples[next].value < samples[least].value) least = next;
      if (samples[next].value > samples[greatest].value) greatest = next;
      ++next;
    }
    points.push_back(place(samples[std::min(least, greatest)]));
    if (least != greatest) points.push_back(place(samples[std::max(least, greatest)]));
    i = next;
  }
  return points;
}

void draw_trace(const Layout& at, const Trace& trace, float bottom, std::vector<OverlayBox>& boxes,
                LeftOut& left_out, float top) {
  const std::vector<Sample> samples = drawable_samples(trace, left_out);
  const float left = at.margin;
  const float right = std::round(at.margin + 0.29f * at.width);
  const float small_line = at.line(at.fonts.small);
  if (samples.size() < 2 || bottom - top < 3.5f * small_line) return;
  const float span = samples.back().at - samples.front().at;
  if (!std::isfinite(span)) return;

  at.list.AddRectFilled({left, top}, {right, bottom}, at.colours.sheet, 4 * at.unit);
  at.list.AddRect({left + 0.5f, top + 0.5f}, {right - 0.5f, bottom - 0.5f}, at.colours.border, 4 * at.unit);
  const float inset = std::round(9 * at.unit);
  const float plot_left = left + inset;
  const float plot_right = right - inset;
  const std::string label = shortened(*at.fonts.small, trace.label, plot_right - plot_left);
  at.text(at.fonts.small, plot_left, top + std::round(5 * at.unit), at.colours.text, label);

  const float plot_top = top + std::round(5 * at.unit) + small_line;
  const float plot_bottom = bottom - std::round(3 * at.unit) - small_line;
  float peak = 0;
  bool negative = false;
  for (const Sample& s : samples) {
    peak = std::max(peak, std::abs(s.value));
    negative = negative || s.value < 0;
  }
  const float zero_y = std::round(negative ? (plot_top + plot_bottom) / 2 : plot_bottom);
  const float scale = peak > 0 ? (zero_y - plot_top) / peak : 0;
  at.list.AddRectFilled({plot_left, zero_y}, {plot_right, zero_y + 1}, at.colours.axis);
  const std::vector<ImVec2> points = polyline(samples, plot_left, plot_right, zero_y, scale);
  at.list.AddPolyline(points.data(), static_cast<int>(points.size()), at.colours.trace, 0,
                      std::max(1.0f, 1.3f * at.unit));

  const auto end_label = [&](float x) {
    return number(x, !trace.whole && span < 10 ? 1 : 0) + " " + trace.unit;
  };
  const std::string first = end_label(samples.front().at);
  const std::string last = end_label(samples.back().at);
  const float label_y = plot_bottom + std::round(1 * at.unit);
  at.text(at.fonts.small, plot_left, label_y, at.colours.quiet, first);
  at.text(at.fonts.small, plot_right - text_width(*at.fonts.small, last), label_y, at.colours.quiet, last);

  const float share = (trace.cursor - samples.front().at) / span;
  if (share >= 0 && share <= 1) {
    const float x = std::round(plot_left + (plot_right - plot_left) * share);
    const float half = std::max(0.5f, 0.75f * at.unit);
    at.list.AddRectFilled({x - half, plot_top}, {x + half, plot_bottom}, at.colours.cursor);
    const auto after = std::ranges::lower_bound(samples, trace.cursor, {}, &Sample::at);
    if (after != samples.end()) {
      at.list.AddCircleFilled({x, zero_y - scale * after->value}, 3.5f * at.unit, at.colours.cursor, 16);
    }
  }
  boxes.push_back({"trace", left, top, right, bottom});
}

}  // namespace

Ticks nice_ticks(double minimum, double maximum, int count) {
  const double rough = (maximum - minimum) / std::max(count, 1);
  if (!(rough > 0) || !std::isfinite(rough)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  Ticks ticks;
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double first = std::ceil(minimum / step - 1e-6);
  const double last = std::floor(maximum / step + 1e-6);
  for (double n = first; n <= last && ticks.values.size() <= 100; ++n) ticks.values.push_back(n * step);
  return ticks;
}

Ticks root_ticks(double maximum) {
  Ticks ticks;
  if (!(maximum > 0) || !std::isfinite(maximum)) return ticks;
  constexpr double k_apart = 0.12;  // of the bar, least
  double last = 1 + k_apart;
  double power = std::pow(10.0, std::floor(std::log10(maximum)));
  for (int decade = 0; decade < 4; ++decade, power /= 10) {
    for (const double factor : {5.0, 2.0, 1.0}) {
      const double share = std::sqrt(factor * power / maximum);
      if (factor * power > maximum || last - share < k_apart || share < k_apart) continue;
      ticks.values.push_back(factor * power);
      last = share;
    }
  }
  ticks.values.push_back(0);
  return ticks;
}

std::vector<OverlayBox> draw_overlay(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame,
                                     ColourMap map, float width, float height, LeftOut& left_out) {
  const float unit = fonts.text->FontSize / 17;
  const Layout at{list, fonts, width, height, unit, std::round(26 * unit), colours(frame.dark)};
  std::vector<OverlayBox> boxes;
  const bool has_legend = can_be_drawn(frame.legend, left_out);
  const float column_left = has_legend ? std::round(0.825f * width) : width - at.margin;
  const float note_top = draw_note(at, frame.caption.note, boxes);
  const bool has_trace = !frame.trace.at.empty();
  const float trace_bottom = note_top - std::round(8 * unit);
  const float trace_top = has_trace ? std::round(trace_bottom - 0.165f * height) : trace_bottom;
  const float words_bottom = draw_words(at, frame.caption, has_legend ? column_left - at.margin : column_left,
                                        trace_top - at.margin / 2, boxes);
  if (has_trace && trace_top >= words_bottom)
    draw_trace(at, frame.trace, trace_bottom, boxes, left_out, trace_top);
  if (has_legend) {
    draw_legend(at, frame.legend, map,
                {column_left, at.margin, width - at.margin, note_top - 8 * unit, 0.44f * height}, boxes);
  }
  return boxes;
}

void draw_labels(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame, const Camera& camera,
                 const OverlayBox& room, float lowest) {
  const float unit = fonts.text->FontSize / 17, pad = 3 * unit, away = 9 * unit;
  const ImFont& font = *fonts.small;
  std::vector<OverlayBox> placed;
  for (const Label& label : frame.labels) {
    const auto at = seen_at(camera, label.at, room.right - room.left, room.bottom - room.top);
    if (!at || label.words.empty()) continue;
    const float width = text_width(font, label.words) + 2 * pad, height = font.FontSize + 2 * pad;
    if (width > room.right - room.left || height > lowest - room.top) continue;
    OverlayBox box{"label", room.left + at->x + away, room.top + at->y - height / 2, 0, 0};
    box.left = std::round(std::clamp(box.left, room.left, room.right - width));
    box.top = std::round(std::clamp(box.top, room.top, lowest - height));
    for (const OverlayBox& other : placed)  // below those before it
      if (box.left < other.right && box.left + width > other.left && box.top < other.bottom &&
          box.top + height > other.top)
        box.top = other.bottom + 1;
    box.right = box.left + width;
    box.bottom = box.top + height;
    if (box.bottom > lowest) continue;
    list.AddRectFilled({box.left, box.top}, {box.right, box.bottom}, colours(frame.dark).sheet, pad);
    list.AddText(fonts.small, font.FontSize, {box.left + pad, box.top + pad}, colours(frame.dark).title,
                 label.words.c_str());
    placed.push_back(box);
  }
}

std::optional<OverlayBox> draw_legend_in(ImDrawList& list, const OverlayFonts& fonts, const Legend& legend,
                                         ColourMap map, const OverlayBox& room, bool dark,
                                         LeftOut& left_out) {
  const Layout at{list, fonts, room.right, room.bottom, fonts.text->FontSize / 17, 0, colours(dark)};
  std::vector<OverlayBox> boxes;
  if (can_be_drawn(legend, left_out)) {
    draw_legend(at, legend, map, {room.left, room.top, room.right, room.bottom, room.bottom - room.top},
                boxes);
  }
  return boxes.empty() ? std::nullopt : std::optional(boxes.front());
}

std::optional<OverlayBox> draw_flat_legend_in(ImDrawList& list, const OverlayFonts& fonts,
                                              const Legend& legend, ColourMap map, const OverlayBox& room,
                                              bool dark) {
  if (legend.quantity.empty() || !has_value_range(legend)) return std::nullopt;
  const Layout at{list, fonts, room.right, room.bottom, fonts.text->FontSize / 17, 0, colours(dark)};
  const ImFont* const font = fonts.small;
  const float line = at.line(font), gap = 8 * at.unit, top = room.bottom - line;
  const int decimals = nice_ticks(legend.minimum, legend.maximum, 5).decimals;
  const std::string low = number(legend.minimum, decimals), high = number(legend.maximum, decimals);
  const float numbers = text_width(*font, low) + text_width(*font, high) + 3 * gap, least = 5 * line;
  const std::string words =
      shortened(*font, legend.quantity + (legend.unit.empty() ? "" : ", " + legend.unit),
                room.right - room.left - numbers - least);
  const float first = room.left + text_width(*font, words) + 2 * gap;
  const float left = std::round(first + text_width(*font, low) + gap);
  const float right = std::round(room.right - text_width(*font, high) - gap);
  if (top < room.top || right - left < least / 2) return std::nullopt;
  at.text(font, room.left, top, at.colours.text, words);
  at.text(font, first, top, at.colours.text, low);
  at.text(font, right + gap, top, at.colours.text, high);
  const float bar_top = std::round(top + 0.1f * line), bar_bottom = std::round(top + 0.7f * line);
  const ColourTable& table = colour_table(map);
  for (int i = 0; i + 1 < k_colour_map_size; ++i) {
    const auto colour = [&](int k) { return IM_COL32(table[k][0], table[k][1], table[k][2], 255); };
    const auto x = [&](int k) {
      return left + (right - left) * static_cast<float>(k) / (k_colour_map_size - 1);
    };
    list.AddRectFilledMultiColor({x(i), bar_top}, {x(i + 1), bar_bottom}, colour(i), colour(i + 1),
                                 colour(i + 1), colour(i));
  }
  list.AddRect({left - 0.5f, bar_top - 0.5f}, {right + 0.5f, bar_bottom + 0.5f}, at.colours.frame);
  const bool on_bar = legend.mark >= legend.minimum && legend.mark <= legend.maximum;
  if (!legend.mark_label.empty() && on_bar) {
    const float x = left + (right - left) * legend_position(legend, legend.mark),
                half = std::max(1.f, at.unit);
    list.AddRectFilled({x - half, bar_top}, {x + half, bar_bottom + 4 * at.unit}, at.colours.title);
  }
  return OverlayBox{"legend", room.left, top, room.right, room.bottom};
}

}  // namespace topple::render
