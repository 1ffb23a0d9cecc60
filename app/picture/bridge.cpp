#include "app/picture/bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/picture/anchor_picture.h"
#include "app/picture/annotations.h"
#include "app/picture/row.h"
#include "app/picture/ways_in_words.h"
#include "app/picture/window_words.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "solver/math/bits.h"
#include "solver/math/ranges.h"

namespace topple::app {
namespace {

constexpr double k_floor_margin = 2.2;  // m, floor beyond where bodies go
constexpr double k_wall_margin = 0.6;   // m, wall beyond the bodies beside it
constexpr double k_wall_reach = 0.8;    // m, bodies nearer than this stand beside a wall
constexpr double k_wall_height = 2.4;   // m, least
constexpr double k_at_wall = 1e-6;      // m, a door's from its wall's face
constexpr double k_tear = 0.6;          // depth of the teeth of a broken end, of the section
constexpr double k_least_range = 1e-3;  // of a colour scale, in its unit

render::Station station(const Vec3& x, const Quat& q) {
  return {to_float(x),
          {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
           static_cast<float>(q.z())},
          0};
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

// Corners of the base of a block, or of its top (block.h).
const std::array<int, 4>& face(const Model& model, int block, bool top) {
  return model
      .panels[static_cast<std::size_t>(model.bodies[static_cast<std::size_t>(block)].first_panel + top)]
      .node;
}

// Of a block, from above: its surface.
render::Profile outline(const Model& model, int block) {
  const std::array<int, 4>& base = face(model, block, false);
  const auto side = [&](int from, int to) {
    return static_cast<float>((model.node_position[base[to]] - model.node_position[base[from]]).norm() +
                              model.panels[model.bodies[block].first_panel].width) /
           2;
  };
  const float y = side(0, 1), z = side(0, 3);
  return {.outline = {{-y, -z}, {y, -z}, {y, z}, {-y, z}}};
}

}  // namespace

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
  mix(a.member_contact, b.member_contact, out.member_contact);
  mix(a.panel_contact, b.panel_contact, out.panel_contact);
  mix(a.energy, b.energy, out.energy);
  for (std::size_t i = 0; i < a.body.size(); ++i) {
    const auto x = bits_as<io::BodyArray>(a.body[i]), y = bits_as<io::BodyArray>(b.body[i]);
    io::BodyArray between;
    mix(x, y, between);
    out.body[i] = bits_as<io::BodyNumbers>(between);
    const Quat q = a.body[i].rotation().slerp(u, b.body[i].rotation());
    out.body[i].qw = q.w(), out.body[i].qx = q.x(), out.body[i].qy = q.y(), out.body[i].qz = q.z();
  }
  mix(a.floor_acceleration, b.floor_acceleration, out.floor_acceleration);
  mix(a.floor_displacement, b.floor_displacement, out.floor_displacement);
  out.load_factor = (1 - u) * a.load_factor + u * b.load_factor;
  for (int i = 0; 4 * static_cast<std::size_t>(i) < a.rotation.size(); ++i) {
    const Quat q = rotation(a, i).slerp(u, rotation(b, i));
    const double parts[4] = {q.w(), q.x(), q.y(), q.z()};
    for (int k = 0; k < 4; ++k) out.rotation[4 * i + k] = static_cast<float>(parts[k]);
  }
  return out;
}

Bridge::Bridge(const io::Scene& scene, const RunExtent& extent, bool tells_ways)
    : scene_(scene), extent_(extent), tells_ways_(tells_ways) {
  const Model& model = scene.setup.model;
  for (const Section& section : model.sections) profiles_.push_back(profile(section));
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    of_block_.push_back(static_cast<std::uint32_t>(profiles_.size()));
    if (model.bodies[b].solid) profiles_.push_back(outline(model, b));
  }
  std::vector<int> members_at(model.node_position.size(), 0);
  for (const Member& member : model.members) {
    if (model.sections[member.section].shape == Section::Shape::custom) continue;
    ++members_at[model.elements[member.first_element].node[0]];
    ++members_at[model.elements[member.first_element + member.element_count - 1].node[1]];
  }
  for (int count : members_at) joint_.push_back(count > 1);
}

