#include "solver/frame/central_difference.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <new>

#include "solver/contact/contact_law.h"
#include "solver/element/beam.h"
#include "solver/frame/hinges.h"
#include "solver/frame/start_vector.h"
#include "solver/frame/work.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr int k_power_iterations = 400;
constexpr double k_ahead = 0.1;  // of h^2 times what is fast of the acceleration
constexpr double k_mean = 0.5;   // of the newest acceleration in its running mean

// Velocity v of a touching node with mass/(h/2) (v - v_half) = rest + contact forces at v.
Vec3 solve_velocity(const BodySystem& s, const ContactLaw& law, int node, double mass, double h,
                    const Vec3& half, const Vec3& rest, std::span<TouchingPair> pairs,
                    std::span<ContactInput> inputs) {
  Vec3 v = half;
  for (int iteration = 0; iteration < 30; ++iteration) {
    Vec3 residual = 2 * mass / h * (v - half) - rest;
    Mat3 slope = 2 * mass / h * Mat3::Identity();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      Mat3 by_position, by_velocity;
      inputs[k].velocity = v;
      pairs[k].out = contact_force(law, inputs[k], by_position, by_velocity);
      residual -= pairs[k].out.force;
      slope -= by_velocity;
    }
    const Vec3 correction = slope.inverse() * residual;
    v -= correction;
    for (int k = 0; k < 3; ++k)
      if (s.is_fixed(node, k)) v[k] = 0;
    if (!(correction.norm() > 1e-12 * (1 + v.norm()))) break;
  }
  return v;
}

// Of closed and sticking contacts, per node of the system.
std::vector<Mat3> contact_stiffness(const BodySystem& s, const ContactLaw& law) {
  std::vector<Mat3> sum(s.count, Mat3::Zero());
  const auto [along, across] = stiffness_bound(law);
  for (const ContactPoint& point : s.model.contact_points) {
    const int i = s.local(point.node);
    if (i < 0) continue;
    for (const Plane& plane : s.model.planes) {
      const double L = contact_length(point, plane);
      const Mat3 normal = plane.normal * plane.normal.transpose();
      sum[i] += law.alpha / L * (along * normal + across * (Mat3::Identity() - normal));
    }
  }
  if (s.model.bodies.size() < 2) return sum;
  for (const auto& own : s.own_elements) {
    const double L = contact_length(s.model, {own.element, own.element});
    for (const int i : {own.i, own.j})
      sum[i] += law.member_share * law.alpha / L * (along + across) * Mat3::Identity();
  }
  if (!s.model.surfaces) return sum;
  for (const Panel& panel : s.model.panels)
    for (const int node : panel.node)
      if (const int i = s.local(node); i >= 0)
        sum[i] += law.member_share * law.alpha / panel.width * (along + across) * Mat3::Identity();
  return sum;
}

// Contact forces between members at the new velocities instead of those that `force` has them at: sweeps over
// the touches, each of which is solved for its own relative velocity. False: they are settled as they were.
bool solve_member_contacts(BodySystem& s, const ContactLaw& law, double h, const std::vector<Vec3>& half) {
  constexpr int k_sweeps = 50;
  constexpr double k_settled = 1e-10;  // of the greatest force
  const auto compliance = [&](int i) {
    return (s.fixed[i] & 7u) == 7u ? 0 : h / 2 / s.model.node_mass[s.node[i]];
  };
  for (int sweep = 0; sweep < k_sweeps; ++sweep) {
    double greatest = 0, change = 0;
    for (MemberTouch& touch : s.contacts.members.touches) {
      const MemberPair& pair = s.member_pairs()[touch.pair];
      const ContactLaw own = weighted(law, touch);
      Vec3 rest = Vec3::Zero();
      double inverse = 0;
      for (int k = 0; k < pair.nodes(); ++k) {
        const double c = compliance(pair.node[k]);
        rest += touch.share[k] * (half[pair.node[k]] + c * s.force[pair.node[k]]);
        inverse += c * touch.share[k] * touch.share[k];
      }
      const Vec3 before = touch.out.force;
      rest -= inverse * before;
      Vec3& v = touch.input.velocity;
      for (int iteration = 0; iteration < 30; ++iteration) {
        Mat3 by_position, by_velocity;
        touch.out = contact_force(own, touch.input, by_position, by_velocity);
        const Mat3 slope = Mat3::Identity() - inverse * by_velocity;
        const Vec3 correction = slope.inverse() * (v - rest - inverse * touch.out.force);
        v -= correction;
        if (!(correction.norm() > 1e-12 * (1 + v.norm()))) break;
      }
      for (int k = 0; k < pair.nodes(); ++k)
        s.force[pair.node[k]] += touch.share[k] * (touch.out.force - before);
      greatest = std::max(greatest, touch.out.force.norm());
      change = std::max(change, (touch.out.force - before).norm());
    }
    if (!(change > k_settled * greatest)) return sweep > 0;
  }
  return true;
}

