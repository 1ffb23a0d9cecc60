// Exact values that benchmarks are compared with.
#pragma once

#include "solver/model/model.h"

namespace topple::study {

/// Tip of a cantilever under a dead load P across it, as fractions of its length L.
struct Elastica {
  double shortening, deflection;  ///< travel of the tip along the unloaded beam and across it, / L
  double angle;                   ///< rad, of the tip
};

/// Inextensible and without shear, by elliptic integrals (Bisshopp & Drucker 1945).
///   k^2 = (1 + sin angle)/2, sin phi = 1/(k sqrt 2), sqrt(load) = K(k) - F(phi, k)
///   deflection = 1 - 2 (E(k) - E(phi, k))/sqrt(load), 1 - shortening = sqrt(2 sin(angle)/load)
/// load: P L^2/EI, 0 < load < 1000.
Elastica elastica(double load);

/// P L^3/3EI + P L/(k G A), m: tip deflection under a small load across the tip. Model: one body, a straight
/// member from its clamped first node, one load.
double cantilever_deflection(const Model& model);

/// Mean sway, m, of the corners of a portal with clamped feet under a load F along x on each of its two
/// corners, with the shear and the normal force of the columns and the shear of the beam; the section is the
/// same everywhere. Height h, half span a, theta the turn of a corner; by antisymmetry the middle of the beam
/// stays at its height and has no moment:
///   V = a theta/(a^3/3EI + a/kGA + h/EA)     shear of the beam, which is the columns' normal force
///   theta (EI + h V a/theta) = F h^2/2
///   sway = F (h^3/3EI + h/kGA) - V a h^2/2EI
/// Model: one body; node 0 a foot, node 1 the corner above it with the first load, node 2 the other corner.
double portal_sway(const Model& model);

/// 8 Mp/(P L): load factor at which a beam of length L, clamped at both ends, collapses under P at its
/// middle. Model: one body; node 0 and node 2 the ends, one load.
double beam_collapse(const Model& model);

/// 6 Mp/(H h + V l/2), with pinned feet 4 Mp: load factor of the combined mechanism of a portal under H at a
/// corner and V at the middle of the beam. Model: one body; nodes 0 and 4 the feet, 1 the corner, loads H and
/// V.
double portal_collapse(const Model& model);

/// The limit of a second-order sequence.
struct Limit {
  double value;
  double uncertainty;  ///< >= 0, change from the limit that the coarser two values give
};

/// From values at element lengths 4h, 2h and h (Richardson 1911): (4 v(h) - v(2h))/3.
Limit second_order_limit(double at_4h, double at_2h, double at_h);

}  // namespace topple::study
