#include "solver/io/recording/recording_writer.h"

namespace topple::io {

struct Recorder::Impl {
  RecordingWriter writer;
};

Recorder::Recorder(const host::Target& target, const std::string& scene_name, const std::string& scene_text,
                   const Model& model, const std::vector<SceneFile>& files, const std::string& arithmetic)
    : impl_(new Impl{
          RecordingWriter(target, scene_name, scene_text, model, row_shape(model), files, arithmetic)}) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::write(const Observation& observation) {
  for (const RecordedEvent& event : observation.events) impl_->writer.append(event);
  if (observation.checkpoint) impl_->writer.append(*observation.checkpoint);
  for (const FrameRow& frame : observation.frames) impl_->writer.append(frame);
}

void Recorder::write(const Branch& branch) {
  impl_->writer.append(branch);
}

void Recorder::write(const LoggedEdit& edit) {
  impl_->writer.append(edit);
}

void Recorder::flush() {
  impl_->writer.flush();
}

void Recorder::flush_if_due() {
  impl_->writer.flush_if_due();
}

void Recorder::finish(const std::string& status, const std::string& summary_json) {
  impl_->writer.finish(status, summary_json);
}

}  // namespace topple::io
