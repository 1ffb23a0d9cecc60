#include "solver/io/export/export_xdmf.h"

#include <array>
#include <cstdio>

#include "solver/io/export/exported_values.h"
#include "solver/io/host/staged_file.h"
#include "solver/io/recording/hdf5_handle.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  }
  return out;
}

/// How numbers are stored, and what XDMF calls that.
struct NumberType {
  hid_t stored;
  const char* xdmf;
};
template <typename Number>
NumberType number_type() {
  if constexpr (std::is_same_v<Number, float>)
    return {H5T_IEEE_F32LE, "NumberType=\"Float\" Precision=\"4\""};
  if constexpr (std::is_same_v<Number, double>)
    return {H5T_IEEE_F64LE, "NumberType=\"Float\" Precision=\"8\""};
  if constexpr (std::is_same_v<Number, std::int32_t>)
    return {H5T_STD_I32LE, "NumberType=\"Int\" Precision=\"4\""};
  if constexpr (std::is_same_v<Number, std::uint8_t>)
    return {H5T_STD_U8LE, "NumberType=\"UChar\" Precision=\"1\""};
}

/// Both files while they are written: every array goes into the HDF5 file and is named in the XML.
class XdmfFile {
 public:
  explicit XdmfFile(const host::Target& target)
      : xml_(target, host::FileKind::xdmf),
        data_({target.path.string() + ".h5", target.force}, host::FileKind::hdf5) {
    guarded([this] {
      h5_ =
          Handle(H5Fcreate(data_.part().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, unbuffered_access()), H5Fclose);
      link_ = Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
      checked(H5Pset_create_intermediate_group(link_, 1));
      creation_ = Handle(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      checked(H5Pset_obj_track_times(creation_, false));  // the same bytes every time
    });
    text_ =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
        "<Grid Name=\"topple\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  }

  /// Stores an array; `columns` numbers belong to each of its rows. The DataItem that refers to it.
  template <typename Number>
  std::string store(const std::string& name, const std::vector<Number>& values, std::size_t columns) {
    const std::array<hsize_t, 2> dims = {values.size() / columns, columns};
    const int rank = columns == 1 ? 1 : 2;
    const NumberType type = number_type<Number>();
    guarded([&] {
      const Handle space(H5Screate_simple(rank, dims.data(), nullptr), H5Sclose);
      const Handle set(H5Dcreate2(h5_, name.c_str(), type.stored, space, link_, creation_, H5P_DEFAULT),
                       H5Dclose);
      checked(H5Dwrite(set, type.stored, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    });
    return std::string("<DataItem Format=\"HDF\" ") + type.xdmf + " Dimensions=\"" + std::to_string(dims[0]) +
           (rank == 2 ? " " + std::to_string(columns) : "") + "\">" +
           escaped(data_.path().filename().string()) + ":/" + name + "</DataItem>\n";
  }

  void add(const std::string& xml) { text_ += xml; }

  void commit() {
    guarded([this] { checked(h5_.reset()); });
    text_ += "</Grid>\n</Domain>\n</Xdmf>\n";
    xml_.write(text_);
    data_.commit();
    xml_.commit();
  }

 private:
  template <typename Work>
  void guarded(Work&& work) {
    const QuietHdf5 quiet;
    try {
      work();
    } catch (const Hdf5Error& error) {
      h5_.release();  // closing would write over caches that a failed write has left in no good state
      throw WriteError(data_.path().string() + ": cannot be written: " + error.what());
    }
  }

  host::StagedFile xml_, data_;
  Handle h5_, link_, creation_;
  std::string text_;
};

std::string attribute(const char* name, const char* centre, std::size_t columns, const std::string& item) {
  return std::string("<Attribute Name=\"") + name + "\" AttributeType=\"" +
         (columns == 3 ? "Vector" : "Scalar") + "\" Center=\"" + centre + "\">" + item + "</Attribute>\n";
}

/// What is the same in all frames: lines from node to node, and whose they are.
std::string fixed_parts(XdmfFile& file, const Model& model) {
  const ElementPlaces places(model);
  std::string text = "<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"" +
                     std::to_string(model.elements.size()) + "\">";
  text += file.store("topology", places.nodes, 2) + "</Topology>\n";
  text += attribute("body", "Cell", 1, file.store("body", places.body, 1));
  return text + attribute("member", "Cell", 1, file.store("member", places.member, 1));
}

void add_frame(XdmfFile& file, const Model& model, const FrameRow& row, int number,
               const std::string& fixed) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "/%06d", number);
  file.add("<Grid Name=\"frame\" GridType=\"Uniform\">\n<Time Value=\"" + shortest(row.time) + "\"/>\n");
  file.add(fixed);
  file.add("<Geometry GeometryType=\"XYZ\">" +
           file.store("position_m" + std::string(digits), row.position, 3) + "</Geometry>\n");
  each_field(model, row, [&](const char* name, FieldPlace place, const auto& values, std::size_t columns) {
    file.add(attribute(name, place == FieldPlace::nodes ? "Node" : "Cell", columns,
                       file.store(name + std::string(digits), values, columns)));
  });
  file.add("</Grid>\n");
}

}  // namespace

bool export_xdmf(const Recording& recording, const host::Target& target, const Proceed& proceed) {
  const Scene scene = recorded_scene(recording);
  const Model& model = scene.setup.model;
  XdmfFile file(target);
  const std::string fixed = fixed_parts(file, model);
  int number = 0;
  if (!each_frame(recording, scene.setup, proceed,
                  [&](const FrameRow& row) { add_frame(file, model, row, number++, fixed); }))
    return false;
  file.commit();
  return true;
}

}  // namespace topple::io
