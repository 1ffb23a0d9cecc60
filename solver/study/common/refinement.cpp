#include "solver/study/common/refinement.h"

#include <algorithm>
#include <cmath>

#include "solver/body/model_level.h"
#include "solver/contact/contact_period.h"
#include "solver/frame/integrator.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple::study {
namespace {

double error(double coarse, double fine, double least) {
  return std::max(k_error_of_difference * std::abs(coarse - fine), least);
}

/// 1/s, Housner 1963's p of the edge of its base about which it falls fastest; 0 without a base.
double frequency_parameter(const Body& body, double gravity) {
  const std::vector<Vec3>& corners = body.support_polygon;
  double squared = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 edge = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
    const Vec3 arm = body.centre_of_gravity - corners[i], across = arm - edge.dot(arm) * edge;
    const double moment = body.mass * across.norm();
    squared = std::max(squared, gravity * moment / (edge.dot(body.inertia * edge) + moment * across.norm()));
  }
  return std::sqrt(squared);
}

/// Of the time at which it overturns. What falls slowly began near the motion that ends balanced: as it
/// leaves that with e^(pt) and comes near the critical angle with e^(-pt), it is beyond that angle later by
/// ln(4)/2p when it began a quarter as far away. What is left of that distance at finer steps loses as much
/// again at the finest.
double overturn_error(double coarse, double fine, double p) {
  constexpr double k_least_left = 0.01;  // what is nearer than that may as well stay
  const double linear = error(coarse, fine, k_least_time_error);
  if (p == 0) return linear;
  const double left = k_error_of_difference * std::exp(2 * p * (coarse - fine)) - (k_error_of_difference - 1);
  return std::max(linear, -std::log(std::max(left, k_least_left)) / (2 * p));
}

/// Whether its fixed steps are too long for the blows that it was given as a frame: errors of their stresses
/// then follow no order.
bool blurs_blows(const Setup& setup, int body, const BodyOutcome& run) {
  const Parameters& p = setup.parameters;
  return run.impacts > 0 && !p.adaptive &&
         p.time_step * k_steps_of_bounce > contact_period(setup.model, body, p.contact, p.gravity) &&
         ranges::any_of(run.level_changes,
                        [](const LevelChange& change) { return traits(change.level).moves_nodes; });
}

/// Before it overturned, or in all.
int impacts_of(const BodyOutcome& body) {
  return body.beyond_since ? static_cast<int>(ranges::count_if(
                                 body.impact_times, [&](double t) { return t < *body.beyond_since; }))
                           : body.impacts;
}

}  // namespace

Setup refined(const Setup& setup) {
  Setup finer = setup;
  finer.parameters.tolerance /= k_finer_tolerance;
  finer.parameters.substep_refinement *= k_finer_step;
  if (!finer.parameters.adaptive) finer.parameters.time_step /= k_finer_step;
  return finer;
}

Setup compared(const Setup& setup) {
  return is_by_tolerance(setup.parameters) ? refined(refined(setup)) : refined(setup);
}

bool is_by_tolerance(const Parameters& parameters) {
  return parameters.adaptive && !traits(parameters.integrator).is_explicit;
}

std::vector<BodyError> errors(const Setup& setup, const Outcome& run, const Outcome& finer) {
  const Model& model = setup.model;
  std::vector<BodyError> list;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const BodyOutcome &coarse = run.bodies()[b], &fine = finer.bodies()[b];
    BodyError e;
    e.overturned = coarse.beyond_since.has_value();
    e.overturned_refined = fine.beyond_since.has_value();
    e.impacts = impacts_of(coarse);
    e.impacts_refined = impacts_of(fine);
    e.overturn_time = coarse.beyond_since;
    e.overturn_refined = fine.beyond_since;
    if (e.same_course()) {
      if (e.overturned)
        e.overturn_error =
            overturn_error(*coarse.beyond_since, *fine.beyond_since,
                           frequency_parameter(model.bodies[b], setup.parameters.gravity.norm()));
      const Vec3 axis = exp_quaternion(setup.starts[b].rotation) * Vec3::UnitZ();
      const double given = std::atan2(axis.head<2>().norm(), axis.z());
      if (given == 0 || coarse.peak_tilt > given + k_least_tilt_error)
        e.peak_tilt_error = error(coarse.peak_tilt, fine.peak_tilt, k_least_tilt_error);
      e.peak_slide_error = error(coarse.peak_slide, fine.peak_slide, k_least_slide_error);
      if (!e.overturned && !coarse.always_rigid && !fine.always_rigid && !blurs_blows(setup, b, coarse))
        e.peak_stress_error =
            error(coarse.peak_stress, fine.peak_stress, k_least_stress_error * coarse.peak_stress);
    }
    list.push_back(e);
  }
  return list;
}

std::vector<std::optional<double>> anchor_errors(const Setup& setup, const Outcome& run,
                                                 const Outcome& finer) {
  const std::vector<BodyError> bodies = errors(setup, run, finer);
  const auto bends_and_stands = [&](int body) {  // so do floors and walls of beams
    if (body < 0 || body >= static_cast<int>(bodies.size())) return true;
    const BodyError& e = bodies[static_cast<std::size_t>(body)];
    return !e.overturned && !e.overturned_refined &&
           !run.bodies()[static_cast<std::size_t>(body)].always_rigid;
  };
  const auto held = [](const AnchorOutcome& o) { return o.hold == AnchorHold::in_place || o.peak_force > 0; };
  std::vector<std::optional<double>> list;
  for (std::size_t k = 0; k < setup.model.anchors.size(); ++k) {
    const Anchor& anchor = setup.model.anchors[k];
    const AnchorOutcome &coarse = run.anchors()[k], &fine = finer.anchors()[k];
    const bool known = held(coarse) && held(fine) && coarse.broke.has_value() == fine.broke.has_value() &&
                       bends_and_stands(anchor.body) && bends_and_stands(anchor.other.body);
    list.push_back(known ? std::optional(error(coarse.peak_force, fine.peak_force,
                                               k_least_force_error * coarse.peak_force))
                         : std::nullopt);
  }
  return list;
}

}  // namespace topple::study
