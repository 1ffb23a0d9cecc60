#include <algorithm>

#include "solver/io/accelerogram/accelerogram_text.h"
#include "solver/io/common/units.h"

namespace topple::io::accelerogram {
namespace {

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
                 known_units() + "; or give unit in the scene");
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

}  // namespace

bool is_csv(std::string_view text, const std::string& name, const AccelerogramNotes& notes) {
  Lines lines(text, name);
  if (!next_content(lines)) return false;
  const std::string_view header = trimmed(lines.line());
  // one column alone has its times from the scene
  return header.find_first_of(",;\t") != std::string_view::npos || notes.interval ||
         !acceleration_unit(read_column(header).unit).empty();
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
      largest[k].update(value, lines.number());
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

}  // namespace topple::io::accelerogram
