#include "solver/study/common/standing.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/study/common/alone.h"

namespace topple::study {
namespace {

constexpr double k_across = 1 - 1e-6;   // cosine, of an edge that lies across a direction
constexpr double k_least_share = 1e-6;  // likewise, of one that a push has a part across

/// What the floor does when the body is `sunk` deeper than in the reference pose and leans by theta.
struct Support {
  double force = 0, moment = 0, stiffness = 0;  ///< N, N m about the centre of gravity, N/m
};

Support support_at(const Standing& body, const ContactLaw& law, double sunk, double theta) {
  Support sum;
  for (const Standing::Contact& contact : body.contacts) {
    const double depth = (contact.sunk + sunk + theta * contact.place) / contact.L;
    if (!(depth > 0)) continue;
    const double force = penalty_force(law, depth);
    sum.force += force;
    sum.moment += force * contact.place;
    sum.stiffness += law.q * force / (depth * contact.L);
  }
  return sum;
}

/// How far the body sinks at a lean until the floor carries its weight: Newton's method, halving where it
/// leaves its bounds.
double balanced_sunk(const Standing& body, const ContactLaw& law, double theta) {
  double low = std::numeric_limits<double>::infinity(), high = low;
  const double one = std::pow(body.weight() / law.alpha, 1 / law.q);
  for (const Standing::Contact& contact : body.contacts) {
    const double touch = -contact.sunk - theta * contact.place;
    low = std::min(low, touch);
    high = std::min(high, touch + one * contact.L);  // this one alone would carry it
  }
  double sunk = high;
  for (int k = 0; k < 100 && high - low > 1e-15 * std::abs(high); ++k) {
    const Support now = support_at(body, law, sunk, theta);
    (now.force < body.weight() ? low : high) = sunk;
    const double from = sunk, next = sunk - (now.force - body.weight()) / now.stiffness;
    sunk = next > low && next < high ? next : (low + high) / 2;
    if (std::abs(sunk - from) < 1e-16 * body.height) break;
  }
  return sunk;
}

Support balanced(const Standing& body, const ContactLaw& law, double theta) {
  return support_at(body, law, balanced_sunk(body, law, theta), theta);
}

constexpr double k_stiffest = 1e12;  // alpha over the weight

/// Depth of one contact on a base that is sunk by rest[0] and leans by rest[1] and rest[2].
double depth_of(const Standing::Contact& contact, const Vec3& rest) {
  return (contact.sunk + rest.dot(Vec3(1, contact.place, contact.across))) / contact.L;
}

/// Sunk and leaning so that the contacts balance the weight: the least of the potential energy, by Newton's
/// method with steps that are halved until they lower it.
Vec3 plane_at_rest(const Standing& body, const ContactLaw& law) {
  const auto energy = [&](const Vec3& rest) {
    double sum = -body.weight() * rest[0];
    for (const Standing::Contact& contact : body.contacts)
      sum += penalty_energy(law, depth_of(contact, rest), contact.L);
    return sum;
  };
  Vec3 rest(balanced_sunk(body, law, 0), 0, 0);
  for (int k = 0; k < 100; ++k) {
    Vec3 left(body.weight(), 0, 0);
    Mat3 stiffness = Mat3::Zero();
    for (const Standing::Contact& contact : body.contacts) {
      const double depth = depth_of(contact, rest);
      if (!(depth > 0)) continue;
      const Vec3 arm(1, contact.place, contact.across);
      const double force = penalty_force(law, depth);
      left -= force * arm;
      stiffness += law.q * force / (depth * contact.L) * arm * arm.transpose();
    }
    Vec3 way = stiffness.fullPivLu().solve(left);
    while (energy(rest + way) > energy(rest) && way.norm() > 1e-14) way /= 2;
    rest += way;
    if (way.norm() < 1e-14) break;
  }
  return rest;
}

/// log of the number at which `passes` turns from false to true, by bisection between two logs.
template <typename Passes>
double turning_point(double low, double high, Passes passes) {
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (passes(std::exp(middle)) ? high : low) = middle;
  }
  return high;
}

/// Rocking about one edge of rigid contact, time in units of 1/p: angle, rate and the classical Runge-Kutta
/// step under push(t), an acceleration over g.
struct Rocking {
  double critical, angle = 0, rate = 0, time = 0;

  template <typename Push>
  void advance(double h, Push push) {
    const auto rise = [&](double t, double th) {
      return -std::sin(critical - th) + push(t) * std::cos(critical - th);
    };
    const double k1 = rise(time, angle), k2 = rise(time + h / 2, angle + h / 2 * rate),
                 k3 = rise(time + h / 2, angle + h / 2 * rate + h * h / 4 * k1),
                 k4 = rise(time + h, angle + h * rate + h * h / 2 * k3);
    angle += h * rate + h * h / 6 * (k1 + k2 + k3);
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    time += h;
  }
};

/// An edge of the base.
struct Edge {
  Vec3 outward;     // unit, horizontal
  double distance;  // m, from the centre of gravity
};

std::vector<Edge> edges_of(const Body& body) {
  std::vector<Edge> edges;
  const std::vector<Vec3>& corners = body.support_polygon;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 edge = corners[(i + 1) % corners.size()] - corners[i];
    const Vec3 outward = Vec3(edge.y(), -edge.x(), 0).normalized();
    edges.push_back({outward, outward.dot(corners[i] - body.centre_of_gravity)});
  }
  return edges;
}

