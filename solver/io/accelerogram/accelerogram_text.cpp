#include "solver/io/accelerogram/accelerogram_text.h"

#include <cctype>
#include <cstdio>
#include <limits>

#include "solver/io/common/digits.h"
#include "solver/io/common/units.h"
#include "solver/math/types.h"

namespace topple::io::accelerogram {
namespace {

struct Spelling {
  std::string_view text, unit;
};

// As files spell them, in capitals without blanks.
constexpr Spelling k_spellings[] = {
    {"G", "g"},          {"GAL", "gal"},       {"GALS", "gal"},       {"M/S^2", "m/s^2"},
    {"M/S2", "m/s^2"},   {"M/S**2", "m/s^2"},  {"M/S/S", "m/s^2"},    {"M/SEC/SEC", "m/s^2"},
    {"M/SEC2", "m/s^2"}, {"M/SEC^2", "m/s^2"}, {"CM/S^2", "gal"},     {"CM/S2", "gal"},
    {"CM/S**2", "gal"},  {"CM/S/S", "gal"},    {"CM/SEC/SEC", "gal"}, {"CM/SEC2", "gal"},
    {"CM/SEC^2", "gal"},
};

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

std::string shown(std::string_view text) {
  constexpr std::size_t k_longest = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, k_longest)) result += static_cast<unsigned char>(c) < 0x80 ? c : '?';
  return result + (text.size() > k_longest ? "...\"" : "\"");
}

std::string count_text(double count) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", count);
  return text;
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = read_digits(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> take_number(std::string_view& text) {
  text = trimmed(text);
  double value = 0;
  const auto [end, error] = read_digits(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

double finite_number(std::string_view text, const Lines& lines, const std::string& what) {
  const std::optional<double> value = number_in(text);
  if (!value) lines.fail(what + shown(text) + " is not a number");
  if (!std::isfinite(*value)) lines.fail(what + shown(text) + " is not a finite number");
  return *value;
}

void check_count(const Lines& lines, const std::string& key, double count) {
  if (count > k_most_samples)
    lines.fail(key + count_text(count) + " samples are more than the " + count_text(k_most_samples) +
               " that are allowed");
  if (!(count >= 2) || count != std::floor(count))
    lines.fail(key + short_number(count) + " samples; expected a whole number, 2 or more");
}

void check_interval(const Lines& lines, int line, const std::string& key, double interval) {
  if (!(interval >= k_shortest_interval && interval <= k_longest_interval))
    lines.fail_at(line, key + short_number(interval) + " s between samples are outside " +
                            short_number(k_shortest_interval) + ".." + short_number(k_longest_interval) +
                            " s");
}

std::string known_units() {
  std::string text;
  for (const std::string_view unit : k_sample_units)
    text += (text.empty() ? "known: " : ", ") + std::string(unit);
  return text;
}

std::string_view acceleration_unit(std::string_view text) {
  std::string plain = upper(text);
  std::erase(plain, ' ');
  for (const Spelling& spelling : k_spellings)
    if (spelling.text == plain) return spelling.unit;
  return {};
}

std::string_view chosen_unit(const Lines& lines, std::string_view stated, const AccelerogramNotes& notes) {
  if (notes.unit.empty() && stated.empty())
    lines.fail("unit: the file states none; give it in the scene, unit = \"gal\"");
  const std::string_view said = notes.unit == "cm/s^2" ? std::string_view("gal") : notes.unit;
  if (!said.empty() && !stated.empty() && said != stated)
    lines.fail("unit: the file states " + std::string(stated) + ", the scene " + notes.unit +
               "; leave it out there");
  return stated.empty() ? said : stated;
}

void check_peak(const Lines& lines, int line, double size, std::string_view unit) {
  const double in_g = size * unit_value(unit, Dimension::acceleration) / k_standard_gravity;
  if (in_g <= k_highest_peak) return;
  lines.fail_at(line, "peak: " + short_number(size) + " " + std::string(unit) +
                          (unit == "g" ? "" : " = " + short_number(in_g) + " g") + " is above " +
                          short_number(k_highest_peak) + " g; is the unit right?");
}

void to_si(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

}  // namespace topple::io::accelerogram
