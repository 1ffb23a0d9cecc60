#include "app/batch/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ranges>
#include <string_view>
#include <vector>

#include "app/batch/load_steps.h"
#include "app/batch/run_warnings.h"
#include "app/batch/scene_warnings.h"
#include "app/batch/ways_summary.h"
#include "app/support/integrators.h"
#include "app/support/terms.h"
#include "solver/body/body_pose.h"
#include "solver/body/model_level.h"
#include "solver/body/planar_body.h"
#include "solver/contact/contact_default.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json number(double x) {
  return std::isfinite(x) ? ordered_json(x) : ordered_json(nullptr);
}

ordered_json number(const std::optional<double>& x) {
  return x ? number(*x) : ordered_json(nullptr);
}

ordered_json list(const std::vector<double>& values, double unit) {
  ordered_json out = ordered_json::array();
  for (const double value : values) out.push_back(number(value / unit));
  return out;
}

ordered_json intervals(const std::vector<double>& times) {
  ordered_json out = ordered_json::array();
  for (std::size_t k = 1; k < times.size(); ++k) out.push_back(number(times[k] - times[k - 1]));
  return out;
}

ordered_json models(const BodyOutcome& o, const Model& model, const Parameters& parameters) {
  ordered_json out = ordered_json::array();
  for (const LevelChange& change : o.level_changes)
    out.push_back(
        {{"from_s", number(change.time)},
         {"model", traits(change.level).word},
         {"reason", name(change.reason)},
         {"integrator", integrator_of(change.level, model, parameters)},
         {"error_of", traits(change.level).has_modes && parameters.want_stress ? "stress" : "motion"},
         {"error_estimate",
          traits(change.level).moves_nodes ? ordered_json(nullptr) : number(change.error_estimate)}});
  return out;
}

/// Why one that `automatic` begins as a rigid body is no planar block.
ordered_json not_planar(const Setup& setup, const BodyOutcome& o, int body) {
  if (o.level_changes.empty() || o.level_changes.front().level != ModelLevel::rigid) return nullptr;
  const std::string_view why =
      why_not_planar(setup.model, setup.parameters, start_state(setup.model, setup.starts), body, false);
  return why.empty() ? ordered_json(nullptr) : ordered_json(std::string(why));
}

ordered_json body(const Setup& setup, const Parameters& parameters, const BodyOutcome& o,
                  const BodyMomentum& momentum, int index) {
  const Body& body = setup.model.bodies[static_cast<std::size_t>(index)];
  const bool slides = std::isfinite(o.critical);  // it stands on a floor, and nothing holds its base
  return {{"name", body.name},
          {"model", traits(o.level.value_or(ModelLevel::frame)).word},
          {"integrator", is_static(setup) ? ordered_json(nullptr)
                                          : ordered_json(integrator_of(o.level.value_or(ModelLevel::frame),
                                                                       setup.model, parameters))},
          {"models", models(o, setup.model, parameters)},
          {"not_planar", not_planar(setup, o, index)},
          {"friction", number(body.grip * setup.parameters.contact.friction)},
          {"overturned", o.beyond_since.has_value()},
          {"overturn_time_s", number(o.beyond_since)},
          {"first_beyond_critical_s", number(o.first_beyond)},
          {"first_uplift_s", number(o.first_uplift)},
          {"impacts", o.impacts},
          {"first_impact_s", number(o.first_impact)},
          {"peak_tilt_deg", number(o.peak_tilt * k_degrees)},
          {"rebound_tilt_deg", o.first_impact ? number(o.rebound_tilt * k_degrees) : ordered_json(nullptr)},
          {"impact_times_s", list(o.impact_times, 1)},
          {"impact_intervals_s", intervals(o.impact_times)},
          {"peak_tilts_deg", list(o.peak_tilts, 1 / k_degrees)},
          {"final_tilt_deg", number(o.tilt * k_degrees)},
          {"critical_tilt_deg", number(o.peak.critical * k_degrees)},
          {"peak_critical_share", slides ? number(o.peak.share) : ordered_json(nullptr)},
          {"peak_slide_m", slides ? number(o.peak_slide) : ordered_json(nullptr)},
          {"final_slide_m", slides ? number(o.slide) : ordered_json(nullptr)},
          {"final_velocity_m_s", vector_json(momentum.velocity)},
          {"final_angular_momentum_kg_m2_s", vector_json(momentum.angular_momentum)},
          {"peak_stress_Pa", o.always_rigid ? ordered_json(nullptr) : number(o.peak_stress)},
          {"peak_yield_ratio", number(o.peak_yield_ratio)},
          {"hinges", o.hinges},
          {"fractures", o.fractures},
          {"peak_penetration_ratio", number(o.peak_penetration)},
          {"peak_pinch_ratio", number(o.peak_pinch)}};
}

