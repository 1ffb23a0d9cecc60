// What a body was computed as, of a summary, in a few lines.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "solver/run/overturn.h"

namespace topple::app {

/// "models" of a body in the order of their first time: of what it was again for the same reason the first,
/// with how many "times", as text that is empty for one, and the greatest "error_estimate".
inline nlohmann::ordered_json models_in_brief(const nlohmann::ordered_json& models) {
  using nlohmann::ordered_json;
  ordered_json out = ordered_json::array();
  std::vector<int> times;
  for (const ordered_json& model : models) {
    const auto same = std::ranges::find_if(out, [&](const ordered_json& told) {
      return told["model"] == model["model"] && told["reason"] == model["reason"];
    });
    if (same == out.end()) {
      out.push_back(model);
      times.push_back(1);
      continue;
    }
    ++times[static_cast<std::size_t>(same - out.begin())];
    ordered_json& error = (*same)["error_estimate"];
    const ordered_json& here = model["error_estimate"];
    if (here.is_null() || (!error.is_null() && here > error)) error = here;  // null: unknown
  }
  const char* const at_least = models.size() < k_kept_impacts ? "" : "≥ ";
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k]["times"] = times[k] == 1 ? "" : fmt::format("{}{}", at_least, times[k]);
  return out;
}

}  // namespace topple::app
