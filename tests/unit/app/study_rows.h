// Rows that a study of the program wrote.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>

#include "program.h"

namespace topple::app {

/// Those of a CSV file without their last column, the CPU time.
inline std::string rows_of(const std::string& csv) {
  std::istringstream lines(bytes_of(csv));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

inline int lines_in(const std::string& file) {
  const std::string text = bytes_of(file);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace topple::app
