#include "solver/body/rungs.h"

#include <algorithm>
#include <cmath>

#include "solver/element/plasticity.h"
#include "solver/run/overturn.h"
#include "solver/step/balance.h"

namespace topple {
namespace {

void find_base(const Model& model, const Parameters& p, Workspace::Impl& w) {
  if (!w.base.empty()) return;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) w.base.push_back(base_rung(model, p, b));
}

void find_near(const Model& model, const State& state, Workspace::Impl& w) {
  std::ranges::fill(w.near, false);
  for (const ElementPair& pair : state.near)
    for (const int e : {pair.a, pair.b}) w.near[model.members[model.elements[e].member].body] = true;
}

// Greatest sqrt(f + 1) of a body's sections.
double yield_ratio(const Model& model, int b, const std::vector<SectionForces>& sections) {
  const Body& body = model.bodies[b];
  double greatest = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    if (!std::isfinite(element.capacity[0])) continue;
    for (const int end : {-1, 1})
      greatest = std::max(
          greatest,
          std::sqrt(1 + yield_function(element, forces_along(sections[e], element.length, element.s, end))));
  }
  return greatest;
}

// Nothing keeps a frame from coming down.
bool is_calm(const Model& model, const Parameters& parameters, const State& state, int b,
             Workspace::Impl& w) {
  const Body& body = model.bodies[b];
  double strain = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const ElementState& element = state.elements[e];
    if (element.hinge != Hinge::none || !element.offset.gamma.isZero(0) || !element.offset.kappa.isZero(0))
      return false;
    strain += section_energy(model.elements[e], w.sections[e]);
  }
  return !w.near[b] && strain < k_negligible * body.mass * parameters.gravity.norm() * body.reach &&
         yield_ratio(model, b, w.sections) < k_calm_yield;
}

// The rung that a body takes at `state`. The contacts of those that are not frames have been found.
RungChoice choose_rung(const Model& model, const Parameters& parameters, State& state, int b,
                       Workspace::Impl& w) {
  BodyState& s = state.bodies[b];
  const RungChoice& base = w.base[b];
  if (base.rung == Rung::frame) return base;
  if (w.near[b]) return {Rung::frame, RungReason::near};
  if (s.rung == Rung::frame) {
    if (!is_calm(model, parameters, state, b, w))
      s.calm_since = -1;
    else if (s.calm_since < 0)
      s.calm_since = state.time;
    else if (state.time - s.calm_since >= k_calm_for)
      return {base.rung, RungReason::calm};
    return {s.rung, s.reason};
  }
  const bool automatic = parameters.models[b] == BodyModel::automatic;
  if (s.rung == Rung::elastic && automatic) {
    ReducedBody& body = w.reduced(model, state, b);
    if (body.rotation_bound(s) > k_small_rotation) return {Rung::frame, RungReason::deformation};
    if (body.yield_bound(s) > k_near_yield) {
      body.section_forces(s, w.sections);
      if (yield_ratio(model, b, w.sections) > k_near_yield) return {Rung::frame, RungReason::yield};
    }
  }
  return s.rung == base.rung ? RungChoice{s.rung, s.reason} : base;
}

// Takes a body to another rung. `now`: contacts of its present one have been found.
void change_rung(const Model& model, const Parameters& parameters, const Instant& now, RungChoice choice,
                 int b, State& state, Workspace::Impl& w) {
  BodyState& s = state.bodies[b];
  const auto total = [](const BodyEnergy& e) { return e.kinetic + e.strain + e.contact + e.anchor; };
  const auto of_frame = [&] {
    BodySystem& system = *w.islands.alone(b);
    system.load(state, w.motion);
    system.load_memory(state);
    system.find_contacts(now.law, w.motion, state.stick, w.motion.position, system.contacts);
    return total(system.energy(now.law, w.motion, system.contacts, w.sections));
  };
  ReducedBody& body = w.reduced(model, state, b);
  const double height = body_pose(model, state, b).centre.dot(parameters.gravity);
  const double before = s.rung == Rung::frame ? of_frame() : total(body.energy(now.law, s));
  if (choice.rung == Rung::frame) {
    place_nodes(model, state);
    body.add_residual(s, state);
    w.new_frames[b] = true;
  } else if (s.rung == Rung::frame) {
    s = reduce(model, state, b, choice.rung);
  } else if (choice.rung == Rung::rigid) {
    s.amplitude.setZero();
    s.rate.setZero();
  }
  if ((choice.rung == Rung::frame) != (s.rung == Rung::frame)) w.explicit_limit.reset();
  s.rung = choice.rung;
  s.reason = choice.reason;
  s.calm_since = -1;
  const double after =
      s.rung == Rung::frame ? of_frame() : total(body.balance(parameters, now, s, state.stick));
  const double sunk = height - body_pose(model, state, b).centre.dot(parameters.gravity);
  state.energy.model_switch += after - before + model.bodies[b].mass * sunk;
  state.energy.gravity += model.bodies[b].mass * sunk;
}

}  // namespace

void start_rungs(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  w.meet(parameters);
  place_nodes(model, state);
  state.near_slack = 0;
  look_around(model, w.search, state, 0);
  find_base(model, parameters, w);
  find_near(model, state, w);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const RungChoice choice =
        w.near[b] && w.base[b].rung != Rung::frame ? RungChoice{Rung::frame, RungReason::near} : w.base[b];
    BodyState& s = state.bodies[b];
    if (s.rung == Rung::frame && choice.rung != Rung::frame) s = reduce(model, state, b, choice.rung);
    s.rung = choice.rung;
    s.reason = choice.reason;
  }
  w.islands.arrange(state.bodies, state.near);
}

void change_rungs(const Model& model, const Parameters& parameters, const Instant& now, State& state,
                  Workspace::Impl& w) {
  find_base(model, parameters, w);
  find_near(model, state, w);
  std::ranges::fill(w.new_frames, false);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    BodyState& s = state.bodies[b];
    if (s.rung != Rung::frame) w.reduced(model, state, b).find_contacts(now, s, state.stick);
    const RungChoice choice = choose_rung(model, parameters, state, b, w);
    if (choice.rung == s.rung) {
      s.reason = choice.reason;
    } else {
      change_rung(model, parameters, now, choice, b, state, w);
    }
  }
  w.islands.arrange(state.bodies, state.near);
  if (!w.systems().empty()) balance_again(model, parameters, now, w.new_frames, state, w);
}

}  // namespace topple