// Contacts between members enter `force` at the half-step velocity, then at the new one.
void add_member_contacts(BodySystem& s, const ContactLaw& law, double h, IntegratorScratch& w) {
  find_member_contacts(law, s.member_pairs(), w.trial.position, w.trial.velocity, w.start.position,
                       s.contacts.members);
  add_forces(s.contacts.members, s.member_pairs(), s.force);
  solve_member_contacts(s, law, h, w.trial.velocity);
}

// Forces of planes, solved at each touching node for its new velocity; `again`: in place of those that were
// added before. Inputs and outputs are made in their places: a copy waits for what was just stored.
void add_plane_contacts(BodySystem& s, const ContactLaw& of_all, std::span<const Vec3> stick, double h,
                        const IntegratorScratch& w, bool again) {
  std::vector<TouchingPair>& touching = s.contacts.planes;
  const auto at_new_velocity = traits(of_all).at_new_velocity;
  for (std::size_t k = 0; k < touching.size();) {
    const int i = touching[k].node;
    const ContactLaw law = s.on_plane(of_all, i);
    const Vec3& half = w.trial.velocity[i];
    std::size_t end = k;
    ContactInput inputs[8];
    for (; end < touching.size() && touching[end].node == i && end - k < 8; ++end) {
      if (again) s.force[i] -= touching[end].out.force;
      new (&inputs[end - k]) ContactInput(s.plane_contact(touching[end], w.trial, stick, w.start.position));
    }
    const double mass = s.model.node_mass[s.node[i]], impedance = 2 * mass / h;
    if (end - k == 1 && at_new_velocity && s.fixed[i] == 0) {
      new (&touching[k].out)
          ContactOutput(at_new_velocity(law, inputs[0], impedance, half + s.force[i] / impedance));
      s.force[i] = impedance * (inputs[0].velocity - half);
    } else {
      const std::span<TouchingPair> own(touching.data() + k, end - k);
      const Vec3 v = solve_velocity(s, law, i, mass, h, half, s.force[i], own, {inputs, own.size()});
      s.force[i] = impedance * (v - half);
    }
    k = end;
  }
}

// Whether a node that touches a plane belongs to parts that touch.
bool share_nodes(const Contacts& contacts, std::span<const MemberPair> pairs) {
  for (const MemberTouch& touch : contacts.members.touches)
    for (int k = 0; k < pairs[touch.pair].nodes(); ++k)
      for (const TouchingPair& plane : contacts.planes)
        if (touch.share[k] != 0 && plane.node == pairs[touch.pair].node[k]) return true;
  return false;
}

// Forces of all contacts, those of members and planes in turns where they have nodes in common, until both
// are those of the new velocities: friction would else do work that no force did.
void add_contacts(BodySystem& s, const ContactLaw& law, std::span<const Vec3> stick, double h,
                  IntegratorScratch& w) {
  constexpr int k_turns = 50;
  const bool members = !s.candidate_pairs.empty();
  if (members) add_member_contacts(s, law, h, w);
  add_plane_contacts(s, law, stick, h, w, false);
  if (!members || !share_nodes(s.contacts, s.member_pairs())) return;
  for (int turn = 0; turn < k_turns && solve_member_contacts(s, law, h, w.trial.velocity); ++turn)
    add_plane_contacts(s, law, stick, h, w, true);
}

