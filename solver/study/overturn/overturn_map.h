// Who overturns, over two keys of a scene.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/io/scene/scene.h"
#include "solver/study/common/axis.h"
#include "solver/study/common/spread.h"
#include "solver/study/overturn/criteria.h"
#include "solver/study/overturn/floor_peak.h"
#include "solver/study/overturn/fragility.h"
#include "solver/study/overturn/varied_run.h"

namespace topple::study {

/// Runs with drawn factors.
struct Ensemble {
  int runs = 1;       ///< 1: nothing is varied
  double spread = 0;  ///< > 0: the amplitude of all shakes evenly within 1 -+ spread, beside `vary`
  std::vector<std::string> vary = {};  ///< plan_factors()
  std::uint64_t seed = 1;
};
/// Throws io::InputError when nothing could be varied.
FactorPlan plan_factors(const Ensemble& ensemble, const io::Scene& scene);

/// What is computed: a run at each point of two axes, or `ensemble` of them with factors that depend on
/// point, member and seed alone.
struct OverturnPlan {
  io::Scene scene;  ///< with the first record
  Axis x, y;
  int ensemble = 1;
  FactorPlan factors = {};
  std::vector<io::Scene> scenes = {};     ///< one per record, which members have in turn
  std::vector<std::string> set = {};      ///< overturn_settings()
  std::optional<Criteria> criteria = {};  ///< for gather(), which finds them where there are none
  int chunk = 1;                          ///< runs of a case, of the same point

  int points() const { return x.count() * y.count(); }
  int chunks() const { return (ensemble + chunk - 1) / chunk; }
  int cases() const { return points() * chunks(); }  ///< point chunks() + chunk
  int runs() const { return points() * ensemble; }
};

/// Axes of --x and --y for a kind of shake that has usual ones.
struct UsualAxes {
  Shake::Kind kind;
  const char *x, *y;
};
/// Those of the first shake; null: there are none.
const UsualAxes* usual_axes(const std::vector<Shake>& shakes);

/// `x`, `y`: as of --x and --y; empty: frequency (of a pulse: duration) and amplitude of the first shake,
/// 24 by 24. Throws io::InputError when the scene is not dynamic, an axis is refused, or there is no shake to
/// perturb.
OverturnPlan plan_overturn(io::Scene scene, const std::string& x, const std::string& y,
                           const Ensemble& ensemble = {});

/// What rows depend on, for KeptRows.
nlohmann::ordered_json settings_of(const OverturnPlan& plan);

/// The order in which cases are begun: one at each point, coarse points first (coarse_to_fine), then rounds
/// over all points that come to 4, 16, 64 ... cases.
std::vector<int> case_order(const OverturnPlan& plan);

/// Runs cases one after another: as planar blocks where planar_cases() finds them, else as `topple run` does.
/// The scene of a point is read once for those that follow each other, or not at all where it is a planar one
/// and the axes change its shakes alone.
class OverturnRunner {
 public:
  explicit OverturnRunner(const OverturnPlan& plan);
  /// A row of JSON in one line: "cpu_s" and "runs", each with "status" ("completed", or why it failed),
  /// "fell" (s, per piece of furniture, null: it stands), "lifted" (a side of any lifted), "open" (per
  /// place with a way out), of planar blocks "planar" (true). Empty: give_up() came true, it is asked after
  /// each step.
  std::string run(int k, const std::function<bool()>& give_up);

 private:
  /// The scene with one of the records, at a point.
  struct Place {
    const io::Scene* of;
    int point = -1;
    std::optional<Setup> own = {};        ///< the scene's; its parameters those of the point by its edits
    std::optional<io::Scene> scene = {};  ///< of the point
    std::string trouble = {};             ///< why there is no scene
    std::vector<planar::PlanarCase> planar = {};  ///< empty: it is not planar
    std::vector<Shake> shakes = {};
    double duration = 0;
  };
  void begin(Place& place, int point) const;
  void read(Place& place) const;
  const io::Scene& scene_at(Place& place) const;

