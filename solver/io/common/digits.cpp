#include "solver/io/common/digits.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace topple::io {

#if defined(__cpp_lib_to_chars)

std::string shortest_digits(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::from_chars_result read_digits(const char* from, const char* end, double& value, bool fixed) {
  return std::from_chars(from, end, value, fixed ? std::chars_format::fixed : std::chars_format::general);
}

#else  // the C library has one locale there, "C"

namespace {

constexpr int k_most_digits = 17;  // of a double

const char* after_digits(const char* at, const char* end) {
  while (at != end && *at >= '0' && *at <= '9') ++at;
  return at;
}

/// Behind the number that begins at `from`; `from` itself: none does.
const char* after_number(const char* from, const char* end, bool fixed) {
  const char* const whole = from + (from != end && *from == '-' ? 1 : 0);
  const char* at = after_digits(whole, end);
  auto digits = at - whole;
  if (at != end && *at == '.') {
    const char* const part = at + 1;
    at = after_digits(part, end);
    digits += at - part;
  }
  if (digits == 0) return from;
  if (fixed || at == end || (*at != 'e' && *at != 'E')) return at;
  const char* const exponent = at + 1 + (at + 1 != end && (at[1] == '-' || at[1] == '+') ? 1 : 0);
  const char* const behind = after_digits(exponent, end);
  return behind == exponent ? at : behind;
}

}  // namespace

std::string shortest_digits(double value) {
  char text[40];
  for (int digits = 1; digits <= k_most_digits; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

std::from_chars_result read_digits(const char* from, const char* end, double& value, bool fixed) {
  const char* const behind = after_number(from, end, fixed);
  if (behind == from) return {from, std::errc::invalid_argument};
  const double read = std::strtod(std::string(from, behind).c_str(), nullptr);
  if (!std::isfinite(read)) return {behind, std::errc::result_out_of_range};
  value = read;
  return {behind, std::errc()};
}

#endif

}  // namespace topple::io
