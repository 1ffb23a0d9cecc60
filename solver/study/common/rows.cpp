#include "solver/study/common/rows.h"

#include <nlohmann/json.hpp>

namespace topple::study {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::string field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? quoted(value.get<std::string>()) : value.dump();
}

}  // namespace

std::string csv_text(const nlohmann::ordered_json& rows) {
  std::string text;
  const auto line = [&text](const auto& items, const auto& shown) {
    std::string begin;
    for (const auto& item : items) {
      text += begin + shown(item);
      begin = ",";
    }
    text += '\n';
  };
  if (!rows.empty()) line(rows.front().items(), [](const auto& item) { return quoted(item.key()); });
  for (const auto& row : rows) line(row, field);
  return text;
}

}  // namespace topple::study
