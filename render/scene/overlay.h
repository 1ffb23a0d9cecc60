// Words, legend and trace of a picture.
#pragma once

#include <span>
#include <vector>

#include "render/scene/camera.h"
#include "render/scene/colour_map.h"
#include "render/scene/font.h"
#include "render/scene/mesh.h"
#include "render/scene/overlay_box.h"
#include "render/scene/scene_frame.h"

struct ImDrawList;

namespace topple::render {

/// Adds the overlay to `list` for a picture of width x height px: title and lines at the upper left,
/// legend at the right, trace and note at the lower left. Text that is too long is wrapped or
/// shortened; a part without room is not drawn. Returns the parts drawn; they do not overlap.
std::vector<OverlayBox> draw_overlay(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame,
                                     ColourMap map, float width, float height, LeftOut& left_out);

/// Adds the frame's labels beside their places, as `camera` sees them in a picture that fills `room` (px; its
/// name does not count). They stay above `lowest` and inside, and overlap neither each other nor `taken`, nor
/// do lines to them; where there is room they keep off bodies. Those without room are left out.
void draw_labels(ImDrawList& list, const OverlayFonts& fonts, const SceneFrame& frame, const Camera& camera,
                 const OverlayBox& room, float lowest, std::span<const OverlayBox> taken);

}  // namespace topple::render
