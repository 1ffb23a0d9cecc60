#include "solver/reduced/contact_impulses.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "solver/contact/coulomb.h"
#include "solver/contact/penalty.h"
#include "solver/reduced/rigid_solver.h"

namespace topple {
namespace {

constexpr double k_error = 1e-7;       // of the speed
constexpr int k_iterations = 50;       // of Newton
constexpr int k_held_after = 15;       // of them: limits of friction are held
constexpr int k_looks = 8;             // along a correction
constexpr double k_least_share = 0.1;  // of what is left of it, between two looks
constexpr double k_turned_back = 0.5;  // of what is left along a correction, with the other sign: too far
constexpr double k_resolved = 4;       // rad in a step, of a bounce on contacts, which is then half implicit

using Points = PackVector<Four>;

PackMatrix<Four> no_slope() {
  const Points none = in_all_lanes(Vec3::Zero());
  return {{none, none, none}};
}

}  // namespace

// Sums over contacts of -d(force)/d(velocity) t and of its products with the arms r of both bodies.
struct ContactImpulses::Slopes {
  PackMatrix<Four> t = no_slope(), left[2] = {t, t}, right[2] = {t, t};  // t, [r] t, t [r]
  PackMatrix<Four> both[2][2] = {{t, t}, {t, t}};                        // [r_i] t [r_j]

  [[gnu::always_inline]] void add(const PackMatrix<Four>& slope, const Points (&arm)[2], int bodies) {
    t = t + slope;
    for (int j = 0; j < bodies; ++j) {
      const PackMatrix<Four> turned = times_skew(slope, arm[j]);
      right[j] = right[j] + turned;
      left[j] = left[j] + skew_times(arm[j], slope);
      for (int i = 0; i < bodies; ++i) both[i][j] = both[i][j] + skew_times(arm[i], turned);
    }
  }
  // factor J_i^T t J_j, J = [1, -[r]] of the first body and the opposite of the second.
  Mat6 block(int i, int j, double factor) const {
    const double f = i == j ? factor : -factor;
    Mat6 out;
    out.block<3, 3>(0, 0) = unpacked(f * sum(t));
    out.block<3, 3>(0, 3) = unpacked(-f * sum(right[j]));
    out.block<3, 3>(3, 0) = unpacked(f * sum(left[i]));
    out.block<3, 3>(3, 3) = unpacked(-f * sum(both[i][j]));
    return out;
  }
};

void ContactImpulses::begin(const PreparedLaw& law, double h) {
  law_ = &law;
  h_ = h;
  bodies_.clear();
  u_.clear();
  contacts_.clear();
  touching_.clear();
}

void ContactImpulses::add(const RigidBody& body, const Velocity& guess) {
  bodies_.push_back(body);
  u_.push_back(guess);
}

int ContactImpulses::add(int first, int second, double grip, bool hardens, const NearContact& contact) {
  const auto same = [&](const Touching& of) {
    return of.body[0] == first && of.body[1] == second && of.hardens == hardens;
  };
  if (touching_.empty() || !same(touching_.back()))
    touching_.push_back(
        {{first, second}, gripped(*law_, grip), hardens, static_cast<int>(contacts_.size()), 0});
  const double k = contact.alpha / contact.L * std::max(1., law_->q);
  for (int side = 0; side < (second < 0 ? 1 : 2); ++side) {
    RigidBody& body = bodies_[side == 0 ? first : second];
    body.stiffness += k * (1 / body.mass + contact.arm[side].squaredNorm() / body.least_inertia);
  }
  int& count = touching_.back().count;
  const int lane = count++ % 4;
  if (lane == 0) {
    const Points none = in_all_lanes(Vec3::Zero());
    contacts_.push_back({in_all_lanes(Vec3::UnitZ()), {none, none}, none, none, -1, 1, 0, 0, 0});
  }
  FourContacts& to = contacts_.back();
  set_lane(to.normal, lane, contact.normal);
  for (int side = 0; side < 2; ++side) set_lane(to.arm[side], lane, contact.arm[side]);
  set_lane(to.stick, lane, contact.stick);
  to.depth.set(lane, contact.depth);
  to.L.set(lane, contact.L);
  to.alpha.set(lane, contact.alpha);
  to.k.set(lane, contact.stick_stiffness);
  to.c.set(lane, contact.stick_damping);
  set_lane(to.turning, lane, contact.turning);
  return 4 * (static_cast<int>(contacts_.size()) - 1) + lane;
}

// What is left of the equations, and their slopes.
template <ContactImpulses::Sums sums>
void ContactImpulses::evaluate(BlockLu* matrix) {
  if constexpr (sums == Sums::slopes) matrix->set_zero();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RigidBody& body = bodies_[b];
    const PackVec3 linear = body.mass * (u_[b].linear - body.linear) - h_ * body.force,
                   angular = body.inertia * (u_[b].angular - body.angular) - h_ * body.moment;
    put({linear, angular, {}}, 0, &left_[6 * b]);
    if constexpr (sums == Sums::slopes) {
      Mat6 own = Mat6::Zero();
      own.diagonal().head<3>().setConstant(body.mass);
      own.block<3, 3>(3, 3) = unpacked(body.inertia);
      matrix->add(static_cast<int>(b), static_cast<int>(b), own);
    }
  }
  for (const Touching& of : touching_) evaluate<sums>(of, matrix);
}

