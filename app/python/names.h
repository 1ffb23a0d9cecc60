// What stands along the axes of arrays.
#pragma once

#include <pybind11/pybind11.h>

#include <span>

#include "solver/model/model.h"

namespace topple::python {

struct NamesTraits {
  const char* name;
  pybind11::list (*of)(const Model& model);
  const char* doc;
};
std::span<const NamesTraits> names();

/// Adds them to a class as properties; `model` gives the Model of an instance.
template <class Class, class GetModel>
void add_names(Class& bound, GetModel model) {
  for (const NamesTraits& axis : names())
    bound.def_property_readonly(
        axis.name, [model, of = axis.of](const typename Class::type& self) { return of(model(self)); },
        axis.doc);
}

}  // namespace topple::python
