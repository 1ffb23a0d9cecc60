// Small deformations of a free body: its lowest modes, and what the others add when loads act slowly.
#pragma once

#include "solver/model/body_state.h"
#include "solver/model/model.h"

namespace topple {

/// Linear elasticity of one body about its unloaded reference pose, free of supports. Displacements are
/// relative to the rigid motion that carries the body's momentum, in the axes of the reference pose; rows per
/// node: displacement, rotation; rows per element: N, Vy, Vz, Mx, My, Mz at its stress point.
struct ElasticBasis {
  int modes = 0;                     ///< k_modes, or all of a small body
  Amplitudes frequency;              ///< rad/s, ascending; zero beyond `modes`
  Eigen::MatrixXd shape;             ///< 6 nodes x modes, v M v = 1
  Eigen::MatrixXd section;           ///< 6 elements x modes, N and N m
  Eigen::MatrixXd residual_shape;    ///< 6 nodes x 3 nodes: static, by a force on a node, less the modes'
  Eigen::MatrixXd residual_section;  ///< 6 elements x 3 nodes
  Eigen::VectorXd mode_yield;        ///< modes: greatest sqrt(f + 1) at ends of elements per amplitude
  Eigen::VectorXd residual_yield;    ///< 3 nodes: likewise per newton
  Eigen::VectorXd mode_rotation;     ///< modes: greatest rotation of a node per amplitude, rad
};

/// None when the body has supports, or nodes without mass or inertia.
std::shared_ptr<const ElasticBasis> elastic_basis(const Model& model, int body);

/// Angular frequency of the first elastic mode of a body with its supports, rad/s; 0 when it has none.
double first_frequency(const Model& model, int body);

}  // namespace topple
