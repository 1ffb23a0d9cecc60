#include "solver/frame/settle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/frame/find_rest.h"
#include "solver/frame/hinges.h"
#include "solver/frame/start_vector.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

// Steps, of the size. Slender members that turn far in one step stretch, and throw the body off, as a wall
// does with what goes deep into it; a body on soft contacts may sink farther than short steps lead.
constexpr double k_short = 0.002, k_long = 0.01;

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
    Mat6 block = Mat6::Zero();
    block.diagonal().head<3>().setConstant(s.node_mass[i] / (sigma * sigma));
    block.bottomRightCorner<3, 3>() = s.node_inertia[i] / (sigma * sigma);
    s.lu.add(i, i, block);
    for (int k = 0; k < 6; ++k)
      if (s.is_fixed(i, k)) s.lu.fix(i, k);
  }
}

// A balance that tips over by itself: (K + M/sigma^2)^-1 M/sigma^2 enlarges some small motion. Newton finds
// such balances as readily as stable ones. sigma: half the time in which a body of this size falls over.
bool tips_over(BodySystem& s, const Parameters& still, const StepInputs& now, const State& state,
               IntegratorScratch& w) {
  constexpr int k_rounds = 60;
  const double g = still.gravity.norm();
  if (!(g > 0)) return false;
  const double sigma = 0.5 * std::sqrt(s.size / g);
  s.lu.set_zero();
  s.evaluate_with_tangent(still, now, w.start, state.stick, w.start.position, 0);
  add_mass(s, sigma);
  if (s.lu.factor() >= 0) return true;
  std::vector<double>& v = w.right_hand_side;
  for (int i = 0; i < 6 * s.count; ++i) v[i] = start_entry(i);
  double growth = 1;
  for (int round = 0; round < k_rounds; ++round) {
    double before = 0, after = 0;
    for (int i = 0; i < s.count; ++i) {
      Eigen::Map<Vec3> shift(&v[6 * i]), spin(&v[6 * i + 3]);
      s.clear_fixed(i, shift, spin);
      const Vec3 impulse = s.node_mass[i] * shift, turn = s.node_inertia[i] * spin;
      before += impulse.dot(shift) + turn.dot(spin);
      shift = impulse / (sigma * sigma);
      spin = turn / (sigma * sigma);
      s.clear_fixed(i, shift, spin);
    }
    s.lu.solve(v.data());
    for (int i = 0; i < s.count; ++i) {
      const Vec3 shift(&v[6 * i]), spin(&v[6 * i + 3]);
      after += s.node_mass[i] * shift.squaredNorm() + spin.dot(s.node_inertia[i] * spin);
    }
    if (!(after > 0)) return false;  // held everywhere
    growth = std::sqrt(after / before);
    for (double& x : v) x /= std::sqrt(after);
  }
  return !(growth < 1 + 1e-3);  // free sliding has a growth of one
}

// Of find_rest.
class FrameRest {
 public:
  FrameRest(BodySystem& system, const Parameters& parameters, State& state, IntegratorScratch& scratch)
      : size(system.size),
        s_(system),
        still_(at_rest(parameters)),
        now_(still_, 0),
        state_(state),
        w_(scratch) {
    s_.load(state, w_.start);
    s_.load_memory(state, w_.start);
    std::fill(w_.start.velocity.begin(), w_.start.velocity.end(), Vec3::Zero());
    std::fill(w_.start.angular_velocity.begin(), w_.start.angular_velocity.end(), Vec3::Zero());
    before_ = w_.start;
    w_.right_hand_side.resize(6 * s_.count);
    balanced = k_balance * s_.mass * parameters.gravity.norm() + rounding(s_, before_.position);
    status_.time = state.time;
    status_.body = s_.index;
    status_.kind = StepStatus::Kind::not_settled;
  }

  double unbalance() {
    s_.lu.set_zero();
    s_.evaluate_with_tangent(still_, now_, w_.start, state_.stick, w_.start.position, 0);
    double left = 0;
    for (int i = 0; i < s_.count; ++i) {
      Eigen::Map<Vec3> force(&w_.right_hand_side[6 * i]), moment(&w_.right_hand_side[6 * i + 3]);
      force = s_.force[i];
      moment = s_.moment[i];
      s_.clear_fixed(i, force, moment);
      left = std::max({left, force.cwiseAbs().maxCoeff(), moment.cwiseAbs().maxCoeff() / size});
    }
    s_.store_stick(s_.contacts, state_);
    s_.load_sticks(state_);
    return left;
  }

