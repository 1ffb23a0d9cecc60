// The group /model: what other programs need to understand the rows.
#include <algorithm>
#include <cstring>

#include "solver/io/recording/recording_format.h"

namespace topple::io {
namespace {

/// Rows of a compound data set, put together column by column.
class Table {
 public:
  explicit Table(std::size_t rows) : rows_(rows) {}

  template <typename Get>
  void text(const char* name, Get get) {
    std::size_t length = 1;
    for (std::size_t i = 0; i < rows_; ++i) length = std::max(length, get(i).size());
    std::vector<std::byte> bytes(rows_ * length);
    for (std::size_t i = 0; i < rows_; ++i) {
      const std::string& value = get(i);
      if (!value.empty()) std::memcpy(bytes.data() + i * length, value.data(), value.size());
    }
    columns_.push_back({name, text_type(length), length, std::move(bytes)});
  }
  template <typename Get>
  void number(const char* name, Get get) {
    add(name, H5T_IEEE_F64LE, 1, [&](std::size_t i, double* to) { *to = get(i); });
  }
  template <typename Get>
  void integer(const char* name, Get get) {
    add(name, H5T_STD_I32LE, 1, [&](std::size_t i, std::int32_t* to) { *to = get(i); });
  }
  template <typename Get>
  void vector(const char* name, Get get) {
    add(name, H5T_IEEE_F64LE, 3, [&](std::size_t i, double* to) {
      const Vec3 value = get(i);
      std::copy_n(value.data(), 3, to);
    });
  }

  void write(hid_t group, const char* name) const {
    std::size_t size = 0;
    for (const Column& column : columns_) size += column.bytes_per_row;
    const Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
    std::vector<std::byte> bytes(rows_ * size);
    std::size_t offset = 0;
    for (const Column& column : columns_) {
      const std::size_t width = column.bytes_per_row;
      checked(H5Tinsert(type, column.name, offset, column.type));
      for (std::size_t i = 0; i < rows_; ++i) {
        std::memcpy(bytes.data() + i * size + offset, column.bytes.data() + i * width, width);
      }
      offset += width;
    }
    write_fixed(group, name, type, {rows_}, bytes.data(), "SI");
  }

 private:
  struct Column {
    const char* name;
    Handle type;
    std::size_t bytes_per_row;
    std::vector<std::byte> bytes;
  };

  template <typename Fill>
  void add(const char* name, hid_t scalar, hsize_t count, Fill fill) {
    using Scalar = std::conditional_t<std::is_invocable_v<Fill, std::size_t, double*>, double, std::int32_t>;
    Handle type(count == 1 ? H5Tcopy(scalar) : H5Tarray_create2(scalar, 1, &count), H5Tclose);
    std::vector<Scalar> values(rows_ * count);
    for (std::size_t i = 0; i < rows_; ++i) fill(i, values.data() + i * count);
    const auto view = std::as_bytes(std::span(values));
    columns_.push_back({name, std::move(type), count * sizeof(Scalar), {view.begin(), view.end()}});
  }

