// Tables of a recording: the columns of the contract, the numbers of the recording. XDMF and VTK: those
// of the tables.
#include <Eigen/Geometry>
#include <cstring>
#include <map>
#include <regex>
#include <sstream>

#include "solver/io/recording/hdf5_handle.h"
#include "solver/io/recording/recording.h"
#include "solver/math/types.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

using Table = std::vector<std::vector<std::string>>;

constexpr const char* k_elements =
    "time_s,body,member,element,N,Vy,Vz,T,My,Mz,stress_Pa,yield_ratio,s,hinge,peak_stress_Pa";

/// What was exported of an instant: by name the arrays and where they belong.
struct ExportedGrid {
  double time = 0;
  struct Array {
    std::string centre, set;
    std::vector<hsize_t> dims;
    std::vector<double> values;
  };
  std::map<std::string, Array> arrays;  ///< attributes by name; also "Topology", "Geometry"
};

class ExportTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("s.toml", k_shaken);
    ASSERT_EQ(topple({"run", "s.toml", "-o", "a.h5"}).code, 0);
    const Ended ended = topple({"export", "a.h5", "--csv", "new/data"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
  }
  /// Rows below the header, which must be `header`.
  static Table rows(const std::string& name, const std::string& header,
                    const std::string& folder = "new/data/") {
    std::istringstream text(bytes_of(folder + name));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, header) << name;
    const auto columns = std::count(header.begin(), header.end(), ',') + 1;
    Table table;
    while (std::getline(text, line)) {
      std::vector<std::string>& row = table.emplace_back();
      std::istringstream fields(line + ",");
      for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
      EXPECT_EQ(row.size(), static_cast<std::size_t>(columns)) << name << ": " << line;
    }
    return table;
  }
  static double number(const std::string& field) { return std::strtod(field.c_str(), nullptr); }
  /// Of an XML element.
  static std::string value(const std::string& attributes, const std::string& name) {
    const std::size_t at = attributes.find(" " + name + "=\"");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 3;
    return attributes.substr(begin, attributes.find('"', begin) - begin);
  }

  /// What the grids hold is what the tables hold, exactly.
  static void expect_as_tables(const std::vector<ExportedGrid>& grids, const std::string& folder) {
    const Table nodes = rows("nodes.csv", "time_s,body,node,x_m,y_m,z_m,qw,qx,qy,qz", folder);
    const Table elements = rows("elements.csv", k_elements, folder);
    ASSERT_FALSE(grids.empty());
    const std::size_t n = nodes.size() / grids.size(), e = elements.size() / grids.size();
    const std::vector<std::string> columns = {"N_N",   "Vy_N",  "Vz_N",          "T_Nm",
                                              "My_Nm", "Mz_Nm", "stress_Pa",     "yield_ratio",
                                              "s",     "hinge", "peak_stress_Pa"};
    for (std::size_t f = 0; f < grids.size(); ++f) {
      const ExportedGrid& grid = grids[f];
      EXPECT_EQ(grid.time, number(nodes[f * n][0]));
      EXPECT_EQ(grid.arrays.at("Topology").dims, (std::vector<hsize_t>{e, 2}));
      ASSERT_EQ(grid.arrays.at("Geometry").dims, (std::vector<hsize_t>{n, 3}));
      for (std::size_t i = 0; i < 3 * n; ++i)
        EXPECT_EQ(grid.arrays.at("Geometry").values[i],
                  std::strtof(nodes[f * n + i / 3][3 + i % 3].c_str(), nullptr));
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const ExportedGrid::Array& array = grid.arrays.at(columns[c]);
        EXPECT_EQ(array.centre, "Cell");
        ASSERT_EQ(array.dims, (std::vector<hsize_t>{e}));
        for (std::size_t i = 0; i < e; ++i) {
          const std::string& field = elements[f * e + i][4 + c];
          EXPECT_EQ(array.values[i],
                    columns[c].ends_with("stress_Pa") ? number(field) : std::strtof(field.c_str(), nullptr))
              << columns[c] << " of element " << i << " at " << grid.time << " s";
        }
      }
    }
  }
};

