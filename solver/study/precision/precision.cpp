#include "solver/study/precision/precision.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "solver/body/model_level.h"
#include "solver/body/step_control.h"
#include "solver/contact/contact_law.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/math/elementary.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/kept_rows.h"
#include "solver/study/common/measure.h"

namespace topple::study {
namespace {

using io::InputError;
using nlohmann::ordered_json;

constexpr double k_usual_step = 1e-3, k_usual_tolerance = 1e-3;  // of scenes that name none
// Powers of two of the scene's step, and of the root of ten of its tolerance.
constexpr int k_coarsest = 3, k_finest_reduced = -4, k_finest_frame = -5;
constexpr int k_looser = 2, k_tighter = -4;
constexpr int k_explicit_steps = 3;      // below the limit
constexpr double k_most_samples = 1000;  // of a run

constexpr MethodMeaning k_meanings[k_methods] = {
    {Method::scene, "scene's own", "as the scene is", BodyModel::automatic, Integrator::generalized_alpha,
     false, 3.5},
    {Method::rigid, "rigid", "rigid, fixed steps", BodyModel::rigid, Integrator::generalized_alpha, false, 1},
    {Method::rigid_auto, "rigid auto", "rigid, by tolerance", BodyModel::rigid, Integrator::generalized_alpha,
     true, 1},
    {Method::elastic, "elastic", "elastic, fixed steps", BodyModel::elastic, Integrator::generalized_alpha,
     false, 3.5},
    {Method::elastic_auto, "elastic auto", "elastic, by tolerance", BodyModel::elastic,
     Integrator::generalized_alpha, true, 3.5},
    {Method::generalized_alpha, "frame generalized-alpha", "frame, generalized-alpha", BodyModel::frame,
     Integrator::generalized_alpha, false, 19},
    {Method::generalized_alpha_auto, "frame generalized-alpha auto", "frame, generalized-alpha, by tolerance",
     BodyModel::frame, Integrator::generalized_alpha, true, 19},
    {Method::newmark, "frame newmark", "frame, Newmark 1/4, 1/2", BodyModel::frame, Integrator::newmark,
     false, 19},
    {Method::newmark_damped, "frame newmark 5/6", "frame, Newmark 4/9, 5/6", BodyModel::frame,
     Integrator::newmark, false, 19, 4. / 9, 5. / 6},
    {Method::central_difference, "frame central-difference", "frame, central differences", BodyModel::frame,
     Integrator::central_difference, false, 5.5}};

bool moves_as(const Model& model, BodyModel asked) {
  for (int b = 0; b < model.furniture_total(); ++b)
    if (can_be(model, b, asked)) return true;
  return false;
}

void compute_as(Setup& setup, BodyModel asked) {
  setup.parameters.models.resize(setup.model.bodies.size(), BodyModel::frame);
  for (int b = 0; b < setup.model.furniture_total(); ++b)
    setup.parameters.models[static_cast<std::size_t>(b)] =
        can_be(setup.model, b, asked) ? asked : BodyModel::frame;
}

/// Of central differences with all bodies frames, s; none: the scene does not begin.
std::optional<double> stable_step(Setup setup) {
  compute_as(setup, BodyModel::frame);
  setup.parameters.integrator = Integrator::central_difference;
  setup.parameters.adaptive = false;
  setup.parameters.time_step = k_least_step;
  Run run(setup);
  if (!run.status().ok()) return std::nullopt;
  run.advance();
  return run.stable_step();
}

std::vector<ContactLaw> laws_of(const Setup& setup) {
  const ContactLaw& own = setup.parameters.contact;
  std::vector<ContactLaw> laws{own};
  if (setup.model.contact_points.empty() || (setup.model.planes.empty() && setup.model.bodies.size() < 2))
    return laws;
  const double most = io::find_key("contact", "alpha")->most;
  for (const ContactLawTraits& of : contact_laws())
    for (const double factor : k_alpha_factors) {
      ContactLaw law = own;
      law.kind = of.kind;
      law.alpha *= factor;
      if (law != own && law.alpha <= most) laws.push_back(law);
    }
  return laws;
}

/// CPU time of a run to its end, s.
double expected_cost(const Setup& setup, const Setting& setting) {
  constexpr double k_rigid_step = 1e-6;  // s
  const double step =
      setting.step > 0 ? setting.step : k_usual_step * std::sqrt(setting.tolerance / k_usual_tolerance);
  return k_rigid_step * meaning(setting.method).step_cost * setup.model.furniture_total() *
         setup.run.duration / step;
}

}  // namespace

const MethodMeaning& meaning(Method method) {
  return row_of(k_meanings, method);
}

PrecisionPlan plan_precision(io::Scene scene) {
  if (scene.setup.run.analysis != Analysis::dynamic)
    throw InputError("study precision: " + scene.name + " is not dynamic; it has no time steps");
  if (scene.setup.model.furniture_total() == 0)
    throw InputError("study precision: " + scene.name + " has no body that moves");
  if (const std::string why = why_not_frames(scene.setup.model); !why.empty())
    throw InputError("study precision: " + scene.name + " cannot be stepped by all methods: " + why);
  PrecisionPlan plan{.scene = std::move(scene), .laws = {}, .settings = {}, .list = {}};
  Setup& setup = plan.scene.setup;
  Model& model = setup.model;
  for (int b = 0; b < model.furniture_total(); ++b)
    if (Body& body = model.bodies[static_cast<std::size_t>(b)];
        !body.elastic && can_be(model, b, BodyModel::rigid)) {
      body.elastic = elastic_basis(model, b);
      if (body.elastic) body.elastic = with_attachments(model, b);
    }
  if (setup.run.stop_when == StopWhen::never) setup.run.stop_when = StopWhen::all_overturned;
  plan.laws = laws_of(setup);

  const Parameters& own = setup.parameters;
  const double step = own.adaptive ? k_usual_step : own.time_step;
  const double tolerance = own.adaptive ? own.tolerance : k_usual_tolerance;
  plan.settings.push_back({Method::scene, own.adaptive ? 0 : step, own.adaptive ? tolerance : 0});
  const auto add_steps = [&](Method method, int finest) {
    for (int k = k_coarsest; k >= finest; --k) plan.settings.push_back({method, std::ldexp(step, k), 0});
  };
  const auto add_tolerances = [&](Method method) {
    for (int k = k_looser; k >= k_tighter; --k)
      plan.settings.push_back({method, 0, tolerance * elementary::pow(10., k / 2.)});
  };
  for (const auto& [fixed, adaptive] :
       {std::pair{Method::rigid, Method::rigid_auto}, {Method::elastic, Method::elastic_auto}}) {
    if (!moves_as(model, meaning(fixed).model)) continue;
    add_steps(fixed, k_finest_reduced);
    add_tolerances(adaptive);
  }
  add_steps(Method::generalized_alpha, k_finest_frame);
  add_tolerances(Method::generalized_alpha_auto);
  add_steps(Method::newmark, k_finest_frame);
  add_steps(Method::newmark_damped, k_finest_frame);
  Setup stiffest = setup;
  for (const ContactLaw& law : plan.laws)
    stiffest.parameters.contact.alpha = std::max(stiffest.parameters.contact.alpha, law.alpha);
  if (const std::optional<double> limit = stable_step(stiffest)) {
    // the first is beyond the limit and has a row that says so
    const int first = static_cast<int>(std::ceil(std::log2(*limit / step)));
    for (int k = 0; k <= k_explicit_steps; ++k)
      plan.settings.push_back({Method::central_difference, std::ldexp(step, first - k), 0});
  }
  for (int law = 0; law < static_cast<int>(plan.laws.size()); ++law)
    for (int k = 0; k < static_cast<int>(plan.settings.size()); ++k)
      if (k == 0 || expected_cost(setup, plan.settings[static_cast<std::size_t>(k)]) <=
                        (law == 0 ? k_own_law : k_other_law))
        plan.list.push_back({law, k});
  const double coarsest = std::ldexp(step, k_coarsest);
  plan.interval = coarsest * std::max(1., std::ceil(setup.run.duration / k_most_samples / coarsest));
  return plan;
}

Setup PrecisionPlan::setup_of(int k) const {
  Setup setup = scene.setup;
  Parameters& p = setup.parameters;
  p.contact = laws[static_cast<std::size_t>(law_of(k))];
  const Setting& setting = setting_of(k);
  if (setting.method == Method::scene) return setup;
  const MethodMeaning& how = meaning(setting.method);
  compute_as(setup, how.model);
  p.integrator = how.integrator;
  p.beta = how.beta;
  p.gamma = how.gamma;
  p.adaptive = how.adaptive;
  (how.adaptive ? p.tolerance : p.time_step) = how.adaptive ? setting.tolerance : setting.step;
  return setup;
}

ordered_json settings_of(const PrecisionPlan& plan) {
  ordered_json laws = ordered_json::array(), settings = ordered_json::array();
  for (int k = 0; k < static_cast<int>(plan.laws.size()); ++k)
    laws.push_back(in_words(plan.laws[static_cast<std::size_t>(k)]));
  for (int k = 0; k < plan.cases(); ++k) settings.push_back(in_words(plan, k));
  return {{"study", "precision"}, {"scene", plan.scene.name},      {"laws", laws},
          {"settings", settings}, {"scene text", plan.scene.text}, {"files", fingerprints(plan.scene.files)}};
}

std::vector<int> case_order(const PrecisionPlan& plan) {
  std::vector<int> order(static_cast<std::size_t>(plan.cases()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int k) {
    return std::pair(plan.law_of(k), expected_cost(plan.scene.setup, plan.setting_of(k)));
  });
  return order;
}

namespace {

/// What a run did, at multiples of the interval; between steps by the cubic through four of them.
class Sampler {
 public:
  Sampler(const PrecisionPlan& plan, int bodies)
      : interval_(plan.interval), tilt_(static_cast<std::size_t>(bodies)), stress_(tilt_.size()) {
    for (Step& step : last_) step.bodies.resize(tilt_.size());
  }

