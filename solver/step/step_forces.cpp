#include "solver/step/step_forces.h"

#include <algorithm>
#include <tuple>

#include "solver/step/workspace_impl.h"

namespace topple {
namespace {

const std::vector<ContactForce>& list_forces(const Parameters& parameters, const StepInputs& now,
                                             const State& state, Workspace::Impl& w) {
  w.forces.contacts.clear();
  w.forces.members.clear();
  w.parts.arrange(state);
  for (const auto& part : w.parts.all()) part->list_forces(parameters, now, state, w.forces);
  std::sort(w.forces.contacts.begin(), w.forces.contacts.end(),
            [](const ContactForce& a, const ContactForce& b) {
              return std::tie(a.point, a.plane) < std::tie(b.point, b.plane);
            });
  return w.forces.contacts;
}

}  // namespace

const std::vector<ContactForce>& contact_forces(const Model&, const Parameters& parameters,
                                                const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  const bool edited = !(w.parameters == parameters);
  if (edited) w.parts.forget_parameters();
  list_forces(parameters, StepInputs(parameters, state.time), state, w);
  if (edited) w.parts.forget_parameters();  // those of the last step may come back
  return w.forces.contacts;
}

const std::vector<ContactForce>& contact_forces_after_step(const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  return list_forces(*w.parameters, *w.reached, state, w);
}

const std::vector<MemberForce>& member_forces(Workspace& workspace) {
  return workspace.impl().forces.members;
}

const std::vector<SectionForces>& section_forces(Workspace& workspace) {
  return workspace.impl().parts.sections;
}

void find_section_forces(const State& state, int body, Workspace& workspace) {
  workspace.impl().parts.find_sections(state, body);
}

bool may_exceed(const State& state, int body, double stress, double yield_ratio, Workspace& workspace) {
  constexpr double k_rounding = 1 + 1e-12;  // of the bound and of what it is compared with
  const ReducedBody& elastic = workspace.impl().parts.reduced(state, body);
  const BodyState& s = state.bodies[body];
  return k_rounding * elastic.stress_bound(s) > stress || k_rounding * elastic.yield_bound(s) > yield_ratio;
}

}  // namespace topple
