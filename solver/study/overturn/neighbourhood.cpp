#include "solver/study/overturn/neighbourhood.h"

#include <algorithm>
#include <cmath>

#include "solver/math/elementary.h"
#include "solver/study/common/low_discrepancy.h"

namespace topple::study {
namespace {

/// SI; part: 0..1 of the cell.
double within_cell(const Axis& axis, int place, double part) {
  const std::vector<double> edges = axis.edges();
  const double low = edges[static_cast<std::size_t>(place)],
               high = edges[static_cast<std::size_t>(place) + 1];
  return axis.si * (axis.logarithmic ? low * elementary::pow(high / low, part) : low + part * (high - low));
}

}  // namespace

bool neighbours_disagree(const OverturnPlan& plan, const OverturnMap& map, int point) {
  const int nx = plan.x.count(), ny = plan.y.count(), i = point % nx, j = point / nx;
  bool some = false, none = false;
  for (int b = std::max(0, j - 1); b <= std::min(ny - 1, j + 1); ++b)
    for (int a = std::max(0, i - 1); a <= std::min(nx - 1, i + 1); ++a) {
      const OverturnPoint& at = map.points[static_cast<std::size_t>(b * nx + a)];
      some |= at.overturned > 0;
      none |= at.runs > at.overturned;
    }
  return some && none;
}

CellRuns::CellRuns(const OverturnPlan& plan)
    : plan_(&plan), own_(scene_of_runs(plan).setup), planar_(planar_cases(own_)) {}

std::optional<CellShare> CellRuns::run(int point, int runs, const std::function<bool()>& give_up) const {
  if (planar_.empty()) return std::nullopt;
  const int nx = plan_->x.count();
  std::vector<PlanarMember> members;
  for (int n = 0; n < runs; ++n) {
    const auto part = [&](int dimension) {
      return shifted_sobol(static_cast<std::uint64_t>(point), static_cast<std::uint32_t>(n), dimension);
    };
    std::optional<std::vector<Shake>> shakes = edited_shakes(
        *plan_, own_, within_cell(plan_->x, point % nx, part(0)), within_cell(plan_->y, point / nx, part(1)));
    if (!shakes) return std::nullopt;
    members.push_back({planar_, *std::move(shakes), own_.run.duration});
  }
  CellShare share;
  for (const auto& of_bodies : run_planar(members, give_up)) {
    if (!of_bodies) return std::nullopt;
    ++share.runs;
    share.overturned +=
        std::ranges::any_of(*of_bodies, [](const BodyEnd& fate) { return fate.fell.has_value(); });
  }
  return share;
}

}  // namespace topple::study
