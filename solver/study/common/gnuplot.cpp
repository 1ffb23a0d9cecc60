#include "solver/study/common/gnuplot.h"

#include <optional>
#include <system_error>
#include <vector>

#include "solver/io/host/process.h"

namespace topple::study {

std::string run_gnuplot(const std::string& script) {
  host::MemoryFile input("gnuplot"), output("gnuplot"), errors("gnuplot");
  input.write(script);
  std::optional<host::Process> process;
  try {
    process.emplace(
        "gnuplot", std::vector<std::string>{"-d"},  // no settings of the user
        host::Streams{
            .input = input.descriptor(), .output = output.descriptor(), .errors = errors.descriptor()});
  } catch (const std::system_error& error) {
    throw ChartError(std::string(error.what()) + "; charts need the Debian package gnuplot-nox");
  }
  const host::Ended ended = process->wait();
  std::string chart = output.content();
  if (ended.good() && !chart.empty()) return chart;
  const std::string line = host::last_line(errors.content());
  throw ChartError("gnuplot failed (" + in_words(ended) + ")" + (line.empty() ? "" : ": " + line));
}

std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    switch (c) {
      case '\n':
      case '\r':
        quoted += ' ';
        break;
      case '"':
        quoted += "\\042";
        break;
      case '\\':
        quoted += "\\134";
        break;
      case '`':
        quoted += "\\140";
        break;  // a command to run
      default:
        quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace topple::study
