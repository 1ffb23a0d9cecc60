#include "solver/body/reduced_part.h"

#include <algorithm>

#include "solver/reduced/bodies_at_rest.h"
#include "solver/state/profile.h"
#include "solver/state/step_limits.h"

namespace topple {

bool ReducedPart::has(const std::vector<char>& marked) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const ModelBody& m) { return marked[m.index]; });
}

StepStatus ReducedPart::settle(const Parameters& parameters, State& state, PartScratch&) {
  for (const ModelBody& one : bodies_) {
    one.body->remember(state.anchors);
    if (const StepStatus status = settle_bodies({&one, 1}, nullptr, parameters, state); !status.ok())
      return status;
  }
  return {};
}

BodyEnergy ReducedPart::balance(const Parameters& parameters, const StepInputs& now,
                                const std::vector<char>& marked, State& state) {
  BodyEnergy held;
  for (const auto& [index, body] : bodies_) {
    if (!marked[index]) continue;
    body->remember(state.anchors);
    held += body->balance(parameters, now, state.bodies[index], state.stick);
  }
  return held;
}

BodyEnergy ReducedPart::energy(const StepInputs& now, const State& state) {
  BodyEnergy held;
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    body->find_contacts(now, state.bodies[index], state.stick);
    held += body->energy(now.law, state.bodies[index]);
  }
  return held;
}

void ReducedPart::advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  const InPhase phase(scratch.frame.profile, Phase::reduced);
  for (const auto& [index, body] : bodies_) {
    BodyState& s = next.bodies[index];
    body->remember(next.anchors);
    body->take(span.start.pulls);
    outcome.status.kind = body->advance(span.parameters, span.start, span.end, span.h, s, next.stick,
                                        outcome.exchanged, scratch.reduced);
    if (!outcome.status.ok()) {
      outcome.status.time = span.end.time;
      outcome.status.body = index;
      return;
    }
    outcome.held += body->energy(span.end.law, s);
  }
}

double ReducedPart::time_limit(const Parameters& parameters, const State& state) {
  const ContactLaw law = contact_law(parameters, state.time);
  double limit = k_longest_step;
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    limit = std::min(limit, body->look_ahead(parameters, law, state.bodies[index]));
  }
  return limit;
}

void ReducedPart::find_forces(const StepInputs& now, const State& state, bool) {
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    body->find_contacts(now, state.bodies[index], state.stick);
    body->clear_member_forces();
  }
}

void ReducedPart::list_forces(const Parameters&, const StepInputs& now, const State& state, Forces& forces) {
  find_forces(now, state, true);
  for (const auto& [index, body] : bodies_) body->list_contacts(forces.contacts);
}

HardestContact ReducedPart::hardest_contact(const HardestContact& hardest) {
  HardestContact found = hardest;
  std::vector<ContactForce> forces;
  for (const auto& [index, body] : bodies_) {
    forces.clear();
    body->list_contacts(forces);
    for (const ContactForce& force : forces)
      if (force.normal > found.force) found = {force.normal, index, body->node_of(force.point)};
  }
  return found;
}

}  // namespace topple
