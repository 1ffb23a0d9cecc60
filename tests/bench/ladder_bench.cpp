// What the model levels cost, with their errors beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "solver/io/scene/scene.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/run/overturn.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_step = 1e-3;  // s

void compute_as(Setup& setup, BodyModel model) {
  setup.parameters.models.assign(setup.model.bodies.size(), model);
  for (std::size_t b = 0; b < setup.model.bodies.size(); ++b)
    setup.model.bodies[b].elastic =
        model == BodyModel::elastic ? elastic_basis(setup.model, static_cast<int>(b)) : nullptr;
}

/// Paper-a's cabinet beside a wall under its sine, `count` times, too far from each other to meet.
Setup beside_a_wall(BodyModel model, int count) {
  Setup setup;
  setup.model = steel_model();
  setup.model.planes.push_back(ground());
  setup.model.planes.push_back({"wall", Vec3(-0.215, 0, 0), Vec3::UnitX(), 0.09});
  for (int k = 0; k < count; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.at.y() = 1.5 * k;
    setup.starts.push_back(add_cabinet(setup.model, spec));
  }
  compute_as(setup, model);
  setup.parameters.contact.restitution = 0.5;
  shake(setup, 1.9, 0.5);
  setup.parameters.time_step = k_step;
  return setup;
}

/// A step, over and over the first two seconds, in which each cabinet lifts, rocks and leans on the wall.
void step_of(benchmark::State& state, BodyModel model) {
  const int count = static_cast<int>(state.range(0));
  const Setup setup = beside_a_wall(model, count);
  Workspace workspace(setup.model);
  State start = start_state(setup.model, setup.starts);
  if (!settle(setup.model, setup.parameters, start, workspace).ok())
    return state.SkipWithError("not settled");
  prepare(setup.model, setup.parameters, start, workspace);
  State now = start;
  for (auto _ : state) {
    if (now.time > 2) {
      state.PauseTiming();
      now = start;
      state.ResumeTiming();
    }
    if (!step(setup.model, setup.parameters, now, workspace).ok()) return state.SkipWithError("step failed");
  }
  state.counters["balance_error"] = now.energy.balance_error();
  state.counters["per_body"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(step_of, rigid, BodyModel::rigid)->Arg(1)->Arg(10)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(step_of, elastic, BodyModel::elastic)->Arg(1)->Arg(10);
BENCHMARK_CAPTURE(step_of, frame, BodyModel::frame)->Arg(1)->Arg(10)->Arg(100);

/// Tilts of the bodies every 10 ms, deg, and the greatest stress, Pa.
struct Course {
  std::vector<double> tilt;
  double stress = 0;
};

Course follow(const Setup& setup) {
  Course course;
  Run run(setup);
  double next = 0;
  while (!run.over() && run.advance().ok()) {
    if (run.time() < next - 1e-6) continue;
    next += 0.01;
    for (const BodyOutcome& o : run.outcome().bodies()) course.tilt.push_back(o.tilt * k_degrees);
  }
  for (const BodyOutcome& o : run.outcome().bodies()) course.stress = std::max(course.stress, o.peak_stress);
  return course;
}

/// The first four seconds of paper-a, both cabinets, stresses found at every step, against the frame at 0.1
/// ms.
void paper_a(benchmark::State& state, BodyModel model) {
  Setup setup = io::load_scene("paper-a", {"run.duration=4"}).setup;
  static const Course exact = [&] {
    Setup fine = setup;
    compute_as(fine, BodyModel::frame);
    fine.parameters.time_step = 1e-4;
    return follow(fine);
  }();
  compute_as(setup, model);
  setup.parameters.time_step = 1e-6 * static_cast<double>(state.range(0));
  Course course;
  for (auto _ : state) course = follow(setup);
  double squares = 0;
  const std::size_t count = std::min(course.tilt.size(), exact.tilt.size());
  for (std::size_t i = 0; i < count; ++i) squares += std::pow(course.tilt[i] - exact.tilt[i], 2);
  state.counters["per_simulated_s"] = benchmark::Counter(
      setup.run.duration, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["tilt_rms_deg"] = std::sqrt(squares / static_cast<double>(count));
  state.counters["stress_error"] = course.stress / exact.stress - 1;
}
BENCHMARK_CAPTURE(paper_a, rigid, BodyModel::rigid)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(paper_a, elastic, BodyModel::elastic)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(paper_a, frame, BodyModel::frame)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Unit(benchmark::kMillisecond);

/// The rocking block of the verification table, whose expectations its errors are compared with: 1 is the
/// tolerance.
void rocking(benchmark::State& state, BodyModel model) {
  const auto& scenes = io::verification_scenes();
  const auto found_scene = std::find_if(scenes.begin(), scenes.end(), [](const io::BuiltinScene& scene) {
    return scene.name.ends_with("rocking-free-50");
  });
  io::Scene scene = io::parse_scene(
      found_scene->text, std::string(found_scene->name),
      {"run.time_step=" +
       (state.range(0) > 0 ? std::to_string(1e-6 * static_cast<double>(state.range(0))) : "auto")});
  Setup& setup = scene.setup;
  compute_as(setup, model);
  BodyOutcome outcome;
  for (auto _ : state) {
    state.PauseTiming();
    Run observed(setup);
    while (!observed.over() && observed.advance().ok()) {
    }
    outcome = observed.outcome().bodies()[0];
    Workspace workspace(setup.model);
    State now = start_state(setup.model, setup.starts);
    prepare(setup.model, setup.parameters, now, workspace);
    state.ResumeTiming();
    long steps = 0;
    while (now.time < setup.run.duration - setup.parameters.time_step / 2) {
      if (!step(setup.model, setup.parameters, now, workspace, setup.run.duration).ok())
        return state.SkipWithError("step failed");
      ++steps;
    }
    state.counters["steps"] = steps;
    state.counters["balance_error"] = now.energy.balance_error();
  }
  state.counters["per_simulated_s"] = benchmark::Counter(
      setup.run.duration, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  const std::map<std::string, double> found{{"/bodies/0/peak_tilt_deg", outcome.peak_tilt * k_degrees},
                                            {"/bodies/0/first_impact_s", outcome.first_impact.value_or(0)},
                                            {"/bodies/0/rebound_tilt_deg", outcome.rebound_tilt * k_degrees}};
  double worst = 0;
  for (const io::Expectation& e : scene.expectations)
    if (found.contains(e.value))
      worst = std::max(worst, std::abs(found.at(e.value) - e.reference) / (e.scale * e.tolerance));
  state.counters["error_over_tolerance"] = worst;
}
BENCHMARK_CAPTURE(rocking, rigid, BodyModel::rigid)
    ->Arg(0)
    ->Arg(2000)
    ->Arg(4000)
    ->Arg(250)
    ->Arg(500)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(rocking, frame, BodyModel::frame)->Arg(250)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace topple::test

BENCHMARK_MAIN();
