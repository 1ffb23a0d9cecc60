#include "solver/io/accelerogram/accelerogram_file.h"

#include <algorithm>
#include <cmath>

#include "solver/io/accelerogram/accelerogram_text.h"
#include "solver/io/common/units.h"
#include "solver/math/elementary.h"
#include "solver/model/accelerogram.h"

namespace topple::io {
namespace {

using namespace accelerogram;

void refuse_binary(std::string_view text, const std::string& name) {
  int line = 1;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte == '\n') ++line;
    if (byte >= 0x20 ? byte != 0x7f : byte == '\n' || byte == '\r' || byte == '\t') continue;
    throw InputError(name + ":" + std::to_string(line) +
                     ": is not text; expected PEER AT2, K-NET ASCII, or CSV with a header");
  }
}

// ---- PEER AT2

// The number that stands behind `key` and an equals sign. Nothing without the key.
std::optional<double> keyed_number(const Lines& lines, const std::string& line, const std::string& key) {
  const auto at = line.find(key);
  const auto equals = at == std::string::npos ? at : line.find('=', at + key.size());
  if (equals == std::string::npos) return std::nullopt;
  std::string_view rest = std::string_view(line).substr(equals + 1);
  const std::optional<double> value = take_number(rest);
  if (!value) lines.fail(key + ": " + shown(trimmed(rest)) + " is not a number");
  return value;
}

bool is_at2(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  for (int i = 0; i < 4; ++i)
    if (!lines.next()) return false;
  return upper(lines.line()).find("NPTS") != std::string::npos;
}

std::string_view at2_unit(const Lines& lines) {
  static constexpr std::string_view k_units_of = "UNITS OF";
  const std::string line = upper(lines.line());
  const auto at = line.find(k_units_of);
  if (at == std::string::npos) return {};
  std::string_view rest = trimmed(std::string_view(line).substr(at + k_units_of.size()));
  rest = rest.substr(0, rest.find_first_of(" ,.;("));
  const std::string_view unit = acceleration_unit(rest);
  if (unit.empty()) lines.fail("unit: " + shown(rest) + " is not one of an acceleration; " + known_units());
  return unit;
}

AccelerogramFile read_at2(std::string_view text, const std::string& name, const AccelerogramNotes& notes) {
  Lines lines(text, name);
  for (int i = 0; i < 3; ++i) lines.next();
  const std::string_view unit = chosen_unit(lines, at2_unit(lines), notes);
  lines.next();
  const std::string header = upper(lines.line());
  std::optional<double> count = keyed_number(lines, header, "NPTS"),
                        interval = keyed_number(lines, header, "DT");
  if (!count && !interval) {
    std::string_view rest = header;
    count = take_number(rest);
    interval = take_number(rest);
    if (!trimmed(rest).starts_with("NPTS")) count.reset();
  }
  if (!count || !interval)
    lines.fail("NPTS, DT: found " + shown(lines.line()) +
               ", expected such as NPTS= 4000, DT= .01000 SEC or 4000 0.01 NPTS, DT");
  check_count(lines, "NPTS: ", *count);
  check_interval(lines, lines.number(), "DT: ", *interval);
  const int header_line = lines.number();

  AccelerogramFile file{AccelerogramFile::Format::at2, *interval, {{}}};
  std::vector<double>& samples = file.components[0];
  Largest largest;
  const double found = read_samples(
      lines, *count, samples, [&](double value, std::string_view) { largest.update(value, lines.number()); });
  if (found != *count)
    lines.fail_at(header_line,
                  "NPTS: says " + count_text(*count) + " samples, the file holds " + count_text(found));
  check_peak(lines, largest.line, largest.size, unit);
  to_si(samples, unit_value(unit, Dimension::acceleration));
  return file;
}

// ---- K-NET

constexpr std::string_view k_knet_first = "Origin Time";
constexpr int k_knet_lines = 17;

// What stands behind the label of a header line. Stations and years spell labels differently ("Max Acc.
// (gal)"), so only its letters count up to where the value may begin.
std::string_view knet_value(Lines& lines, int number, std::string_view label) {
  constexpr std::size_t k_label_columns = 18;
  while (lines.number() < number)
    if (!lines.next())
      lines.fail("K-NET: the header ends after " + std::to_string(lines.number()) + " of " +
                 std::to_string(k_knet_lines) + " lines");
  const std::string_view line = lines.line();
  const auto letters = [](std::string_view text) {
    std::string result;
    for (const char c : text)
      if (std::isalpha(static_cast<unsigned char>(c))) result += c;
    return upper(result);
  };
  const auto tab = line.find('\t');
  const std::size_t width = std::min(tab == std::string_view::npos ? k_label_columns : tab, line.size());
  if (!letters(line.substr(0, width)).starts_with(letters(label)))
    lines.fail("K-NET: found " + shown(line) + ", expected \"" + std::string(label) + "\"");
  return trimmed(line.substr(width));
}

