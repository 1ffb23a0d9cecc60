#include "app/page/page_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "solver/io/common/errors.h"

namespace topple::app {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Hands every value that a page holds to `each(pointer, bytes)`, always in one order.
template <class Row, class Each>
void for_packed(Row& row, const Each& each) {
  const auto list = [&](auto& values) { each(values.data(), values.size() * sizeof values[0]); };
  each(&row.step, sizeof row.step);
  each(&row.time, sizeof row.time);
  each(&row.load_factor, sizeof row.load_factor);
  each(row.floor_acceleration, sizeof row.floor_acceleration);
  each(row.floor_displacement, sizeof row.floor_displacement);
  list(row.body);
  list(row.anchor);
  list(row.position);
  list(row.rotation);
  list(row.section_force);
  list(row.s);
  list(row.hinge);
  list(row.level);
}

}  // namespace

std::size_t packed_size(const Model& model) {
  std::size_t size = 0;
  const io::FrameRow row = io::blank_row(io::row_shape(model));
  for_packed(row, [&](const void*, std::size_t bytes) { size += bytes; });
  return size;
}

std::size_t page_stride(const Model& model, std::size_t rows) {
  const std::size_t most = std::max<std::size_t>(k_most_page_bytes / packed_size(model), 2);
  return rows <= most ? 1 : (rows - 2) / (most - 1) + 1;
}

std::string pack_rows(const std::vector<io::FrameRow>& rows) {
  std::string out;
  for (const io::FrameRow& row : rows)
    for_packed(
        row, [&](const void* from, std::size_t bytes) { out.append(static_cast<const char*>(from), bytes); });
  return out;
}

std::vector<io::FrameRow> unpack_rows(const Model& model, std::string_view bytes) {
  const std::size_t size = packed_size(model);
  if (bytes.size() % size != 0) throw io::InputError("the recorded rows are not those of this scene");
  std::vector<io::FrameRow> rows;
  while (!bytes.empty()) {
    rows.push_back(io::blank_row(io::row_shape(model)));
    rows.back().knows_contacts = false;
    for_packed(rows.back(), [&](void* to, std::size_t count) {
      std::memcpy(to, bytes.data(), count);
      bytes.remove_prefix(count);
    });
    if (!is_finite(rows.back())) rows.pop_back();
  }
  return rows;
}

double floor_along(const io::FrameRow& row, const std::vector<Shake>& shakes) {
  return shakes.empty() ? 0 : Vec3(row.floor_acceleration).dot(shakes.front().direction);
}

double floor_peak(const std::vector<io::FrameRow>& rows, const std::vector<Shake>& shakes) {
  constexpr double k_interval = 1e-3;  // s: off by 0.1 % of the peak at most up to 14 Hz
  constexpr double k_same = 1e-5;      // m/s^2, times of rows are rounded
  double peak = 0;
  bool unchanged = !rows.empty();
  for (const io::FrameRow& row : rows) {
    peak = std::max(peak, std::abs(floor_along(row, shakes)));
    unchanged =
        unchanged && (Vec3(row.floor_acceleration) - floor_acceleration(shakes, row.time)).norm() < k_same;
  }
  if (!unchanged || shakes.empty()) return peak;
  const auto steps = static_cast<int>((rows.back().time - rows.front().time) / k_interval);
  for (int k = 0; k < steps; ++k) {
    const Vec3 floor = floor_acceleration(shakes, rows.front().time + k * k_interval);
    peak = std::max(peak, std::abs(floor.dot(shakes.front().direction)));
  }
  return peak;
}

double floor_scale(const std::vector<io::FrameRow>& rows, const std::vector<Shake>& shakes) {
  constexpr double k_least = 0.1;  // m/s^2
  return std::max(floor_peak(rows, shakes), k_least);
}

}  // namespace topple::app
