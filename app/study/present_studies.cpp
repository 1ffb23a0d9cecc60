#include "app/study/present_studies.h"

#include <algorithm>
#include <utility>

#include "app/study/study_results.h"
#include "app/support/clock.h"
#include "solver/io/edit/scene_save.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/parallel.h"

namespace topple::app {
namespace {

using StudyRows = std::vector<std::string>;

constexpr double k_between = 0.3;  // s, from one result shown to the next

io::Scene changed_scene(const io::Scene& scene, const Parameters& now) {
  io::Scene changed = io::parse_scene(io::edited_scene(scene, now).text, scene.name, {}, io::files_of(scene));
  changed.name = scene.name;
  return changed;
}

/// Works through the cases in this order; `gather` makes of the rows what is shown.
template <class Found>
void work_through(Background<Found>& background, const std::vector<int>& order, int jobs,
                  const MakeWork& make, const std::function<bool()>& give_up,
                  const std::function<Found(const StudyRows&)>& gather) {
  std::vector<CaseWork> works;
  works.reserve(static_cast<std::size_t>(jobs));
  for (int worker = 0; worker < jobs; ++worker) works.push_back(make());
  StudyRows rows(order.size());
  std::mutex keeping;
  background.show(gather(rows));
  Clock::time_point shown = Clock::now();
  study::for_each_case(
      static_cast<int>(order.size()), jobs,
      [&](int n, int worker) {
        const int k = order[static_cast<std::size_t>(n)];
        std::string row = works[static_cast<std::size_t>(worker)](k, give_up);
        const std::lock_guard lock(keeping);
        rows[static_cast<std::size_t>(k)] = std::move(row);
      },
      [&](int done) {
        background.report_progress(static_cast<double>(done) / static_cast<double>(order.size()));
        if (seconds_since(shown) > k_between) {
          const std::lock_guard lock(keeping);
          background.show(gather(rows));
          shown = Clock::now();
        }
        return !give_up();
      });
  background.show(gather(rows));
}

template <class Found>
std::unique_ptr<Background<Found>> search(const std::function<void(Background<Found>&)>& work) {
  return std::make_unique<Background<Found>>([work](Background<Found>& background) {
    try {
      work(background);
    } catch (const std::exception& error) {
      background.show({.failure = error.what()});
    }
  });
}

}  // namespace

MakeWork work_on(const study::OverturnPlan& plan) {
  return [&plan] {
    return [runner = study::OverturnRunner(plan)](int k, const std::function<bool()>& give_up) mutable {
      return runner.run(k, give_up);
    };
  };
}

namespace {

constexpr int k_cell_runs = 24;

void search_cells(OverturnSearch& background, OverturnFound found) {
  const study::CellRuns cells(*found.plan);
  found.shares.resize(found.map.points.size());
  const auto stopped = [&] { return background.stopped(); };
  for (int point = 0; point < found.plan->points() && !stopped(); ++point)
    if (neighbours_disagree(*found.plan, found.map, point))
      found.shares[static_cast<std::size_t>(point)] = cells.run(point, k_cell_runs, stopped);
  background.show(std::move(found));
}

}  // namespace

std::unique_ptr<OverturnSearch> search_overturning(const io::Scene& scene, const Parameters& now,
                                                   bool planar_only) {
  return search<OverturnFound>([scene, now, planar_only](OverturnSearch& background) {
    const auto plan =
        std::make_shared<study::OverturnPlan>(study::plan_overturn(changed_scene(scene, now), "", ""));
    const std::string why = why_not_planar(*plan);
    if (planar_only && !why.empty()) return background.show({.failure = why});
    const Setup& setup = plan->scene.setup;
    // of planar blocks the cells come first: they take less time than the lines
    plan->criteria = why.empty() ? study::Criteria() : criteria(setup, plan->x, plan->y);
    const int jobs = std::max(1, study::core_count() - 1);  // one is for what the window shows
    study::OverturnMap map;
    work_through<OverturnFound>(
        background, case_order(*plan), jobs, work_on(*plan), [&] { return background.stopped(); },
        [&](const StudyRows& rows) {
          map = gather(*plan, rows);
          return OverturnFound{.failure = "", .plan = plan, .map = map};
        });
    if (background.stopped() || !why.empty()) return;
    map.criteria = criteria(setup, plan->x, plan->y);
    background.show({.failure = "", .plan = plan, .map = map});
    if (map.planar == map.of) search_cells(background, {.failure = "", .plan = plan, .map = std::move(map)});
  });
}

std::unique_ptr<PrecisionSearch> search_precision(const io::Scene& scene, const Parameters& now) {
  return search<PrecisionFound>([scene, now](PrecisionSearch& background) {
    const auto start = Clock::now();
    study::PrecisionPlan own = study::plan_precision(changed_scene(scene, now));
    own.laws.resize(1);
    std::erase_if(own.list, [](const auto& one) { return one.law != 0; });
    const auto plan = std::make_shared<const study::PrecisionPlan>(std::move(own));
    std::vector<Parameters> parameters;
    parameters.reserve(static_cast<std::size_t>(plan->cases()));
    for (int k = 0; k < plan->cases(); ++k) parameters.push_back(plan->setup_of(k).parameters);
    work_through<PrecisionFound>(
        background, case_order(*plan), 1, work_on(*plan),
        [&] { return background.stopped() || seconds_since(start) > k_quick; },
        [&](const StudyRows& rows) {
          return PrecisionFound{
              .failure = "", .plan = plan, .parameters = parameters, .study = gather(*plan, rows)};
        });
  });
}

bool parameters_differ(const Model& model, const Parameters& a, const Parameters& b,
                       const std::function<bool(Edit::Key key, int index)>& of_study) {
  const auto keys = editable(model, a);
  return keys != editable(model, b) || std::ranges::any_of(keys, [&](const auto& entry) {
           const auto& [key, index] = entry;
           return edited_value(a, key, index) != edited_value(b, key, index) && !of_study(key, index);
         });
}

}  // namespace topple::app