TEST_F(ExportTest, bodies_are_those_of_the_recording) {
  const Table table = rows("bodies.csv", "time_s,body,x_m,y_m,z_m,qw,qx,qy,qz,tilt_deg,slide_m,energy_J");
  const io::Recording recording("a.h5");
  ASSERT_EQ(table.size(), static_cast<std::size_t>(recording.frame_count()));
  for (std::int64_t i = 0; i < recording.frame_count(); ++i) {
    const io::FrameRow frame = recording.frame(i);
    const std::vector<std::string>& row = table[static_cast<std::size_t>(i)];
    EXPECT_EQ(number(row[0]), frame.time);
    EXPECT_EQ(row[1], "free");
    const io::BodyNumbers& body = frame.body[0];
    const double pose[] = {body.x, body.y, body.z, body.qw, body.qx, body.qy, body.qz};
    for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(number(row[2 + k]), pose[k]);
    EXPECT_DOUBLE_EQ(number(row[9]), body.tilt * 180 / k_pi);
    EXPECT_EQ(number(row[10]), body.slide);
    EXPECT_EQ(number(row[11]), body.energy);
  }
  const auto summary = info("a.h5")["summary"];
  EXPECT_DOUBLE_EQ(number(table.back()[0]), summary["simulated_s"]);
  EXPECT_DOUBLE_EQ(number(table.back()[9]), summary["bodies"][0]["final_tilt_deg"]);
  EXPECT_EQ(number(table.back()[10]), summary["bodies"][0]["final_slide_m"]);
}

// Within steps that are longer than 10 ms rows of this scene hold 1.3 % more than the ends of steps.
TEST_F(ExportTest, no_row_holds_more_than_the_peak_that_is_told) {
  ASSERT_EQ(topple({"run", "paper-a", "--set", "run.time_step=auto", "-o", "b.h5"}).code, 0);
  ASSERT_EQ(topple({"export", "b.h5", "--csv", "b"}).code, 0);
  double peak = 0;
  for (const std::vector<std::string>& row : rows("elements.csv", k_elements, "b/"))
    if (row[1] == "free") peak = std::max(peak, number(row.back()));
  const double told = info("b.h5")["summary"]["bodies"][0]["peak_stress_Pa"];
  EXPECT_LE(peak, (1 + 1e-6) * told);  // single precision
  EXPECT_GE(peak, 0.9 * told);
}

TEST_F(ExportTest, forces_of_a_body_that_is_rigid_are_left_empty) {
  ASSERT_EQ(topple({"run", "free-rocking", "--set", "run.want=['motion']", "--set", "run.duration=0.1 s",
                    "-o", "b.h5"})
                .code,
            0);
  ASSERT_EQ(topple({"export", "b.h5", "--csv", "b"}).code, 0);
  const Table table = rows("elements.csv", k_elements, "b/");
  ASSERT_FALSE(table.empty());
  for (const std::size_t column : {4u, 9u, 10u, 11u, 14u}) EXPECT_EQ(table.back()[column], "");
  EXPECT_NE(table.back()[12], "");
}

TEST_F(ExportTest, every_node_element_and_instant_has_its_row) {
  const auto what = info("a.h5");
  const std::size_t frames = what["frames"];
  EXPECT_EQ(frames, 31u);  // 100 Hz for 0.3 s, both ends included
  const Table nodes = rows("nodes.csv", "time_s,body,node,x_m,y_m,z_m,qw,qx,qy,qz");
  const Table elements = rows("elements.csv", k_elements);
  const Table floor = rows("floor.csv", "time_s,ax,ay,az,dx,dy,dz");
  EXPECT_EQ(nodes.size(), frames * what["nodes"].get<std::size_t>());
  EXPECT_EQ(elements.size(), frames * what["elements"].get<std::size_t>());
  ASSERT_EQ(floor.size(), frames);
  const io::Recording recording("a.h5");
  const io::FrameRow last = recording.frame(recording.frame_count() - 1);
  EXPECT_EQ(static_cast<float>(number(nodes.back()[5])), last.position.back());
  EXPECT_EQ(static_cast<float>(number(elements.back()[9])), last.section_force.back());
  double at_points = 0, peak = 0;
  for (const std::vector<std::string>& row : elements) {
    at_points = std::max(at_points, number(row[10]));
    peak = std::max(peak, number(row.back()));
  }
  EXPECT_GT(peak, at_points);
  EXPECT_LE(peak,
            (1 + 1e-6) * what["summary"]["bodies"][0]["peak_stress_Pa"].get<double>());  // single precision
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(number(floor.back()[1 + static_cast<std::size_t>(k)]), last.floor_acceleration[k]);
    EXPECT_EQ(number(floor.back()[4 + static_cast<std::size_t>(k)]), last.floor_displacement[k]);
  }
  EXPECT_EQ(files().size(), 2u + 2u + 6u);  // scene, recording, two folders, six tables
}

