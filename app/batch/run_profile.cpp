#include "app/batch/run_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct PhaseWords {
  Phase phase;
  const char* key;
  std::string_view words;
};

constexpr PhaseWords k_phases[] = {
    {Phase::search, "search_s", "search for near bodies, copying"},
    {Phase::models, "models_s", "choice of models"},
    {Phase::reduced, "bodies_s", "rigid and elastic bodies"},
    {Phase::forces, "forces_s", "forces of frames"},
    {Phase::tangent, "tangent_s", "tangents"},
    {Phase::factor, "factor_s", "factorisation"},
    {Phase::solve, "solve_s", "solution"},
    {Phase::energy, "energy_s", "energies, section forces"},
    {Phase::observe, "observe_s", "observation"},
    {Phase::record, "record_s", "recording"},
    {Phase::other, "other_s", "other"},
};
static_assert(std::size(k_phases) == std::tuple_size_v<decltype(Profile::seconds)>);

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string row(std::string_view words, double s, double total, double steps) {
  return fmt::format("{:<32} {:>10.2f} {:>8.1f} {:>10.2f}\n", words, 1e3 * s, total > 0 ? 100 * s / total : 0,
                     steps > 0 ? 1e6 * s / steps : 0);
}

}  // namespace

void start_profile(Profile& profile) {
  profile.clock = seconds;
  profile.enter(Phase::other);
}

ordered_json profile_summary(Profile& profile, std::int64_t steps) {
  profile.enter(Phase::other);
  profile.clock = nullptr;
  ordered_json out;
  out["threads"] = 1;
  out["steps"] = steps;
  out["total_s"] = std::accumulate(profile.seconds.begin(), profile.seconds.end(), 0.);
  for (const auto& [phase, key, words] : k_phases) out[key] = profile.seconds[static_cast<int>(phase)];
  return out;
}

std::string profile_table(const ordered_json& profile) {
  const double total = profile["total_s"], steps = profile["steps"];
  std::string out = fmt::format("{:<32} {:>10} {:>8} {:>10}\n", "time of steps", "ms", "%", "µs/step");
  for (const auto& [phase, key, words] : k_phases) out += row(words, profile[key], total, steps);
  return out + row("all", total, total, steps) + "measured on one thread\n";
}

}  // namespace topple::app