Standing towards(const Model& model, const Parameters& parameters, int index, const Edge& edge) {
  const Body& body = model.bodies[index];
  const Plane floor = floor_of(model).value();
  const Vec3 centre = body.centre_of_gravity;
  Standing out;
  out.base = edge.distance;
  out.direction = edge.outward;
  out.edge = centre + out.base * out.direction;
  out.edge.z() = body.support_polygon.front().z();
  out.mass = body.mass;
  out.gravity = parameters.gravity.norm();
  out.height = centre.z() - out.edge.z();
  out.grip = body.grip;
  const Vec3 axis = Vec3::UnitZ().cross(out.direction);
  out.inertia_of_edge =
      axis.dot(body.inertia * axis) + body.mass * (out.base * out.base + out.height * out.height);
  for (const int point : body.base_points) {
    const ContactPoint& contact = model.contact_points[point];
    const Vec3& place = model.node_position[contact.node];
    const double gap = floor.normal.dot(place - floor.point) - contact.width / 2;
    out.contacts.push_back(
        {out.direction.dot(place - centre), axis.dot(place - centre), contact_length(contact, floor), -gap});
  }
  return out;
}

/// h, or less where the push has a kink at its end.
double step_to(double end, double time, double h) {
  constexpr double k_rounding = 1e-9;
  return time < end - k_rounding * h && time + h > end ? end - time : h;
}

