#include "solver/frame/settle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/frame/hinges.h"
#include "solver/math/elementary.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr int k_most_rounds = 400;
constexpr double k_first_sigma = 1e-3;  // s
constexpr double k_last_sigma = 1e3;    // s
constexpr double k_balance = 1e-10;     // of the body's weight, greatest force left on a node
constexpr double k_furthest = 0.25;     // of the body's size: more is falling, not settling

// Force that rounding of the coordinates makes in the stiffest element, N.
double rounding(const BodySystem& s, const std::vector<Vec3>& position) {
  double stiffness = 0, reach = s.size;
  for (const auto& own : s.own_elements) {
    const Element& element = s.model.elements[own.element];
    stiffness = std::max(stiffness, element.normal_stiffness.x() / element.length);
  }
  for (const auto& own : s.anchors) stiffness = std::max(stiffness, s.model.anchors[own.index].stiffness);
  for (const Vec3& x : position) reach = std::max(reach, x.norm());
  return 8 * std::numeric_limits<double>::epsilon() * reach * stiffness;
}

// K + M/sigma^2 of the last evaluation's tangent, and its fixed rows, into the solver.
void add_mass(BodySystem& s, double sigma) {
  for (int i = 0; i < s.count; ++i) {
    const int g = s.node[i];
    Mat6 block = Mat6::Zero();
    block.diagonal().head<3>().setConstant(s.model.node_mass[g] / (sigma * sigma));
    block.bottomRightCorner<3, 3>() = s.model.node_inertia[g] / (sigma * sigma);
    s.lu.add(i, i, block);
    for (int k = 0; k < 6; ++k)
      if (s.fixed[i] >> k & 1) s.lu.fix(i, k);
  }
}

// A balance that tips over by itself: (K + M/sigma^2)^-1 M/sigma^2 enlarges some small motion. Newton finds
// such balances as readily as stable ones. sigma: half the time in which a body of this size falls over.
bool tips_over(BodySystem& s, const Parameters& still, const State& state, IntegratorScratch& w) {
  constexpr int k_rounds = 60;
  const double g = still.gravity.norm();
  if (!(g > 0)) return false;
  const double sigma = 0.5 * std::sqrt(s.size / g);
  s.lu.set_zero();
  s.evaluate_with_tangent(still, 0, w.start, state.stick, w.start.position, 0);
  add_mass(s, sigma);
  if (s.lu.factor() >= 0) return true;
  std::vector<double>& v = w.right_hand_side;
  for (int i = 0; i < 6 * s.count; ++i)
    v[i] = elementary::sin(1 + 2.7 * i);  // no symmetry of a body shares it
  double growth = 1;
  for (int round = 0; round < k_rounds; ++round) {
    double before = 0, after = 0;
    for (int i = 0; i < s.count; ++i) {
      Eigen::Map<Vec3> shift(&v[6 * i]), spin(&v[6 * i + 3]);
      for (int k = 0; k < 6; ++k)
        if (s.fixed[i] >> k & 1) v[6 * i + k] = 0;
      const Vec3 impulse = s.model.node_mass[s.node[i]] * shift,
                 turn = s.model.node_inertia[s.node[i]] * spin;
      before += impulse.dot(shift) + turn.dot(spin);
      shift = impulse / (sigma * sigma);
      spin = turn / (sigma * sigma);
      for (int k = 0; k < 6; ++k)
        if (s.fixed[i] >> k & 1) v[6 * i + k] = 0;
    }
    s.lu.solve(v.data());
    for (int i = 0; i < s.count; ++i) {
      const Vec3 shift(&v[6 * i]), spin(&v[6 * i + 3]);
      after += s.model.node_mass[s.node[i]] * shift.squaredNorm() +
               spin.dot(s.model.node_inertia[s.node[i]] * spin);
    }
    if (!(after > 0)) return false;  // held everywhere
    growth = std::sqrt(after / before);
    for (double& x : v) x /= std::sqrt(after);
  }
  return !(growth < 1 + 1e-3);  // free sliding has a growth of one
}

}  // namespace

