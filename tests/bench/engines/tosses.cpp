#include "bench/engines/tosses.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/engines/files.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"
#include "solver/study/validate/toss_study.h"

namespace topple::bench {
namespace {

struct TossTrial {
  const TossSetting* setting;
  study::TossScores scores;
  double cost, cpu;  ///< cost: of contact_grid(); cpu: s per simulated second
};

TossTrial tried(const TossSetting& setting, const std::vector<study::Toss>& tosses, double offset) {
  study::TossOutcomes outcomes;
  double simulated = 0, cost = 0;
  const double cpu = study::cpu_time_of(
      [&] {
        for (const study::Toss& toss : tosses) {
          const std::vector<study::CubePose> rows = setting.run(toss, offset);
          simulated += toss.rows.back().time;
          outcomes.push_back(rows.empty() ? std::nullopt : std::optional(study::errors_of(toss, rows)));
        }
      },
      0);
  for (const auto& one : outcomes)
    cost += one ? std::min(one->position / (2 * study::TossedCube::half_edge) + one->angle, study::k_astray)
                : study::k_astray;
  return {&setting, study::scored_tosses(outcomes), cost / static_cast<double>(tosses.size()),
          cpu / simulated};
}

nlohmann::ordered_json row_of(const TossTrial& t) {
  const study::TossScores& s = t.scores;
  return {{"engine", t.setting->engine},
          {"setting", t.setting->words},
          {"cost", t.cost},
          {"cpu_per_s", t.cpu},
          {"place_m", s.place.median},
          {"place_90_m", s.place.ninetieth},
          {"place_share", s.place_share.median},
          {"face_right", static_cast<double>(s.face_right) / s.tosses},
          {"yaw_deg", s.yaw.median},
          {"rest_s", s.rest.median},
          {"position_m", s.position.median},
          {"position_90_m", s.position.ninetieth},
          {"angle_deg", s.angle.median},
          {"angle_90_deg", s.angle.ninetieth},
          {"failed", s.failed}};
}

void print(const char* title, const std::vector<const TossTrial*>& best) {
  fmt::print(
      "\n{}\n\n| engine | setting | ms CPU per s | place, mm | of travel, % | right face, % | yaw, deg | "
      "rest, "
      "ms | position, mm | angle, deg |\n|---|---|---|---|---|---|---|---|---|---|\n",
      title);
  for (const TossTrial* t : best) {
    const study::TossScores& s = t->scores;
    fmt::print(
        "| {} | {} | {:.2g} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | {:.1f} | {:.1f} / {:.1f} | {:.0f} / {:.0f} "
        "| "
        "{:.1f} / {:.1f} | {:.1f} / {:.1f} |\n",
        t->setting->engine, t->setting->words, 1e3 * t->cpu, 1e3 * s.place.median, 1e3 * s.place.ninetieth,
        1e2 * s.place_share.median, 1e2 * s.place_share.ninetieth, 1e2 * s.face_right / s.tosses,
        s.yaw.median, s.yaw.ninetieth, 1e3 * s.rest.median, 1e3 * s.rest.ninetieth, 1e3 * s.position.median,
        1e3 * s.position.ninetieth, s.angle.median, s.angle.ninetieth);
  }
}

/// The best of each engine, of those that take no more than `most` CPU time.
std::vector<const TossTrial*> best_of(const std::vector<TossTrial>& trials, double most) {
  std::map<std::string, const TossTrial*> best;
  for (const TossTrial& t : trials)
    if (const TossTrial*& one = best[t.setting->engine]; t.cpu <= most && (!one || t.cost < one->cost))
      one = &t;
  std::vector<const TossTrial*> list;
  for (const auto& [engine, trial] : best)
    if (trial) list.push_back(trial);
  return list;
}

std::vector<TossSetting> all_settings() {
  std::vector<TossSetting> all = topple_toss_settings();
  [[maybe_unused]] const auto add = [&all](const std::vector<TossSetting>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
#ifdef WITH_MUJOCO
  add(mujoco_toss_settings());
#endif
#ifdef WITH_BULLET
  add(bullet_toss_settings());
#endif
  return all;
}

}  // namespace

std::vector<TossSetting> topple_toss_settings() {
  std::vector<TossSetting> all;
  for (const double friction : k_toss_frictions)
    for (const double restitution : {0., 0.1, 0.125, 0.2})
      all.push_back(
          {"topple", fmt::format("friction {:g}, restitution {:g}", friction, restitution),
           [=](const study::Toss& toss, double offset) {
             return study::computed_toss(toss, {friction, restitution}, offset, [] { return false; });
           }});
  return all;
}

std::vector<study::CubePose> stepped_toss(const study::Toss& toss, double h,
                                          const std::function<study::CubePose()>& step) {
  std::vector<study::CubePose> rows{toss.rows.front()};
  study::CubePose before = toss.rows.front();
  for (long n = 1; rows.size() < toss.rows.size(); ++n) {
    study::CubePose after = step();
    if (!after.place.allFinite()) return {};
    after.time = static_cast<double>(n) * h;
    while (rows.size() < toss.rows.size() && toss.rows[rows.size()].time <= after.time) {
      const double time = toss.rows[rows.size()].time, part = (time - before.time) / h;
      rows.push_back({time, before.place + part * (after.place - before.place),
                      before.rotation.slerp(part, after.rotation)});
    }
    before = after;
  }
  return rows;
}

void run_tosses(const std::filesystem::path& folder, const std::string& data) {
  const std::vector<study::Toss> tosses = study::read_tosses(data);
  const double offset = study::offset_of(tosses);
  const std::vector<TossSetting> settings = all_settings();
  fmt::print("{} tosses, {} settings, {}, one core\n", tosses.size(), settings.size(),
             study::processor_name());
  std::vector<TossTrial> trials;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const TossSetting& setting : settings) {
    trials.push_back(tried(setting, tosses, offset));
    rows.push_back(row_of(trials.back()));
    fmt::print(stderr, "\r{:3.0f} % ",
               100. * static_cast<double>(trials.size()) / static_cast<double>(settings.size()));
  }
  fmt::print(stderr, "\n");
  write(folder / "tosses.csv", study::csv_text(rows));
  print("The best setting of each engine (median / 90 %)", best_of(trials, 1e9));
  double own = 0;
  for (const TossTrial* one : best_of(trials, 1e9))
    if (one->setting->engine == "topple") own = one->cpu;
  print("The best at no more CPU time than topple's best", best_of(trials, own));
}

}  // namespace topple::bench
