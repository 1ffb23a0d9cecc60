#include "app/bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/anchor_picture.h"
#include "app/words.h"

namespace topple::app {
namespace {

constexpr int k_stations = 6;           // per element: bends of an element look smooth at any size on screen
constexpr double k_floor_margin = 2.2;  // m, floor beyond where bodies go
constexpr double k_wall_margin = 0.6;   // m, wall beyond the bodies beside it
constexpr double k_wall_reach = 0.8;    // m, bodies nearer than this stand beside a wall
constexpr double k_wall_height = 2.4;   // m, least
constexpr double k_mega = 1e-6;
constexpr std::uint8_t k_broken = 3;      // FrameRow::hinge
constexpr double k_ring = 1.3;            // radius of a hinge's ring, of the section
constexpr double k_least_section = 0.02;  // m, of a section without sides
constexpr render::Float4 k_flowed_colour = {0.93f, 0.70f, 0.55f, 1};
constexpr render::Float4 k_ground_colour = {0.80f, 0.79f, 0.76f, 1};
constexpr render::Float4 k_hinge_colour = {0.90f, 0.33f, 0.04f, 1};
constexpr double k_colour_share = 0.95;  // of the instants lie within the colour scale

render::Float3 to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Vec3 position(const io::FrameRow& row, int node) {
  return {row.position[3 * node], row.position[3 * node + 1], row.position[3 * node + 2]};
}

Quat rotation(const io::FrameRow& row, int node) {
  const float* q = &row.rotation[4 * node];
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

Vec3 floor_shift(const io::FrameRow& row) {
  return Vec3(row.floor_displacement);
}

render::Station station(const Vec3& x, const Quat& q) {
  return {to_float(x),
          {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
           static_cast<float>(q.z())},
          0};
}

void expect_same_model(const Model& model, const io::FrameRow& row) {
  const std::size_t nodes = model.node_position.size(), elements = model.elements.size();
  if (row.position.size() != 3 * nodes || row.rotation.size() != 4 * nodes || row.s.size() != elements ||
      row.section_force.size() != 6 * elements || row.hinge.size() != elements ||
      row.body.size() != 11 * model.bodies.size() || row.anchor.size() != 4 * model.anchors.size())
    throw io::InputError(io::k_another_model);
}

render::Profile profile(const Section& section) {
  render::Profile out;
  const float y = static_cast<float>(section.size_y / 2), z = static_cast<float>(section.size_z / 2);
  if (section.shape == Section::Shape::pipe) {
    constexpr int k_sides = 24;
    out.smooth = true;
    for (int i = 0; i < k_sides; ++i) {
      const double angle = 2 * k_pi * i / k_sides;
      out.outline.push_back(
          {y * static_cast<float>(std::cos(angle)), y * static_cast<float>(std::sin(angle))});
    }
  } else {
    out.outline = {{-y, -z}, {y, -z}, {y, z}, {-y, z}};
  }
  return out;
}

}  // namespace

/// An element between its nodes, in the picture's frame.
struct Curve {
  Vec3 x1, x2;
  Quat q1, q2;    ///< local axes at the nodes
  double length;  ///< m, reference

