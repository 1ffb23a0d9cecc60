// What tests of studies that run cases share.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace topple::study {

/// Nobody gives up.
inline bool never() {
  return false;
}

/// A row without the time that its run took.
inline std::string without_time(const std::string& row) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(row);
  json.erase("cpu_s");
  return json.dump();
}

}  // namespace topple::study
