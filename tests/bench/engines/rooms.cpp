#include "bench/engines/rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bench/engines/files.h"
#include "bench/engines/trial.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"

namespace topple::bench {
namespace {

using nlohmann::ordered_json;

constexpr int k_runs = 3;        // of a setting, of which the fastest counts
constexpr double k_enough = 10;  // s, of CPU time, after which there is no further run
constexpr double k_milli = 1e3;
constexpr double k_percent = 100;

using Falls = std::vector<std::optional<double>>;

/// What one setting did in a room.
struct RoomTrial {
  double cpu = std::numeric_limits<double>::infinity();  ///< s per simulated second, of the steps alone
  double end = 0;                                        ///< s, simulated
  long steps = 0;
  Falls falls;                ///< s, per body, when it passed k_fall
  std::vector<double> peaks;  ///< rad, per body, greatest tilt
  std::optional<double> estimate;
  std::string failure;  ///< why the engine gave up
};

/// How far one trial is from another.
struct RoomErrors {
  int falls = 0, other_verdicts = 0;
  std::optional<double> greatest, median;  ///< s, of the time of falling, over the bodies that fall in both
  std::optional<double> peak;              ///< rad, greatest of the peak tilt, over those that stand in both
};

RoomTrial run_once(const RoomSetting& setting, const Setup& setup) {
  const std::unique_ptr<RoomSimulation> room = setting.start(setup);
  const int bodies = setup.model.furniture_total();
  RoomTrial trial;
  trial.falls.resize(bodies);
  std::vector<double> tilts(bodies);
  for (int b = 0; b < bodies; ++b) tilts[b] = room->tilt(b);
  trial.peaks = tilts;
  bool going = true;
  const double spent = study::cpu_time_of(
      [&] {
        while (going && trial.end < setup.run.duration) {
          going = room->advance();
          if (!going) break;
          const double before = std::exchange(trial.end, room->time());
          for (int b = 0; b < bodies; ++b) {
            const double last = std::exchange(tilts[b], room->tilt(b));
            trial.peaks[b] = std::max(trial.peaks[b], tilts[b]);
            if (!trial.falls[b] && tilts[b] >= k_fall)
              trial.falls[b] = std::lerp(before, trial.end, (k_fall - last) / (tilts[b] - last));
          }
        }
      },
      0);
  trial.cpu = spent / trial.end;
  trial.steps = room->steps();
  trial.estimate = room->estimate();
  if (!going) trial.failure = room->failure();
  return trial;
}

RoomTrial run_room(const RoomSetting& setting, const Setup& setup) {
  RoomTrial trial = run_once(setting, setup);
  double spent = trial.cpu * trial.end;
  for (int k = 1; k < k_runs && spent < k_enough; ++k) {
    const double cpu = run_once(setting, setup).cpu;
    spent += cpu * trial.end;
    trial.cpu = std::min(trial.cpu, cpu);
  }
  return trial;
}

RoomErrors errors(const RoomTrial& trial, const RoomTrial& reference) {
  RoomErrors out;
  std::vector<double> off;
  for (std::size_t b = 0; b < trial.falls.size(); ++b) {
    const auto &fall = trial.falls[b], &other = reference.falls[b];
    out.falls += fall.has_value();
    out.other_verdicts += fall.has_value() != other.has_value();
    if (fall && other) off.push_back(std::abs(*fall - *other));
    if (!fall && !other)
      out.peak = std::max(out.peak.value_or(0), std::abs(trial.peaks[b] - reference.peaks[b]));
  }
  if (off.empty()) return out;
  std::ranges::sort(off);
  out.greatest = off.back();
  out.median = (off[(off.size() - 1) / 2] + off[off.size() / 2]) / 2;
  return out;
}

ordered_json row(const Room& room, const RoomSetting& setting, const RoomTrial& trial,
                 const RoomErrors& off) {
  ordered_json out{{"room", room.name},
                   {"engine", setting.engine},
                   {"version", setting.version},
                   {"setting", setting.words},
                   {"step_ms", setting.step > 0 ? ordered_json(k_milli * setting.step) : ordered_json()},
                   {"cpu_ms_per_s", k_milli * trial.cpu},
                   {"simulated_s", trial.end},
                   {"steps", trial.steps},
                   {"estimate_percent", nullptr},
                   {"falls", off.falls},
                   {"fall_error_max_s", study::or_null(off.greatest)},
                   {"fall_error_median_s", study::or_null(off.median)},
                   {"other_verdicts", off.other_verdicts},
                   {"peak_error_deg", nullptr}};
  if (off.peak) out["peak_error_deg"] = *off.peak / k_degree;
  if (trial.estimate) out["estimate_percent"] = k_percent * *trial.estimate;
  std::string times;
  for (const auto& fall : trial.falls)
    times += (times.empty() ? "" : " ") + (fall ? fmt::format("{:.4f}", *fall) : "-");
  out["falls_s"] = times;
  out["gave_up"] = trial.failure;
  return out;
}

constexpr const char* k_head =
    "| engine | setting | step | ms per s | steps | estimate | fall | time of falling off, s: greatest | "
    "median "
    "| other verdicts | peak tilt of who stands off, deg |\n|---|---|---|---|---|---|---|---|---|---|---|\n";

std::string line(const RoomSetting& setting, const RoomTrial& trial, const RoomErrors& off) {
  const auto text = [](const std::optional<double>& value, double scale, const char* unit = "") {
    return value ? fmt::format("{:.2g}{}", scale * *value, unit) : "-";
  };
  return fmt::format(
      "| {} | {} | {} | {:.3g} | {} | {} | {} | {} | {} | {} | {} |{}\n", setting.engine, setting.words,
      setting.step > 0 ? fmt::format("{:g} ms", k_milli * setting.step) : "scene's", k_milli * trial.cpu,
      trial.steps, text(trial.estimate, k_percent, " %"), off.falls, text(off.greatest, 1),
      text(off.median, 1), off.other_verdicts, text(off.peak, 1 / k_degree),
      trial.failure.empty() ? "" : fmt::format(" gave up at {:.3f} s: {}", trial.end, trial.failure));
}

std::vector<RoomSetting> settings([[maybe_unused]] const Setup& setup) {
  std::vector<RoomSetting> found{topple_room_setting()};
#ifdef WITH_MUJOCO
  for (RoomSetting& setting : mujoco_room_settings(setup)) found.push_back(std::move(setting));
#endif
  return found;
}

void run(const Room& room, ordered_json& rows) {
  fmt::print("\n{}: {}. {} bodies, {:g} s\n\n{}", room.name, room.about, room.setup.model.furniture_total(),
             room.setup.run.duration, k_head);
  const RoomSetting by = topple_room_reference(room);
  const RoomTrial reference = run_once(by, room.setup);
  const auto show = [&](const RoomSetting& setting, const RoomTrial& trial) {
    const RoomErrors off = errors(trial, reference);
    rows.push_back(row(room, setting, trial, off));
    fmt::print("{}", line(setting, trial, off));
    std::fflush(stdout);
  };
  show(by, reference);
  for (const RoomSetting& setting : settings(room.setup)) show(setting, run_room(setting, room.setup));
}

}  // namespace

void run_rooms(const std::filesystem::path& folder, const std::string& only) {
  ordered_json rows = ordered_json::array();
  fmt::print("Rooms on {}, one core. Falls: past {:g} deg\n", study::processor_name(), k_fall / k_degree);
  bool found = false;
  for (const Room& room : rooms()) {
    if (!only.empty() && room.name != only) continue;
    found = true;
    run(room, rows);
  }
  if (!found) throw std::runtime_error("no room is called " + only);
  write(folder / "rooms.csv", study::csv_text(rows));
}

}  // namespace topple::bench
