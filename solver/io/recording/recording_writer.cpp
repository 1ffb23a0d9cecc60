#include "solver/io/recording/recording_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>

#include "solver/io/common/units.h"
#include "solver/io/edit/edit_text.h"

namespace topple::io {
namespace {

// Index chunks are rewritten at every flush while they fill, so they stay small.
constexpr hsize_t k_index_chunk_rows = 64;
constexpr hsize_t k_byte_chunk = 4096, k_number_chunk = 4096;

}  // namespace

RowSet::RowSet(hid_t group, const char* name, hid_t type, std::vector<hsize_t> row_dims, hsize_t chunk_rows,
               const void* fill)
    : type_(H5Tcopy(type), H5Tclose), dims_(std::move(row_dims)) {
  dims_.insert(dims_.begin(), 0);
  // HDF5 has no chunks of size zero: a model without contacts gets a limit of one column, and none in use.
  std::vector<hsize_t> chunk = dims_, limit = dims_;
  for (std::size_t i = 1; i < dims_.size(); ++i) chunk[i] = limit[i] = std::max<hsize_t>(dims_[i], 1);
  chunk[0] = chunk_rows;
  limit[0] = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(static_cast<int>(dims_.size()), dims_.data(), limit.data()), H5Sclose);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  checked(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()));
  if (fill != nullptr) checked(H5Pset_fill_value(properties, type, fill));
  set_ = Handle(H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
}

void RowSet::append(const void* rows, std::size_t count) {
  if (count == 0) return;
  std::vector<hsize_t> start(dims_.size(), 0), extent = dims_;
  start[0] = dims_[0];
  extent[0] = count;
  dims_[0] += count;
  checked(H5Dset_extent(set_, dims_.data()));
  dirty_ = true;
  if (std::find(extent.begin(), extent.end(), hsize_t{0}) != extent.end()) return;
  const int rank = static_cast<int>(dims_.size());
  const Handle memory(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
  const Handle file(H5Screate_simple(rank, dims_.data(), nullptr), H5Sclose);
  checked(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr));
  checked(H5Dwrite(set_, type_, memory, file, H5P_DEFAULT, rows));
}

void RowSet::flush() {
  if (!dirty_) return;
  checked(H5Dflush(set_));
  dirty_ = false;
}

void RowSet::release() {
  set_.release();
  type_.release();
}

void RowSet::describe(const char* units, const char* columns) {
  if (*units != '\0') write_attribute(set_, "units", units);
  if (*columns != '\0') write_attribute(set_, "columns", columns);
}

RecordingWriter::RecordingWriter(const host::Target& target, const std::string& scene_name,
                                 const std::string& scene_text, const Model& model, const RowShape& shape,
                                 const std::vector<SceneFile>& files, const std::string& arithmetic)
    : staged_(target, host::FileKind::hdf5) {
  guarded([&] {
    descriptions_ = frame_fields(shape);
    std::transform(descriptions_.begin(), descriptions_.end(), field_bytes_.begin(), row_bytes);
    field_count_ = field_count(shape);
    create(scene_name, scene_text, model, files, arithmetic);
  });
}

RecordingWriter::~RecordingWriter() {
  try {
    if (!finished_ && !failure_) {
      flush();
      guarded([this] { close(); });
    }
  } catch (const WriteError&) {
    // Nobody is left to tell; what was flushed stays readable.
  }
}

template <typename Work>
void RecordingWriter::guarded(Work&& work) {
  if (failure_) throw WriteError(*failure_);
  const QuietHdf5 quiet;
  try {
    work();
  } catch (const Hdf5Error& error) {
    failure_ = staged_.path().string() + ": cannot write the recording: " + error.what();
  } catch (const WriteError& error) {
    failure_ = error.what();
  }
  if (!failure_) return;
  detach();
  throw WriteError(*failure_);
}

