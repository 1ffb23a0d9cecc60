#include "solver/hinges.h"

#include <algorithm>
#include <cmath>

#include "solver/beam.h"
#include "solver/plasticity.h"

namespace topple {
namespace {

// Sections loaded this near to the greatest f form hinges together.
constexpr double k_together = 0.9;
// f is compared in these units, so that rounding does not decide between symmetric sections.
constexpr double k_same = 1e-6;

BeamEnds ends_at(const BodySystem& s, const Element& element, const BodyMotion& motion) {
  const int i = element.node[0] - s.first, j = element.node[1] - s.first;
  return beam_ends(element, motion.position[i], motion.rotation[i], motion.position[j], motion.rotation[j]);
}

bool yields(const Element& element) {
  return std::isfinite(element.capacity[0]);
}

Hinge hinge_at(int end) {
  return end == 0 ? Hinge::first : Hinge::second;
}

struct Candidate {
  long long f;  // in units of k_same
  int element, end;
};

class Update {
 public:
  Update(BodySystem& system, const BodyMotion& start, const BodyMotion& trial, HingeStep& step)
      : s_(system),
        model_(system.model),
        first_(model_.bodies[system.index].first_element),
        start_(start),
        trial_(trial),
        step_(step) {
    step_.released.resize(s_.elements.size(), false);
    step_.formed.resize(s_.elements.size(), false);
  }

  bool break_sections();
  bool release();
  bool form();

 private:
  const Element& element(int k) const { return model_.elements[first_ + k]; }
  SectionForces forces(int k) const {
    const BeamStrain strain = beam_strain(element(k), s_.elements[k].s, ends_at(s_, element(k), trial_));
    return respond(element(k), s_.elements[k], strain).forces;
  }
  double loading(int k, const SectionForces& at_point, double xi) const {
    return yield_function(element(k),
                          forces_along(at_point, element(k).length, s_.elements[k].s, xi));
  }
  bool holds_rotation(int node) const { return (s_.fixed[node] >> 3) == 7; }
  bool is_last(int k, int end) const;
  void set(int k, Hinge hinge);
  void place(int k);
  std::vector<Candidate> candidates() const;

