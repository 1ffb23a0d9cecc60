// Many runs of one scene from Python.
#pragma once

#include <pybind11/pybind11.h>

namespace topple::python {

void add_sweep(pybind11::module_& module);

}  // namespace topple::python
