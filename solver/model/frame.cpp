#include <algorithm>
#include <cmath>

#include "solver/model/body_builder.h"
#include "solver/model/cabinet.h"

namespace topple {
namespace {

constexpr double k_level = 1e-6;  // of the height: nodes of one level

void add_one(Model& model, const FrameSpec& spec, const std::string& name, const Vec3& shift) {
  BodyBuilder builder(model, name);
  for (std::size_t i = 0; i < spec.nodes.size(); ++i) {
    const int before = model.node_total();
    const int index = builder.node(spec.nodes[i] + shift);
    if (index != before)
      throw BuildError("nodes", "nodes " + std::to_string(index - builder.body().first_node) + " and " +
                                    std::to_string(i) + " are in one place");
  }
  const int first = builder.body().first_node, count = builder.body().node_count;
  std::vector<double> width(count, 0.);
  for (std::size_t m = 0; m < spec.members.size(); ++m) {
    const FrameMember& member = spec.members[m];
    if (member.node[0] == member.node[1])
      throw BuildError("members", "member " + std::to_string(m) + " has no length");
    // copies: the line adds nodes to the list that holds its ends
    const Vec3 from = model.node_position[first + member.node[0]];
    const Vec3 to = model.node_position[first + member.node[1]];
    const std::vector<int> nodes = builder.line("member-" + std::to_string(m), from, to, 1, member.elements,
                                                member.section, member.material, member.up);
    width.resize(builder.body().node_count, 0.);
    for (int node : nodes)
      width[node - first] = std::max(width[node - first], model.sections[member.section].width);
  }
  for (int i = 0; i < count; ++i)
    if (width[i] == 0) throw BuildError("nodes", "node " + std::to_string(i) + " belongs to no member");
  for (std::array<int, 4> corners : spec.panels) {
    for (int& node : corners) node += first;
    builder.add_panel(corners);
  }
  builder.add_material_mass();
  if (spec.mass > 0) {
    double from_density = 0, added = 0;
    for (int i = first; i < model.node_total(); ++i) from_density += model.node_mass[i];
    for (const PointMass& point : spec.masses) added += point.mass;
    if (!(spec.mass > added)) throw BuildError("mass", "is not above the sum of `masses`");
    const double factor = (spec.mass - added) / from_density;
    for (int i = first; i < model.node_total(); ++i) {
      model.node_mass[i] *= factor;
      model.node_inertia[i] *= factor;
    }
  }
  for (const PointMass& point : spec.masses) {
    model.node_mass[first + point.node] += point.mass;
    model.node_inertia[first + point.node] += point.inertia.asDiagonal();
  }
  for (std::size_t i = 0; i < width.size(); ++i)
    builder.add_contact_point(first + static_cast<int>(i), width[i]);
  builder.close();
  for (Support support : spec.supports) {
    support.node += first;
    model.supports.push_back(support);
  }
  for (Load load : spec.loads) {
    load.node += first;
    model.loads.push_back(load);
  }
}

// Of the lowest nodes of the newest body the one farthest to the side of the tilt.
Vec3 tilt_pivot(const Model& model, double tilt) {
  const Body& body = model.bodies.back();
  Vec3 pivot = model.node_position[body.first_node];
  double highest = pivot.z();
  const auto each = [&](auto&& use) {
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i) use(model.node_position[i]);
  };
  each([&](const Vec3& x) {
    if (x.z() < pivot.z()) pivot = x;
    highest = std::max(highest, x.z());
  });
  const double top_of_base = pivot.z() + k_level * (highest - pivot.z());
  each([&](const Vec3& x) {
    if (x.z() <= top_of_base && (x.x() - pivot.x()) * tilt > 0) pivot = x;
  });
  return pivot;
}

}  // namespace

std::string copy_name(const std::string& name, std::size_t index) {
  return index == 0 ? name : name + "-" + std::to_string(index + 1);
}

std::vector<BodyStart> add_frame(Model& model, const FrameSpec& spec) {
  std::vector<Vec3> copies = spec.copies;
  if (copies.empty()) copies.push_back(Vec3::Zero());
  std::vector<BodyStart> starts;
  for (std::size_t c = 0; c < copies.size(); ++c) {
    add_one(model, spec, copy_name(spec.name, c), copies[c]);
    BodyStart start;
    start.velocity = spec.velocity;
    start.angular_velocity = spec.angular_velocity;
    if (spec.tilt != 0) {
      start.pivot = tilt_pivot(model, spec.tilt);
      start.rotation = Vec3(0, spec.tilt, 0);
    }
    starts.push_back(start);
  }
  return starts;
}

}  // namespace topple
