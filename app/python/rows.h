// Rows of a run side by side: one block of memory for each field.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/io/recording/recording_format.h"

namespace topple::python {

/// In the order of io::field_bytes.
enum Field : std::size_t {
  k_position,
  k_rotation,
  k_section_force,
  k_s,
  k_hinge,
  k_contact_depth,
  k_contact_force,
  k_member_contact,
  k_panel_contact,
  k_energy,
  k_body,
  k_level,
  k_floor_acceleration,
  k_floor_displacement,
  k_load_factor,
  k_anchors
};

/// Rows of one model. What it holds stays in its place as long as no row is added beyond reserve().
class Rows {
 public:
  explicit Rows(const io::RowShape& shape) : shape_(shape) {}

  void reserve(std::size_t rows);
  void add(const io::FrameRow& row);
  /// Takes all rows away; the memory stays.
  void clear();

  const io::RowShape& shape() const { return shape_; }
  std::size_t size() const { return time_.size(); }
  io::FrameRow row(std::size_t number) const;
  const std::vector<std::int32_t>& branch() const { return branch_; }
  const std::vector<std::int64_t>& step() const { return step_; }
  const std::vector<double>& time() const { return time_; }  ///< s
  /// Of all rows.
  const std::vector<std::byte>& bytes(Field field) const { return fields_[field]; }

 private:
  io::RowShape shape_;
  std::vector<std::int32_t> branch_;
  std::vector<std::int64_t> step_;
  std::vector<double> time_;
  std::array<std::vector<std::byte>, io::k_field_count> fields_;
};

}  // namespace topple::python
