#include "app/batch/run_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>

#include "app/batch/warning_words.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"
#include "solver/contact/contact_period.h"
#include "solver/frame/integrator.h"
#include "solver/math/ranges.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"
#include "solver/study/common/refinement.h"
#include "solver/study/stability/stability_limits.h"

namespace topple::app {

namespace ww = warning_words;

namespace {

constexpr double k_pinched = 0.95;              // 1 - l/L between members
constexpr double k_same_interval = 1 + 1e-9;    // of a step and a sample interval, both rounded
constexpr double k_good_balance = 1e-3;         // energy that nothing explains
constexpr double k_hardly_lifts = 1e-6;         // m, all bodies: an energy that tells nothing
constexpr double k_numerical = 0.1;             // energy that the integrator takes or gives
constexpr double k_yielded = 1.05;              // of the yield surface: frames stay within it
constexpr double k_stretched = 0.3;             // of the length of an element
constexpr double k_sunk = 0.1;                  // m below a floor
constexpr double k_switched = 0.01;             // energy that changes of models give or take
constexpr double k_resolved_bounce = 10;        // steps of a bounce on the contacts
constexpr double k_elastic_strain = 0.01;       // more than structural metals and wood have
constexpr double k_most_g = 5;                  // of a shake; records above it are refused
constexpr double k_numbers_of_interest = 1e-9;  // J, below it shares are rounding

using Warnings = std::vector<Said>;

void warn_of_depth(const Run& run, Warnings& list) {
  const std::vector<BodyOutcome>& bodies = run.outcome().bodies();
  const Model& model = run.setup().model;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].peak_penetration > 1)
      list.push_back(said(ww::k_sank, model.bodies[b].name, bodies[b].peak_penetration));
  for (int b = 0; b < model.furniture_total(); ++b)
    if (bodies[b].peak_pinch > k_pinched)
      list.push_back(said(ww::k_pinched_member, model.bodies[b].name, 1 - bodies[b].peak_pinch));
}

// Of a cabinet its corners meet the floor, and edges where they are asked for.
void warn_of_pieces(const Run& run, Warnings& list) {
  const Model& model = run.setup().model;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const Body& body = model.bodies[b];
    if (run.outcome().bodies()[b].fractures == 0) continue;
    int sunk = 0;
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      sunk += std::ranges::any_of(model.planes, [&](const Plane& plane) {
        return plane.normal.dot(run.state().position[i] - plane.point) < -k_sunk;
      });
    if (sunk > 0)
      list.push_back(said(ww::k_pieces, sunk, body.node_count, body.name, body.contact_point_count));
  }
}

// With run.control the loads follow the path, and a body stays on it.
void warn_of_instability(const Run& run, Warnings& list) {
  const std::vector<LoadStep>& steps = run.load_steps();
  const auto unstable =
      std::ranges::find_if(steps, [](const LoadStep& step) { return !step.stability.stable(); });
  if (unstable == steps.end() || !unstable->converged || run.setup().run.statics.control) return;
  list.push_back(said(ww::k_not_stable, unstable->factor));
}

// Of the member whose elements are longest beside the half wave in which what it bears would buckle it, as
// the path ends; measured on columns (scenes.md).
void warn_of_few_elements(const Run& run, Warnings& list) {
  constexpr double k_enough = 6, k_good = 8;  // elements in a half wave
  const Model& model = run.setup().model;
  double fewest = k_enough, borne = 0;
  const Member* worst = nullptr;
  if (run.sections().empty()) return;  // it had no equilibrium to begin with
  for (const Member& member : model.members)
    for (int e = member.first_element; e < member.first_element + member.element_count; ++e) {
      const Element& element = model.elements[e];
      const double compression = -run.sections()[e].normal.x();
      if (!(compression > 0)) continue;
      const double half_wave =
          std::numbers::pi * std::sqrt(element.bending_stiffness.tail<2>().minCoeff() / compression);
      if (!(half_wave < fewest * element.length)) continue;
      fewest = half_wave / element.length;
      borne = compression;
      worst = &member;
    }
  if (!worst) return;
  const int enough = 2 * static_cast<int>(std::ceil(worst->element_count * k_good / fewest / 2));
  list.push_back(said(ww::k_few_elements, worst->name, model.bodies[worst->body].name, borne / 1e3,
                      worst->element_count, fewest, enough));
}