  void see(const Run& run) {
    std::rotate(last_, last_ + 1, last_ + k_kept);
    Step& now = last_[k_kept - 1];
    now.time = run.time();
    now.balance = run.energy().balance_error();
    for (std::size_t b = 0; b < tilt_.size(); ++b) {
      const BodyOutcome& body = run.outcome().bodies()[b];
      now.bodies[b] = {body.tilt, body.peak_stress};
    }
    seen_ = std::min(seen_ + 1, k_kept);
    while (seen_ >= 2 && next() <= last_[k_kept - 2].time + k_least_step) take();
  }
  void finish() {
    while (seen_ > 0 && next() <= last_[k_kept - 1].time + k_least_step) take();
  }

  ordered_json tilt() const { return tilt_; }
  ordered_json stress() const { return stress_; }
  ordered_json balance() const { return balance_; }

 private:
  static constexpr int k_kept = 4;
  struct Seen {
    double tilt = 0, stress = 0;
  };
  struct Step {
    double time = 0, balance = 0;
    std::vector<Seen> bodies;
  };

  double next() const { return interval_ * static_cast<double>(balance_.size()); }

  void take() {
    const double at = next();
    const Step* after = last_ + k_kept - seen_;
    while (after->time < at - k_least_step) ++after;
    for (std::size_t b = 0; b < tilt_.size(); ++b) {
      double tilt = 0;
      for (const Step* i = last_ + k_kept - seen_; i < last_ + k_kept; ++i) {
        double weight = 1;
        for (const Step* j = last_ + k_kept - seen_; j < last_ + k_kept; ++j)
          if (j != i) weight *= (at - j->time) / (i->time - j->time);
        tilt += weight * i->bodies[b].tilt;
      }
      tilt_[b].push_back(std::llround(1e9 * tilt));
      stress_[b].push_back(std::llround(after->bodies[b].stress));
    }
    balance_.push_back(std::round(1e12 * after->balance) / 1e12);
  }

