// `topple export`: tables of a recording.
#pragma once

#include <string>

namespace topple::app {

struct ExportOptions {
  std::string recording;
  std::string csv;   ///< folder; or
  std::string xdmf;  ///< file; or
  std::string vtk;   ///< folder
};
int export_command(const ExportOptions& options);

}  // namespace topple::app