// Velocities to the middle of the step, then positions and rotations to its end.
template <bool damped>
void half_step(const BodySystem& s, const State& state, double h, IntegratorScratch& w) {
  w.trial.resize(s.count);
  s.take(state.acceleration, w.acceleration);
  s.take(state.angular_acceleration, w.angular_acceleration);
  if constexpr (damped) {
    s.take(state.algorithmic_acceleration, w.algorithmic);
    s.take(state.algorithmic_angular_acceleration, w.algorithmic_angular);
  }
  const Four step(h), half(h / 2), ahead(k_ahead * h);
  for (const NodePack& pack : s.node_packs) {
    const PackVector<Four> acceleration = gather(w.acceleration.data(), pack.node),
                           angular = gather(w.angular_acceleration.data(), pack.node);
    PackVector<Four> v = mul_add(half, acceleration, gather(w.start.velocity.data(), pack.node)),
                     omega = mul_add(half, angular, gather(w.start.angular_velocity.data(), pack.node));
    scatter(v, w.trial.velocity.data(), pack.node);
    scatter(omega, w.trial.angular_velocity.data(), pack.node);
    if constexpr (damped) {
      const auto run_ahead = [&](const PackVector<Four>& now, std::vector<Vec3>& mean, PackVector<Four>& by) {
        const PackVector<Four> before = gather(mean.data(), pack.node),
                               after = mul_add(Four(k_mean), now - before, before);
        by = mul_add(ahead, now - after, by);
        scatter(after, mean.data(), pack.node);
      };
      run_ahead(acceleration, w.algorithmic, v);
      run_ahead(angular, w.algorithmic_angular, omega);
    }
    scatter(mul_add(step, v, gather(w.start.position.data(), pack.node)), w.trial.position.data(), pack.node);
    scatter(normalized(gather(w.start.rotation.data(), pack.node) * exponential(step * omega)),
            w.trial.rotation.data(), pack.node);
  }
}

// New accelerations and velocities from `force` and `moment`, and the new motion into `state`: ok, or
// not_finite.
template <bool damped>
StepStatus::Kind take_accelerations(const BodySystem& s, double h, IntegratorScratch& w, State& state,
                                    StepEnergy& energy) {
  BodyMotion& trial = w.trial;
  const Four half(h / 2);
  PackVector<Four> odd{0, 0, 0};
  Four taken(0);
  for (const NodePack& pack : s.node_packs) {
    const PackQuaternion<Four> q = gather(trial.rotation.data(), pack.node);
    const PackVector<Four> acceleration = pack.inverse_mass * gather(s.force.data(), pack.node);
    const PackVector<Four> velocity = mul_add(half, acceleration, gather(trial.velocity.data(), pack.node));
    const PackVector<Four> moment = rotate(conjugate(q), gather(s.moment.data(), pack.node));
    const PackVector<Four> middle = gather(trial.angular_velocity.data(), pack.node);
    PackVector<Four> omega = middle, angular{0, 0, 0};
    for (int pass = 0; pass < 3; ++pass) {  // the gyroscopic moment at the new velocity: a strong contraction
      angular = pack.inverse_inertia * (moment - cross(omega, pack.inertia * omega));
      omega = mul_add(half, angular, middle);
    }
    if constexpr (damped) {
      const PackVector<Four> before = gather(w.acceleration.data(), pack.node),
                             turning = gather(w.angular_acceleration.data(), pack.node);
      taken =
          taken + pack.mass * dot(before - gather(w.algorithmic.data(), pack.node), before + acceleration);
      taken = taken + dot(turning - gather(w.algorithmic_angular.data(), pack.node),
                          pack.inertia * (turning + angular));
    }
    scatter(velocity, trial.velocity.data(), pack.node);
    scatter(omega, trial.angular_velocity.data(), pack.node);
    scatter(acceleration, w.acceleration.data(), pack.node);
    scatter(angular, w.angular_acceleration.data(), pack.node);
    odd = odd + 0. * (acceleration + angular);
  }
  s.put(trial.position, state.position);
  s.put(trial.rotation, state.rotation);
  s.put(trial.velocity, state.velocity);
  s.put(trial.angular_velocity, state.angular_velocity);
  s.put(w.acceleration, state.acceleration);
  s.put(w.angular_acceleration, state.angular_acceleration);
  s.put(damped ? w.algorithmic : w.acceleration, state.algorithmic_acceleration);
  s.put(damped ? w.algorithmic_angular : w.angular_acceleration, state.algorithmic_angular_acceleration);
  if constexpr (damped) energy.numerical += k_ahead * h * h / 2 * sum(taken);
  return any_above(dot(odd, odd), 0) ? StepStatus::Kind::not_finite : StepStatus::Kind::ok;
}

// First node of the model whose motion is not finite.
int first_lost(const BodySystem& s, const State& state) {
  for (const int g : s.node)
    if (!std::isfinite(state.acceleration[g].sum() + state.angular_acceleration[g].sum())) return g;
  return s.node.front();
}

