#include "solver/io/export/export_vtk.h"

#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <numeric>
#include <type_traits>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

template <typename Number>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<Number, float>) return "Float32";
  if constexpr (std::is_same_v<Number, double>) return "Float64";
  if constexpr (std::is_same_v<Number, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

/// Numbers behind the XML, each array after the count of its bytes.
class RawData {
 public:
  /// The XML element that refers to the array; `columns` numbers belong to each of its rows.
  template <typename Number>
  std::string array(const char* name, const std::vector<Number>& values, std::size_t columns) {
    std::string element = std::string("<DataArray type=\"") + type_name<Number>() + "\" Name=\"" + name +
                          "\" NumberOfComponents=\"" + std::to_string(columns) +
                          "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
    const std::uint64_t size = values.size() * sizeof(Number);
    append(&size, sizeof size);
    append(values.data(), size);
    return element;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t size) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    if (size > 0) std::memcpy(bytes_.data() + at, from, size);
  }
  std::string bytes_;
};

std::string frame_file(const Model& model, const ElementPlaces& places, const FrameRow& row) {
  std::vector<std::int32_t> ends(model.elements.size());
  for (std::size_t e = 0; e < ends.size(); ++e) ends[e] = static_cast<std::int32_t>(2 * e + 2);
  RawData data;
  std::string on_nodes, on_elements = data.array("body", places.body, 1);
  on_elements += data.array("member", places.member, 1);
  each_field(model, row, [&](const char* name, FieldPlace place, const auto& values, std::size_t columns) {
    (place == FieldPlace::nodes ? on_nodes : on_elements) += data.array(name, values, columns);
  });
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
      std::to_string(model.node_position.size()) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
      std::to_string(model.elements.size()) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  text += "<Points>\n" + data.array("position_m", row.position, 3) + "</Points>\n";
  text += "<Lines>\n" + data.array("connectivity", places.nodes, 1);
  text += data.array("offsets", ends, 1) + "</Lines>\n";
  text += "<PointData>\n" + on_nodes + "</PointData>\n<CellData>\n" + on_elements + "</CellData>\n";
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return text + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace

bool export_vtk(const Recording& recording, const host::Target& folder, const Proceed& proceed) {
  const Scene scene = recorded_scene(recording);
  const Model& model = scene.setup.model;
  const ElementPlaces places(model);
  std::deque<host::StagedFile> files;
  const auto write = [&](const char* name, const std::string& text) {
    files.emplace_back(host::Target(folder.path / name, folder.force), host::FileKind::vtk).write(text);
  };
  std::string list =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  const bool whole = each_frame(recording, scene.setup, proceed, [&](const FrameRow& row) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%06zu.vtp", files.size());
    write(name, frame_file(model, places, row));
    list += "<DataSet timestep=\"" + shortest(row.time) + "\" file=\"" + name + "\"/>\n";
  });
  if (!whole) return false;
  write("frames.pvd", list + "</Collection>\n</VTKFile>\n");
  for (host::StagedFile& file : files) file.commit();
  return true;
}

}  // namespace topple::io
