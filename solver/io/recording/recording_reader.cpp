#include "solver/io/recording/recording_reader.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>
#include <tuple>

#include "solver/io/common/errors.h"
#include "solver/io/recording/hdf5_read_driver.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

constexpr unsigned char k_signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t k_flags_at = 11;            // in a superblock of version 3
constexpr unsigned char k_being_written = 1 | 4;  // open for writing; by SWMR
// A block that a writer has half written is read again; one that stays wrong must not hold the reader up.
constexpr unsigned k_metadata_attempts = 20;
constexpr int k_open_attempts = 5;
constexpr const char* k_not_finite = " holds a number that is not finite";

bool is_level(double number) {
  return std::ranges::any_of(k_model_levels,
                             [&](const LevelTraits& row) { return static_cast<double>(row.kind) == number; });
}

bool is_level_change(const EventRecord& event) {
  return is_level(event.value[0]) && event.value[1] >= 0 &&
         event.value[1] <= static_cast<double>(LevelReason::solid);
}

/// What the file's first bytes say, before HDF5 sees it.
struct FirstBytes {
  bool exists = false, is_hdf5 = false, being_written = false;
  std::size_t count = 0;
};

FirstBytes first_bytes(const std::string& path) {
  unsigned char bytes[k_flags_at + 1] = {};
  std::ifstream file(path, std::ios::binary);
  FirstBytes found{.exists = file.is_open()};
  if (!found.exists) return found;
  file.read(reinterpret_cast<char*>(bytes), sizeof bytes);
  found.count = static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0));
  found.is_hdf5 =
      found.count >= sizeof k_signature && std::memcmp(bytes, k_signature, sizeof k_signature) == 0;
  found.being_written = found.count == sizeof bytes && (bytes[k_flags_at] & k_being_written) != 0;
  return found;
}

FirstBytes expect_recording(const std::string& path) {
  if (path.empty()) throw InputError("the name of the recording is empty");
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path + ": is a folder, not a recording");
  const FirstBytes found = first_bytes(path);
  if (!found.exists) throw InputError(path + ": " + std::generic_category().message(errno));
  if (found.count == 0) throw InputError(path + ": is empty, not a recording");
  if (!found.is_hdf5) throw InputError(path + ": is not a recording (an HDF5 file)");
  return found;
}

}  // namespace

RowReader::RowReader(hid_t group, const char* name, hid_t type)
    : set_(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose), type_(H5Tcopy(type), H5Tclose) {
  const Handle stored(H5Dget_type(set_), H5Tclose);
  if (checked(H5Tequal(stored, type_)) == 0)
    throw Hdf5Error(std::string(name) + " has another type than expected");
  read_extent();
}

void RowReader::read_extent() {
  const Handle space(H5Dget_space(set_), H5Sclose);
  dims_.resize(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space))));
  if (dims_.empty()) throw Hdf5Error("a data set without rows");
  checked(H5Sget_simple_extent_dims(space, dims_.data(), nullptr));
}

