// What of a body's motion is rigid, and what is deformation.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "solver/io/recording/observer.h"
#include "solver/model/model.h"

namespace topple::app {

/// The rigid motion that brings the reference pose nearest to a row, mass-weighted (Kabsch 1976), of each
/// piece: a body, or what is left of one that broke. A piece that its supports hold in place has none.
struct RigidFit {
  std::vector<Eigen::Isometry3d> motion;  ///< of each piece, reference pose to the row's, m
  std::vector<int> piece;                 ///< of each node

  const Eigen::Isometry3d& of(int node) const { return motion[piece[node]]; }
};
RigidFit rigid_fit(const Model& model, const io::FrameRow& row);

/// How far a node stands from where the rigid motion takes it, m.
Vec3 displacement(const Model& model, const io::FrameRow& row, const RigidFit& fit, int node);

/// Makes displacements and rotations from the rigid motion `factor` times what they are; rotations no more
/// than a right angle, beyond which members would turn back.
void exaggerate(const Model& model, const RigidFit& fit, double factor, io::FrameRow& row);

}  // namespace topple::app
