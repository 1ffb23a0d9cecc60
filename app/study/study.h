// The studies of `topple study`, each a row of one table.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/study/broadcast_scene.h"
#include "app/study/study_options.h"
#include "app/study/sweep.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/chart.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::app {

/// What a study found out.
struct Findings {
  using Json = nlohmann::ordered_json;
  std::string title;
  Json units = Json::object(), settings = Json::object();  ///< besides those that every study has
  Json entries = Json::object();                           ///< the rest of its JSON; "rows" is its table
  /// gnuplot script. `origin`: version and machine.
  std::function<std::string(const std::string& origin, study::ChartFormat format)> chart;
  std::string text = {};                     ///< for a person
  int run = 0, of = 0;                       ///< of a study that is no sweep
  std::string each = {};                     ///< what each run of a sweep is: " of 0.3 s"
  std::string pace = {};                     ///< behind its runs per second
  std::shared_ptr<const void> results = {};  ///< what `chart` reads
};

/// The cases of a study, as they are worked off one by one, resumed, and shared among ranks.
struct Sweep {
  std::function<SweepPlan()> cases;  ///< but for label, stem and start
  std::function<Findings(const std::vector<std::string>& rows)> gather;
  /// What rank 0 finds out before the cases, and how the others receive it. Absent: nothing.
  std::function<std::string()> prepare = {};
  std::function<void(const std::string& prepared)> receive = {};
};

/// A study that is not shared among ranks. go_on(done, of) as for_each_case (parallel.h).
using Solve = std::function<Findings(const std::function<bool(int done, int of)>& go_on)>;

struct Study {
  const char *name, *about;
  const char *x = nullptr, *y = nullptr;  ///< its usual axes, in words; null: it has none
  bool takes_scene = true, takes_ensemble = false, takes_slide = false;
  int usual_runs = 1;                   ///< of an ensemble without --ensemble
  bool timed = false;                   ///< CPU times count: one run at a time unless more are asked for
  const char* runs = "runs";            ///< what is counted of a study that is no sweep
  const char* left_out = "the finest";  ///< by --quick
  // One of the two. They throw io::InputError or BadInput on what cannot be studied.
  Sweep (*sweep)(io::Scene scene, const StudyOptions& options) = nullptr;
  Solve (*solve)(io::Scene scene, const StudyOptions& options) = nullptr;
};

// In NAME_study.cpp.
extern const Study k_overturn_study, k_fragility_study, k_stability_study, k_precision_study,
    k_elements_study, k_penalty_study;
/// Of the options of a study that takes one.
study::Ensemble ensemble_of(const Study& study, const StudyOptions& options);

/// In the order of --help.
inline constexpr const Study* k_studies[] = {&k_overturn_study,  &k_fragility_study, &k_stability_study,
                                             &k_precision_study, &k_elements_study,  &k_penalty_study};

/// The sweep of a plan with settings_of(), case_order() and gather(), of which `find` makes findings; `unit`:
/// what its cases are.
template <class Plan, class Results>
Sweep sweep_of(const std::shared_ptr<Plan>& plan, const MakeWork& make,
               Findings (*find)(const Plan& plan, const Results& results), const char* unit = "runs") {
  return {.cases =
              [plan, make, unit] {
                return SweepPlan{.unit = unit,
                                 .settings = settings_of(*plan),
                                 .order = case_order(*plan),
                                 .broadcast = broadcast_parts(plan->scene),
                                 .make = make};
              },
          .gather =
              [plan, find](const std::vector<std::string>& rows) {
                const auto results = std::make_shared<const Results>(gather(*plan, rows));
                Findings findings = find(*plan, *results);
                findings.results = results;
                return findings;
              }};
}

}  // namespace topple::app
