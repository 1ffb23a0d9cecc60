// Numbers as digits, in any locale.
#pragma once

#include <charconv>
#include <string>

namespace topple::io {

/// The shortest digits that read back the same.
std::string shortest_digits(double value);

/// std::from_chars of a double, which the standard library of emscripten (LLVM 13) lacks. fixed: digits and a
/// point, no exponent.
std::from_chars_result read_digits(const char* from, const char* end, double& value, bool fixed = false);

}  // namespace topple::io
