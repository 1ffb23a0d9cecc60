// Values by their bits.
#pragma once

#include <cstring>
#include <type_traits>

namespace topple {

/// A To of the bits of `from`, as std::bit_cast, which the standard library of emscripten (LLVM 13) lacks.
template <class To, class From>
To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

}  // namespace topple
