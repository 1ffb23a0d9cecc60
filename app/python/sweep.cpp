#include "app/python/sweep.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/batch/recorded_run.h"
#include "app/batch/summary.h"
#include "app/python/scene.h"
#include "app/python/signals.h"
#include "app/support/errors.h"
#include "solver/study/common/parallel.h"

namespace topple::python {
namespace {

namespace py = pybind11;

constexpr int k_most_jobs = 1024;

int jobs_of(std::optional<int> jobs, std::size_t cases) {
  if (jobs && (*jobs < 1 || *jobs > k_most_jobs))
    throw app::BadInput("jobs: " + std::to_string(*jobs) + " is outside 1.." + std::to_string(k_most_jobs));
  const int usual = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::min(jobs.value_or(usual), std::max(1, static_cast<int>(cases)));
}

/// A scene with modes or a wrong key is refused before anything runs.
std::vector<ScenePtr> scenes_of(const SceneText& scene, const std::vector<py::dict>& cases) {
  std::vector<ScenePtr> scenes;
  for (const py::dict& one : cases) {
    SceneText changed = scene;
    for (const auto& [key, value] : one) changed.set(key.cast<std::string>(), value_text(value));
    if (changed.scene()->setup.run.analysis == Analysis::modes)
      throw app::BadInput(changed.scene()->name + ": modes are no run; run() gives them");
    scenes.push_back(changed.scene());
  }
  return scenes;
}

py::list sweep(const SceneText& scene, const std::vector<py::dict>& cases, std::optional<int> jobs) {
  const std::vector<ScenePtr> scenes = scenes_of(scene, cases);
  const int workers = jobs_of(jobs, scenes.size());
  std::vector<std::string> summaries(scenes.size());
  Signals signals;
  std::atomic<bool> stop = false;
  {
    const py::gil_scoped_release released;
    study::for_each_case(
        static_cast<int>(scenes.size()), workers,
        [&](int k, int worker) {
          const auto interrupted = [&signals, &stop, worker] {
            if (worker == 0 && signals.raised()) stop = true;  // it is this thread
            return stop.load();
          };
          const auto i = static_cast<std::size_t>(k);
          summaries[i] = app::json_text(
              app::record(*scenes[i], "", {.quiet = true, .jobs = 1, .interrupted = interrupted}).summary);
        },
        [&](int) { return !stop.load(); });
  }
  signals.rethrow();
  const py::object loads = py::module_::import("json").attr("loads");
  py::list out;
  for (const std::string& summary : summaries) out.append(loads(summary));
  return out;
}

}  // namespace

void add_sweep(py::module_& module) {
  module.def("sweep", sweep, py::arg("scene"), py::arg("cases"), py::arg("jobs") = py::none(),
             R"(The summaries of many runs of a scene, in the order of the cases.

cases: for each run what is set before it, a dictionary as {"shake.1.amplitude": "150 gal"}; the scene itself stays as
it was. jobs: threads, default one a core; they change no bit of any result. A run that fails before its end has the
status "diverged" in its summary. Nothing is recorded.
Other threads of Python go on meanwhile; Ctrl+C ends it with KeyboardInterrupt.
Raises InputError for a wrong key or value in any case, before anything runs.)");
}

}  // namespace topple::python
