#include "solver/study/precision/convergence.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace topple::study {

std::optional<double> observed_order(double coarse_to_middle, double middle_to_fine, double ratio) {
  const double order = std::log(std::abs(coarse_to_middle / middle_to_fine)) / std::log(ratio);
  return std::isfinite(order) && order > 0 ? std::optional(order) : std::nullopt;
}

double rms_difference(std::span<const double> a, std::span<const double> b) {
  if (a.empty()) return 0;
  double squares = 0;
  for (std::size_t n = 0; n < a.size(); ++n) squares += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

std::vector<int> pareto_front(std::span<const CostPoint> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int k) {
    return std::tuple(points[static_cast<std::size_t>(k)].cost, points[static_cast<std::size_t>(k)].error, k);
  });
  std::vector<int> front;
  for (const int k : order)
    if (front.empty() ||
        points[static_cast<std::size_t>(k)].error < points[static_cast<std::size_t>(front.back())].error)
      front.push_back(k);
  return front;
}

}  // namespace topple::study
