#include "solver/study/validate/data_table.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "solver/io/common/errors.h"

namespace topple::study {

namespace fs = std::filesystem;

namespace {

std::string_view stripped(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// In quotes, as much as a line of a message has room for.
std::string in_quotes(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return '"' + out + '"';
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(stripped(line.substr(begin, end - begin)));
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

std::optional<double> number_in(std::string_view text) {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Where the wanted columns stand in the header.
std::vector<std::size_t> places_of(const std::vector<std::string_view>& header, const std::string& name,
                                   const std::vector<std::string_view>& columns) {
  std::vector<std::size_t> places;
  for (const std::string_view column : columns) {
    const auto found = std::ranges::find(header, column);
    if (found == header.end())
      throw io::InputError(fmt::format("{}:1: there is no column {}, found {}", name, column,
                                       in_quotes(fmt::format("{}", fmt::join(header, ",")))));
    if (std::count(header.begin(), header.end(), column) > 1)
      throw io::InputError(fmt::format("{}:1: the column {} is there twice", name, column));
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  return places;
}

}  // namespace

std::string unpacked(const fs::path& path) {
  const std::string name = path.string();
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(name.c_str(), "rb"), gzclose);
  if (!file) throw io::InputError(name + ": cannot be read");
  std::string text;
  std::vector<char> part(std::size_t{1} << 18);
  for (int count = 0; (count = gzread(file.get(), part.data(), static_cast<unsigned>(part.size()))) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(count));
    if (text.size() > k_most_bytes)
      throw io::InputError(fmt::format("{}: holds more than {} bytes", name, k_most_bytes));
  }
  int error = Z_OK;
  const char* what = gzerror(file.get(), &error);
  if (error == Z_BUF_ERROR) throw io::InputError(name + ": is cut off: its gzip stream has no end");
  if (error != Z_OK)
    throw io::InputError(name + ": cannot be read: " + (error == Z_ERRNO ? "it is no file" : what));
  return text;
}

DataTable::DataTable(std::string_view text, std::string name, const std::vector<std::string_view>& columns)
    : name_(std::move(name)), columns_(columns.begin(), columns.end()) {
  int line = 0;
  std::vector<std::size_t> places;
  std::size_t width = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view row = stripped(text.substr(begin, end - begin));
    begin = end + 1, ++line;
    if (row.empty() && line > 1) continue;
    const std::vector<std::string_view> fields = fields_of(row);
    if (line == 1) {
      places = places_of(fields, name_, columns);
      width = fields.size();
      continue;
    }
    if (fields.size() != width)
      throw io::InputError(
          fmt::format("{}:{}: has {} fields, the header {}", name_, line, fields.size(), width));
    lines_.push_back(line);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const std::string_view field = fields[places[c]];
      const std::optional<double> value = number_in(field);
      if (!value)
        throw io::InputError(
            fmt::format("{}:{}: {}: {}", name_, line, columns_[c],
                        field.empty() ? "is missing" : in_quotes(field) + " is no finite number"));
      values_.push_back(*value);
    }
  }
  if (places.empty()) throw io::InputError(name_ + ": is empty");
}

void DataTable::fail(std::size_t row, std::size_t column, const std::string& message) const {
  throw io::InputError(fmt::format("{}:{}: {}: {}", name_, lines_[row], columns_[column], message));
}

int DataTable::whole(std::size_t row, std::size_t column, int least, int most) const {
  const double value = at(row, column);
  if (!(value >= least && value <= most) || value != std::floor(value))
    fail(row, column, fmt::format("{:g} is not a whole number in {}..{}", value, least, most));
  return static_cast<int>(value);
}

void DataTable::expect_rising(std::size_t column) const {
  for (std::size_t row = 1; row < rows(); ++row)
    if (!(at(row, column) > at(row - 1, column)))
      fail(row, column, fmt::format("{:g} does not come after {:g}", at(row, column), at(row - 1, column)));
}

std::vector<std::string> text_column(std::string_view text, std::string_view column) {
  std::vector<std::string> out;
  std::optional<std::size_t> place;
  for (std::size_t begin = 0, line = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view row = stripped(text.substr(begin, end - begin));
    begin = end + 1;
    const std::vector<std::string_view> fields = fields_of(row);
    if (line == 0) {
      const auto found = std::ranges::find(fields, column);
      if (found == fields.end()) return {};
      place = static_cast<std::size_t>(found - fields.begin());
    } else if (!row.empty() && *place < fields.size()) {
      out.emplace_back(fields[*place]);
    }
  }
  return out;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file()) files.push_back(entry->path());
  if (error) throw io::InputError(folder.string() + ": cannot be read as a folder: " + error.message());
  if (files.empty()) throw io::InputError(folder.string() + ": is an empty folder");
  std::ranges::sort(files);
  return files;
}

}  // namespace topple::study