/// Least amplitude, over g, of a push one way that ends at `end` and overturns before the body falls back.
/// push(amplitude, t) and its time of passing b/h, lifts(amplitude), in 1/p.
template <typename Push, typename Lifts>
double least_push(const Standing& body, double end, Push push, Lifts lifts) {
  constexpr int k_steps = 400;  // of the push
  const double h = end / k_steps;
  const auto falls = [&](double amplitude) {
    Rocking rocking{body.critical(), 0, 0, lifts(amplitude)};
    while (true) {
      rocking.advance(step_to(end, rocking.time, h), [&](double t) { return push(amplitude, t); });
      if (rocking.angle < 0 || (rocking.time >= end && rocking.rate < 0)) return false;
      if (rocking.time >= end && rocking.angle > rocking.critical) return true;
    }
  };
  double low = body.rigid_limit() * (1 + 1e-9), high = 2 * low;
  while (!falls(high)) high *= 2;
  while (high - low > 1e-8 * high) {
    const double middle = (low + high) / 2;
    (falls(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

double Standing::critical() const {
  return std::atan2(base, height);
}

double Standing::p() const {
  return std::sqrt(weight() * std::hypot(base, height) / inertia_of_edge);
}

Standing standing(const Model& model, const Parameters& parameters, int body) {
  const std::vector<Edge> edges = edges_of(model.bodies[body]);
  return towards(model, parameters, body,
                 *std::ranges::min_element(edges, [](const Edge& one, const Edge& other) {
                   return one.distance < other.distance * (1 - 1e-9);
                 }));
}

std::optional<Standing> standing_towards(const Model& model, const Parameters& parameters, int body,
                                         const Vec3& direction) {
  for (const Edge& edge : edges_of(model.bodies[body]))
    if (edge.outward.dot(direction) > k_across) return towards(model, parameters, body, edge);
  return std::nullopt;
}

std::optional<PushedOver> pushed_over(const Model& model, const Parameters& parameters, int body,
                                      const Vec3& direction) {
  const std::vector<Edge> edges = edges_of(model.bodies[body]);
  const auto way = [&](const Edge& edge) { return edge.distance / edge.outward.dot(direction); };
  const Edge* first = nullptr;
  for (const Edge& edge : edges)
    if (edge.outward.dot(direction) > k_least_share && (!first || way(edge) < way(*first))) first = &edge;
  if (!first) return std::nullopt;
  return PushedOver{towards(model, parameters, body, *first), first->outward.dot(direction)};
}

double rest_depth(const Standing& body, const ContactLaw& law) {
  const Vec3 rest = plane_at_rest(body, law);
  double deepest = 0;
  for (const Standing::Contact& contact : body.contacts) deepest = std::max(deepest, depth_of(contact, rest));
  return deepest;
}

double bounce_frequency(const Standing& body, const ContactLaw& law) {
  return std::sqrt(balanced(body, law, 0).stiffness / body.mass) / (2 * k_pi);
}

double tipping_limit(const Standing& body, const ContactLaw& law) {
  constexpr int k_places = 240;  // of the lean, evenly in its logarithm
  constexpr double k_decades = 12;
  const auto withstood = [&](double k) {
    const double theta = body.critical() * std::pow(10., k_decades * (k / k_places - 1));
    return balanced(body, law, theta).moment / (body.weight() * body.height) - theta;
  };
  int at = 0;
  double best = withstood(0);
  for (int k = 1; k <= k_places; ++k)
    if (const double now = withstood(k); now > best) {
      best = now;
      at = k;
    }
  // golden section: the maximum is a corner where a row of contacts lifts
  const double golden = (std::sqrt(5.) - 1) / 2;
  double from = at - 1, to = at + 1;
  while (to - from > 1e-7) {
    const double a = to - golden * (to - from), b = from + golden * (to - from);
    if (withstood(a) < withstood(b))
      from = a;
    else
      to = b;
  }
  return std::max({best, withstood((from + to) / 2), 0.});
}

double stiff_limit(const Standing& body, ContactLaw law) {
  constexpr double k_hardly = 1e-8;  // of L: the contacts give way, more than rounding
  law.alpha = body.weight() * std::pow(1 / k_hardly, law.q);
  return std::min(tipping_limit(body, law), body.rigid_limit());
}

std::optional<double> soft_limit(const Standing& body, const ContactLaw& law) {
  constexpr double k_nearly = 0.95;
  const double limit = tipping_limit(body, law);
  return limit < k_nearly * body.rigid_limit() ? std::optional(body.gravity * limit) : std::nullopt;
}

double alpha_for_tipping(const Standing& body, ContactLaw law, double loss) {
  const double enough = (1 - loss) * stiff_limit(body, law);
  return std::exp(
      turning_point(std::log(1e-3 * body.weight()), std::log(k_stiffest * body.weight()), [&](double alpha) {
        law.alpha = alpha;
        return tipping_limit(body, law) >= enough;
      }));
}

double alpha_for_period(const Standing& body, ContactLaw law, double period) {
  return std::exp(
      turning_point(std::log(1e-3 * body.weight()), std::log(k_stiffest * body.weight()), [&](double alpha) {
        law.alpha = alpha;
        return bounce_frequency(body, law) * period >= 1;
      }));
}

double fall_back_time(const Standing& body) {
  constexpr double k_step = 1e-3;
  Rocking rocking{body.critical(), body.critical() / 2};
  while (true) {
    const double before = rocking.angle;
    rocking.advance(k_step, [](double) { return 0.; });
    if (rocking.angle <= 0)
      return (rocking.time - k_step * rocking.angle / (rocking.angle - before)) / body.p();
  }
}

double least_half_sine(const Standing& body, double ratio) {
  const double end = k_pi / ratio;
  return least_push(
      body, end, [&](double amplitude, double t) { return t < end ? amplitude * std::sin(ratio * t) : 0; },
      [&](double amplitude) { return std::asin(body.rigid_limit() / amplitude) / ratio; });
}

double least_rectangle(const Standing& body, double length) {
  return least_push(
      body, length, [&](double amplitude, double t) { return t < length ? amplitude : 0; },
      [](double) { return 0.; });
}

std::optional<double> least_full_sine(const Standing& body, double ratio, double most) {
  constexpr int k_steps = 200;  // of the pulse, or of 4/p where that is shorter
  constexpr double k_near = 1.002, k_apart = 1.01, k_still = 1e-6;
  const double end = 2 * k_pi / ratio, h = std::min(end, 4.) / k_steps;
  const double kept = 1 - 2 * body.mass * body.base * body.base / body.inertia_of_edge;
  const auto falls = [&](double amplitude) {
    Rocking rocking{body.critical(), 0, 0, std::asin(body.rigid_limit() / amplitude) / ratio};
    double side = 1;
    const auto push = [&](double t) { return t < end ? side * amplitude * std::sin(ratio * t) : 0; };
    while (rocking.angle < k_pi / 2) {
      if (rocking.time >= end) {
        if (rocking.angle > rocking.critical) return true;
        // what is below the energy of standing on the edge stays there
        if (rocking.rate * rocking.rate / 2 + std::cos(rocking.critical - rocking.angle) < 1) return false;
      }
      if (rocking.angle == 0 && rocking.rate < k_still) {  // it stands until it is pushed enough
        if (push(rocking.time) < 0) side = -side;
        if (push(rocking.time) < body.rigid_limit() * (1 - 1e-9)) {
          rocking.rate = 0;
          rocking.time += h;
          continue;
        }
      }
      const Rocking before = rocking;
      const double step = step_to(end, rocking.time, h);
      rocking.advance(step, push);
      if (rocking.angle >= 0) continue;
      double low = 0, high = step;  // the landing lies between
      while (high - low > 1e-12) {
        const double middle = (low + high) / 2;
        rocking = before;
        rocking.advance(middle, push);
        (rocking.angle < 0 ? high : low) = middle;
      }
      rocking.angle = 0;
      rocking.rate *= -kept;
      side = -side;
    }
    return true;
  };
  double low = body.rigid_limit(), high = low * (1 + 1e-9);
  while (!falls(high)) {
    low = high;
    high *= high < 1.5 * body.rigid_limit() ? k_near : k_apart;  // slow pulses fall in narrow ranges
    if (high > most) return std::nullopt;
  }
  while (high - low > 1e-6 * high) {
    const double middle = (low + high) / 2;
    (falls(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace topple::study
