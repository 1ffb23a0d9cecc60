#include "solver/frame/hinges.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "solver/element/beam.h"
#include "solver/element/plasticity.h"

namespace topple {
namespace {

// Sections loaded this near to the greatest f form hinges together.
constexpr double k_together = 0.9;
// f is compared in these units, so that rounding does not decide between symmetric sections.
constexpr double k_same = 1e-6;

BeamEnds ends_at(const BodySystem& s, std::size_t k, const BodyMotion& motion) {
  const auto [e, i, j] = s.own_elements[k];
  return beam_ends(motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]);
}

bool yields(const Element& element) {
  return std::isfinite(element.capacity[0]);
}

bool is_end(Hinge hinge) {
  return hinge == Hinge::first || hinge == Hinge::second;
}

Hinge hinge_at(int end) {
  return end == 0 ? Hinge::first : Hinge::second;
}

class Update {
 public:
  Update(BodySystem& system, const BodyMotion& trial, HingeStep& step)
      : s_(system), model_(system.model), trial_(trial), step_(step) {
    step_.formed.resize(s_.elements.size(), false);
    step_.sections.resize(model_.elements.size());
  }

  bool break_sections();
  bool form();
  bool move();

 private:
  int count() const { return static_cast<int>(s_.elements.size()); }
  const Element& element(int k) const { return model_.elements[s_.own_elements[k].element]; }
  BeamStrain strain(int k) const { return beam_strain(element(k), ends_at(s_, k, trial_)); }
  double loading(int k, const SectionForces& forces, double xi) const {
    return yield_function(element(k), forces_along(forces, element(k).length, element(k).s, xi));
  }
  bool is_last(int k, int end) const;
  void set(int k, Hinge hinge) {
    s_.elements[k].hinge = hinge;
    step_.formed[k] = true;
  }
  void find_candidates() const;

  BodySystem& s_;
  const Model& model_;
  const BodyMotion& trial_;
  HingeStep& step_;
};

// The joint's rotation is not held, and all other ends there have hinges or are broken.
bool Update::is_last(int k, int end) const {
  const int node = end == 0 ? s_.own_elements[k].i : s_.own_elements[k].j;
  if (s_.fixed[node] >> 3 == 7) return false;
  return std::none_of(s_.joints[node].begin(), s_.joints[node].end(), [&](const auto& joint) {
    const Hinge hinge = s_.elements[joint.first].hinge;
    return joint.first != k && hinge != Hinge::broken && hinge != hinge_at(joint.second);
  });
}

bool Update::break_sections() {
  bool any = false;
  for (int k = 0; k < count(); ++k) {
    ElementState& state = s_.elements[k];
    if (state.hinge == Hinge::none || state.hinge == Hinge::broken) continue;
    const BeamStrain strains = strain(k);
    const SectionForces forces = respond(element(k), state, strains).forces;
    if (loading(k, forces, hinge_place(element(k), state.hinge)) < -k_unloading ||
        !breaks(model_, element(k), strains, forces))
      continue;
    state.hinge = Hinge::broken;
    any = true;
  }
  return any;
}

// Greatest first, symmetric ones in the order of the elements.
void Update::find_candidates() const {
  std::vector<HingeStep::Candidate>& found = step_.candidates;
  found.clear();
  found.reserve(2 * count());
  const bool middle = !traits(model_.scheme).hinges_at_ends;
  s_.elastic_energy(trial_, step_.sections);
  for (int k = 0; k < count(); ++k) {
    if (!yields(element(k)) || s_.elements[k].hinge != Hinge::none || step_.formed[k]) continue;
    const SectionForces& forces = step_.sections[s_.own_elements[k].element];
    for (int end = 0; end < (middle ? 1 : 2); ++end) {
      const double f = loading(k, forces, middle ? 0 : 2 * end - 1);
      if (f > k_yielding) found.push_back({std::llround(std::min(f, 1e9) / k_same), k, end});
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(b.f, a.element, a.end) < std::tie(a.f, b.element, b.end);
  });
}

bool Update::form() {
  const bool middle = !traits(model_.scheme).hinges_at_ends;
  double greatest = 0;
  std::vector<int>& nodes = step_.nodes;  // where hinges formed just now: what happens beside them shows when
  nodes.clear();                          // solved again
  nodes.reserve(2 * count());
  find_candidates();
  for (const auto& [f, k, end] : step_.candidates) {
    if (static_cast<double>(f) < k_together * greatest) break;
    if (s_.elements[k].hinge != Hinge::none) continue;
    const int node = element(k).node[end];
    const bool beside_new = std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    if (!middle && is_last(k, end) && (beside_new || static_cast<double>(f) * k_same < k_beside)) continue;
    set(k, middle ? Hinge::middle : hinge_at(end));
    greatest = std::max(greatest, static_cast<double>(f));
    nodes.push_back(node);
  }
  return !nodes.empty();
}

bool Update::move() {
  bool any = false;
  for (int k = 0; k < count(); ++k) {
    const Hinge hinge = s_.elements[k].hinge;
    if (!is_end(hinge) || step_.formed[k]) continue;
    const SectionForces forces = respond(element(k), s_.elements[k], strain(k)).forces;
    if (loading(k, forces, hinge == Hinge::first ? 1 : -1) <= k_crowded) continue;
    set(k, hinge == Hinge::first ? Hinge::second : Hinge::first);
    any = true;
  }
  return any;
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

bool update_hinges(BodySystem& system, const BodyMotion& trial, HingeStep& step) {
  if (!system.yields || step.redos >= k_most_redos) return false;
  Update update(system, trial, step);
  if (!update.break_sections() && !update.form() && !update.move()) return false;
  ++step.redos;
  return true;
}

double commit_hinges(BodySystem& s, const BodyMotion& start, const BodyMotion& end, State& state) {
  if (!s.yields) return 0;
  double taken = 0;
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    const int e = s.own_elements[k].element;
    const Element& element = s.model.elements[e];
    ElementState &now = s.elements[k], &before = state.elements[e];
    if (before.hinge == Hinge::broken || now.hinge == Hinge::none) continue;
    const BeamStrain strain0 = beam_strain(element, ends_at(s, k, start));
    const BeamStrain strain1 = beam_strain(element, ends_at(s, k, end));
    const BeamStrain elastic0 = elastic_strain(before, strain0);
    const SectionForces forces0 = section_forces(element, elastic0);
    const SectionResponse response = respond(element, now, strain1);
    take_flow(element, response, now);
    taken += element.length / 2 *
                 ((forces0.normal + response.forces.normal).dot(strain1.gamma - strain0.gamma) +
                  (forces0.moment + response.forces.moment).dot(strain1.kappa - strain0.kappa)) +
             beam_energy(element, elastic0) - beam_energy(element, elastic_strain(now, strain1));
    const SectionForces at_hinge =
        forces_along(response.forces, element.length, element.s, hinge_place(element, now.hinge));
    if (now.hinge != Hinge::broken && yield_function(element, at_hinge) < -k_unloading)
      now.hinge = Hinge::none;
    before = now;
  }
  return taken;
}

}  // namespace topple
