// Tables of measured data as others hand them on: CSV, plain or packed by gzip.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace topple::study {

/// All bytes of a file, unpacked where it is packed by gzip. Throws io::InputError "PATH: ..." when it cannot
/// be read, is cut off or damaged, or holds more than k_most_bytes.
std::string unpacked(const std::filesystem::path& path);
inline constexpr std::size_t k_most_bytes = std::size_t{1} << 30;

/// The columns that are asked for of a table of numbers: a header that names them with their units, then a
/// row a line. Others are left out.
class DataTable {
 public:
  /// `name`: of the file, for messages. Throws io::InputError "NAME:LINE: ..." where a column is missing or
  /// twice, a row has another count of fields, and where a wanted field is no finite number.
  DataTable(std::string_view text, std::string name, const std::vector<std::string_view>& columns);

  std::size_t rows() const { return lines_.size(); }
  /// `column`: as they were asked for.
  double at(std::size_t row, std::size_t column) const { return values_[row * columns_.size() + column]; }
  int line(std::size_t row) const { return lines_[row]; }
  /// Throws io::InputError "NAME:LINE: COLUMN: MESSAGE".
  [[noreturn]] void fail(std::size_t row, std::size_t column, const std::string& message) const;
  /// A whole number in least..most, or fails.
  int whole(std::size_t row, std::size_t column, int least, int most) const;
  /// Fails unless the values of this column rise from row to row.
  void expect_rising(std::size_t column) const;

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<double> values_;
  std::vector<int> lines_;
};

/// The column of a table of that form as texts; empty where there is none.
std::vector<std::string> text_column(std::string_view text, std::string_view column);

/// A file that is left out of many, and why: one line.
using Skipped = std::vector<std::string>;

/// Ordinary files in a folder by name; throws io::InputError when it is none or has none.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace topple::study
