// Natural frequencies and mode shapes of one body.
#pragma once

#include <vector>

#include "solver/model/model.h"

namespace topple {

/// A mode of K v = w^2 M v, about the unloaded reference pose with the supports and without contacts.
struct Mode {
  double frequency = 0;                      ///< Hz; 0 for a rigid one
  bool rigid = false;                        ///< moves without strain
  Vec3 effective_mass = Vec3::Zero();        ///< kg, that takes part in a motion of the floor along x, y, z
  std::vector<Vec3> displacement, rotation;  ///< per node of the body, m and rad; v M v = 1 kg m^2
};

/// The `count` lowest modes of a body (fewer when it has fewer unknowns), rigid ones first, then by
/// frequency. Block Krylov steps of (K + shift M)^-1 M with the rigid motions that the supports leave taken
/// out. Empty when a mass or an inertia of a free node is not positive.
std::vector<Mode> natural_modes(const Model& model, int body, int count);

}  // namespace topple
