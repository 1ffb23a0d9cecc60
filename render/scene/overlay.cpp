#include "render/scene/overlay.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "render/scene/drawable.h"
#include "render/scene/legend.h"
#include "render/scene/overlay_parts.h"
#include "render/scene/text_layout.h"

namespace topple::render {
namespace {

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
  const float label_top = top + std::round(5 * at.unit);
  const float plot_top = label_top + small_line;
  const float plot_bottom = bottom - std::round(3 * at.unit) - small_line;
  float peak = 0;
  bool negative = false;
  for (const Sample& s : samples) {
    peak = std::max(peak, std::abs(s.value));
    negative = negative || s.value < 0;
  }
  // What the plot reaches up to, over its right end, with three digits.
  std::string reach;
  if (peak > 0) {
    const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(peak))), 0, 4);
    reach = (negative ? "\u00b1" : "") + number(peak, decimals);
  }
  const float reach_width = text_width(*at.fonts.small, reach);
  at.text(at.fonts.small, plot_right - reach_width, label_top, at.colours.quiet, reach);
  at.text(at.fonts.small, plot_left, label_top, at.colours.text,
          shortened(*at.fonts.small, trace.label, plot_right - reach_width - inset - plot_left));
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

std::vector<OverlayBox> draw_overlay(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame,
                                     ColourMap map, float width, float height, LeftOut& left_out) {
  const float unit = fonts.text->FontSize / 17;
  const Colours& on = colours(frame.dark);
  const Layout at{list, fonts, width, height, unit, std::round(26 * unit), on, on.sheet | IM_COL32_A_MASK};
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

}  // namespace topple::render