template <bool damped>
StepStatus advance(BodySystem& s, const StepSpan& span, State& state, IntegratorScratch& w,
                   StepEnergy& energy) {
  s.load(state, w.start);
  s.load_memory(state, w.start);
  const std::span<const Vec3> stick(state.stick);
  const ContactLaw& law = span.end.law;
  s.find_contacts(span.start.law, w.start, stick, w.start.position, w.contacts_start);
  half_step<damped>(s, state, span.h, w);
  do s.evaluate_free(span.parameters, span.end, w.trial);
  while (break_sections(s, w.trial));
  s.ends_here = true;
  s.find_plane_contacts(w.trial, s.contacts.planes);
  add_contacts(s, law, stick, span.h, w);
  for (int i = 0; i < s.count; ++i) s.clear_fixed(i, s.force[i], s.moment[i]);
  StepStatus status;
  status.kind = take_accelerations<damped>(s, span.h, w, state, energy);
  status.time = span.end.time;
  status.body = s.index;
  book_work(s, span, w.start, w.trial, w.contacts_start, s.contacts, energy);
  energy.plastic += commit_hinges(s, w.start, w.trial, state);
  s.store_stick(s.contacts, state);
  if (!status.ok()) {
    status.node = first_lost(s, state);
    status.element = s.element_at(status.node);
  }
  return status;
}

}  // namespace

StepStatus advance_central_difference(BodySystem& s, const StepSpan& span, State& state, IntegratorScratch& w,
                                      StepEnergy& energy) {
  return advance<false>(s, span, state, w, energy);
}

StepStatus advance_damped_central_difference(BodySystem& s, const StepSpan& span, State& state,
                                             IntegratorScratch& w, StepEnergy& energy) {
  return advance<true>(s, span, state, w, energy);
}

double explicit_limit(BodySystem& s, const ContactLaw* law, double damping, int* busiest) {
  const int n = s.count;
  const std::size_t count = s.own_elements.size();
  std::vector<Mat12> tangents(count);
  for (std::size_t e = 0; e < count; ++e)
    tangents[e] = beam_stiffness(s.model, s.model.elements[s.own_elements[e].element]);
  const std::vector<Mat3> held = law ? contact_stiffness(s, *law) : std::vector<Mat3>(n, Mat3::Zero());
  std::vector<Mat3> inverse(n);
  for (int i = 0; i < n; ++i) inverse[i] = s.model.node_inertia[s.node[i]].inverse();
  Eigen::VectorXd v(6 * n), kv(6 * n);
  for (int i = 0; i < 6 * n; ++i) v[i] = start_entry(i);
  double value = 0;
  for (int iteration = 0; iteration < k_power_iterations; ++iteration) {
    kv.setZero();
    for (std::size_t e = 0; e < count; ++e) {
      const auto [element, i, j] = s.own_elements[e];
      Eigen::Matrix<double, 12, 1> u;
      u << v.segment<6>(6 * i), v.segment<6>(6 * j);
      const Eigen::Matrix<double, 12, 1> f = tangents[e] * u;
      kv.segment<6>(6 * i) += f.head<6>();
      kv.segment<6>(6 * j) += f.tail<6>();
    }
    for (const BodySystem::OwnAnchor& one : s.anchors) {
      // k (u - u')^2 <= 2 k (u^2 + u'^2): the limits of both bodies alone hold for them together
      const Anchor& anchor = s.model.anchors[one.index];
      const auto& [node, reference] = one.own;
      const Vec3 shift = v.segment<3>(6 * node), spin = v.segment<3>(6 * node + 3);
      const Vec3 pull = (anchor.other.body < 0 ? 1 : 2) * anchor.stiffness * (shift + spin.cross(reference));
      kv.segment<3>(6 * node) += pull;
      kv.segment<3>(6 * node + 3) += reference.cross(pull);
    }
    for (int i = 0; i < n; ++i) {
      Vec3 translation =
          (kv.segment<3>(6 * i) + held[i] * v.segment<3>(6 * i)) / s.model.node_mass[s.node[i]];
      Vec3 rotation = inverse[i] * kv.segment<3>(6 * i + 3);
      s.clear_fixed(i, translation, rotation);
      kv.segment<3>(6 * i) = translation;
      kv.segment<3>(6 * i + 3) = rotation;
    }
    value = kv.norm() / v.norm();
    v = kv / kv.norm();
  }
  double most = -1;
  for (int i = 0; busiest && i < n; ++i) {
    const int g = s.node[i];
    const Vec3 shift = v.segment<3>(6 * i), spin = v.segment<3>(6 * i + 3);
    const double share =
        s.model.node_mass[g] * shift.squaredNorm() + spin.dot(s.model.node_inertia[g] * spin);
    if (share > most) {
      most = share;
      *busiest = g;
    }
  }
  return std::sqrt(damping * damping + 4 / value) - damping;
}

}  // namespace topple