double knet_number(Lines& lines, int number, std::string_view label, std::string_view behind) {
  std::string_view text = knet_value(lines, number, label);
  const std::string_view whole = text;
  const std::optional<double> value = take_number(text);
  if (!value || !(*value > 0) || !(trimmed(text).empty() || trimmed(text) == behind))
    lines.fail(std::string(label) + ": found " + shown(whole) + ", expected a number above 0");
  return *value;
}

// gal of one count: "3920(gal)/6182761".
double knet_scale(Lines& lines) {
  static constexpr std::string_view k_between = "(gal)/";
  const std::string_view whole = knet_value(lines, 14, "Scale Factor");
  std::string_view text = whole;
  const std::optional<double> above = take_number(text);
  std::optional<double> below;
  if (text.starts_with(k_between)) {
    text.remove_prefix(k_between.size());
    below = take_number(text);
  }
  if (!above || !below || !(*above > 0) || !(*below > 0) || !trimmed(text).empty())
    lines.fail("Scale Factor: found " + shown(whole) + ", expected such as 3920(gal)/6182761");
  return *above / *below;
}

// One in the last digit of a number as it is written.
double last_digit(std::string_view text) {
  const auto point = text.find('.');
  if (point == std::string_view::npos) return 1;
  return elementary::pow(10., -static_cast<double>(text.size() - point - 1));
}

AccelerogramFile read_knet(std::string_view text, const std::string& name, const AccelerogramNotes& notes) {
  Lines lines(text, name);
  const double frequency = knet_number(lines, 11, "Sampling Freq(Hz)", "Hz");
  check_interval(lines, lines.number(), "Sampling Freq(Hz): ", 1 / frequency);
  const double seconds = knet_number(lines, 12, "Duration Time(s)", "");
  const double count = std::round(frequency * seconds);
  check_count(lines, "Duration Time(s): ", count);
  const double scale = knet_scale(lines);
  chosen_unit(lines, "gal", notes);
  const double stated_peak = knet_number(lines, 15, "Max. Acc. (gal)", "");
  const std::string_view stated_text = knet_value(lines, 15, "Max. Acc. (gal)");
  knet_value(lines, k_knet_lines, "Memo.");

  AccelerogramFile file{AccelerogramFile::Format::knet, 1 / frequency, {{}}};
  std::vector<double>& samples = file.components[0];
  const double found = read_samples(lines, count, samples, [&](double value, std::string_view word) {
    if (value != std::floor(value)) lines.fail(shown(word) + " is not a whole number of counts");
  });
  if (found != count)
    lines.fail_at(12, "Duration Time(s): " + short_number(seconds) + " s at " + short_number(frequency) +
                          " Hz are " + count_text(count) + " samples, the file holds " + count_text(found));
  remove_mean(samples);
  const double peak =
      scale * std::abs(*std::max_element(samples.begin(), samples.end(),
                                         [](double a, double b) { return std::abs(a) < std::abs(b); }));
  check_peak(lines, 14, peak, "gal");
  // the printed peak and the counts are rounded
  if (std::abs(peak - stated_peak) > last_digit(stated_text) + scale)
    lines.fail_at(15, "Max. Acc. (gal): says " + std::string(stated_text) + ", the data give " +
                          short_number(peak) + " about their mean");
  to_si(samples, scale * unit_value("gal", Dimension::acceleration));
  return file;
}

}  // namespace

AccelerogramFile read_accelerogram(std::string_view bytes, const std::string& name,
                                   const AccelerogramNotes& notes) {
  static constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";
  if (bytes.starts_with(k_byte_order_mark)) bytes.remove_prefix(k_byte_order_mark.size());
  if (bytes.empty()) throw InputError(name + ":1: is empty");
  refuse_binary(bytes, name);
  const bool knet = bytes.starts_with(k_knet_first), at2 = !knet && is_at2(bytes, name);
  if (!knet && !at2 && !is_csv(bytes, name, notes))
    throw InputError(name + ":1: found " + shown(bytes.substr(0, bytes.find_first_of("\r\n"))) +
                     ", expected PEER AT2, K-NET ASCII, or CSV with a header such as time_s,ax_gal");
  if (notes.interval && (knet || at2))
    throw InputError(name + ":1: dt: the file states its own; leave dt out in the scene");
  return knet  ? read_knet(bytes, name, notes)
         : at2 ? read_at2(bytes, name, notes)
               : read_csv(bytes, name, notes);
}

}  // namespace topple::io
