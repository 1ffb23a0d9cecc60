#include "app/python/scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>

#include "app/python/names.h"
#include "solver/io/edit/scene_number.h"

namespace topple::python {
namespace py = pybind11;

namespace {

std::string toml(py::handle value) {
  if (py::isinstance<py::str>(value)) return io::written_text(value.cast<std::string>());
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (PySequence_Check(value.ptr())) {
    std::string text;
    for (const py::handle item : value) text += (text.empty() ? "[" : ", ") + toml(item);
    return text.empty() ? "[]" : text + "]";
  }
  if (PyIndex_Check(value.ptr())) return py::str(py::int_(py::reinterpret_borrow<py::object>(value)));
  if (py::hasattr(value, "__float__")) return py::repr(py::float_(py::reinterpret_borrow<py::object>(value)));
  throw py::type_error("a value is a text, a number, True, False or a list of these, not " +
                       std::string(py::str(py::type::of(value))));
}

double number(const SceneText& self, const std::string& key) {
  const io::SceneNumber found = io::number_in(*self.scene(), key);
  if (!found.value)
    throw io::InputError(key + ": the scene leaves it out or has no number there, and it has no default");
  return *found.value;
}

}  // namespace

SceneText::SceneText(io::SceneSource source)
    : source_(std::move(source)),
      root_(io::parse_toml(source_.text, source_.origin)),
      scene_(std::make_shared<const io::Scene>(io::understand(root_, source_, source_.text))) {}

void SceneText::set(const std::string& key, const std::string& value) {
  io::Node changed = root_;
  io::change(changed, {key + "=" + value});
  scene_ = std::make_shared<const io::Scene>(io::understand(changed, source_, io::write_toml(changed)));
  root_ = std::move(changed);
}

std::string value_text(py::handle value) {
  return py::isinstance<py::str>(value) ? value.cast<std::string>() : toml(value);
}

void add_scene(py::module_& module) {
  py::class_<SceneText, std::shared_ptr<SceneText>> scene(
      module, "Scene", R"(A scene: what stands where, and how the floor shakes.

Scene(source): a TOML file by path, or a built-in scene by name; a path wins when the file exists. Raises InputError.

scene["shake.1.amplitude"] = "150 gal" sets a key, as --set of the program does: keys are dotted, entries of arrays go
by name or by number from 1; a text may have a unit, a number is in SI. What is wrong raises InputError and leaves the
scene as it was. scene["shake.1.amplitude"] is the number there in SI, or its default.)");
  scene
      .def(py::init([](const std::filesystem::path& source) {
             return std::make_shared<SceneText>(io::find_scene(source.string()));
           }),
           py::arg("source"))
      .def_static(
          "parse",
          [](const std::string& text, const std::string& origin) {
            return std::make_shared<SceneText>(io::SceneSource{text, origin, io::files_beside(origin)});
          },
          py::arg("text"), py::arg("origin") = "scene.toml",
          "A scene from TOML text. origin: what errors call it; files that the scene names are sought beside "
          "it.")
      .def("__setitem__", [](SceneText& self, const std::string& key,
                             const py::object& value) { self.set(key, value_text(value)); })
      .def("__getitem__", number)
      .def("__repr__",
           [](const SceneText& self) {
             return "topple.Scene(" + std::string(py::repr(py::str(self.scene()->name))) + ")";
           })
      .def(
          "run",
          [](const SceneText& self, const std::optional<std::filesystem::path>& record) {
            return run(self.scene(), record.value_or(""));
          },
          py::arg("record") = py::none(), R"(Steps the scene to its end and gives a Result.

record: a file to record to as well (HDF5), in place of an older recording. Runs that record wait for one another.
Other threads of Python go on meanwhile; Ctrl+C ends it with KeyboardInterrupt, and the recording holds what came
before.
A run that fails before its end warns (RuntimeWarning); its summary has the status "diverged".
Raises InputError for a file that is no recording, OSError where one cannot be written.)")
      .def_property_readonly(
          "name", [](const SceneText& self) { return self.scene()->name; },
          "The built-in name, or the file's without folder and extension.")
      .def_property_readonly("title", [](const SceneText& self) { return self.scene()->title; })
      .def_property_readonly(
          "text", [](const SceneText& self) { return self.scene()->text; },
          "TOML, with the keys that were set.");
  add_names(scene, [](const SceneText& self) -> const Model& { return self.scene()->setup.model; });
}

}  // namespace topple::python
