#include "bench/engines/tosses.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/engines/files.h"
#include "solver/study/common/axis.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"
#include "solver/study/validate/toss_study.h"

namespace topple::bench {
namespace {

constexpr const char* k_own = "topple";

struct TossTrial {
  const TossSetting* setting;
  study::TossOutcomes outcomes;
  double cpu;  ///< s per simulated second
};

TossTrial tried(const TossSetting& setting, const std::vector<study::Toss>& tosses, double offset) {
  TossTrial trial{&setting, {}, 0};
  double simulated = 0;
  trial.cpu = study::cpu_time_of(
      [&] {
        for (const study::Toss& toss : tosses) {
          const std::vector<study::CubePose> rows = setting.run(toss, offset);
          simulated += toss.rows.back().time;
          trial.outcomes.push_back(rows.empty() ? std::nullopt : std::optional(study::errors_of(toss, rows)));
        }
      },
      0);
  trial.cpu /= simulated;
  return trial;
}

/// A row of the comparison; of all less is better.
struct Row {
  const char *name, *key;
  double (*of)(const study::TossScores&);  ///< in the unit that it is printed in
};
constexpr Row k_rows[] = {
    {"place, mm", "place_mm", [](const auto& s) { return 1e3 * s.place.median; }},
    {"place, 90 %", "place_90_mm", [](const auto& s) { return 1e3 * s.place.ninetieth; }},
    {"of travel, %", "travel_percent", [](const auto& s) { return 1e2 * s.place_share.median; }},
    {"of travel, 90 %", "travel_90_percent", [](const auto& s) { return 1e2 * s.place_share.ninetieth; }},
    {"wrong face, %", "wrong_face_percent",
     [](const auto& s) { return 1e2 - 1e2 * s.face_right / s.tosses; }},
    {"yaw, deg", "yaw_deg", [](const auto& s) { return s.yaw.median; }},
    {"yaw, 90 %", "yaw_90_deg", [](const auto& s) { return s.yaw.ninetieth; }},
    {"time to rest, ms", "rest_ms", [](const auto& s) { return 1e3 * s.rest.median; }},
    {"time to rest, 90 %", "rest_90_ms", [](const auto& s) { return 1e3 * s.rest.ninetieth; }},
    {"position, mm", "position_mm", [](const auto& s) { return 1e3 * s.position.median; }},
    {"position, 90 %", "position_90_mm", [](const auto& s) { return 1e3 * s.position.ninetieth; }},
    {"angle, deg", "angle_deg", [](const auto& s) { return s.angle.median; }},
    {"angle, 90 %", "angle_90_deg", [](const auto& s) { return s.angle.ninetieth; }}};

nlohmann::ordered_json row_of(const TossTrial& t) {
  const study::TossScores scores = study::scored_tosses(t.outcomes);
  nlohmann::ordered_json row{
      {"engine", t.setting->engine}, {"setting", t.setting->words}, {"cpu_per_s", t.cpu}};
  for (const Row& one : k_rows) row[one.key] = one.of(scores);
  row["failed"] = scores.failed;
  return row;
}

/// An engine within a cost: each toss under the setting that is best on the other nine tenths of them, as
/// topple validate does it.
struct Entrant {
  std::string engine, words;  ///< words: of the setting that is best on all
  double cpu = 0;             ///< of that
  study::TossOutcomes outcomes;
};

/// Of those that take no more than `most` CPU time.
std::vector<Entrant> entrants(const std::vector<TossTrial>& trials, double most) {
  std::map<std::string, std::vector<const TossTrial*>> by_engine;
  for (const TossTrial& t : trials)
    if (t.cpu <= most) by_engine[t.setting->engine].push_back(&t);
  std::vector<Entrant> list;
  for (const auto& [engine, of] : by_engine) {
    std::vector<study::TossOutcomes> grid;
    for (const TossTrial* t : of) grid.push_back(t->outcomes);
    const TossTrial& best = *of[study::best_contact(grid, std::vector<double>(grid.front().size(), 1))];
    list.push_back({engine, best.setting->words, best.cpu, study::cross_validated(grid)});
  }
  std::ranges::stable_partition(list, [](const Entrant& one) { return one.engine == k_own; });
  return list;
}

study::TossOutcomes drawn(const study::TossOutcomes& from, std::uint64_t draw) {
  study::TossOutcomes out;
  for (std::uint64_t i = 0; i < from.size(); ++i)
    out.push_back(
        from[static_cast<std::size_t>(study::scattered(draw, i) * static_cast<double>(from.size()))]);
  return out;
}

/// Of an engine's row less topple's, 95 % by drawing tosses anew, the same for both (Efron 1979).
std::vector<study::Interval> differences(const Entrant& own, const Entrant& other) {
  constexpr std::uint64_t k_draws = 1000;
  std::vector<std::vector<double>> values(std::size(k_rows));
  for (std::uint64_t n = 0; n < k_draws; ++n) {
    const study::TossScores a = study::scored_tosses(drawn(own.outcomes, n)),
                            b = study::scored_tosses(drawn(other.outcomes, n));
    for (std::size_t r = 0; r < values.size(); ++r) values[r].push_back(k_rows[r].of(b) - k_rows[r].of(a));
  }
  std::vector<study::Interval> out;
  for (std::vector<double>& row : values) {
    std::ranges::sort(row);
    out.push_back({row[k_draws / 40], row[k_draws - 1 - k_draws / 40]});
  }
  return out;
}

void print(const std::string& title, const std::vector<Entrant>& list) {
  fmt::print("\n{}\n\n| |", title);
  for (const Entrant& one : list)
    fmt::print(" {} ({}; {:.2g} ms CPU per s) |", one.engine, one.words, 1e3 * one.cpu);
  fmt::print("\n|---|");
  std::vector<study::TossScores> scores;
  std::vector<std::vector<study::Interval>> beside;
  for (const Entrant& one : list) {
    fmt::print("---|");
    scores.push_back(study::scored_tosses(one.outcomes));
    beside.push_back(differences(list.front(), one));
  }
  for (std::size_t r = 0; r < std::size(k_rows); ++r) {
    fmt::print("\n| {} |", k_rows[r].name);
    for (std::size_t k = 0; k < list.size(); ++k) {
      fmt::print(" {:.1f}", k_rows[r].of(scores[k]));
      const study::Interval& from = beside[k][r];
      if (k > 0) fmt::print(" ({:+.1f} to {:+.1f}){}", from.low, from.high, from.high < 0 ? " ahead" : "");
      fmt::print(" |");
    }
  }
  fmt::print("\n");
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
          {k_own, fmt::format("friction {:g}, restitution {:g}", friction, restitution),
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
  const std::vector<Entrant> all = entrants(trials, 1e9);
  print("Whatever it costs (engine less topple, 95 %)", all);
  print("At no more than the CPU time of topple's best", entrants(trials, all.front().cpu));
}

}  // namespace topple::bench