void warn_of_stress(const Run& run, Warnings& list) {
  const Model& model = run.setup().model;
  const std::vector<BodyOutcome>& bodies = run.outcome().bodies();
  for (int b = 0; b < model.furniture_total(); ++b) {
    const Body& body = model.bodies[b];
    const Material* stiffest = nullptr;
    bool yields = false;  // then the greatest stress may be that of what yields
    for (int m = body.first_member; m < body.first_member + body.member_count; ++m) {
      const Material& material = model.materials[model.members[m].material];
      yields = yields || material.yield > 0;
      if (!stiffest || material.young > stiffest->young) stiffest = &material;
    }
    const auto was = [&](ModelLevel level) {
      const std::vector<LevelChange>& changes = bodies[b].level_changes;
      return bodies[b].level == level || ranges::find(changes, level, &LevelChange::level) != changes.end();
    };
    // ends of frames with hinges at midpoints bear more
    const bool by_ends = model.scheme == Scheme::midpoint && was(ModelLevel::frame);
    if (const double ratio = bodies[b].peak_yield_ratio.value_or(0);
        ratio > k_yielded && was(ModelLevel::elastic) && !by_ends)
      list.push_back(said(ww::k_beyond_yield, body.name, 1e-6 * bodies[b].peak_stress, ratio));
    if (!yields && stiffest && bodies[b].peak_stress > k_elastic_strain * stiffest->young)
      list.push_back(said(ww::k_beyond_strength, body.name, 1e-6 * bodies[b].peak_stress, stiffest->name,
                          1e-6 * k_elastic_strain * stiffest->young));
  }
}

// Of a path that leapt from one break to the next.
void warn_of_breaks(const Run& run, Warnings& list) {
  std::map<std::int64_t, int> broken;  // by load step
  for (const Event& event : run.events())
    if (event.kind == Event::Kind::fracture) ++broken[event.step];
  const auto most = std::ranges::max_element(broken, {}, [](const auto& of) { return of.second; });
  if (most == broken.end() || most->second < 2) return;
  list.push_back(said(ww::k_breaks, most->second, most->first));
}

// Of the element whose nodes flowed apart or together most.
void warn_of_stretch(const Run& run, Warnings& list) {
  const Model& model = run.setup().model;
  const State& state = run.state();
  double most = 0;
  int worst = -1;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    if (!std::isfinite(element.capacity[0]) || state.elements[e].hinge == Hinge::broken) continue;
    const auto& [a, b] = element.node;
    const double length = (model.node_position[b] - model.node_position[a]).norm(),
                 stretch = (state.position[b] - state.position[a]).norm() / length - 1;
    if (!(std::abs(stretch) > std::max(k_stretched, std::abs(most)))) continue;
    most = stretch;
    worst = static_cast<int>(e);
  }
  if (worst < 0) return;
  const Member& member = model.members[model.elements[worst].member];
  list.push_back(said(ww::k_stretched, worst - member.first_element, member.name,
                      model.bodies[member.body].name, 100 * std::abs(most),
                      most > 0 ? ww::k_longer : ww::k_shorter));
}

