#include "render/scene/legend.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "render/scene/drawable.h"
#include "render/scene/overlay_parts.h"
#include "render/scene/text_layout.h"
#include "render/scene/ticks.h"

namespace topple::render {
namespace {

constexpr float k_most_words = 0.5f;  // of a flat legend, beside its bar

struct TickLabel {
  float share;  // of the bar
  std::string words;
};

/// From the least to the greatest.
std::vector<TickLabel> tick_labels(const Legend& legend) {
  const Ticks ticks =
      legend.square_root ? root_ticks(legend.maximum) : nice_ticks(legend.minimum, legend.maximum, 5);
  std::vector<TickLabel> labels;
  for (const double tick : ticks.values) {
    // on a scale of roots, 10 and 0.5 stand side by side
    const int decimals =
        tick > 0 && legend.square_root ? static_cast<int>(std::ceil(-std::log10(tick) - 1e-9)) : 0;
    labels.push_back({legend_position(legend, static_cast<float>(tick)),
                      number(tick, legend.square_root ? std::max(decimals, 0) : ticks.decimals)});
  }
  std::ranges::sort(labels, {}, &TickLabel::share);
  return labels;
}

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

}  // namespace

void draw_legend(const Layout& at, const Legend& legend, ColourMap map, const LegendRoom& room,
                 std::vector<OverlayBox>& boxes) {
  const float column_left = room.left, right = room.right;
  float y = room.top;
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
  const auto add_below = [&](const std::string& words) {
    for (const std::string& line : wrapped(*at.fonts.small, words, right - column_left, 2))
      below.push_back(line);
  };
  add_below(legend.range_policy);
  for (const std::string& note : legend.notes) add_below(note);
  const float below_bar = small_line * (below.empty() ? 0.5f : 0.9f + static_cast<float>(below.size()));
  const float bar_bottom = std::round(std::min(bar_top + room.bar, room.bottom - below_bar));
  if (bar_bottom - bar_top < 4 * small_line) return;

  for (const std::string& line : heading) add_line(at.fonts.text, at.colours.text, line);
  add_line(at.fonts.small, at.colours.quiet, shortened(*at.fonts.small, legend.unit, right - column_left));

  const std::vector<TickLabel> ticks = tick_labels(legend);
  float label_width = 0;
  for (const TickLabel& tick : ticks)
    label_width = std::max(label_width, text_width(*at.fonts.small, tick.words));
  const float bar_right = std::round(right - label_width - 9 * at.unit);
  const float bar_left = std::round(bar_right - 18 * at.unit);
  draw_colour_bar(at, map, bar_left, bar_top, bar_right, bar_bottom);
  for (const TickLabel& tick : ticks) {
    const float tick_y = std::round(bar_bottom + (bar_top - bar_bottom) * tick.share);
    at.list.AddRectFilled({bar_right, tick_y},
                          {bar_right + std::round(4 * at.unit), tick_y + std::max(1.0f, std::round(at.unit))},
                          at.colours.quiet);
    at.text(at.fonts.small, bar_right + std::round(8 * at.unit), tick_y - 0.5f * at.fonts.small->FontSize,
            at.colours.text, tick.words);
  }
  if (!legend.mark_label.empty() && std::isfinite(legend.mark)) {
    draw_mark(at, legend, column_left, bar_left, bar_right, bar_top, bar_bottom);
  }
  y = bar_bottom + 0.9f * small_line;
  for (const std::string& line : below) add_line(at.fonts.small, at.colours.quiet, line);
  boxes.push_back({"legend", column_left, room.top, right, std::max(y, bar_bottom + small_line / 2)});
}

bool can_be_drawn(const Legend& legend, LeftOut& left_out) {
  if (legend.quantity.empty()) return false;
  const bool drawn = has_value_range(legend);
  if (!drawn) ++left_out.legends;
  return drawn;
}

namespace {

Layout layout_over_bodies(ImDrawList& list, const OverlayFonts& fonts, const OverlayBox& room, bool dark) {
  const Colours& on = colours(dark);
  return {list, fonts, room.right, room.bottom, fonts.text->FontSize / 17, 0, on, on.sheet | IM_COL32_A_MASK};
}

}  // namespace

std::optional<OverlayBox> draw_legend_in(ImDrawList& list, const OverlayFonts& fonts, const Legend& legend,
                                         ColourMap map, const OverlayBox& room, bool dark,
                                         LeftOut& left_out) {
  const Layout at = layout_over_bodies(list, fonts, room, dark);
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
  const Layout at = layout_over_bodies(list, fonts, room, dark);
  const ImFont* const font = fonts.small;
  const float line = at.line(font), gap = 8 * at.unit, width = room.right - room.left;
  const bool on_bar =
      !legend.mark_label.empty() && legend.mark >= legend.minimum && legend.mark <= legend.maximum;
  std::string notes = on_bar ? legend.mark_label : "";
  for (const std::string& note : legend.notes) notes += (notes.empty() ? "" : " \xc2\xb7 ") + note;
  const float top = room.bottom - (notes.empty() ? 2 : 3) * line;
  std::vector<TickLabel> ticks = tick_labels(legend);
  float overhang = 0;  // of numbers beyond the bar
  for (const TickLabel& tick : ticks) overhang = std::max(overhang, text_width(*font, tick.words) / 2);
  const float column = k_most_words * width;
  const std::string quantity =
      shortened(*font, legend.quantity + (legend.unit.empty() ? "" : ", " + legend.unit), column);
  const std::string policy = shortened(*font, legend.range_policy, column);
  const float words = std::max(text_width(*font, quantity), text_width(*font, policy));
  const float left = std::round(room.left + words + 2 * gap + overhang),
              right = std::round(room.right - overhang);
  if (top < room.top || right - left < 3 * line) return std::nullopt;
  at.text(font, room.left, top, at.colours.text, quantity);
  at.text(font, room.left, top + line, at.colours.quiet, policy);
  at.text(font, room.left, top + 2 * line, at.colours.quiet, shortened(*font, notes, width));
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
  // The ends first: what would lie on a number that stands is left out.
  if (!ticks.empty()) std::reverse(ticks.begin() + 1, ticks.end());
  std::vector<std::pair<float, float>> taken;
  for (const TickLabel& tick : ticks) {
    const float x = std::round(left + (right - left) * tick.share), half = text_width(*font, tick.words) / 2;
    const bool free = std::ranges::none_of(taken, [&](const auto& other) {
      return x - half - gap < other.second && x + half + gap > other.first;
    });
    if (!free) continue;
    taken.emplace_back(x - half, x + half);
    list.AddRectFilled({x, bar_bottom}, {x + std::max(1.f, std::round(at.unit)), bar_bottom + 4 * at.unit},
                       at.colours.quiet);
    at.text(font, x - half, top + line, at.colours.text, tick.words);
  }
  if (on_bar) {
    const float x = left + (right - left) * legend_position(legend, legend.mark),
                half = std::max(1.f, at.unit);
    list.AddRectFilled({x - half, bar_top}, {x + half, bar_bottom + 4 * at.unit}, at.colours.title);
  }
  return OverlayBox{"legend", room.left, top, room.right, room.bottom};
}

}  // namespace topple::render
