// Results of a study as text.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace topple::study {

/// A list of flat objects with the same keys as CSV (RFC 4180): the keys, then one line an object. null is an
/// empty field; numbers are the shortest that read back the same.
std::string csv_text(const nlohmann::ordered_json& rows);

/// A number, or null.
template <typename Number>
nlohmann::ordered_json or_null(const std::optional<Number>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace topple::study
