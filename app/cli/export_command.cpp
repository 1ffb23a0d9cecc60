#include "app/cli/export_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "solver/io/export/export_csv.h"
#include "solver/io/export/export_vtk.h"
#include "solver/io/export/export_xdmf.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

int export_command(const ExportOptions& options) {
  if (!io::is_recording(options.recording) && !std::filesystem::exists(options.recording))
    for (const io::BuiltinScene& scene : io::builtin_scenes())
      if (scene.name == options.recording)
        throw BadInput(
            fmt::format("{0}: is a scene, not a recording; topple run {0} -o {0}.h5 makes one", scene.name));
  const io::Recording recording = open_foreign_recording(options.recording);
  if (!options.xdmf.empty()) {
    for (const std::string& file : {options.xdmf, options.xdmf + ".h5"})
      require_writable_file("--xdmf", file, options.recording);
    if (std::filesystem::path(options.xdmf).filename().string().find(':') != std::string::npos)
      throw BadInput("--xdmf: " + options.xdmf + ": ParaView finds no data behind a name with a colon");
    io::export_xdmf(recording, options.xdmf);
    return k_done;
  }
  const std::string& folder = options.csv.empty() ? options.vtk : options.csv;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadInput(folder + ": cannot be created: " + error.message());
  require_writable_folder(folder, folder);
  if (options.csv.empty())
    io::export_vtk(recording, folder);
  else
    io::export_csv(recording, folder);
  return k_done;
}

}  // namespace topple::app
