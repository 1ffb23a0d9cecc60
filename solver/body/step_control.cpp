#include "solver/body/step_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/body/anchors.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/model/excitation.h"

namespace topple {
namespace {

constexpr double k_energy_part = 0.02;  // of the tolerance: energy that a step may leave unexplained
constexpr double k_ramp_part = 0.05;    // of a pull's ramp, at most
constexpr double k_at_rest = 1e-7;      // m/s, what rounding makes of a body at rest is below
constexpr double k_small_fall = 1e-8;   // of the reach: what bodies gain by it counts as nothing
constexpr double k_speed_floor = 0.1;   // of the speed that the largest energy amounts to

// Of an implicit method's local error of the velocity over h times the change of the acceleration.
double error_factor(const GeneralizedAlpha& c) {
  const double delta = c.alpha_m - c.alpha_f;
  return std::abs(1. / 6 - c.beta - delta / 2) + std::abs(c.gamma - 0.5 + delta);
}

// Sums over a body: the change of its algorithmic acceleration and its motion, squared.
struct Motion {
  double change = 0, speed = 0;  // kg m^2/s^4, kg m^2/s^2
};

// `before` has nodes only of what was a frame there: one that became one in the step began without
// algorithmic acceleration (place_nodes).
Motion of_frame(const Model& model, const Body& body, bool was_frame, const State& before,
                const State& after) {
  Motion sum;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    const auto square = [&](const Vec3& v, const Vec3& w) {
      return model.node_mass[i] * v.squaredNorm() + w.dot(model.node_inertia[i] * w);
    };
    if (!was_frame) {
      sum.change += square(after.algorithmic_acceleration[i], after.algorithmic_angular_acceleration[i]);
      sum.speed += square(after.velocity[i], after.angular_velocity[i]);
      continue;
    }
    sum.change +=
        square(after.algorithmic_acceleration[i] - before.algorithmic_acceleration[i],
               after.algorithmic_angular_acceleration[i] - before.algorithmic_angular_acceleration[i]);
    sum.speed += std::max(square(before.velocity[i], before.angular_velocity[i]),
                          square(after.velocity[i], after.angular_velocity[i]));
  }
  return sum;
}

Motion of_rigid(const Body& body, const BodyState& before, const BodyState& after) {
  if (before.level != after.level) return {};
  const auto square = [&](const Vec3& v, const Vec3& w) {
    return body.mass * v.squaredNorm() + w.dot(body.inertia * w);
  };
  const auto turning = [&](const BodyState& s) {
    return Vec3(body.inertia.inverse() * (s.rotation.conjugate() * s.moment -
                                          s.angular_velocity.cross(body.inertia * s.angular_velocity)));
  };
  return {square((after.force - before.force) / body.mass, turning(after) - turning(before)),
          std::max(square(before.velocity, before.angular_velocity),
                   square(after.velocity, after.angular_velocity))};
}

}  // namespace

double look_ahead(const Model& model, const Parameters& parameters, const State& state) {
  double limit = std::min({k_longest_step, sample_interval(parameters.shakes, state.time + k_least_step),
                           anchor_look_ahead(model, state)});
  for (const Pull& pull : parameters.pulls)
    if (state.time < pull.ramp.since + pull.ramp.over) limit = std::min(limit, k_ramp_part * pull.ramp.over);
  return limit;
}

StepError step_error(const Model& model, const Parameters& parameters, const State& before,
                     const State& after, double h, const std::vector<char>& with_frames) {
  double factor = 0, rigid_factor = 0;
  if (const auto coefficients = traits(parameters.integrator).coefficients) {
    const GeneralizedAlpha c = coefficients(parameters);
    factor = error_factor(c);
    rigid_factor = error_factor(c.of_rigid());
  }
  double total_mass = 0, small_fall = 0, greatest = 0;
  for (const Body& body : model.bodies) {
    total_mass += body.mass;
    small_fall += k_small_fall * body.mass * parameters.gravity.norm() * body.reach;
  }
  const double largest = std::max(after.energy.largest + total_mass * k_at_rest * k_at_rest, small_fall);
  const double floor = k_speed_floor * k_speed_floor * 2 * largest / total_mass;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!with_frames[b]) continue;
    const Body& body = model.bodies[b];
    const bool frame = traits(after.bodies[b].level).moves_nodes;
    const bool was_frame = traits(before.bodies[b].level).moves_nodes;
    const auto [change, speed] = frame ? of_frame(model, body, was_frame, before, after)
                                       : of_rigid(body, before.bodies[b], after.bodies[b]);
    if (!(change > 0)) continue;
    const double allowed = parameters.tolerance * std::sqrt(speed / body.mass + floor);
    greatest =
        std::max(greatest, (frame ? factor : rigid_factor) * h * std::sqrt(change / body.mass) / allowed);
  }
  const double unexplained = std::abs(after.energy.unexplained() - before.energy.unexplained());
  return {greatest, unexplained / (k_energy_part * parameters.tolerance * largest)};
}

double next_kink(const Model& model, const Parameters& parameters, double t) {
  double next = std::numeric_limits<double>::infinity();
  const auto consider = [&](double at) {
    if (at > t + k_least_step) next = std::min(next, at);
  };
  for (const Shake& shake : parameters.shakes) {
    consider(shake.start);
    consider(shake_end(shake));
    consider(ground_end(shake));
    if (traits(shake.kind).has_shape)
      for (const double kink : traits(shake.shape).kinks) consider(shake.start + kink * shake.duration);
  }
  for (const Pull& pull : parameters.pulls) consider(pull.ramp.since + pull.ramp.over);
  for (const Load& load : model.loads)
    for (const auto& [at, factor] : load.history) consider(at);
  return next;
}

void change_step(State& state, double h) {
  if (!(state.step_size > 0) || state.step_size == h) return;
  const double ratio = h / state.step_size;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Vec3 &a = state.algorithmic_acceleration[i], &b = state.algorithmic_angular_acceleration[i];
    a = state.acceleration[i] + ratio * (a - state.acceleration[i]);
    b = state.angular_acceleration[i] + ratio * (b - state.angular_acceleration[i]);
  }
  state.step_size = h;
}

}  // namespace topple