StepStatus settle_system(BodySystem& s, const Parameters& parameters, State& state, IntegratorScratch& w) {
  Parameters still = parameters;
  still.shakes.clear();
  still.contact.kind = ContactLawKind::coulomb;
  still.contact.restitution = 1;  // the normal force of Eq. 2 alone
  const int n = s.count;
  s.load(state, w.start);
  s.load_memory(state);
  std::fill(w.start.velocity.begin(), w.start.velocity.end(), Vec3::Zero());
  std::fill(w.start.angular_velocity.begin(), w.start.angular_velocity.end(), Vec3::Zero());
  const BodyMotion before = w.start;
  const std::vector<Vec3>& origin = before.position;
  HingeStep hinges;
  w.right_hand_side.resize(6 * n);
  const double weight = s.mass * parameters.gravity.norm();
  const double balanced = k_balance * weight + rounding(s, origin);
  double sigma = k_first_sigma;
  StepStatus status;
  status.time = state.time;
  status.body = s.index;
  status.kind = StepStatus::Kind::not_settled;
  const auto blame = [&](int node) {
    status.node = s.node[node];
    status.body = s.model.node_body[status.node];
    status.element = s.element_at(status.node);
  };
  for (int round = 0; round < k_most_rounds; ++round) {
    s.lu.set_zero();
    s.evaluate_with_tangent(still, 0, w.start, state.stick, w.start.position, 0);
    double left = 0;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k) {
        w.right_hand_side[6 * i + k] = s.fixed[i] >> k & 1 ? 0 : s.force[i][k];
        w.right_hand_side[6 * i + 3 + k] = s.fixed[i] >> (3 + k) & 1 ? 0 : s.moment[i][k];
        left = std::max({left, std::abs(w.right_hand_side[6 * i + k]),
                         std::abs(w.right_hand_side[6 * i + 3 + k]) / s.size});
      }
    }
    add_mass(s, sigma);
    s.store_stick(s.contacts, state);
    s.load_sticks(state);
    if (left < balanced && sigma > 1) {
      if (!s.loads_grow && update_hinges(s, w.start, hinges)) {
        sigma = k_first_sigma;
        continue;
      }
      if (tips_over(s, still, state, w)) return status;
      if (!s.loads_grow) commit_hinges(s, before, w.start, state);
      for (int i = 0; i < n; ++i) {
        const int g = s.node[i];
        state.position[g] = w.start.position[i];
        state.rotation[g] = w.start.rotation[i];
        state.velocity[g].setZero();
        state.angular_velocity[g].setZero();
      }
      status = {};
      status.time = state.time;
      return status;
    }
    if (const int singular = s.lu.factor(); singular >= 0) {
      blame(singular);
      return status;
    }
    s.lu.solve(w.right_hand_side.data());
    w.trial = w.start;
    double furthest = 0, step = 0;
    for (int i = 0; i < n; ++i) {
      const Vec3 shift(&w.right_hand_side[6 * i]), spin(&w.right_hand_side[6 * i + 3]);
      w.trial.position[i] += shift;
      w.trial.rotation[i] = exp_quaternion(spin) * w.trial.rotation[i];
      w.trial.rotation[i].normalize();
      step = std::max(step, shift.norm());
      const double travel = (w.trial.position[i] - origin[i]).norm();
      if (!(travel <= furthest)) {
        furthest = travel;
        blame(i);
      }
      if (!std::isfinite(furthest + spin.sum())) return status;
    }
    if (furthest > k_furthest * s.size) return status;
    // stick springs travel along: evaluate them from where they were
    s.find_contacts(still.contact, w.trial, state.stick, w.start.position, s.contacts);
    s.store_stick(s.contacts, state);
    s.load_sticks(state);
    std::swap(w.start, w.trial);
    sigma = std::clamp(sigma * (step < 0.01 * s.size ? 2 : 0.5), k_first_sigma / 16, k_last_sigma);
  }
  return status;
}

}  // namespace topple
