#include "solver/frame/hinges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/element/beam.h"
#include "solver/element/plasticity.h"

namespace topple {
namespace {

BeamStrain strain_at(const BodySystem& s, std::size_t k, const BodyMotion& motion) {
  const auto [e, i, j] = s.own_elements[k];
  return beam_strain(s.model.elements[e], beam_ends(motion.position[i], motion.rotation[i],
                                                    motion.position[j], motion.rotation[j]));
}

// Of an element that `response` leaves at rest or flowing, and that had `before`.
Hinge hinges_of(const Element& element, const SectionResponse& response, Hinge before) {
  bool there[2];
  for (int k = 0; k < 2; ++k) {
    const SectionForces at = forces_along(response.forces, element.length, element.s, element.hinge_place[k]);
    there[k] =
        response.multiplier[k] > 0 || (has_hinge(before, k) && yield_function(element, at) >= -k_unloading);
  }
  if (element.hinge_place[0] == element.hinge_place[1]) return there[0] ? Hinge::middle : Hinge::none;
  return there[0] && there[1] ? Hinge::both
         : there[0]           ? Hinge::first
         : there[1]           ? Hinge::second
                              : Hinge::none;
}

}  // namespace

bool breaks(const Model& model, const Element& element, const BeamStrain& strain,
            const SectionForces& forces) {
  const Member& member = model.members[element.member];
  const double limit = model.materials[member.material].fracture_strain;
  if (!(limit > 0)) return false;
  const Section& section = model.sections[member.section];
  const Vec3 shear = forces.normal.cwiseQuotient(element.normal_stiffness);
  return std::abs(strain.kappa.y()) * section.fibre_z() >= limit ||
         std::abs(strain.kappa.z()) * section.fibre_y() >= limit || strain.gamma.x() >= limit ||
         std::max(std::abs(shear.y()), std::abs(shear.z())) >= std::sqrt(3.) * limit;
}

bool break_sections(BodySystem& s, const BodyMotion& trial) {
  if (!s.remembers && !s.tears()) return false;
  const auto breaks_here = [&](std::size_t k) {
    const Element& element = s.model.elements[s.own_elements[k].element];
    const bool is_brittle = s.model.materials[s.model.members[element.member].material].fracture_strain > 0;
    if (s.elements[k].hinge == Hinge::broken || !(is_brittle || s.tears())) return false;
    const BeamStrain strain = strain_at(s, k, trial);
    if (strain.kappa.norm() * element.length > k_torn) return true;
    if (!is_brittle) return false;
    const SectionResponse response = respond(element, s.elements[k], strain);
    return hinges_of(element, response, s.elements[k].hinge) != Hinge::none &&
           breaks(s.model, element, strain, response.forces);
  };
  bool any = false;
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    if (!breaks_here(k)) continue;
    s.elements[k].hinge = Hinge::broken;
    s.remembers = any = true;
  }
  return any;
}

void hold_joints(BodySystem& s, const BodyMotion& start, const BodyMotion& trial) {
  if (!s.remembers) return;
  struct Joint {
    bool all_flow = true, held = false;
    int ends = 0, element = -1, place = 0;
    std::pair<double, double> least;
  };
  std::vector<Joint> joints(s.count);
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    const auto [e, i, j] = s.own_elements[k];
    const Element& element = s.model.elements[e];
    const ElementState& state = s.elements[k];
    if (state.hinge == Hinge::broken) continue;
    const SectionResponse response = respond(element, state, strain_at(s, k, trial));
    SectionForces before{Vec3::Zero(), Vec3::Zero()};
    if (response.flows()) before = section_forces(element, elastic_strain(state, strain_at(s, k, start)));
    for (int place = 0; place < 2; ++place) {
      Joint& joint = joints[place == 0 ? i : j];
      const bool at_end = element.hinge_place[0] != element.hinge_place[1];
      ++joint.ends;
      joint.held = joint.held || state.held >> place & 1;
      joint.all_flow = joint.all_flow && at_end && response.multiplier[place] > 0;
      const double f = yield_function(
          element, forces_along(before, element.length, element.s, element.hinge_place[place]));
      const std::pair<double, double> flow{std::min(f, -k_on_surface), response.multiplier[place]};
      if (!joint.all_flow || state.held >> (2 + place) & 1 || (joint.element >= 0 && !(flow < joint.least)))
        continue;
      joint.element = static_cast<int>(k);
      joint.place = place;
      joint.least = flow;
    }
  }
  constexpr unsigned k_turns = 0b111000;
  for (int i = 0; i < s.count; ++i) {
    const Joint& joint = joints[i];
    if (joint.ends > 1 && joint.all_flow && !joint.held && joint.element >= 0 &&
        (s.fixed[i] & k_turns) != k_turns)
      s.elements[joint.element].held |= 1 << joint.place;
  }
}

void hold_ends(BodySystem& s) {
  for (ElementState& state : s.elements)
    if (state.hinge != Hinge::broken) state.held = 3;
}

bool release_joints(BodySystem& s, const BodyMotion& trial) {
  if (!s.remembers) return false;
  double reach = s.size;
  for (const Vec3& x : trial.position) reach = std::max(reach, x.norm());
  bool any = false;
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    ElementState& state = s.elements[k];
    if (!(state.held & 3)) continue;
    const Element& element = s.model.elements[s.own_elements[k].element];
    const SectionForces forces = respond(element, state, strain_at(s, k, trial)).forces;
    // what rounding of the positions makes of f, where it is more
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * reach *
                            element.normal_stiffness.maxCoeff() / element.capacity.tail<3>().minCoeff();
    for (int place = 0; place < 2; ++place) {
      if (!(state.held >> place & 1) ||
          yield_function(element,
                         forces_along(forces, element.length, element.s, element.hinge_place[place])) <=
              std::max(k_on_surface, rounding))
        continue;
      state.held ^= 5 << place;
      any = true;
    }
  }
  return any;
}

double commit_hinges(BodySystem& s, const BodyMotion& start, const BodyMotion& end, State& state) {
  if (!s.remembers) return 0;
  double taken = 0;
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    const int e = s.own_elements[k].element;
    const Element& element = s.model.elements[e];
    ElementState &now = s.elements[k], &before = state.elements[e];
    if (before.hinge == Hinge::broken) continue;
    const BeamStrain strain1 = strain_at(s, k, end);
    now.held = 0;
    const SectionResponse response = respond(element, now, strain1);
    if (!response.flows() && now.hinge == Hinge::none) continue;
    const BeamStrain strain0 = strain_at(s, k, start);
    const BeamStrain elastic0 = elastic_strain(before, strain0);
    const SectionForces forces0 = section_forces(element, elastic0);
    take_flow(element, response, now);
    taken += element.length / 2 *
                 ((forces0.normal + response.forces.normal).dot(strain1.gamma - strain0.gamma) +
                  (forces0.moment + response.forces.moment).dot(strain1.kappa - strain0.kappa)) +
             beam_energy(element, elastic0) - beam_energy(element, elastic_strain(now, strain1));
    if (now.hinge != Hinge::broken) now.hinge = hinges_of(element, response, now.hinge);
    before = now;
  }
  return taken;
}

}  // namespace topple