void RowReader::read(hsize_t first, hsize_t count, void* to) const {
  std::vector<hsize_t> start(dims_.size(), 0), extent = dims_;
  start[0] = first;
  extent[0] = count;
  if (std::find(extent.begin(), extent.end(), hsize_t{0}) != extent.end()) return;
  const int rank = static_cast<int>(dims_.size());
  const Handle memory(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
  const Handle file(H5Dget_space(set_), H5Sclose);
  checked(H5Sselect_hyperslab(file, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr));
  checked(H5Dread(set_, type_, memory, file, H5P_DEFAULT, to));
}

void RowReader::refresh() {
  checked(H5Drefresh(set_));
  read_extent();
}

struct Recording::Impl {
  ~Impl() {
    const QuietHdf5 quiet;
    close();
  }
  explicit Impl(const std::string& file_path) : path(file_path) {
    const QuietHdf5 quiet;
    const FirstBytes found = expect_recording(path);
    live = found.being_written;
    for (int attempt = 1;; ++attempt) {
      try {
        open();
        return;
      } catch (const Hdf5Error& error) {
        // Beside a writer that is at work, what looks damaged may be a matter of moments.
        if (!live || attempt == k_open_attempts) fail(in_words(error.what()));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        live = first_bytes(path).being_written;
      }
    }
  }

  /// HDF5's own sentence on a file that was cut off holds nothing but its internal names.
  static std::string in_words(const std::string& why) {
    return why.rfind("truncated file", 0) == 0 ? "the file is cut off; its end is missing" : why;
  }

  [[noreturn]] void fail(const std::string& why) const { throw InputError(path + ": cannot read: " + why); }

  template <typename Work>
  auto guarded(Work&& work) const {
    const QuietHdf5 quiet;
    try {
      return work();
    } catch (const Hdf5Error& error) {
      fail(error.what());
    }
  }

  void close() {
    for (RowReader* set : {&frame_index, &checkpoint_index, &checkpoint_state, &event_rows, &edit_rows,
                           &branch_rows, &result_rows, &summary_bytes}) {
      *set = {};
    }
    fields = {};
    held.clear();
    file.reset();
  }

  void open() {
    close();
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    use_read_driver(access);
    if (live) checked(H5Pset_metadata_read_attempts(access, k_metadata_attempts));
    file = Handle(H5Fopen(path.c_str(), live ? H5F_ACC_RDONLY | H5F_ACC_SWMR_READ : H5F_ACC_RDONLY, access),
                  H5Fclose);
    expect_format();
    name = read_text_attribute(file, "scene");
    read_arithmetic();
    const auto bytes = read_fixed(file, "scene");
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    read_files();
    check_model();
    open_rows();
    load();
  }

  void expect_format() {
    if (!has_attribute(file, "format") || !has_attribute(file, "version") ||
        read_text_attribute(file, "format") != k_format) {
      throw InputError(path + ": is an HDF5 file, but not a recording of topple");
    }
    const std::int32_t version = read_int_attribute(file, "version");
    const auto found =
        std::ranges::find_if(formats(), [version](const Format& f) { return f.version == version; });
    if (found == formats().end()) {
      throw InputError(path + ": recording format " + std::to_string(version) +
                       " is not supported by this version, which reads formats " +
                       std::to_string(formats().front().version) + " to " + std::to_string(k_format_version));
    }
    format = &*found;
  }

  void read_arithmetic() {
    arithmetic =
        has_attribute(file, "arithmetic") ? read_text_attribute(file, "arithmetic") : k_system_arithmetic;
    const auto is_printed = [](unsigned char c) { return c < 0x80 && std::isprint(c); };
    if (!std::ranges::all_of(arithmetic, is_printed)) throw Hdf5Error("attribute arithmetic is damaged");
  }

  void read_files() {
    scene_files.clear();
    if (checked(H5Lexists(file, "files", H5P_DEFAULT)) == 0) return;
    const Handle group(H5Gopen2(file, "files", H5P_DEFAULT), H5Gclose);
    for (int number = 1;; ++number) {
      const std::string set_name = std::to_string(number);
      if (checked(H5Lexists(group, set_name.c_str(), H5P_DEFAULT)) == 0) return;
      const Handle set(H5Dopen2(group, set_name.c_str(), H5P_DEFAULT), H5Dclose);
      const auto bytes = read_fixed(group, set_name.c_str());
      scene_files.push_back({read_text_attribute(set, "name"),
                             std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())});
    }
  }

  void check_model() const {
    const Handle group(H5Gopen2(file, "model", H5P_DEFAULT), H5Gclose);
    for (const char* table :
         {"nodes", "elements", "members", "bodies", "sections", "materials", "contact_points", "planes"}) {
      read_fixed(group, table);
    }
    if (checked(H5Lexists(group, "anchors", H5P_DEFAULT)) > 0) read_fixed(group, "anchors");
  }

  void open_rows() {
    const auto records = [this](const char* set, const Handle& type) { return RowReader(file, set, type); };
    frame_index = records("frames/index", record_type<FrameRecord>());
    checkpoint_state = RowReader(file, "checkpoints/state", H5T_IEEE_F64LE);
    state_row.reset();
    const auto dims = checkpoint_state.row_dims();
    if (dims.size() > 1) throw Hdf5Error("checkpoints/state has another shape than expected");
    if (!dims.empty()) state_row = std::max<hsize_t>(dims[0], 1);
    checkpoint_index = records("checkpoints/index",
                               state_row ? record_type<StateRowRecord>() : record_type<CheckpointRecord>());
    const bool anchors = checked(H5Lexists(file, "frames/anchor", H5P_DEFAULT)) > 0;
    event_rows = records("events", event_type(*format, anchors));
    edit_rows = records("edits", record_type<EditRecord>());
    branch_rows = records("branches", record_type<BranchRecord>());
    result_rows = records("result", record_type<ResultRecord>());
    summary_bytes = records("summary", text_type(1));
    open_fields(anchors);
  }

  void open_fields(bool anchors) {
    const auto descriptions = frame_fields({});
    for (std::size_t i = 0; i < (anchors ? k_field_count : k_field_count - 1); ++i) {
      if (!format->has_field(descriptions[i].name)) continue;
      const std::string set = std::string("frames/") + descriptions[i].name;
      fields[i] = RowReader(file, set.c_str(), descriptions[i].type);
      held.push_back(i);
    }
    const auto first = [&](std::string_view field) {
      for (const std::size_t i : held)
        if (const auto dims = fields[i].row_dims(); descriptions[i].name == field && !dims.empty())
          return static_cast<std::size_t>(dims[0]);
      return std::size_t{0};
    };
    shape = {.nodes = first("position"),
             .elements = first("section_force"),
             .contacts = first("contact_depth"),
             .touched = first("member_contact"),
             .panels = first("panel_contact"),
             .bodies = first("body"),
             .anchors = first("anchor")};
    auto expected = frame_fields(shape);
    for (const std::size_t i : held) {
      if (descriptions[i].name == std::string_view("energy"))
        expected[i].dims[0] -= format->no_energies.size();
      if (fields[i].row_dims() != expected[i].dims) {
        throw Hdf5Error(std::string("frames/") + expected[i].name + " has another shape than expected");
      }
    }
    if (!format->has_field("member_contact") && shape.bodies > 1) shape.touched = shape.elements;
  }

  std::vector<CheckpointRecord> read_checkpoints() const {
    if (!state_row) return read_records<CheckpointRecord>(checkpoint_index, "checkpoints/index");
    std::vector<CheckpointRecord> records;
    for (const auto& r : read_records<StateRowRecord>(checkpoint_index, "checkpoints/index"))
      records.push_back({.branch = r.branch,
                         .data_checksum = r.data_checksum,
                         .step = r.step,
                         .time = r.time,
                         .hash = r.hash,
                         .first = static_cast<std::int64_t>(records.size() * *state_row),
                         .count = static_cast<std::int64_t>(*state_row)});
    return records;
  }

  void load() {
    frames = read_records<FrameRecord>(frame_index, "frames/index");
    checkpoints = read_checkpoints();
    recorded_events = read_records<EventRecord>(event_rows, "events");
    for (const EventRecord& event : recorded_events)
      if (event.kind == static_cast<int>(Event::Kind::model) && !is_level_change(event))
        throw Hdf5Error("events is damaged (a body has a model that there is not)");
    for (const std::size_t i : held) frames.resize(std::min<std::size_t>(frames.size(), fields[i].rows()));
    const auto numbers = static_cast<std::int64_t>(checkpoint_state.rows() * state_row.value_or(1));
    for (const CheckpointRecord& record : checkpoints)
      if (record.first < 0 || record.count < 0 || record.first > numbers)
        throw Hdf5Error("checkpoints/index is damaged");
    while (!checkpoints.empty() && checkpoints.back().count > numbers - checkpoints.back().first)
      checkpoints.pop_back();
    frame_instants = instants(frames);
    checkpoint_instants = instants(checkpoints);
    history = read_history(read_records<BranchRecord>(branch_rows, "branches"),
                           read_records<EditRecord>(edit_rows, "edits"));
    expect_branches(frames, "frames/index");
    expect_branches(checkpoints, "checkpoints/index");
    expect_branches(recorded_events, "events");
    status = "interrupted";
    summary.clear();
    for (const ResultRecord& result : read_records<ResultRecord>(result_rows, "result")) read_result(result);
    // The end of a file is what goes missing first.
    if (live && !frames.empty()) read_frame(frames.size() - 1);
  }

  template <typename Record>
  static std::vector<FrameKey> instants(const std::vector<Record>& records) {
    std::vector<FrameKey> result;
    result.reserve(records.size());
    for (const Record& r : records) result.push_back({r.branch, r.step, r.time});
    return result;
  }

  template <typename Record>
  void expect_branches(const std::vector<Record>& records, const char* set) const {
    std::int32_t known = 0;  // of the record before; the root is always there
    for (const Record& record : records) {
      if (record.branch != known && !has_branch(history, record.branch))
        throw Hdf5Error(std::string(set) + " is damaged (branch " + std::to_string(record.branch) +
                        " does not exist)");
      known = record.branch;
    }
  }

  void read_result(const ResultRecord& result) {
    status.assign(result.status, strnlen(result.status, sizeof result.status));
    const auto length = static_cast<hsize_t>(result.summary_length);
    if (length > summary_bytes.rows()) throw Hdf5Error("the summary is incomplete");
    summary.resize(length);
    summary_bytes.read(0, length, summary.data());
    if (crc32c(std::as_bytes(std::span(summary))) != result.summary_checksum) {
      throw Hdf5Error("the summary is damaged (checksum differs)");
    }
  }

  FrameRow read_frame(std::size_t index) const {
    const FrameRecord& record = frames[index];
    FrameRow row = blank_row(shape);
    row.branch = record.branch;
    row.step = record.step;
    row.time = record.time;
    row.energy.resize(row.energy.size() - format->no_energies.size());
    std::uint32_t checksum = 0;
    const auto bytes = field_bytes(row);
    for (const std::size_t i : held) {
      fields[i].read(index, 1, bytes[i].data());
      checksum = crc32c(bytes[i], checksum);
    }
    for (const std::size_t column : format->no_energies)
      row.energy.insert(row.energy.begin() + static_cast<std::ptrdiff_t>(column), 0.);
    if (checksum != record.data_checksum) {
      throw Hdf5Error("frame " + std::to_string(index) + " is damaged (checksum differs)");
    }
    if (!is_finite(row)) throw Hdf5Error("frame " + std::to_string(index) + k_not_finite);
    if (!std::ranges::all_of(row.level, is_level))
      throw Hdf5Error("frame " + std::to_string(index) + " has a body on no known level");
    return row;
  }

  // Indices are refreshed before the data, rows before the edits and branches that they follow from: what a
  // record names is then there.
  bool refresh() {
    if (!live) return false;
    const auto known = [this] {
      return std::tuple(frames.size(), checkpoints.size(), recorded_events.size(), history.edits.size(),
                        history.branches.size(), status);
    };
    const auto before = known();
    for (RowReader* set : {&result_rows, &summary_bytes, &frame_index, &checkpoint_index, &event_rows,
                           &edit_rows, &branch_rows, &checkpoint_state}) {
      set->refresh();
    }
    for (const std::size_t i : held) fields[i].refresh();
    load();
    return known() != before;
  }

  std::string path;
  bool live = false;
  Handle file;
  RowReader frame_index, checkpoint_index, checkpoint_state, event_rows, edit_rows, branch_rows, result_rows,
      summary_bytes;
  const Format* format = nullptr;
  std::array<RowReader, k_field_count> fields;
  std::vector<std::size_t> held;     ///< those of the fields that there are
  std::optional<hsize_t> state_row;  ///< numbers of every state, where each is a row
  RowShape shape;
  std::string name, arithmetic, text, status, summary;
  std::vector<SceneFile> scene_files;
  std::vector<FrameRecord> frames;
  std::vector<CheckpointRecord> checkpoints;
  std::vector<EventRecord> recorded_events;
  std::vector<FrameKey> frame_instants, checkpoint_instants;
  History history;
};