  Balance look() {
    if (!s_.loads_grow && break_sections(s_, w_.start)) return Balance::not_final;
    return tips_over(s_, still_, now_, state_, w_) ? Balance::tips_over : Balance::rest;
  }

  std::optional<RestStep> step(double sigma) {
    add_mass(s_, sigma);
    if (const int singular = s_.lu.factor(); singular >= 0) {
      blame(singular);
      return std::nullopt;
    }
    s_.lu.solve(w_.right_hand_side.data());
    w_.trial = w_.start;
    RestStep out{0, 0};
    for (int i = 0; i < s_.count; ++i) {
      const Vec3 shift(&w_.right_hand_side[6 * i]), spin(&w_.right_hand_side[6 * i + 3]);
      w_.trial.position[i] += shift;
      w_.trial.rotation[i] = exp_quaternion(spin) * w_.trial.rotation[i];
      w_.trial.rotation[i].normalize();
      out.length = std::max(out.length, shift.norm());
      if (!std::isfinite(shift.sum() + spin.sum())) return std::nullopt;
    }
    s_.place_carried(w_.trial);
    for (int i = 0; i < s_.count; ++i) {
      const double travel = (w_.trial.position[i] - before_.position[i]).norm();
      if (!(travel <= out.furthest)) {
        out.furthest = travel;
        blame(i);
      }
    }
    return out;
  }

  // Stick springs travel along: evaluates them from where they were.
  void follow() {
    s_.find_contacts(still_.contact, w_.trial, state_.stick, w_.start.position, s_.contacts);
    s_.store_stick(s_.contacts, state_);
    s_.load_sticks(state_);
    std::swap(w_.start, w_.trial);
  }

  // Where it came to rest becomes the state.
  StepStatus accept() {
    if (!s_.loads_grow) commit_hinges(s_, before_, w_.start, state_);
    s_.store(w_.start, state_);
    StepStatus status;
    status.time = state_.time;
    return status;
  }

  // Without rest.
  StepStatus status(Balance found) {
    status_.no_rest = no_rest(found);
    return status_;
  }

  const double size;
  double balanced;

 private:
  void blame(int node) {
    status_.node = s_.node[node];
    status_.body = s_.model.node_body[status_.node];
    status_.element = s_.element_at(status_.node);
  }

  BodySystem& s_;
  const Parameters still_;
  const StepInputs now_;
  State& state_;
  IntegratorScratch& w_;
  BodyMotion before_;
  StepStatus status_;
};

// Frames that start deep within a plane, onto it: there it pushes with more than they ever bear.
void lift_out(const BodySystem& s, State& state) {
  const Model& model = s.model;
  for (int i = 0; i < s.count; ++i) {
    const int index = model.node_body[s.node[i]];
    const Body& body = model.bodies[index];
    if (s.node[i] != body.first_node || state.bodies[index].level != ModelLevel::frame) continue;
    const auto is_own = [&](const Support& support) { return model.node_body[support.node] == index; };
    if (ranges::any_of(model.supports, is_own)) continue;
    for (const Plane& plane : model.planes) {
      double deepest = 0;
      for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
        const ContactPoint& point = model.contact_points[p];
        deepest =
            std::max(deepest, point.width / 2 - plane.normal.dot(state.position[point.node] - plane.point));
      }
      for (int n = body.first_node; n < body.first_node + body.node_count; ++n)
        state.position[n] += deepest * plane.normal;
    }
  }
}

}  // namespace

StepStatus settle_system(BodySystem& s, const Parameters& parameters, State& state, IntegratorScratch& w) {
  const std::vector<Vec3> stick = state.stick;
  FrameRest body(s, parameters, state, w);
  const Balance found = find_rest(body, k_short);
  if (found == Balance::rest) return body.accept();
  if (found == Balance::tips_over) return body.status(found);
  state.stick = stick;
  lift_out(s, state);
  FrameRest again(s, parameters, state, w);
  const Balance then = find_rest(again, k_long);
  return then == Balance::rest ? again.accept() : again.status(then == Balance::none ? found : then);
}

}  // namespace topple
