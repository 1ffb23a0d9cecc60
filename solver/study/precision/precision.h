// Error against cost: a scene at every integrator, step and model, for contact laws and penalty coefficients.
//
// Every law and alpha is physics of its own, and so has a reference of its own: errors are those of the
// computation, what a law or alpha changes is shown beside them. The reference is the frame, all nodes free,
// with central differences at the finest step, checked by generalized-alpha at its finest. Bodies that rock
// forget how they started after some impacts; so errors are those of a window, which ends where the tilts of
// the two references part by more than k_parted.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"

namespace topple::study {

/// How motion is computed. `scene`: as the scene says.
enum class Method {
  scene,
  rigid,
  rigid_auto,
  elastic,
  elastic_auto,
  generalized_alpha,
  generalized_alpha_auto,
  newmark,
  newmark_damped,
  central_difference
};
inline constexpr int k_methods = 10;

/// What a Method stands for.
struct MethodMeaning {
  Method kind;
  const char* name;   ///< "frame newmark"
  const char* about;  ///< "frame, Newmark 1/4, 1/2": in a chart
  BodyModel model;    ///< of bodies that can be
  Integrator integrator;
  bool adaptive;
  double step_cost;                 ///< of a step, in steps of a rigid body
  double beta = 0.25, gamma = 0.5;  ///< of newmark
};
const MethodMeaning& meaning(Method method);

/// A method at one step or tolerance.
struct Setting {
  Method method = Method::scene;
  double step = 0;       ///< s; adaptive: 0
  double tolerance = 0;  ///< adaptive: > 0
};

inline constexpr double k_alpha_factors[] = {1, 5, 25};
inline constexpr double k_levels[] = {1e-2, 1e-3, 1e-4};  ///< errors of which the cheapest setting is named
/// Part of the critical angle by which the tilts of the two references may differ within the window.
inline constexpr double k_parted = 1e-4;
inline constexpr double k_own_law = 60, k_other_law = 8;  ///< s, CPU time that a run may be expected to take

struct PrecisionPlan {
  io::Scene scene;                ///< bodies that can be elastic have their basis
  std::vector<ContactLaw> laws;   ///< the scene's own first
  std::vector<Setting> settings;  ///< the scene's own first
  double interval = 0;            ///< s, between instants at which runs are compared
  struct Case {
    int law, setting;
  };
  std::vector<Case> list;  ///< by law, the scene's own setting first of each

  int cases() const { return static_cast<int>(list.size()); }
  int law_of(int k) const { return list[static_cast<std::size_t>(k)].law; }
  const Setting& setting_of(int k) const {
    return settings[static_cast<std::size_t>(list[static_cast<std::size_t>(k)].setting)];
  }
  Setup setup_of(int k) const;
};

/// Settings whose runs could take more than k_own_law, with other laws k_other_law, are left out. Throws
/// io::InputError when the scene is not dynamic or has no furniture.
PrecisionPlan plan_precision(io::Scene scene);

/// What rows depend on, for KeptRows.
nlohmann::ordered_json settings_of(const PrecisionPlan& plan);

/// The order in which cases are begun: the scene's own law and alpha first, the cheapest first of each.
std::vector<int> case_order(const PrecisionPlan& plan);

/// Runs one case: a row of JSON in one line. "status" ("completed", or why it failed), "fell" (s, per piece
/// of furniture, null: it stands), then at multiples of the interval, as long as the run lasts, "tilt" (1e-9
/// rad) and "stress" (Pa, greatest so far; null: always rigid) per piece of furniture, "balance" (error of
/// the energy balance); "end_s", "steps" and "cpu_s", of the solving thread for the whole run, the fastest of
/// repeated ones. Empty: give_up() came true, it is asked after each step.
std::string run_case(const PrecisionPlan& plan, int k, const std::function<bool()>& give_up);

/// What errors are of. tilt: root mean square over the window, over the body's least critical angle.
/// overturn_time, peak_stress: relative, within the window. energy: the error of the balance at the window's
/// end. Of several bodies the greatest. A run that completed before the window's end is compared up to its
/// own.
enum class Measure { tilt, overturn_time, peak_stress, energy };
inline constexpr int k_measures = 4;
/// Without: the measure does not exist, or the run is not comparable.
using Errors = std::array<std::optional<double>, k_measures>;
inline std::size_t index(Measure measure) {
  return static_cast<std::size_t>(measure);
}
/// "tilt", "overturn time", "peak stress", "energy".
const char* name(Measure measure);

/// What runs of one law and alpha are compared with.
struct Reference {
  std::string why_not;                      ///< there is none; empty: there is
  int run = -1, check = -1;                 ///< cases
  double window = 0, end = 0;               ///< s; of the comparison, and of the run
  Errors uncertainty;                       ///< how far the check is off: smaller errors say nothing
  std::optional<double> order;              ///< of convergence of the tilt, observed with the steps of `run`
  std::vector<std::optional<double>> fell;  ///< s, per piece of furniture, within the run
  std::vector<double> peak_tilt;            ///< rad, per piece of furniture, in the window
};

struct PrecisionRow {
  std::string status = "not run";
  std::optional<double> cost;  ///< CPU seconds per simulated second; none: it failed
  std::optional<double> end;   ///< s
  long steps = 0;
  bool same_verdict = true;  ///< the same bodies overturn within the window
  Errors errors;
};

/// The scene's own setting beside others that answer as much: where it gives stresses, those that do.
struct DefaultPlace {
  double cost_ratio = 1;   ///< its cost over that of the cheapest setting that is no less exact
  double error_ratio = 1;  ///< its error over that of the most exact setting that costs no more
};

struct PrecisionStudy {
  std::vector<PrecisionRow> rows;     ///< per case
  std::vector<Reference> references;  ///< per law
  int run = 0, of = 0;
};

/// rows: one per case; empty: not run.
PrecisionStudy gather(const PrecisionPlan& plan, const std::vector<std::string>& rows);

/// Cases on the Pareto front of a law, by rising cost; errors below the reference's uncertainty count as
/// that.
std::vector<int> front(const PrecisionPlan& plan, const PrecisionStudy& study, int law, Measure measure);

/// The cheapest case of a law within an error; none: no setting is, or the reference cannot tell.
std::optional<int> cheapest(const PrecisionPlan& plan, const PrecisionStudy& study, int law, Measure measure,
                            double error);

/// None: it has no error.
std::optional<DefaultPlace> place_of_default(const PrecisionPlan& plan, const PrecisionStudy& study,
                                             Measure measure);

/// "elastic, 1 ms", "rigid, tolerance 0.001".
std::string in_words(const PrecisionPlan& plan, int k);
/// "coulomb, 50 kgf".
std::string in_words(const ContactLaw& law);

/// Cases as a list of flat objects: the content of precision.csv. Of timing is the last column alone.
nlohmann::ordered_json rows_as_json(const PrecisionPlan& plan, const PrecisionStudy& study);
/// References, fronts and cheapest settings, by name.
nlohmann::ordered_json findings_as_json(const PrecisionPlan& plan, const PrecisionStudy& study);

}  // namespace topple::study
