#include "solver/planar/planar_case.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/math/rotation.h"
#include "solver/model/accelerogram.h"
#include "solver/model/excitation.h"

namespace topple::planar {
namespace {

constexpr double k_level = 1e-9;          // sine of an angle that counts as none, and products of inertia
constexpr double k_same_place = 1e-7;     // m, as of BodyBuilder
constexpr double k_at_rest = 1e-12;       // m/s, of an edge that stays on the floor
constexpr double k_last_tilt = k_pi / 3;  // rad, least: where a run counts a body as fallen

/// What is looked at: each obstacle may rely on those above it in the table.
struct Candidate {
  const Model& model;
  const Parameters& parameters;
  const RigidMotion* motion;      ///< null: it moves along found.along already
  std::span<const Vec3> centres;  ///< of all bodies; empty: not looked at
  int index;
  const Body& body;
  const Plane* floor = nullptr;
  double width = 0;  ///< m, contact width of the base
  PlanarCase found{};

  const Vec3& node(const ContactPoint& point) const {
    return model.node_position[static_cast<std::size_t>(point.node)];
  }
  std::span<const ContactPoint> points() const {
    return std::span(model.contact_points)
        .subspan(static_cast<std::size_t>(body.first_contact_point),
                 static_cast<std::size_t>(body.contact_point_count));
  }
  const ContactPoint& base_point(int p) const { return model.contact_points[static_cast<std::size_t>(p)]; }
  /// From the centre of gravity: along, up, across.
  Vec3 place(const ContactPoint& point) const {
    const Vec3 arm = node(point) - body.centre_of_gravity;
    return {arm.dot(found.along), arm.z(), arm.dot(found.across)};
  }
  double base_height() const { return node(base_point(body.base_points.front())).z(); }
};

bool has_no_floor(Candidate& c) {
  const Vec3& g = c.parameters.gravity;
  if (c.body.ground || !(-g.z() > 0) || g.head<2>().norm() > k_level * g.norm()) return true;
  for (const Plane& plane : c.model.planes)
    if (plane.normal.head<2>().norm() <= k_level && plane.normal.z() > 0 && !c.floor) c.floor = &plane;
  return !c.floor;
}

bool is_held(Candidate& c) {
  const auto on_body = [&](int node) { return c.model.node_body[static_cast<std::size_t>(node)] == c.index; };
  const auto any = [](const auto& all, const auto& is) { return std::any_of(all.begin(), all.end(), is); };
  if (any(c.model.supports, [&](const Support& one) { return on_body(one.node); }) ||
      any(c.model.loads, [&](const Load& one) { return on_body(one.node); }) ||
      any(c.parameters.pulls, [&](const Pull& one) { return on_body(one.node); }))
    return true;
  for (std::size_t k = 0; k < c.model.anchors.size(); ++k)
    if ((c.model.anchors[k].body == c.index || c.model.anchors[k].other.body == c.index) &&
        (c.parameters.anchors.empty() || c.parameters.anchors[k]))
      return true;
  return false;
}

bool has_no_base(Candidate& c) {
  if (c.body.support_polygon.empty()) return true;
  c.width = c.base_point(c.body.base_points.front()).width;
  return std::any_of(c.body.base_points.begin(), c.body.base_points.end(),
                     [&](int p) { return std::abs(c.base_point(p).width - c.width) > k_same_place; });
}

bool has_other_law(Candidate& c) {
  return !traits(c.parameters.contact).has_restitution;
}

/// Calls f with every direction in which the body is shaken, moved or tilted.
template <class F>
void each_direction(const Candidate& c, F f) {
  for (const Shake& shake : c.parameters.shakes) {
    if (traits(shake.kind).has_record)
      for (const AccelerogramComponent& component : shake.record->components) f(component.direction);
    else
      f(shake.direction);
    f(shake.amplitude_before);
  }
  if (!c.motion) return;
  f(c.motion->velocity);
  for (const Vec3& turn : {c.motion->rotation, c.motion->angular_velocity}) f(turn.cross(Vec3::UnitZ()));
}

bool is_symmetric(const Candidate& c) {
  const Vec3 moment = c.body.inertia * c.found.across;
  if (moment.cross(c.found.across).norm() > k_level * moment.norm()) return false;
  const std::span<const ContactPoint> points = c.points();
  return std::all_of(points.begin(), points.end(), [&](const ContactPoint& one) {
    const Vec3 mirrored = c.place(one).cwiseProduct(Vec3(1, 1, -1));
    return std::any_of(points.begin(), points.end(), [&](const ContactPoint& other) {
      return (c.place(other) - mirrored).norm() <= k_same_place &&
             std::abs(one.width - other.width) <= k_same_place;
    });
  });
}

void look_along(Candidate& c, const Vec3& horizontal) {
  c.found.along = horizontal.normalized();
  c.found.across = Vec3::UnitZ().cross(c.found.along);
}

bool is_moved_across(const Candidate& c) {
  bool leaves = false;
  each_direction(c, [&](const Vec3& d) { leaves |= std::abs(d.dot(c.found.across)) > k_level * d.norm(); });
  return leaves;
}

bool leaves_a_plane(Candidate& c) {
  if (!c.motion) return is_moved_across(c);
  Vec3 greatest = Vec3::Zero();
  each_direction(c, [&](const Vec3& d) {
    const Vec3 horizontal(d.x(), d.y(), 0);
    if (horizontal.norm() > k_level * d.norm() && horizontal.norm() > greatest.norm()) greatest = horizontal;
  });
  for (const Vec3& turn : {c.motion->rotation, c.motion->angular_velocity})
    if (std::abs(turn.z()) > k_level * turn.norm()) return true;
  if (greatest.isZero(0)) {  // any plane about which it is symmetric
    const std::vector<Vec3>& corners = c.body.support_polygon;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 side = corners[(i + 1) % corners.size()] - corners[i];
      look_along(c, Vec3(side.y(), -side.x(), 0));
      if (is_symmetric(c)) return false;
    }
    return false;
  }
  look_along(c, greatest);
  return is_moved_across(c);
}

void set_block(Candidate& c) {
  PlanarCase& found = c.found;
  const Vec3& centre = c.body.centre_of_gravity;
  Block& block = found.block;
  block.mass = c.body.mass;
  block.inertia = found.across.dot(c.body.inertia * found.across);
  block.height = centre.z() - c.base_height();
  block.left = block.right = -k_never;
  for (const int p : c.body.base_points) {
    const double u = c.place(c.base_point(p)).x();
    block.left = std::max(block.left, -u), block.right = std::max(block.right, u);
  }
  const ContactLaw law = gripped(c.parameters.contact, c.body.grip);
  block.kinetic_friction = law.friction;
  block.static_friction = law.friction + law.excess();
  block.restitution = c.body.restitution;
  block.gravity = -c.parameters.gravity.z();
  const std::vector<BaseLine> base = base_lines(c.model, c.index, found.along);
  if (base.size() > 2)
    block.sprung = std::make_shared<SprungBase>(
        block, base, law, contact_length(c.base_point(c.body.base_points.front()), *c.floor));
  found.bounces = law.restitution > 0;
  found.floor = static_cast<int>(c.floor - c.model.planes.data());
  found.origin = {centre.x(), centre.y(), c.floor->point.z() + c.width / 2};
}

bool starts_elsewhere(Candidate& c) {
  set_block(c);
  if (!c.motion) return false;
  PlanarCase& found = c.found;
  const RigidMotion& from = *c.motion;
  const Vec3 centre = from.centre - found.origin;
  State& state = found.start;
  state.mode = Mode::flight;
  state.tilt = from.rotation.dot(found.across);
  state.rate = from.angular_velocity.dot(found.across);
  state.x = centre.dot(found.along), state.z = centre.z();
  state.x_velocity = from.velocity.dot(found.along), state.z_velocity = from.velocity.z();
  const bool upright = std::abs(state.tilt) < k_level;
  if (upright) state.tilt = 0;
  const Side side = (upright ? state.rate : state.tilt) < 0 ? Side::left : Side::right;
  const State rocks = referred(found.block, state, Mode::rock, side);
  if (std::abs(rocks.z) > k_same_place || std::abs(centre.dot(found.across)) > k_same_place) return true;
  if (std::abs(rocks.z_velocity) > k_at_rest) return false;  // lands, or takes off
  state = upright && state.rate == 0 ? referred(found.block, state, Mode::rest, side) : rocks;
  state.z = state.z_velocity = 0;
  if (std::abs(state.x_velocity) <= k_at_rest) state.x_velocity = 0;
  state = left_behind(state, 0);
  return false;
}

bool is_not_symmetric(Candidate& c) {
  return !is_symmetric(c);
}

bool ends_in_a_point(Candidate& c) {
  for (const double end : {-c.found.block.left, c.found.block.right})
    if (std::none_of(c.body.base_points.begin(), c.body.base_points.end(), [&](int p) {
          const Vec3 at = c.place(c.base_point(p));
          return std::abs(at.x() - end) <= k_same_place && std::abs(at.z()) > k_same_place;
        }))
      return true;
  return false;
}

/// Tilt at which a point meets the floor, by its place from the edge and how much it is thicker there:
/// R sin(angle - tilt) = lift.
double meeting_tilt(double ahead, double above, double lift) {
  const double R = elementary::hypot(ahead, above);
  return lift >= R ? 0 : elementary::atan2(above, ahead) - elementary::asin(lift / R);
}

bool meets_early(Candidate& c) {
  const Block& block = c.found.block;
  double& last = c.found.controls.last_tilt;
  for (const Side side : {Side::left, Side::right})
    for (const ContactPoint& point : c.points()) {
      const Vec3 at = c.place(point);
      const double above = at.y() + block.height, sign = side == Side::right ? 1 : -1;
      const double ahead = sign * (at.x() - block.edge(side));
      if (above > k_same_place)
        last = std::min(last, meeting_tilt(ahead, above, (point.width - c.width) / 2));
    }
  return last < std::max({k_last_tilt, c.found.critical(Side::left), c.found.critical(Side::right)});
}

/// Least |x| at which the body may come within reach of something else, from its horizontal and vertical
/// extent about the centre of gravity. Other bodies may come as far towards it.
double reachable(const Candidate& c, double rise) {
  const PlanarCase& found = c.found;
  double least = k_never;
  for (const Plane& plane : c.model.planes) {
    if (&plane == c.floor) continue;
    const double apart = plane.normal.dot(c.body.centre_of_gravity - plane.point) - c.body.reach -
                         std::abs(plane.normal.z()) * rise - c.width;
    const double slope = std::abs(plane.normal.dot(found.along));
    least = std::min(least, apart <= 0 ? 0 : slope > 0 ? apart / slope : k_never);
  }
  for (std::size_t b = 0; b < c.model.bodies.size(); ++b) {
    if (static_cast<int>(b) == c.index) continue;
    const double apart = (c.centres[b] - c.body.centre_of_gravity).head<2>().norm();
    least = std::min(least, (apart - c.body.reach - c.model.bodies[b].reach - 2 * c.width) / 2);
  }
  return least;
}

bool has_neighbours(Candidate& c) {
  const Block& block = c.found.block;
  const double edge = std::max(block.left, block.right), R = elementary::hypot(edge, block.height);
  c.found.farthest = k_never;
  if (c.centres.empty()) return false;
  c.found.farthest = reachable(c, R);
  return c.found.farthest < std::abs(c.found.start.x) + edge + R;
}

bool jumps_upright(Candidate& c) {
  return std::any_of(c.parameters.shakes.begin(), c.parameters.shakes.end(), [](const Shake& shake) {
    return shake.initial_velocity == Shake::Start::jump && shake.direction.z() != 0;
  });
}

struct Row : ObstacleTraits {
  bool (*is_there)(Candidate&);
};
constexpr Row k_obstacles[] = {
    {{Obstacle::floor, "floor", "it stands on no level plane under straight gravity"}, has_no_floor},
    {{Obstacle::held, "held", "supports, loads, pulls or anchors act on it"}, is_held},
    {{Obstacle::base, "base", "it has no flat base of one contact width"}, has_no_base},
    {{Obstacle::law, "law", "its contact law has no rigid limit"}, has_other_law},
    {{Obstacle::direction, "direction", "it moves out of one vertical plane"}, leaves_a_plane},
    {{Obstacle::stands, "stands", "it does not begin on the floor"}, starts_elsewhere},
    {{Obstacle::symmetry, "symmetry", "it is not symmetric about the plane of its motion"}, is_not_symmetric},
    {{Obstacle::edge, "edge", "its base ends in a point"}, ends_in_a_point},
    {{Obstacle::early, "early", "another of its contact points meets the floor before it overturns"},
     meets_early},
    {{Obstacle::near, "near", "a wall or body is within its fall"}, has_neighbours},
    {{Obstacle::jump, "jump", "the floor's velocity jumps upward or downward"}, jumps_upright},
    {{Obstacle::none, "none", ""}, nullptr},
};

std::optional<PlanarCase> looked_at(Candidate& candidate, Obstacle* obstacle) {
  const auto found = std::find_if(std::begin(k_obstacles), std::end(k_obstacles),
                                  [&](const Row& row) { return !row.is_there || row.is_there(candidate); });
  if (obstacle) *obstacle = found->kind;
  return found->is_there ? std::nullopt : std::optional(candidate.found);
}

}  // namespace