Recording::Recording(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

std::int32_t Recording::format() const {
  return impl_->format->version;
}
const std::string& Recording::arithmetic() const {
  return impl_->arithmetic;
}
bool Recording::can_go_on() const {
  return impl_->format->can_go_on;
}
void Recording::leave_out_unrecorded(FrameRow& row) const {
  leave_out(*impl_->format, row);
}
const std::string& Recording::scene_name() const {
  return impl_->name;
}
const std::string& Recording::scene_text() const {
  return impl_->text;
}
const std::vector<SceneFile>& Recording::scene_files() const {
  return impl_->scene_files;
}
const std::string& Recording::status() const {
  return impl_->status;
}
const std::string& Recording::summary_json() const {
  return impl_->summary;
}
const std::vector<FrameKey>& Recording::index() const {
  return impl_->frame_instants;
}
const std::vector<FrameKey>& Recording::checkpoint_index() const {
  return impl_->checkpoint_instants;
}
const History& Recording::history() const {
  return impl_->history;
}
std::int32_t Recording::newest_branch() const {
  return impl_->history.branches.back().id;
}
std::int64_t Recording::frame_count() const {
  return static_cast<std::int64_t>(impl_->frames.size());
}
std::int64_t Recording::checkpoint_count() const {
  return static_cast<std::int64_t>(impl_->checkpoints.size());
}

bool Recording::left_open() const {
  return impl_->live;
}
std::int64_t Recording::incomplete_frames() const {
  hsize_t begun = impl_->frame_index.rows();
  for (const std::size_t i : impl_->held) begun = std::max(begun, impl_->fields[i].rows());
  return static_cast<std::int64_t>(begun) - frame_count();
}

bool Recording::refresh() {
  return impl_->guarded([this] { return impl_->refresh(); });
}

FrameRow Recording::frame(std::int64_t index) const {
  if (index < 0 || index >= frame_count()) throw std::out_of_range("frame " + std::to_string(index));
  return impl_->guarded([&] { return impl_->read_frame(static_cast<std::size_t>(index)); });
}

std::vector<RecordedEvent> Recording::events() const {
  std::vector<RecordedEvent> events;
  for (const EventRecord& record : impl_->recorded_events) {
    const Event event{.kind = static_cast<Event::Kind>(record.kind),
                      .step = record.step,
                      .time = record.time,
                      .body = record.body,
                      .value = record.value[0],
                      .element = record.element,
                      .reason = static_cast<LevelReason>(record.value[1]),
                      .anchor = static_cast<int>(record.value[2])};
    events.push_back({.branch = record.branch, .step = record.step, .time = record.time, .event = event});
  }
  return events;
}

Checkpoint Recording::checkpoint(std::int64_t index) const {
  if (index < 0 || index >= checkpoint_count())
    throw std::out_of_range("checkpoint " + std::to_string(index));
  return impl_->guarded([&] {
    const CheckpointRecord& record = impl_->checkpoints[static_cast<std::size_t>(index)];
    Checkpoint checkpoint{.branch = record.branch,
                          .step = record.step,
                          .time = record.time,
                          .hash = record.hash,
                          .state = std::vector<double>(static_cast<std::size_t>(record.count))};
    const auto row = static_cast<std::int64_t>(impl_->state_row.value_or(1));
    impl_->checkpoint_state.read(static_cast<hsize_t>(record.first / row),
                                 static_cast<hsize_t>(record.count / row), checkpoint.state.data());
    if (crc32c(std::as_bytes(std::span(checkpoint.state))) != record.data_checksum) {
      throw Hdf5Error("checkpoint " + std::to_string(index) + " is damaged (checksum differs)");
    }
    if (!is_finite(checkpoint)) throw Hdf5Error("checkpoint " + std::to_string(index) + k_not_finite);
    return checkpoint;
  });
}

std::vector<std::int64_t> Recording::frames_on_way_to(std::int32_t branch) const {
  std::vector<std::int64_t> found;
  for (const Stretch& stretch : impl_->history.way_to(branch))
    for (std::size_t i = 0; i < impl_->frame_instants.size(); ++i) {
      const FrameKey& instant = impl_->frame_instants[i];
      // the instant of the fork is the branch's own first frame
      if (instant.branch == stretch.branch && (stretch.branch == branch || instant.step < stretch.last_step))
        found.push_back(static_cast<std::int64_t>(i));
    }
  return found;
}

std::vector<RecordedEvent> Recording::events_on_way_to(std::int32_t branch) const {
  return events_on(impl_->history.way_to(branch), events());
}

void expect_to_go_on(const Recording& recording) {
  if (recording.can_go_on()) return;
  const auto first = std::ranges::find_if(formats(), [](const Format& f) { return f.can_go_on; });
  throw InputError("the recording has format " + std::to_string(recording.format()) +
                   ": it can be looked at and exported; runs go on from format " +
                   std::to_string(first->version) + " and later");
}

bool is_recording(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && first_bytes(path).is_hdf5;  // reading a pipe would use it up
}

}  // namespace topple::io
