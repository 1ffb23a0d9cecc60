// What contact points between the edges of a base change about its landings.
#pragma once

#include <span>
#include <vector>

#include "solver/planar/block.h"

namespace topple::planar {

/// Contact points of a base that lie across the plane of motion: m, from below the centre of gravity, towards
/// +x; indices into the model.
struct BaseLine {
  double place;
  std::vector<int> points;
};

/// Factor on the rate that Housner's condition leaves a base that lands on this edge, from the other one and
/// without slip, where points between the edges take a part of its impulse: in the limit of stiff contacts
/// without restitution, each bearing in proportion to depth^q until it ceases to sink. To 1e-4; 1 without
/// such points, and where Housner's condition lets no block rock on.
double landing_factor(const Block& block, Side side, std::span<const BaseLine> base, double q);

}  // namespace topple::planar
