#include "solver/central_difference.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "solver/beam.h"
#include "solver/hinges.h"
#include "solver/rotation.h"

namespace topple {
namespace {

constexpr int k_power_iterations = 400;

bool fixed_direction(const BodySystem& s, int node, int direction) {
  return s.fixed[node] >> direction & 1;
}

void clear_fixed(const BodySystem& s, int node, Vec3& translation, Vec3& rotation) {
  for (int k = 0; k < 3; ++k) {
    if (fixed_direction(s, node, k)) translation[k] = 0;
    if (fixed_direction(s, node, 3 + k)) rotation[k] = 0;
  }
}

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
      if (fixed_direction(s, node, k)) v[k] = 0;
    if (!(correction.norm() > 1e-12 * (1 + v.norm()))) break;
  }
  return v;
}

// Of closed and sticking contacts, per node of the system.
std::vector<Mat3> contact_stiffness(const BodySystem& s, const ContactLaw& law) {
  std::vector<Mat3> sum(s.count, Mat3::Zero());
  const double slope = law.q < 1 ? law.q * std::pow(0.01, law.q - 1) : law.q;
  for (const ContactPoint& point : s.model.contact_points) {
    const int i = s.local(point.node);
    if (i < 0) continue;
    for (const Plane& plane : s.model.planes) {
      const double L = (point.width + (plane.width > 0 ? plane.width : point.width)) / 2;
      const Mat3 normal = plane.normal * plane.normal.transpose();
      sum[i] += law.alpha / L * (slope * normal + k_stick_stiffness * (Mat3::Identity() - normal));
    }
  }
  if (s.model.bodies.size() < 2) return sum;
  for (const auto& own : s.own_elements) {
    const double L = contact_length(s.model, {own.element, own.element});
    for (const int i : {own.i, own.j})
      sum[i] += law.alpha / L * (slope + k_stick_stiffness) * Mat3::Identity();
  }
  return sum;
}

// Contact forces between members at the new velocities instead of the half-step ones that `force` has them
// at: sweeps over the touches, each of which is solved for its own relative velocity.
void solve_member_contacts(BodySystem& s, const ContactLaw& law, double h, const std::vector<Vec3>& half) {
  constexpr int k_sweeps = 50;
  constexpr double k_settled = 1e-10;  // of the greatest force
  const auto compliance = [&](int i) {
    return (s.fixed[i] & 7u) == 7u ? 0 : h / 2 / s.model.node_mass[s.node[i]];
  };
  for (int sweep = 0; sweep < k_sweeps; ++sweep) {
    double greatest = 0, change = 0;
    for (MemberTouch& touch : s.contacts.members.touches) {
      const MemberPair& pair = s.member_pairs()[touch.pair];
      ContactLaw weighted = law;
      weighted.alpha *= touch.weight;
      Vec3 rest = Vec3::Zero();
      double inverse = 0;
      for (int k = 0; k < 4; ++k) {
        const double c = compliance(pair.node[k]);
        rest += touch.share[k] * (half[pair.node[k]] + c * s.force[pair.node[k]]);
        inverse += c * touch.share[k] * touch.share[k];
      }
      const Vec3 before = touch.out.force;
      rest -= inverse * before;
      Vec3& v = touch.input.velocity;
      for (int iteration = 0; iteration < 30; ++iteration) {
        Mat3 by_position, by_velocity;
        touch.out = contact_force(weighted, touch.input, by_position, by_velocity);
        const Mat3 slope = Mat3::Identity() - inverse * by_velocity;
        const Vec3 correction = slope.inverse() * (v - rest - inverse * touch.out.force);
        v -= correction;
        if (!(correction.norm() > 1e-12 * (1 + v.norm()))) break;
      }
      for (int k = 0; k < 4; ++k) s.force[pair.node[k]] += touch.share[k] * (touch.out.force - before);
      greatest = std::max(greatest, touch.out.force.norm());
      change = std::max(change, (touch.out.force - before).norm());
    }
    if (!(change > k_settled * greatest)) return;
  }
}

}  // namespace

