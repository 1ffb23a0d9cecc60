#include "solver/study/elements/elements.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/frame/modes.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/parallel.h"
#include "solver/study/common/rows.h"
#include "solver/study/elements/theory.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

constexpr int k_modes = 3;
constexpr int k_finest = 256;  // elements per member, of the references by extrapolation

io::Scene scene_with(const std::string& name, Scheme scheme, int elements_per_member) {
  const Model model = io::load_scene(name).setup.model;
  std::vector<std::string> overrides{std::string("run.elements=") + traits(scheme).word};
  for (std::size_t m = 1; m <= model.members.size(); ++m)
    overrides.push_back("frame." + model.bodies.front().name + ".members." + std::to_string(m) +
                        ".elements=" + std::to_string(elements_per_member));
  return io::load_scene(name, overrides);
}

int unknowns(const Model& model) {
  int fixed = 0;
  for (const Support& support : model.supports) fixed += std::popcount(support.fixed);
  return 6 * model.node_total() - fixed;
}

/// A probe's displacement and turn in the plane of the benchmarks, or the mean displacement of two.
std::vector<double> probed(const Run& run) {
  const std::vector<ProbeOutcome>& probes = run.probes();
  if (probes.size() == 2) return {(probes[0].displacement.x() + probes[1].displacement.x()) / 2};
  const ProbeOutcome& tip = probes.front();
  return {-tip.displacement.z(), -tip.displacement.x(), tip.rotation.y()};
}

std::vector<double> peak_load(const Run& run) {
  double peak = 0;
  for (const LoadStep& step : run.load_steps())
    if (step.converged) peak = std::max(peak, step.factor);
  return {peak};
}

std::vector<double> frequencies(const Model& model) {
  std::vector<double> found;
  for (const Mode& mode : natural_modes(model, 0, k_modes)) found.push_back(mode.frequency);
  return found;
}

/// The values of a benchmark's quantities, in their order; empty when the run diverged.
std::vector<double> solve(const Setup& setup) {
  if (setup.run.analysis == Analysis::modes) return frequencies(setup.model);
  Run run(setup);
  while (!run.over()) run.advance();
  if (!run.status().ok()) return {};
  return setup.run.statics.control ? peak_load(run) : probed(run);
}

Benchmark theory_benchmark(const std::string& scene, const std::string& solves, Quantity quantity,
                           double (*exact)(const Model&)) {
  quantity.reference = exact(io::load_scene(scene).setup.model);
  return {scene, solves, {std::move(quantity)}};
}

Benchmark elastica_benchmark() {
  const Elastica exact = elastica(10);
  const std::string source = "elliptic integrals, P L²/EI = 10";
  const auto quantity = [&](const char* name, const char* title, const char* unit, bool charted,
                            double reference) {
    return Quantity{name, title, unit, source, charted, 2, reference};
  };
  return {"elements/elastica",
          "10 load steps",
          {quantity("elastica-deflection", "Elastica, tip deflection", "m", true, exact.deflection),
           quantity("elastica-shortening", "Elastica, shortening", "m", false, exact.shortening),
           quantity("elastica-angle", "Elastica, tip angle", "rad", false, exact.angle)}};
}

/// Frequencies have no theory here: both schemes that converge from different elements are extrapolated, and
/// their difference is part of the uncertainty.
Benchmark frequency_benchmark() {
  Benchmark benchmark{"elements/cabinet-frame", "three modes", {}};
  const auto fine = [&](Scheme scheme, int coarser) {
    return solve(scene_with(benchmark.scene, scheme, k_finest / coarser).setup);
  };
  const auto limits = [&](Scheme scheme) {
    const std::vector<double> at_4h = fine(scheme, 4), at_2h = fine(scheme, 2), at_h = fine(scheme, 1);
    std::vector<Limit> found;
    for (std::size_t k = 0; k < at_h.size(); ++k)
      found.push_back(second_order_limit(at_4h[k], at_2h[k], at_h[k]));
    return found;
  };
  const std::vector<Limit> gauss = limits(Scheme::asi_gauss), midpoint = limits(Scheme::midpoint);
  static const char* const k_word[k_modes] = {"first", "second", "third"};
  for (std::size_t k = 0; k < gauss.size(); ++k) {
    const double value = gauss[k].value;
    const double uncertainty =
        std::max({gauss[k].uncertainty, midpoint[k].uncertainty, std::abs(value - midpoint[k].value)});
    benchmark.quantities.push_back({"cabinet-frequency-" + std::to_string(k + 1),
                                    "Cabinet frame, " + std::string(k_word[k]) + " frequency", "Hz",
                                    "Richardson limit at 256 elements", k < 2, 2, value,
                                    uncertainty / value});
  }
  return benchmark;
}

/// One solution: of a benchmark by a scheme.
struct Solution {
  std::size_t benchmark;
  Scheme scheme;
  int elements_per_member;
  int elements = 0, unknowns = 0;
  bool run = false;
  std::vector<double> values;
  double cpu = 0;
};

