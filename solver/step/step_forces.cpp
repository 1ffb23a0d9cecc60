#include "solver/step/step_forces.h"

#include <algorithm>
#include <tuple>

#include "solver/contact/contact_law.h"

namespace topple {

bool blame_hardest_contact(const Model& model, Workspace::Impl& w, StepStatus& status) {
  double greatest = 0;
  const auto blame = [&](const BodySystem& system, double force, int node) {
    if (!(force > greatest)) return;
    greatest = force;
    status.node = node;
    status.body = system.model.node_body[node];
    status.element = system.element_at(node);
  };
  for (std::size_t b = 0; b < w.next.bodies.size(); ++b) {
    if (w.next.bodies[b].rung == Rung::frame) continue;
    w.contact_forces.clear();
    w.reduced_bodies[b]->list_contacts(w.contact_forces);
    for (const ContactForce& force : w.contact_forces)
      if (force.normal > greatest) {
        greatest = force.normal;
        status.body = static_cast<int>(b);
        status.node = model.contact_points[force.point].node;
        status.element = -1;
      }
  }
  for (const BodySystem* system : w.systems()) {
    for (const TouchingPair& pair : system->contacts.planes)
      blame(*system, pair.out.normal, system->node[pair.node]);
    for (const MemberTouch& touch : system->contacts.members.touches)
      blame(*system, touch.out.normal, system->node[system->member_pairs()[touch.pair].node[0]]);
  }
  return greatest > 0;
}

const std::vector<ContactForce>& contact_forces(const Model& model, const Parameters& parameters,
                                                const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  w.contact_forces.clear();
  w.member_forces.clear();
  w.islands.arrange(state.bodies, state.near);
  const Instant now(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (state.bodies[b].rung == Rung::frame) continue;
    ReducedBody& body = w.reduced(model, state, b);
    body.find_contacts(now, state.bodies[b], state.stick);
    body.section_forces(state.bodies[b], w.sections);
    body.list_contacts(w.contact_forces);
  }
  for (auto& system : w.systems()) {
    system->load(state, w.motion);
    system->load_memory(state);
    system->find_contacts(contact_law(parameters, state.time), w.motion, state.stick, w.motion.position,
                          w.contacts);
    for (const TouchingPair& pair : w.contacts.planes)
      w.contact_forces.push_back({pair.point, pair.plane, pair.depth, pair.out.normal, pair.out.force});
    for (const MemberTouch& touch : w.contacts.members.touches)
      w.member_forces.push_back(
          {system->near[touch.pair], touch.at.s, touch.at.t, touch.depth, touch.out.force});
  }
  std::sort(w.contact_forces.begin(), w.contact_forces.end(),
            [](const ContactForce& a, const ContactForce& b) {
              return std::tie(a.point, a.plane) < std::tie(b.point, b.plane);
            });
  return w.contact_forces;
}

const std::vector<MemberForce>& member_forces(Workspace& workspace) {
  return workspace.impl().member_forces;
}

const std::vector<SectionForces>& section_forces(Workspace& workspace) {
  return workspace.impl().sections;
}

}  // namespace topple
