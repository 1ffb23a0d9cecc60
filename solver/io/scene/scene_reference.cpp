// The table of keys as text.
#include <cmath>

#include "solver/io/scene/scene_keys.h"

namespace topple::io {
namespace {

bool takes_words(const Key& key) {
  return !key.choices.empty() && key.fallback.size() == 1 && key.type != KeyType::number;
}

std::string in_unit(const Key& key, double si) {
  return short_number(si / unit_value(key.unit, key.dimension));
}

std::string unit_suffix(const Key& key) {
  return key.unit.empty() ? "" : " " + std::string(key.unit);
}

std::string heading(std::string_view table) {
  if (table.empty()) return "Top level";
  const auto dot = table.find('.');
  if (dot != std::string_view::npos) {
    return "`" + std::string(table.substr(dot + 1)) + "` of " + heading(table.substr(0, dot));
  }
  const Key* key = find_key("", table);
  const std::string name(table);
  return key && key->type == KeyType::tables ? "`[[" + name + "]]`" : "`[" + name + "]`";
}

std::string type_text(const Key& key) {
  const std::string quantity(key.dimension == Dimension::none ? "a number" : dimension_name(key.dimension));
  std::string text;
  switch (key.type) {
    case KeyType::number:
      text = quantity;
      break;
    case KeyType::integer:
      text = "an integer";
      break;
    case KeyType::boolean:
      text = "true or false";
      break;
    case KeyType::text:
      text = "text";
      break;
    case KeyType::texts:
      text = "a list of 1 to " + std::to_string(key.count) + " texts";
      break;
    case KeyType::choice:
      text = "one word";
      break;
    case KeyType::choices:
      text = "a list of words";
      break;
    case KeyType::numbers:
      text = "a list of " + (key.least_count ? std::to_string(key.least_count) + " to " : "") +
             std::to_string(key.count) + ", each " + quantity;
      break;
    case KeyType::vectors:
      text = "a list of [x, y, z], each " + quantity;
      break;
    case KeyType::integers:
      text = "a list of " + std::to_string(key.count) + " integers";
      break;
    case KeyType::history:
      text = "a list of [time, factor]";
      break;
    case KeyType::table:
      text = "a table";
      break;
    case KeyType::tables:
      text = "tables";
      break;
  }
  return text;
}

std::string allowed_text(const Key& key) {
  std::string text;
  for (const std::string_view word : key.choices)
    text += (text.empty() ? "`" : ", `") + std::string(word) + "`";
  if (!std::isinf(key.least)) text += (text.empty() ? "" : " or ") + range_text(key);
  return text;
}

std::string absent_text(const Key& key) {
  if (key.required) return "required";
  if (!key.otherwise.empty()) return std::string(key.otherwise);
  return default_text(key);
}

std::string meaning_text(const Key& key) {
  std::string text(key.about);
  const auto only_with = [&](std::string_view of, const std::vector<std::string_view>& words) {
    text += "; only with `" + std::string(of) + "` = ";
    for (std::size_t k = 0; k < words.size(); ++k) text += (k ? " or `" : "`") + std::string(words[k]) + "`";
  };
  if (!key.of.empty()) only_with(key.of, key.when);
  if (!key.analyses.empty()) only_with("analysis", key.analyses);
  return text;
}

}  // namespace

std::string range_text(const Key& key) {
  return in_unit(key, key.least) + ".." + value_text(key, key.most);
}

std::string value_text(const Key& key, double si) {
  return in_unit(key, si) + unit_suffix(key);
}

std::string default_text(const Key& key) {
  if (key.fallback.empty()) return {};
  if (key.type == KeyType::boolean) return key.fallback[0] != 0 ? "true" : "false";
  if (takes_words(key)) {
    const std::string word(key.choices[static_cast<std::size_t>(key.fallback[0])]);
    return key.type == KeyType::choices ? "[" + word + "]" : word;
  }
  if (key.type != KeyType::numbers) return value_text(key, key.fallback[0]);
  std::string text;
  for (const double value : key.fallback) text += (text.empty() ? "[" : ", ") + in_unit(key, value);
  return text + "]" + unit_suffix(key);
}

std::string scene_reference() {
  std::string text =
      "# Keys of a scene file\n\n"
      "Generated from the table in `solver/io/scene/scene_keys.cpp`. A physical value is a number in SI or a "
      "string of a\n"
      "number and a unit, such as `\"190 gal\"`. Errors name file, line and column.\n";
  const Key* before = nullptr;
  for (const Key& key : scene_keys()) {
    if (!before || before->table != key.table) {
      text += "\n## " + heading(key.table) +
              "\n\n| key | value | allowed | when absent | meaning |\n|---|---|---|---|---|\n";
    }
    before = &key;
    text += "| `" + std::string(key.name) + "` | " + type_text(key) + " | " + allowed_text(key) + " | " +
            absent_text(key) + " | " + meaning_text(key) + " |\n";
  }
  text += "\n## Units\n\n| what | units |\n|---|---|\n";
  for (const Unit* unit = units().data(); unit != units().data() + units().size(); ++unit) {
    if (unit != units().data() && unit->dimension == (unit - 1)->dimension) continue;
    text += "| " + std::string(dimension_name(unit->dimension)) + " | " + unit_list(unit->dimension) + " |\n";
  }
  return text;
}

}  // namespace topple::io
