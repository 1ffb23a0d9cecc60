// `topple report`: a run as a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace topple::app {

struct ReportOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string file;                    ///< HTML; empty: NAME-report.html in the working folder
  std::string language = "en";         ///< en or ja
  std::optional<int> jobs;             ///< runs at a time; absent: one per core
  bool quiet = false;
};
int report_command(const ReportOptions& options);

}  // namespace topple::app
