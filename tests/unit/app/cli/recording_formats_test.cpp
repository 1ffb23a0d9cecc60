// Recordings of all formats before the program: shown, exported, and verified as far as they can be.
#include "solver/io/recording/recording.h"
#include "solver/math/elementary.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

class RecordingFormatsTest : public ProgramTest {
 protected:
  static std::string kept(const std::string& name) {
    return bytes_of(TOPPLE_SOURCE_DIR "/tests/recordings/" + name + ".h5");
  }
  static std::string parted(int format) {
    return "undamaged; written by another arithmetic (the system's functions, format " +
           std::to_string(format) + "): the re-run parts at ";
  }
};

TEST_F(RecordingFormatsTest, every_format_is_described_drawn_and_exported) {
  for (int format = 1; format <= 7; ++format) {
    SCOPED_TRACE(format);
    write_bytes("a.h5", kept("format-" + std::to_string(format)));
    const auto listed = info("a.h5");
    EXPECT_EQ(listed["format"], format);
    EXPECT_EQ(listed["arithmetic"], io::k_system_arithmetic);
    EXPECT_EQ(listed["frames"], 7);
    EXPECT_EQ(topple({"render", "a.h5", "--still", "a.png", "--at", "0.2", "--size", "160x90"}).code, 0);
    EXPECT_EQ(topple({"export", "a.h5", "--csv", "data"}).code, 0);
    EXPECT_TRUE(std::filesystem::exists("a.png"));
    EXPECT_TRUE(std::filesystem::exists("data/energy.csv"));
    std::filesystem::remove("a.png");
    std::filesystem::remove_all("data");
  }
}

TEST_F(RecordingFormatsTest, another_arithmetic_is_told_from_damage) {
  for (int format = 1; format <= 7; ++format) {
    SCOPED_TRACE(format);
    write_bytes("a.h5", kept("format-" + std::to_string(format)));
    const Ended ended = topple({"info", "a.h5", "--verify"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find(parted(format)), std::string::npos) << ended.out;
  }
  const Ended ended = topple({"info", "a.h5", "--verify", "--json", "-"});
  EXPECT_EQ(ended.code, 0);
  const auto verify = json_of(ended.out)["verify"];
  EXPECT_EQ(verify["damaged"], false);
  EXPECT_EQ(verify["same"], false);
  std::string bytes = kept("format-7");
  const auto position = io::Recording("a.h5").frame(4).position;
  const auto place = bytes.find({reinterpret_cast<const char*>(position.data()), 4 * position.size()});
  ASSERT_NE(place, std::string::npos);
  bytes[place] = static_cast<char>(bytes[place] ^ 1);
  write_bytes("a.h5", bytes);
  expect_one_line({"info", "a.h5", "--verify"}, 2,
                  "a.h5: cannot read: frame 4 is damaged (checksum differs)");
}

TEST_F(RecordingFormatsTest, a_recording_of_this_arithmetic_repeats_to_the_last_bit) {
  ASSERT_STREQ(arithmetic(), "topple-19");
  write_bytes("a.h5", kept("format-10-topple-19"));
  const Ended ended = topple({"info", "a.h5", "--verify"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.out.find("re-run: 2 checkpoints of 1 branch have the same state hashes\n"),
            std::string::npos)
      << ended.out;
  EXPECT_EQ(ended.out.find("another arithmetic"), std::string::npos);
}

}  // namespace
}  // namespace topple::app
