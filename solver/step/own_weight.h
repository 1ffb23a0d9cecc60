// The weight of members in statics, which acts between their nodes.
#pragma once

#include <vector>

#include "solver/frame/body_system.h"

namespace topple {

/// Puts the weight of the pairs of elements that stand for a member, or for a part of one, where it bends a
/// free beam exactly: on the ends of each pair, half of it and the moments +-W L/12 of a beam between two
/// walls, into the forces and the tangent of the last evaluation. `x`: m, per node of the body. Where
/// sections yield nothing changes: the masses bear it, with which the moments at the ends are right too (W
/// L/2 of a cantilever, W L/12 between two walls), while the mid node sinks less.
void distribute_weight(BodySystem& s, const Vec3& gravity, const std::vector<Vec3>& x);

/// Adds to section forces what the weight so put does between the ends of a pair, straight from element to
/// element: the moments are right at the nodes, the forces in the middle of an element.
void add_weight(const BodySystem& s, const Vec3& gravity, const State& state,
                std::vector<SectionForces>& sections);

}  // namespace topple
