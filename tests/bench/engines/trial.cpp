#include "bench/engines/trial.h"

#include <algorithm>
#include <limits>

#include "solver/study/common/measure.h"
#include "verification/housner.h"

namespace topple::bench {
namespace {

constexpr double k_timed = 0.05;        // s, spent at least on the time of one setting
constexpr int k_repeats = 3;            // at least
constexpr double k_theory_step = 1e-5;  // s
constexpr double k_within = 1e-4;       // s, between the instants that are looked at within a step

const double k_critical = std::atan(k_size[0] / k_size[2]);

Case let_go() {
  return {.tilt = k_critical / 2};
}

Case shaken(double gal) {
  return {.amplitude = gal * k_gal};
}

std::optional<double> cpu_per_second(const Setting& setting, const Case& c, double until) {
  double least = std::numeric_limits<double>::infinity(), spent = 0;
  for (int k = 0; k < k_repeats || spent < k_timed; ++k) {
    const Simulation simulation = setting.start(c);
    double time = 0;
    const double taken = study::cpu_time_of(
        [&] {
          while (time < until) time = simulation.advance();
        },
        0);
    if (std::isnan(time)) return {};
    least = std::min(least, taken);
    spent += taken;
  }
  return least / until;
}

double tilt_at(const std::vector<Instant>& path, double t) {
  const auto after =
      std::upper_bound(path.begin() + 1, path.end() - 1, t,
                       [](double time, const Instant& instant) { return time < instant.time; });
  const Instant &a = after[-1], &b = *after;
  return std::lerp(a.tilt, b.tilt, (t - a.time) / (b.time - a.time));
}

/// Where the line through two points reaches `level`.
double crossing(double t0, double v0, double t1, double v1, double level) {
  return t0 + (t1 - t0) * (level - v0) / (v1 - v0);
}

/// One step from `time`. Calls see(t, tilt) at its end and, where the tilt is known within it, before; until
/// that returns false. The time then; NaN: the engine gave up.
template <typename See>
double look(const Simulation& simulation, double time, See see) {
  const double end = simulation.advance();
  if (std::isnan(end)) return end;
  if (simulation.tilt_within)
    for (long k = 1; time + static_cast<double>(k) * k_within < end; ++k) {
      const double t = time + static_cast<double>(k) * k_within;
      if (!see(t, simulation.tilt_within(t))) return t;
    }
  see(end, simulation.tilt());
  return end;
}

std::optional<double> time_of_fall(const Setting& setting, const Case& c) {
  const Simulation simulation = setting.start(c);
  double time = 0, before = 0, tilt = 0;
  std::optional<double> fall;
  while (time < k_fall_window && !fall) {
    time = look(simulation, time, [&](double t, double signed_tilt) {
      const double now = std::abs(signed_tilt);
      if (now >= k_fall) fall = crossing(before, tilt, t, now, k_fall);
      before = t, tilt = now;
      return !fall && now <= std::numbers::pi;
    });
    if (std::isnan(time) || !(tilt <= std::numbers::pi)) return {};
  }
  return fall;
}

/// Of Housner's block, s. It begins where the floor lifts it: rocking_block steps from there.
double theory_of_fall(const test::Block& block, const Case& c) {
  const double unit = k_gravity * std::tan(block.critical);
  const double lifted = std::asin(unit / c.amplitude) / (2 * std::numbers::pi * c.frequency);
  double before = 0, tilt = 0, fall = 0;
  test::rock(
      block, {-std::numeric_limits<double>::min(), 0},
      [&](double t) { return c.floor_acceleration(lifted + t) / unit; }, k_fall_window, k_theory_step,
      1.1 * k_fall / block.critical,
      [&](double t, double signed_tilt) {
        const double now = std::abs(signed_tilt);
        if (now >= k_fall && fall == 0) fall = lifted + crossing(before, tilt, t, now, k_fall);
        before = t, tilt = now;
      });
  return fall;
}

}  // namespace

Reference reference() {
  const test::Block block{k_size[0] / 2, k_size[2] / 2, 4. / 3, k_gravity};
  Reference out;
  const Case start = let_go();
  out.path = {{0, start.tilt}};
  out.impacts = test::rock(
                    block, {start.tilt, 0}, [](double) { return 0.; }, k_window, k_theory_step, 1.5,
                    [&](double t, double tilt) {
                      out.path.push_back({t, tilt});
                    })
                    .impacts;
  for (std::size_t k = 0; k < std::size(k_amplitudes); ++k)
    out.falls[k] = theory_of_fall(block, shaken(k_amplitudes[k]));
  return out;
}

FreeRocking free_rocking(const Setting& setting, const Reference& theory) {
  FreeRocking out;
  const Case c = let_go();
  out.cpu = cpu_per_second(setting, c, k_window);
  const Simulation simulation = setting.start(c);
  double time = 0, before = 0, tilt = c.tilt, error = 0, squares = 0;
  std::vector<double> impacts;
  while (time < k_window) {
    time = look(simulation, time, [&](double t, double now) {
      if (t > theory.path.back().time) return false;
      const double now_off = now - tilt_at(theory.path, t);
      squares += (t - before) * (error * error + now_off * now_off) / 2;
      if ((tilt > 0) != (now > 0)) impacts.push_back(crossing(before, tilt, t, now, 0));
      before = t, tilt = now, error = now_off;
      return std::abs(now) <= std::numbers::pi;
    });
    if (std::isnan(time) || !(std::abs(tilt) <= std::numbers::pi)) return out;
  }
  out.error = std::sqrt(squares / before);
  if (impacts.size() > 0) out.first_impact = impacts[0] - theory.impacts[0];
  if (impacts.size() > 2) out.third_impact = impacts[2] - theory.impacts[2];
  return out;
}

Falling falling(const Setting& setting, const Reference& theory) {
  Falling out;
  constexpr std::size_t timed = std::size(k_amplitudes) - 1;
  out.cpu = cpu_per_second(setting, shaken(k_amplitudes[timed]), theory.falls[timed]);
  double greatest = 0;
  bool all = true;
  for (std::size_t k = 0; k <= timed; ++k) {
    out.falls[k] = time_of_fall(setting, shaken(k_amplitudes[k]));
    if (out.falls[k])
      greatest = std::max(greatest, std::abs(*out.falls[k] - theory.falls[k]));
    else
      all = false;
  }
  if (all) out.error = greatest;
  return out;
}

}  // namespace topple::bench
