#include "app/picture/annotations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/picture/body_colour.h"
#include "app/picture/row.h"
#include "solver/contact/proximity.h"
#include "solver/math/ranges.h"

namespace topple::app {
namespace {

constexpr render::Float4 k_flowed_colour = {0.93f, 0.70f, 0.55f, 1};
constexpr render::Float4 k_hinge_colour = {0.90f, 0.33f, 0.04f, 1};
constexpr double k_ring = 1.9;            // radius of a hinge's ring, of the section
constexpr double k_least_section = 0.02;  // m, of a section without sides

constexpr render::Float4 k_force_colour = {0.96f, 0.56f, 0.05f, 1};
constexpr render::Float4 k_pull_colour = {0.85f, 0.1f, 0.55f, 1};
constexpr double k_arrow = 1. / 3;       // of the height, an arrow of the usual top
constexpr double k_least_arrow = 0.004;  // m: shorter ones are not seen

constexpr double k_door = 2;             // m, drawn so high
constexpr double k_before_wall = 0.005;  // m
constexpr render::Float4 k_place_colour = {0.36f, 0.45f, 0.56f, 1};

constexpr double k_trail = 1;  // s
constexpr std::size_t k_trail_points = 240;
constexpr float k_least_strength = 0.15f;  // of what is oldest in a whole run

constexpr double k_nothing = 1e-5;         // of the greatest value: rounding
constexpr std::size_t k_my = 4, k_mz = 5;  // components
constexpr int k_samples = 12;              // of a diagram, per element
constexpr double k_diagram = 0.2;          // of the member's length, the height of its greatest value
constexpr double k_highest_diagram = 0.3;  // m
constexpr render::Float4 k_positive = {0.78f, 0.13f, 0.16f, 1}, k_negative = {0.16f, 0.33f, 0.75f, 1};

struct ComponentName {
  const char *name, *unit;
};
constexpr ComponentName k_component_names[k_components] = {{"N", "N"},   {"Vy", "N"},   {"Vz", "N"},
                                                           {"T", "N m"}, {"My", "N m"}, {"Mz", "N m"}};

/// In which of its own directions a member's diagram is drawn. The side that a moment stretches: +z for My,
/// -y for Mz.
Vec3 diagram_side(std::size_t component) {
  if (component == 1) return Vec3::UnitY();
  return component == 5 ? Vec3(-Vec3::UnitY()) : Vec3::UnitZ();
}

/// One place of a diagram.
struct Ordinate {
  Vec3 base, side;
  double value;

  Vec3 edge(double scale) const { return base + scale * value * side; }
};

std::vector<Ordinate> ordinates(const Model& model, const io::FrameRow& row, const Member& member,
                                std::size_t component) {
  std::vector<Ordinate> all;
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e) {
    const ElementCurve curve = element_curve(model, row, e);
    for (int i = 0; i <= k_samples; ++i) {
      const double t = static_cast<double>(i) / k_samples;
      all.push_back({curve.place(t), curve.axes(t) * diagram_side(component),
                     component_of(forces_at(model, row, e, 2 * t - 1), component)});
    }
  }
  return all;
}

std::string value_text(std::size_t component, double value) {
  return fmt::format("{} {:.3g} {}", component_name(component), value + 0., component_unit(component));
}

}  // namespace

const char* component_name(std::size_t component) {
  return k_component_names[component].name;
}

const char* component_unit(std::size_t component) {
  return k_component_names[component].unit;
}

double component_of(const SectionForces& forces, std::size_t component) {
  return component < 3 ? forces.normal[component] : forces.moment[component - 3];
}

void add_hinges(const Model& model, const io::FrameRow& row, render::SceneFrame& out) {
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const std::uint8_t code = row.hinge[e];
    if (code == 0 || code == k_broken) continue;
    const bool flows = io::flows_now(code);
    const Element& element = model.elements[e];
    const Section& section = model.sections[model.members[element.member].section];
    const double size = std::max({section.size_y, section.size_z, k_least_section});
    const ElementCurve curve = element_curve(model, row, e);
    for (int place = 0; place < 2; ++place) {
      if (!has_hinge(io::hinge_of(code), place)) continue;
      const double xi = element.hinge_place[place], t = (1 + xi) / 2;
      const SectionForces forces = forces_at(model, row, e, xi);
      const double sense = t == 1 ? -1 : 1;  // sections turn with the moment from the first end to the second
      out.rings.push_back(
          {to_float(curve.place(t)),
           to_float(curve.axes(t) * Vec3(0, sense * forces.moment.y(), sense * forces.moment.z())),
           static_cast<float>(k_ring * size), flows ? k_hinge_colour : k_flowed_colour, flows});
    }
  }
}

