// Sparse LU of 6 x 6 blocks (one per node) with its pattern fixed at build.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "solver/math/pack.h"
#include "solver/math/types.h"

namespace topple {

/// A x = b for an unsymmetric matrix with a symmetric block pattern, one 6 x 6 block row per node, eliminated
/// in minimum-degree order without pivoting between blocks.
class BlockLu {
 public:
  /// `edges`: pairs of nodes 0..nodes-1 that couple.
  BlockLu(int nodes, const std::vector<std::pair<int, int>>& edges);

  void set_zero();
  /// Adds to block (i, j), which must be on the diagonal or an edge.
  template <class Block>
  void add(int i, int j, const Block& block) {
    double* out = values_.data() + k_block * index(i, j);
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) out[k_stride * c + r] += block(r, c);
  }
  /// Adds the 6 x 6 matrix [a b; c d] of lane k to block number[k], see index().
  void add(const std::array<int, 4>& number, const PackMatrix<Four>& a, const PackMatrix<Four>& b,
           const PackMatrix<Four>& c, const PackMatrix<Four>& d);
  /// Number of block (i, j), which must be on the diagonal or an edge.
  int index(int i, int j) const;
  /// Replaces row 6 i + k by x[6 i + k] = b[6 i + k], for a fixed direction; before factor().
  void fix(int i, int k);
  /// Factors in place. The node whose diagonal block is singular, else -1. `count`: also finds negative().
  int factor(bool count = false);
  /// Negative eigenvalues of the matrix last factored with `count`; it must be symmetric but for fixed rows.
  int negative() const { return negative_; }
  /// Overwrites b (6 per node) with x; after factor() returned -1.
  void solve(double* b) const;

 private:
  static constexpr int k_stride = 8;  ///< rows per column, with padding: two 32-byte vectors
  static constexpr int k_block = 6 * k_stride;

  struct Column {
    std::vector<int> rows;    ///< eliminated later and coupled, permuted numbers, ascending
    std::vector<int> lower;   ///< block numbers of (row, this)
    std::vector<int> upper;   ///< block numbers of (this, row)
    std::vector<int> update;  ///< block numbers of (row a, row b), row-major
  };
  int nodes_;
  std::vector<int> place_;    ///< node to position in the order of elimination
  std::vector<int> node_at_;  ///< its inverse
  std::vector<int> lookup_;   ///< permuted (i, j) to block number, -1: none
  std::vector<Column> columns_;
  std::vector<double> values_;
  int negative_ = 0;
};

}  // namespace topple
