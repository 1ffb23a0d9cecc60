// How likely bodies lift, slide and overturn, over a measure of the floor's motion.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/study/overturn/motion_measures.h"
#include "solver/study/overturn/overturn_map.h"

namespace topple::study {

/// What may become of a body. A new one is a row of the table in fragility_study.cpp.
struct StateTraits {
  const char *word, *title, *verb;  ///< "overturn", "overturns"
  bool (*is_there)(const BodyEnd& fate, double slide);
};
inline constexpr int k_states = 3;
const std::array<StateTraits, k_states>& damage_states();

/// Runs at each level of the measure, the amplitudes of all shakes times the factor that brings them there.
struct FragilityPlan {
  io::Scene scene;                ///< with the first record, and the files of all
  std::vector<io::Scene> scenes;  ///< one per record
  const MotionMeasure* measure;
  Axis levels;
  FactorPlan factors;
  int runs;                      ///< of each record at each level
  double slide;                  ///< m, from which on a body has slid
  std::vector<std::string> set;  ///< overturn_settings()
  std::vector<double> own;       ///< of each record unscaled, SI
  int chunk;                     ///< runs of a case

  int records() const { return static_cast<int>(scenes.size()); }
  int chunks() const { return (runs + chunk - 1) / chunk; }
  /// (level records() + record) chunks() + chunk
  int cases() const { return levels.count() * records() * chunks(); }
};

/// `levels`: "MEASURE=FROM..TO:N", empty: pga. ensemble.runs: at each level, evenly of each record, rounded
/// up. Throws io::InputError.
FragilityPlan plan_fragility(io::Scene scene, const std::string& levels, const Ensemble& ensemble,
                             double slide);

/// Whether the scene itself is run as planar blocks.
bool is_planar(const FragilityPlan& plan);

nlohmann::ordered_json settings_of(const FragilityPlan& plan);
/// First one case of each level, coarse levels first, then the others.
std::vector<int> case_order(const FragilityPlan& plan);

/// Runs cases one after another.
class FragilityRunner {
 public:
  explicit FragilityRunner(const FragilityPlan& plan) : plan_(&plan) {}
  /// A row of JSON in one line: "runs" (that did not fail), "failed", "planar", "status" (of the first that
  /// failed), "hits" (per piece of furniture, then of any: runs in which it came to each state), "closed"
  /// (per place of the room: runs that left it no way out), "cpu_s". Empty: give_up() came true.
  std::string run(int k, const std::function<bool()>& give_up);

 private:
  struct Place {
    io::Scene scene;
    std::vector<planar::PlanarCase> planar;
  };
  Place& place(int record);

  const FragilityPlan* plan_;
  std::vector<std::optional<Place>> places_;
};

/// Of a body (the last: of any) and a state.
struct FragilityCurve {
  std::vector<Level> levels;  ///< in the axis's unit; of all records
  Fragility fit;              ///< over the measure's intensity
  /// Root of the deviance over its freedom where that is more than chance makes it (0.1 %), else 1: shares
  /// scatter so about the curve, and standard errors are as much greater (quasi-likelihood; P. McCullagh and
  /// J. A. Nelder, Generalized Linear Models, 1989, 4.5).
  double scatter = 1;
  double median = 0;                          ///< of the fit, in the axis's unit
  Interval median_of_runs{}, beta_of_runs{};  ///< 95 % by Fisher's information and the scatter
  /// 95 % of the median and beta when the records are drawn anew from themselves; none with one record, or
  /// where fewer than nine in ten of the draws have a fit.
  std::optional<Interval> median_of_records, beta_of_records;

  /// From the greatest level up to which no run hits to the least from which every run does; none: one is
  /// missing.
  std::optional<Interval> step() const;
  double probability(const FragilityPlan& plan, double value) const;  ///< of the fit, which there is
};

/// What criteria say of a body, in the axis's unit.
struct BodyCriteria {
  std::string why_not;  ///< "": there are
  double west = 0, ishiyama = 0, evaluation = 0;
  double corner = 0;  ///< Hz, of the evaluation
  /// Of the motion, across the edge that it lifts the body from first: the criteria are of that share.
  double share = 1;
  bool along_a_line = true;  ///< the floor moves so; else they are of the nearest edge, the measure of all
};

struct FragilityResults {
  std::vector<std::string> bodies;                           ///< furniture; "any body" behind several
  std::vector<std::array<FragilityCurve, k_states>> curves;  ///< one per name
  std::vector<FragilityCurve> closed;                        ///< one per one of Room::ways(): it is not open
  std::vector<BodyCriteria> criteria;                        ///< one per piece of furniture
  double frequency = 0;                                      ///< Hz, PGA/(2 pi PGV), median of the records
  long runs = 0, of = 0, failed = 0, planar = 0;
  std::string status = "completed";  ///< of the first that failed
  double cpu = 0;                    ///< s
  std::string why_not_planar;        ///< of the scene itself; "": it is
};

/// rows: one per case; empty: not run.
FragilityResults gather(const FragilityPlan& plan, const std::vector<std::string>& rows);

/// One flat object per body, state and level: the content of fragility.csv.
nlohmann::ordered_json rows_as_json(const FragilityPlan& plan, const FragilityResults& results);
/// Curves and criteria by name.
nlohmann::ordered_json curves_as_json(const FragilityPlan& plan, const FragilityResults& results);

}  // namespace topple::study
