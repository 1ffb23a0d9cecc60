// The Python module.
#include <pybind11/pybind11.h>

#include <utility>

#include "app/python/result.h"
#include "app/python/scene.h"
#include "app/python/simulation.h"
#include "app/python/sweep.h"
#include "app/support/errors.h"
#include "solver/io/common/errors.h"

namespace topple::python {
namespace {

namespace py = pybind11;

/// Names of files in `line` may be no UTF-8.
void raise(PyObject* error, const char* line) {
  PyErr_SetObject(error, py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(line)).ptr());
}

void add_errors(py::module_& module) {
  // Never given back: exceptions may outlive the module's own objects.
  static PyObject* const input_error =
      py::exception<io::InputError>(module, "InputError", PyExc_ValueError).release().ptr();
  static PyObject* const run_error =
      py::exception<RunError>(module, "RunError", PyExc_RuntimeError).release().ptr();
  py::setattr(
      input_error, "__doc__",
      py::str("Bad input, in the program's one line: file, line and column, key, and what is expected."));
  py::setattr(run_error, "__doc__", py::str("A step failed, or a run is over."));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const io::InputError& error) {
      raise(input_error, error.what());
    } catch (const app::BadInput& error) {
      raise(input_error, error.what());
    } catch (const host::Refusal& error) {
      raise(input_error, error.what());
    } catch (const host::FileError& error) {
      raise(PyExc_OSError, error.what());
    } catch (const RunError& error) {
      raise(run_error, error.what());
    }
  });
}

}  // namespace

PYBIND11_MODULE(topple, module) {
  module.doc() = R"(Furniture that tips over when the floor shakes.

    scene = topple.Scene("paper-a")
    scene["shake.1.amplitude"] = "150 gal"
    result = scene.run()
    result.tilt.max(axis=0)     # rad, of each body

Lengths in m, times in s, forces in N, angles in rad: SI, unless a text says a unit.)";
  module.attr("__version__") = TOPPLE_VERSION;
  add_errors(module);
  add_result(module);
  add_scene(module);
  add_simulation(module);
  add_sweep(module);
}

}  // namespace topple::python
