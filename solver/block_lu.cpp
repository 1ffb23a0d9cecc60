#include "solver/block_lu.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace topple {
namespace {

constexpr int k_stride = 8;

using Four = double __attribute__((vector_size(32)));  // GNU vectors: the same operations in every build type

inline Four load(const double* from) {
  Four v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

inline void store(double* to, Four v) {
  __builtin_memcpy(to, &v, sizeof v);
}

// Row r of the product a b, in two vectors; padding columns stay zero.
inline void row_product(const double* a_row, const double* b, Four& low, Four& high) {
  low = a_row[0] * load(b);
  high = a_row[0] * load(b + 4);
  for (int k = 1; k < 6; ++k) {
    low += a_row[k] * load(b + k_stride * k);
    high += a_row[k] * load(b + k_stride * k + 4);
  }
}

// c -= a b
inline void subtract_product(double* __restrict c, const double* __restrict a, const double* __restrict b) {
  for (int r = 0; r < 6; ++r, c += k_stride, a += k_stride) {
    Four low, high;
    row_product(a, b, low, high);
    store(c, load(c) - low);
    store(c + 4, load(c + 4) - high);
  }
}

// c = a b
inline void multiply(double* __restrict c, const double* __restrict a, const double* __restrict b) {
  for (int r = 0; r < 6; ++r, c += k_stride, a += k_stride) {
    Four low, high;
    row_product(a, b, low, high);
    store(c, low);
    store(c + 4, high);
  }
}

// Gauss-Jordan with row pivoting; false when singular.
bool invert(double* block) {
  double inverse[6 * k_stride] = {};
  for (int i = 0; i < 6; ++i) inverse[k_stride * i + i] = 1;
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (std::abs(block[k_stride * i + k]) > std::abs(block[k_stride * pivot + k])) pivot = i;
    const double value = block[k_stride * pivot + k];
    if (!(std::abs(value) > 1e-300)) return false;
    if (pivot != k)
      for (int j = 0; j < k_stride; ++j) {
        std::swap(block[k_stride * k + j], block[k_stride * pivot + j]);
        std::swap(inverse[k_stride * k + j], inverse[k_stride * pivot + j]);
      }
    const double reciprocal = 1 / value;
    const auto scaled = [&](double* row) {
      const Four low = reciprocal * load(row), high = reciprocal * load(row + 4);
      store(row, low);
      store(row + 4, high);
      return std::pair(low, high);
    };
    const auto [left_low, left_high] = scaled(block + k_stride * k);
    const auto [right_low, right_high] = scaled(inverse + k_stride * k);
    for (int i = 0; i < 6; ++i) {
      if (i == k) continue;
      const double f = block[k_stride * i + k];
      double* const left = block + k_stride * i;
      double* const right = inverse + k_stride * i;
      store(left, load(left) - f * left_low);
      store(left + 4, load(left + 4) - f * left_high);
      store(right, load(right) - f * right_low);
      store(right + 4, load(right + 4) - f * right_high);
    }
  }
  std::copy(inverse, inverse + 6 * k_stride, block);
  return true;
}

// Negative pivots of elimination in order, which Sylvester's law makes those of the eigenvalues.
int negative_pivots(const double* block) {
  double a[k_stride * 6];
  std::copy(block, block + k_stride * 6, a);
  int count = 0;
  for (int k = 0; k < 6; ++k) {
    const double pivot = a[k_stride * k + k];
    count += pivot < 0;
    for (int i = k + 1; i < 6; ++i) {
      const double f = a[k_stride * i + k] / pivot;
      for (int j = k; j < 6; ++j) a[k_stride * i + j] -= f * a[k_stride * k + j];
    }
  }
  return count;
}

}  // namespace