render::SceneFrame Bridge::frame(const io::FrameRow& row, const Parameters& parameters,
                                 const PictureSettings& settings, bool changed) const {
  const Model& model = scene_.setup.model;
  render::SceneFrame out;
  out.profiles = profiles_;
  const double skin = 0.05 + (settings.exaggeration - 1) * extent_.top(BeamQuantity::displacement);
  out.bounds_min = to_float(extent_.low - Vec3::Constant(skin));
  out.bounds_max = to_float(extent_.high + Vec3::Constant(skin));
  if (!is_finite(row)) {
    out.caption.title = title_in_words(scene_, parameters, changed);
    out.caption.lines.push_back(say(window_words::k_not_finite));
    add_grounds(Vec3::Zero(), out);
    return out;
  }
  const Vec3 shift = floor_shift(row);
  const RigidFit fit = rigid_fit(model, row);
  io::FrameRow drawn = row;
  exaggerate(model, fit, settings.exaggeration, drawn);
  add_tubes(drawn, colours(row, fit, settings.colour), out.stations, out.tubes);
  if (settings.colour == BeamQuantity::yield_ratio)  // what cannot yield has none
    for (render::Tube& tube : out.tubes)
      if (!std::isfinite(model.elements[model.members[tube.member].first_element].capacity[0]))
        tube.colour = k_rigid_colour;
  add_hinges(model, drawn, out);
  add_doors(scene_.setup.room, shift, out);
  add_anchors(model, drawn, shift, out);
  out.legend = legend(row, settings);
  if (settings.panels)
    for (const topple::Panel& sheet : model.panels) {
      if (model.bodies[sheet.body].solid) continue;
      render::Panel panel;
      panel.body = static_cast<std::uint32_t>(sheet.body);
      for (int k = 0; k < 4; ++k) panel.corners[k] = to_float(position(drawn, sheet.node[k]) + shift);
      out.panels.push_back(panel);
    }
  if (settings.contact_forces) {
    const double newtons = newtons_per_decimetre(extent_, settings.alone ? greatest_contact_force(row) : 0);
    add_contact_forces(model, drawn, newtons, out);
    out.legend.notes.push_back(say(window_words::k_arrow_scale, newtons));
  }
  add_pulls(model, parameters, drawn, out);
  if (settings.trails != Trails::none)
    add_trails(model, extent_, row, settings.trails == Trails::run || is_static(scene_.setup), out);
  if (settings.diagram) add_diagram(model, drawn, *settings.diagram, out);
  add_grounds(shift, out);
  add_captions(row, parameters, settings, changed, out);
  if (!settings.words) {
    out.legend = {};
    out.trace = {};
    out.caption = {};
    out.labels.clear();
  }
  return out;
}

void Bridge::add_ghost(const io::FrameRow& row, const io::FrameRow& beside, const PictureSettings& settings,
                       render::SceneFrame& out) const {
  if (!is_finite(row)) return;
  io::FrameRow drawn = row;
  ranges::copy(beside.floor_displacement, drawn.floor_displacement);
  exaggerate(scene_.setup.model, rigid_fit(scene_.setup.model, row), settings.exaggeration, drawn);
  add_tubes(
      drawn, [](std::size_t, double) { return 0.f; }, out.ghost_stations, out.ghost_tubes);
  if (!settings.words) return;
  out.caption.lines.push_back(say(window_words::k_ghost_is, row.branch));
  ++out.caption.most_lines;
}

Bridge::ColourAt Bridge::colours(const io::FrameRow& row, const RigidFit& fit, BeamQuantity quantity) const {
  const Model& model = scene_.setup.model;
  const double unit = traits(quantity).per_unit;
  if (const auto value = traits(quantity).value)
    return [&model, &row, value, unit](std::size_t e, double t) {
      return static_cast<float>(value(model, e, forces_at(model, row, e, 2 * t - 1)) / unit);
    };
  return [&model, &row, &fit, unit](std::size_t e, double t) {
    const int* const node = model.elements[e].node;
    const Vec3 reference = (1 - t) * model.node_position[node[0]] + t * model.node_position[node[1]];
    const Vec3 rigid = fit.of(node[t < 0.5 ? 0 : 1]) * reference;
    const Vec3 now = row.hinge[e] == k_broken
                         ? Vec3(rigid + displacement(model, row, fit, node[t < 0.5 ? 0 : 1]))
                         : Vec3(element_curve(model, row, e).place(t) - floor_shift(row));
    return static_cast<float>((now - rigid).norm() / unit);
  };
}

double Bridge::colour_maximum(const io::FrameRow& row, const PictureSettings& settings) const {
  if (settings.range == RangePolicy::fixed) return settings.maximum;
  const double top = settings.range == RangePolicy::run
                         ? extent_.top(settings.colour)
                         : peaks_of(scene_.setup.model, row)[place_of(settings.colour)];
  if (!(top > 0)) return 1;
  return std::max(top / traits(settings.colour).per_unit, k_least_range);
}

