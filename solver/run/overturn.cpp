#include "solver/run/overturn.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/body/anchors.h"
#include "solver/body/model_level.h"
#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/math/elementary.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr double k_upright_normal = 0.7;  // planes steeper than 45 degrees are walls
constexpr double k_fallen = k_pi / 3;     // stop_when = "all-overturned"
constexpr double k_fallen_for = 0.5;      // s

// Distance from p to the boundary of a counter-clockwise polygon along the unit direction d, horizontal.
double distance_to_edge(const std::vector<Vec3>& polygon, const Vec3& p, const Vec3& d) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec3 outward(edge.y(), -edge.x(), 0);
    const double speed = outward.dot(d);
    if (speed <= 0) continue;
    nearest = std::min(nearest, outward.dot(polygon[i] - p) / speed);
  }
  return nearest;
}

/// p: above the polygon, or on its boundary, in plan.
bool is_above(const std::vector<Vec3>& polygon, const Vec3& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (Vec3(edge.y(), -edge.x(), 0).dot(p - polygon[i]) > 0) return false;
  }
  return true;
}

bool is_floor(const Plane& plane) {
  return plane.normal.z() > k_upright_normal;
}

bool has_floor(const Model& model) {
  return std::any_of(model.planes.begin(), model.planes.end(), is_floor) ||
         std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.ground; });
}

/// m, up to which what pushes a body up acts on its base.
double base_slack(const Body& body) {
  return 1e-6 + 1e-6 * body.reach;
}

bool reaches_base(const Model& model, int part) {
  const Body& body = model.bodies[body_of(model, part)];
  return !body.support_polygon.empty() && ranges::any_of(nodes_of(model, part), [&](int node) {
    return model.node_position[node].z() <= body.support_polygon.front().z() + base_slack(body);
  });
}

/// What holds a body higher up may break, and lets it fall then.
bool is_base_supported(const Model& model, int index) {
  const Body& body = model.bodies[index];
  const double base = body.support_polygon.front().z() + 1e-6 * (1 + body.reach);
  return std::any_of(model.supports.begin(), model.supports.end(), [&](const Support& support) {
    return model.node_body[support.node] == index && model.node_position[support.node].z() <= base;
  });
}

/// Something pushes it up, as a pole does.
bool is_propped(const Model& model, int index) {
  return std::any_of(model.anchors.begin(), model.anchors.end(), [&](const Anchor& anchor) {
    return anchor.body == index && anchor.type == Anchor::Type::pole;
  });
}

/// From the centre of gravity of an upright body to the edge in the direction of the tilt, of one that is
/// upright to the nearest, m.
struct EdgeAhead {
  double distance, height;
};
std::optional<EdgeAhead> edge_ahead(const Model& model, int index, const BodyPose& pose, const Vec3& centre) {
  const Body& body = model.bodies[index];
  if (body.support_polygon.empty() || !has_floor(model) || is_base_supported(model, index))
    return std::nullopt;
  const Vec3 up = pose.rotation.conjugate() * Vec3::UnitZ();
  const double height = centre.z() - body.support_polygon.front().z();
  const double lean = up.head<2>().norm();
  if (lean > k_uplift_angle) {
    const Vec3 downhill = Vec3(-up.x(), -up.y(), 0) / lean;
    return EdgeAhead{distance_to_edge(body.support_polygon, centre, downhill), height};
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < body.support_polygon.size(); ++i) {
    const Vec3 edge = body.support_polygon[(i + 1) % body.support_polygon.size()] - body.support_polygon[i];
    const Vec3 outward = Vec3(edge.y(), -edge.x(), 0).normalized();
    nearest = std::min(nearest, outward.dot(body.support_polygon[i] - centre));
  }
  return EdgeAhead{nearest, height};
}

}  // namespace