  render::Station at(double t) const {
    const double span = (x2 - x1).norm(), t2 = t * t, t3 = t2 * t;
    const Vec3 d1 = span * (q1 * Vec3::UnitX()), d2 = span * (q2 * Vec3::UnitX());
    return station(
        (2 * t3 - 3 * t2 + 1) * x1 + (t3 - 2 * t2 + t) * d1 + (3 * t2 - 2 * t3) * x2 + (t3 - t2) * d2,
        q1.slerp(t, q2));
  }
  /// The halves of a broken one.
  render::Station stump(double t) const {
    return t < 0.5 ? station(x1 + t * length * (q1 * Vec3::UnitX()), q1)
                   : station(x2 - (1 - t) * length * (q2 * Vec3::UnitX()), q2);
  }
};

SectionForces forces_at(const Model& model, const io::FrameRow& row, std::size_t e, double xi) {
  const float* f = &row.section_force[6 * e];
  return forces_along({{f[0], f[1], f[2]}, {f[3], f[4], f[5]}}, model.elements[e].length, row.s[e], xi);
}

void RunExtent::add(const Model& model, const Parameters& parameters, const io::FrameRow& row) {
  expect_same_model(model, row);
  const Vec3 shift = floor_shift(row);
  for (int i = 0; i < model.node_total(); ++i) {
    if (model.bodies[model.node_body[i]].ground) continue;
    low = low.cwiseMin(position(row, i) + shift);
    high = high.cwiseMax(position(row, i) + shift);
  }
  for (const Anchor& anchor : model.anchors) {
    low = low.cwiseMin(anchor.to + shift);
    high = high.cwiseMax(anchor.to + shift);
  }
  double peak = 0;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    for (double xi : {-1., 1.})
      peak = std::max(peak, equivalent_stress(model.sections[model.members[element.member].section],
                                              forces_at(model, row, e, xi)));
  }
  peak_stress_.push_back(peak);
  way.push_back(static_cast<float>(row.time));
  load_factor.push_back(static_cast<float>(row.load_factor));
  if (parameters.shakes.empty()) return;
  time_s.push_back(static_cast<float>(row.time));
  acceleration_gal.push_back(
      static_cast<float>(Vec3(row.floor_acceleration).dot(parameters.shakes.front().direction) / k_gal));
}

double RunExtent::colour_top() const {
  if (peak_stress_.empty()) return 0;
  std::vector<double> sorted = peak_stress_;
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(k_colour_share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

io::FrameRow blend(const io::FrameRow& a, const io::FrameRow& b, double time) {
  if (!(b.time > a.time)) return a;
  const double u = std::clamp((time - a.time) / (b.time - a.time), 0., 1.);
  io::FrameRow out = u < 0.5 ? a : b;  // what cannot lie between comes from the nearer row
  out.time = time;
  const auto mix = [u](const auto& x, const auto& y, auto& to) {
    for (std::size_t i = 0; i < std::size(x); ++i)
      to[i] = static_cast<std::remove_reference_t<decltype(to[i])>>((1 - u) * x[i] + u * y[i]);
  };
  mix(a.position, b.position, out.position);
  mix(a.section_force, b.section_force, out.section_force);
  mix(a.contact_depth, b.contact_depth, out.contact_depth);
  mix(a.contact_force, b.contact_force, out.contact_force);
  mix(a.energy, b.energy, out.energy);
  mix(a.body, b.body, out.body);
  mix(a.floor_acceleration, b.floor_acceleration, out.floor_acceleration);
  mix(a.floor_displacement, b.floor_displacement, out.floor_displacement);
  out.load_factor = (1 - u) * a.load_factor + u * b.load_factor;
  const auto turn = [u](const auto& x, const auto& y, auto& to, std::size_t at) {
    const Quat q =
        Quat(x[at], x[at + 1], x[at + 2], x[at + 3]).slerp(u, Quat(y[at], y[at + 1], y[at + 2], y[at + 3]));
    const double parts[4] = {q.w(), q.x(), q.y(), q.z()};
    for (std::size_t k = 0; k < 4; ++k)
      to[at + k] = static_cast<std::remove_reference_t<decltype(to[at])>>(parts[k]);
  };
  for (std::size_t i = 0; i + 3 < a.rotation.size(); i += 4) turn(a.rotation, b.rotation, out.rotation, i);
  for (std::size_t i = 0; i + 10 < a.body.size(); i += 11) turn(a.body, b.body, out.body, i + 3);
  return out;
}

Bridge::Bridge(const io::Scene& scene, const RunExtent& extent) : scene_(scene), extent_(extent) {
  const Model& model = scene.setup.model;
  for (const Section& section : model.sections) profiles_.push_back(profile(section));
  std::vector<int> members_at(model.node_position.size(), 0);
  for (const Member& member : model.members) {
    if (model.sections[member.section].shape == Section::Shape::custom) continue;
    ++members_at[model.elements[member.first_element].node[0]];
    ++members_at[model.elements[member.first_element + member.element_count - 1].node[1]];
  }
  for (int count : members_at) joint_.push_back(count > 1);
}

render::SceneFrame Bridge::frame(const io::FrameRow& row, const Parameters& parameters) const {
  render::SceneFrame out;
  out.profiles = profiles_;
  const Vec3 shift = floor_shift(row);
  add_tubes(row, out.stations, out.tubes);
  add_hinges(row, out);
  add_anchors(scene_.setup.model, row, shift, out);
  out.legend.quantity = "equivalent stress";
  out.legend.unit = "MPa";
  out.legend.range_policy = "covers 95 % of the run";
  out.legend.minimum = 0;
  out.legend.square_root = true;
  out.legend.maximum = static_cast<float>(std::max(extent_.colour_top() * k_mega, 1e-3));
  for (const Body& body : scene_.setup.model.bodies)
    for (const auto& corners : body.panels) {
      render::Panel panel;
      for (int k = 0; k < 4; ++k) panel.corners[k] = to_float(position(row, corners[k]) + shift);
      out.panels.push_back(panel);
    }
  add_grounds(shift, out);
  add_captions(row, parameters, out);
  const Vec3 skin = Vec3::Constant(0.05);
  out.bounds_min = to_float(extent_.low - skin);
  out.bounds_max = to_float(extent_.high + skin);
  return out;
}

void Bridge::add_ghost(const io::FrameRow& row, render::SceneFrame& out) const {
  add_tubes(row, out.ghost_stations, out.ghost_tubes);
}

// Between its nodes an element is a cubic in space with the nodes' directions at its ends, its section
// turning evenly. A broken one is two stumps, each as its node stands.
void Bridge::add_tubes(const io::FrameRow& row, std::vector<render::Station>& stations,
                       std::vector<render::Tube>& tubes) const {
  const Model& model = scene_.setup.model;
  for (std::size_t m = 0; m < model.members.size(); ++m) {
    const Member& member = model.members[m];
    render::Tube tube;
    tube.profile = static_cast<std::uint32_t>(member.section);
    tube.member = static_cast<std::uint32_t>(m);
    tube.body = static_cast<std::uint32_t>(member.body);
    if (model.bodies[static_cast<std::size_t>(member.body)].ground) tube.colour = k_ground_colour;
    const auto begin = [&](float lead) {
      tube.first_station = static_cast<std::uint32_t>(stations.size());
      tube.lead = lead;
    };
    const auto end = [&](float trail) {
      tube.station_count = static_cast<std::uint32_t>(stations.size()) - tube.first_station;
      tube.trail = trail;
      tubes.push_back(tube);
    };
    const std::size_t first = static_cast<std::size_t>(member.first_element);
    const std::size_t last = first + static_cast<std::size_t>(member.element_count) - 1;
    begin(closing(member, model.elements[first].node[0]));
    for (std::size_t e = first; e <= last; ++e) {
      const bool broken = row.hinge[e] == k_broken;
      const Curve curve = curve_of(row, e, floor_shift(row));
      for (int i = e == first ? 0 : 1; i < k_stations; ++i) {
        const double t = static_cast<double>(i) / (k_stations - 1);
        if (broken && i == k_stations / 2) {
          end(0);
          begin(0);
        }
        stations.push_back(broken ? curve.stump(t) : curve.at(t));
        stations.back().value = static_cast<float>(
            k_mega * equivalent_stress(model.sections[static_cast<std::size_t>(member.section)],
                                       forces_at(model, row, e, 2 * t - 1)));
      }
    }
    end(closing(member, model.elements[last].node[1]));
  }
}

/// How far the section is drawn on at a node where several members meet, m.
float Bridge::closing(const Member& member, int node) const {
  const Section& section = scene_.setup.model.sections[static_cast<std::size_t>(member.section)];
  if (section.shape == Section::Shape::custom || !joint_[static_cast<std::size_t>(node)]) return 0;
  return static_cast<float>(std::min(section.size_y, section.size_z) / 2);
}

Curve Bridge::curve_of(const io::FrameRow& row, std::size_t e, const Vec3& shift) const {
  const Element& element = scene_.setup.model.elements[e];
  const Quat triad(element.triad);
  return {.x1 = position(row, element.node[0]) + shift,
          .x2 = position(row, element.node[1]) + shift,
          .q1 = rotation(row, element.node[0]) * triad,
          .q2 = rotation(row, element.node[1]) * triad,
          .length = element.length};
}

// A hinge is a ring in the plane in which it bends; one that has come to rest is pale.
void Bridge::add_hinges(const io::FrameRow& row, render::SceneFrame& out) const {
  const Model& model = scene_.setup.model;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const std::uint8_t code = row.hinge[e];
    if (code == 0 || code == k_broken) continue;
    const bool flowed = code == io::k_flowed_first || code == io::k_flowed_second;
    const Section& section = model.sections[static_cast<std::size_t>(
        model.members[static_cast<std::size_t>(model.elements[e].member)].section)];
    const bool at_first = code == 1 || code == io::k_flowed_first;
    const Curve curve = curve_of(row, e, floor_shift(row));
    const SectionForces forces = forces_at(model, row, e, at_first ? -1 : 1);
    const Quat& turned = at_first ? curve.q1 : curve.q2;
    const double size = std::max({section.size_y, section.size_z, k_least_section});
    out.rings.push_back({to_float(at_first ? curve.x1 : curve.x2),
                         to_float(turned * Vec3(0, forces.moment.y(), forces.moment.z())),
                         static_cast<float>(k_ring * size), flowed ? k_flowed_colour : k_hinge_colour});
  }
}

void Bridge::add_grounds(const Vec3& shift, render::SceneFrame& out) const {
  const Model& model = scene_.setup.model;
  for (const Plane& plane : model.planes) {
    render::Ground ground;
    ground.normal = to_float(plane.normal);
    Vec3 low = extent_.low, high = extent_.high, along = Vec3::UnitX();
    ground.is_floor = std::abs(plane.normal.z()) > 0.7;
    if (ground.is_floor) {
      low -= Vec3::Constant(k_floor_margin);
      high += Vec3::Constant(k_floor_margin);
    } else {
      along = Vec3::UnitZ().cross(plane.normal).normalized();
      const auto beside = [&](const Body& body) {
        double nearest = 1e30;
        for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
          nearest = std::min(nearest, plane.normal.dot(model.node_position[i] - plane.point));
        return nearest < k_wall_reach;
      };
      Vec3 near_low = Vec3::Constant(1e30), near_high = -near_low;
      for (const Body& body : model.bodies) {
        if (!beside(body)) continue;
        for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
          near_low = near_low.cwiseMin(model.node_position[i]);
          near_high = near_high.cwiseMax(model.node_position[i]);
        }
      }
      if (near_low.x() < 1e29) low = near_low, high = near_high;
      low -= Vec3::Constant(k_wall_margin);
      high += Vec3::Constant(k_wall_margin);
      low.z() = 0;
      high.z() = std::max(high.z(), k_wall_height);
    }
    // the rectangle lies in the plane, around the middle of the box
    const Vec3 middle = (low + high) / 2, half = (high - low) / 2;
    const Vec3 across = plane.normal.cross(along);
    const Vec3 centre = middle - plane.normal * plane.normal.dot(middle - plane.point);
    ground.centre = to_float(centre + shift);
    ground.along = to_float(along);
    ground.half_length = static_cast<float>(along.cwiseAbs().dot(half));
    ground.half_width = static_cast<float>(across.cwiseAbs().dot(half));
    out.grounds.push_back(ground);
  }
}

void Bridge::add_captions(const io::FrameRow& row, const Parameters& parameters,
                          render::SceneFrame& out) const {
  const Setup& setup = scene_.setup;
  out.caption.title = scene_.title;
  out.caption.lines.push_back(instant_in_words(setup, row));
  if (!parameters.shakes.empty()) {
    const Shake& shake = parameters.shakes.front();
    const double a = Vec3(row.floor_acceleration).dot(shake.direction) / k_gal;
    const double d = Vec3(row.floor_displacement).dot(shake.direction);
    out.caption.lines.push_back(
        fmt::format("{};  now {:+.0f} gal, {:+.0f} mm", shake_in_words(parameters), a, 1e3 * d));
    out.trace = {.label = "floor acceleration, gal",
                 .at = extent_.time_s,
                 .value = extent_.acceleration_gal,
                 .cursor = static_cast<float>(row.time)};
  }
  if (is_static(setup)) {
    const float steps = static_cast<float>(setup.run.statics.load_steps);
    out.trace = {.label = "load factor",
                 .unit = "load steps",
                 .whole = true,
                 .at = extent_.way,
                 .value = extent_.load_factor,
                 .cursor = steps * static_cast<float>(row.time)};
    for (float& at : out.trace.at) at *= steps;
  }
  for (std::size_t b = 0; b < static_cast<std::size_t>(setup.model.furniture_total()); ++b)
    out.caption.lines.push_back(body_in_words(setup.model, row, b));
  for (const std::string& line : anchors_in_words(setup.model, row)) out.caption.lines.push_back(line);
  std::string contact;
  if (!setup.model.planes.empty())
    contact = fmt::format(" · contact α = {:g} kgf, q = {:g}, μ = {:g}",
                          parameters.contact.alpha / k_standard_gravity, parameters.contact.q,
                          parameters.contact.friction);
  out.caption.note =
      fmt::format("topple {} · scene {}{} · deformation ×1", TOPPLE_VERSION, scene_.name, contact);
}

}  // namespace topple::app
