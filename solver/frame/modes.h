// Natural frequencies and mode shapes of one body.
#pragma once

#include <vector>

#include "solver/model/model.h"

namespace topple {

/// A mode of K v = w^2 M v, about the unloaded reference pose with the supports and without contacts.
struct Mode {
  double frequency = 0;                      ///< Hz; 0 for a rigid one
  bool rigid = false;                        ///< moves without strain
  Vec3 effective_mass = Vec3::Zero();        ///< kg, effective modal mass for floor motion along x, y, z
  std::vector<Vec3> displacement, rotation;  ///< per node of the body, m and rad; v M v = 1 kg m^2
};

/// The `count` lowest modes of a body (fewer when it has fewer unknowns), rigid ones first, then by
/// frequency. Restarted block Krylov method with (K + shift M)^-1 M, after rigid motions that the supports
/// leave are projected out. Empty when the mass of a node, or its inertia, is not positive.
std::vector<Mode> natural_modes(const Model& model, int body, int count);

}  // namespace topple