void find_stacks(const Model& model, std::span<const Bearer> bearers, std::span<const BodyPose> poses,
                 std::vector<Stack>& stacks) {
  constexpr double k_as_high = 0.25;  // of the reach
  stacks.clear();
  for (std::size_t b = 0; b < poses.size(); ++b)
    stacks.push_back({model.bodies[b].mass, model.bodies[b].centre_of_gravity});
  const auto within = [&](int under, const Vec3& point) -> Vec3 {
    return poses[under].rotation.conjugate() * (point - poses[under].centre) +
           model.bodies[under].centre_of_gravity;
  };
  const auto rides = [&](int b) {
    const auto& [under, place] = bearers[b];
    return std::abs((place_on(model, b, poses[b], under, poses[under]) - place).z()) <
               k_as_high * model.bodies[b].reach &&
           is_above(model.bodies[under].support_polygon, within(under, poses[b].centre));
  };
  for (std::size_t b = 0; b < poses.size(); ++b)
    for (int on = static_cast<int>(b); bearers[on].body >= 0 && rides(on); on = bearers[on].body) {
      Stack& under = stacks[bearers[on].body];
      under.mass += model.bodies[b].mass;
      under.centre_of_gravity += model.bodies[b].mass / under.mass *
                                 (within(bearers[on].body, poses[b].centre) - under.centre_of_gravity);
    }
}

double critical_angle(const Model& model, int index, const BodyPose& pose, const Stack& stack) {
  const auto edge = edge_ahead(model, index, pose, stack.centre_of_gravity);
  return edge ? elementary::atan2(edge->distance, edge->height) : std::numeric_limits<double>::infinity();
}

OverturnBarrier overturn_barrier(const Model& model, int index, const BodyPose& pose, const Stack& stack,
                                 double gravity) {
  const auto edge = edge_ahead(model, index, pose, stack.centre_of_gravity);
  constexpr double k_never = std::numeric_limits<double>::infinity();
  if (!edge) return {k_never, k_never};
  const double critical = elementary::atan2(edge->distance, edge->height);
  const auto barrier = [&](double angle) {
    return stack.mass * gravity * elementary::hypot(edge->distance, edge->height) *
           (1 - elementary::cos(critical - std::min(angle, critical)));
  };
  return {barrier(tilt(pose)), barrier(0)};
}

double slide(const Model& model, int index, const BodyPose& pose, const Bearer& bearer, const BodyPose& on) {
  return (place_on(model, index, pose, bearer.body, on) - bearer.place).head<2>().norm();
}

Outcome::Outcome(const Model& model, const std::vector<BodyStart>& starts)
    : anchors_(model.anchors.size()),
      bearers_(bearers_of(model, starts)),
      broke_(model.elements.size()),
      flowed_(model.node_position.size()),
      furniture_(model.furniture_total()) {
  tilts_and_slides_.resize(model.bodies.size());
  for (const Section& section : model.sections) {
    const auto of = [&](const Vec3& normal, const Vec3& moment) {
      return equivalent_stress(section, {normal, moment});
    };
    const Vec3 zero = Vec3::Zero();
    unit_stress_.emplace_back(of(Vec3::UnitX(), zero), of(zero, Vec3::UnitX()), of(zero, Vec3::UnitY()),
                              of(zero, Vec3::UnitZ()));
  }
  for (const Body& body : model.bodies) {
    const std::size_t sides = body.support_polygon.size();
    BodyOutcome outcome;
    outcome.sides.resize(sides);
    bodies_.push_back(outcome);
    side_force_.emplace_back(sides, 0.);
    inner_force_.emplace_back(sides, 0.);
    total_force_.push_back(0);
    depth_.emplace_back();
    side_of_.emplace_back(body.contact_point_count);
    inner_of_.emplace_back(body.contact_point_count);
    for (int side = 0; side < static_cast<int>(sides); ++side) list_points(model, body, side);
  }
  const int parts = static_cast<int>(model.elements.size() + model.panels.size());
  for (int part = 0; part < parts; ++part) reaches_base_.push_back(reaches_base(model, part));
}

