// Where time integration fails over two keys of a scene.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"
#include "solver/study/common/axis.h"

namespace topple::study {

/// Energy over the largest exchanged so far: what may appear or vanish unexplained, and what the integrator
/// may dissipate. What the integrator gives is judged as what appears.
inline constexpr double k_stable_balance = 0.01, k_stable_damping = 0.1;
/// Depth 1 - l/L beyond that of the reference from which on a run went through a floor, if it is above 1 too.
inline constexpr double k_through = 0.5;
/// Relative change of the amplitudes in two of the reference runs; s that are run after the last body
/// overturned.
inline constexpr double k_reference_spread = 0.02, k_after_fall = 1;

/// A way to step a scene.
struct SteppingMethod {
  std::string name;                                       ///< "newmark-5/6"; "scene": as the scene has it
  std::string label;                                      ///< "Newmark, β = 4/9, γ = 5/6"
  Integrator integrator = Integrator::generalized_alpha;  ///< with every body a frame; not of "scene"
  double beta = 0.25, gamma = 0.5, spectral_radius = Parameters{}.spectral_radius;

  bool of_scene() const { return name == "scene"; }
};

/// A run with each method at each point of two axes, and runs that tell what is right. These do not depend on
/// run.time_step and run.tolerance: the points that differ in nothing else make a group.
struct StabilityPlan {
  io::Scene scene;
  Axis x, y;
  std::vector<SteppingMethod> methods;
  double horizon =
      0;  ///< s, length of the runs: that of the scene, or until everything that falls has fallen

  int points() const { return x.count() * y.count(); }
  int groups() const;
  int group(int point) const;
  /// Reference runs of each group: a quarter of the step and a hundredth of the tolerance; half and a tenth;
  /// with shakes two more as the first, amplitudes times 1 -+ k_reference_spread.
  int references() const;
  /// First those of the groups, then point methods + method.
  int cases() const { return groups() * references() + points() * static_cast<int>(methods.size()); }
};

/// `x`, `y`: as of --x and --y; empty: run.time_step and contact.alpha. The horizon is left at 0. Throws
/// io::InputError when the scene is not dynamic, or an axis is refused.
StabilityPlan plan_stability(io::Scene scene, const std::string& x, const std::string& y);

/// Runs the scene as it is: the horizon. It is that of the scene where nothing overturns or the run fails.
/// give_up() is asked after each step.
double find_horizon(const Setup& scene, const std::function<bool()>& give_up);

/// What rows depend on, for KeptRows.
nlohmann::ordered_json settings_of(const StabilityPlan& plan);

/// The groups first, then the points, coarse ones first.
std::vector<int> case_order(const StabilityPlan& plan);

/// The scene with KEY=VALUE changes as the method steps it. Throws io::InputError when there is none.
Setup stepped_by(const StabilityPlan& plan, const SteppingMethod& method,
                 const std::vector<std::string>& changes);

/// Runs case k: a row of JSON in one line. Empty: give_up() came true.
std::string run_case(const StabilityPlan& plan, int k, const std::function<bool()>& give_up);

/// How a run ended, and what is judged.
struct StabilityRun {
  /// refused: central differences above their limit. growth: not finite, or a step lost count of its energy.
  enum class End { completed, not_set_up, not_settled, refused, no_solution, growth, passed_through };
  End end = End::completed;
  std::string message = "completed";  ///< else why not
  double time = 0;                    ///< s, reached
  std::vector<bool> fell;             ///< per piece of furniture: overturned
  double unexplained = 0;             ///< energy, over the largest exchanged; above 0: it appeared
  double numerical = 0;               ///< likewise, that the integrator took; below 0: gave
  double penetration = 0;             ///< greatest 1 - l/L at floors and walls
  std::int64_t steps = 0, rejected = 0;
  double cpu = 0;  ///< s
};

/// What the runs of a group agree on.
struct Agreement {
  bool decided = false;
  std::string why_not = "not all reference runs were done";  ///< "": it is decided
  std::vector<bool> fell = {};                               ///< of the finest run
  double penetration = 0;                                    ///< the greatest of them
};
/// Decided where all completed, none left more than k_stable_balance unexplained, and the same bodies
/// overturned in all.
Agreement agree(const std::vector<StabilityRun>& runs);

/// From the worst to the best that is known.
enum class Fate {
  not_computed,
  failed,
  refused,
  no_solution,
  grows,
  tunnels,
  wrong,
  loses,
  undecided,
  stable
};
inline constexpr int k_fates = static_cast<int>(Fate::stable) + 1;
/// "energy grows".
const char* name(Fate fate);
/// The first of these that holds.
Fate judge(const StabilityRun& run, const Agreement& reference);

struct StabilityMap {
  std::vector<std::string> bodies;  ///< furniture
  struct Cell {
    std::optional<StabilityRun> run;
    Fate fate = Fate::not_computed;
  };
  std::vector<std::vector<Cell>> cells;  ///< per method, per point
  std::vector<Agreement> references;     ///< per group
  int run = 0, of = 0;                   ///< cases

  int count(std::size_t method, Fate fate) const;
};

/// rows: one per case; empty: not run.
StabilityMap gather(const StabilityPlan& plan, const std::vector<std::string>& rows);

/// One flat object for each method and point: the content of stability.csv.
nlohmann::ordered_json rows_as_json(const StabilityPlan& plan, const StabilityMap& map);

/// Axes, methods with arrays over the axes (rows by y, columns by x), references, by name.
nlohmann::ordered_json map_as_json(const StabilityPlan& plan, const StabilityMap& map);

}  // namespace topple::study