// Velocities of two bodies, and of points of the first relative to the second.
struct ContactImpulses::Motion {
  Points linear[2], angular[2];
  int bodies;

  template <class Of>
  Motion(const Touching& of, const Of& bodies_at) : bodies(of.body[1] < 0 ? 1 : 2) {
    for (int side = 0; side < bodies; ++side) {
      linear[side] = in_all_lanes(bodies_at[of.body[side]].linear);
      angular[side] = in_all_lanes(bodies_at[of.body[side]].angular);
    }
  }
  [[gnu::always_inline]] Points at(const FourContacts& contacts) const {
    const Points first = linear[0] + cross(angular[0], contacts.arm[0]);
    return bodies == 1 ? first : first - (linear[1] + cross(angular[1], contacts.arm[1]));
  }
};

// Four contacts that move at v: their springs' force and its slope, N and N/m, with what adds up along the
// normals of the law.
struct ContactImpulses::Springs {
  Four::Mask touching;
  Four p, stiffness;

  [[gnu::always_inline]] Springs(const Touching& of, const FourContacts& at, Four vn, double ahead,
                                 bool with_slope) {
    const PreparedLaw& law = of.law;
    const Four reached = at.depth - Four(ahead) * vn / at.L;
    touching = Four(0) < reached;
    const Four depth = choose(touching, reached, Four(0));
    p = at.alpha * penalty_power(depth, law.q);
    stiffness = at.alpha / at.L;
    if (with_slope && law.q != 1) stiffness = stiffness * penalty_slope(depth, law.q);
    if (of.hardens && any_above(depth, k_hardening_depth))
      for (int k = 0; k < 4; ++k) {
        if (!(depth[k] > k_hardening_depth)) continue;
        const double share = at.alpha[k] / law.alpha;
        p.set(k, share * penalty_force(law, depth[k], true));
        stiffness.set(k, share * penalty_stiffness(law, depth[k], at.L[k], true));
      }
    stiffness = choose(touching, stiffness, Four(0));
  }
};

template <ContactImpulses::Sums sums>
[[gnu::flatten]] void ContactImpulses::evaluate(const Touching& of, BlockLu* matrix) {
  const PreparedLaw& law = of.law;
  const bool weakens = law.excess() > 0;
  const Motion motion(of, u_), before(of, bodies_);
  const int bodies = motion.bodies;
  const Points none = in_all_lanes(Vec3::Zero());
  Points force = none, moment[2] = {none, none};
  Four normal_work = Four(0), friction_work = normal_work;
  Slopes slopes;
  FourContacts* const end = &contacts_[of.first] + (of.count + 3) / 4;
  for (FourContacts* at = &contacts_[of.first]; at != end; ++at) {
    const Points &n = at->normal, v = motion.at(*at), at_end = v + at->turning,
                 mean = mul_add(Four(0.5), at->turning, v);
    const Springs springs(of, *at, dot(n, mean), ahead_, sums == Sums::slopes);
    const auto f = coulomb_force(law, law.loss, weakens, n, at_end, mul_add(Four(h_ / 2), mean, at->stick),
                                 springs.touching, springs.p, at->k, at->c);
    const Points along = -f.scale * f.trial, push = mul_add(f.normal, n, along);
    force = force + push;
    for (int side = 0; side < bodies; ++side) moment[side] = moment[side] + cross(at->arm[side], push);
    if constexpr (sums == Sums::slopes) {
      const Four by_normal = normal_slope(law, law.loss, springs.p, f.inverse) -
                             Four(ahead_) * springs.stiffness * f.factor,
                 across = mul_add(Four(h_ / 2), at->k, at->c) * f.scale;
      PackMatrix<Four> slope = diagonal(Points{across, across, across}) - outer((by_normal + across) * n, n);
      if (f.slips)
        slope = slope -
                slip_slope(law, weakens && !holds_limits_, f, n, holds_limits_ ? Four(0) : by_normal, across);
      slopes.add(slope, at->arm, bodies);
    } else if constexpr (sums == Sums::work) {
      const Points of_step = Four(0.5) * (before.at(*at) + v);
      normal_work -= f.normal * dot(n, of_step);
      friction_work -= dot(along, of_step);
      at->stick = held_share(at->k, dot(f.stick, f.stick), f.limit, springs.touching) * f.stick;
    }
  }
  for (int side = 0; side < bodies; ++side) {
    const double factor = side == 0 ? -h_ : h_;
    double* left = &left_[6 * of.body[side]];
    const Points& turning = moment[side];
    for (const Four* of_force : {&force.x, &force.y, &force.z}) *left++ += factor * sum(*of_force);
    for (const Four* of_moment : {&turning.x, &turning.y, &turning.z}) *left++ += factor * sum(*of_moment);
  }
  if constexpr (sums == Sums::slopes) {
    for (int i = 0; i < bodies; ++i)
      for (int j = 0; j < bodies; ++j) matrix->add(of.body[i], of.body[j], slopes.block(i, j, h_));
  } else if constexpr (sums == Sums::work) {
    work_.normal += h_ * sum(normal_work);
    work_.friction += h_ * sum(friction_work);
  }
}

