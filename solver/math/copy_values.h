// Copies of arrays of values that own no memory, such as Vec3.
#pragma once

#include <cstring>
#include <span>
#include <type_traits>

namespace topple {

/// Copies `count` values with one memcpy: an assignment of Eigen vectors goes number by number. The arrays do
/// not overlap.
template <class T>
void copy_values(const T* from, std::size_t count, T* to) {
  static_assert(std::is_trivially_destructible_v<T>);
  const std::span bytes = std::as_bytes(std::span(from, count));
  if (count > 0) std::memcpy(std::as_writable_bytes(std::span(to, count)).data(), bytes.data(), bytes.size());
}

}  // namespace topple