// Of fixed steps; adaptive ones follow what happens.
void warn_of_step(const Run& run, Warnings& list) {
  const Parameters& p = run.parameters();
  const Model& model = run.setup().model;
  const double h = p.time_step;
  for (const Shake& shake : p.shakes)
    if (traits(shake.kind).has_record && h > k_same_interval * shake.record->interval)
      list.push_back(said(ww::k_record_step, 1e3 * h, 1e3 * shake.record->interval));
  double bounce = std::numeric_limits<double>::infinity();
  for (int b = 0; b < model.furniture_total(); ++b)
    if (traits(base_level(model, p, b).level).moves_nodes)
      if (const double period = contact_period(model, b, p.contact, p.gravity); period > 0)
        bounce = std::min(bounce, period);
  if (h > bounce / k_resolved_bounce)
    list.push_back(said(ww::k_bounce, 1e3 * bounce, bounce / h, 1e3 * bounce / (2 * k_resolved_bounce)));
  const double chatter = model.planes.empty() ? 0 : study::step_of_chatter(p.contact, p.gravity.norm());
  if (chatter > 0 && h > chatter) list.push_back(said(ww::k_chatter, 1e3 * h, 1e3 * chatter));
}

void warn_of_law(const Run& run, Warnings& list) {
  const ContactLawTraits& law = traits(run.parameters().contact);
  if (!law.trusted && !run.setup().model.planes.empty()) list.push_back(said(ww::k_law, law.word));
}

void warn_of_energy(const Run& run, Warnings& list) {
  const EnergyLedger& e = run.state().energy;
  const Phrase& finer = study::is_by_tolerance(run.parameters()) ? ww::k_try_tolerance
                        : run.parameters().adaptive              ? ww::k_try_fixed_step
                                                                 : ww::k_try_step;
  double weight = 0;
  for (const Body& body : run.setup().model.bodies) weight += body.mass * run.parameters().gravity.norm();
  if (const double balance = e.balance_error();
      balance > k_good_balance && balance * e.largest > k_hardly_lifts * weight)
    list.push_back(said(ww::k_balance, balance, e.largest, k_good_balance, finer));
  if (e.largest >= k_numbers_of_interest && std::abs(e.model_switch) > k_switched * e.largest)
    list.push_back(said(ww::k_switched, e.model_switch > 0 ? ww::k_got : ww::k_lost, std::abs(e.model_switch),
                        100 * std::abs(e.model_switch) / e.largest));
  const double share = std::abs(e.numerical) / e.largest;
  if (e.largest < k_numbers_of_interest || share < k_numerical) return;
  const Parameters& p = run.parameters();
  const bool damping_newmark = p.integrator == Integrator::newmark && p.gamma > 0.5;
  list.push_back(said(ww::k_numerical, e.numerical > 0 ? ww::k_took : ww::k_gave, std::abs(e.numerical),
                      100 * share, e.numerical > 0 && damping_newmark ? ww::k_try_alpha_method : finer));
}

}  // namespace

void warn_of_shakes(const std::vector<Shake>& shakes, double output_rate, std::vector<Said>& list) {
  for (std::size_t k = 0; k < shakes.size(); ++k) {
    if (!rows_follow(shakes[k], output_rate))
      list.push_back(said(ww::k_too_fast, k + 1, highest_frequency(shakes[k]), output_rate,
                          2 * k_rows_in_period * highest_frequency(shakes[k])));
    if (traits(shakes[k].kind).has_amplitude && shakes[k].amplitude > k_most_g * k_standard_gravity)
      list.push_back(said(ww::k_too_strong, k + 1, shakes[k].amplitude / k_gal,
                          shakes[k].amplitude / k_standard_gravity));
  }
}

std::vector<Said> run_warnings(const Run& run) {
  Warnings list;
  if (run.counted_from() > 0) list.push_back(said(ww::k_went_on, run.counted_from()));
  warn_of_depth(run, list);
  warn_of_shakes(run.parameters().shakes, run.setup().run.output_rate, list);
  warn_of_stress(run, list);
  warn_of_stretch(run, list);
  warn_of_pieces(run, list);
  warn_of_instability(run, list);
  if (is_static(run.setup())) {
    warn_of_few_elements(run, list);
    warn_of_breaks(run, list);
    return list;
  }
  if (!run.parameters().adaptive) warn_of_step(run, list);
  warn_of_law(run, list);
  warn_of_energy(run, list);
  return list;
}

}  // namespace topple::app
