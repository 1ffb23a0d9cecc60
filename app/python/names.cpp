#include "app/python/names.h"

#include <string>

namespace topple::python {
namespace {

namespace py = pybind11;

const std::string& name_of(const Model& model, int body) {
  return model.bodies[static_cast<std::size_t>(body)].name;
}

template <class Items, class Name>
py::list names_of(const Items& items, Name name) {
  py::list names;
  for (const auto& item : items) names.append(name(item));
  return names;
}

/// In its body, from 0.
int number_of_node(const Model& model, int node) {
  const int body = model.node_body[static_cast<std::size_t>(node)];
  return node - model.bodies[static_cast<std::size_t>(body)].first_node;
}

py::list body_names(const Model& model) {
  return names_of(model.bodies, [](const Body& body) { return body.name; });
}

py::list member_names(const Model& model) {
  return names_of(model.members, [&](const Member& member) {
    return py::make_tuple(name_of(model, member.body), member.name);
  });
}

py::list node_names(const Model& model) {
  py::list names;
  for (int node = 0; node < model.node_total(); ++node)
    names.append(py::make_tuple(name_of(model, model.node_body[static_cast<std::size_t>(node)]),
                                number_of_node(model, node)));
  return names;
}

py::list element_names(const Model& model) {
  py::list names;
  for (const Member& member : model.members)
    for (int k = 0; k < member.element_count; ++k)
      names.append(py::make_tuple(name_of(model, member.body), member.name, k));
  return names;
}

py::list contact_names(const Model& model) {
  py::list names;
  for (const ContactPoint& point : model.contact_points)
    for (const Plane& plane : model.planes)
      names.append(py::make_tuple(name_of(model, model.node_body[static_cast<std::size_t>(point.node)]),
                                  number_of_node(model, point.node), plane.name));
  return names;
}

py::list anchor_names(const Model& model) {
  return names_of(model.anchors, [](const Anchor& anchor) { return anchor.name; });
}

constexpr NamesTraits k_names[] = {
    {"bodies", body_names, "Names of bodies, in the order of the axis body."},
    {"members", member_names, "Pairs of body and member, in the order of the model."},
    {"nodes", node_names, "Pairs of body and number in it from 0, in the order of the axis node."},
    {"elements", element_names, "Body, member and number in it from 0, in the order of the axis element."},
    {"contacts", contact_names,
     "Body, number of the node in it and floor or wall, in the order of the axis contact."},
    {"anchors", anchor_names, "Names of anchors, in the order of the axis anchor."},
};

}  // namespace

std::span<const NamesTraits> names() {
  return k_names;
}

}  // namespace topple::python
