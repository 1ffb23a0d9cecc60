// What a recording looks like inside, shared by its writer and its reader. All numbers are little-endian.
//
//   /              attributes: format, version, scene (its name), arithmetic (absent in older ones)
//   /scene         the scene text, bytes
//   /files/N       the files that it names, bytes; attribute: name. Absent in older recordings
//   /model/...     fixed data, see recording_model.cpp; every fixed data set has its CRC-32C as attribute
//   /frames/index  one FrameRecord a row, written last: its extent is the number of complete frames
//   /frames/NAME   the fields of FrameRow, one row a frame (frame_fields)
//   /checkpoints/index, /checkpoints/state     likewise; `state` holds pack(State), one after the other
//   /events, /edits, /blobs, /branches, /result, /summary
//
// /frames/anchor, /model/anchors and two columns of /frames/energy are there with anchors only.
// All data sets exist before SWMR writing starts and nothing is of variable length. Rows are only ever
// appended. A record whose branch is -1 (the fill value) was allocated, but not written when the writer died:
// readers leave such records at the end away. `/result` has one row once the run was finished.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "solver/io/recording/frame_row.h"
#include "solver/io/recording/hdf5_handle.h"
#include "solver/io/recording/recording.h"

namespace topple::io {

inline constexpr const char* k_format = "topple recording";
inline constexpr std::int32_t k_format_version = 10;
inline constexpr std::int32_t k_not_written = -1;  ///< branch of a record that was never written

/// How the recordings of one format differ from those of today.
struct Format {
  std::int32_t version;
  int event_kinds;                            ///< of Event::Kind, `anchor` not counted
  bool can_go_on;                             ///< states are packed as they are now
  std::vector<std::string_view> no_fields;    ///< data sets of today's /frames that are not there
  std::vector<std::size_t> no_energies = {};  ///< columns of today's /frames/energy that are not there
  bool on_corners = false;  ///< a cabinet whose scene names no `base` stands on its corners, else on edges

  bool has_field(std::string_view name) const;
};
/// Those that are read, the oldest first. What a format does not hold is read as zero.
const std::vector<Format>& formats();

/// Rows per chunk of the frame fields, and rows gathered before they are handed to HDF5.
inline constexpr hsize_t k_chunk_rows = 32;

// Records. `checksum` is the CRC-32C of the bytes before it; the order of the members leaves no gaps.
struct FrameRecord {
  std::int32_t branch = k_not_written;
  std::uint32_t data_checksum = 0;  ///< of the row's fields, one after the other in the order of frame_fields
  std::int64_t step = 0;
  double time = 0;
  std::uint32_t checksum = 0, unused = 0;
};
struct CheckpointRecord {
  std::int32_t branch = k_not_written;
  std::uint32_t data_checksum = 0;  ///< of its numbers in /checkpoints/state
  std::int64_t step = 0;
  double time = 0;
  std::uint64_t hash = 0;
  std::int64_t first = 0, count = 0;  ///< of its numbers
  std::uint32_t checksum = 0, unused = 0;
};
/// Of the first recordings: their states have one size, and each is a row of /checkpoints/state.
struct StateRowRecord {
  std::int32_t branch = k_not_written;
  std::uint32_t data_checksum = 0;
  std::int64_t step = 0;
  double time = 0;
  std::uint64_t hash = 0;
  std::uint32_t checksum = 0, unused = 0;
};
struct EventRecord {
  std::int32_t branch = k_not_written;
  std::int32_t kind = 0;  ///< Event::Kind; `anchor` is in the HDF5 type when the model has any
  std::int64_t step = 0;
  double time = 0;
  std::int32_t body = 0, element = -1;
  double value[4] = {};
  std::uint32_t checksum = 0, unused = 0;
};
struct EditRecord {
  std::int32_t branch = k_not_written;
  std::int32_t kind = 0;  ///< 0: a value; others are reserved for edits with a blob
  std::int64_t step = 0;
  char key[64] = {};     ///< edit_key(): "shake.1.amplitude"
  double value[4] = {};  ///< SI; the last one is the time of the step, s
  std::int64_t blob_offset = 0, blob_length = 0;
  std::uint32_t checksum = 0, unused = 0;
};
struct BranchRecord {
  std::int32_t branch = k_not_written;  ///< "id"
  std::int32_t parent = -1;             ///< -1: the root
  std::int64_t fork_step = 0;
  std::uint32_t checksum = 0, unused = 0;
};
struct ResultRecord {
  std::int32_t branch = k_not_written;
  std::uint32_t summary_checksum = 0;
  std::int64_t summary_length = 0;
  char status[16] = {};
  std::uint32_t checksum = 0, unused = 0;
};

/// HDF5 compound types of the records.
template <typename Record>
Handle record_type();
/// Of EventRecord.
Handle event_type(const Format& format, bool anchors);

template <typename Record>
std::uint32_t record_checksum(const Record& record) {
  return crc32c(std::as_bytes(std::span(&record, 1)).first(offsetof(Record, checksum)));
}
template <typename Record>
Record sealed(Record record) {
  record.checksum = record_checksum(record);
  return record;
}

/// One data set of /frames.
struct FrameField {
  const char* name;
  hid_t type;                 ///< one of HDF5's own types, in memory and in the file
  std::vector<hsize_t> dims;  ///< of one row
  const char* units;
  const char* columns;  ///< names along the last dimension, comma-separated
};
inline constexpr std::size_t k_field_count = 16;
std::array<FrameField, k_field_count> frame_fields(const RowShape& shape);
std::size_t row_bytes(const FrameField& field);
/// Of the data sets that there are: the last, `anchor`, when the model has anchors.
std::size_t field_count(const RowShape& shape);

/// The fields of `row` as bytes, in the order of frame_fields. Row: FrameRow, const or not.
template <typename Row>
auto field_bytes(Row& row) {
  const auto bytes = [](auto&& field) {
    if constexpr (std::is_const_v<Row>) {
      return std::as_bytes(std::span(field));
    } else {
      return std::as_writable_bytes(std::span(field));
    }
  };
  using Bytes = std::span<std::conditional_t<std::is_const_v<Row>, const std::byte, std::byte>>;
  return std::array<Bytes, k_field_count>{bytes(row.position),
                                          bytes(row.rotation),
                                          bytes(row.section_force),
                                          bytes(row.s),
                                          bytes(row.hinge),
                                          bytes(row.contact_depth),
                                          bytes(row.contact_force),
                                          bytes(row.member_contact),
                                          bytes(row.panel_contact),
                                          bytes(row.energy),
                                          bytes(row.body),
                                          bytes(row.level),
                                          bytes(row.floor_acceleration),
                                          bytes(row.floor_displacement),
                                          bytes(std::span(&row.load_factor, 1)),
                                          bytes(row.anchor)};
}

/// Throws InputError when the rows are not those of the model.
void expect_same_model(const Model& model, const FrameRow& row);
/// Makes zero what a row of this format does not hold.
void leave_out(const Format& format, FrameRow& row);

/// Writes the group /model.
void write_model(hid_t file, const Model& model);

}  // namespace topple::io
