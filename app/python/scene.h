// A scene as Python holds it: its text, changed key by key.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "app/python/result.h"
#include "solver/io/scene/scene_file.h"

namespace topple::python {

class SceneText {
 public:
  /// Throws io::InputError.
  explicit SceneText(io::SceneSource source);

  /// `value`: as of --set. Throws io::InputError and stays as it was.
  void set(const std::string& key, const std::string& value);
  const ScenePtr& scene() const { return scene_; }

 private:
  io::SceneSource source_;
  io::Node root_;
  ScenePtr scene_;
};

/// What --set calls a value of Python: a text as it is, numbers, truth values and lists of them as TOML.
/// Throws py::type_error.
std::string value_text(pybind11::handle value);

void add_scene(pybind11::module_& module);

}  // namespace topple::python
