// The fields of rows as NumPy arrays that share their memory.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <span>
#include <string>

#include "app/python/rows.h"

namespace topple::python {

namespace py = pybind11;

enum class Number { f32, f64, u8 };

/// An array of Python: a field of rows, or some of its columns.
struct ArrayTraits {
  const char* name;
  Field field;
  Number number;
  const char* axis;                   ///< for people: "node"; empty: none
  std::size_t io::RowShape::*length;  ///< of that axis
  int columns;                        ///< of the field's last axis; 0: it has none
  int first, count;                   ///< columns that are taken; of one the last axis is left out
  const char* about;                  ///< with the unit
};
std::span<const ArrayTraits> arrays();

/// "[row, node, 3] m: of nodes, floor's frame".
std::string doc(const ArrayTraits& array, bool rows);

/// Read-only views, which keep the rows alive. `axis` false: of the only row, without an axis for rows.
py::array view(const std::shared_ptr<const Rows>& rows, const ArrayTraits& array, bool axis);
/// By name of the column.
py::dict energy_view(const std::shared_ptr<const Rows>& rows, bool axis);
py::array time_view(const std::shared_ptr<const Rows>& rows);
py::array step_view(const std::shared_ptr<const Rows>& rows);

}  // namespace topple::python
