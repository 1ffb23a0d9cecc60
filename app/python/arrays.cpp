#include "app/python/arrays.h"

#include <utility>
#include <vector>

namespace topple::python {
namespace {

using Shape = io::RowShape;
constexpr auto f32 = Number::f32, f64 = Number::f64, u8 = Number::u8;

constexpr ArrayTraits k_arrays[] = {
    {"position", k_position, f32, "node", &Shape::nodes, 3, 0, 3, "m: of nodes, floor's frame"},
    {"rotation", k_rotation, f32, "node", &Shape::nodes, 4, 0, 4,
     "1: of nodes from the reference pose, quaternion w x y z"},
    {"section_force", k_section_force, f32, "element", &Shape::elements, 6, 0, 6,
     "N and N m: N, Vy, Vz, T, My, Mz at the stress point"},
    {"integration_point", k_s, f32, "element", &Shape::elements, 0, 0, 0,
     "1: -1..1 along the element; the stress point lies opposite"},
    {"hinge", k_hinge, u8, "element", &Shape::elements, 0, 0, 0,
     "1: hinges: 0 none, 1 first end, 2 second end, 3 broken, 4 middle, 7 both ends; 5, 6, 8: none now, "
     "flowed at the first, the second, both"},
    {"contact_depth", k_contact_depth, f32, "contact", &Shape::contacts, 0, 0, 0,
     "1: share of the contact width, 0 open"},
    {"contact_force", k_contact_force, f32, "contact", &Shape::contacts, 3, 0, 3,
     "N: on the node, floor's frame"},
    {"member_contact", k_member_contact, f32, "element", &Shape::touched, 4, 0, 4,
     "N and 1: force of other bodies on an element, and where, 0..1 along it; of a single body no elements"},
    {"panel_contact", k_panel_contact, f32, "panel", &Shape::panels, 5, 0, 5,
     "N and 1: the same of panels, with two numbers for the place"},
    {"centre", k_body, f64, "body", &Shape::bodies, 11, 0, 3, "m: centre of gravity, floor's frame"},
    {"body_rotation", k_body, f64, "body", &Shape::bodies, 11, 3, 4,
     "1: from the reference pose, quaternion w x y z"},
    {"tilt", k_body, f64, "body", &Shape::bodies, 11, 7, 1, "rad"},
    {"slide", k_body, f64, "body", &Shape::bodies, 11, 8, 1, "m: horizontal travel of the base"},
    {"body_energy", k_body, f64, "body", &Shape::bodies, 11, 9, 1,
     "J: kinetic, strain and gravity, the last from the reference pose"},
    {"critical_angle", k_body, f64, "body", &Shape::bodies, 11, 10, 1,
     "rad: tilt at which it is in balance on an edge, 0 none"},
    {"model", k_level, u8, "body", &Shape::bodies, 0, 0, 0, "1: 0 rigid, 1 elastic, 2 frame, 3 planar"},
    {"floor_acceleration", k_floor_acceleration, f64, "", nullptr, 3, 0, 3, "m/s^2"},
    {"floor_displacement", k_floor_displacement, f64, "", nullptr, 3, 0, 3, "m: high-passed"},
    {"load_factor", k_load_factor, f64, "", nullptr, 0, 0, 0, "1: of static runs"},
    {"anchor_tension", k_anchors, f32, "anchor", &Shape::anchors, 4, 0, 1, "N: negative where it pushes"},
    {"anchor_energy", k_anchors, f32, "anchor", &Shape::anchors, 4, 1, 1, "J"},
    {"anchor_length", k_anchors, f32, "anchor", &Shape::anchors, 4, 2, 1, "m: natural"},
    {"anchor_state", k_anchors, f32, "anchor", &Shape::anchors, 4, 3, 1,
     "1: 0 away, 1 slack, 2 holds, 3 broken"},
};

py::dtype dtype_of(Number number) {
  return number == f32   ? py::dtype::of<float>()
         : number == f64 ? py::dtype::of<double>()
                         : py::dtype::of<std::uint8_t>();
}

/// It owns a share of the rows.
py::array shared(const std::shared_ptr<const Rows>& rows, const py::dtype& type,
                 std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const void* first) {
  using Share = std::shared_ptr<const Rows>;
  const py::capsule share(new Share(rows), [](void* held) { delete static_cast<Share*>(held); });
  py::array array(type, std::move(shape), std::move(strides), first, share);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <class T>
py::array column(const std::shared_ptr<const Rows>& rows, const std::vector<T>& values) {
  return shared(rows, py::dtype::of<T>(), {static_cast<py::ssize_t>(values.size())}, {sizeof(T)},
                values.data());
}

}  // namespace

std::span<const ArrayTraits> arrays() {
  return k_arrays;
}

std::string doc(const ArrayTraits& array, bool rows) {
  std::string axes;
  const auto add = [&axes](const std::string& axis) { axes += (axes.empty() ? "" : ", ") + axis; };
  if (rows) add("row");
  if (array.length) add(array.axis);
  if (array.count > 1) add(std::to_string(array.count));
  return "[" + axes + "] " + array.about;
}

py::array view(const std::shared_ptr<const Rows>& rows, const ArrayTraits& array, bool axis) {
  const py::dtype type = dtype_of(array.number);
  const py::ssize_t item = type.itemsize();
  std::vector<py::ssize_t> shape;
  if (axis) shape.push_back(static_cast<py::ssize_t>(rows->size()));
  if (array.length) shape.push_back(static_cast<py::ssize_t>(rows->shape().*array.length));
  if (array.columns > 0) shape.push_back(array.columns);
  std::vector<py::ssize_t> strides(shape.size());
  py::ssize_t bytes = item;
  for (std::size_t k = shape.size(); k-- > 0; bytes *= shape[k]) strides[k] = bytes;
  if (array.count == 1) {
    shape.pop_back();
    strides.pop_back();
  } else if (array.columns > 0) {
    shape.back() = array.count;
  }
  return shared(rows, type, std::move(shape), std::move(strides),
                rows->bytes(array.field).data() + array.first * item);
}

py::dict energy_view(const std::shared_ptr<const Rows>& rows, bool axis) {
  py::dict energies;
  const auto kinds = io::energy_columns(rows->shape().anchors > 0);
  const int count = static_cast<int>(kinds.size());
  for (int k = 0; k < count; ++k)
    energies[kinds[k].name] = view(rows, {"energy", k_energy, f64, "", nullptr, count, k, 1, ""}, axis);
  return energies;
}

py::array time_view(const std::shared_ptr<const Rows>& rows) {
  return column(rows, rows->time());
}

py::array step_view(const std::shared_ptr<const Rows>& rows) {
  return column(rows, rows->step());
}

}  // namespace topple::python
