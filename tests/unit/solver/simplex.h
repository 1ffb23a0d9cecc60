// Linear programming for tests: the dense simplex method in two phases, by Bland's rule.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace topple::test {

/// Greatest c . x with A x = b, x >= 0; none where there is no such x or it grows without bound.
inline std::optional<double> greatest(Eigen::MatrixXd a, Eigen::VectorXd b, const Eigen::VectorXd& c) {
  const Eigen::Index rows = a.rows(), columns = a.cols();
  for (Eigen::Index r = 0; r < rows; ++r)
    if (b[r] < 0) a.row(r) *= -1, b[r] *= -1;
  Eigen::MatrixXd t(rows, columns + rows + 1);
  t << a, Eigen::MatrixXd::Identity(rows, rows), b;
  std::vector<Eigen::Index> basis;
  for (Eigen::Index r = 0; r < rows; ++r) basis.push_back(columns + r);
  const auto maximise = [&](const Eigen::VectorXd& gain, Eigen::Index usable) {
    constexpr double k_rounding = 1e-9;
    for (;;) {
      Eigen::Index enters = -1, leaves = -1;
      for (Eigen::Index j = 0; j < usable && enters < 0; ++j) {
        double reduced = gain[j];
        for (Eigen::Index r = 0; r < rows; ++r) reduced -= gain[basis[r]] * t(r, j);
        if (reduced > k_rounding) enters = j;
      }
      if (enters < 0) return true;
      for (Eigen::Index r = 0; r < rows; ++r) {
        if (t(r, enters) <= k_rounding) continue;
        const double ratio =
            leaves < 0 ? 0
                       : t(r, columns + rows) / t(r, enters) - t(leaves, columns + rows) / t(leaves, enters);
        if (leaves < 0 || ratio < -1e-14 || (ratio < 1e-14 && basis[r] < basis[leaves])) leaves = r;
      }
      if (leaves < 0) return false;
      t.row(leaves) /= t(leaves, enters);
      for (Eigen::Index r = 0; r < rows; ++r)
        if (r != leaves) t.row(r) -= t(r, enters) * Eigen::RowVectorXd(t.row(leaves));
      basis[leaves] = enters;
    }
  };
  const auto value = [&](const Eigen::VectorXd& gain) {
    double sum = 0;
    for (Eigen::Index r = 0; r < rows; ++r) sum += gain[basis[r]] * t(r, columns + rows);
    return sum;
  };
  Eigen::VectorXd gain = Eigen::VectorXd::Zero(columns + rows);
  gain.tail(rows).setConstant(-1);
  if (!maximise(gain, columns + rows) || value(gain) < -1e-7) return std::nullopt;
  gain.setZero();
  gain.head(columns) = c;
  gain.tail(rows).setConstant(-1e12);  // none comes back
  if (!maximise(gain, columns)) return std::nullopt;
  return value(gain);
}

}  // namespace topple::test
