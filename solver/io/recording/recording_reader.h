// Reading data sets of rows, for Recording.
#pragma once

#include <string>
#include <vector>

#include "solver/io/recording/recording_format.h"

namespace topple::io {

/// An extendible data set opened for reading.
class RowReader {
 public:
  RowReader() = default;
  /// Throws Hdf5Error when the data set is missing or does not hold rows of `type`.
  RowReader(hid_t group, const char* name, hid_t type);
  hsize_t rows() const { return dims_[0]; }
  /// Dimensions of one row.
  std::vector<hsize_t> row_dims() const { return {dims_.begin() + 1, dims_.end()}; }
  /// `to`: room for `count` rows. Throws Hdf5Error.
  void read(hsize_t first, hsize_t count, void* to) const;
  /// Looks again how many rows there are in a file that somebody else is writing.
  void refresh();

 private:
  void read_extent();
  Handle set_, type_;
  std::vector<hsize_t> dims_;
};

/// Rows of a set of records up to the last one that was written. Throws Hdf5Error when one does not have its
/// checksum.
template <typename Record>
std::vector<Record> read_records(const RowReader& set, const char* name) {
  std::vector<Record> records(set.rows());
  if (!records.empty()) set.read(0, records.size(), records.data());
  while (!records.empty() && records.back().branch == k_not_written) records.pop_back();
  for (const Record& record : records) {
    if (record.checksum != record_checksum(record)) {
      throw Hdf5Error(std::string(name) + " is damaged (checksum differs)");
    }
  }
  return records;
}

/// Branches and edits from their records. Throws Hdf5Error for one that does not follow from those before it,
/// has an unknown key or a value out of range.
History read_history(const std::vector<BranchRecord>& branches, const std::vector<EditRecord>& edits);

bool has_branch(const History& history, std::int32_t id);

}  // namespace topple::io