const ObstacleTraits& traits(Obstacle obstacle) {
  return row_of(k_obstacles, obstacle);
}

std::vector<BaseLine> base_lines(const Model& model, int index, const Vec3& along) {
  const Body& body = model.bodies[static_cast<std::size_t>(index)];
  std::vector<BaseLine> lines;
  for (const int p : body.base_points) {
    const int node = model.contact_points[static_cast<std::size_t>(p)].node;
    const double place =
        (model.node_position[static_cast<std::size_t>(node)] - body.centre_of_gravity).dot(along);
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const BaseLine& line) {
      return std::abs(line.place - place) <= k_same_place;
    });
    if (same == lines.end())
      lines.push_back({place, {p}});
    else
      same->points.push_back(p);
  }
  std::sort(lines.begin(), lines.end(),
            [](const BaseLine& a, const BaseLine& b) { return a.place < b.place; });
  return lines;
}

double PlanarCase::critical(Side side) const {
  return elementary::atan2(side == Side::right ? block.right : block.left, block.height);
}

std::optional<PlanarCase> planar_case(const Model& model, const Parameters& parameters,
                                      std::span<const BodyStart> starts, int body, Obstacle* obstacle) {
  std::vector<Vec3> centres;
  for (std::size_t b = 0; b < starts.size(); ++b)
    centres.push_back(starts[b].pivot + exp_quaternion(starts[b].rotation) *
                                            (model.bodies[b].centre_of_gravity - starts[b].pivot));
  const auto own = static_cast<std::size_t>(body);
  const BodyStart& start = starts[own];
  return planar_case(model, parameters,
                     {centres[own], start.rotation, start.velocity, start.angular_velocity}, centres, body,
                     obstacle);
}

