#include "solver/study/elements/theory.h"

#include <cmath>

namespace topple::study {
namespace {

// Members of the benchmarks lie in the x-z plane and bend in it: about their local y.
double bending(const Model& model) {
  return model.elements.front().bending_stiffness[1];
}
double shear(const Model& model) {
  return model.elements.front().normal_stiffness[2];
}
double tension(const Model& model) {
  return model.elements.front().normal_stiffness[0];
}
double full_moment(const Model& model) {
  return model.elements.front().capacity[2];
}

}  // namespace

Elastica elastica(double load) {
  const auto modulus = [](double angle) { return std::sqrt((1 + std::sin(angle)) / 2); };
  const auto amplitude = [&](double angle) { return std::asin(1 / (std::sqrt(2.) * modulus(angle))); };
  const auto root_of_load = [&](double angle) {
    return std::comp_ellint_1(modulus(angle)) - std::ellint_1(modulus(angle), amplitude(angle));
  };
  double below = 0, above = k_pi / 2;  // the load grows with the angle
  for (double middle = k_pi / 4; middle > below && middle < above; middle = (below + above) / 2)
    (root_of_load(middle) < std::sqrt(load) ? below : above) = middle;
  const double k = modulus(below), phi = amplitude(below);
  return {1 - std::sqrt(2 * std::sin(below) / load),
          1 - 2 * (std::comp_ellint_2(k) - std::ellint_2(k, phi)) / std::sqrt(load), below};
}

double cantilever_deflection(const Model& model) {
  const double length = (model.node_position[1] - model.node_position[0]).norm();
  const double load = model.loads.front().force.norm();
  return load * (std::pow(length, 3) / (3 * bending(model)) + length / shear(model));
}

double portal_sway(const Model& model) {
  const auto& x = model.node_position;
  const double h = (x[1] - x[0]).norm(), a = (x[2] - x[1]).norm() / 2, load = model.loads.front().force.x();
  const double ei = bending(model), kga = shear(model);
  const double moment_per_turn = a * a / (std::pow(a, 3) / (3 * ei) + a / kga + h / tension(model));
  const double turn = load * h * h / 2 / (ei + h * moment_per_turn);
  return load * (std::pow(h, 3) / (3 * ei) + h / kga) - moment_per_turn * turn * h * h / (2 * ei);
}

double beam_collapse(const Model& model) {
  const double length = (model.node_position[2] - model.node_position[0]).norm();
  return 8 * full_moment(model) / (model.loads.front().force.norm() * length);
}

double portal_collapse(const Model& model) {
  const auto& x = model.node_position;
  const double height = (x[1] - x[0]).norm(), span = (x[4] - x[0]).norm();
  constexpr unsigned k_turn = 1u << 4;  // in its plane
  return (model.supports.front().fixed & k_turn ? 6 : 4) * full_moment(model) /
         (model.loads[0].force.norm() * height + model.loads[1].force.norm() * span / 2);
}

Limit second_order_limit(double at_4h, double at_2h, double at_h) {
  const double coarser = (4 * at_2h - at_4h) / 3, finer = (4 * at_h - at_2h) / 3;
  return {finer, std::abs(finer - coarser)};
}

}  // namespace topple::study
