#include "solver/state/sections.h"

namespace topple {

void section_forces(const Model& model, const State& state, std::vector<SectionForces>& forces) {
  forces.resize(model.elements.size());
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    const int i = element.node[0], j = element.node[1];
    const BeamStrain strain = beam_strain(
        element, beam_ends(state.position[i], state.rotation[i], state.position[j], state.rotation[j]));
    forces[e] = section_forces(element, elastic_strain(state.elements[e], strain));
  }
}

}  // namespace topple
