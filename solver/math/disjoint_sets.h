// Numbers 0..count-1 in sets that grow together (union-find).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace topple {

/// Each alone at first.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The least number of the set that i is in.
  int first_of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) {
    const int a = first_of(i), b = first_of(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace topple
