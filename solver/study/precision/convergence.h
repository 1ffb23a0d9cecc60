// Observed order of convergence, and the Pareto front of error against cost.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace topple::study {

/// Observed order of convergence of results at the steps r^2 h, r h and h, ratio = r > 1:
///   p = log(|x_coarse - x_middle|/|x_middle - x_fine|)/log r
/// None: two of them are the same, or they do not come closer (p <= 0).
std::optional<double> observed_order(double coarse_to_middle, double middle_to_fine, double ratio);

/// Root of the mean square of a - b, which have the same length; 0 of nothing.
double rms_difference(std::span<const double> a, std::span<const double> b);

/// A setting: what it costs and how far off it is.
struct CostPoint {
  double cost, error;
};

/// Indices of those points of which no other is cheaper and no less exact, by rising cost.
std::vector<int> pareto_front(std::span<const CostPoint> points);

}  // namespace topple::study
