// Nodal masses that give a body its mass, centre of gravity and inertia tensor.
#pragma once

#include <optional>
#include <vector>

#include "solver/math/types.h"

namespace topple {

/// Rows of moments (target values) over groups of nodes that share one mass by symmetry.
struct MomentProblem {
  Eigen::MatrixXd moments;  ///< constraints x groups: what one kilogram on every node of the group
                            ///< adds; the first row is the mass itself
  Eigen::VectorXd target;   ///< constraints
  Eigen::VectorXd nominal;  ///< groups, kg per node: the distribution to stay close to
  Eigen::VectorXd least;    ///< groups, kg per node: lower bound, > 0
  Eigen::VectorXd count;    ///< groups, nodes in the group
};

/// Masses per node that meet the moments exactly, are not below `least`, and depart least (relative squares)
/// from `nominal`. Primal active set. None: no such masses.
std::optional<Eigen::VectorXd> fit_masses(const MomentProblem& problem);

}  // namespace topple
