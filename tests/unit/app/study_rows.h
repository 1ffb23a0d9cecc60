// Rows that a study of the program wrote.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

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

/// Runs the program with these words on two ranks with a thread each. False where that is not to be had:
/// mpirun is not installed, or topple was built without MPI.
inline bool run_on_two_ranks(const std::vector<std::string>& words) {
  if (std::system("command -v mpirun >/dev/null") != 0) return false;
  std::string line =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 " TOPPLE_PROGRAM;
  for (const std::string& word : words) line += " '" + word + "'";
  const int code = std::system((line + " >out 2>err").c_str());
  if (bytes_of("err").find("this build of topple has no MPI") != std::string::npos) return false;
  EXPECT_EQ(code, 0) << bytes_of("err");
  return true;
}

}  // namespace topple::app
