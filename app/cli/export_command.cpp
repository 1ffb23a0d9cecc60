#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/recorded_run.h"
#include "app/cli/command.h"
#include "app/gltf/export_gltf.h"
#include "app/page/export_page.h"
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
  std::string csv;                        ///< folder; or
  std::string xdmf;                       ///< file; or
  std::string vtk;                        ///< folder; or
  std::string gltf;                       ///< file; or
  std::string page;                       ///< file
  std::vector<std::string> overrides;     ///< of the scene of a page, KEY=VALUE
  Language language = Language::english;  ///< of the page
  bool quiet = false;
  bool force = false;  ///< in place of files of any kind
};

bool is_scene(const std::string& source) {
  return !io::is_recording(source);
}

int write_page(const ExportOptions& options, const io::Scene& scene, const std::string& file) {
  const io::Recording recording(file);
  const PageRun run = page_run(scene, recording);
  const std::string page = page_of(scene, run, options.language, [] { return !interrupted(); });
  if (page.empty()) {
    log_message("interrupted; " + options.page + " is not written");
    return k_interrupted;
  }
  write_whole_file({options.page, options.force}, host::FileKind::html, page);
  if (const std::string why = in_words(why_replay_only(scene, run), Language::english); !why.empty())
    log_message(options.page + ": " + why);
  return k_done;
}

/// A scene is run for it.
int export_page(const ExportOptions& options) {
  require_pages("--page");
  if (!is_scene(options.recording)) {
    if (!options.overrides.empty())
      throw BadInput("--set: " + options.recording + " is a recording; only a scene can be changed");
    require_writable_file("--page", {options.page, options.force}, host::FileKind::html, options.recording);
    const io::Recording recording = open_foreign_recording(options.recording);
    defer_interrupts();
    return write_page(options, recorded_scene(recording), options.recording);
  }
  const io::Scene scene = io::load_scene(options.recording, options.overrides);
  require_no_record("--page", options.page, options.recording, scene);
  require_writable_file("--page", {options.page, options.force}, host::FileKind::html, options.recording);
  defer_interrupts();
  const TemporaryFile file;
  const RecordedRun run = record(scene, file.path(), {.quiet = options.quiet, .jobs = 1});
  if (!run.trouble.empty()) log_message(run.trouble);
  if (run.exit_code == k_interrupted || !run.recorded) return run.exit_code;
  const int written = write_page(options, scene, file.path());
  return written == k_done ? run.exit_code : written;
}

int export_command(const ExportOptions& options) {
  if (!options.page.empty()) return export_page(options);
  if (!options.overrides.empty()) throw BadInput("--set: only a scene for --page can be changed");
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
                   "topple export paper-a.h5 --gltf paper-a.glb\n  topple export paper-a --page paper-a.html",
                   export_command);
  add_path(command, "RECORDING", data.recording, "", "recording; for --page a scene as well").required();
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
  add_path(what, "--page", data.page, "FILE.html",
           "a page for any browser that replays the run, and computes it anew when a slider moves");
  what.require_option(1);
  add_set(command, data.overrides);
  add_language(command, data.language, "en (default) or ja, of the page");
  add_quiet(command, data.quiet);
  add_force(command, data.force);
}

}  // namespace topple::app
