// Copies of values that own nothing, as Vec3 and what is made of it.
#pragma once

#include <cstring>
#include <type_traits>

namespace topple {

/// Copies them as bytes (Eigen would go number by number) to where there is room for them.
template <class T>
void copy_values(const T* from, std::size_t count, T* to) {
  static_assert(std::is_trivially_destructible_v<T>);
  if (count > 0) std::memcpy(static_cast<void*>(to), from, count * sizeof(T));
}

}  // namespace topple
