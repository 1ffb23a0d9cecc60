#include "solver/model/body_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "solver/math/rotation.h"

namespace topple {
namespace {

Mat3 member_triad(const Vec3& from, const Vec3& to, Vec3 up) {
  const Vec3 x = (to - from).normalized();
  if (up.isZero()) up = std::abs(x.z()) > 0.999 ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 z = up - up.dot(x) * x;
  if (z.norm() < 1e-6 * up.norm()) throw BuildError("up", "up is parallel to the member");
  Mat3 triad;
  triad.col(0) = x;
  triad.col(2) = z.normalized();
  triad.col(1) = triad.col(2).cross(x);
  return triad;
}

Eigen::Vector4d capacity(const Section& section, const Material& material) {
  if (!(section.zy > 0 && section.zz > 0 && section.zt > 0))
    throw BuildError("section", "section \"" + section.name + "\" of yielding material \"" + material.name +
                                    "\" has no plastic moduli: give zy, zz and zt");
  return material.yield * Eigen::Vector4d(section.area, section.zt / std::sqrt(3.), section.zy, section.zz);
}

// Counter-clockwise hull of points in the horizontal plane (Andrew 1979); collinear points are left out.
std::vector<Vec3> convex_hull(std::vector<Vec3> points, double tolerance) {
  std::sort(points.begin(), points.end(),
            [](const Vec3& a, const Vec3& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Vec3> hull;
  const auto half = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= base + 2) {
        const Vec3 a = hull[hull.size() - 1] - hull[hull.size() - 2], b = *it - hull[hull.size() - 2];
        if (a.x() * b.y() - a.y() * b.x() > tolerance) break;
        hull.pop_back();
      }
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  return hull;
}

}  // namespace

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", 1e3 * metres);
  return text;
}

BodyBuilder::BodyBuilder(Model& model, const std::string& name)
    : model_(model), body_(static_cast<int>(model.bodies.size())) {
  Body new_body{};
  new_body.name = name;
  new_body.first_node = model.node_total();
  new_body.first_element = static_cast<int>(model.elements.size());
  new_body.first_member = static_cast<int>(model.members.size());
  new_body.first_contact_point = static_cast<int>(model.contact_points.size());
  new_body.first_panel = static_cast<int>(model.panels.size());
  model.bodies.push_back(new_body);
}

int BodyBuilder::node(const Vec3& position) {
  const auto cell = [](double x) { return std::llround(x / k_same_place); };
  const auto key = std::make_tuple(cell(position.x()), cell(position.y()), cell(position.z()));
  for (long long dx = -1; dx <= 1; ++dx)
    for (long long dy = -1; dy <= 1; ++dy)
      for (long long dz = -1; dz <= 1; ++dz) {
        const auto found =
            places_.find({std::get<0>(key) + dx, std::get<1>(key) + dy, std::get<2>(key) + dz});
        if (found != places_.end()) return found->second;
      }
  const int index = model_.node_total();
  places_[key] = index;
  model_.node_position.push_back(position);
  model_.node_mass.push_back(0);
  model_.node_inertia.push_back(Mat3::Zero());
  model_.node_body.push_back(body_);
  ++body().node_count;
  return index;
}

std::vector<int> BodyBuilder::line(const std::string& name, const Vec3& from, const Vec3& to, int members,
                                   int elements, int section, int material, const Vec3& up) {
  const Section& profile = model_.sections[section];
  const Material& stuff = model_.materials[material];
  const double shear = stuff.young / (2 * (1 + stuff.poisson));
  const int total = members * elements;
  Element element;
  element.length = (to - from).norm() / total;
  element.triad = member_triad(from, to, up);
  element.normal_stiffness = {stuff.young * profile.area, shear * profile.area * profile.ky,
                              shear * profile.area * profile.kz};
  element.bending_stiffness = {shear * profile.j, stuff.young * profile.iy, stuff.young * profile.iz};
  if (stuff.yield > 0) element.capacity = capacity(profile, stuff);
  if (!traits(model_.scheme).hinges_at_ends) element.hinge_place[0] = element.hinge_place[1] = 0;
  std::vector<int> nodes;
  for (int i = 0; i <= total; ++i)
    nodes.push_back(node(from + (to - from) * (static_cast<double>(i) / total)));
  for (int m = 0; m < members; ++m) {
    Member member;
    member.name = members == 1 ? name : name + "-" + std::to_string(m + 1);
    member.body = body_;
    member.first_element = static_cast<int>(model_.elements.size());
    member.element_count = elements;
    member.section = section;
    member.material = material;
    const int ends[2] = {nodes[m * elements], nodes[(m + 1) * elements]};
    for (int k = 0; k < 2; ++k) member.tip[k] = tips_.insert(ends[k]).second;
    for (int e = 0; e < elements; ++e) {
      const int i = m * elements + e;
      element.node[0] = nodes[i];
      element.node[1] = nodes[i + 1];
      element.member = static_cast<int>(model_.members.size());
      element.s = traits(model_.scheme).s[e % 2];
      model_.elements.push_back(element);
      ++body().element_count;
    }
    model_.members.push_back(member);
    ++body().member_count;
  }
  return nodes;
}

void BodyBuilder::add_material_mass() {
  for (int m = body().first_member; m < body().first_member + body().member_count; ++m) {
    const Member& member = model_.members[m];
    const Section& section = model_.sections[member.section];
    const double density = model_.materials[member.material].density;
    for (int e = member.first_element; e < member.first_element + member.element_count; ++e) {
      const Element& element = model_.elements[e];
      const bool first = (e - member.first_element) % 2 == 0;
      // Simpson's 1/6 : 2/3 : 1/6 over the pair: 1/3 and 2/3 of one element's own length
      const double share[2] = {first ? 1. / 3 : 2. / 3, first ? 2. / 3 : 1. / 3};
      const Mat3 rotary = density * element.length * element.triad *
                          Vec3(section.iy + section.iz, section.iy, section.iz).asDiagonal() *
                          element.triad.transpose();
      for (int k = 0; k < 2; ++k) {
        model_.node_mass[element.node[k]] += share[k] * density * section.area * element.length;
        model_.node_inertia[element.node[k]] += share[k] * rotary;
      }
    }
  }
}

void BodyBuilder::add_contact_point(int node, double width) {
  model_.contact_points.push_back({node, width});
  ++body().contact_point_count;
}

void BodyBuilder::add_panel(const std::array<int, 4>& nodes) {
  const auto x = [&](int k) -> const Vec3& { return model_.node_position[nodes[k % 4]]; };
  const Vec3 along = x(1) - x(0), cross = (x(2) - x(0)).cross(x(3) - x(1));
  const double size = std::max((x(2) - x(0)).norm(), (x(3) - x(1)).norm());
  const std::string which = "panel " + std::to_string(body().panel_count);
  for (int k = 0; k < 4; ++k)
    if (!((x(k + 1) - x(k)).cross(x(k + 2) - x(k + 1)).dot(cross) > 0))
      throw BuildError("panels", which + ": its corners are not those of a convex sheet, in order around it");
  const Vec3 normal = cross.normalized(), e1 = (along - along.dot(normal) * normal).normalized(),
             e2 = normal.cross(e1);
  if (const double off = std::abs(along.dot(normal)); off > k_flat * size)
    throw BuildError("panels", which + " is not flat: its diagonals pass each other " + millimetres(off) +
                                   " apart, more than " + millimetres(k_flat * size) +
                                   ", a thousandth of their length");
  Panel panel{body_, nodes, std::numeric_limits<double>::infinity(), {}, {}};
  const auto place = [&](const Vec3& p) { return Panel::Place(e1.dot(p - x(0)), e2.dot(p - x(0))); };
  for (int k = 0; k < 4; ++k) panel.corner[k] = place(x(k));
  const double near = k_flat * size;
  std::array<double, 4> covered{};
  for (int m = body().first_member; m < body().first_member + body().member_count; ++m) {
    const Member& member = model_.members[m];
    const int last = member.first_element + member.element_count - 1;
    const Vec3 ends[2] = {model_.node_position[model_.elements[member.first_element].node[0]],
                          model_.node_position[model_.elements[last].node[1]]};
    const auto beyond = [&](const Panel::Place& p, int k) {
      const Panel::Place side = panel.corner[(k + 1) % 4] - panel.corner[k], to = p - panel.corner[k];
      return (side.y() * to.x() - side.x() * to.y()) / side.norm();
    };
    bool within = true;
    std::array<bool, 4> on{true, true, true, true};
    for (const Vec3& end : ends) {
      within = within && std::abs(normal.dot(end - x(0))) <= near;
      for (int k = 0; k < 4; ++k) {
        const double out = beyond(place(end), k);
        within = within && out <= near;
        on[k] = on[k] && std::abs(out) <= near;
      }
    }
    if (!within) continue;
    panel.members.push_back({place(ends[0]), place(ends[1])});
    panel.width = std::min(panel.width, model_.sections[member.section].width);
    for (int k = 0; k < 4; ++k)
      if (on[k]) covered[k] += (ends[1] - ends[0]).norm();
  }
  for (int k = 0; k < 4; ++k)
    if (covered[k] < (1 - k_flat) * (x(k + 1) - x(k)).norm())
      throw BuildError("panels", which + ": no members lie all along its side between corners " +
                                     std::to_string(k) + " and " + std::to_string((k + 1) % 4));
  model_.panels.push_back(std::move(panel));
  ++body().panel_count;
}

void BodyBuilder::close() {
  Body& b = body();
  b.mass = 0;
  b.centre_of_gravity.setZero();
  for (int i = b.first_node; i < b.first_node + b.node_count; ++i) {
    b.mass += model_.node_mass[i];
    b.centre_of_gravity += model_.node_mass[i] * model_.node_position[i];
  }
  b.centre_of_gravity /= b.mass;
  b.inertia.setZero();
  for (int i = b.first_node; i < b.first_node + b.node_count; ++i) {
    const Mat3 arm = skew(model_.node_position[i] - b.centre_of_gravity);
    b.inertia += model_.node_inertia[i] - model_.node_mass[i] * arm * arm;
  }
  b.reach = b.width = 0;
  b.box.setEmpty();
  for (int i = b.first_node; i < b.first_node + b.node_count; ++i) {
    const Vec3 arm = model_.node_position[i] - b.centre_of_gravity;
    b.reach = std::max(b.reach, arm.norm());
    b.box.extend(arm);
  }
  for (int m = b.first_member; m < b.first_member + b.member_count; ++m)
    b.width = std::max(b.width, model_.sections[model_.members[m].section].width);
  b.base_centre = b.centre_of_gravity;
  if (b.contact_point_count == 0) return;

  double lowest = 1e300, highest = -1e300;
  for (int i = b.first_contact_point; i < b.first_contact_point + b.contact_point_count; ++i) {
    const double z = model_.node_position[model_.contact_points[i].node].z();
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  const double tolerance = 1e-6 * (highest - lowest) + k_same_place;
  std::vector<Vec3> base;
  for (int i = b.first_contact_point; i < b.first_contact_point + b.contact_point_count; ++i) {
    const Vec3& x = model_.node_position[model_.contact_points[i].node];
    if (x.z() > lowest + tolerance) continue;
    b.base_points.push_back(i);
    base.push_back(x);
  }
  if (base.size() < 3) return;
  std::vector<Vec3> hull = convex_hull(base, 1e-9);
  if (hull.size() < 3) return;
  b.base_centre.setZero();
  for (const Vec3& x : hull) b.base_centre += x / static_cast<double>(hull.size());
  b.support_polygon = std::move(hull);
}

}  // namespace topple