// What rocks over the opposite side stands on the points farthest from this one; of a base with three legs or
// five a corner between them may bear it.
void Outcome::list_points(const Model& model, const Body& body, int side) {
  const std::vector<Vec3>& corners = body.support_polygon;
  const Vec3& from = corners[side];
  const Vec3 edge = corners[(side + 1) % corners.size()] - from;
  const double near = 1e-6 * edge.squaredNorm();
  const auto before = [&](const Vec3& x) {
    const Vec3 to = x - from;
    return edge.x() * to.y() - edge.y() * to.x();
  };
  double farthest = 0;
  for (const Vec3& corner : corners) farthest = std::max(farthest, before(corner));
  depth_.back().push_back(farthest / edge.norm());
  for (const int point : body.base_points) {
    const Vec3& x = model.node_position[model.contact_points[point].node];
    const int own = point - body.first_contact_point;
    const auto is_here = [&](const Vec3& corner) { return (corner - x).squaredNorm() < near; };
    if (std::abs(before(x)) < near)
      side_of_.back()[own].push_back(side);
    else if (before(x) < farthest - near && std::none_of(corners.begin(), corners.end(), is_here))
      inner_of_.back()[own].push_back(side);
  }
}

void Outcome::carry(const Model& model, int part, double t, double u, const Vec3& force) {
  if (!(force.z() > 0) || !reaches_base_[part]) return;
  const int b = body_of(model, part);
  const Body& body = model.bodies[b];
  const double base = body.support_polygon.front().z(), slack = base_slack(body);
  Vec3 x = Vec3::Zero();
  each_share(model, part, t, u, [&](int node, double share) { x += share * model.node_position[node]; });
  if (x.z() > base + slack) return;
  total_force_[b] += force.z();
  const std::size_t sides = body.support_polygon.size();
  for (std::size_t i = 0; i < sides; ++i) {
    // on the half next to it: what bears may be narrower than the base
    const Vec3 edge = body.support_polygon[(i + 1) % sides] - body.support_polygon[i];
    const Vec3 to = x - body.support_polygon[i];
    const double from_edge = (edge.x() * to.y() - edge.y() * to.x()) / edge.norm();
    if (from_edge < depth_[b][i] / 2 - slack) side_force_[b][i] += force.z();
  }
}

// What the sides of the bases carry.
void Outcome::observe_forces(const Model& model, const std::vector<ContactForce>& forces,
                             const std::vector<MemberForce>& between) {
  for (auto* carried : {&side_force_, &inner_force_})
    for (auto& sides : *carried) std::fill(sides.begin(), sides.end(), 0.);
  std::fill(total_force_.begin(), total_force_.end(), 0.);
  for (const ContactForce& f : forces) {
    const int b = model.node_body[model.contact_points[f.point].node];
    bodies_[b].peak_penetration = std::max(bodies_[b].peak_penetration, f.depth);
    const double up =
        is_floor(model.planes[f.plane]) ? f.normal : std::max(0., f.force.z());  // a wall's grip
    total_force_[b] += up;
    const int point = f.point - model.bodies[b].first_contact_point;
    for (const int side : side_of_[b][point]) side_force_[b][side] += up;
    for (const int side : inner_of_[b][point]) inner_force_[b][side] += up;
  }
  for (const MemberForce& f : between) {
    carry(model, f.elements.a, f.s, 0, f.force);
    carry(model, f.elements.b, f.t, f.u, -f.force);
    for (const int part : {f.elements.a, f.elements.b}) {
      double& pinch = bodies_[body_of(model, part)].peak_pinch;
      pinch = std::max(pinch, f.depth);
    }
  }
}

void Outcome::observe_level(const Parameters& parameters, const State& state, std::size_t b,
                            std::vector<Event>& events) {
  BodyOutcome& o = bodies_[b];
  const BodyState& now = state.bodies[b];
  o.always_rigid = o.always_rigid && !traits(now.level).has_stresses;
  const bool listed = !parameters.models.empty() && traits(parameters.models[b]).lists_start;
  if (o.level != now.level && (o.level || listed)) {
    events.push_back({.kind = Event::Kind::model,
                      .step = state.step,
                      .time = state.time,
                      .body = static_cast<int>(b),
                      .value = static_cast<double>(now.level),
                      .reason = now.reason});
    if (o.level_changes.size() < k_kept_impacts)
      o.level_changes.push_back({state.time, now.level, now.reason, 0});
  }
  o.level = now.level;
  if (!o.level_changes.empty()) {
    LevelChange& latest = o.level_changes.back();
    if (latest.level == now.level)
      latest.error_estimate = std::max(latest.error_estimate, now.error_estimate);
  }
}