// A block of 10 kg on one of 50 kg, settled: to 1e-6 of the weight, as rows are of single precision. 198 mm
// from the middle its edge is where the face below hands over to the member at its side.
TEST_F(ExportTest, what_stands_is_pushed_by_its_weight_and_pushes_back) {
  for (const char* x : {"0", "0.098"}) {
    SCOPED_TRACE(x);
    write_bytes("stack.toml",
                "topple = 1\n[run]\nduration = 0.02\n[floor]\n"
                "[[block]]\nname = \"below\"\nsize = [0.4, 0.4, 0.2]\nmass = 50\n"
                "[[block]]\nname = \"above\"\nsize = [0.2, 0.2, 0.2]\nmass = 10\nat = [" +
                    std::string(x) + ", 0, 0.21]\n");
    ASSERT_EQ(topple({"run", "stack.toml", "-o", "stack.h5", "--force"}).code, 0);
    ASSERT_EQ(topple({"export", "stack.h5", "--csv", "stack", "--force"}).code, 0);
    std::map<std::string, Vec3> last;  // by body and what pushes it
    for (const auto& row : rows("contacts.csv", "time_s,body,part,against,x_m,y_m,z_m,Fx,Fy,Fz", "stack/")) {
      if (number(row[0]) < 0.02) continue;
      EXPECT_TRUE(row[2].starts_with("node ") == !row[3].empty()) << row[2] << ", " << row[3];
      const auto sum = last.try_emplace(row[1] + "/" + row[3], Vec3::Zero()).first;
      sum->second += Vec3(number(row[7]), number(row[8]), number(row[9]));
    }
    const Vec3 g(0, 0, 9.80665);
    const double rounding = 1e-6 * 60 * g.z();
    EXPECT_EQ(last.size(), 3u);
    EXPECT_LT((last["below/floor"] - 60 * g).norm(), rounding);
    EXPECT_LT((last["above/"] - 10 * g).norm(), rounding);
    EXPECT_LT((last["below/"] + 10 * g).norm(), rounding);
  }
}

TEST_F(ExportTest, columns_of_all_tables_are_explained_in_their_order) {
  ASSERT_EQ(topple({"run", "anchored", "--set", "run.duration=0.01", "-o", "t.h5"}).code, 0);
  ASSERT_EQ(topple({"export", "t.h5", "--csv", "tied"}).code, 0);
  std::map<std::string, std::string> written, explained;
  for (const auto& entry : std::filesystem::directory_iterator("tied")) {
    const std::string text = bytes_of(entry.path());
    written[entry.path().filename().string()] = text.substr(0, text.find('\n'));
  }
  const std::string theory = bytes_of(TOPPLE_SOURCE_DIR "/assets/guide/theory.md");
  const std::regex row(R"(\n\| (\w+\.csv) \| ([^|\n]+) \| ([^|\n]+) \|)"), column("`(\\w+)`");
  for (std::sregex_iterator i(theory.begin(), theory.end(), row), none; i != none; ++i) {
    const std::string cells = (*i)[2], units = (*i)[3];
    std::string& list = explained[(*i)[1]];
    const auto first = std::sregex_iterator(cells.begin(), cells.end(), column);
    for (auto k = first; k != none; ++k) list += (list.empty() ? "" : ",") + (*k)[1].str();
    const auto given = std::count(units.begin(), units.end(), ',') + 1;
    EXPECT_TRUE(given == 1 || given == std::distance(first, none)) << cells << ": " << units;
  }
  EXPECT_EQ(explained, written);
}

TEST_F(ExportTest, tables_are_the_same_every_time_and_replace_older_ones) {
  const std::string before = bytes_of("new/data/nodes.csv");
  write_bytes("new/data/nodes.csv", "older,table\n");
  ASSERT_EQ(topple({"export", "a.h5", "--csv", "new/data"}).code, 0);
  EXPECT_EQ(bytes_of("new/data/nodes.csv"), before);
}