double newtons_per_decimetre(const RunExtent& extent, double force) {
  const double height = std::max(extent.high.z() - extent.low.z(), 0.1);
  const double wanted = 0.1 * std::max(extent.contact_force_top() / k_arrow, force) / height;
  if (!(wanted > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  for (const double factor : {1., 2., 5.})
    if (wanted <= factor * power) return factor * power;
  return 10 * power;
}

void add_contact_forces(const Model& model, const io::FrameRow& row, double newtons,
                        render::SceneFrame& out) {
  const auto add = [&](const Vec3& from, const float* force) {
    const Vec3 arrow = 0.1 / newtons * Vec3(force[0], force[1], force[2]);
    if (arrow.norm() < k_least_arrow) return;
    out.arrows.push_back({to_float(from), to_float(from + arrow), k_force_colour});
  };
  const std::size_t planes = model.planes.size();
  for (std::size_t c = 0; c < model.contact_points.size() * planes; ++c)
    add(position(row, model.contact_points[c / planes].node) + floor_shift(row), &row.contact_force[3 * c]);
  for (std::size_t e = 0; 4 * e < row.member_contact.size(); ++e) {
    if (model.bodies[model.members[model.elements[e].member].body].ground) continue;
    add(element_curve(model, row, e).place(row.member_contact[4 * e + 3]), &row.member_contact[4 * e]);
  }
  for (std::size_t k = 0; 5 * k < row.panel_contact.size(); ++k) {
    const float* const on = &row.panel_contact[5 * k];
    Vec3 at = floor_shift(row);
    const int part = static_cast<int>(model.elements.size() + k);
    each_share(model, part, on[3], on[4], [&](int node, double share) { at += share * position(row, node); });
    add(at, on);
  }
}

double hand_strength(const Model& model, int node) {
  return k_standard_gravity * model.bodies[model.node_body[node]].mass;
}

void add_pulls(const Model& model, const Parameters& parameters, const io::FrameRow& row,
               render::SceneFrame& out) {
  for (const Pull& pull : parameters.pulls) {
    const Vec3 force = pull_force(pull, row.time);
    const Vec3 arrow = k_hand_reach / hand_strength(model, pull.node) * force;
    if (arrow.norm() < k_least_arrow) continue;
    const Vec3 from = position(row, pull.node) + floor_shift(row), to = from + arrow;
    out.arrows.push_back({to_float(from), to_float(to), k_pull_colour});
    out.labels.push_back({to_float(to), say(window_words::k_newtons, force.norm())});
  }
}

void add_doors(const Room& room, const Vec3& shift, render::SceneFrame& out) {
  const auto above = [&](const Vec2& at, double z) { return to_float(Vec3(at.x(), at.y(), z) + shift); };
  for (const Room::Door& door : room.doors) {
    const Vec2 face = k_before_wall * room.walls[static_cast<std::size_t>(door.wall)].normal;
    const Vec2 a = room.jamb(door, 0) + face, b = room.jamb(door, 1) + face;
    out.panels.push_back({{above(a, 0), above(b, 0), above(b, k_door), above(a, k_door)}, render::k_no_body});
    out.labels.push_back({above((a + b) / 2, k_door), door.name});
  }
  for (const Room::Place& place : room.places) {
    const auto at = above(place.at, place.top);
    out.rings.push_back({at, {0, 0, 1}, static_cast<float>(room.person / 2), k_place_colour});
    out.labels.push_back({at, place.name});
  }
}

void add_trails(const Model& model, const RunExtent& extent, const io::FrameRow& row, bool whole_run,
                render::SceneFrame& out) {
  const std::vector<float>& times = extent.way;
  const auto now = static_cast<float>(row.time);
  const auto end =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), now) - times.begin());
  if (end == 0) return;
  const float oldest = whole_run ? times.front() : std::max(times.front(), now - static_cast<float>(k_trail));
  const auto begin =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), oldest) - times.begin());
  const std::size_t stride = (end - begin) / k_trail_points + 1;
  const auto strength = [&](float time) {
    const float age = (now - time) / std::max(now - oldest, 1e-6f);
    return whole_run ? std::max(1 - age, k_least_strength) : 1 - age;
  };
  for (std::size_t b = 0; b < static_cast<std::size_t>(model.furniture_total()); ++b)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& [red, green, blue] = body_colour(b);
      render::Trail trail{.points = {}, .strength = {}, .colour = {}};
      trail.colour = {static_cast<float>(red) / 255, static_cast<float>(green) / 255,
                      static_cast<float>(blue) / 255, 1};
      // From a whole number of strides on, so that points do not wander as the run goes on.
      for (std::size_t i = (begin + stride - 1) / stride * stride; i < end; i += stride) {
        trail.points.push_back(extent.points(i, b)[k]);
        trail.strength.push_back(strength(times[i]));
      }
      trail.points.push_back(body_points(model, row, b)[k]);
      trail.strength.push_back(1);
      if (trail.points.size() > 1) out.trails.push_back(trail);
    }
}

