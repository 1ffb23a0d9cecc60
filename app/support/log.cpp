#include "app/support/log.h"

#include <fmt/format.h>

#include <cstdio>

namespace topple::app {

void log_message(const std::string& message) {
  std::string line = "topple: ";
  for (const char c : message) {
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f)
      line += fmt::format("\\x{:02x}", byte);
    else
      line += c;
  }
  line += '\n';
  std::fputs(line.c_str(), stderr);
}

}  // namespace topple::app
