// How a run begins, or goes on from a checkpoint.
#include "solver/body/anchors.h"
#include "solver/body/candidates.h"
#include "solver/state/sections.h"
#include "solver/step/step.h"
#include "solver/step/workspace_impl.h"

namespace topple {
namespace {

// What bodies are computed as, and the anchors that are in place.
void start_models(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  w.invalidate_caches(parameters);
  place_nodes(model, state);
  state.candidate_margin = 0;
  update_candidates(model, w.search, state, 0);
  w.changed.assign(model.bodies.size(), false);
  switch_anchors(model, parameters, state, w.changed);
  w.models.start(model, parameters, state, w.parts);
}

}  // namespace

StepStatus settle(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  StepStatus status = look_at_numbers(model, parameters, state, true);
  if (!status.ok()) return status;
  Workspace::Impl& w = workspace.impl();
  start_models(model, parameters, state, w);
  w.parts.with_sticks(state, [&] {
    for (const auto& part : w.parts.all())
      if (status.ok()) status = part->settle(parameters, state, w.scratches[0]);
  });
  return status;
}

void prepare(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  start_models(model, parameters, state, w);
  break_anchors(model, state, w.changed);
  state.energy.released = 0;  // what settling left in them was never in the run
  const BodyEnergy held = w.parts.balance(parameters, StepInputs(parameters, state.time), state);
  state.law = parameters.contact.kind;
  state.energy.open(held);
}

void resume(const Model& model, const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  w.parts.arrange(state);
  section_forces(model, state, w.parts.sections);
}

}  // namespace topple
