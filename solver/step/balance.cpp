#include "solver/step/balance.h"

#include <Eigen/LU>
#include <algorithm>

namespace topple {

void add(const BodyEnergy& part, BodyEnergy& sum) {
  sum.kinetic += part.kinetic;
  sum.strain += part.strain;
  sum.contact += part.contact;
  sum.anchor += part.anchor;
}

void take(const BodyEnergy& held, EnergyLedger& energy) {
  energy.kinetic = held.kinetic;
  energy.strain = held.strain;
  energy.contact = held.contact;
  energy.anchor = held.anchor;
}

void balance_accelerations(BodySystem& s, const Parameters& parameters, State& state, BodyMotion& motion) {
  s.load(state, motion);
  s.load_memory(state);
  s.evaluate(parameters, state.time, motion, state.stick, motion.position);
  for (int i = 0; i < s.count; ++i) {
    const int g = s.node[i];
    for (int k = 0; k < 3; ++k) {
      if (s.fixed[i] >> k & 1) s.force[i][k] = 0;
      if (s.fixed[i] >> (3 + k) & 1) s.moment[i][k] = 0;
    }
    const Mat3& j = s.model.node_inertia[g];
    const Vec3& omega = state.angular_velocity[g];
    state.acceleration[g] = state.algorithmic_acceleration[g] = s.force[i] / s.model.node_mass[g];
    state.angular_acceleration[g] = state.algorithmic_angular_acceleration[g] =
        j.inverse() * (state.rotation[g].conjugate() * s.moment[i] - omega.cross(j * omega));
  }
}

BodyEnergy balance_all(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  BodyEnergy held;
  const Instant now(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (state.bodies[b].rung != Rung::frame)
      add(w.reduced(model, state, b).balance(parameters, now, state.bodies[b], state.stick), held);
  for (BodySystem* system : w.systems()) {
    balance_accelerations(*system, parameters, state, w.motion);
    add(system->energy(now.law, w.motion, system->contacts, w.sections), held);
  }
  return held;
}

void change_law(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  const double before = state.energy.contact;
  state.law = parameters.contact.kind;
  state.energy.contact = balance_all(model, parameters, state, w).contact;
  state.energy.input += state.energy.contact - before;
}

void balance_again(const Model& model, const Parameters& parameters, const Instant& now,
                   const std::vector<char>& changed, State& state, Workspace::Impl& w) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (changed[b] && state.bodies[b].rung != Rung::frame)
      w.reduced(model, state, b).balance(parameters, now, state.bodies[b], state.stick);
  for (BodySystem* system : w.systems())
    if (std::any_of(system->bodies.begin(), system->bodies.end(), [&](int b) { return changed[b]; }))
      balance_accelerations(*system, parameters, state, w.motion);
}

}  // namespace topple