// None where all furniture is rigid.
render::Legend Bridge::legend(const io::FrameRow& row, const PictureSettings& settings) const {
  const int furniture = scene_.setup.model.furniture_total();
  int rigid = 0;
  for (int b = 0; b < furniture; ++b) rigid += !io::has_stresses(row, b);
  if (furniture > 0 && rigid == furniture) return {};
  const BeamQuantityTraits& name = traits(settings.colour);
  render::Legend out;
  out.quantity = say(name.name);
  out.unit = name.unit;
  out.range_policy = say(settings.range == RangePolicy::run     ? window_words::k_covers_run
                         : settings.range == RangePolicy::fixed ? window_words::k_range_fixed
                                                                : window_words::k_range_instant);
  out.maximum = static_cast<float>(colour_maximum(row, settings));
  out.minimum = name.is_signed ? -out.maximum : 0;
  out.is_signed = name.is_signed;
  out.square_root = !name.is_signed;
  const std::optional<double> yield = least_yield(scene_.setup.model);
  if (name.at_yield && yield) {
    out.mark = static_cast<float>(name.at_yield(*yield) / name.per_unit);
    out.mark_label = *name.unit ? say(window_words::k_yield_at, out.mark) : say(window_words::k_yield);
  } else if (name.at_yield && !*name.unit) {
    out.mark = 1;
    out.notes.push_back(say(window_words::k_cannot_yield));
  }
  if (settings.exaggeration != 1) out.notes.push_back(say(window_words::k_deformed, settings.exaggeration));
  if (rigid > 0) out.notes.push_back(say(window_words::k_some_rigid));
  const auto cannot_yield = [](const Element& element) { return !std::isfinite(element.capacity[0]); };
  if (name.at_yield && !*name.unit && yield && ranges::any_of(scene_.setup.model.elements, cannot_yield))
    out.notes.push_back(say(window_words::k_some_cannot_yield));
  return out;
}

// A broken element is two stumps, each as its node stands.
void Bridge::add_tubes(const io::FrameRow& row, const ColourAt& colour,
                       std::vector<render::Station>& stations, std::vector<render::Tube>& tubes) const {
  const Model& model = scene_.setup.model;
  for (std::size_t m = 0; m < model.members.size(); ++m) {
    const Member& member = model.members[m];
    if (const Body& body = model.bodies[member.body]; body.solid) {
      if (static_cast<int>(m) == body.first_member) add_block(row, member.body, stations, tubes);
      continue;
    }
    const Section& section = model.sections[member.section];
    const float tear = static_cast<float>(k_tear * std::min(section.size_y, section.size_z));
    render::Tube tube;
    tube.profile = static_cast<std::uint32_t>(member.section);
    tube.member = static_cast<std::uint32_t>(m);
    tube.body = static_cast<std::uint32_t>(member.body);
    if (model.bodies[member.body].ground)
      tube.colour = k_ground_colour;
    else if (!io::has_stresses(row, member.body))
      tube.colour = k_rigid_colour;
    const auto begin = [&](float lead, float torn) {
      tube.first_station = static_cast<std::uint32_t>(stations.size());
      tube.lead = lead;
      tube.torn_first = torn;
    };
    const auto end = [&](float trail, float torn) {
      tube.station_count = static_cast<std::uint32_t>(stations.size()) - tube.first_station;
      tube.trail = trail;
      tube.torn_last = torn;
      tubes.push_back(tube);
    };
    const std::size_t first = member.first_element;
    const std::size_t last = first + member.element_count - 1;
    begin(closing(member, model.elements[first].node[0]), 0);
    if (!io::has_stresses(row, member.body)) {  // straight
      const ElementCurve here = element_curve(model, row, first), there = element_curve(model, row, last);
      stations.push_back(station(here.place(0), here.axes(0)));
      stations.push_back(station(there.place(1), there.axes(1)));
      end(closing(member, model.elements[last].node[1]), 0);
      continue;
    }
    for (std::size_t e = first; e <= last; ++e) {
      const bool broken = row.hinge[e] == k_broken;
      const ElementCurve curve = element_curve(model, row, e);
      for (int i = e == first ? 0 : 1; i < k_stations; ++i) {
        const double t = static_cast<double>(i) / (k_stations - 1);
        if (broken && i == k_stations / 2) {
          end(0, tear);
          begin(0, tear);
        }
        if (!broken)
          stations.push_back(station(curve.place(t), curve.axes(t)));
        else if (t < 0.5)
          stations.push_back(station(curve.x1 + t * curve.length * (curve.q1 * Vec3::UnitX()), curve.q1));
        else
          stations.push_back(
              station(curve.x2 - (1 - t) * curve.length * (curve.q2 * Vec3::UnitX()), curve.q2));
        stations.back().value = colour(e, t);
      }
    }
    end(closing(member, model.elements[last].node[1]), 0);
  }
}