std::optional<PlanarCase> planar_case(const Model& model, const Parameters& parameters,
                                      const RigidMotion& motion, std::span<const Vec3> centres, int body,
                                      Obstacle* obstacle) {
  Candidate candidate{model,   parameters, &motion,
                      centres, body,       model.bodies[static_cast<std::size_t>(body)]};
  return looked_at(candidate, obstacle);
}

std::optional<PlanarCase> planar_case_along(const Model& model, const Parameters& parameters,
                                            const Vec3& along, int body, Obstacle* obstacle) {
  Candidate candidate{model, parameters, nullptr, {}, body, model.bodies[static_cast<std::size_t>(body)]};
  look_along(candidate, along);
  return looked_at(candidate, obstacle);
}

PlanarCase block_along(const Model& model, const Parameters& parameters, const Vec3& along, int body) {
  Candidate candidate{model, parameters, nullptr, {}, body, model.bodies[static_cast<std::size_t>(body)]};
  look_along(candidate, along);
  has_no_floor(candidate);
  has_no_base(candidate);
  set_block(candidate);
  return candidate.found;
}

Pose pose(const PlanarCase& of, const State& state, const Turned& known) {
  const Motion centre = centre_of_gravity(of.block, state, known);
  return {of.origin + of.along * centre.x + Vec3(0, 0, centre.z), exp_quaternion(state.tilt * of.across)};
}

}  // namespace topple::planar
