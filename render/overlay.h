// Words, legend and trace of a picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/colour_map.h"
#include "render/font.h"
#include "render/mesh.h"
#include "render/scene_frame.h"

struct ImDrawList;

namespace topple::render {

/// Where a part of the overlay lies, px from the upper left corner of the picture.
struct OverlayBox {
  std::string name;  ///< "title", "lines", "legend", "trace", "note"
  float left, top, right, bottom;
};

/// Round numbers for a scale from minimum to maximum, at most `count` + 1 of them, with as many
/// decimals as tell them apart.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks nice_ticks(double minimum, double maximum, int count);

/// Round numbers for a scale of square roots from 0 to maximum, far enough apart to be read; without
/// `decimals`.
Ticks root_ticks(double maximum);

/// Adds the overlay to `list` for a picture of width x height px: title and lines at the upper left,
/// legend at the right, trace and note at the lower left. Text that is too long is wrapped or
/// shortened; a part without room is not drawn. Returns the parts drawn; they do not overlap.
std::vector<OverlayBox> draw_overlay(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame,
                                     ColourMap map, float width, float height, LeftOut& left_out);

/// Adds the frame's labels beside their places, as `camera` sees them in a picture that fills `room` (px; its
/// name does not count). They stay above `lowest` and inside, and do not overlap; those without room are left
/// out.
void draw_labels(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame, const Camera& camera,
                 const OverlayBox& room, float lowest);

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