  const OverturnPlan* plan_;
  std::vector<Place> places_;
};

/// The scene with what runs have besides.
io::Scene scene_of_runs(const OverturnPlan& plan);

/// Its shakes with these values of the axes, SI, by edits; none where the axes change something else, or when
/// a shake begins.
std::optional<std::vector<Shake>> edited_shakes(const OverturnPlan& plan, const Setup& own, double x,
                                                double y);

/// Why the scene itself is not run as planar blocks; empty: it is.
std::string why_not_planar(const OverturnPlan& plan);

/// From the worst to the best that is known.
enum class Verdict { not_computed, failed, all, some, rocks, stands };
/// "all overturn".
const char* name(Verdict verdict);

/// What became of the runs at one point.
struct OverturnPoint {
  Verdict verdict = Verdict::not_computed;  ///< of most runs that ended, the worse of two; failed: all did
  int runs = 0, failed = 0;                 ///< that ended, without and with failure
  int overturned = 0;                       ///< runs in which a body overturned
  std::vector<int> fell;                    ///< per piece of furniture: runs in which it did
  std::vector<int> open;                    ///< per place: runs after which a way leads to a door
  std::vector<double> times;                ///< s, of the first overturning in each such run, ascending
  std::string status = "not run";           ///< "completed", or why the first that failed did
  double cpu = 0;                           ///< s

  /// Of the runs that did not fail; none without one.
  std::optional<double> probability() const;
  std::optional<Interval> interval() const;
  /// Quantile of the times, part = 0..1; none without times.
  std::optional<double> time(double part) const;
};

struct OverturnMap {
  std::vector<std::string> bodies;  ///< furniture
  std::vector<std::string> ways;    ///< places whose way out is looked at
  std::vector<OverturnPoint> points;
  int run = 0, of = 0;  ///< runs
  int planar = 0;       ///< runs that were planar blocks
  Criteria criteria;
  /// Along the axis that is an amplitude or scale of a shake, at each value of the other.
  std::vector<Fragility> fragility;
  bool fragility_along_y = true;
  /// Where on the other axis the scene's own value is nearest; the middle without one.
  int own_column = 0;
};

/// rows: one per case; empty: not run.
OverturnMap gather(const OverturnPlan& plan, const std::vector<std::string>& rows);

/// Runs at the values of the intensity axis, at place k of the other one.
std::vector<Level> levels(const OverturnPlan& plan, const OverturnMap& map, int k);

/// How strong the floor shakes at those values, without the spread of an ensemble; empty: an axis changes the
/// shake by a key that no edit has.
std::vector<FloorPeak> floor_peaks(const OverturnPlan& plan, const OverturnMap& map, int k);

/// Intensities that fragility is told over besides the axis's own.
struct GroundMeasure {
  const char *name, *title, *unit;  ///< "pga", "peak horizontal acceleration of the floor", "gal"
  double FloorPeak::*value;
  double si;  ///< value of one unit
};
inline constexpr GroundMeasure k_ground_measures[] = {
    {"pga", "peak horizontal acceleration of the floor", "gal", &FloorPeak::acceleration, k_gal},
    {"pgv", "peak horizontal velocity of the floor", "cm/s", &FloorPeak::velocity, 0.01}};

/// `levels` with a measure of the floor's motion, in its unit, as their intensity.
std::vector<Level> levels_over(const GroundMeasure& measure, std::vector<Level> levels,
                               const std::vector<FloorPeak>& peaks);

/// The points as a list of flat objects: the content of overturn.csv.
nlohmann::ordered_json rows_as_json(const OverturnPlan& plan, const OverturnMap& map);

/// Axes, arrays over them (rows by y, columns by x), curves and fragility, by name.
nlohmann::ordered_json map_as_json(const OverturnPlan& plan, const OverturnMap& map);

}  // namespace topple::study