ordered_json anchors(const Run& run) {
  ordered_json out = ordered_json::array();
  const Model& model = run.setup().model;
  for (std::size_t k = 0; k < model.anchors.size(); ++k) {
    const AnchorOutcome& o = run.outcome().anchors()[k];
    ordered_json one = describe_anchor(model, model.anchors[k]);
    one["peak_force_N"] = number(o.peak_force);  // a step may end beyond the strength at which it broke
    one["final_force_N"] = number(o.tension);
    one["in_place"] = o.hold == AnchorHold::in_place;
    one["slack"] = o.hold == AnchorHold::in_place && o.tension == 0 && io::can_slacken(model.anchors[k]);
    one["broke"] = o.broke.has_value();
    one["break_time_s"] = number(o.broke);
    out.push_back(one);
  }
  return out;
}

/// All that moved a body, and floors and walls of beams.
std::string integrators(const Run& run) {
  const Model& model = run.setup().model;
  std::vector<ModelLevel> levels;
  for (const BodyOutcome& o : run.outcome().bodies()) {
    for (const LevelChange& change : o.level_changes) levels.push_back(change.level);
    levels.push_back(o.level.value_or(ModelLevel::frame));
  }
  std::vector<std::string_view> found;
  for (const ModelLevel level : levels)
    for (const auto& word :
         std::views::split(integrator_of(level, model, run.parameters()), std::string_view(", ")))
      if (const std::string_view one(word.begin(), word.end()); std::ranges::find(found, one) == found.end())
        found.push_back(one);
  return fmt::format("{}", fmt::join(found, ", "));
}

/// The mean of an adaptive run.
ordered_json time_step(const Run& run) {
  const Parameters& p = run.parameters();
  if (is_static(run.setup()) || (p.adaptive && run.state().step == 0)) return nullptr;
  return number(p.adaptive ? run.state().time / static_cast<double>(run.state().step) : p.time_step);
}

/// Relative speed, m/s, below which no fixed step is cut because members would pass each other unseen.
ordered_json safe_closing_speed(const Run& run) {
  const Model& model = run.setup().model;
  const Parameters& p = run.parameters();
  if (is_static(run.setup()) || p.adaptive || model.bodies.size() < 2) return nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e)
    least = std::min(least, contact_length(model, {e, e}));
  return number(least / 2 / p.time_step);
}

ordered_json contact(const Model& model, const ContactLaw& c, const Vec3& gravity) {
  if (!can_touch(model)) return nullptr;
  const ContactLawTraits& law = traits(c);
  return {{"law", law.word},
          {"alpha_N", number(c.alpha)},
          {"q", number(c.q)},
          {"friction", number(c.friction)},
          {"restitution", law.has_restitution ? number(c.restitution) : nullptr},
          {"normal_speed_m_s", law.has_restitution ? number(c.normal_speed) : nullptr},
          {"member_share", model.bodies.size() > 1 ? number(c.member_share) : ordered_json(nullptr)},
          {"stands_for_hard_floor", stands_for_hard_floor(model, c, gravity)}};
}

/// Of the balances found: a limit load, where the path goes beyond it.
ordered_json peak_load_factor(const Run& run) {
  std::optional<double> peak;
  for (const LoadStep& step : run.load_steps())
    if (step.converged) peak = std::max(peak.value_or(step.factor), step.factor);
  return number(peak);
}

ordered_json probes(const Run& run) {
  ordered_json out = ordered_json::array();
  for (std::size_t k = 0; k < run.probes().size(); ++k) {
    const ProbeOutcome& probe = run.probes()[k];
    out.push_back(
        {{"name", run.setup().probes[k].name},
         {"final",
          {{"displacement_m", vector_json(probe.displacement)},
           {"rotation_rad", vector_json(probe.rotation)}}},
         {"peak", {{"displacement_m", vector_json(probe.peak)}, {"time_s", vector_json(probe.peak_time)}}}});
  }
  return out;
}

}  // namespace

