#include "app/python/simulation.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <utility>

#include "app/batch/recorded_run.h"
#include "app/python/arrays.h"
#include "app/python/edit_value.h"
#include "app/python/names.h"
#include "app/python/picture.h"
#include "app/python/signals.h"
#include "app/support/errors.h"
#include "app/support/terms.h"

namespace topple::python {

/// As long as it lives no other thread has one of the same simulation.
class Simulation::Turn {
 public:
  explicit Turn(Simulation& of) : of_(of) {
    if (of.busy_.test_and_set()) throw std::runtime_error("the simulation is stepping in another thread");
  }
  ~Turn() { of_.busy_.clear(); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  Simulation& of_;
};

Simulation::Simulation(ScenePtr scene, std::optional<RunPoint> point) : scene_(std::move(scene)) {
  const Setup& setup = scene_->setup;
  if (setup.run.analysis == Analysis::modes)
    throw app::BadInput(scene_->name + ": modes take no steps of time; run() gives them");
  const py::gil_scoped_release released;
  if (point)
    run_.emplace(setup, *std::move(point));
  else
    run_.emplace(setup);
  expect_success();
  if (const int jobs = app::paying_jobs(setup); jobs > 1) run_->share(team_.emplace(jobs).share());
}

void Simulation::expect_success() const {
  if (!run_->status().ok()) throw RunError(scene_->name + ": " + run_->status().message(model()));
}

void Simulation::show() {
  if (!now_) return;
  now_->clear();
  now_->add(io::frame_row(*run_));
}

void Simulation::step() {
  const Turn turn(*this);
  expect_success();
  if (run_->over())
    throw RunError(fmt::format("{}: is over, at {:.6g}{}", scene_->name, run_->time(),
                               app::extent_unit(app::is_static(scene_->setup))));
  {
    const py::gil_scoped_release released;
    run_->advance();
  }
  show();
  expect_success();
}

void Simulation::run_until(double time) {
  const Turn turn(*this);
  Signals signals;
  {
    const py::gil_scoped_release released;
    while (!run_->over() && io::is_ahead(*run_, time) && !signals.raised()) run_->advance();
  }
  show();
  signals.rethrow();
  expect_success();
}

void Simulation::edit(const std::string& key, const std::string& value) {
  const Turn turn(*this);
  run_->edit(read_edit(key, value, run_->parameters(), model()));
  show();
  expect_success();
}

std::shared_ptr<Simulation> Simulation::fork() {
  const Turn turn(*this);
  return std::shared_ptr<Simulation>(new Simulation(scene_, run_->point()));
}

double Simulation::time() {
  const Turn turn(*this);
  return run_->time();
}

std::int64_t Simulation::steps() {
  const Turn turn(*this);
  return run_->step();
}

bool Simulation::over() {
  const Turn turn(*this);
  return run_->over();
}

std::uint64_t Simulation::state_hash() {
  const Turn turn(*this);
  return hash(run_->state());
}

std::shared_ptr<const Rows> Simulation::now() {
  const Turn turn(*this);
  if (!now_) {
    now_ = std::make_shared<Rows>(io::row_shape(model()));
    show();
  }
  return now_;
}

std::string Simulation::render(PictureSize size) {
  const Turn turn(*this);
  const py::gil_scoped_release released;
  const io::FrameRow row = io::frame_row(*run_);
  app::RunExtent extent;
  extent.add(run_->setup(), run_->parameters(), row);
  return draw_png(*scene_, extent, row, run_->parameters(), size);
}

void add_simulation(py::module_& module) {
  py::class_<Simulation, std::shared_ptr<Simulation>> bound(module, "Simulation",
                                                            R"(A run in progress, stepped from Python.

Simulation(scene): settles under gravity, where the scene says so; what is set in the scene later does not reach it.
Its steps are those of `topple run`, bit for bit. Other threads of Python go on while it steps; each simulation is for
one thread at a time, and another that uses it meanwhile gets RuntimeError. A step that fails raises RunError.

Arrays are live: views of the present state, read-only, that follow it whenever step, run_until or edit returns. Copy
them to keep values. They have the names, axes and units of a Result, without the axis row.)");
  bound
      .def(py::init([](const SceneText& scene) { return std::make_shared<Simulation>(scene.scene()); }),
           py::arg("scene"))
      .def("step", &Simulation::step, "One accepted step, of time or of the loads of a static run.")
      .def(
          "run_until", &Simulation::run_until, py::arg("time"),
          R"(Steps until `time`, s (static runs: part of the way), is reached, but for rounding, or the run is over.

It stands at the end of the step that reached it: steps are not cut. Ctrl+C raises KeyboardInterrupt after the step
under way; it can go on from there.)")
      .def(
          "edit",
          [](Simulation& self, const std::string& key, const py::object& value) {
            self.edit(key, value_text(value));
          },
          py::arg("key"), py::arg("value"),
          R"(Changes a parameter from the present instant on: edit("shake.1.amplitude", "150 gal").

Shakes, anchors and bodies are numbered from 1. Nothing jumps: amplitudes change over a quarter of a period. Before
the first step the simulation starts anew with the value, as with a scene that says it; RunError: that does not settle.
Raises InputError, which says what can be changed.)")
      .def("fork", &Simulation::fork,
           "Another simulation that goes on from here, bit for bit as this one would; neither touches the "
           "other.")
      .def_property_readonly("time", &Simulation::time, "s; of static runs the part of the way, 0..1")
      .def_property_readonly("steps", &Simulation::steps, "Accepted so far.")
      .def_property_readonly("over", &Simulation::over,
                             "Time is up, a stop condition holds or a step failed.")
      .def_property_readonly("state_hash", &Simulation::state_hash,
                             "64-bit hash of the state: equal where two runs go on bit for bit alike.")
      .def_property_readonly(
          "energy", [](Simulation& self) { return energy_view(self.now(), false); },
          "By name: [] J; balance_error is relative");
  for (const ArrayTraits& array : arrays())
    bound.def_property_readonly(
        array.name, [&array](Simulation& self) { return view(self.now(), array, false); },
        doc(array, false).c_str());
  bound
      .def(
          "render", [](Simulation& self, PictureSize size) { return py::bytes(self.render(size)); },
          py::arg("size") = PictureSize(k_picture_size),
          "A picture of the present state, as the bytes of a PNG file. size: width and height, px, 64..8192.")
      .def("_repr_png_", [](Simulation& self) { return py::bytes(self.render(k_picture_size)); });
  add_names(bound, [](const Simulation& self) -> const Model& { return self.model(); });
}

}  // namespace topple::python
