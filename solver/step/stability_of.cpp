#include "solver/step/stability_of.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/element/plasticity.h"
#include "solver/frame/start_vector.h"
#include "solver/math/ranges.h"
#include "solver/state/sections.h"

namespace topple {
namespace {

// Forces that keep their direction have a potential, moments about fixed axes have none.
bool is_conservative(const BodySystem& s) {
  return std::all_of(s.loads.begin(), s.loads.end(),
                     [](const auto& own) { return own.load->moment.isZero(0); });
}

}  // namespace

void add_softest_mode(BodySystem& s, const std::vector<double>& growth, Stability& out) {
  constexpr int k_rounds = 30, k_more = 3;  // of inverse iteration; vectors beside those that are sought
  constexpr double k_beside = 1e-3;         // of the loads' work: less is none
  using Vectors = Eigen::MatrixXd;
  const auto n = static_cast<Eigen::Index>(growth.size());
  const Eigen::Index count = std::min<Eigen::Index>(n, std::max(out.negative_pivots, 0) + k_more);
  Vectors modes(n, count);
  for (Eigen::Index m = 0; m < count; ++m)
    for (Eigen::Index i = 0; i < n; ++i) modes(i, m) = start_entry(static_cast<int>(i), static_cast<int>(m));
  Eigen::VectorXd softness;  // 1 over the eigenvalues of K, ascending
  for (int round = 0; round < k_rounds; ++round) {
    for (Eigen::Index m = 0; m < count; ++m)
      for (int i = 0; i < s.count; ++i) {
        Eigen::Map<Vec3> shift(&modes(6 * i, m)), spin(&modes(6 * i + 3, m));
        s.clear_fixed(i, shift, spin);
      }
    modes = Eigen::HouseholderQR<Vectors>(modes).householderQ() * Vectors::Identity(n, count);
    Vectors soft = modes;
    for (Eigen::Index m = 0; m < count; ++m) s.lu.solve(soft.col(m).data());
    const Vectors held = modes.transpose() * soft;
    const Eigen::SelfAdjointEigenSolver<Vectors> ritz((held + held.transpose()) / 2);
    softness = ritz.eigenvalues();
    modes = soft * ritz.eigenvectors();
  }
  Eigen::Index softest = 0;
  if (out.negative_pivots <= 0) softness.cwiseAbs().maxCoeff(&softest);
  const Eigen::VectorXd mode = modes.col(softest).normalized();
  double greatest = 0, share = 0, loads = 0;
  for (int i = 0; i < s.count; ++i) {
    const Vec3 shift = mode.segment<3>(6 * i), load(&growth[6 * i]);
    share += shift.dot(load);
    loads += load.squaredNorm();
    if (shift.norm() <= greatest) continue;
    greatest = shift.norm();
    out.node = s.first + i;
    out.direction = shift / greatest;
  }
  // a mode has no sense of its own: the way that the loads push, or towards the axis that it is nearest to
  const bool pushed = std::abs(share) > k_beside * std::sqrt(loads) * greatest;
  Eigen::Index axis = 0;
  out.direction.cwiseAbs().maxCoeff(&axis);
  if ((pushed ? share : out.direction[axis]) < 0) out.direction = -out.direction;
  const bool hinged =
      ranges::any_of(s.elements, [](const ElementState& e) { return e.hinge != Hinge::none; });
  out.loss = hinged   ? Stability::Loss::mechanism
             : pushed ? Stability::Loss::limit_point
                      : Stability::Loss::buckling;
}

bool is_at_yield(const Model& model, const State& state, int index) {
  constexpr double k_at_yield = 1e-3;
  std::vector<SectionForces> forces(model.elements.size());
  section_forces(model, state, index, forces);
  const Body& body = model.bodies[index];
  for (int m = body.first_member; m < body.first_member + body.member_count; ++m)
    for (int k = 0; k < model.members[m].element_count; ++k) {
      const int e = model.members[m].first_element + k;
      const Element& element = model.elements[e];
      for (const double end : {-1., 1.})
        if (yield_function(element, forces_along(forces[e], element.length, element.s, end)) > -k_at_yield)
          return true;
    }
  return false;
}

bool add_collapse(const BodySystem& s, const std::vector<double>& growth, Stability& out) {
  std::vector<double> way = growth;
  s.lu.solve(way.data());
  double greatest = 0;
  for (int i = 0; i < s.count; ++i) {
    const Vec3 shift(&way[6 * i]);
    if (!(shift.norm() > greatest)) continue;
    greatest = shift.norm();
    out.node = s.first + i;
    out.direction = shift / greatest;
    out.loss = Stability::Loss::mechanism;
  }
  return greatest > 0;
}

bool is_free(const BodySystem& s) {
  constexpr double k_free = 1e8;
  double softest = std::numeric_limits<double>::infinity();
  for (const auto& own : s.own_elements) {
    const Element& element = s.model.elements[own.element];
    softest = std::min(softest, element.bending_stiffness.minCoeff() / std::pow(element.length, 3));
  }
  std::vector<double> x(6 * s.count);
  for (int i = 0; i < s.count; ++i) {
    Eigen::Map<Vec3> force(&x[6 * i]), moment(&x[6 * i + 3]);
    for (int k = 0; k < 3; ++k) force[k] = start_entry(6 * i + k);
    s.clear_fixed(i, force, moment);
  }
  s.lu.solve(x.data());
  double furthest = 0;
  for (int i = 0; i < s.count; ++i) furthest = std::max(furthest, Vec3(&x[6 * i]).norm());
  return !(furthest * softest < k_free);
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
