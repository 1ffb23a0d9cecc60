// Tables of a recording: the columns of the contract, the numbers of the recording.
#include <sstream>

#include "program.h"
#include "scenes.h"
#include "solver/io/recording.h"
#include "solver/types.h"

namespace topple::app {
namespace {

using Table = std::vector<std::vector<std::string>>;

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
  static Table rows(const std::string& name, const std::string& header) {
    std::istringstream text(bytes_of("new/data/" + name));
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
    for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(number(row[2 + k]), frame.body[k]);
    EXPECT_DOUBLE_EQ(number(row[9]), frame.body[7] * 180 / k_pi);
    EXPECT_EQ(number(row[10]), frame.body[8]);
    EXPECT_EQ(number(row[11]), frame.body[9]);
  }
  const auto summary = info("a.h5")["summary"];
  EXPECT_EQ(number(table.back()[0]), summary["simulated_s"]);
  EXPECT_DOUBLE_EQ(number(table.back()[9]), summary["bodies"][0]["final_tilt_deg"]);
  EXPECT_EQ(number(table.back()[10]), summary["bodies"][0]["final_slide_m"]);
}

TEST_F(ExportTest, every_node_element_and_instant_has_its_row) {
  const auto what = info("a.h5");
  const std::size_t frames = what["frames"];
  EXPECT_EQ(frames, 31u);  // 100 Hz for 0.3 s, both ends included
  const Table nodes = rows("nodes.csv", "time_s,body,node,x_m,y_m,z_m,qw,qx,qy,qz");
  const Table elements =
      rows("elements.csv", "time_s,body,member,element,N,Vy,Vz,T,My,Mz,stress_Pa,yield_ratio,s,hinge");
  const Table floor = rows("floor.csv", "time_s,ax,ay,az,dx,dy,dz");
  EXPECT_EQ(nodes.size(), frames * what["nodes"].get<std::size_t>());
  EXPECT_EQ(elements.size(), frames * what["elements"].get<std::size_t>());
  ASSERT_EQ(floor.size(), frames);
  const io::Recording recording("a.h5");
  const io::FrameRow last = recording.frame(recording.frame_count() - 1);
  EXPECT_EQ(static_cast<float>(number(nodes.back()[5])), last.position.back());
  EXPECT_EQ(static_cast<float>(number(elements.back()[9])), last.section_force.back());
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(number(floor.back()[1 + static_cast<std::size_t>(k)]), last.floor_acceleration[k]);
    EXPECT_EQ(number(floor.back()[4 + static_cast<std::size_t>(k)]), last.floor_displacement[k]);
  }
  EXPECT_EQ(files().size(), 2u + 2u + 5u);  // scene, recording, two folders, five tables
}

TEST_F(ExportTest, tables_are_the_same_every_time_and_replace_older_ones) {
  const std::string before = bytes_of("new/data/nodes.csv");
  write_bytes("new/data/nodes.csv", "older");
  ASSERT_EQ(topple({"export", "a.h5", "--csv", "new/data"}).code, 0);
  EXPECT_EQ(bytes_of("new/data/nodes.csv"), before);
}

}  // namespace
}  // namespace topple::app