BlockLu::BlockLu(int nodes, const std::vector<std::pair<int, int>>& edges)
    : nodes_(nodes), place_(nodes), lookup_(static_cast<std::size_t>(nodes) * nodes, -1), columns_(nodes) {
  std::vector<std::set<int>> graph(nodes);
  for (const auto& [i, j] : edges)
    if (i != j) {
      graph[i].insert(j);
      graph[j].insert(i);
    }
  std::vector<bool> done(nodes, false);
  std::vector<std::vector<int>> later(nodes);
  for (int k = 0; k < nodes; ++k) {
    int best = -1;
    for (int i = 0; i < nodes; ++i)
      if (!done[i] && (best < 0 || graph[i].size() < graph[best].size())) best = i;
    done[best] = true;
    place_[best] = k;
    node_at_.push_back(best);
    later[k].assign(graph[best].begin(), graph[best].end());
    for (int i : later[k]) {
      graph[i].erase(best);
      for (int j : later[k])
        if (i != j) graph[i].insert(j);
    }
  }
  int blocks = 0;
  const auto block = [&](int i, int j) -> int& { return lookup_[static_cast<std::size_t>(i) * nodes + j]; };
  for (int k = 0; k < nodes; ++k) block(k, k) = blocks++;
  for (int k = 0; k < nodes; ++k) {
    Column& column = columns_[k];
    for (int node : later[k]) column.rows.push_back(place_[node]);
    std::sort(column.rows.begin(), column.rows.end());
    for (int row : column.rows) {
      if (block(row, k) < 0) block(row, k) = blocks++;
      if (block(k, row) < 0) block(k, row) = blocks++;
      column.lower.push_back(block(row, k));
      column.upper.push_back(block(k, row));
    }
  }
  for (Column& column : columns_)
    for (int a : column.rows)
      for (int b : column.rows) column.update.push_back(block(a, b));
  values_.assign(static_cast<std::size_t>(blocks) * k_block, 0.);
}

int BlockLu::index(int i, int j) const {
  return lookup_[static_cast<std::size_t>(place_[i]) * nodes_ + place_[j]];
}

void BlockLu::set_zero() {
  std::fill(values_.begin(), values_.end(), 0.);
}

void BlockLu::fix(int i, int k) {
  const int place = place_[i];
  const auto clear_row = [&](int number) {
    double* row = values_.data() + k_block * number + k_stride * k;
    std::fill(row, row + k_stride, 0.);
  };
  for (int j = 0; j < nodes_; ++j) {
    const int number = lookup_[static_cast<std::size_t>(place) * nodes_ + j];
    if (number >= 0) clear_row(number);
  }
  values_[k_block * place + k_stride * k + k] = 1;  // diagonal blocks come first, in order
}

int BlockLu::factor(bool count) {
  double* const v = values_.data();
  double scaled[k_block];
  negative_ = 0;
  for (int k = 0; k < nodes_; ++k) {
    double* const diagonal = v + k_block * k;
    if (count) negative_ += negative_pivots(diagonal);
    if (!invert(diagonal)) return node_at_[k];
    const Column& column = columns_[k];
    const std::size_t n = column.rows.size();
    for (std::size_t a = 0; a < n; ++a) {
      double* const lower = v + k_block * column.lower[a];
      multiply(scaled, lower, diagonal);
      std::copy(scaled, scaled + k_block, lower);
      for (std::size_t b = 0; b < n; ++b)
        subtract_product(v + k_block * column.update[a * n + b], lower, v + k_block * column.upper[b]);
    }
  }
  return -1;
}

void BlockLu::solve(double* b) const {
  const double* const v = values_.data();
  const auto subtract = [](double* y, const double* block, const double* x) {
    for (int r = 0; r < 6; ++r) {
      double sum = 0;
      for (int c = 0; c < 6; ++c) sum += block[k_stride * r + c] * x[c];
      y[r] -= sum;
    }
  };
  for (int k = 0; k < nodes_; ++k) {
    const Column& column = columns_[k];
    for (std::size_t a = 0; a < column.rows.size(); ++a)
      subtract(b + 6 * node_at_[column.rows[a]], v + k_block * column.lower[a], b + 6 * node_at_[k]);
  }
  for (int k = nodes_ - 1; k >= 0; --k) {
    const Column& column = columns_[k];
    double* const x = b + 6 * node_at_[k];
    for (std::size_t a = 0; a < column.rows.size(); ++a)
      subtract(x, v + k_block * column.upper[a], b + 6 * node_at_[column.rows[a]]);
    double y[6] = {};
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) y[r] += v[k_block * k + k_stride * r + c] * x[c];
    std::copy(y, y + 6, x);
  }
}

}  // namespace topple
