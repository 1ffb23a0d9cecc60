#include "solver/model/mass_fit.h"

#include <Eigen/Dense>
#include <cmath>

namespace topple {
namespace {

constexpr int k_most_iterations = 200;

/// The dual of the fit: masses follow from one multiplier per moment,
///   m_g(lambda) = max(least_g, nominal_g + (A^T lambda)_g / w_g),  w_g = count_g / nominal_g^2,
/// and the moments are met where the convex function below is least.
struct Dual {
  const Eigen::MatrixXd& moments;
  const Eigen::VectorXd& target;
  const Eigen::VectorXd& least;
  const Eigen::VectorXd& nominal;
  const Eigen::VectorXd weight;

  Eigen::VectorXd masses(const Eigen::VectorXd& lambda) const {
    return least.cwiseMax(nominal + (moments.transpose() * lambda).cwiseQuotient(weight));
  }
  double value(const Eigen::VectorXd& lambda) const {
    const Eigen::VectorXd z = moments.transpose() * lambda;
    double sum = -target.dot(lambda);
    for (Eigen::Index g = 0; g < z.size(); ++g) {
      const double bound = weight[g] * (least[g] - nominal[g]);
      const auto curve = [&](double x) { return nominal[g] * x + x * x / (2 * weight[g]); };
      sum += z[g] >= bound ? curve(z[g]) : curve(bound) + least[g] * (z[g] - bound);
    }
    return sum;
  }
};

}  // namespace

std::optional<Eigen::VectorXd> fit_masses(const MomentProblem& problem) {
  const Eigen::VectorXd scale = (problem.moments.cwiseAbs() * problem.nominal).cwiseInverse();
  const Eigen::MatrixXd moments = scale.asDiagonal() * problem.moments;
  const Eigen::VectorXd target = scale.cwiseProduct(problem.target);
  const Dual dual{moments, target, problem.least, problem.nominal,
                  problem.count.cwiseQuotient(problem.nominal.cwiseProduct(problem.nominal))};
  // No masses that add up to the total depart further than this: a lower dual value proves that none fit.
  const Eigen::VectorXd most = (problem.target[0] * problem.moments.row(0).cwiseInverse()).transpose();
  const double floor = -0.5 * dual.weight.dot(most.cwiseMax(problem.nominal).cwiseAbs2());
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(target.size());
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    const Eigen::VectorXd mass = dual.masses(lambda);
    const Eigen::VectorXd miss = moments * mass - target;
    if (!miss.allFinite()) return std::nullopt;
    if (miss.cwiseAbs().maxCoeff() < 1e-13) return mass;
    Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(target.size(), target.size());
    for (Eigen::Index g = 0; g < mass.size(); ++g)
      if (mass[g] > problem.least[g]) slope += moments.col(g) * moments.col(g).transpose() / dual.weight[g];
    slope.diagonal().array() += 1e-12;  // too few groups off their bound to meet every moment
    const Eigen::VectorXd step = -slope.ldlt().solve(miss);
    const double here = dual.value(lambda), descent = miss.dot(step);
    if (!(here >= floor)) return std::nullopt;
    double length = 1;
    // at the bottom the values differ by rounding alone, and Newton's own step is right
    if (-descent > 1e-12 * std::abs(here))
      while (length > 1e-8 && !(dual.value(lambda + length * step) <= here + 1e-4 * length * descent))
        length /= 2;
    lambda += length * step;
  }
  const Eigen::VectorXd mass = dual.masses(lambda);
  return (moments * mass - target).cwiseAbs().maxCoeff() < 1e-11 ? std::optional(mass) : std::nullopt;
}

}  // namespace topple