class XdmfTest : public ExportTest {
 protected:
  static std::vector<ExportedGrid> read_xdmf(const std::string& file) {
    const std::string text = bytes_of(file);
    const io::Handle data(H5Fopen((file + ".h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    std::vector<ExportedGrid> grids;
    std::vector<std::string> open;  // elements that are not closed yet
    std::string name, centre;
    const std::regex tag(R"(<([!?/]?)(\w+)([^<>]*?)(/?)>([^<]*))");
    for (std::sregex_iterator i(text.begin(), text.end(), tag), none; i != none; ++i) {
      const std::string kind = (*i)[1], element = (*i)[2], attributes = (*i)[3];
      if (kind == "!" || kind == "?") continue;
      if (kind == "/") {
        EXPECT_EQ(open.empty() ? "" : open.back(), element);
        if (!open.empty()) open.pop_back();
        continue;
      }
      if ((*i)[4] != "/") open.push_back(element);
      if (element == "Grid" && value(attributes, "GridType") == "Uniform") grids.emplace_back();
      if (element == "Time") grids.back().time = number(value(attributes, "Value"));
      if (element == "Attribute" || element == "Topology" || element == "Geometry") {
        name = element == "Attribute" ? value(attributes, "Name") : element;
        centre = value(attributes, "Center");
      }
      if (element == "DataItem") grids.back().arrays[name] = array(data, file, centre, attributes, (*i)[5]);
    }
    EXPECT_TRUE(open.empty());
    return grids;
  }

 private:
  static ExportedGrid::Array array(hid_t data, const std::string& file, const std::string& centre,
                                   const std::string& attributes, const std::string& text) {
    ExportedGrid::Array out;
    out.centre = centre;
    std::istringstream dims(value(attributes, "Dimensions"));
    std::size_t count = 1;
    for (hsize_t dim; dims >> dim; count *= dim) out.dims.push_back(dim);
    const std::string before = std::filesystem::path(file).filename().string() + ".h5:";
    EXPECT_TRUE(text.starts_with(before)) << text;
    out.set = text.substr(before.size());
    const io::Handle set(H5Dopen2(data, out.set.c_str(), H5P_DEFAULT), H5Dclose);
    const io::Handle space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
    EXPECT_EQ(std::to_string(H5Tget_size(type)), value(attributes, "Precision"));
    EXPECT_EQ(H5Tget_class(type) == H5T_FLOAT, value(attributes, "NumberType") == "Float");
    std::vector<hsize_t> extent(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    EXPECT_EQ(extent, out.dims);
    out.values.resize(count);
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.values.data()), 0);
    return out;
  }
};

TEST_F(XdmfTest, every_number_is_that_of_the_tables) {
  const Ended ended = topple({"export", "a.h5", "--xdmf", "a.xdmf"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  const std::vector<ExportedGrid> grids = read_xdmf("a.xdmf");
  ASSERT_EQ(grids.size(), 31u);
  EXPECT_NE(grids[0].arrays.at("stress_Pa").set, grids[1].arrays.at("stress_Pa").set);
  expect_as_tables(grids, "new/data/");
}

TEST_F(XdmfTest, yielding_and_hinges_are_those_of_the_tables) {
  ASSERT_EQ(topple({"run", "portal-pushover", "-o", "p.h5"}).code, 0);
  ASSERT_EQ(topple({"export", "p.h5", "--csv", "p"}).code, 0);
  ASSERT_EQ(topple({"export", "p.h5", "--xdmf", "p.xdmf"}).code, 0);
  const std::vector<ExportedGrid> grids = read_xdmf("p.xdmf");
  expect_as_tables(grids, "p/");
  const auto& ratio = grids.back().arrays.at("yield_ratio").values;
  // perfectly plastic; section forces of rows are floats
  EXPECT_NEAR(*std::max_element(ratio.begin(), ratio.end()), 1, 1e-6);
  const auto& hinge = grids.back().arrays.at("hinge").values;
  EXPECT_GT(*std::max_element(hinge.begin(), hinge.end()), 0);
}

TEST_F(XdmfTest, displacement_and_rotation_lead_from_the_reference_pose_to_the_instant) {
  ASSERT_EQ(topple({"export", "a.h5", "--xdmf", "a.xdmf"}).code, 0);
  const std::vector<ExportedGrid> grids = read_xdmf("a.xdmf");
  const io::Recording recording("a.h5");
  const Model model = io::recorded_scene(recording).setup.model;
  const ExportedGrid& last = grids.back();
  const io::FrameRow row = recording.frame(recording.frame_count() - 1);
  const auto vector = [&last](const char* name, std::size_t n) {
    return Eigen::Map<const Eigen::Vector3d>(last.arrays.at(name).values.data() + 3 * n);
  };
  double most = 0;
  for (std::size_t n = 0; n < model.node_position.size(); ++n) {
    EXPECT_EQ(last.arrays.at("displacement_m").centre, "Node");
    EXPECT_LT((model.node_position[n] + vector("displacement_m", n) - vector("Geometry", n)).norm(), 1e-14);
    const float* q = row.rotation.data() + 4 * n;
    const Eigen::Vector3d turn = vector("rotation_rad", n);
    const Eigen::Matrix3d matrix = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
    // 1e-6: a few roundings of the recorded floats
    EXPECT_LT((matrix - Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix()).norm(), 1e-6);
    most = std::max(most, turn.norm());
  }
  EXPECT_GT(most, 1e-3);  // it was shaken
}

TEST_F(XdmfTest, lines_join_the_nodes_of_their_elements) {
  ASSERT_EQ(topple({"export", "a.h5", "--xdmf", "a.xdmf"}).code, 0);
  const ExportedGrid grid = read_xdmf("a.xdmf").front();
  const Model model = io::recorded_scene(io::Recording("a.h5")).setup.model;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(grid.arrays.at("Topology").values[2 * e + k], model.elements[e].node[k]);
    EXPECT_EQ(grid.arrays.at("member").values[e], model.elements[e].member);
    EXPECT_EQ(grid.arrays.at("body").values[e], 0);
  }
}

TEST_F(XdmfTest, files_are_the_same_every_time_and_replace_older_ones) {
  ASSERT_EQ(topple({"export", "a.h5", "--xdmf", "a.xdmf"}).code, 0);
  const std::string xml = bytes_of("a.xdmf"), data = bytes_of("a.xdmf.h5");
  write_bytes("a.xdmf", "<Xdmf/>");
  write_bytes("a.xdmf.h5", k_older_recording);
  ASSERT_EQ(topple({"export", "a.h5", "--xdmf", "./a.xdmf"}).code, 0);
  EXPECT_EQ(bytes_of("a.xdmf"), xml);
  EXPECT_EQ(bytes_of("a.xdmf.h5"), data);
}

TEST_F(XdmfTest, places_that_cannot_be_are_refused_and_nothing_is_begun) {
  std::filesystem::copy_file("a.h5", "b.xdmf.h5");
  std::filesystem::create_directory("folder.h5");
  const std::vector<std::string> before = files();
  expect_one_line({"export", "a.h5", "--xdmf", "none/a.xdmf"}, 2, "there is no folder");
  expect_one_line({"export", "a.h5", "--xdmf", "folder"}, 2, "folder.h5: cannot be written: is a folder");
  expect_one_line({"export", "a.h5", "--xdmf", "a.h5"}, 2, "a.h5 is what is being read");
  expect_one_line({"export", "b.xdmf.h5", "--xdmf", "b.xdmf"}, 2, "b.xdmf.h5 is what is being read");
  expect_one_line({"export", "a.h5", "--xdmf", "a:b.xdmf"}, 2, "a name with a colon");
  EXPECT_EQ(files(), before);
}

class VtkTest : public XdmfTest {
 protected:
  void SetUp() override {
    XdmfTest::SetUp();
    const Ended ended = topple({"export", "a.h5", "--vtk", "v"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out + ended.err, "");
  }
  static std::vector<ExportedGrid> read_vtk(const std::string& folder) {
    const std::string list = bytes_of(folder + "/frames.pvd");
    std::vector<ExportedGrid> grids;
    const std::regex tag(R"(<DataSet([^<>]*)/>)");
    for (std::sregex_iterator i(list.begin(), list.end(), tag), none; i != none; ++i) {
      grids.push_back(read_frame(folder + "/" + value((*i)[1], "file")));
      grids.back().time = number(value((*i)[1], "timestep"));
    }
    return grids;
  }

 private:
  template <typename Number>
  static void read(const char* from, std::vector<double>& values) {
    for (double& x : values) {
      Number one;
      std::memcpy(&one, from, sizeof one);
      from += sizeof one;
      x = static_cast<double>(one);
    }
  }
  static ExportedGrid read_frame(const std::string& file) {
    const std::string bytes = bytes_of(file);
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    const std::size_t head = bytes.find(mark), data = head + mark.size();
    const std::string text = bytes.substr(0, head);
    const std::map<std::string, std::size_t> sizes = {
        {"Float32", 4}, {"Float64", 8}, {"Int32", 4}, {"UInt8", 1}};
    ExportedGrid grid;
    std::string section;
    std::size_t end = data;  // arrays fill what is appended without a gap
    std::map<std::size_t, std::size_t> taken;
    const std::regex tag(R"(<(\w+)([^<>]*)>)");
    for (std::sregex_iterator i(text.begin(), text.end(), tag), none; i != none; ++i) {
      const std::string attributes = (*i)[2];
      if ((*i)[1] != "DataArray") {
        section = (*i)[1];
        continue;
      }
      const std::size_t at = data + std::stoul(value(attributes, "offset"));
      const std::string type = value(attributes, "type");
      std::uint64_t size;
      std::memcpy(&size, bytes.data() + at, sizeof size);
      taken[at] = at + sizeof size + size;
      ExportedGrid::Array array;
      array.centre = section == "PointData" ? "Node" : section == "CellData" ? "Cell" : "";
      const hsize_t columns = std::stoul(value(attributes, "NumberOfComponents"));
      array.values.resize(size / sizes.at(type));
      array.dims = {array.values.size() / columns};
      if (columns > 1) array.dims.push_back(columns);
      const char* const from = bytes.data() + at + sizeof size;
      if (type == "Float32") read<float>(from, array.values);
      if (type == "Float64") read<double>(from, array.values);
      if (type == "Int32") read<std::int32_t>(from, array.values);
      if (type == "UInt8") read<std::uint8_t>(from, array.values);
      grid.arrays[section == "Points" ? "Geometry" : value(attributes, "Name")] = array;
    }
    for (const auto& [from, to] : taken) {
      EXPECT_EQ(from, end);
      end = to;
    }
    EXPECT_EQ(bytes.substr(end), "\n</AppendedData>\n</VTKFile>\n");
    // two nodes a line
    const std::vector<double>& ends = grid.arrays.at("offsets").values;
    for (std::size_t e = 0; e < ends.size(); ++e) EXPECT_EQ(ends[e], 2 * (e + 1));
    ExportedGrid::Array lines = grid.arrays.at("connectivity");
    lines.dims = {ends.size(), 2};
    grid.arrays["Topology"] = lines;
    return grid;
  }
};

TEST_F(VtkTest, every_number_is_that_of_the_tables_and_of_xdmf) {
  const std::vector<ExportedGrid> grids = read_vtk("v");
  ASSERT_EQ(grids.size(), 31u);
  expect_as_tables(grids, "new/data/");
  ASSERT_EQ(topple({"export", "a.h5", "--xdmf", "a.xdmf"}).code, 0);
  const std::vector<ExportedGrid> others = read_xdmf("a.xdmf");
  for (std::size_t f = 0; f < grids.size(); ++f)
    for (const auto& [name, array] : others[f].arrays) {
      EXPECT_EQ(grids[f].arrays.at(name).values, array.values) << name;
      EXPECT_EQ(grids[f].arrays.at(name).centre, array.centre) << name;
    }
}

TEST_F(VtkTest, files_are_the_same_every_time_and_replace_older_ones) {
  const std::string before = bytes_of("v/frame-000030.vtp");
  write_bytes("v/frame-000030.vtp", "<VTKFile/>");
  ASSERT_EQ(topple({"export", "a.h5", "--vtk", "v"}).code, 0);
  EXPECT_EQ(bytes_of("v/frame-000030.vtp"), before);
}

TEST_F(VtkTest, a_folder_that_cannot_be_is_refused_and_nothing_is_begun) {
  const std::vector<std::string> before = files();
  expect_one_line({"export", "a.h5", "--vtk", "a.h5"}, 2, "a.h5: cannot be created");
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace topple::app
