// What of a picture lies under a pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "render/scene/camera.h"
#include "render/scene/scene_frame.h"

namespace topple::render {

/// A place on a tube.
struct Pick {
  std::size_t tube = 0;       ///< index into SceneFrame::tubes
  std::uint32_t member = 0;   ///< the tube's
  std::uint32_t body = 0;     ///< the tube's
  std::uint32_t station = 0;  ///< of the tube, from its first one; the place lies between it and the next
  float share = 0;            ///< of the way to the next station, 0..1
};

/// The tube that is seen at pixel x, y (from the upper left corner of a picture of width x height px):
/// the foremost of those whose section covers it, else the one that comes nearest to it within 6 px.
/// Nothing for a camera that is not finite.
std::optional<Pick> pick(const SceneFrame& frame, const Camera& camera, int width, int height, float x,
                         float y);

}  // namespace topple::render