std::size_t component_of(const Model& model, const io::FrameRow& row, const Diagram& diagram) {
  if (diagram.component) return *diagram.component;
  const Member& member = model.members[diagram.member];
  double most[2] = {};
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
    for (const double xi : {-1., 1.})
      for (std::size_t k = 0; k < 2; ++k)
        most[k] = std::max(most[k], std::abs(component_of(forces_at(model, row, e, xi), k_my + k)));
  return most[1] > most[0] ? k_mz : k_my;
}

void add_diagram(const Model& model, const io::FrameRow& row, const Diagram& diagram,
                 render::SceneFrame& out) {
  const Member& member = model.members[diagram.member];
  if (!io::has_stresses(row, member.body)) return;
  const std::size_t component = component_of(model, row, diagram);
  double length = 0;
  for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
    length += model.elements[e].length;
  const std::vector<Ordinate> all = ordinates(model, row, member, component);
  const auto [least, most] = ranges::minmax_element(all, {}, &Ordinate::value);
  const double greatest = std::max(std::abs(least->value), std::abs(most->value));
  const double scale = greatest > 0 ? std::min(k_diagram * length, k_highest_diagram) / greatest : 0;
  const auto is_something = [&](const Ordinate& o) { return std::abs(o.value) > k_nothing * greatest; };
  const auto begin_band = [&](const Ordinate& from, bool positive) {
    out.bands.push_back(
        {{to_float(from.base)}, {to_float(from.edge(scale))}, positive ? k_positive : k_negative});
  };
  const auto add = [&](const Vec3& base, const Vec3& edge) {
    out.bands.back().base.push_back(to_float(base));
    out.bands.back().edge.push_back(to_float(edge));
  };
  bool positive =
      ranges::find_if(all, is_something) == all.end() || ranges::find_if(all, is_something)->value > 0;
  begin_band(all.front(), positive);
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Ordinate &a = all[i - 1], &b = all[i];
    if (is_something(b) && (b.value > 0) != positive) {
      const double u = a.value / (a.value - b.value);
      const Ordinate zero{a.base + u * (b.base - a.base), a.side, 0};
      add(zero.base, zero.base);
      positive = !positive;
      begin_band(zero, positive);
    }
    add(b.base, b.edge(scale));
  }
  // One that is the same all along is written once, in the middle.
  const auto label = [&](const Ordinate& at) {
    out.labels.push_back({to_float(at.edge(scale)), value_text(component, at.value)});
  };
  if (most->value - least->value <= 1e-3 * greatest) {
    label(all[all.size() / 2]);
    return;
  }
  label(*least);
  label(*most);
  for (const Ordinate* end : {&all.front(), &all.back()})
    if (end != &*least && end != &*most && is_something(*end)) label(*end);
}

}  // namespace topple::app
