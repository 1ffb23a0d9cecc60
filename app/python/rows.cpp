#include "app/python/rows.h"

#include <algorithm>

namespace topple::python {

void Rows::reserve(std::size_t rows) {
  branch_.reserve(rows);
  step_.reserve(rows);
  time_.reserve(rows);
  const io::FrameRow blank = io::blank_row(shape_);
  const auto bytes = io::field_bytes(blank);
  for (std::size_t k = 0; k < bytes.size(); ++k) fields_[k].reserve(rows * bytes[k].size());
}

void Rows::add(const io::FrameRow& row) {
  branch_.push_back(row.branch);
  step_.push_back(row.step);
  time_.push_back(row.time);
  const auto bytes = io::field_bytes(row);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    fields_[k].insert(fields_[k].end(), bytes[k].begin(), bytes[k].end());
}

void Rows::clear() {
  branch_.clear();
  step_.clear();
  time_.clear();
  for (auto& field : fields_) field.clear();
}

io::FrameRow Rows::row(std::size_t number) const {
  io::FrameRow row = io::blank_row(shape_);
  row.branch = branch_[number];
  row.step = step_[number];
  row.time = time_[number];
  const auto bytes = io::field_bytes(row);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    std::copy_n(fields_[k].begin() + static_cast<std::ptrdiff_t>(number * bytes[k].size()), bytes[k].size(),
                bytes[k].begin());
  return row;
}

}  // namespace topple::python
