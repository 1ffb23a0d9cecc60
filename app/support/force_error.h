// The stated error of what an anchor bears, of a summary.
#pragma once

#include <nlohmann/json.hpp>

namespace topple::app {

/// N, of the greatest force of an anchor; null: none is stated, or it never bore any.
inline nlohmann::ordered_json force_error(const nlohmann::ordered_json& summary, std::size_t anchor) {
  const nlohmann::ordered_json estimate = summary.value("error_estimate", nlohmann::ordered_json());
  if (!estimate.contains("anchors")) return nullptr;
  const nlohmann::ordered_json& error = estimate["anchors"][anchor]["peak_force_N"];
  return error == 0 ? nlohmann::ordered_json(nullptr) : error;
}

}  // namespace topple::app
