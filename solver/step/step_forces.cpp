#include "solver/step/step_forces.h"

#include <algorithm>
#include <tuple>

#include "solver/step/workspace_impl.h"

namespace topple {

const std::vector<ContactForce>& contact_forces(const Model&, const Parameters& parameters,
                                                const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  w.forces.contacts.clear();
  w.forces.members.clear();
  w.parts.arrange(state);
  const StepInputs now(parameters, state.time);
  for (const auto& part : w.parts.all()) part->list_forces(parameters, now, state, w.forces);
  std::sort(w.forces.contacts.begin(), w.forces.contacts.end(),
            [](const ContactForce& a, const ContactForce& b) {
              return std::tie(a.point, a.plane) < std::tie(b.point, b.plane);
            });
  return w.forces.contacts;
}

const std::vector<MemberForce>& member_forces(Workspace& workspace) {
  return workspace.impl().forces.members;
}

const std::vector<SectionForces>& section_forces(Workspace& workspace) {
  return workspace.impl().parts.sections;
}

}  // namespace topple