  std::size_t rows_;
  std::vector<Column> columns_;
};

void write_nodes(hid_t group, const Model& model) {
  const std::size_t n = model.node_position.size();
  const auto inertia = [&model](int a, int b) {
    return [&model, a, b](std::size_t i) { return model.node_inertia[i](a, b); };
  };
  Table nodes(n);
  nodes.vector("position", [&](std::size_t i) { return model.node_position[i]; });
  nodes.integer("body", [&](std::size_t i) { return model.node_body[i]; });
  nodes.number("mass", [&](std::size_t i) { return model.node_mass[i]; });
  nodes.number("inertia_xx", inertia(0, 0));
  nodes.number("inertia_yy", inertia(1, 1));
  nodes.number("inertia_zz", inertia(2, 2));
  nodes.number("inertia_xy", inertia(0, 1));
  nodes.number("inertia_xz", inertia(0, 2));
  nodes.number("inertia_yz", inertia(1, 2));
  nodes.write(group, "nodes");
}

void write_elements(hid_t group, const Model& model) {
  const auto& list = model.elements;
  Table elements(list.size());
  elements.integer("first_node", [&](std::size_t i) { return list[i].node[0]; });
  elements.integer("second_node", [&](std::size_t i) { return list[i].node[1]; });
  elements.integer("member", [&](std::size_t i) { return list[i].member; });
  elements.number("length", [&](std::size_t i) { return list[i].length; });
  elements.number("s", [&](std::size_t i) { return list[i].s; });
  elements.vector("x_axis", [&](std::size_t i) { return Vec3(list[i].triad.col(0)); });
  elements.vector("y_axis", [&](std::size_t i) { return Vec3(list[i].triad.col(1)); });
  elements.vector("z_axis", [&](std::size_t i) { return Vec3(list[i].triad.col(2)); });
  elements.vector("EA_kGAy_kGAz", [&](std::size_t i) { return list[i].normal_stiffness; });
  elements.vector("GJ_EIy_EIz", [&](std::size_t i) { return list[i].bending_stiffness; });
  elements.write(group, "elements");
}

void write_members(hid_t group, const Model& model) {
  const auto& list = model.members;
  Table members(list.size());
  members.text("name", [&](std::size_t i) -> const std::string& { return list[i].name; });
  members.integer("body", [&](std::size_t i) { return list[i].body; });
  members.integer("first_element", [&](std::size_t i) { return list[i].first_element; });
  members.integer("element_count", [&](std::size_t i) { return list[i].element_count; });
  members.integer("section", [&](std::size_t i) { return list[i].section; });
  members.integer("material", [&](std::size_t i) { return list[i].material; });
  members.write(group, "members");
}

void write_bodies(hid_t group, const Model& model) {
  const auto& list = model.bodies;
  Table bodies(list.size());
  bodies.text("name", [&](std::size_t i) -> const std::string& { return list[i].name; });
  bodies.integer("first_node", [&](std::size_t i) { return list[i].first_node; });
  bodies.integer("node_count", [&](std::size_t i) { return list[i].node_count; });
  bodies.integer("first_element", [&](std::size_t i) { return list[i].first_element; });
  bodies.integer("element_count", [&](std::size_t i) { return list[i].element_count; });
  bodies.integer("first_contact_point", [&](std::size_t i) { return list[i].first_contact_point; });
  bodies.integer("contact_point_count", [&](std::size_t i) { return list[i].contact_point_count; });
  bodies.number("mass", [&](std::size_t i) { return list[i].mass; });
  bodies.vector("centre_of_gravity", [&](std::size_t i) { return list[i].centre_of_gravity; });
  bodies.vector("base_centre", [&](std::size_t i) { return list[i].base_centre; });
  bodies.write(group, "bodies");
}

void write_sections(hid_t group, const Model& model) {
  const auto& list = model.sections;
  Table sections(list.size());
  const auto column = [&](const char* name, double Section::*member) {
    sections.number(name, [&list, member](std::size_t i) { return list[i].*member; });
  };
  sections.text("name", [&](std::size_t i) -> const std::string& { return list[i].name; });
  sections.integer("shape", [&](std::size_t i) { return static_cast<std::int32_t>(list[i].shape); });
  column("size_y", &Section::size_y);
  column("size_z", &Section::size_z);
  column("thickness", &Section::thickness);
  column("area", &Section::area);
  column("iy", &Section::iy);
  column("iz", &Section::iz);
  column("j", &Section::j);
  column("ky", &Section::ky);
  column("kz", &Section::kz);
  column("width", &Section::width);
  sections.write(group, "sections");

  Table materials(model.materials.size());
  materials.text("name", [&](std::size_t i) -> const std::string& { return model.materials[i].name; });
  materials.number("young", [&](std::size_t i) { return model.materials[i].young; });
  materials.number("poisson", [&](std::size_t i) { return model.materials[i].poisson; });
  materials.number("density", [&](std::size_t i) { return model.materials[i].density; });
  materials.write(group, "materials");
}

void write_contacts(hid_t group, const Model& model) {
  Table points(model.contact_points.size());
  points.integer("node", [&](std::size_t i) { return model.contact_points[i].node; });
  points.number("width", [&](std::size_t i) { return model.contact_points[i].width; });
  points.write(group, "contact_points");

  Table planes(model.planes.size());
  planes.text("name", [&](std::size_t i) -> const std::string& { return model.planes[i].name; });
  planes.vector("point", [&](std::size_t i) { return model.planes[i].point; });
  planes.vector("normal", [&](std::size_t i) { return model.planes[i].normal; });
  planes.number("width", [&](std::size_t i) { return model.planes[i].width; });
  planes.write(group, "planes");
}

void write_anchors(hid_t group, const Model& model) {
  const auto& list = model.anchors;
  if (list.empty()) return;
  Table anchors(list.size());
  anchors.text("name", [&](std::size_t i) -> const std::string& { return list[i].name; });
  anchors.integer("body", [&](std::size_t i) { return list[i].body; });
  anchors.integer("node", [&](std::size_t i) { return list[i].node; });
  anchors.vector("arm", [&](std::size_t i) { return list[i].arm; });
  anchors.vector("to", [&](std::size_t i) { return list[i].to; });
  anchors.integer("type", [&](std::size_t i) { return static_cast<std::int32_t>(list[i].type); });
  anchors.number("stiffness", [&](std::size_t i) { return list[i].stiffness; });
  anchors.number("strength", [&](std::size_t i) { return list[i].strength; });
  anchors.number("length", [&](std::size_t i) { return list[i].length; });
  if (std::ranges::any_of(list, [](const Anchor& anchor) { return anchor.other.body >= 0; })) {
    anchors.integer("to_body", [&](std::size_t i) { return list[i].other.body; });
    anchors.integer("to_node", [&](std::size_t i) { return list[i].other.node; });
    anchors.vector("to_arm", [&](std::size_t i) { return list[i].other.arm; });
  }
  anchors.write(group, "anchors");
}

}  // namespace

void write_model(hid_t file, const Model& model) {
  const Handle group(H5Gcreate2(file, "model", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  write_nodes(group, model);
  write_elements(group, model);
  write_members(group, model);
  write_bodies(group, model);
  write_sections(group, model);
  write_contacts(group, model);
  write_anchors(group, model);
}

}  // namespace topple::io
