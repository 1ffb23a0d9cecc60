// Where a map's neighbours disagree, a probability says more than a verdict.
#pragma once

#include <functional>
#include <optional>

#include "solver/study/overturn/overturn_map.h"

namespace topple::study {

/// Runs within the cell of a point.
struct CellShare {
  int runs = 0, overturned = 0;  ///< overturned: runs in which a body did

  double probability() const { return static_cast<double>(overturned) / runs; }
};

/// Whether of a point and those around it, of a map with one run a point, some overturn and some do not.
bool neighbours_disagree(const OverturnPlan& plan, const OverturnMap& map, int point);

/// Planar runs with the values of both axes drawn evenly from the point's cell (on logarithmic axes in their
/// logarithm). None: the scene is no planar one, the axes change more than its shakes, a run left what planar
/// blocks know, or give_up() came true.
class CellRuns {
 public:
  explicit CellRuns(const OverturnPlan& plan);
  std::optional<CellShare> run(int point, int runs, const std::function<bool()>& give_up) const;

 private:
  const OverturnPlan* plan_;
  Setup own_;
  std::vector<planar::PlanarCase> planar_;
};

}  // namespace topple::study
