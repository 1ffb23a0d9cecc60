// The unknowns of a rigid or elastic body, and matrices of them.
#pragma once

#include "solver/math/pack.h"
#include "solver/model/body_state.h"

namespace topple {

using PackVec3 = PackVector<double>;
using PackMat3 = PackMatrix<double>;

/// Velocity of a body; also what acts on it: N, N m, N/sqrt(kg), and such sums over time.
struct BodyVelocity {
  PackVec3 linear, angular;  ///< m/s of the centre of gravity, rad/s
  Amplitudes rate;           ///< m sqrt(kg)/s, of the modes
};

/// As numbers in a row, filled up with zeros to whole groups of six; back.
inline void put(const BodyVelocity& from, int modes, double* to) {
  const PackVec3 &x = from.linear, &y = from.angular;
  to[0] = x.x, to[1] = x.y, to[2] = x.z, to[3] = y.x, to[4] = y.y, to[5] = y.z;
  for (int k = 0; k < modes; ++k) to[6 + k] = from.rate[k];
  for (int k = modes; k % 6 != 0; ++k) to[6 + k] = 0;
}
inline BodyVelocity taken(const double* from, int modes) {
  BodyVelocity to;
  to.linear = {from[0], from[1], from[2]};
  to.angular = {from[3], from[4], from[5]};
  for (int k = 0; k < modes; ++k) to.rate[k] = from[6 + k];
  return to;
}

/// A matrix of a body's six unknowns and its modes; rows are padded to whole packs.
using ModeMatrix = double[6 + k_modes][6 + k_modes + 2];
inline void set_block(ModeMatrix& matrix, int row, int column, const PackMat3& block) {
  for (int i = 0; i < 3; ++i) {
    matrix[row + i][column] = block.row[i].x;
    matrix[row + i][column + 1] = block.row[i].y;
    matrix[row + i][column + 2] = block.row[i].z;
  }
}

/// LU in place, of n unknowns. Damping makes the matrix more than M, so that nothing needs a pivot.
inline void factor(ModeMatrix& a, int n) {
  for (int k = 0; k < n; ++k) {
    a[k][k] = 1 / a[k][k];
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i][k] *= a[k][k];
#pragma GCC unroll 6
      for (int j = k + 1; j < n; ++j) a[i][j] -= factor * a[k][j];
    }
  }
}
/// x: the right side, then the solution.
inline void solve(const ModeMatrix& a, double* x, int n) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) x[i] -= a[i][j] * x[j];
    x[i] *= a[i][i];
  }
}

}  // namespace topple
