#include "solver/io/recording/recover.h"

#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/recording/recording_writer.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

/// Indices at which `read` throws no InputError.
template <typename Read>
std::vector<std::int64_t> readable(std::int64_t count, Read read) {
  std::vector<std::int64_t> found;
  for (std::int64_t i = 0; i < count; ++i) {
    try {
      read(i);
      found.push_back(i);
    } catch (const InputError&) {
    }
  }
  return found;
}

}  // namespace

SoundRows sound_rows(const Recording& recording) {
  SoundRows rows{.frames = readable(recording.frame_count(), [&](std::int64_t i) { recording.frame(i); }),
                 .checkpoints = readable(recording.checkpoint_count(),
                                         [&](std::int64_t i) { recording.checkpoint(i); })};
  rows.damaged_frames = recording.frame_count() - static_cast<std::int64_t>(rows.frames.size());
  rows.damaged_checkpoints =
      recording.checkpoint_count() - static_cast<std::int64_t>(rows.checkpoints.size());
  return rows;
}

bool write_recovered(const Recording& recording, const SoundRows& rows, const host::Target& target,
                     const std::function<bool()>& proceed) {
  expect_to_go_on(recording);  // a copy of another format would hold what nobody recorded
  const Scene scene = recorded_scene(recording);
  const Model& model = scene.setup.model;
  if (!rows.frames.empty()) expect_same_model(model, recording.frame(rows.frames.front()));
  host::StagedFile staged(target, host::FileKind::hdf5);
  RecordingWriter writer(staged.part(), recording.scene_name(), scene.text, model, row_shape(model),
                         recording.scene_files(), recording.arithmetic());
  for (const Branch& branch : recording.history().branches)
    if (branch.parent >= 0) writer.append(branch);  // a writer begins with the root
  for (const LoggedEdit& edit : recording.history().edits) writer.append(edit);
  for (const RecordedEvent& event : recording.events()) writer.append(event);
  for (const std::int64_t i : rows.checkpoints) writer.append(recording.checkpoint(i));
  for (const std::int64_t i : rows.frames) {
    if (proceed && !proceed()) return false;
    writer.append(recording.frame(i));
  }
  writer.finish(recording.status(), recording.summary_json());
  staged.commit();
  return true;
}

}  // namespace topple::io
