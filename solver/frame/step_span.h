// The ends of a step and what all bodies share there.
#pragma once

#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/model/parameters.h"

namespace topple {

/// A node of the model on which a force acts, N.
struct PulledNode {
  int node;
  Vec3 force;
};

/// What all bodies share at an instant of a step.
struct StepInputs {
  double time;  ///< s
  PreparedLaw law;
  Vec3 floor;                     ///< m/s^2, acceleration
  std::vector<PulledNode> pulls;  ///< one per Parameters::pulls
  /// Where the floor's acceleration jumps, with what follows.
  StepInputs(const Parameters& parameters, double t);
  /// Of an instant after `before` with the same parameters, which is no jump: cheaper.
  StepInputs(const Parameters& parameters, double t, const StepInputs& before);
};

/// A step of size h, s, from `start` to `end`.
struct StepSpan {
  const Parameters& parameters;
  const StepInputs& start;
  const StepInputs& end;
  double h;
  int halvings;  ///< how often the implicit methods of frames may halve h when Newton does not converge
};

}  // namespace topple
