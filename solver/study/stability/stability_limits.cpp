#include "solver/study/stability/stability_limits.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/contact/contact_period.h"
#include "solver/element/damping.h"
#include "solver/frame/central_difference.h"
#include "solver/frame/integrator.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/standing.h"

namespace topple::study {
namespace {

constexpr int k_places = 24;            // of a line, at most
constexpr double k_on_the_side = 1e-6;  // m, from the plane of a side

double positive_min(double a, double b) {
  return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
}

double contact_length(const Model& model, const Body& body, const Plane& plane) {
  return contact_length(model.contact_points[body.first_contact_point], plane);
}

/// A body that stands freely falls over its nearest edge.
void add_fall(const Setup& scene, int b, Demand& out) {
  const Model& model = scene.model;
  const Body& body = model.bodies[b];
  const Standing s = standing(model, scene.parameters, b);
  const double L = s.contacts.front().L, R = std::hypot(s.base, s.height);
  int side = 0;
  double far = 0;
  for (int k = 0; k < body.contact_point_count; ++k) {
    const Vec3 arm = model.node_position[model.contact_points[body.first_contact_point + k].node] - s.edge;
    if (arm.dot(s.direction) < -k_on_the_side) continue;
    ++side;
    far = std::max(far, arm.z());
  }
  const double energy = s.weight() * (R - s.base);
  if (!(energy > 0) || !(far > 0)) return;
  out.landing = positive_min(out.landing, L / (far * std::sqrt(2 * energy / s.inertia_of_edge)));
  out.alpha = std::max(out.alpha, energy * (scene.parameters.contact.q + 1) / (side * L));
  out.turning = std::max(out.turning, 4 * s.p() * (1 - std::cos((k_pi / 2 - s.critical()) / 2)));
}

/// A body that starts with a velocity lands on its base.
void add_throw(const Setup& scene, int b, Demand& out) {
  const Model& model = scene.model;
  const Body& body = model.bodies[b];
  const double g = scene.parameters.gravity.norm();
  double gap = 0;
  if (const auto floor = floor_of(model); floor && !body.base_points.empty())
    gap = std::max(0., body.base_centre.z() - floor->point.z() -
                           model.contact_points[body.first_contact_point].width / 2);
  const double v2 = scene.starts[b].velocity.squaredNorm() + 2 * g * gap;
  const double L = contact_length(model, body, model.planes.front());
  if (!(v2 > 0)) return;
  out.landing = positive_min(out.landing, L / std::sqrt(v2));
  const double points = static_cast<double>(std::max<std::size_t>(1, body.base_points.size()));
  out.alpha = std::max(out.alpha, body.mass * v2 / 2 * (scene.parameters.contact.q + 1) / (points * L));
}

/// A scene at one place of the map.
struct Place {
  double x, y;  // of the axes
  Demand demand;
  ContactLaw law;
  double gravity, step;  // s, 0: adaptive
};

std::vector<double> places_on(const Axis& axis) {
  const std::vector<double> ends = axis.edges();
  std::vector<double> out;
  for (int k = 0; k <= k_places; ++k) {
    const double part = static_cast<double>(k) / k_places;
    out.push_back(axis.logarithmic ? ends.front() * std::pow(ends.back() / ends.front(), part)
                                   : std::lerp(ends.front(), ends.back(), part));
  }
  return out;
}

/// Nothing where there is no such scene.
std::optional<Place> place_at(const StabilityPlan& plan, const std::optional<double>& x,
                              const std::optional<double>& y) {
  std::vector<std::string> changes;
  if (x) changes.push_back(plan.x.change_to(*x));
  if (y) changes.push_back(plan.y.change_to(*y));
  try {
    const Setup setup = stepped_by(plan, plan.methods.front(), changes);
    const Parameters& p = setup.parameters;
    return Place{x.value_or(0), y.value_or(0),    demand(setup, plan.horizon),
                 p.contact,     p.gravity.norm(), p.adaptive ? 0 : p.time_step};
  } catch (const io::InputError&) {
    return std::nullopt;
  }
}

/// Rows by y of places over both axes, or one row along the axis that does not bear the key.
class Places {
 public:
  Places(const StabilityPlan& plan, const char* table, const char* name) : plan_(plan) {
    const auto bears = [&](const Axis& axis) { return axis.table == table && axis.name == name; };
    bearer_ = bears(plan.x) ? &plan.x : bears(plan.y) ? &plan.y : nullptr;
    if (bearer_) {
      const bool on_x = bearer_ == &plan.x;
      rows_.emplace_back();
      for (const double at : places_on(on_x ? plan.y : plan.x))
        if (auto place = on_x ? place_at(plan, {}, at) : place_at(plan, at, {})) rows_[0].push_back(*place);
      return;
    }
    for (const double x : places_on(plan.x)) {
      rows_.emplace_back();
      for (const double y : places_on(plan.y))
        if (auto place = place_at(plan, x, y)) rows_.back().push_back(*place);
    }
  }

