#include "solver/step/controlled_way.h"

#include <cmath>
#include <utility>

namespace topple {
namespace {

/// Of the order of what holds a node of the body, N/m.
double control_spring(const BodySystem& s) {
  const Element& element = s.model.elements[s.model.bodies[s.index].first_element];
  return element.normal_stiffness[0] / element.length;
}

}  // namespace

ControlledWay::ControlledWay(const BodySystem& s, std::vector<double> along, double travel)
    : along_(std::move(along)), left_(travel), spring_(control_spring(s)) {
  for (std::size_t i = 0; i < along_.size(); ++i)
    if (std::abs(along_[i]) > std::abs(along_[held_])) held_ = i;
}

void ControlledWay::add_spring(BodySystem& s) const {
  const int node = static_cast<int>(held_ / 6), k = static_cast<int>(held_ % 6);
  Mat6 block = Mat6::Zero();
  block(k, k) = spring_;
  s.lu.add(node, node, block);
}

double ControlledWay::go(BodySystem& s, const std::vector<double>& growth, std::vector<double>& x) {
  by_factor_ = growth;
  by_spring_.assign(x.size(), 0.);
  by_spring_[held_] = spring_;
  s.lu.solve(by_factor_.data());
  s.lu.solve(by_spring_.data());
  // of change and the spring's shift:  shift = x + change by_factor + shift by_spring  where it is held,
  //                                    left = along . (x + change by_factor + shift by_spring)
  const double way_factor = dot(along_, by_factor_), way_spring = dot(along_, by_spring_),
               rest = left_ - dot(along_, x);
  const double here = x[held_], by_factor = by_factor_[held_], soft = 1 - by_spring_[held_];
  const double determinant = soft * way_factor + by_factor * way_spring;
  const double change = (soft * rest - way_spring * here) / determinant,
               shift = (way_factor * here + by_factor * rest) / determinant;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += change * by_factor_[i] + shift * by_spring_[i];
  return change;
}

}  // namespace topple
