#include "solver/body/planar_part.h"

#include <algorithm>

#include "solver/state/profile.h"
#include "solver/state/step_limits.h"

namespace topple {

bool PlanarPart::has(const std::vector<char>& marked) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const Member& m) { return marked[m.index]; });
}

// A block at rest has settled; one whose centre of gravity is not above its base tips over.
StepStatus PlanarPart::settle(const Parameters& parameters, State& state, PartScratch&) {
  StepStatus status;
  for (const auto& [index, body] : bodies_) {
    if (body->stands(parameters, state)) continue;
    status.kind = StepStatus::Kind::not_settled;
    status.no_rest = NoRest::tips_over;
    status.time = state.time;
    status.body = index;
    break;
  }
  return status;
}

BodyEnergy PlanarPart::balance(const Parameters& parameters, const StepInputs& now,
                               const std::vector<char>& marked, State& state) {
  BodyEnergy held;
  for (const auto& [index, body] : bodies_)
    if (marked[index]) held += body->balance(parameters, now, state);
  return held;
}

BodyEnergy PlanarPart::energy(const StepInputs&, const State& state) {
  BodyEnergy held;
  for (const auto& [index, body] : bodies_) held += body->energy(state);
  return held;
}

void PlanarPart::advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  const InPhase phase(scratch.frame.profile, Phase::reduced);
  for (const auto& [index, body] : bodies_) {
    body->take_planned(next, outcome.exchanged);
    outcome.held += body->balance(span.parameters, span.end, next);
  }
}

double PlanarPart::time_limit(const Parameters& parameters, const State& state) {
  double limit = k_longest_step;
  for (const auto& [index, body] : bodies_) limit = std::min(limit, body->time_limit(parameters, state));
  return limit;
}

void PlanarPart::list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                             Forces& forces) {
  for (const auto& [index, body] : bodies_) body->list_contacts(parameters, now, state, forces.contacts);
}

}  // namespace topple
