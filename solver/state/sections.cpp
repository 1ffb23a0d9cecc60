#include "solver/state/sections.h"

#include <algorithm>

#include "solver/element/plasticity.h"

namespace topple {

void section_forces(const Model& model, const State& state, int index, std::vector<SectionForces>& forces) {
  const Body& body = model.bodies[index];
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0], j = element.node[1];
    const BeamStrain strain = beam_strain(
        element, beam_ends(state.position[i], state.rotation[i], state.position[j], state.rotation[j]));
    forces[e] = respond(element, state.elements[e], strain).forces;
  }
}

void section_forces(const Model& model, const State& state, std::vector<SectionForces>& forces) {
  forces.resize(model.elements.size());
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    if (traits(state.bodies[b].level).has_stresses)
      section_forces(model, state, b, forces);
    else
      std::fill_n(forces.begin() + body.first_element, body.element_count,
                  SectionForces{Vec3::Zero(), Vec3::Zero()});
  }
}

}  // namespace topple
