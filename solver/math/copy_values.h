// Copies of values that own nothing, as Vec3 and what is made of it.
#pragma once

#include <cstring>
#include <span>
#include <type_traits>

namespace topple {

// Writes `count` values of `from` to `to` as bytes: an assignment of Eigen's goes number by number.
template <class T>
void copy_values(const T* from, std::size_t count, T* to) {
  static_assert(std::is_trivially_destructible_v<T>);
  const std::span bytes = std::as_bytes(std::span(from, count));
  if (count > 0) std::memcpy(std::as_writable_bytes(std::span(to, count)).data(), bytes.data(), bytes.size());
}

}  // namespace topple
