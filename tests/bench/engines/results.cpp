#include "bench/engines/results.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>

namespace topple::bench {
namespace {

using nlohmann::ordered_json;

constexpr double k_milli = 1e3;
constexpr double k_tilt_errors[] = {0.1, 0.03, 0.01, 0.003, 1e-6};       // deg
constexpr double k_fall_errors[] = {0.3, 0.1, 0.03, 0.01, 0.003, 1e-6};  // s

ordered_json number(const std::optional<double>& value, double scale = 1) {
  return value ? ordered_json(*value * scale) : ordered_json();
}

std::string text(const std::optional<double>& value, double scale, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value * scale) : "none";
}

std::string step_text(const Setting& setting) {
  return setting.step > 0 ? fmt::format("{:g} ms", k_milli * setting.step) : "adaptive";
}

template <typename Part>
bool on_front(const Results& results, const Trial& trial, Part Trial::*part) {
  const std::vector<const Trial*> best = front(results.trials, trial.engine, part);
  return std::find(best.begin(), best.end(), &trial) != best.end();
}

template <typename Part>
std::string cheapest(const Results& results, Part Trial::*part, const std::string& title,
                     std::span<const double> errors, double unit, const char* unit_name) {
  std::string out = "\n| " + title + " |";
  for (const double error : errors) out += fmt::format(" {:g} {} |", error, unit_name);
  out += "\n|---|";
  for (std::size_t k = 0; k < errors.size(); ++k) out += "---|";
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e) {
    const std::vector<const Trial*> best = front(results.trials, e, part);
    out += "\n| " + results.engines[e].name + " |";
    for (const double error : errors) {
      const auto found = std::find_if(best.begin(), best.end(), [&](const Trial* trial) {
        return *(trial->*part).error <= error * unit;
      });
      out +=
          found == best.end() ? " not reached |" : fmt::format(" {:.3g} |", k_milli * *((*found)->*part).cpu);
    }
  }
  return out + "\n";
}

}  // namespace

ordered_json rows(const Results& results) {
  ordered_json out = ordered_json::array();
  for (const Trial& trial : results.trials) {
    const Engine& engine = results.engines[trial.engine];
    const Setting& setting = engine.grid[trial.setting];
    const auto row = [&](const char* name) {
      ordered_json begun{{"case", name}, {"engine", engine.name}, {"version", engine.version}};
      begun["step_ms"] = setting.step > 0 ? ordered_json(k_milli * setting.step) : ordered_json();
      begun["setting"] = setting.contact;
      return begun;
    };
    ordered_json free = row("free rocking");
    free["cpu_ms_per_s"] = number(trial.rocking.cpu, k_milli);
    free["tilt_error_deg"] = number(trial.rocking.error, 1 / k_degree);
    free["first_impact_error_ms"] = number(trial.rocking.first_impact, k_milli);
    free["third_impact_error_ms"] = number(trial.rocking.third_impact, k_milli);
    for (const double gal : k_amplitudes) free[fmt::format("fall_{:g}_gal_s", gal)] = nullptr;
    free["fall_error_s"] = nullptr;
    free["front"] = on_front(results, trial, &Trial::rocking);
    ordered_json fall = row("2 Hz");
    fall["cpu_ms_per_s"] = number(trial.falling.cpu, k_milli);
    for (const char* key : {"tilt_error_deg", "first_impact_error_ms", "third_impact_error_ms"})
      fall[key] = nullptr;
    for (std::size_t k = 0; k < std::size(k_amplitudes); ++k)
      fall[fmt::format("fall_{:g}_gal_s", k_amplitudes[k])] = number(trial.falling.falls[k]);
    fall["fall_error_s"] = number(trial.falling.error);
    fall["front"] = on_front(results, trial, &Trial::falling);
    out.push_back(std::move(free));
    out.push_back(std::move(fall));
  }
  return out;
}

std::string tables(const Results& results) {
  std::string out =
      "Pareto front of each engine, free rocking. Off theory: tilt, root mean square; first and third "
      "impact\n\n"
      "| engine | step | setting | ms per s | tilt, deg | first, ms | third, ms "
      "|\n|---|---|---|---|---|---|---|\n";
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e)
    for (const Trial* trial : front(results.trials, e, &Trial::rocking)) {
      const Setting& setting = results.engines[e].grid[trial->setting];
      out +=
          fmt::format("| {} | {} | {} | {:.3g} | {:.2g} | {} | {} |\n", results.engines[e].name,
                      step_text(setting), setting.contact, k_milli * *trial->rocking.cpu,
                      *trial->rocking.error / k_degree, text(trial->rocking.first_impact, k_milli, "{:.3g}"),
                      text(trial->rocking.third_impact, k_milli, "{:.3g}"));
    }
  out += fmt::format(
      "\nPareto front of each engine, 2 Hz: time of passing {:g} deg, s. Error: the greatest of the three\n\n"
      "| engine | step | setting | ms per s | error, s |",
      k_fall / k_degree);
  for (const double gal : k_amplitudes) out += fmt::format(" {:g} gal |", gal);
  out += "\n|---|---|---|---|---|---|---|---|\n| Housner, no sliding | | | | |";
  for (const double fall : results.theory.falls) out += fmt::format(" {:.4f} |", fall);
  out += "\n";
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e)
    for (const Trial* trial : front(results.trials, e, &Trial::falling)) {
      const Setting& setting = results.engines[e].grid[trial->setting];
      out += fmt::format("| {} | {} | {} | {:.3g} | {:.2g} |", results.engines[e].name, step_text(setting),
                         setting.contact, k_milli * *trial->falling.cpu, *trial->falling.error);
      for (const auto& fall : trial->falling.falls) out += " " + text(fall, 1, "{:.4f}") + " |";
      out += "\n";
    }
  out += "\nms per simulated second of the cheapest setting within an error\n";
  out += cheapest(results, &Trial::rocking, "free rocking: tilt", k_tilt_errors, k_degree, "deg");
  out += cheapest(results, &Trial::falling, "2 Hz: time of falling", k_fall_errors, 1, "s");
  out += "\n| without a result | settings | free rocking | 2 Hz |\n|---|---|---|---|\n";
  for (int e = 0; e < static_cast<int>(results.engines.size()); ++e) {
    int rocking = 0, falling = 0;
    for (const Trial& trial : results.trials) {
      if (trial.engine != e) continue;
      rocking += !trial.rocking.error;
      falling += !trial.falling.error;
    }
    out += fmt::format("| {} | {} | {} | {} |\n", results.engines[e].name, results.engines[e].grid.size(),
                       rocking, falling);
  }
  return out;
}

}  // namespace topple::bench
