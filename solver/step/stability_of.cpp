#include "solver/step/stability_of.h"

#include <algorithm>
#include <cmath>

#include "solver/frame/start_vector.h"

namespace topple {
namespace {

// Forces that keep their direction have a potential, moments about fixed axes have none.
bool is_conservative(const BodySystem& s) {
  return std::all_of(s.loads.begin(), s.loads.end(),
                     [](const auto& own) { return own.load->moment.isZero(0); });
}

}  // namespace

void add_softest_mode(BodySystem& s, const std::vector<double>& growth, Stability& out) {
  constexpr int k_rounds = 50, k_most_modes = 8;
  constexpr double k_beside = 1e-3;  // of the loads' work: less is none
  using Unknowns = Eigen::VectorXd;
  std::vector<Unknowns> found;
  const auto n = static_cast<Eigen::Index>(growth.size());
  for (int m = 0; m < k_most_modes; ++m) {
    Unknowns mode(n);
    double softness = 0;
    for (Eigen::Index i = 0; i < n; ++i) mode[i] = start_entry(static_cast<int>(i));
    for (int round = 0; round < k_rounds; ++round) {
      for (int i = 0; i < s.count; ++i) {
        Eigen::Map<Vec3> shift(&mode[6 * i]), spin(&mode[6 * i + 3]);
        s.clear_fixed(i, shift, spin);
      }
      for (const Unknowns& other : found) mode -= other.dot(mode) * other;
      mode.normalize();
      const Unknowns before = mode;
      s.lu.solve(mode.data());
      softness = before.dot(mode);
    }
    found.push_back(mode.normalized());
    if (softness < 0 || out.negative_pivots <= 0) break;
  }
  const Unknowns& mode = found.back();
  double greatest = 0;
  for (int i = 0; i < s.count; ++i)
    if (const Vec3 shift = mode.segment<3>(6 * i); shift.norm() > greatest) {
      greatest = shift.norm();
      out.node = s.first + i;
      out.direction = shift / greatest;
    }
  const Eigen::Map<const Unknowns> loads(growth.data(), n);
  double share = 0;
  for (int i = 0; i < s.count; ++i) share += mode.segment<3>(6 * i).dot(loads.segment<3>(6 * i));
  const bool hinged =
      std::ranges::any_of(s.elements, [](const ElementState& e) { return e.hinge != Hinge::none; });
  out.loss = hinged                                                 ? Stability::Loss::mechanism
             : std::abs(share) > k_beside * loads.norm() * greatest ? Stability::Loss::limit_point
                                                                    : Stability::Loss::buckling;
}

Stability stability_of(BodySystem& s, const std::vector<double>& growth) {
  Stability out;
  if (!is_conservative(s)) return out;
  const int singular = s.lu.factor(true);
  out.negative_pivots = s.lu.negative();
  if (singular >= 0) {
    ++out.negative_pivots;
    out.loss = Stability::Loss::mechanism;
    out.node = s.first + singular;
  } else if (out.negative_pivots > 0) {
    add_softest_mode(s, growth, out);
  }
  return out;
}

}  // namespace topple
