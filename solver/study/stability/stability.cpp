#include "solver/study/stability/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "solver/body/model_level.h"
#include "solver/io/edit/scene_rewrite.h"
#include "solver/io/scene/scene_file.h"
#include "solver/math/ranges.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/refinement.h"
#include "solver/study/common/spread.h"

namespace topple::study {
namespace {

using io::InputError;
using nlohmann::ordered_json;
using End = StabilityRun::End;

constexpr const char* k_steps = "run.time_step=0.03 ms..30 ms:10";
constexpr double k_softest = 0.2, k_stiffest = 100;  // of the scene's alpha
constexpr double k_most_kgf = 1e6;                   // kgf
constexpr const char* k_ends[] = {"completed",   "not set up", "not settled",   "refused",
                                  "no solution", "growth",     "passed through"};

/// A fifth of to a hundred times what the scene has.
std::string usual_alphas(const Setup& scene) {
  const double own = scene.parameters.contact.alpha / k_standard_gravity;
  return fmt::format("contact.alpha={:.6g} kgf..{:.6g} kgf:10log", k_softest * own,
                     std::min(k_stiffest * own, k_most_kgf));
}

bool is_numerical(const Axis& axis) {
  return axis.table == "run" && (axis.name == "time_step" || axis.name == "tolerance");
}

/// Of how a method steps; of one method alone.
bool is_of_method(const Axis& axis) {
  return axis.table == "run" &&
         (axis.name == "beta" || axis.name == "gamma" || axis.name == "spectral_radius");
}

std::vector<SteppingMethod> methods_for(const Setup& scene) {
  std::vector<SteppingMethod> list{
      {"central-difference", "Central differences", Integrator::central_difference},
      {"newmark", "Newmark, β = 1/4, γ = 1/2 (trapezoidal rule)", Integrator::newmark, 1. / 4, 1. / 2},
      {"newmark-5/6", "Newmark, β = 4/9, γ = 5/6", Integrator::newmark, 4. / 9, 5. / 6},
      {"generalized-alpha", "Generalized-α, spectral radius 0.8", Integrator::generalized_alpha}};
  const Parameters& p = scene.parameters;
  bool known = false;
  for (const SteppingMethod& m : list)
    known |= m.integrator == p.integrator &&
             (m.integrator != Integrator::newmark || (m.beta == p.beta && m.gamma == p.gamma)) &&
             (m.integrator != Integrator::generalized_alpha || p.spectral_radius == m.spectral_radius);
  for (int b = 0; b < scene.model.furniture_total(); ++b)
    known &= traits(base_level(scene.model, p, b).level).moves_nodes;
  if (!known) list.push_back({"scene", "As the scene has it", p.integrator});
  return list;
}

Setup with_changes(const StabilityPlan& plan, const std::vector<std::string>& changes) {
  // the tolerance of a scene is that of steps which it chooses
  const bool step_given =
      ranges::any_of(changes, [](const std::string& change) { return change.starts_with("run.time_step="); });
  const std::string text = step_given
                               ? io::rewrite_toml(plan.scene.text, {{{"run", "tolerance"}, std::nullopt}})
                               : plan.scene.text;
  Setup setup = io::parse_scene(text, plan.scene.name, changes, io::kept_files(plan.scene)).setup;
  setup.run.duration = plan.horizon;
  return setup;
}

/// Member 0: a quarter of the step and a hundredth of the tolerance; 1: half and a tenth; 2 and 3: as 0, with
/// weaker and stronger shakes.
Setup reference_setup(const StabilityPlan& plan, int group, int member) {
  std::vector<std::string> changes;
  int point = 0;
  while (plan.group(point) != group) ++point;
  if (!is_numerical(plan.x)) changes.push_back(plan.x.change(point % plan.x.count()));
  if (!is_numerical(plan.y)) changes.push_back(plan.y.change(point / plan.x.count()));
  Setup half = refined(with_changes(plan, changes));
  if (member == 1) return half;
  const double turn = member == 0 ? 0 : member == 2 ? -1 : 1;
  return shaken_by(refined(half), 1 + k_reference_spread * turn);
}

End end_of(const StepStatus& status) {
  switch (status.kind) {
    case StepStatus::Kind::ok:
      return End::completed;
    case StepStatus::Kind::step_too_long:
      return End::refused;
    case StepStatus::Kind::not_settled:
      return End::not_settled;
    case StepStatus::Kind::passed_through:
      return End::passed_through;
    case StepStatus::Kind::not_finite:
    case StepStatus::Kind::energy_lost:
      return End::growth;
    default:
      return End::no_solution;
  }
}

double finite(double value) {
  return std::isfinite(value) ? value : 0;
}

StabilityRun outcome_of(const Setup& setup, const std::function<bool()>& give_up, bool& gave_up) {
  Run run(setup);
  while (!run.over() && !gave_up) {
    run.advance();
    gave_up = give_up();
  }
  StabilityRun out;
  out.end = end_of(run.status());
  if (!run.status().ok()) out.message = run.status().message(setup.model);
  out.time = run.time();
  for (int b = 0; b < setup.model.furniture_total(); ++b) {
    const BodyOutcome& body = run.outcome().bodies()[static_cast<std::size_t>(b)];
    out.fell.push_back(body.beyond_since.has_value());
    out.penetration = std::max(out.penetration, finite(body.peak_penetration));
  }
  const EnergyLedger& energy = run.state().energy;
  if (energy.largest > 0) {
    out.unexplained = finite(energy.unexplained() / energy.largest);
    out.numerical = finite(energy.numerical / energy.largest);
  }
  out.steps = run.step();
  out.rejected = run.rejected_steps();
  return out;
}

ordered_json as_row(const StabilityRun& run) {
  return {{"end", k_ends[static_cast<int>(run.end)]},
          {"message", run.message},
          {"time_s", run.time},
          {"fell", run.fell},
          {"unexplained", run.unexplained},
          {"numerical", run.numerical},
          {"penetration", run.penetration},
          {"steps", run.steps},
          {"rejected", run.rejected},
          {"cpu_s", run.cpu}};
}

StabilityRun from_row(const std::string& row) {
  const ordered_json json = ordered_json::parse(row);
  StabilityRun run;
  run.end = static_cast<End>(std::ranges::find(k_ends, json["end"].get<std::string>()) - std::begin(k_ends));
  run.message = json["message"];
  run.time = json["time_s"];
  run.fell = json["fell"].get<std::vector<bool>>();
  run.unexplained = json["unexplained"];
  run.numerical = json["numerical"];
  run.penetration = json["penetration"];
  run.steps = json["steps"];
  run.rejected = json["rejected"];
  run.cpu = json["cpu_s"];
  return run;
}

}  // namespace

int StabilityPlan::groups() const {
  return (is_numerical(x) ? 1 : x.count()) * (is_numerical(y) ? 1 : y.count());
}

int StabilityPlan::group(int point) const {
  const int i = is_numerical(x) ? 0 : point % x.count(), j = is_numerical(y) ? 0 : point / x.count();
  return j * (is_numerical(x) ? 1 : x.count()) + i;
}

int StabilityPlan::references() const {
  return scene.setup.parameters.shakes.empty() ? 2 : 4;
}

StabilityPlan plan_stability(io::Scene scene, const std::string& x, const std::string& y) {
  if (scene.setup.run.analysis != Analysis::dynamic)
    throw InputError("study stability: " + scene.name + " is not dynamic; it has no time steps");
  if (const std::string why = why_not_frames(scene.setup.model); !why.empty())
    throw InputError("study stability: " + scene.name + " cannot be stepped by all methods: " + why);
  if (y.empty() && scene.setup.model.planes.empty())
    throw InputError("--y KEY=FROM..TO:N is required: " + scene.name +
                     " has no floor or wall that is a plane");
  StabilityPlan plan{.scene = std::move(scene), .x = {}, .y = {}, .methods = {}};
  plan.x = axis_of("--x", x.empty() ? k_steps : x, plan.scene);
  plan.y = axis_of("--y", y.empty() ? usual_alphas(plan.scene.setup) : y, plan.scene);
  for (const auto& [option, axis] : {std::pair{"--x ", &plan.x}, std::pair{"--y ", &plan.y}})
    if (is_of_method(*axis))
      throw InputError(option + axis->key + ": is of one method; the study has several");
  check_axes(plan.scene, plan.x, plan.y);
  plan.methods = methods_for(plan.scene.setup);
  return plan;
}

double find_horizon(const Setup& scene, const std::function<bool()>& give_up) {
  Run run(scene);
  while (!run.over() && !give_up()) run.advance();
  double last = 0;
  for (const BodyOutcome& body : run.outcome().bodies()) last = std::max(last, body.beyond_since.value_or(0));
  if (last == 0 || !run.status().ok()) return scene.run.duration;
  return std::min(scene.run.duration, last + k_after_fall);
}

ordered_json settings_of(const StabilityPlan& plan) {
  ordered_json settings = settings_of("stability", plan.scene, plan.x, plan.y);
  settings["horizon"] = plan.horizon;
  return settings;
}

std::vector<int> case_order(const StabilityPlan& plan) {
  const int first = plan.groups() * plan.references(), methods = static_cast<int>(plan.methods.size());
  std::vector<int> order(static_cast<std::size_t>(first));
  std::iota(order.begin(), order.end(), 0);
  for (const int point : coarse_to_fine(plan.x.count(), plan.y.count()))
    for (int m = 0; m < methods; ++m) order.push_back(first + point * methods + m);
  return order;
}

Setup stepped_by(const StabilityPlan& plan, const SteppingMethod& method,
                 const std::vector<std::string>& changes) {
  Setup setup = with_changes(plan, changes);
  if (method.of_scene()) return setup;
  Parameters& p = setup.parameters;
  p.resolves_contacts = false;  // the method as it is
  p.models.assign(setup.model.bodies.size(), BodyModel::frame);
  p.integrator = method.integrator;
  p.beta = method.beta;
  p.gamma = method.gamma;
  p.spectral_radius = method.spectral_radius;
  return setup;
}

std::string run_case(const StabilityPlan& plan, int k, const std::function<bool()>& give_up) {
  const int first = plan.groups() * plan.references(), methods = static_cast<int>(plan.methods.size());
  const auto setup_of = [&] {
    if (k < first) return reference_setup(plan, k / plan.references(), k % plan.references());
    const int point = (k - first) / methods;
    return stepped_by(plan, plan.methods[static_cast<std::size_t>((k - first) % methods)],
                      {plan.x.change(point % plan.x.count()), plan.y.change(point / plan.x.count())});
  };
  StabilityRun out;
  bool gave_up = false;
  const auto work = [&] {
    try {
      out = outcome_of(setup_of(), give_up, gave_up);
    } catch (const InputError& error) {
      out.end = End::not_set_up;
      out.message = error.what();
    }
  };
  const double cpu = cpu_time_of(work, 0);
  if (gave_up) return "";
  out.cpu = cpu;
  return as_row(out).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

Agreement agree(const std::vector<StabilityRun>& runs) {
  Agreement out{.decided = true, .why_not = "", .fell = runs.front().fell};
  for (const StabilityRun& run : runs) {
    out.penetration = std::max(out.penetration, run.penetration);
    if (!out.decided) continue;
    if (run.end != End::completed)
      out.why_not = "a reference run failed: " + run.message;
    else if (std::abs(run.unexplained) > k_stable_balance)
      out.why_not = "a reference run does not keep its energy balance";
    else if (run.fell != out.fell)
      out.why_not = "the reference runs part in what overturns";
    out.decided = out.why_not.empty();
  }
  return out;
}

const char* name(Fate fate) {
  constexpr const char* k_names[k_fates] = {"not computed", "failed",  "refused",       "no solution",
                                            "energy grows", "tunnels", "wrong verdict", "energy lost",
                                            "undecided",    "stable"};
  return k_names[static_cast<int>(fate)];
}

Fate judge(const StabilityRun& run, const Agreement& reference) {
  switch (run.end) {
    case End::completed:
      break;
    case End::not_set_up:
    case End::not_settled:
      return Fate::failed;
    case End::refused:
      return Fate::refused;
    case End::no_solution:
      return Fate::no_solution;
    case End::growth:
      return Fate::grows;
    case End::passed_through:
      return Fate::tunnels;
  }
  if (run.unexplained > k_stable_balance || run.numerical < -k_stable_balance) return Fate::grows;
  if (run.penetration > std::max(1., reference.penetration + k_through)) return Fate::tunnels;
  if (reference.decided && run.fell != reference.fell) return Fate::wrong;
  if (run.unexplained < -k_stable_balance || run.numerical > k_stable_damping) return Fate::loses;
  return reference.decided ? Fate::stable : Fate::undecided;
}

int StabilityMap::count(std::size_t method, Fate fate) const {
  return static_cast<int>(
      std::ranges::count_if(cells[method], [=](const Cell& cell) { return cell.fate == fate; }));
}

StabilityMap gather(const StabilityPlan& plan, const std::vector<std::string>& rows) {
  StabilityMap map;
  const Model& model = plan.scene.setup.model;
  for (int b = 0; b < model.furniture_total(); ++b) map.bodies.push_back(model.bodies[b].name);
  map.of = plan.cases();
  map.run =
      static_cast<int>(std::ranges::count_if(rows, [](const std::string& row) { return !row.empty(); }));
  for (int group = 0, k = 0; group < plan.groups(); ++group) {
    std::vector<StabilityRun> runs;
    for (int member = 0; member < plan.references(); ++member, ++k)
      if (const std::string& row = rows[static_cast<std::size_t>(k)]; !row.empty())
        runs.push_back(from_row(row));
    const bool whole = static_cast<int>(runs.size()) == plan.references();
    map.references.push_back(whole ? agree(runs) : Agreement{});
  }
  const std::size_t first = static_cast<std::size_t>(plan.groups() * plan.references());
  for (std::size_t m = 0; m < plan.methods.size(); ++m) {
    std::vector<StabilityMap::Cell> cells(static_cast<std::size_t>(plan.points()));
    for (std::size_t p = 0; p < cells.size(); ++p) {
      const std::string& row = rows[first + p * plan.methods.size() + m];
      if (row.empty()) continue;
      cells[p].run = from_row(row);
      cells[p].fate =
          judge(*cells[p].run, map.references[static_cast<std::size_t>(plan.group(static_cast<int>(p)))]);
    }
    map.cells.push_back(std::move(cells));
  }
  return map;
}

}  // namespace topple::study
