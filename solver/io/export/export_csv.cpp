#include "solver/io/export/export_csv.h"

#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

namespace fs = std::filesystem;

/// A table that appears under its name when it is complete.
class CsvFile {
 public:
  CsvFile(const host::Target& target, const char* header) : staged_(target, host::FileKind::csv) {
    file_.reset(std::fopen(staged_.part().c_str(), "wb"));
    if (!file_) fail();
    buffer_ = header;
    buffer_ += '\n';
  }

  template <typename Number>
  CsvFile& number(Number value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return field({digits, static_cast<std::size_t>(end - digits)});
  }
  template <typename Number>
  CsvFile& numbers(const Number* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) number(values[i]);
    return *this;
  }
  /// A name; in quotes where RFC 4180 asks for them.
  CsvFile& text(const std::string& value) {
    if (value.find_first_of(",\"\r\n") == std::string::npos) return field(value);
    std::string quoted = "\"";
    for (const char c : value) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field(quoted + '"');
  }
  CsvFile& none() { return field({}); }
  void end_row() {
    buffer_ += '\n';
    at_row_start_ = true;
    constexpr std::size_t enough = 1 << 16;
    if (buffer_.size() >= enough) write();
  }
  /// Puts everything on disk, under the temporary name still.
  void close() {
    write();
    if (std::fclose(file_.release()) != 0) fail();
  }
  void commit() { staged_.commit(); }

 private:
  CsvFile& field(std::string_view value) {
    if (!at_row_start_) buffer_ += ',';
    at_row_start_ = false;
    buffer_ += value;
    return *this;
  }
  void write() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) fail();
    buffer_.clear();
  }
  [[noreturn]] void fail() const {
    throw WriteError(staged_.path().string() +
                     ": cannot be written: " + std::generic_category().message(errno));
  }

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  host::StagedFile staged_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string buffer_;
  bool at_row_start_ = true;
};

void bodies_rows(CsvFile& csv, const Model& model, const FrameRow& row) {
  for (std::size_t b = 0; b < static_cast<std::size_t>(model.furniture_total()); ++b) {
    const BodyNumbers& body = row.body[b];
    csv.number(row.time).text(model.bodies[b].name).numbers(std::bit_cast<BodyArray>(body).data(), 7);
    csv.number(body.tilt * 180 / k_pi).number(body.slide).number(body.energy).end_row();
  }
}

void nodes_rows(CsvFile& csv, const Model& model, const FrameRow& row) {
  for (const Body& body : model.bodies) {
    for (int k = 0; k < body.node_count; ++k) {
      const auto n = static_cast<std::size_t>(body.first_node + k);
      csv.number(row.time).text(body.name).number(k);
      csv.numbers(row.position.data() + 3 * n, 3).numbers(row.rotation.data() + 4 * n, 4).end_row();
    }
  }
}

void elements_rows(CsvFile& csv, const Model& model, const FrameRow& row) {
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Member& member = model.members[static_cast<std::size_t>(model.elements[e].member)];
    const float* f = row.section_force.data() + 6 * e;
    const ElementLoading loading = element_loading(model, row, e);
    const bool known = has_stresses(row, member.body);
    const auto number_if = [&](bool is, auto value) { is ? csv.number(value) : csv.none(); };
    csv.number(row.time).text(model.bodies[static_cast<std::size_t>(member.body)].name).text(member.name);
    csv.number(static_cast<int>(e) - member.first_element);
    for (int k = 0; k < 6; ++k) number_if(known, f[k]);
    number_if(known, loading.stress);
    number_if(known && std::isfinite(model.elements[e].capacity[0]), loading.yield_ratio);
    csv.number(row.s[e]).number(static_cast<int>(row.hinge[e]));
    number_if(known, loading.peak);
    csv.end_row();
  }
}

void contacts_rows(CsvFile& csv, const Model& model, const FrameRow& row) {
  for (const ContactForce& one : contact_forces(model, row)) {
    csv.number(row.time).text(model.bodies[static_cast<std::size_t>(one.body)].name).text(one.part);
    const Eigen::Vector3f place = one.place.cast<float>(), force = one.force.cast<float>();
    csv.text(one.against).numbers(place.data(), 3).numbers(force.data(), 3).end_row();
  }
}

void energy_row(CsvFile& csv, const FrameRow& row) {
  csv.number(row.time).numbers(row.energy.data(), row.energy.size()).end_row();
}

void anchors_rows(CsvFile& csv, const Model& model, const FrameRow& row) {
  for (std::size_t k = 0; k < model.anchors.size(); ++k) {
    const AnchorNumbers& anchor = row.anchor[k];
    csv.number(row.time).text(model.anchors[k].name);
    csv.number(anchor.tension).number(anchor.energy).number(anchor.natural_length);
    csv.text(anchor_word(anchor_state(model.anchors[k], anchor))).end_row();
  }
}

void floor_row(CsvFile& csv, const FrameRow& row) {
  csv.number(row.time).numbers(row.floor_acceleration, 3).numbers(row.floor_displacement, 3).end_row();
}

}  // namespace

bool write_csv(const Recording& recording, const Setup& setup, const host::Target& folder,
               const Proceed& proceed) {
  const Model& model = setup.model;
  std::error_code error;
  fs::create_directories(folder.path, error);
  if (error) throw WriteError(folder.path.string() + ": cannot be created: " + error.message());
  const auto within = [&](const char* name) { return host::Target(folder.path / name, folder.force); };
  CsvFile bodies(within("bodies.csv"), "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,tilt_deg,slide_m,energy_J");
  CsvFile nodes(within("nodes.csv"), "time_s,body,node,x_m,y_m,z_m,qw,qx,qy,qz");
  CsvFile elements(within("elements.csv"),
                   "time_s,body,member,element,N,Vy,Vz,T,My,Mz,stress_Pa,yield_ratio,s,hinge,peak_stress_Pa");
  CsvFile contacts(within("contacts.csv"), "time_s,body,part,against,x_m,y_m,z_m,Fx,Fy,Fz");
  CsvFile floor(within("floor.csv"), "time_s,ax,ay,az,dx,dy,dz");
  std::string energies = "time_s";
  for (const EnergyTraits& column : energy_columns(!model.anchors.empty()))
    energies += std::string(",") + column.name + (column.kind == k_balance_error ? "" : "_J");
  CsvFile energy(within("energy.csv"), energies.c_str());
  std::optional<CsvFile> anchors;
  if (!model.anchors.empty())
    anchors.emplace(within("anchors.csv"), "time_s,anchor,tension_N,energy_J,natural_length_m,state");
  const bool whole = each_frame(recording, setup, proceed, [&](const FrameRow& row) {
    bodies_rows(bodies, model, row);
    nodes_rows(nodes, model, row);
    elements_rows(elements, model, row);
    contacts_rows(contacts, model, row);
    floor_row(floor, row);
    energy_row(energy, row);
    if (anchors) anchors_rows(*anchors, model, row);
  });
  if (!whole) return false;
  std::vector<CsvFile*> files = {&bodies, &nodes, &elements, &contacts, &floor, &energy};
  if (anchors) files.push_back(&*anchors);
  for (CsvFile* file : files) file->close();
  for (CsvFile* file : files) file->commit();
  return true;
}

bool export_csv(const Recording& recording, const host::Target& folder, const Proceed& proceed) {
  const Scene scene = recorded_scene(recording);
  return write_csv(recording, scene.setup, folder, proceed);
}

}  // namespace topple::io
