// A load step whose length is given: the load factor is solved for.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "solver/frame/body_system.h"

namespace topple {

/// a . b, of one size.
inline double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
}

/// `along` times the increments of the unknowns, six numbers per node, is to come to `travel`. A spring on
/// the greatest entry of `along` keeps a mechanism from being singular. What it would hold is put on as a
/// load: so it does nothing to the solution.
class ControlledWay {
 public:
  ControlledWay(const BodySystem& system, std::vector<double> along, double travel);

  void add_spring(BodySystem& system) const;
  /// `x`, the correction under constant loads, becomes that which goes what is left; `growth`: derivative of
  /// the loads by their factor. Returns the change of the load factor. system.lu is factored, with the
  /// spring.
  double go(BodySystem& system, const std::vector<double>& growth, std::vector<double>& x);
  /// `x` was taken.
  void take(const std::vector<double>& x) { left_ -= dot(along_, x); }
  double left() const { return left_; }  ///< of the travel

 private:
  std::vector<double> along_;
  std::size_t held_ = 0;
  double left_, spring_;
  std::vector<double> by_factor_, by_spring_;
};

}  // namespace topple
