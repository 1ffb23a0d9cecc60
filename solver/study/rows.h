// Results of a study as text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace topple::study {

/// A list of flat objects with the same keys as CSV (RFC 4180): the keys, then one line an object. null is an
/// empty field; numbers are the shortest that read back the same.
std::string csv_text(const nlohmann::ordered_json& rows);

}  // namespace topple::study
