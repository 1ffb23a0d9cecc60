// Nodal masses that give a body its mass, centre of gravity and inertia tensor.
#pragma once

#include <optional>
#include <vector>

#include "solver/math/types.h"

namespace topple {

/// Conditions moments m = target on the masses m per node of groups of nodes that weigh the same by symmetry.
struct MomentProblem {
  Eigen::MatrixXd moments;  ///< constraints x groups: what one kilogram on every node of the group
                            ///< adds; the first row is for the mass itself
  Eigen::VectorXd target;   ///< per constraint: kg, kg m or kg m^2
  Eigen::VectorXd nominal;  ///< groups, kg per node: the distribution to stay close to
  Eigen::VectorXd least;    ///< groups, kg per node: lower bound, > 0
  Eigen::VectorXd count;    ///< groups, nodes in the group
};

/// Masses per group that meet the moments to rounding, are not below `least`, and have the least sum of
/// count (m/nominal - 1)^2. Newton's method on the dual problem, one multiplier per moment. None: no such
/// masses were found.
std::optional<Eigen::VectorXd> fit_masses(const MomentProblem& problem);

}  // namespace topple