void RecordingWriter::create(const std::string& scene_name, const std::string& scene_text, const Model& model,
                             const std::vector<SceneFile>& files, const std::string& arithmetic) {
  const Handle access = unbuffered_access();
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110));
  checked(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG));
  file_ = Handle(H5Fcreate(staged_.part().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  void* descriptor = nullptr;
  checked(H5Fget_vfd_handle(file_, H5P_DEFAULT, &descriptor));
  descriptor_ = *static_cast<int*>(descriptor);

  write_attribute(file_, "format", k_format);
  write_attribute(file_, "version", k_format_version);
  write_attribute(file_, "scene", scene_name);
  write_attribute(file_, "arithmetic", arithmetic);
  const Handle character = text_type(1);
  write_fixed(file_, "scene", character, {scene_text.size()}, scene_text.data());
  write_files(files);
  write_model(file_, model);
  create_rows();
  append(Branch{});
  checked(H5Fflush(file_, H5F_SCOPE_GLOBAL));
  checked(H5Fstart_swmr_write(file_));
}

void RecordingWriter::write_files(const std::vector<SceneFile>& files) {
  const Handle group(H5Gcreate2(file_, "files", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    write_fixed(group, number.c_str(), H5T_STD_U8LE, {files[i].bytes.size()}, files[i].bytes.data());
    const Handle set(H5Dopen2(group, number.c_str(), H5P_DEFAULT), H5Dclose);
    write_attribute(set, "name", files[i].name);
  }
}

void RecordingWriter::create_rows() {
  const auto group = [this](const char* name) {
    return Handle(H5Gcreate2(file_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  };
  const auto records = [](hid_t place, const char* name, const auto& blank) {
    const Handle type = record_type<std::decay_t<decltype(blank)>>();
    return RowSet(place, name, type, {}, k_index_chunk_rows, &blank);
  };
  const Handle frames = group("frames");
  frame_index_ = records(frames, "index", FrameRecord{});
  for (std::size_t i = 0; i < field_count_; ++i) {
    const FrameField& field = descriptions_[i];
    fields_[i] = RowSet(frames, field.name, field.type, field.dims, k_chunk_rows);
    fields_[i].describe(field.units, field.columns);
  }
  const Handle checkpoints = group("checkpoints");
  checkpoint_index_ = records(checkpoints, "index", CheckpointRecord{});
  checkpoint_state_ = RowSet(checkpoints, "state", H5T_IEEE_F64LE, {}, k_number_chunk);
  const EventRecord no_event;
  const Handle event = event_type(formats().back(), field_count_ == k_field_count);
  events_ = RowSet(file_, "events", event, {}, k_index_chunk_rows, &no_event);
  edits_ = records(file_, "edits", EditRecord{});
  blobs_ = RowSet(file_, "blobs", H5T_STD_U8LE, {}, k_byte_chunk);
  branches_ = records(file_, "branches", BranchRecord{});
  result_ = records(file_, "result", ResultRecord{});
  summary_ = RowSet(file_, "summary", text_type(1), {}, k_byte_chunk);
}

// What came before is kept, and the file can still be closed.
void RecordingWriter::refuse(const std::string& what, double time) {
  flush();
  throw WriteError(staged_.path().string() + ": cannot write the recording: " + what + " at " +
                   short_number(time) + " s holds a number that is not finite");
}

void RecordingWriter::append(const FrameRow& row) {
  if (failure_) throw WriteError(*failure_);
  if (!is_finite(row)) refuse("frame " + std::to_string(frames_), row.time);
  const auto fields = field_bytes(row);
  FrameRecord record{.branch = row.branch, .step = row.step, .time = row.time};
  for (std::size_t i = 0; i < k_field_count; ++i) {
    if (fields[i].size() != field_bytes_[i]) {
      throw std::invalid_argument(std::string("frame row: wrong size of ") + descriptions_[i].name);
    }
    record.data_checksum = crc32c(fields[i], record.data_checksum);
  }
  for (std::size_t i = 0; i < k_field_count; ++i) {
    batch_[i].insert(batch_[i].end(), fields[i].begin(), fields[i].end());
  }
  pending_frames_.push_back(sealed(record));
  ++batch_rows_;
  ++frames_;
  if (frames_ % static_cast<std::int64_t>(k_chunk_rows) == 0) guarded([this] { write_batch(); });
}

void RecordingWriter::append(const Checkpoint& checkpoint) {
  if (!is_finite(checkpoint)) refuse("the checkpoint", checkpoint.time);
  guarded([&] {
    const auto first = static_cast<std::int64_t>(checkpoint_state_.rows());
    checkpoint_state_.append(checkpoint.state.data(), checkpoint.state.size());
    pending_checkpoints_.push_back(
        sealed(CheckpointRecord{.branch = checkpoint.branch,
                                .data_checksum = crc32c(std::as_bytes(std::span(checkpoint.state))),
                                .step = checkpoint.step,
                                .time = checkpoint.time,
                                .hash = checkpoint.hash,
                                .first = first,
                                .count = static_cast<std::int64_t>(checkpoint.state.size())}));
  });
}

void RecordingWriter::append(const RecordedEvent& event) {
  if (failure_) throw WriteError(*failure_);
  EventRecord record{.branch = event.branch,
                     .kind = static_cast<std::int32_t>(event.event.kind),
                     .step = event.step,
                     .time = event.time,
                     .body = event.event.body,
                     .element = event.event.element};
  record.value[0] = event.event.value;
  record.value[1] = static_cast<double>(event.event.reason);
  record.value[2] = event.event.anchor;
  pending_events_.push_back(sealed(record));
}

void RecordingWriter::append(const Branch& branch) {
  if (failure_) throw WriteError(*failure_);
  pending_branches_.push_back(
      sealed(BranchRecord{.branch = branch.id, .parent = branch.parent, .fork_step = branch.fork_step}));
  newest_branch_ = branch.id;
}

void RecordingWriter::append(const LoggedEdit& logged) {
  if (failure_) throw WriteError(*failure_);
  EditRecord record{.branch = logged.branch, .step = logged.step};
  const std::string key = edit_key(logged.edit);
  std::copy_n(key.data(), std::min(key.size(), sizeof(record.key)), record.key);
  std::copy_n(logged.edit.value.data(), 3, record.value);
  record.value[3] = logged.time;
  pending_edits_.push_back(sealed(record));
}

void RecordingWriter::write_batch() {
  for (std::size_t i = 0; i < field_count_; ++i) {
    fields_[i].append(batch_[i].data(), batch_rows_);
    batch_[i].clear();
  }
  batch_rows_ = 0;
}

// Data first and the indices last, each on disk before the next: a row that can be found is complete, and so
// is what it follows from.
void RecordingWriter::write_pending() {
  write_batch();
  for (RowSet& field : fields_) field.flush();
  checkpoint_state_.flush();
  const auto publish = [](RowSet& set, auto& records) {
    set.append(records.data(), records.size());
    set.flush();
    records.clear();
  };
  publish(branches_, pending_branches_);
  publish(edits_, pending_edits_);
  publish(events_, pending_events_);
  publish(checkpoint_index_, pending_checkpoints_);
  publish(frame_index_, pending_frames_);
}

void RecordingWriter::flush() {
  guarded([this] {
    write_pending();
    if (!staged_.committed() && frames_ > 0) staged_.commit();
  });
  last_flush_ = std::chrono::steady_clock::now();
}

void RecordingWriter::flush_if_due() {
  if (std::chrono::steady_clock::now() - last_flush_ >= k_flush_interval) flush();
}

void RecordingWriter::finish(const std::string& status, const std::string& summary_json) {
  flush();
  guarded([&] {
    ResultRecord record{.branch = newest_branch_,
                        .summary_checksum = crc32c(std::as_bytes(std::span(summary_json))),
                        .summary_length = static_cast<std::int64_t>(summary_json.size())};
    std::copy_n(status.data(), std::min(status.size(), sizeof(record.status)), record.status);
    record = sealed(record);
    summary_.append(summary_json.data(), summary_json.size());
    summary_.flush();
    result_.append(&record, 1);
    result_.flush();
    // Whatever can fail should do so while the descriptor is still there to let go of.
    checked(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    close();
  });
  finished_ = true;
}

template <typename Work>
void RecordingWriter::for_each_set(Work work) {
  for (RowSet& field : fields_) work(field);
  for (RowSet* set : {&frame_index_, &checkpoint_state_, &checkpoint_index_, &events_, &edits_, &blobs_,
                      &branches_, &result_, &summary_}) {
    work(*set);
  }
}

void RecordingWriter::close() {
  for_each_set([](RowSet& set) { set = {}; });
  descriptor_ = -1;  // closed with the file, and its number soon someone else's
  checked(file_.reset());
}

// HDF5 keeps changed metadata in memory, and closing would write it out, over caches that a failed write has
// left in no good state. So nothing is closed any more; the descriptor is pointed at nothing, which also
// gives back the space and the lock of the file, and makes sure that it is not touched again.
void RecordingWriter::detach() noexcept {
  if (descriptor_ >= 0) {
    if (const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC); nowhere >= 0) {
      dup2(nowhere, descriptor_);
      ::close(nowhere);
    }
    descriptor_ = -1;
  }
  for_each_set([](RowSet& set) { set.release(); });
  file_.release();
}

}  // namespace topple::io
