#include "app/python/result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <utility>

#include "app/batch/recorded_run.h"
#include "app/batch/summary.h"
#include "app/picture/bridge.h"
#include "app/python/arrays.h"
#include "app/python/names.h"
#include "app/python/page.h"
#include "app/python/picture.h"
#include "app/python/signals.h"
#include "app/support/errors.h"
#include "app/support/terms.h"
#include "solver/io/export/exported_values.h"
#include "solver/io/recording/rerun.h"

namespace topple::python {
namespace {

constexpr int k_modes = 10;  // of a body, as `topple modes` gives

/// Locked while HDF5 is at work: the library of Debian takes one thread at a time. With the GIL.
std::unique_lock<std::timed_mutex> turn_at_files(Signals& signals) {
  static std::timed_mutex mutex;
  std::unique_lock lock(mutex, std::defer_lock);
  {
    const py::gil_scoped_release released;
    while (!lock.try_lock_for(std::chrono::milliseconds(50)) && !signals.raised()) continue;
  }
  signals.rethrow();
  return lock;
}

void keep(const io::Observation& observation, Rows& rows, std::vector<KnownState>& states) {
  for (const io::FrameRow& row : observation.frames) rows.add(row);
  if (const auto& point = observation.checkpoint) states.push_back({point->step, point->time, point->hash});
}

py::object summary_of(const Result& self) {
  if (self.summary.empty()) return py::dict();
  return py::module_::import("json").attr("loads")(self.summary);
}

py::list states_of(const Result& self) {
  py::list states;
  for (const KnownState& state : self.states)
    states.append(py::make_tuple(state.step, state.time, state.hash));
  return states;
}

py::bytes render(const Result& self, std::optional<double> at, PictureSize size) {
  if (self.rows->size() == 0) throw app::BadInput(self.scene->name + ": there is nothing to draw");
  const auto& times = self.rows->time();
  const double time = at.value_or(times.back());
  constexpr double slack = 1e-6;  // times are sums of rounded steps
  if (!(time >= times.front() - slack && time <= times.back() + slack))
    throw app::BadInput(fmt::format("at: {:g} is outside {:g}..{:g}{}", time, times.front(), times.back(),
                                    app::extent_unit(app::is_static(self.scene->setup))));
  std::string png;
  {
    const py::gil_scoped_release released;
    const io::FrameRow row = self.at(time);
    png = draw_png(*self.scene, self.extent(), row, self.parameters(row), size);
  }
  return py::bytes(png);
}

py::object page_of(const Result& self) {
  return page_in_frame(*self.scene,
                       {.rows = self.rows->size(),
                        .row = [&](std::size_t k) { return self.rows->row(k); },
                        .parameters = [&](const io::FrameRow& row) { return self.parameters(row); },
                        .summary = self.summary,
                        .edited = !self.history.edits_on_way_to(self.history.branches.back().id).empty()});
}

}  // namespace

const app::RunExtent& Result::extent() const {
  std::call_once(looked_, [this] {
    for (std::size_t k = 0; k < rows->size(); ++k)
      extent_.add(scene->setup, scene->setup.parameters, rows->row(k));
  });
  return extent_;
}

io::FrameRow Result::at(double time) const {
  const auto& times = rows->time();
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, time) - times.begin());
  const std::size_t next = std::min(after, times.size() - 1), here = std::max<std::size_t>(next, 1) - 1;
  if (times[here] == time || here == next) return rows->row(here);
  return app::blend(rows->row(here), rows->row(next), time);
}

Parameters Result::parameters(const io::FrameRow& row) const {
  return parameters_before(scene->setup, history, row.branch, row.step);
}

std::shared_ptr<Result> run(const ScenePtr& scene, const std::filesystem::path& record) {
  auto result = std::make_shared<Result>();
  const auto rows = std::make_shared<Rows>(io::row_shape(scene->setup.model));
  result->scene = scene;
  result->history.branches = {Branch{}};
  result->rows = rows;
  if (scene->setup.run.analysis == Analysis::modes) {
    if (!record.empty()) throw app::BadInput("record: modes are not recorded; the summary has them");
    result->summary = app::json_text(app::modes_summary(*scene, k_modes));
    return result;
  }
  Signals signals;
  const auto turn = record.empty() ? std::unique_lock<std::timed_mutex>() : turn_at_files(signals);
  app::RecordedRun ended;
  {
    const py::gil_scoped_release released;
    ended = app::record(*scene, record,
                        {.quiet = true,
                         .observe = [&](const io::Observation& seen) { keep(seen, *rows, result->states); },
                         .interrupted = [&signals] { return signals.raised(); }});
  }
  signals.rethrow();
  if (!ended.trouble.empty() && PyErr_WarnEx(PyExc_RuntimeWarning, ended.trouble.c_str(), 1) != 0)
    throw py::error_already_set();
  result->summary = app::json_text(ended.summary);
  return result;
}

