#include "solver/io/recording/recording_format.h"

#include <algorithm>
#include <string>

namespace topple::io {
namespace {

struct Column {
  const char* name;
  std::size_t offset;
  hid_t type;
};

Handle compound(std::size_t size, std::initializer_list<Column> columns) {
  Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  for (const Column& column : columns) checked(H5Tinsert(type, column.name, column.offset, column.type));
  return type;
}

Handle four_numbers() {
  const hsize_t count = 4;
  return Handle(H5Tarray_create2(H5T_IEEE_F64LE, 1, &count), H5Tclose);
}

Handle event_kind(int kinds, bool anchors) {
  Handle type(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
  int left = kinds;
  const auto insert = [&](const char* name, Event::Kind kind) {
    const auto number = static_cast<std::int32_t>(kind);
    if (left-- > 0) checked(H5Tenum_insert(type, name, &number));
  };
  insert("uplift", Event::Kind::uplift);
  insert("impact", Event::Kind::impact);
  insert("overturn", Event::Kind::overturn);
  insert("hinge", Event::Kind::hinge);
  insert("fracture", Event::Kind::fracture);
  insert("model", Event::Kind::model);
  left = anchors;
  insert("anchor", Event::Kind::anchor);
  return type;
}

/// Names and units of energies, comma-separated.
struct EnergyColumns {
  std::string names, units;
  explicit EnergyColumns(std::span<const EnergyTraits> columns) {
    for (const EnergyTraits& column : columns) {
      const char* const comma = names.empty() ? "" : ",";
      names += std::string(comma) + column.name;
      units += std::string(comma) + column.unit;
    }
  }
};

}  // namespace

bool Format::has_field(std::string_view name) const {
  return std::ranges::find(no_fields, name) == no_fields.end();
}

const std::vector<Format>& formats() {
  static const std::vector<Format> all{
      {1,
       3,
       false,
       {"member_contact", "panel_contact", "load_factor"},
       {k_plastic, k_damping, k_model_switch}},
      {2,
       5,
       false,
       {"member_contact", "panel_contact", "load_factor"},
       {k_plastic, k_damping, k_model_switch}},
      {3, 5, false, {"member_contact", "panel_contact"}, {k_damping, k_model_switch}},
      {4, 6, false, {"member_contact", "panel_contact"}, {k_damping}},
      {5, 6, false, {"member_contact", "panel_contact"}, {k_damping}},
      {6, 6, true, {"member_contact", "panel_contact"}},
      {7, 6, true, {"panel_contact"}},
      {8, 6, true, {"panel_contact"}, {}, true},
      {9, 6, true, {"panel_contact"}, {}, true},
      {k_format_version, 6, true, {}, {}, true}};
  return all;
}

template <>
Handle record_type<FrameRecord>() {
  using R = FrameRecord;
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"data_checksum", offsetof(R, data_checksum), H5T_STD_U32LE},
                              {"step", offsetof(R, step), H5T_STD_I64LE},
                              {"time", offsetof(R, time), H5T_IEEE_F64LE},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

template <>
Handle record_type<CheckpointRecord>() {
  using R = CheckpointRecord;
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"data_checksum", offsetof(R, data_checksum), H5T_STD_U32LE},
                              {"step", offsetof(R, step), H5T_STD_I64LE},
                              {"time", offsetof(R, time), H5T_IEEE_F64LE},
                              {"hash", offsetof(R, hash), H5T_STD_U64LE},
                              {"first", offsetof(R, first), H5T_STD_I64LE},
                              {"count", offsetof(R, count), H5T_STD_I64LE},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

template <>
Handle record_type<StateRowRecord>() {
  using R = StateRowRecord;
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"data_checksum", offsetof(R, data_checksum), H5T_STD_U32LE},
                              {"step", offsetof(R, step), H5T_STD_I64LE},
                              {"time", offsetof(R, time), H5T_IEEE_F64LE},
                              {"hash", offsetof(R, hash), H5T_STD_U64LE},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

Handle event_type(const Format& format, bool anchors) {
  using R = EventRecord;
  const Handle kind = event_kind(format.event_kinds, anchors);
  const Handle value = four_numbers();
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"kind", offsetof(R, kind), kind},
                              {"step", offsetof(R, step), H5T_STD_I64LE},
                              {"time", offsetof(R, time), H5T_IEEE_F64LE},
                              {"body", offsetof(R, body), H5T_STD_I32LE},
                              {"element", offsetof(R, element), H5T_STD_I32LE},
                              {"value", offsetof(R, value), value},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

template <>
Handle record_type<EditRecord>() {
  using R = EditRecord;
  const Handle key = text_type(sizeof(R::key));
  const Handle value = four_numbers();
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"kind", offsetof(R, kind), H5T_STD_I32LE},
                              {"step", offsetof(R, step), H5T_STD_I64LE},
                              {"key", offsetof(R, key), key},
                              {"value", offsetof(R, value), value},
                              {"blob_offset", offsetof(R, blob_offset), H5T_STD_I64LE},
                              {"blob_length", offsetof(R, blob_length), H5T_STD_I64LE},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

template <>
Handle record_type<BranchRecord>() {
  using R = BranchRecord;
  return compound(sizeof(R), {{"id", offsetof(R, branch), H5T_STD_I32LE},
                              {"parent", offsetof(R, parent), H5T_STD_I32LE},
                              {"fork_step", offsetof(R, fork_step), H5T_STD_I64LE},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

template <>
Handle record_type<ResultRecord>() {
  using R = ResultRecord;
  const Handle status = text_type(sizeof(R::status));
  return compound(sizeof(R), {{"branch", offsetof(R, branch), H5T_STD_I32LE},
                              {"summary_checksum", offsetof(R, summary_checksum), H5T_STD_U32LE},
                              {"summary_length", offsetof(R, summary_length), H5T_STD_I64LE},
                              {"status", offsetof(R, status), status},
                              {"checksum", offsetof(R, checksum), H5T_STD_U32LE}});
}

std::array<FrameField, k_field_count> frame_fields(const RowShape& shape) {
  const hsize_t n = shape.nodes, e = shape.elements, c = shape.contacts, t = shape.touched;
  const hsize_t p = shape.panels, b = shape.bodies, a = shape.anchors;
  static const EnergyColumns k_without(energy_columns(false)), k_with(energy_columns(true));
  const EnergyColumns& energies = a > 0 ? k_with : k_without;
  const hid_t f32 = H5T_IEEE_F32LE, f64 = H5T_IEEE_F64LE, u8 = H5T_STD_U8LE;
  return {
      {{"position", f32, {n, 3}, "m", "x,y,z"},
       {"rotation", f32, {n, 4}, "1", "w,x,y,z"},
       {"section_force", f32, {e, 6}, "N,N,N,N m,N m,N m", "N,Vy,Vz,T,My,Mz"},
       {"s", f32, {e}, "1", ""},
       {"hinge",
        u8,
        {e},
        "0 none, 1 first end, 2 second end, 3 broken, 4 middle, 7 both; 5, 6, 8 flowed at the first, second, "
        "both",
        ""},
       {"contact_depth", f32, {c}, "1", ""},
       {"contact_force", f32, {c, 3}, "N", "x,y,z"},
       {"member_contact", f32, {t, 4}, "N,N,N,1", "x,y,z,place"},
       {"panel_contact", f32, {p, 5}, "N,N,N,1,1", "x,y,z,t,u"},
       {"energy", f64, {energy_columns(a > 0).size()}, energies.units.c_str(), energies.names.c_str()},
       {"body", f64, {b, 11}, "m,m,m,1,1,1,1,rad,m,J,rad", "x,y,z,qw,qx,qy,qz,tilt,slide,energy,critical"},
       {"rung", u8, {b}, "0 rigid, 1 elastic, 2 frame, 3 planar", ""},
       {"floor_acceleration", f64, {3}, "m/s^2", "x,y,z"},
       {"floor_displacement", f64, {3}, "m", "x,y,z"},
       {"load_factor", f64, {}, "1", ""},
       {"anchor",
        f32,
        {a, 4},
        "N,J,m,0 away 1 slack 2 holds 3 broken",
        "tension,energy,natural_length,state"}}};
}

std::size_t row_bytes(const FrameField& field) {
  std::size_t bytes = H5Tget_size(field.type);
  for (const hsize_t dim : field.dims) bytes *= dim;
  return bytes;
}

std::size_t field_count(const RowShape& shape) {
  return shape.anchors > 0 ? k_field_count : k_field_count - 1;
}

void expect_same_model(const Model& model, const FrameRow& row) {
  if (row.position.size() != 3 * model.node_position.size() || row.s.size() != model.elements.size() ||
      row.contact_depth.size() != model.contact_points.size() * model.planes.size() ||
      row.level.size() != model.bodies.size() || row.anchor.size() != model.anchors.size())
    throw InputError(k_another_model);
}

void leave_out(const Format& format, FrameRow& row) {
  const auto fields = frame_fields({});
  const auto bytes = field_bytes(row);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (!format.has_field(fields[i].name)) std::ranges::fill(bytes[i], std::byte{});
  for (const std::size_t column : format.no_energies) row.energy[column] = 0;
}

}  // namespace topple::io