void Outcome::take_pose(const Model& model, std::size_t b) {
  BodyOutcome& o = bodies_[b];
  const int body = static_cast<int>(b);
  const BodyPose& pose = poses_[b];
  o.tilt = tilt(pose);
  o.peak_tilt = std::max(o.peak_tilt, o.tilt);
  if (o.first_impact) o.rebound_tilt = std::max(o.rebound_tilt, o.tilt);
  if (o.peak_tilts.empty()) o.peak_tilts.push_back(o.tilt);
  o.peak_tilts.back() = std::max(o.peak_tilts.back(), o.tilt);
  o.slide = topple::slide(model, body, pose, bearers_[b], bearer_pose(poses_, bearers_[b].body));
  o.peak_slide = std::max(o.peak_slide, o.slide);
  o.critical = critical_angle(model, body, pose, stacks_[b]);
  const double share = o.tilt / o.critical;
  BodyOutcome::Nearest& nearest = o.beyond_since ? o.beyond : o.peak;
  if (share >= nearest.share) nearest = {share, o.critical};
}

void Outcome::observe_pose(const Model& model, const State& state, std::size_t b,
                           std::vector<Event>& events) {
  BodyOutcome& o = bodies_[b];
  const double before = o.tilt - o.critical, time_before = o.time;
  o.time = state.time;
  const BodyPose on = bearer_pose(poses_, bearers_[b].body);
  o.vertical = poses_[b].rotation.conjugate() * (on.rotation * Vec3::UnitZ());
  take_pose(model, b);
  if (!ends_known_) tilts_and_slides_[b] = tilt_and_slide(model, state, b);
  const double beyond = o.tilt - o.critical;
  if (beyond > 0 && !o.beyond_since) {
    const bool crossed = state.step > 0 && before < 0;
    o.beyond_since =
        crossed ? time_before + (state.time - time_before) * before / (before - beyond) : state.time;
    if (!o.first_beyond) o.first_beyond = o.beyond_since;
    o.beyond = o.peak;  // should it come back
    o.peak = {o.tilt / o.critical, o.critical};
    events.push_back({.kind = Event::Kind::overturn,
                      .step = state.step,
                      .time = *o.beyond_since,
                      .body = static_cast<int>(b),
                      .value = o.tilt});
  } else if (beyond <= 0) {
    if (o.beyond.share > o.peak.share) o.peak = o.beyond;  // it has come back
    o.beyond = {};
    o.beyond_since.reset();
  }
  if (o.tilt <= k_fallen)
    o.over_60_since.reset();
  else if (!o.over_60_since)
    o.over_60_since = state.time;
}

void Outcome::find_poses(const Model& model, const State& state) {
  poses_.clear();
  for (int b = 0; b < furniture_; ++b) poses_.push_back(body_pose(model, state, b));
  find_stacks(model, bearers_, poses_, stacks_);
}

std::array<Outcome::Varying, 2> Outcome::tilt_and_slide(const Model& model, const State& state,
                                                        std::size_t b) const {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  std::array<Varying, 2> out{{{k_none, k_none}, {k_none, k_none}}};
  const BodyState& s = state.bodies[b];
  if (traits(s.level).moves_nodes) return out;
  const Vec3 axis = s.rotation * Vec3::UnitZ(), turning = s.rotation * s.angular_velocity;
  out[0] = {-axis.z(), -turning.cross(axis).z()};
  if (bearers_[b].body >= 0) return out;
  const Vec3 arm = s.rotation * (model.bodies[b].base_centre - model.bodies[b].centre_of_gravity);
  const Eigen::Vector2d way = (s.position + arm - bearers_[b].place).head<2>(),
                        speed = (s.velocity + turning.cross(arm)).head<2>();
  const double slid = way.norm();
  out[1] = {slid, slid > 0 ? way.dot(speed) / slid : speed.norm()};
  return out;
}

