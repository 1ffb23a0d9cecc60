// At which angle a body tips over an edge of its base, and how bending changes that.
#pragma once

#include "solver/model/model.h"

namespace topple {

/// Angle at which the centre of gravity stands above an edge of the base, rad, the least over the edges that
/// it stands within; infinite for a body without a base.
double least_tipping_angle(const Body& body);

/// By how much that angle changes when the body bends while it stands on the edge alone, as a share of the
/// angle; the greatest over the edges. 0 for a body without Body::elastic or a base. gravity: m/s^2.
double tipping_error(const Model& model, int body, double gravity);

}  // namespace topple
