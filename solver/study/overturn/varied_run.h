// One run of an ensemble.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solver/study/overturn/factors.h"
#include "solver/study/overturn/planar_runs.h"

namespace topple::study {

/// What came out of a run.
struct RunEnd {
  std::string status = "completed";     ///< or why it failed
  std::vector<BodyEnd> of_bodies = {};  ///< per piece of furniture; empty where it failed
  std::vector<bool> open = {};          ///< per one of Room::ways()
  bool planar = false;                  ///< as planar blocks, else with the rigid model
  bool gave_up = false;                 ///< give_up() came true
};

/// What a run begins with, before anything is varied.
struct RunStart {
  const std::vector<planar::PlanarCase>& planar;  ///< empty: no planar blocks
  const std::vector<Shake>& shakes;
  double duration;  ///< s
  std::function<const io::Scene&()>
      scene;  ///< for the rigid model; throws io::InputError where there is none
};

/// A run that is to be done.
struct VariedMember {
  const RunStart* start;
  std::vector<double> values;  ///< of the factors, as drawn
};

/// As planar blocks where there are some (in lanes), else, or where it is not known what they do, as `topple
/// run` does. give_up is asked as they go on, once it is true no run comes to its end.
std::vector<RunEnd> run_varied(const std::vector<VariedMember>& members, const FactorPlan& plan,
                               const std::function<bool()>& give_up);

/// What studies of overturning leave to no scene: [run] has these where the scene says nothing.
std::vector<std::string> overturn_settings(const io::Scene& scene);

}  // namespace topple::study