void run_solution(const std::vector<Benchmark>& benchmarks, double timed, Solution& solution) {
  const io::Scene scene =
      scene_with(benchmarks[solution.benchmark].scene, solution.scheme, solution.elements_per_member);
  solution.elements = static_cast<int>(scene.setup.model.elements.size());
  solution.unknowns = unknowns(scene.setup.model);
  solution.cpu = cpu_time_of([&] { solution.values = solve(scene.setup); }, timed);
  solution.run = true;
}

ElementsRow row_of(const Solution& solution, const Benchmark& benchmark, std::size_t k) {
  const Quantity& quantity = benchmark.quantities[k];
  ElementsRow row{quantity.name,
                  quantity.unit,
                  solution.scheme,
                  solution.elements_per_member,
                  solution.elements,
                  solution.unknowns,
                  quantity.reference,
                  {},
                  {},
                  {},
                  "not run"};
  if (!solution.run) return row;
  row.cpu = solution.cpu;
  row.status = solution.values.empty() ? "diverged" : "completed";
  if (solution.values.empty()) return row;
  row.computed = solution.values[k];
  row.error = std::abs(*row.computed - quantity.reference) / std::abs(quantity.reference);
  return row;
}

}  // namespace

std::vector<Benchmark> element_benchmarks() {
  return {theory_benchmark("elements/cantilever", "one load step",
                           {"cantilever", "Cantilever, tip deflection", "m", "P L³/3EI + P L/κGA", true, 2},
                           cantilever_deflection),
          elastica_benchmark(),
          theory_benchmark(
              "elements/portal-sway", "one load step",
              {"portal-sway", "Portal, elastic sway", "m", "frame theory, with shear and tension", true, 2},
              portal_sway),
          theory_benchmark("elements/beam-collapse", "60 load steps",
                           {"beam-collapse", "Clamped beam, collapse load", "1", "8 Mp/L", true, 1},
                           beam_collapse),
          theory_benchmark("elements/portal-collapse", "80 load steps",
                           {"portal-collapse", "Portal, collapse load", "1",
                            "H h + V l/2 = 6 Mp (sway takes 2e-6 off)", true, 1},
                           portal_collapse),
          theory_benchmark("elements/portal-corners", "80 load steps",
                           {"portal-corners", "Pinned portal, equal corners", "1",
                            "H h + V l/2 = 4 Mp (sway takes 2e-5 off)", true, 1},
                           portal_collapse),
          frequency_benchmark()};
}

ElementsStudy study_elements(const ElementsSettings& settings,
                             const std::function<bool(int done, int of)>& go_on) {
  ElementsStudy study{element_benchmarks(), {}, 0, 0};
  std::vector<Solution> solutions;
  for (const int n : k_elements_per_member)
    for (std::size_t b = 0; b < study.benchmarks.size(); ++b)
      for (const SchemeTraits& scheme : k_schemes)
        solutions.push_back({b, scheme.kind, n, 0, 0, false, {}, 0});
  study.of = static_cast<int>(solutions.size());
  for_each_case(
      study.of, settings.jobs,
      [&](int k, int) {
        run_solution(study.benchmarks, settings.timed, solutions[static_cast<std::size_t>(k)]);
      },
      [&](int done) { return go_on(done, study.of); });
  for (std::size_t b = 0; b < study.benchmarks.size(); ++b)
    for (std::size_t k = 0; k < study.benchmarks[b].quantities.size(); ++k)
      for (const SchemeTraits& scheme : k_schemes)
        for (const Solution& solution : solutions)
          if (solution.benchmark == b && solution.scheme == scheme.kind)
            study.rows.push_back(row_of(solution, study.benchmarks[b], k));
  for (const Solution& solution : solutions) study.solved += solution.run ? 1 : 0;
  return study;
}

ordered_json rows_as_json(const ElementsStudy& study) {
  ordered_json rows = ordered_json::array();
  for (const ElementsRow& row : study.rows)
    rows.push_back({{"case", row.quantity},
                    {"scheme", traits(row.scheme).word},
                    {"elements_per_member", row.elements_per_member},
                    {"elements", row.elements},
                    {"unknowns", row.unknowns},
                    {"unit", row.unit},
                    {"reference", row.reference},
                    {"computed", or_null(row.computed)},
                    {"error", or_null(row.error)},
                    {"cpu_s", or_null(row.cpu)},
                    {"status", row.status}});
  return rows;
}

ordered_json quantities_as_json(const ElementsStudy& study) {
  ordered_json list = ordered_json::array();
  for (const Benchmark& benchmark : study.benchmarks)
    for (const Quantity& quantity : benchmark.quantities)
      list.push_back({{"case", quantity.name},
                      {"title", quantity.title},
                      {"scene", benchmark.scene},
                      {"solution", benchmark.solves},
                      {"unit", quantity.unit},
                      {"reference", quantity.reference},
                      {"relative_uncertainty", quantity.uncertainty},
                      {"source", quantity.source}});
  return list;
}

}  // namespace topple::study
