// What the harnesses share. A harness aborts when what it tries breaks its promise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace topple {

inline void promise(bool kept, const char* what, const std::string& found = {}) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s: %s\n", what, found.c_str());
  std::abort();
}

/// A refusal is one line.
inline void promise_one_line(const std::string& error) {
  promise(!error.empty() && error.find('\n') == std::string::npos, "a refusal is one line", error);
}

}  // namespace topple

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