std::shared_ptr<Result> open(const std::filesystem::path& path) {
  Signals signals;
  const auto turn = turn_at_files(signals);
  auto result = std::make_shared<Result>();
  {
    const py::gil_scoped_release released;
    const io::Recording recording(path.string());
    result->scene = std::make_shared<const io::Scene>(io::recorded_scene(recording));
    result->history = recording.history();
    io::check_edits(result->history, result->scene->setup);
    const std::int32_t branch = recording.newest_branch();
    const auto frames = io::exported_frames(recording, result->scene->setup);
    const auto rows = std::make_shared<Rows>(io::row_shape(result->scene->setup.model));
    rows->reserve(frames.size());
    for (std::size_t k = 0; k < frames.size() && !signals.raised(); ++k) {
      const io::FrameRow row = recording.frame(frames[k]);
      io::expect_same_model(result->scene->setup.model, row);
      rows->add(row);
    }
    result->rows = rows;
    const std::vector<Stretch> way = result->history.way_to(branch);
    for (std::int64_t k = 0; k < recording.checkpoint_count() && !signals.raised(); ++k) {
      const io::Checkpoint point = recording.checkpoint(k);
      const auto holds = [&](const Stretch& part) {
        return part.branch == point.branch && (part.branch == branch || point.step < part.last_step);
      };
      if (std::ranges::any_of(way, holds)) result->states.push_back({point.step, point.time, point.hash});
    }
    result->summary = recording.summary_json();
  }
  signals.rethrow();
  return result;
}

void add_result(py::module_& module) {
  py::class_<Result, std::shared_ptr<Result>> bound(
      module, "Result", R"(What a run came to: summary, and recorded rows as arrays.

Arrays share the memory of the run, are read-only and stay valid when the Result is gone. Their axes have names:
[row, node, 3] has a row for each recorded instant; bodies, nodes, elements, contacts and anchors name the others.)");
  bound
      .def_property_readonly(
          "time", [](const Result& self) { return time_view(self.rows); },
          "[row] s; of static runs the part of the way, 0..1")
      .def_property_readonly(
          "step", [](const Result& self) { return step_view(self.rows); },
          "[row] 1: accepted steps at the end of the one that the row lies in")
      .def_property_readonly(
          "energy", [](const Result& self) { return energy_view(self.rows, true); },
          "By name (input, kinetic, strain, gravity, contact, friction, ...): [row] J; "
          "balance_error is relative");
  for (const ArrayTraits& array : arrays())
    bound.def_property_readonly(
        array.name, [&array](const Result& self) { return view(self.rows, array, true); },
        doc(array, true).c_str());
  bound
      .def_property_readonly("summary", summary_of,
                             "As `topple run --json`; empty when a recording was cut off.")
      .def_property_readonly("scene_name", [](const Result& self) { return self.scene->name; })
      .def_property_readonly(
          "scene_text", [](const Result& self) { return self.scene->text; }, "The scene of the run, TOML.")
      .def_property_readonly("states", states_of,
                             "Step, time in s and state_hash of a Simulation at the checkpoints of the run.")
      .def("render", render, py::arg("at") = py::none(), py::arg("size") = PictureSize(k_picture_size),
           R"(A picture, as the bytes of a PNG file: what `topple render --still` draws.

at: s, of static runs the part of the way, default the last instant; size: width and height, px, 64..8192.
Raises InputError for an instant outside the run.)")
      .def("_repr_png_", [](const Result& self) { return render(self, std::nullopt, k_picture_size); })
      .def("_repr_html_", page_of,
           R"(The page that `topple export --page` writes, in a frame, for notebooks.

None where it has more than 10 MiB, there is nothing to show, or the module was built without emscripten: notebooks
show the picture then.)");
  add_names(bound, [](const Result& self) -> const Model& { return self.scene->setup.model; });
  module.def("open", open, py::arg("path"),
             R"(A recording as a Result: all its rows, on the way to the newest branch.

Raises InputError for a file that is no recording, or a damaged one. It is read in this process: check a file from
elsewhere with `topple info FILE` first.)");
}

}  // namespace topple::python