  double interval_;
  Step last_[k_kept];
  int seen_ = 0;
  std::vector<std::vector<long long>> tilt_, stress_;
  std::vector<double> balance_;
};

}  // namespace

std::string run_case(const PrecisionPlan& plan, int k, const std::function<bool()>& give_up) {
  const Setup setup = plan.setup_of(k);
  const int bodies = setup.model.furniture_total();
  ordered_json row;
  bool gave_up = false;
  const double cpu = cpu_time_of([&] {
    if (gave_up) return;
    Sampler sampler(plan, bodies);
    Run run(setup);
    if (run.status().ok()) sampler.see(run);
    while (!run.over() && !gave_up) {
      if (run.advance().ok()) sampler.see(run);
      gave_up = give_up();
    }
    if (gave_up) return;
    sampler.finish();
    row = {{"status", run.status().ok() ? "completed" : run.status().message(setup.model)},
           {"fell", ordered_json::array()},
           {"tilt", sampler.tilt()},
           {"stress", sampler.stress()},
           {"balance", sampler.balance()},
           {"end_s", run.time()},
           {"steps", run.step()}};
    for (int b = 0; b < bodies; ++b) {
      const auto n = static_cast<std::size_t>(b);
      const BodyOutcome& body = run.outcome().bodies()[n];
      row["fell"].push_back(body.beyond_since ? ordered_json(*body.beyond_since) : ordered_json(nullptr));
      if (body.always_rigid) row["stress"][n] = nullptr;
    }
  });
  if (gave_up) return "";
  row["cpu_s"] = cpu;
  return row.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace topple::study
