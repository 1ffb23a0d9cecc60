#include "solver/mass_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace topple {
namespace {

// Nonnegative least squares |A x - b| -> min, x >= 0 (Lawson & Hanson 1974, ch. 23).
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index n = a.cols();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<bool> free(n, false);
  const double tolerance = 1e-12 * a.norm() * (b.norm() + 1);
  const auto solve_free = [&] {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index j = 0; j < n; ++j)
      if (free[j]) columns.push_back(j);
    const Eigen::VectorXd part = a(Eigen::all, columns).colPivHouseholderQr().solve(b);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k < columns.size(); ++k) z[columns[k]] = part[k];
    return z;
  };
  for (Eigen::Index outer = 0; outer < 10 * n; ++outer) {
    const Eigen::VectorXd gradient = a.transpose() * (b - a * x);
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < n; ++j)
      if (!free[j] && gradient[j] > tolerance && (best < 0 || gradient[j] > gradient[best])) best = j;
    if (best < 0) break;
    free[best] = true;
    Eigen::VectorXd z = solve_free();
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      double step = 1;
      for (Eigen::Index j = 0; j < n; ++j)
        if (free[j] && z[j] <= 0 && x[j] - z[j] > 0) step = std::min(step, x[j] / (x[j] - z[j]));
      const bool whole = (z.array() >= 0).all();
      if (whole) break;
      x += step * (z - x);
      for (Eigen::Index j = 0; j < n; ++j)
        if (free[j] && x[j] <= 1e-15 * (1 + std::abs(z[j]))) {
          free[j] = false;
          x[j] = 0;
        }
      z = solve_free();
    }
    x = z.cwiseMax(0);
  }
  return x;
}

}  // namespace

std::optional<Eigen::VectorXd> fit_masses(const MomentProblem& problem) {
  const Eigen::Index groups = problem.nominal.size(), rows = problem.target.size();
  // Unknown y = (mass - least) / nominal >= 0; moments scaled to targets of one, weighted far above the
  // departure.
  const double weight = 1e5;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows + groups, groups);
  Eigen::VectorXd b(rows + groups);
  const Eigen::VectorXd rest = problem.target - problem.moments * problem.least;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double scale = weight / problem.moments.row(i).cwiseAbs().dot(problem.nominal);
    a.row(i) = scale * problem.moments.row(i).cwiseProduct(problem.nominal.transpose());
    b[i] = scale * rest[i];
  }
  for (Eigen::Index g = 0; g < groups; ++g) {
    a(rows + g, g) = std::sqrt(problem.count[g]);
    b[rows + g] = a(rows + g, g) * (1 - problem.least[g] / problem.nominal[g]);
  }
  const Eigen::VectorXd y = nonnegative_least_squares(a, b);
  Eigen::VectorXd mass = problem.least + y.cwiseProduct(problem.nominal);

  // The weighted fit leaves a small miss: remove it within the groups that are off their bound.
  std::vector<Eigen::Index> free;
  for (Eigen::Index g = 0; g < groups; ++g)
    if (y[g] > 1e-9) free.push_back(g);
  for (int pass = 0; pass < 3; ++pass) {
    const Eigen::VectorXd miss = problem.target - problem.moments * mass;
    const Eigen::MatrixXd moments = problem.moments(Eigen::all, free);
    const Eigen::VectorXd correction = moments.completeOrthogonalDecomposition().solve(miss);
    for (std::size_t k = 0; k < free.size(); ++k) mass[free[k]] += correction[k];
  }
  const Eigen::VectorXd miss = problem.target - problem.moments * mass;
  for (Eigen::Index i = 0; i < rows; ++i)
    if (!(std::abs(miss[i]) <= 1e-10 * problem.moments.row(i).cwiseAbs().dot(mass))) return std::nullopt;
  if ((mass.array() < 0.5 * problem.least.array()).any()) return std::nullopt;
  return mass;
}

}  // namespace topple
