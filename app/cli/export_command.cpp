#include <fmt/format.h>

#include <filesystem>

#include "app/cli/command.h"
#include "app/gltf/export_gltf.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/io/export/export_csv.h"
#include "solver/io/export/export_vtk.h"
#include "solver/io/export/export_xdmf.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

struct ExportOptions {
  std::string recording;
  std::string csv;     ///< folder; or
  std::string xdmf;    ///< file; or
  std::string vtk;     ///< folder; or
  std::string gltf;    ///< file
  bool force = false;  ///< in place of files of any kind
};

int export_command(const ExportOptions& options) {
  if (!io::is_recording(options.recording) && !std::filesystem::exists(options.recording))
    for (const io::BuiltinScene& scene : io::builtin_scenes())
      if (scene.name == options.recording)
        throw BadInput(
            fmt::format("{0}: is a scene, not a recording; topple run {0} -o {0}.h5 makes one", scene.name));
  const io::Recording recording = open_foreign_recording(options.recording);
  defer_interrupts();
  const auto proceed = [] { return !interrupted(); };
  const auto end = [](bool whole, const std::string& target) {
    if (!whole) log_message("interrupted; " + target + " is not written");
    return whole ? k_done : k_interrupted;
  };
  if (!options.xdmf.empty()) {
    require_writable_file("--xdmf", {options.xdmf, options.force}, host::FileKind::xdmf, options.recording);
    require_writable_file("--xdmf", {options.xdmf + ".h5", options.force}, host::FileKind::hdf5,
                          options.recording);
    if (std::filesystem::path(options.xdmf).filename().string().find(':') != std::string::npos)
      throw BadInput("--xdmf: " + options.xdmf + ": ParaView finds no data behind a name with a colon");
    return end(io::export_xdmf(recording, {options.xdmf, options.force}, proceed), options.xdmf);
  }
  if (!options.gltf.empty()) {
    require_writable_file("--gltf", {options.gltf, options.force}, host::FileKind::gltf, options.recording);
    return end(export_gltf(recording, {options.gltf, options.force}, proceed), options.gltf);
  }
  const std::string& folder = options.csv.empty() ? options.vtk : options.csv;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw BadInput(folder + ": cannot be created: " + error.message());
  require_writable_folder(folder, folder);
  const auto& write = options.csv.empty() ? io::export_vtk : io::export_csv;
  return end(write(recording, {folder, options.force}, proceed), folder);
}

}  // namespace

void add_export(Commands& commands) {
  const auto [command, data] =
      commands.add("export", "data of a recording for spreadsheets, ParaView and 3D viewers",
                   "export paper-a.h5 --csv paper-a-data\n  topple export paper-a.h5 --xdmf paper-a.xdmf\n  "
                   "topple export paper-a.h5 --gltf paper-a.glb",
                   export_command);
  add_path(command, "RECORDING", data.recording, "", "recording").required();
  CLI::Option_group& what = *command.add_option_group("output", "what to write");
  add_path(
      what, "--csv", data.csv, "DIR",
      "folder for bodies.csv, nodes.csv, elements.csv, contacts.csv, floor.csv, energy.csv, anchors.csv");
  add_path(what, "--xdmf", data.xdmf, "FILE.xdmf",
           "for ParaView 5.11 and later; the data go to FILE.xdmf.h5");
  add_path(what, "--vtk", data.vtk, "DIR",
           "folder for frames.pvd and a .vtp file a frame, for what reads VTK's own format");
  add_path(what, "--gltf", data.gltf, "FILE.glb",
           "for 3D viewers and Blender: an animated model, coloured by stress");
  what.require_option(1);
  add_force(command, data.force);
}

}  // namespace topple::app