ordered_json describe_anchor(const Model& model, const Anchor& anchor) {
  const auto name = [&](int body) { return model.bodies[static_cast<std::size_t>(body)].name; };
  const auto place = [&](const AnchorEnd& end) -> ordered_json {
    if (end.body < 0) return nullptr;
    return {{"body", name(end.body)},
            {"node", end.node - model.bodies[static_cast<std::size_t>(end.body)].first_node},
            {"distance_m", number(end.arm.norm())}};
  };
  return {{"name", anchor.name},
          {"body", name(anchor.body)},
          {"type", anchor_type(anchor)},
          {"strength_N", number(anchor.strength)},
          {"stiffness_N_m", number(anchor.stiffness)},
          {"fixing", anchor.fixing.empty() ? ordered_json(nullptr) : ordered_json(anchor.fixing)},
          {"leads_to", anchor.leads_to.empty() ? ordered_json(nullptr) : ordered_json(anchor.leads_to)},
          {"own_end", place(anchor.own())},
          {"other_end", place(anchor.other)}};
}

ordered_json describe_wedge(const Model& model, const Wedge& wedge) {
  const Body& body = model.bodies[static_cast<std::size_t>(wedge.body)];
  ordered_json nodes = ordered_json::array();
  for (const int node : wedge.nodes) nodes.push_back(node - body.first_node);
  return {{"name", wedge.name}, {"body", body.name}, {"nodes", nodes}, {"lift_m", number(wedge.lift)}};
}

ordered_json summary(const io::Scene& scene, Run& run, const std::string& status, double wall_s) {
  const State& state = run.state();
  const EnergyLedger& e = state.energy;
  const Parameters& p = run.parameters();
  ordered_json out;
  out["topple"] = TOPPLE_VERSION;
  out["schema"] = 1;
  out["scene"] = scene.name;
  out["status"] = status;
  if (!run.status().ok()) out["message"] = run.status().message(run.setup().model);
  out["analysis"] = is_static(run.setup()) ? "static" : "dynamic";
  out["simulated_s"] = number(state.time);
  if (run.counted_from() > 0) out["counted_from_s"] = number(run.counted_from());
  out["wall_s"] = number(wall_s);
  out["realtime_factor"] =
      wall_s > 0 && !is_static(run.setup()) ? number(state.time / wall_s) : ordered_json(nullptr);
  out["integrator"] = is_static(run.setup()) ? ordered_json(nullptr) : ordered_json(integrators(run));
  out["time_step_s"] = time_step(run);
  out["adaptive"] = p.adaptive && !is_static(run.setup());
  out["explicit_limit_s"] = number(run.stable_step());
  out["safe_closing_speed_m_s"] = safe_closing_speed(run);
  out["contact"] = contact(run.setup().model, p.contact, p.gravity);
  out["steps"] = state.step;
  out["rejected_steps"] = run.rejected_steps();
  out["newton_iterations"] = run.newton_iterations();
  out["energy"] = {
      {"input_J", number(e.input)},
      {"kinetic_J", number(e.kinetic)},
      {"strain_J", number(e.strain)},
      {"gravity_J", number(e.gravity)},
      {"contact_J", number(e.contact)},
      {"anchor_J", number(e.anchor)},
      {"start_J", number(e.start_total)},
      {"final_J", number(e.kinetic + e.strain + e.contact + e.anchor)},
      {"dissipated_J", number(e.dissipated())},
      {"friction_J", number(e.friction)},
      {"normal_damping_J", number(e.normal_damping)},
      {"numerical_J", number(e.numerical)},
      {"plastic_J", number(e.plastic)},
      {"damping_J", number(e.damping)},
      {"released_J", number(e.released)},
      {"model_switch_J", number(e.model_switch)},
      {"balance_error", is_static(run.setup()) ? ordered_json(nullptr) : number(e.balance_error())}};
  out["floor"] = {{"final_displacement_m", vector_json(state.floor_displacement)},
                  {"final_velocity_m_s", vector_json(state.floor_velocity)}};
  out["uplift_threshold_deg"] = number(k_uplift_angle * k_degrees);
  out["bodies"] = ordered_json::array();
  const Model& model = run.setup().model;
  for (int b = 0; b < model.furniture_total(); ++b)
    out["bodies"].push_back(
        body(run.setup(), p, run.outcome().bodies()[b], body_momentum(model, state, b), b));
  out["anchors"] = anchors(run);
  out["wedges"] = ordered_json::array();
  for (const Wedge& wedge : run.setup().wedges) out["wedges"].push_back(describe_wedge(model, wedge));
  out["probes"] = probes(run);
  if (!run.setup().room.places.empty()) {
    out["person_m"] = run.setup().room.person;
    out["ways"] = ways_json(run);
  }
  out["static"] = load_steps_json(run);
  out["peak_load_factor"] = is_static(run.setup()) ? peak_load_factor(run) : ordered_json(nullptr);
  out["warnings"] = ordered_json::array();
  for (const Said& warning : run_warnings(run)) out["warnings"].push_back(warning.english);
  if (const std::string soft = soft_contact_warning(run.setup(), run.setup().parameters); !soft.empty())
    out["warnings"].push_back(soft);
  return out;
}

