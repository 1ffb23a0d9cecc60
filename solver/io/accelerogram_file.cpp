#include "solver/io/accelerogram_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "solver/accelerogram.h"
#include "solver/io/scene.h"
#include "solver/io/units.h"

namespace topple::io {
namespace {

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
  return {text, std::to_chars(text, text + sizeof text, count, std::chars_format::fixed, 0).ptr};
}

// The text from line to line.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool next() {
    if (begin_ >= text_.size()) return false;
    const auto end = std::min(text_.find('\n', begin_), text_.size());
    line_ = text_.substr(begin_, end - begin_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    begin_ = end + 1;
    ++number_;
    return true;
  }
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  std::size_t bytes_left() const { return text_.size() - std::min(begin_, text_.size()); }

  [[noreturn]] void fail(const std::string& message) const { fail_at(number_, message); }
  [[noreturn]] void fail_at(int number, const std::string& message) const {
    throw InputError(name_ + ":" + std::to_string(number) + ": " + message);
  }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t begin_ = 0;
  std::string_view line_;
  int number_ = 0;
};

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

// Nothing when it is no number.
std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) return std::numeric_limits<double>::infinity();
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The number at the begin of `text`, taken off it.
std::optional<double> take_number(std::string_view& text) {
  text = trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
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

constexpr const char* k_known_units = "known: g, gal, m/s^2, cm/s^2";

// Empty when it is none that is known.
std::string_view acceleration_unit(std::string_view text) {
  std::string plain = upper(text);
  std::erase(plain, ' ');
  for (const Spelling& spelling : k_spellings)
    if (spelling.text == plain) return spelling.unit;
  return {};
}

// The symbol that counts of what the file states (empty: nothing) and the scene says.
std::string_view chosen_unit(const Lines& lines, std::string_view stated, const AccelerogramNotes& notes) {
  if (notes.unit.empty() && stated.empty())
    lines.fail("unit: the file states none; give it in the scene, unit = \"gal\"");
  const std::string_view said = notes.unit == "cm/s^2" ? std::string_view("gal") : notes.unit;
  if (!said.empty() && !stated.empty() && said != stated)
    lines.fail("unit: the file states " + std::string(stated) + ", the scene " + notes.unit +
               "; leave it out there");
  return stated.empty() ? said : stated;
}

// The largest of numbers as they stand in the file.
struct Largest {
  double size = 0;
  int line = 0;
  void meet(double value, int number) {
    if (std::abs(value) > size) {
      size = std::abs(value);
      line = number;
    }
  }
};

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
  if (unit.empty()) lines.fail("unit: " + shown(rest) + " is not one of an acceleration; " + k_known_units);
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
  samples.reserve(std::min(static_cast<std::size_t>(*count), lines.bytes_left()));
  Largest largest;
  double found = 0;
  while (lines.next()) {
    for (std::string_view rest = trimmed(lines.line()); !rest.empty(); rest = trimmed(rest)) {
      const auto end = std::min(rest.find_first_of(" \t"), rest.size());
      const double value = finite_number(rest.substr(0, end), lines, "");
      rest.remove_prefix(end);
      largest.meet(value, lines.number());
      if (++found <= *count) samples.push_back(value);
    }
  }
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
  return std::pow(10., -static_cast<double>(text.size() - point - 1));
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
  samples.reserve(std::min(static_cast<std::size_t>(count), lines.bytes_left()));
  double found = 0;
  while (lines.next()) {
    for (std::string_view rest = trimmed(lines.line()); !rest.empty(); rest = trimmed(rest)) {
      const auto end = std::min(rest.find_first_of(" \t"), rest.size());
      const double value = finite_number(rest.substr(0, end), lines, "");
      if (value != std::floor(value))
        lines.fail(shown(rest.substr(0, end)) + " is not a whole number of counts");
      rest.remove_prefix(end);
      if (++found <= count) samples.push_back(value);
    }
  }
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

// ---- CSV

struct Column {
  std::string name;
  std::string unit;  // as written; empty: none
};

Column read_column(std::string_view cell) {
  cell = trimmed(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = trimmed(cell.substr(1, cell.size() - 2));
  if (const auto open = cell.find_first_of("(["); open != std::string_view::npos) {
    const auto close = cell.find_first_of(")]", open);
    const auto length = close == std::string_view::npos ? close : close - open - 1;
    return {std::string(trimmed(cell.substr(0, open))), std::string(trimmed(cell.substr(open + 1, length)))};
  }
  const auto mark = cell.rfind('_');
  if (mark == std::string_view::npos) return {std::string(cell), ""};
  return {std::string(cell.substr(0, mark)), std::string(cell.substr(mark + 1))};
}

bool is_time(const Column& column) {
  const std::string name = upper(column.name);
  return name == "T" || name == "TIME";
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  for (;;) {
    const auto end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view header) {
  for (const char c : {',', ';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ',';
}

// The first line that is no comment.
bool next_content(Lines& lines) {
  while (lines.next())
    if (const std::string_view line = trimmed(lines.line()); !line.empty() && line.front() != '#')
      return true;
  return false;
}

bool is_csv(std::string_view text, const std::string& name, const AccelerogramNotes& notes) {
  Lines lines(text, name);
  if (!next_content(lines)) return false;
  const std::string_view header = trimmed(lines.line());
  // one column alone has its times from the scene
  return header.find_first_of(",;\t") != std::string_view::npos || notes.interval ||
         !acceleration_unit(read_column(header).unit).empty();
}

struct Columns {
  int time = -1;
  double time_unit = 1;                 // s
  std::vector<int> at;                  // of the accelerations
  std::vector<std::string_view> units;  // of them
  std::size_t count = 0;
};

Columns read_header(const Lines& lines, char separator, const AccelerogramNotes& notes) {
  Columns columns;
  for (const std::string_view cell : cells_of(lines.line(), separator)) {
    const Column column = read_column(cell);
    const int index = static_cast<int>(columns.count++);
    const std::string key = "column " + std::to_string(index + 1) + ": ";
    if (number_in(trimmed(cell)))
      lines.fail(key + "found the number " + shown(cell) +
                 "; the first line names the columns, such as time_s,ax_gal");
    if (is_time(column)) {
      if (columns.time >= 0) lines.fail(key + "a second column of times");
      if (!column.unit.empty() && column.unit != "s" && column.unit != "ms")
        lines.fail(key + shown(column.unit) + " is not a unit of time; known: s, ms");
      columns.time = index;
      if (column.unit == "ms") columns.time_unit = 1e-3;
      continue;
    }
    const std::string_view unit = acceleration_unit(column.unit);
    if (unit.empty() && notes.unit.empty())
      lines.fail(key + shown(cell) + " does not end in a unit of acceleration, such as ax_gal; " +
                 k_known_units + "; or give unit in the scene");
    columns.at.push_back(index);
    columns.units.push_back(chosen_unit(lines, unit, notes));
  }
  if (columns.at.empty() || columns.at.size() > 3)
    lines.fail("columns: found " + std::to_string(columns.at.size()) + " of acceleration, expected 1 to 3");
  return columns;
}

// Equal steps between times that may be rounded. `line_of`: the line of the first.
double common_interval(const std::vector<double>& times, const std::vector<int>& line_of,
                       const Lines& lines) {
  constexpr double k_slack = 0.2;
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (!(steps[i] > 0))
      lines.fail_at(line_of[i + 1], "time: " + short_number(times[i + 1]) + " s does not come after " +
                                        short_number(times[i]) + " s");
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double usual = *middle, interval = (times.back() - times.front()) / static_cast<double>(steps.size());
  const auto refuse = [&](std::size_t i) {
    lines.fail_at(line_of[i + 1], "time: a step of " + short_number(steps[i]) + " s, from " +
                                      short_number(times[i]) + " s to " + short_number(times[i + 1]) +
                                      " s, where the others are " + short_number(usual) +
                                      " s; samples are equally spaced");
  };
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::abs(steps[i] - usual) > k_slack * usual) refuse(i);
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (std::abs(times[i + 1] - times[0] - static_cast<double>(i + 1) * interval) > k_slack * usual)
      refuse(i);
  return interval;
}

AccelerogramFile read_csv(std::string_view text, const std::string& name, const AccelerogramNotes& notes) {
  Lines lines(text, name);
  next_content(lines);
  const int header_line = lines.number();
  const char separator = separator_of(lines.line());
  const Columns columns = read_header(lines, separator, notes);
  if (columns.time >= 0 && notes.interval)
    lines.fail("dt: the file has a column of times; leave dt out in the scene");
  if (columns.time < 0 && !notes.interval)
    lines.fail("time: there is no column of times, such as time_s, and no dt in the scene");

  AccelerogramFile file{AccelerogramFile::Format::csv, 0, {}};
  file.components.resize(columns.at.size());
  std::vector<Largest> largest(columns.at.size());
  std::vector<double> times;
  std::vector<int> line_of;
  bool gap = false;
  while (lines.next()) {
    const std::string_view line = trimmed(lines.line());
    if (line.starts_with('#')) continue;
    if (line.empty()) {
      gap = true;
      continue;
    }
    if (gap) lines.fail("an empty line before it; samples follow each other without gaps");
    const std::vector<std::string_view> cells = cells_of(lines.line(), separator);
    if (cells.size() != columns.count)
      lines.fail("found " + std::to_string(cells.size()) + " columns, expected " +
                 std::to_string(columns.count) + " as in the header");
    const auto cell = [&](int index) {
      const std::string_view value = cells[static_cast<std::size_t>(index)];
      const std::string key = "column " + std::to_string(index + 1) + ": ";
      if (value.empty()) lines.fail(key + "is empty; samples follow each other without gaps");
      return finite_number(value, lines, key);
    };
    if (columns.time >= 0) {
      times.push_back(columns.time_unit * cell(columns.time));
      line_of.push_back(lines.number());
    }
    for (std::size_t k = 0; k < columns.at.size(); ++k) {
      const double value = cell(columns.at[k]);
      largest[k].meet(value, lines.number());
      file.components[k].push_back(value);
    }
    if (static_cast<double>(file.components[0].size()) > k_most_samples)
      lines.fail("more samples than the " + count_text(k_most_samples) + " that are allowed");
  }
  if (file.components[0].size() < 2)
    lines.fail_at(header_line, "found " + std::to_string(file.components[0].size()) +
                                   " samples below it, expected 2 or more");
  file.interval = notes.interval ? *notes.interval : common_interval(times, line_of, lines);
  if (columns.time >= 0) check_interval(lines, header_line, "time: ", file.interval);
  for (std::size_t k = 0; k < columns.at.size(); ++k) {
    check_peak(lines, largest[k].line, largest[k].size, columns.units[k]);
    to_si(file.components[k], unit_value(columns.units[k], Dimension::acceleration));
  }
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
