#include "solver/math/block_lu.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace topple {
namespace {

constexpr int k_stride = 8;

// Six rows of a column, and two of padding that stay zero.
struct SixColumn {
  Four low, high;
};

inline SixColumn load_column(const double* from) {
  return {load(from), load(from + 4)};
}

inline void store_column(double* to, const SixColumn& column) {
  store(to, column.low);
  store(to + 4, column.high);
}

inline SixColumn less_product(const SixColumn& c, const SixColumn& a, double b) {
  return {less_product(c.low, a.low, b), less_product(c.high, a.high, b)};
}

// c -= a b
inline void subtract_product(double* __restrict c, const double* __restrict a, const double* __restrict b) {
  SixColumn left[6];
  for (int k = 0; k < 6; ++k) left[k] = load_column(a + k_stride * k);
  for (int j = 0; j < 6; ++j, c += k_stride, b += k_stride) {
    SixColumn column = load_column(c);
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) column = less_product(column, left[k], b[k]);
    store_column(c, column);
  }
}

// b = a b
inline void multiply_onto(double* __restrict b, const double* __restrict a) {
  SixColumn left[6];
  for (int k = 0; k < 6; ++k) left[k] = load_column(a + k_stride * k);
  for (int j = 0; j < 6; ++j, b += k_stride) {
    SixColumn column{Four(b[0]) * left[0].low, Four(b[0]) * left[0].high};
#pragma GCC unroll 6
    for (int k = 1; k < 6; ++k)
      column = {mul_add(left[k].low, b[k], column.low), mul_add(left[k].high, b[k], column.high)};
    store_column(b, column);
  }
}

// Gauss-Jordan in place with a pivot from each column; false when singular. Single numbers change as parts of
// whole columns: a load waits for a narrower store.
bool invert(double* block) {
  static constexpr double k_unit[6][k_stride] = {{1},          {0, 1},          {0, 0, 1},
                                                 {0, 0, 0, 1}, {0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 1}};
  int pivots[6];
  for (int k = 0; k < 6; ++k) {
    double* const own = block + k_stride * k;
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (std::abs(block[k_stride * i + k]) > std::abs(block[k_stride * pivot + k])) pivot = i;
    pivots[k] = pivot;
    const double value = block[k_stride * pivot + k];
    if (!(std::abs(value) > 1e-300)) return false;
    SixColumn column = load_column(block + k_stride * pivot);
    if (pivot != k) store_column(block + k_stride * pivot, load_column(own));
    const double reciprocal = 1 / value;
    const SixColumn unit = load_column(k_unit[k]);
    column = less_product(column, unit, value);
    column = {reciprocal * (column.low + unit.low), reciprocal * (column.high + unit.high)};
    for (int i = 0; i < 6; ++i) {
      if (i == k) continue;
      double* const other = block + k_stride * i;
      const double factor = other[k];
      store_column(other, less_product(less_product(load_column(other), unit, factor), column, factor));
    }
    store_column(own, column);
  }
  for (int k = 5; k >= 0; --k)
    if (pivots[k] != k)
      for (int column = 0; column < 6; ++column)
        std::swap(block[k_stride * column + k], block[k_stride * column + pivots[k]]);
  return true;
}

// y += sign a x
template <int sign>
inline void add_times(double* __restrict y, const double* __restrict a, const double* __restrict x) {
  Four low(0), high(0), low2(0), high2(0);
  for (int k = 0; k < 6; k += 2) {
    low = mul_add(load(a + k_stride * k), x[k], low);
    high = mul_add(load(a + k_stride * k + 4), x[k], high);
    low2 = mul_add(load(a + k_stride * (k + 1)), x[k + 1], low2);
    high2 = mul_add(load(a + k_stride * (k + 1) + 4), x[k + 1], high2);
  }
  const Four sum_low = low + low2, sum_high = high + high2;
  store(y, sign > 0 ? load(y) + sum_low : load(y) - sum_low);
  y[4] = sign > 0 ? y[4] + sum_high[0] : y[4] - sum_high[0];
  y[5] = sign > 0 ? y[5] + sum_high[1] : y[5] - sum_high[1];
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

void BlockLu::add(const std::array<int, 4>& number, const PackMatrix<Four>& a, const PackMatrix<Four>& b,
                  const PackMatrix<Four>& c, const PackMatrix<Four>& d) {
  const auto add_column = [&](int column, const PackVector<Four>& above, const PackVector<Four>& below) {
    Four low[4] = {above.x, above.y, above.z, below.x}, high[4] = {below.y, below.z, Four(0), Four(0)};
    transpose(low[0], low[1], low[2], low[3]);
    transpose(high[0], high[1], high[2], high[3]);
    for (int k = 0; k < 4; ++k) {
      double* const to = values_.data() + k_block * number[k] + k_stride * column;
      store(to, load(to) + low[k]);
      store(to + 4, load(to + 4) + high[k]);
    }
  };
  const PackMatrix<Four> at = transposed(a), bt = transposed(b), ct = transposed(c), dt = transposed(d);
  for (int column = 0; column < 3; ++column) {
    add_column(column, at.row[column], ct.row[column]);
    add_column(3 + column, bt.row[column], dt.row[column]);
  }
}

void BlockLu::fix(int i, int k) {
  const int place = place_[i];
  for (int j = 0; j < nodes_; ++j) {
    const int number = lookup_[static_cast<std::size_t>(place) * nodes_ + j];
    if (number < 0) continue;
    for (int column = 0; column < 6; ++column) values_[k_block * number + k_stride * column + k] = 0;
  }
  values_[k_block * place + k_stride * k + k] = 1;  // diagonal blocks come first, in order
}

int BlockLu::factor(bool count) {
  double* const v = values_.data();
  negative_ = 0;
  for (int k = 0; k < nodes_; ++k) {
    double* const diagonal = v + k_block * k;
    if (count) negative_ += negative_pivots(diagonal);
    if (!invert(diagonal)) return node_at_[k];
    const Column& column = columns_[k];
    const std::size_t n = column.rows.size();
    for (std::size_t b = 0; b < n; ++b) {
      double* const upper = v + k_block * column.upper[b];
      multiply_onto(upper, diagonal);
      for (std::size_t a = 0; a < n; ++a)
        subtract_product(v + k_block * column.update[a * n + b], v + k_block * column.lower[a], upper);
    }
  }
  return -1;
}

void BlockLu::solve(double* b) const {
  const double* const v = values_.data();
  for (int k = 0; k < nodes_; ++k) {
    const Column& column = columns_[k];
    double* const x = b + 6 * node_at_[k];
    double y[6] = {};
    add_times<1>(y, v + k_block * k, x);
    std::copy(y, y + 6, x);
    for (std::size_t a = 0; a < column.rows.size(); ++a)
      add_times<-1>(b + 6 * node_at_[column.rows[a]], v + k_block * column.lower[a], x);
  }
  for (int k = nodes_ - 1; k >= 0; --k) {
    const Column& column = columns_[k];
    double* const x = b + 6 * node_at_[k];
    for (std::size_t a = 0; a < column.rows.size(); ++a)
      add_times<-1>(x, v + k_block * column.upper[a], b + 6 * node_at_[column.rows[a]]);
  }
}

}  // namespace topple
