// The legend of a picture.
#pragma once

#include <optional>
#include <vector>

#include "render/scene/colour_map.h"
#include "render/scene/font.h"
#include "render/scene/mesh.h"
#include "render/scene/overlay_box.h"
#include "render/scene/scene_frame.h"

struct ImDrawList;

namespace topple::render {

struct Layout;

/// Whether there is a legend with a range that can be drawn; counts one that cannot in `left_out`.
bool can_be_drawn(const Legend& legend, LeftOut& left_out);

/// Where a legend may lie, px, and how long its bar may be.
struct LegendRoom {
  float left, top, right, bottom;
  float bar;
};
void draw_legend(const Layout& at, const Legend& legend, ColourMap map, const LegendRoom& room,
                 std::vector<OverlayBox>& boxes);

/// Adds only the legend of draw_overlay, as large as `room` allows (px; its name does not count); dark: as on
/// a frame that is. Returns where it lies; nothing when there is no room or no legend.
std::optional<OverlayBox> draw_legend_in(ImDrawList& list, const OverlayFonts& fonts, const Legend& legend,
                                         ColourMap map, const OverlayBox& room, bool dark, LeftOut& left_out);

/// The same along the lower edge of `room`: where there is no room for the other. Quantity and range policy,
/// beside them the bar above its numbers, and below a line for a mark on the bar and notes if there are any.
std::optional<OverlayBox> draw_flat_legend_in(ImDrawList& list, const OverlayFonts& fonts,
                                              const Legend& legend, ColourMap map, const OverlayBox& room,
                                              bool dark);

}  // namespace topple::render