  BodySystem& s_;
  const Model& model_;
  const int first_;
  const BodyMotion &start_, &trial_;
  HingeStep& step_;
};

void Update::place(int k) {
  const int other = partner_of(model_, first_ + k);
  ElementState& state = s_.elements[k];
  if (state.hinge == Hinge::broken) return;
  const double s = place_of(model_, first_ + k, state.hinge,
                            other < 0 ? Hinge::none : s_.elements[other - first_].hinge);
  if (s != state.s) state = shifted(element(k), state, s, ends_at(s_, element(k), start_));
}

void Update::set(int k, Hinge hinge) {
  s_.elements[k].hinge = hinge;
  place(k);
  if (const int other = partner_of(model_, first_ + k); other >= 0) place(other - first_);
}

// All other ends at the joint have hinges or are broken.
bool Update::is_last(int k, int end) const {
  const int node = element(k).node[end] - s_.first;
  if (holds_rotation(node)) return false;
  return std::none_of(s_.joints[node].begin(), s_.joints[node].end(), [&](const auto& joint) {
    const Hinge hinge = s_.elements[joint.first].hinge;
    return joint.first != k && hinge != Hinge::broken && hinge != hinge_at(joint.second);
  });
}

bool Update::break_sections() {
  bool any = false;
  for (int k = 0; k < static_cast<int>(s_.elements.size()); ++k) {
    ElementState& state = s_.elements[k];
    if (state.hinge == Hinge::none || state.hinge == Hinge::broken) continue;
    const BeamStrain strain = beam_strain(element(k), state.s, ends_at(s_, element(k), trial_));
    const SectionForces at_point = respond(element(k), state, strain).forces;
    if (yield_function(element(k), at_point) < -k_unloading ||
        !breaks(model_, element(k), strain, at_point))
      continue;
    set(k, Hinge::broken);
    any = true;
  }
  return any;
}

bool Update::release() {
  bool any = false;
  for (int k = 0; k < static_cast<int>(s_.elements.size()); ++k) {
    const Hinge hinge = s_.elements[k].hinge;
    if (hinge == Hinge::none || hinge == Hinge::broken) continue;
    if (step_.released[k] || step_.formed[k]) continue;
    if (yield_function(element(k), forces(k)) >= -k_unloading) continue;
    set(k, Hinge::none);
    step_.released[k] = true;
    any = true;
  }
  return any;
}

std::vector<Candidate> Update::candidates() const {
  std::vector<Candidate> found;
  const bool middle = model_.scheme == Scheme::midpoint;
  for (int k = 0; k < static_cast<int>(s_.elements.size()); ++k) {
    if (!yields(element(k)) || s_.elements[k].hinge != Hinge::none || step_.formed[k]) continue;
    const SectionForces at_point = forces(k);
    for (int end = 0; end < (middle ? 1 : 2); ++end) {
      const double f = loading(k, at_point, middle ? 0 : 2 * end - 1);
      if (f > k_yielding) found.push_back({std::llround(std::min(f, 1e9) / k_same), k, end});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.f > b.f; });
  return found;
}

bool Update::form() {
  const bool middle = model_.scheme == Scheme::midpoint;
  double greatest = 0;
  std::vector<int> nodes;  // where hinges formed just now: what happens beside them shows when solved again
  for (const auto& [f, k, end] : candidates()) {
    if (static_cast<double>(f) < k_together * greatest) break;
    if (s_.elements[k].hinge != Hinge::none) continue;
    const int node = element(k).node[end];
    const bool beside_new = std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    if (!middle && is_last(k, end) && (beside_new || static_cast<double>(f) * k_same < k_beside)) continue;
    set(k, middle ? Hinge::middle : hinge_at(end));
    step_.formed[k] = true;
    greatest = std::max(greatest, static_cast<double>(f));
    nodes.push_back(node);
  }
  return !nodes.empty();
}

}  // namespace

int partner_of(const Model& model, int element) {
  const Member& member = model.members[model.elements[element].member];
  const int other = member.first_element + ((element - member.first_element) ^ 1);
  return other < member.first_element + member.element_count ? other : -1;
}

double place_of(const Model& model, int element, Hinge hinge, Hinge partner) {
  const double elastic = model.elements[element].s;
  if (hinge == Hinge::first) return 1;
  if (hinge == Hinge::second) return -1;
  if (model.scheme != Scheme::asi_gauss || (partner != Hinge::first && partner != Hinge::second))
    return elastic;
  if (model.partner_rule == PartnerRule::middle) return 0;
  // The elastic member beyond the hinge, of length l and a moment that grows as x from it, bends as
  // int x^2 dx; the one stress point of this element, half a member long, at the root of its mean.
  const bool is_first = elastic > 0;
  const bool far = (partner == Hinge::first) != is_first;  // the hinge is at the pair's end, not at its middle
  const double x = far ? 4 * std::sqrt(2. / 3) - 3 : 4 / std::sqrt(6.) - 1;  // r, away from the hinge
  return is_first ? x : -x;
}

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

bool update_hinges(BodySystem& system, const BodyMotion& start, const BodyMotion& trial, HingeStep& step) {
  if (!system.yields || step.redos >= k_most_redos) return false;
  Update update(system, start, trial, step);
  if (!update.break_sections() && !update.release() && !update.form()) return false;
  ++step.redos;
  return true;
}

double commit_hinges(BodySystem& s, const BodyMotion& start, const BodyMotion& end, State& state) {
  if (!s.yields) return 0;
  double taken = 0;
  const int first = s.model.bodies[s.index].first_element;
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    const Element& element = s.model.elements[first + k];
    ElementState &now = s.elements[k], &before = state.elements[first + k];
    if (before.hinge == Hinge::broken || (now.hinge == Hinge::none && now.s == before.s)) continue;
    const BeamEnds ends0 = ends_at(s, element, start), ends1 = ends_at(s, element, end);
    const BeamStrain strain0 = beam_strain(element, now.s, ends0), strain1 = beam_strain(element, now.s, ends1);
    const double energy0 =
        beam_energy(element, elastic_strain(before, beam_strain(element, before.s, ends0)));
    ElementState unbroken = now;
    unbroken.hinge = Hinge::none;
    const SectionForces forces0 = respond(element, unbroken, strain0).forces;
    const SectionResponse response = respond(element, now, strain1);
    take_flow(element, response, now);
    taken += element.length / 2 *
                 ((forces0.normal + response.forces.normal).dot(strain1.gamma - strain0.gamma) +
                  (forces0.moment + response.forces.moment).dot(strain1.kappa - strain0.kappa)) -
             beam_energy(element, elastic_strain(now, strain1)) + energy0;
    before = now;
  }
  return taken;
}

}  // namespace topple