/// One tube from its base to its top, in place of its edges.
void Bridge::add_block(const io::FrameRow& row, int body, std::vector<render::Station>& stations,
                       std::vector<render::Tube>& tubes) const {
  const Model& model = scene_.setup.model;
  const std::array<int, 4>&base = face(model, body, false), &top = face(model, body, true);
  const auto middle = [&](const std::array<int, 4>& corners) -> Vec3 {
    return (position(row, corners[0]) + position(row, corners[2])) / 2 + floor_shift(row);
  };
  const Vec3 from = middle(base), to = middle(top);
  Mat3 axes;
  axes.col(0) = (to - from).normalized();
  axes.col(1) = (position(row, base[1]) - position(row, base[0])).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const float skin = static_cast<float>(model.panels[model.bodies[body].first_panel].width / 2);
  render::Tube tube;
  tube.first_station = static_cast<std::uint32_t>(stations.size());
  tube.station_count = 2;
  tube.profile = of_block_[body];
  tube.member = static_cast<std::uint32_t>(model.bodies[body].first_member);
  tube.body = static_cast<std::uint32_t>(body);
  tube.lead = tube.trail = skin;
  tube.colour = k_rigid_colour;
  for (const Vec3& place : {from, to}) stations.push_back(station(place, Quat(axes)));
  tubes.push_back(tube);
}

/// How far the section is drawn on at a node where several members meet, m.
float Bridge::closing(const Member& member, int node) const {
  const Section& section = scene_.setup.model.sections[static_cast<std::size_t>(member.section)];
  if (section.shape == Section::Shape::custom || !joint_[static_cast<std::size_t>(node)]) return 0;
  return static_cast<float>(std::min(section.size_y, section.size_z) / 2);
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
      const Room& room = scene_.setup.room;
      for (const Room::Door& door : room.doors)
        for (const int end : {0, 1}) {
          const Vec2 jamb = room.jamb(door, end);
          const Vec3 at(jamb.x(), jamb.y(), 0);
          if (std::abs(plane.normal.dot(at - plane.point)) > k_at_wall) continue;
          near_low = near_low.cwiseMin(at);
          near_high = near_high.cwiseMax(at);
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
                          const PictureSettings& settings, bool changed, render::SceneFrame& out) const {
  const Setup& setup = scene_.setup;
  out.caption.title = title_in_words(scene_, parameters, changed);
  out.caption.lines.push_back(instant_in_words(setup, row));
  if (!parameters.shakes.empty()) {
    const Shake& shake = parameters.shakes.front();
    const auto whole = [](double value) { return std::round(value) + 0.; };  // no -0
    const double a = Vec3(row.floor_acceleration).dot(shake.direction) / k_gal;
    const double d = Vec3(row.floor_displacement).dot(shake.direction);
    out.caption.lines.push_back(
        say(window_words::k_now, shake_in_words(parameters, row.time), whole(a), whole(1e3 * d)));
    const bool along_one = ranges::all_of(parameters.shakes, [&](const Shake& other) {
      return other.direction.cross(shake.direction).norm() < 1e-6;
    });
    out.trace = {.label = say(along_one ? window_words::k_floor_trace : window_words::k_first_shake_trace),
                 .at = extent_.time_s,
                 .value = extent_.acceleration_gal,
                 .cursor = static_cast<float>(row.time)};
  }
  if (is_static(setup)) {
    const float steps = static_cast<float>(setup.run.statics.load_steps);
    out.trace = {.label = say(window_words::k_load_factor),
                 .unit = say(window_words::k_load_steps),
                 .whole = true,
                 .at = extent_.way,
                 .value = extent_.load_factor,
                 .cursor = steps * static_cast<float>(row.time)};
    for (float& at : out.trace.at) at *= steps;
  }
  for (const std::string& line : bodies_in_words(setup.model, parameters.gravity, row))
    out.caption.lines.push_back(line);
  std::size_t most_harms = 0;
  if (tells_ways_ && settings.words) {
    const std::vector<std::string> harms = ways_in_words(setup, row, extent_.hits).harms;
    const auto shown = static_cast<std::ptrdiff_t>(std::min(harms.size(), k_most_harms));
    out.caption.lines.insert(out.caption.lines.end(), harms.begin(), harms.begin() + shown);
    most_harms = setup.room.places.size();
    for (const PlaceOutcome& place : extent_.hits) most_harms += place.hits.size();
    most_harms = std::min(most_harms, k_most_harms);
  }
  for (const std::string& line : anchors_in_words(setup.model, row)) out.caption.lines.push_back(line);
  if (out.legend.quantity.empty()) out.caption.lines.push_back(say(window_words::k_all_rigid));
  out.caption.most_lines = 2 + most_lines_of_bodies(setup.model) + static_cast<int>(most_harms) +
                           static_cast<int>(anchors_in_words(setup.model, row).size()) +
                           out.legend.quantity.empty();
  std::string contact;
  if (!setup.model.planes.empty())
    contact = say(window_words::k_note_contact, parameters.contact.alpha / k_standard_gravity,
                  parameters.contact.q, parameters.contact.friction);
  out.caption.note = say(window_words::k_note, TOPPLE_VERSION, scene_.name, contact, settings.exaggeration);
}

}  // namespace topple::app