  /// Where `value` is `limit`, both SI; 0: there is none.
  void draw(StabilityLimit& line, const std::function<double(const Place&)>& limit,
            const std::function<double(const Place&)>& value) const {
    const auto add = [&](double x, double y) {
      line.x.push_back(x);
      line.y.push_back(y);
    };
    if (bearer_) {
      for (const Place& place : rows_[0])
        if (const double at = limit(place) / bearer_->si; at > 0)
          bearer_ == &plan_.x ? add(at, place.y) : add(place.x, at);
      return;
    }
    for (const std::vector<Place>& column : rows_)
      for (std::size_t k = 0; k + 1 < column.size(); ++k) {
        const auto off = [&](const Place& p) {
          return limit(p) > 0 && value(p) > 0 ? std::log(limit(p) / value(p)) : 0;
        };
        const double below = off(column[k]), above = off(column[k + 1]);
        if (!(below * above < 0)) continue;
        add(column[k].x, std::lerp(column[k].y, column[k + 1].y, below / (below - above)));
        break;
      }
  }

 private:
  const StabilityPlan& plan_;
  const Axis* bearer_;
  std::vector<std::vector<Place>> rows_;
};

}  // namespace

Demand demand(const Setup& scene, double duration) {
  const Model& model = scene.model;
  const Parameters& p = scene.parameters;
  Demand out;
  for (int b = 0; b < model.furniture_total(); ++b) {
    BodySystem system(model, b);
    out.explicit_step =
        positive_min(out.explicit_step, explicit_limit(system, &p.contact, damping_time(model, p, b)));
    if (p.gravity.isZero(0))
      out.turning = std::max(out.turning, scene.starts[b].angular_velocity.squaredNorm() * duration);
    if (model.planes.empty() || model.bodies[b].contact_point_count == 0) continue;
    out.bounce = positive_min(out.bounce, contact_period(model, b, p.contact, p.gravity));
    if (floor_of(model) && why_not_standing(model, b).empty()) add_fall(scene, b, out);
    add_throw(scene, b, out);
  }
  return out;
}

double impact_error(double step, double period) {
  const double w_h = 2 * k_pi / period * step;
  return w_h * w_h / 4;
}

double step_of_impact_error(double error, double period) {
  return std::sqrt(error) * period / k_pi;
}

double step_of_damping(double share, double gamma, double turning) {
  return -std::log(1 - share) / (2 * (gamma - 0.5) * turning);
}

double step_of_chatter(const ContactLaw& law, double gravity) {
  if (traits(law).sticks) return 0;
  const double deceleration = law.friction * gravity;
  return deceleration > 0 ? 2 * law.slip_speed / deceleration : 0;
}

std::vector<StabilityLimit> stability_limits(const StabilityPlan& plan) {
  std::vector<std::string> implicit, all, smooth;
  std::vector<const SteppingMethod*> damping;
  for (const SteppingMethod& m : plan.methods) {
    all.push_back(m.name);
    if (m.of_scene() || traits(m.integrator).is_explicit) continue;
    implicit.push_back(m.name);
    if (m.integrator == Integrator::newmark && m.gamma > 0.5) damping.push_back(&m);
  }
  const Places steps(plan, "run", "time_step"), alphas(plan, "contact", "alpha");
  const Place own = *place_at(plan, {}, {});
  std::vector<StabilityLimit> list;
  const auto add_step = [&](const char* name, const char* formula, const char* about,
                            const std::vector<std::string>& methods,
                            const std::function<double(const Place&)>& limit) {
    StabilityLimit line{name, formula, about, methods, {}, {}, {}, "ms"};
    if (const double at = limit(own); at > 0) line.at_scene = 1e3 * at;
    steps.draw(line, limit, [](const Place& p) { return p.step; });
    if (line.at_scene || !line.x.empty()) list.push_back(std::move(line));
  };
  add_step("explicit", "h = 2/ω",
           "stiffest vibration, every contact closed: central differences grow above it",
           {"central-difference"}, [](const Place& p) { return p.demand.explicit_step; });
  add_step("impact", "h = 0.2/ω_c", "one closing or opening of a contact costs or gives (ω_c h)^2/4 = 1 %",
           implicit, [](const Place& p) { return step_of_impact_error(k_stable_balance, p.demand.bounce); });
  add_step("bounce", "h = 2/ω_c", "... all of the energy: e^2 = 1 ± (ω_c h)^2/4; ω_c: a body on its contacts",
           implicit, [](const Place& p) { return step_of_impact_error(1, p.demand.bounce); });
  add_step("tunnelling", "h = L/v", "a landing corner crosses the contact width L in one step", implicit,
           [](const Place& p) { return p.demand.landing; });
  for (const SteppingMethod* m : damping)
    add_step("damping", "h = 0.105/(2(γ - 1/2)∫ω^2 dt)", "takes 10 % of the energy of a fall or rotation",
             {m->name}, [m](const Place& p) {
               return p.demand.turning > 0 ? step_of_damping(k_stable_damping, m->gamma, p.demand.turning)
                                           : 0;
             });
  add_step("chatter", "h = 2 v_s/(μ g)", "smoothed friction changes sides from step to step", all,
           [](const Place& p) { return step_of_chatter(p.law, p.gravity); });
  StabilityLimit capacity{
      "capacity",
      "α = E (q + 1)/(n L)",
      "a fall or throw of energy E sinks past the floor's centre line below it, by any method",
      all,
      {},
      {},
      {},
      "kgf"};
  const auto least = [](const Place& p) { return p.demand.alpha; };
  if (least(own) > 0) capacity.at_scene = least(own) / k_standard_gravity;
  alphas.draw(capacity, least, [](const Place& p) { return p.law.alpha; });
  if (capacity.at_scene || !capacity.x.empty()) list.push_back(std::move(capacity));
  return list;
}

}  // namespace topple::study
