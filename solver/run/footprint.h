// Bodies in plan.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solver/math/convex.h"
#include "solver/model/model.h"

namespace topple {

/// All that is within `radius` of `core`.
struct Footprint {
  Convex core;
  double radius = 0;  ///< m
  double distance(const Vec2& point) const { return std::max(topple::distance(core, point) - radius, 0.); }
};

/// The convex hull in plan of what a body has below `height`, m: of its members' centre lines, with half of
/// the greatest contact width among them around. position: per node of the model. None: it has nothing there.
std::optional<Footprint> footprint(const Model& model, std::span<const Vec3> position, int body,
                                   double height);

}  // namespace topple