void Outcome::observe_peaks(const Model& model, const State& end,
                            const std::function<const State&(double time)>& within) {
  for (std::size_t b = 0; b < static_cast<std::size_t>(furniture_); ++b) {
    BodyOutcome& o = bodies_[b];
    const std::array<Varying, 2> to = tilt_and_slide(model, end, b);
    const double h = end.time - o.time;
    const double least[] = {-elementary::cos(o.peak_tilts.empty() ? 0 : o.peak_tilts.back()), o.peak_slide};
    for (std::size_t k = 0; k < to.size(); ++k) {
      const Varying &before = tilts_and_slides_[b][k], &after = to[k];
      if (!(before.rate > 0 && after.rate < 0)) continue;
      // the cubic polynomial with these values and rates, whose derivative is a t^2 + b t + c
      const double rise = 6 * (before.value - after.value), r0 = h * before.rate, r1 = h * after.rate;
      const double quadratic = rise + 3 * (r0 + r1), linear = -rise - 4 * r0 - 2 * r1;
      const double t = 2 * r0 / (std::sqrt(linear * linear - 4 * quadratic * r0) - linear);
      const double greatest = before.value + t * (r0 + t * (linear / 2 + t * quadratic / 3));
      if (!(greatest > least[k])) continue;
      const double tilt = o.tilt, critical = o.critical;  // at the last observation, from which it goes on
      find_poses(model, within(o.time + t * h));
      take_pose(model, b);
      o.tilt = tilt;
      o.critical = critical;
    }
    tilts_and_slides_[b] = to;
  }
  ends_known_ = true;
}

// What lifts off and lands, until the body overturns: then the base is no longer what it lies on. An uplift
// is told once it counts, with the time at which the side let go.
void Outcome::observe_sides(const Model& model, const State& state, double weight, std::size_t b,
                            std::vector<Event>& events) {
  BodyOutcome& o = bodies_[b];
  for (std::size_t i = 0; i < o.sides.size(); ++i) {
    BodyOutcome::Side& side = o.sides[i];
    const auto add = [&](Event::Kind kind, double time) {
      events.push_back({.kind = kind,
                        .step = state.step,
                        .time = time,
                        .body = static_cast<int>(b),
                        .value = static_cast<double>(i)});
    };
    const double carried = side_force_[b][i];
    if (!side.open && carried + inner_force_[b][i] < k_uplift * weight &&
        total_force_[b] > k_closing * weight)
      side = {.open = true,
              .counts = false,
              .borne_otherwise = state.step == 0 && is_propped(model, static_cast<int>(b)),
              .since = state.time,
              .vertical = o.vertical};
    if (!side.open) continue;
    // or is higher from the start on; a corner that trembles while the body tips over the next side is not
    const auto lifts = [&] {
      const auto& corners = model.bodies[b].support_polygon;
      const Vec3 along = corners[(i + 1) % corners.size()] - corners[i],
                 outward = Vec3(along.y(), -along.x(), 0).normalized(), turned = o.vertical - side.vertical;
      return turned.norm() > k_uplift_angle &&
             std::max(outward.dot(turned), outward.dot(o.vertical)) > k_uplift_angle;
    };
    if (!side.counts && !side.borne_otherwise && !o.beyond_since && lifts()) {
      side.counts = true;
      if (!o.first_uplift) o.first_uplift = side.since;
      add(Event::Kind::uplift, side.since);
    }
    if (!(carried > k_closing * weight)) continue;
    side.open = false;
    if (!side.counts || o.beyond_since) continue;
    ++o.impacts;
    if (!o.first_impact) o.first_impact = state.time;
    if (o.impact_times.size() < k_kept_impacts) {
      o.impact_times.push_back(state.time);
      o.peak_tilts.push_back(o.tilt);
    }
    add(Event::Kind::impact, state.time);
  }
}

void Outcome::observe(const Model& model, const Parameters& parameters, const State& state,
                      const std::vector<ContactForce>& forces, const std::vector<MemberForce>& between,
                      std::vector<Event>& events) {
  const bool goes_on = state.step > 0 && !bodies_.empty() && !bodies_.front().level;  // from a checkpoint
  observe_forces(model, forces, between);
  find_poses(model, state);
  for (std::size_t b = 0; b < poses_.size(); ++b) {
    observe_level(parameters, state, b, events);
    observe_pose(model, state, b, events);
    observe_sides(model, state, model.bodies[b].mass * parameters.gravity.norm(), b, events);
  }
  ends_known_ = false;
  observe_hinges(model, state, goes_on, events);
  observe_anchors(model, state, events);
}

