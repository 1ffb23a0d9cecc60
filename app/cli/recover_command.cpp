#include <fmt/format.h>

#include <filesystem>

#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/io/recording/recover.h"

namespace topple::app {
namespace {

struct RecoverOptions {
  std::string recording;
  std::string output;  ///< empty: NAME.recovered.h5 beside it
  bool force = false;  ///< in place of files of any kind
};

/// "a.h5" gives "a.recovered.h5".
std::string recovered_name(const std::string& recording) {
  std::filesystem::path path(recording);
  if (path.extension() == ".h5") path.replace_extension();
  return path.string() + ".recovered.h5";
}

int recover_command(const RecoverOptions& options) {
  const std::string& from = options.recording;
  const io::Recording recording = open_foreign_recording(from);
  const io::SoundRows rows = io::sound_rows(recording);
  if (rows.frames.empty())
    throw BadInput(from + ": holds no frame that can be read; nothing can be recovered");
  if (!recording.left_open() && rows.damaged_frames + rows.damaged_checkpoints == 0) {
    fmt::print("{}: is whole and closed ({}, {} frames); nothing to recover\n", from, recording.status(),
               rows.frames.size());
    return k_done;
  }
  const std::string to = options.output.empty() ? recovered_name(from) : options.output;
  require_writable_file("--output", {to, options.force}, host::FileKind::hdf5, from);
  defer_interrupts();
  if (!io::write_recovered(recording, rows, {to, options.force}, [] { return !interrupted(); })) {
    log_message("interrupted; " + to + " is not written");
    return k_interrupted;
  }
  fmt::print("{}: {}, {} frames to {:g} s, {} checkpoints, {} events, {} edits\n", to, recording.status(),
             rows.frames.size(), recording.index()[static_cast<std::size_t>(rows.frames.back())].time,
             rows.checkpoints.size(), recording.events().size(), recording.history().edits.size());
  const std::int64_t begun = recording.incomplete_frames();
  if (begun + rows.damaged_frames + rows.damaged_checkpoints > 0)
    fmt::print("left out: {} frames that were not written to their end; damaged: {} frames, {} checkpoints\n",
               begun, rows.damaged_frames, rows.damaged_checkpoints);
  if (recording.status() == "interrupted")
    fmt::print("what came after {:g} s had not been written\n", recording.index().back().time);
  return k_done;
}

}  // namespace

void add_recover(Commands& commands) {
  const auto [command, recover] = commands.add("recover", "repair a recording whose writer was killed",
                                               "recover paper-a.h5 -o repaired.h5", recover_command);
  add_path(command, "RECORDING", recover.recording, "", "recording; it stays as it is").required();
  add_path(command, "-o,--output", recover.output, "REC.h5",
           "closed copy of what can be read, in place of an older one; default NAME.recovered.h5");
  add_force(command, recover.force);
}

}  // namespace topple::app
