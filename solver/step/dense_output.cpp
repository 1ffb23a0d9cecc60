#include "solver/step/dense_output.h"

#include <algorithm>

#include "solver/body/model_level.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/step/workspace_impl.h"

namespace topple {
namespace {

// Cubic Hermite polynomial over a step of size h, s, at its share t: weights of the values at both ends and
// of the rates there, for the value and for its rate.
struct Hermite {
  double value[2], rate[2];
  double value_rate[2], rate_rate[2];

  Hermite(double h, double t)
      : value{(1 + 2 * t) * (1 - t) * (1 - t), t * t * (3 - 2 * t)},
        rate{h * t * (1 - t) * (1 - t), h * t * t * (t - 1)},
        value_rate{6 * t * (t - 1) / h, 6 * t * (1 - t) / h},
        rate_rate{(1 - t) * (1 - 3 * t), t * (3 * t - 2)} {}

  // x, v: at the end on entry, at t on return.
  template <class Vector>
  void move(const Vector& x0, const Vector& v0, Vector& x, Vector& v) const {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double x1 = x[i], v1 = v[i];
      x[i] = value[0] * x0[i] + rate[0] * v0[i] + value[1] * x1 + rate[1] * v1;
      v[i] = value_rate[0] * x0[i] + rate_rate[0] * v0[i] + value_rate[1] * x1 + rate_rate[1] * v1;
    }
  }

  // Of the rotation vector psi from the start, q = q0 exp(psi), w = T(-psi) dpsi/dt in material axes.
  void turn(const Quat& q0, const Vec3& w0, Quat& q, Vec3& w) const {
    Vec3 psi = log_quaternion(q0.conjugate() * q);
    const InverseJacobianCoefficient inverse(psi.squaredNorm());
    Vec3 speed = w + psi.cross(w) / 2 + inverse.g * psi.cross(psi.cross(w));
    move<Vec3>(Vec3::Zero(), w0, psi, speed);
    const ExpCoefficients f(psi.squaredNorm());
    q = (q0 * exp_quaternion(psi)).normalized();
    w = speed - f.f1 * psi.cross(speed) + f.f2 * psi.cross(psi.cross(speed));
  }
};

constexpr double EnergyLedger::*k_energies[] = {
    &EnergyLedger::input,          &EnergyLedger::kinetic,      &EnergyLedger::strain,
    &EnergyLedger::gravity,        &EnergyLedger::contact,      &EnergyLedger::friction,
    &EnergyLedger::normal_damping, &EnergyLedger::numerical,    &EnergyLedger::plastic,
    &EnergyLedger::damping,        &EnergyLedger::model_switch, &EnergyLedger::anchor,
    &EnergyLedger::released,       &EnergyLedger::start_total,  &EnergyLedger::largest};

void move_nodes(const Body& body, const Hermite& hermite, const State& start, State& at) {
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    hermite.move(start.position[i], start.velocity[i], at.position[i], at.velocity[i]);
    hermite.turn(start.rotation[i], start.angular_velocity[i], at.rotation[i], at.angular_velocity[i]);
  }
}

void move_body(const Hermite& hermite, const BodyState& start, BodyState& at) {
  hermite.move(start.position, start.velocity, at.position, at.velocity);
  hermite.turn(start.rotation, start.angular_velocity, at.rotation, at.angular_velocity);
  hermite.move(start.amplitude, start.rate, at.amplitude, at.rate);
}

}  // namespace

void state_between(const Model& model, const State& start, const State& end, double time, State& at) {
  const double h = end.time - start.time, t = (time - start.time) / h;
  const Hermite hermite(h, t);
  const auto mix = [&](const auto& a, auto& b) { b = (1 - t) * a + t * b; };
  const auto moves_nodes = [](const BodyState& body) { return traits(body.level).moves_nodes; };
  copy(end, at,
       at.position.size() != end.position.size() || ranges::any_of(start.bodies, moves_nodes) ||
           ranges::any_of(end.bodies, moves_nodes));
  State placed;
  const State* from = &start;
  if (!ranges::equal(start.bodies, end.bodies, {}, &BodyState::level, &BodyState::level)) {
    placed = start;
    place_nodes(model, placed);
    from = &placed;
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    BodyState& s = at.bodies[b];
    const bool was_frame = start.bodies[b].level == ModelLevel::frame;
    if (s.level == ModelLevel::frame) {
      move_nodes(body, hermite, *from, at);
      for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
        mix(start.elements[e].offset.gamma, at.elements[e].offset.gamma);
        mix(start.elements[e].offset.kappa, at.elements[e].offset.kappa);
      }
    } else {
      move_body(hermite, was_frame ? reduce(model, *from, b, s.level) : start.bodies[b], s);
    }
  }
  for (std::size_t k = 0; k < at.stick.size(); ++k) mix(start.stick[k], at.stick[k]);
  for (const auto member : k_energies) mix(start.energy.*member, at.energy.*member);
  hermite.move(start.floor_displacement, start.floor_velocity, at.floor_displacement, at.floor_velocity);
  at.anchors = start.anchors;
  at.step = start.step;
  at.time = time;
}

void state_within_step(const Model& model, const State& end, double time, Workspace& workspace, State& at) {
  Workspace::Impl& w = workspace.impl();
  state_between(model, w.next, end, time, at);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (traits(w.next.bodies[b].level).has_block && traits(at.bodies[b].level).has_block)
      w.parts.planar(b).place_within(*w.parameters, w.next, end, time, at);
}

}  // namespace topple