std::string refinement_in_words(const Setup& setup) {
  return study::is_by_tolerance(setup.parameters)
             ? fmt::format("tolerance divided by {:g}, parts of a step by {:g}",
                           study::k_finer_tolerance * study::k_finer_tolerance,
                           study::k_finer_step * study::k_finer_step)
             : "step and its parts halved";
}

ordered_json error_estimate(const Setup& setup, const Outcome& run, const Outcome& finer) {
  struct Quantity {
    const char* key;
    std::optional<double> study::BodyError::*error;
    double unit;
  };
  static constexpr Quantity k_quantities[] = {
      {"overturn_time_s", &study::BodyError::overturn_error, 1},
      {"peak_tilt_deg", &study::BodyError::peak_tilt_error, 1 / k_degrees},
      {"peak_slide_m", &study::BodyError::peak_slide_error, 1},
      {"peak_stress_Pa", &study::BodyError::peak_stress_error, 1}};
  const std::vector<study::BodyError> errors = study::errors(setup, run, finer);
  ordered_json bodies = ordered_json::array(), disagreements = ordered_json::array(),
               parted = ordered_json::array();
  for (std::size_t b = 0; b < errors.size(); ++b) {
    const study::BodyError& e = errors[b];
    ordered_json body{{"name", setup.model.bodies[b].name},
                      {"same_verdict", e.same_verdict()},
                      {"same_course", e.same_course()},
                      {"falls_refined", e.overturned_refined}};
    for (const Quantity& q : k_quantities) {
      const std::optional<double>& error = e.*q.error;
      body[q.key] = error ? number(*error / q.unit) : ordered_json(nullptr);
    }
    bodies.push_back(std::move(body));
    if (e.parted())
      parted.push_back(fmt::format("{} meets the floor {} times, {} times when refined",
                                   setup.model.bodies[b].name, e.impacts, e.impacts_refined));
    if (e.same_course()) continue;
    const auto falls = [&](double t, int impacts) {
      return e.overturned == e.overturned_refined
                 ? fmt::format("at {:.4f} s after {} impact{}", t, impacts, impacts == 1 ? "" : "s")
                 : fmt::format("at {:.4f} s", t);
    };
    disagreements.push_back(
        fmt::format("{} {}, but {} when refined", setup.model.bodies[b].name,
                    e.overturned ? "overturns " + falls(*e.overturn_time, e.impacts) : "does not overturn",
                    e.overturned_refined ? falls(*e.overturn_refined, e.impacts_refined) : "not"));
  }
  ordered_json out;
  for (const Quantity& q : k_quantities) {
    std::optional<double> greatest;
    for (const study::BodyError& e : errors)
      if (const std::optional<double>& error = e.*q.error)
        greatest = std::max(greatest.value_or(0), *error / q.unit);
    out[q.key] = disagreements.empty() ? number(greatest) : ordered_json(nullptr);
  }
  out["how"] = refinement_in_words(setup);
  out["error_of_difference"] = study::k_error_of_difference;
  out["disagreements"] = std::move(disagreements);
  out["parted"] = std::move(parted);
  out["bodies"] = std::move(bodies);
  out["anchors"] = ordered_json::array();
  const std::vector<std::optional<double>> forces = study::anchor_errors(setup, run, finer);
  for (std::size_t k = 0; k < forces.size(); ++k)
    out["anchors"].push_back({{"name", setup.model.anchors[k].name}, {"peak_force_N", number(forces[k])}});
  return out;
}

ordered_json failed_estimate(const Setup& setup, const std::string& message) {
  return {{"overturn_time_s", nullptr},
          {"peak_tilt_deg", nullptr},
          {"how", refinement_in_words(setup)},
          {"failed", message}};
}

ordered_json vector_json(const Vec3& v) {
  return {number(v.x()), number(v.y()), number(v.z())};
}

std::string json_text(const ordered_json& value, int indent) {
  return value.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace topple::app