StepStatus advance_central_difference(BodySystem& s, const Parameters& p, State& state, double t, double h,
                                      IntegratorScratch& w, StepEnergy& energy) {
  const int n = s.count;
  s.load(state, w.start);
  s.load_memory(state);
  w.trial.resize(n);
  w.travel.resize(n);
  const std::span<const Vec3> stick(state.stick);
  s.find_contacts(contact_law(p, t), w.start, stick, w.start.position, w.contacts_start);
  for (int i = 0; i < n; ++i) {
    const int g = s.node[i];
    w.trial.velocity[i] = w.start.velocity[i] + h / 2 * state.acceleration[g];
    w.trial.angular_velocity[i] = w.start.angular_velocity[i] + h / 2 * state.angular_acceleration[g];
    w.trial.position[i] = w.start.position[i] + h * w.trial.velocity[i];
    w.trial.rotation[i] = w.start.rotation[i] * exp_quaternion(h * w.trial.angular_velocity[i]);
    w.trial.rotation[i].normalize();
  }
  HingeStep hinges;
  do s.evaluate(p, t + h, w.trial, stick, w.start.position);
  while (update_hinges(s, w.trial, hinges));

  // Contacts enter `force` at the half-step velocity; at touching nodes they are solved for at the new one.
  solve_member_contacts(s, contact_law(p, t + h), h, w.trial.velocity);
  std::vector<TouchingPair>& touching = s.contacts.planes;
  for (std::size_t k = 0; k < touching.size();) {
    const int i = touching[k].node;
    std::size_t end = k;
    Vec3 rest = s.force[i];
    ContactInput inputs[8];
    for (; end < touching.size() && touching[end].node == i && end - k < 8; ++end) {
      rest -= touching[end].out.force;
      inputs[end - k] = s.plane_contact(touching[end], w.trial, stick, w.start.position);
    }
    const std::span<TouchingPair> own(touching.data() + k, end - k);
    const double mass = s.model.node_mass[s.node[i]];
    const Vec3 v = solve_velocity(s, contact_law(p, t + h), i, mass, h, w.trial.velocity[i], rest, own,
                                  {inputs, own.size()});
    s.force[i] = 2 * mass / h * (v - w.trial.velocity[i]);
    k = end;
  }

  int lost = -1;  // first node whose motion is not finite
  for (int i = 0; i < n; ++i) {
    const int g = s.node[i];
    const Mat3& j = s.model.node_inertia[g];
    clear_fixed(s, i, s.force[i], s.moment[i]);
    const Vec3 acceleration = s.force[i] / s.model.node_mass[g];
    const Vec3 moment = w.trial.rotation[i].conjugate() * s.moment[i];
    const Vec3 half = w.trial.angular_velocity[i];
    const Mat3 inverse = j.inverse();
    Vec3 omega = half, angular = Vec3::Zero();
    for (int pass = 0; pass < 3; ++pass) {  // the gyroscopic moment at the new velocity: a strong contraction
      angular = inverse * (moment - omega.cross(j * omega));
      omega = half + h / 2 * angular;
    }
    w.trial.velocity[i] += h / 2 * acceleration;
    w.trial.angular_velocity[i] = omega;
    state.position[g] = w.trial.position[i];
    state.rotation[g] = w.trial.rotation[i];
    state.velocity[g] = w.trial.velocity[i];
    state.angular_velocity[g] = omega;
    state.acceleration[g] = state.algorithmic_acceleration[g] = acceleration;
    state.angular_acceleration[g] = state.algorithmic_angular_acceleration[g] = angular;
    if (lost < 0 && !std::isfinite(acceleration.sum() + angular.sum() + w.trial.position[i].sum())) lost = g;
  }
  book_work(s, p, t, h, w.start, w.trial, w.contacts_start, s.contacts, energy);
  energy.plastic += commit_hinges(s, w.start, w.trial, state);
  s.store_stick(s.contacts, state);
  StepStatus status;
  status.time = t + h;
  status.body = s.index;
  if (lost >= 0) {
    status.kind = StepStatus::Kind::not_finite;
    status.node = lost;
    status.element = s.element_at(lost);
  }
  return status;
}

double explicit_limit(BodySystem& s, const ContactLaw* law, int* busiest) {
  const int n = s.count;
  const std::size_t count = s.own_elements.size();
  std::vector<Mat12> tangents(count);
  for (std::size_t e = 0; e < count; ++e) {
    const Element& element = s.model.elements[s.own_elements[e].element];
    BeamGradient gradient;
    const auto& x = s.model.node_position;
    beam_tangent(
        element, ElementState{},
        beam_ends(element, x[element.node[0]], Quat::Identity(), x[element.node[1]], Quat::Identity()),
        gradient, tangents[e]);
  }
  const std::vector<Mat3> held = law ? contact_stiffness(s, *law) : std::vector<Mat3>(n, Mat3::Zero());
  std::vector<Mat3> inverse(n);
  for (int i = 0; i < n; ++i) inverse[i] = s.model.node_inertia[s.node[i]].inverse();
  Eigen::VectorXd v(6 * n), kv(6 * n);
  for (int i = 0; i < 6 * n; ++i)
    v[i] = std::sin(1 + 2.7 * i);  // any start that no symmetry of a body shares
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
    for (int i = 0; i < n; ++i) {
      Vec3 translation =
          (kv.segment<3>(6 * i) + held[i] * v.segment<3>(6 * i)) / s.model.node_mass[s.node[i]];
      Vec3 rotation = inverse[i] * kv.segment<3>(6 * i + 3);
      clear_fixed(s, i, translation, rotation);
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
  return 2 / std::sqrt(value);
}

}  // namespace topple
