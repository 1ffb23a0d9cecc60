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
  Eigen::MatrixXd shape;             ///< 6 nodes x modes, v^T M v = 1: 1/sqrt(kg), rad/(m sqrt(kg))
  Eigen::MatrixXd section;           ///< 6 elements x modes, N and N m per amplitude
  Eigen::MatrixXd residual_shape;    ///< 6 nodes x 3 nodes, m/N, rad/N: static deflection by a unit
                                     ///< force on a node of the free body, less that of the modes
  Eigen::MatrixXd residual_section;  ///< 6 elements x 3 nodes, N and N m per newton
  Eigen::VectorXd mode_yield;        ///< modes: greatest sqrt(f + 1) at ends of elements per amplitude
  Eigen::VectorXd residual_yield;    ///< 3 nodes: likewise per newton
  Eigen::VectorXd mode_stress;       ///< modes: greatest equivalent_stress there per amplitude, Pa
  Eigen::VectorXd residual_stress;   ///< 3 nodes: likewise per newton
  Eigen::VectorXd rest_stress;       ///< 3 nodes: likewise, of the free body under that force alone at rest
  Eigen::VectorXd beyond;  ///< 3 nodes, m/N: how far a unit force deflects its own node beyond the free
                           ///< modes, whatever took the place of some (with_attachments), times the
                           ///< share of rest_stress that lies beyond them
  Eigen::VectorXd mode_rotation;  ///< modes: greatest rotation of a node per amplitude, rad
};

/// None when the body has supports, or nodes without mass or inertia. It is that of an earlier body which is
/// the same, but for rounding, in another place.
std::shared_ptr<const ElasticBasis> elastic_basis(const Model& model, int body);

/// The basis of an anchored body with the deflections that anchors and floor cause, in place of its highest
/// modes: as a Ritz basis it shares a moment between them as the body does (static attachment shapes, Craig
/// 1977). Pins have no line, and take none. The body's own: there is nothing to add.
std::shared_ptr<const ElasticBasis> with_attachments(const Model& model, int body);

/// Of nodes of the free body, counted from its first, three rows and columns each, m/N: how far forces at
/// rest deflect them.
Eigen::MatrixXd flexibility(const ElasticBasis& basis, const std::vector<int>& nodes);

/// Displacement of an anchor's end in a mode of its body, reference axes, 1/sqrt(kg).
Vec3 anchor_shape(const Model& model, const AnchorEnd& end, int mode);

/// Angular frequency w of the first elastic mode of a body with its supports, rad/s, that is not so slow that
/// weight moves it rather than its springs (w^2 < g/reach/50); 0 when it has none.
double first_frequency(const Model& model, int body);

}  // namespace topple
