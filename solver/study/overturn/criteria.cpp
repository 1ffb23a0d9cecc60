#include "solver/study/overturn/criteria.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/contact/contact_law.h"
#include "solver/math/elementary.h"
#include "solver/model/excitation.h"
#include "solver/run/bearer.h"
#include "solver/study/common/alone.h"

namespace topple::study {
namespace {

constexpr int k_places = 60;         // of a curve
constexpr double k_same = 1e-6;      // relative, of the two edges
constexpr double k_least_w_p = 0.3;  // longer pulses are as good as steady

bool is_of_shake(const Axis& axis, const std::string& name) {
  return axis.table == "shake" && axis.name == name;
}

std::string why_none(const Setup& scene, const Axis& x, const Axis& y) {
  if (!is_of_shake(y, "amplitude") || x.entry != y.entry ||
      !(is_of_shake(x, "frequency") || is_of_shake(x, "duration")))
    return "the axes are not frequency or duration, and amplitude, of one shake";
  if (scene.parameters.shakes.size() != 1) return "there are several shakes";
  if (scene.parameters.shakes[0].building) return "a building stands between the ground and the floor";
  if (std::abs(scene.parameters.shakes[0].direction.z()) > k_same) return "the shake is not level";
  const Vec3& g = scene.parameters.gravity;
  if (!(g.z() < 0) || g.head<2>().norm() > 0 || !floor_of(scene.model) || !scene.run.settle)
    return "nothing starts at rest on a level floor";
  return "";
}

/// A single motion of the floor of which theory knows the least amplitude that overturns a rigid block that
/// does not slip. x: value of the x axis in SI.
struct Pulse {
  const char *name, *label, *about;
  std::optional<double> (*least)(const Standing& body, double x, double most);  ///< m/s^2; `most`: over g
};

std::optional<double> of_full_sine(const Standing& body, double circular_frequency, double most) {
  const double ratio = circular_frequency / body.p();
  if (ratio < k_least_w_p) return std::nullopt;
  const std::optional<double> least = least_full_sine(body, ratio, most);
  return least ? std::optional(body.gravity * *least) : std::nullopt;
}

constexpr Pulse k_one_cycle{
    "one-sine", "one cycle alone",
    "least single cycle that overturns a rigid block that does not slip, exact",
    [](const Standing& body, double x, double most) { return of_full_sine(body, 2 * k_pi * x, most); }};

/// Shapes of pulses with such a theory.
struct KnownPulse : Pulse {
  Shake::Shape kind;
};
constexpr KnownPulse k_known[] = {
    {{"half-sine", "exact", "least half-sine that overturns a rigid block that does not slip",
      [](const Standing& body, double x, double) -> std::optional<double> {
        const double ratio = k_pi / x / body.p();
        if (ratio < k_least_w_p) return std::nullopt;
        return body.gravity * least_half_sine(body, ratio);
      }},
     Shake::Shape::half_sine},
    {{"one-sine", "exact", "least full sine that overturns a rigid block that does not slip",
      [](const Standing& body, double x, double most) { return of_full_sine(body, 2 * k_pi / x, most); }},
     Shake::Shape::full_sine},
    {{"rectangle", "exact", "least rectangle that overturns a rigid block that does not slip",
      [](const Standing& body, double x, double) {
        return std::optional(body.gravity * least_rectangle(body, body.p() * x));
      }},
     Shake::Shape::rectangle},
};

/// Null: no formula is known.
const Pulse* pulse_of(const Shake& shake) {
  if (traits(shake.kind).steady) return &k_one_cycle;
  const auto* const known =
      std::ranges::find(k_known, shake.shape, [](const KnownPulse& pulse) { return pulse.kind; });
  return known == std::end(k_known) ? nullptr : known;
}

/// Greatest velocity of the floor, of amplitude 1, s; of one cycle that of the steady sine.
double floor_velocity(const Shake& shake, double x) {
  return traits(shake.kind).steady ? 1 / (2 * k_pi * x) : traits(shake.shape).velocity * x;
}

Criterion curve(const std::string& name, const std::string& label, const std::string& about, const Axis& x,
                const Axis& y, const std::function<std::optional<double>(double x_si)>& amplitude) {
  Criterion out{name, label, about, {}, {}};
  const double from = x.edges().front(), to = x.edges().back();
  for (int k = 0; k <= k_places; ++k) {
    const double part = static_cast<double>(k) / k_places;
    const double at = x.logarithmic ? from * elementary::pow(to / from, part) : from + part * (to - from);
    if (const std::optional<double> a = amplitude(x.si * at)) {
      out.x.push_back(at);
      out.y.push_back(*a / y.si);
    }
  }
  return out;
}

}  // namespace

std::string why_no_block(const Model& model, int body) {
  for (int b = 0; b < model.furniture_total(); ++b)
    if (bearer_of(model, model.node_position, b) == body) return "bears \"" + model.bodies[b].name + '"';
  return why_not_standing(model, body);
}

bool slides_first(const Model& model, const Parameters& parameters, int body, double limit) {
  const ContactLaw law = gripped(parameters.contact, model.bodies[body].grip);
  return std::max(law.friction, law.friction_static) < limit;
}

double west_acceleration(const Standing& body) {
  return body.gravity * body.rigid_limit();
}

double ishiyama_velocity(const Standing& body) {
  const double c = std::cos(body.critical());
  return 0.4 * std::sqrt(8 * body.gravity * std::hypot(body.base, body.height) * (1 - c) / (3 * c * c));
}

double evaluation_acceleration(const Standing& body) {
  return west_acceleration(body) * (1 + body.rigid_limit());
}

double evaluation_frequency(const Standing& body) {
  return 15.6 / std::sqrt(100 * 2 * body.height) * std::pow(1 + body.rigid_limit(), -1.5);
}

Criteria criteria(const Setup& scene, const Axis& x, const Axis& y) {
  Criteria out;
  out.why_not = why_none(scene, x, y);
  if (!out.why_not.empty()) return out;
  const Shake& shake = scene.parameters.shakes[0];
  const Model& model = scene.model;
  bool symmetric = false;
  for (int b = 0; b < model.furniture_total(); ++b) {
    if (!why_no_block(model, b).empty()) continue;
    const auto ahead = standing_towards(model, scene.parameters, b, shake.direction),
               behind = standing_towards(model, scene.parameters, b, -shake.direction);
    if (!ahead || !behind) continue;
    const Standing& nearer = ahead->base < behind->base ? *ahead : *behind;
    if (slides_first(model, scene.parameters, b, nearer.rigid_limit())) continue;
    const double limit = out.bodies.empty() ? 0 : out.body.rigid_limit();
    if (!out.bodies.empty() && std::abs(nearer.rigid_limit() - limit) < k_same * limit) {
      out.bodies += ", " + model.bodies[b].name;
    } else if (out.bodies.empty() || nearer.rigid_limit() < limit) {
      out.bodies = model.bodies[b].name;
      out.body = nearer;
      symmetric = std::abs(ahead->base - behind->base) < k_same * ahead->base;
    }
  }
  if (out.bodies.empty()) {
    out.why_not =
        "no body stands freely on the floor, bears nothing, has edges across the shake and lifts before it "
        "slides";
    return out;
  }
  const Standing& body = out.body;
  out.list.push_back(curve("west", "West", "a = g b/h, above which it lifts", x, y,
                           [&](double) { return west_acceleration(body); }));
  if (!traits(shake.kind).steady && !traits(shake.kind).has_shape) return out;
  out.list.push_back(
      curve("ishiyama", "Ishiyama",
            "v = 0.4 (8 g R (1 - cos α)/(3 cos^2 α))^{1/2} of the floor; above it and West's it may overturn",
            x, y, [&](double x_si) { return ishiyama_velocity(body) / floor_velocity(shake, x_si); }));
  const Pulse* const pulse = pulse_of(shake);
  if (!pulse || !symmetric) return out;
  const double most = 4 * y.in_si(y.count() - 1) / body.gravity;
  out.list.push_back(curve(pulse->name, pulse->label, pulse->about, x, y,
                           [&](double x_si) { return pulse->least(body, x_si, most); }));
  return out;
}

}  // namespace topple::study