// Takes `part` of the correction off the velocities.
void ContactImpulses::move(double part) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const BodyVelocity by = taken(&correction_[6 * b], 0);
    u_[b].linear = u_[b].linear - part * by.linear;
    u_[b].angular = u_[b].angular - part * by.angular;
  }
}

// What is left, times the correction.
double ContactImpulses::along_correction() const {
  double sum = 0;
  for (std::size_t k = 0; k < left_.size(); ++k) sum += left_[k] * correction_[k];
  return sum;
}

// Of a correction that went too far, for contacts opened, closed or slipped in it: goes back to where little
// is left along it (regula falsi, Illinois).
void ContactImpulses::search(double before, double after) {
  const double enough = k_turned_back * before;
  double low = 0, high = 1, part = 1;
  bool was_beyond = true;
  for (int look = 0; look < k_looks; ++look) {
    const double next =
        low + (high - low) * std::clamp(before / (before - after), k_least_share, 1 - k_least_share);
    move(next - part);
    part = next;
    evaluate<Sums::loads>(nullptr);
    const double now = along_correction();
    if (std::abs(now) <= enough) return;
    const bool beyond = now < 0;
    (beyond ? high : low) = part;
    (beyond ? after : before) = now;
    if (beyond == was_beyond) (beyond ? before : after) /= 2;
    was_beyond = beyond;
  }
}

bool ContactImpulses::strikes(double speed) const {
  for (const Touching& of : touching_) {
    const Motion motion(of, bodies_);
    for (int k = 0; k < (of.count + 3) / 4; ++k) {
      const FourContacts& at = contacts_[of.first + k];
      const Four vn = dot(at.normal, motion.at(at)), reached = at.depth - Four(h_ / 2) * vn / at.L;
      if (bits((Four(speed) < magnitude(vn)) & ((Four(0) < at.depth) | (Four(0) < reached))) != 0)
        return true;
    }
  }
  return false;
}

double ContactImpulses::frequency() const {
  double stiffest = 0;
  for (const RigidBody& body : bodies_) stiffest = std::max(stiffest, body.stiffness);
  return std::sqrt(stiffest);
}

bool ContactImpulses::solve(BlockLu& matrix) {
  left_.resize(6 * bodies_.size());
  const double turn = h_ * frequency() / k_resolved;
  ahead_ = h_ / 2 * turn * turn / (1 + turn * turn);
  holds_limits_ = false;
  double last = 0;  // correction, m/s
  evaluate<Sums::slopes>(&matrix);
  for (int iteration = 0; iteration < k_iterations; ++iteration) {
    if (matrix.factor() >= 0) return false;
    correction_ = left_;
    matrix.solve(correction_.data());
    const double before = along_correction();
    if (!(before > 0) && !holds_limits_) {  // no way down
      holds_limits_ = true;
      evaluate<Sums::slopes>(&matrix);
      continue;
    }
    move(1);
    double size = 0, over = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const BodyVelocity by = taken(&correction_[6 * b], 0);
      const double own = velocity_size(bodies_[b].reach, by.linear, by.angular);
      size = std::max(size, own);
      over =
          std::max(over, own / (k_slow_speed + velocity_size(bodies_[b].reach, u_[b].linear, u_[b].angular)));
      if (!std::isfinite(own)) return false;
    }
    // what is left after a correction: its square over that of the law's smoothing, or by the rate so far
    if (over * std::min(1., size / (holds_limits_ ? last : law_->bend)) <= k_error) return true;
    last = size;
    evaluate<Sums::loads>(nullptr);
    const double after = along_correction();
    if (after < -k_turned_back * before) search(before, after);
    holds_limits_ = holds_limits_ || iteration + 1 >= k_held_after;
    evaluate<Sums::slopes>(&matrix);
  }
  return false;
}

ContactImpulses::Work ContactImpulses::finish() {
  work_ = {};
  evaluate<Sums::work>(nullptr);
  return work_;
}

}  // namespace topple
