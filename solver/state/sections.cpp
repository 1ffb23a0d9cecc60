#include "solver/state/sections.h"

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
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    section_forces(model, state, static_cast<int>(b), forces);
}

}  // namespace topple