void Outcome::observe_anchors(const Model& model, const State& state, std::vector<Event>& events) {
  for (int k = 0; k < static_cast<int>(anchors_.size()); ++k) {
    const Anchor& anchor = model.anchors[k];
    AnchorOutcome& o = anchors_[k];
    AnchorState whole = state.anchors[k];
    const bool first = !o.hold && state.step > 0;  // goes on from a checkpoint
    const bool breaks = whole.hold == AnchorHold::broken && o.hold != AnchorHold::broken && !first;
    if (breaks) whole.hold = AnchorHold::in_place;  // as it was when it broke
    const double tension = anchor_force_at(model, state, k, whole).tension;
    o.hold = state.anchors[k].hold;
    o.tension = breaks ? 0 : tension;
    o.peak_force = std::max(o.peak_force, std::abs(tension));
    if (!breaks) continue;
    o.broke = state.time;
    events.push_back({.kind = Event::Kind::anchor,
                      .step = state.step,
                      .time = state.time,
                      .body = anchor.body,
                      .value = tension,
                      .anchor = k});
  }
}

double Outcome::observe_stresses(const Model& model, int index, const std::vector<SectionForces>& sections) {
  const Body& body = model.bodies[index];
  BodyOutcome& o = bodies_[index];
  double greatest = 0;  // squared
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    const Eigen::Vector4d& stress = unit_stress_[model.members[element.member].section];
    const bool yields = std::isfinite(element.capacity[0]);
    for (const int end : {-1, 1}) {
      const SectionForces forces = forces_along(sections[e], element.length, element.s, end);
      const double normal = std::abs(forces.normal.x()) * stress[0] +
                            std::abs(forces.moment.y()) * stress[2] + std::abs(forces.moment.z()) * stress[3];
      const double shear = forces.moment.x() * stress[1];
      greatest = std::max(greatest, normal * normal + shear * shear);
      if (!yields) continue;
      o.peak_yield_ratio =
          std::max(o.peak_yield_ratio.value_or(0), std::sqrt(yield_function(element, forces) + 1));
    }
  }
  greatest = std::sqrt(greatest);
  o.peak_stress = std::max(o.peak_stress, greatest);
  return greatest;
}

void Outcome::observe_hinges(const Model& model, const State& state, bool goes_on,
                             std::vector<Event>& events) {
  const auto look = [&](int e, int body) {
    const Element& element = model.elements[e];
    const ElementState& now = state.elements[e];
    const bool flows = now.hinge != Hinge::none;
    const Hinge hinge = flows ? now.hinge : flowed_at(element, now);  // it may have unloaded within the step
    if (hinge == Hinge::none) return;
    BodyOutcome& o = bodies_[body];
    const auto tell = [&](Event::Kind kind, Hinge value, int& count) {
      ++count;
      events.push_back({.kind = kind,
                        .step = state.step,
                        .time = state.time,
                        .body = body,
                        .value = static_cast<double>(value),
                        .element = e});
    };
    if (hinge == Hinge::broken && !std::exchange(broke_[e], true))
      tell(Event::Kind::fracture, hinge, o.fractures);
    for (int place = 0; place < 2; ++place)
      if (has_hinge(hinge, place) && !std::exchange(flowed_[element.node[place]], true) &&
          (flows || !goes_on))
        tell(Event::Kind::hinge,
             hinge != Hinge::both ? hinge
             : place == 0         ? Hinge::first
                                  : Hinge::second,
             o.hinges);
  };
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[b];
    if (!traits(state.bodies[b].level).moves_nodes) continue;
    for (int e = body.first_element; e < body.first_element + body.element_count; ++e) look(e, b);
  }
}

bool Outcome::all_overturned(double time) const {
  // those of the ground never change
  return std::all_of(bodies_.begin(), bodies_.begin() + furniture_, [&](const BodyOutcome& o) {
    return o.over_60_since && time - *o.over_60_since >= k_fallen_for;
  });
}

}  // namespace topple
