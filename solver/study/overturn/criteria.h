// Criteria of overturning that are drawn over frequency and amplitude.
#pragma once

#include <string>
#include <vector>

#include "solver/run/run.h"
#include "solver/study/common/axis.h"
#include "solver/study/common/standing.h"

namespace topple::study {

/// Amplitude of the floor's acceleration that a criterion names, along the x axis.
struct Criterion {
  std::string name;          ///< "west"
  std::string label;         ///< "West: a = g b/h"
  std::string about;         ///< what it says and where it is from
  std::vector<double> x, y;  ///< in the axes' units
};

/// Why the criteria of a block alone do not hold of a body: it does not stand freely (alone.h), or "bears
/// "vase"". Empty: they do.
std::string why_no_block(const Model& model, int body);

/// Whether friction gives way before an edge of a body lifts: it is below `limit`, that of a steady push over
/// g. The criteria are of a block that does not slip.
bool slides_first(const Model& model, const Parameters& parameters, int body, double limit);

/// Acceleration at which a rigid block lifts an edge, m/s^2: g b/h (West; Milne 1885).
double west_acceleration(const Standing& body);

/// Velocity of the floor, m/s, below which a block does not overturn by Ishiyama's second criterion:
///   0.4 sqrt(8 g R (1 - cos a)/(3 cos^2 a)), a = atan(b/h)
/// Source: Y. Ishiyama, Earthquake Engineering and Structural Dynamics 10, 1982, 635-650.
double ishiyama_velocity(const Standing& body);

/// Median of the accelerations of a floor at which a body overturns by the Japanese evaluation method, below
/// its corner frequency, m/s^2:
///   A_R50 = A_0 (1 + A_0/g), A_0 = g b/h
/// Source: M. Kaneko and Y. Hayashi, J. Struct. Constr. Eng. AIJ 536, 2000, 55-62.
double evaluation_acceleration(const Standing& body);

/// Its corner frequency, Hz, above which the velocity A_R50/(2 pi F_b) counts; H = 2 h in cm:
///   F_b = 15.6/sqrt(H) (1 + b/h)^(-3/2)
double evaluation_frequency(const Standing& body);

/// The criteria that hold over these axes, and why there are none.
struct Criteria {
  std::string bodies;  ///< names of those that they are for: the first to tip
  Standing body = {};  ///< when there are any
  std::vector<Criterion> list;
  std::string why_not;  ///< "": there are
};

/// They hold where y is the amplitude and x the frequency or duration of the only shake, which is horizontal
/// and perpendicular to two edges of a body that starts at rest on a level floor. Curves of least pulses need
/// both edges equally far from the centre of gravity. A sine is compared with one of its cycles alone. A
/// motion that is neither sine nor pulse has West's only.
Criteria criteria(const Setup& scene, const Axis& x, const Axis& y);

}  // namespace topple::study
