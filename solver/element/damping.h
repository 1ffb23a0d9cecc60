// Damping of elastic deformation, proportional to stiffness:
//   viscous stress = a D (rate of the elastic strain),  a = 2 zeta / w1
// with w1 the first elastic mode about the unloaded reference pose, so that mode k has the ratio
// zeta w_k / w1 to critical. Strain rates are those of the integration point's frame: rigid motion, however
// large, is not damped. An element that has flowed has no viscous stress, which would resist its flow
// (Charney 2008). Recorded stresses are the elastic ones.
#pragma once

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple {

/// a of a body, s; 0: no damping.
inline double damping_time(const Model& model, const Parameters& parameters, int body) {
  if (parameters.damping.empty() || parameters.damping[body] == 0) return 0;
  return 2 * parameters.damping[body] / model.bodies[body].first_frequency;
}

}  // namespace topple
