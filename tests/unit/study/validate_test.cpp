// Scores by hand, and readers of measured tables.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "solver/io/common/errors.h"
#include "solver/study/validate/granite_data.h"
#include "solver/study/validate/scores.h"

namespace topple::study {
namespace {

namespace fs = std::filesystem;

// Shares and squares counted by hand; Wilson's interval of 3 of 5 is that of spread_test.cpp.
TEST(Validate, scores_are_those_counted_by_hand) {
  const Scores scores = scored({{0.9, true}, {0.8, false}, {0.1, false}, {0.3, true}, {0.0, false}});
  EXPECT_EQ(scores.count, 5);
  EXPECT_EQ(scores.right, 3);
  EXPECT_NEAR(scores.brier, (0.01 + 0.64 + 0.01 + 0.49 + 0) / 5, 1e-15);
  EXPECT_EQ(scores.confusion.hits, 1);
  EXPECT_EQ(scores.confusion.false_alarms, 1);
  EXPECT_EQ(scores.confusion.misses, 1);
  EXPECT_EQ(scores.confusion.correct_rejections, 2);
  EXPECT_EQ(scores.interval.low, wilson(3, 5).low);
  EXPECT_EQ(scores.reliability[0].count, 2);
  EXPECT_EQ(scores.reliability[4].count, 2);
  EXPECT_EQ(scores.reliability[4].yes, 1);
  EXPECT_NEAR(scores.reliability[4].mean, 0.85, 1e-15);
}

TEST(Validate, a_probability_of_one_belongs_to_the_last_bin_and_a_half_says_no) {
  const Scores scores = scored({{1.0, true}, {0.5, true}});
  EXPECT_EQ(scores.reliability.back().count, 1);
  EXPECT_EQ(scores.right, 1);
}

// 1 and 2 stood, 3 fell, 4 stood, 5 and 6 fell: between 2 and 3 as well as between 4 and 5 one is wrong.
TEST(Validate, the_best_threshold_lies_half_way_between_neighbours) {
  const std::vector<double> values{1, 2, 3, 4, 5, 6};
  const std::vector<bool> fell{false, false, true, false, true, true}, all(6, true);
  EXPECT_EQ(best_threshold(values, fell, all), 2.5);
  EXPECT_EQ(best_threshold(values, fell, {true, true, false, true, true, true}), 4.5);
  EXPECT_EQ(best_threshold({3, 3, 1}, {true, true, false}, {true, true, true}), 2);
  EXPECT_GT(best_threshold(values, std::vector<bool>(6, false), all), 6);
}

class GraniteFolder : public ::testing::Test {
 protected:
  // Three rows of outcomes.csv (ZhangChen/virtual_shake_robot_pybullet, GPL-3.0); motions are made up.
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "topple-granite-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    write("outcomes.csv", k_head + k_rows);
    write("test-011.csv", motion(56));
    pack("test-013.csv.gz", motion(96));
    write("test-015.csv", motion(92.1));
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string motion(double peak) {
    std::string text = "time_s,ax_gal\n";
    for (int n = 0; n < 20; ++n)
      text += std::to_string(n * 0.01) + "," + std::to_string(n == 7 ? -peak : 0.5 * n) + "\n";
    return text;
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void pack(const std::string& name, const std::string& text) const {
    const gzFile file = gzopen((folder_ / name).c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
  }
  std::string bytes(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// One line that begins with `begin` behind the folder and holds `part`; the others are read nevertheless.
  void expect_refused(const std::string& begin, const std::string& part, std::size_t left = 0) const {
    try {
      read_granite(folder_, false);
      ADD_FAILURE() << "read: " << part;
    } catch (const io::InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_TRUE(what.starts_with(begin.empty() ? folder_.string() : (folder_ / begin).string())) << what;
      EXPECT_NE(what.find(part), std::string::npos) << what;
    }
    if (left == 0) return;
    const GraniteData data = read_granite(folder_, true);
    EXPECT_EQ(data.tests.size(), left);
    EXPECT_EQ(data.skipped.size(), 1u);
  }

  const std::string k_head =
      "test,sheet_pga_g,sheet_pgv_m_s,sp1_overturned,sp2_overturned,samples,dt_s,peak_gal\n";
  const std::string k_rows =
      "11,0.0565,0.0090,0,0,3812,0.010000,56.0\n13,0.0994,0.0279,0,0,3000,0.010000,96.0\n"
      "15,0.0960,0.0460,0,0,4099,0.010000,92.1\n";
  fs::path folder_;
};

TEST_F(GraniteFolder, is_read_plain_and_packed) {
  const GraniteData data = read_granite(folder_, false);
  ASSERT_EQ(data.tests.size(), 3u);
  EXPECT_EQ(data.tests[1].number, 13);
  EXPECT_EQ(data.tests[1].peak_velocity, 0.0279);
  EXPECT_FALSE(data.tests[1].fell[0]);
  EXPECT_NEAR(data.tests[1].motion->peak, 0.96, 1e-12);
  EXPECT_NEAR(data.tests[1].motion->interval, 0.01, 1e-12);
}

TEST_F(GraniteFolder, a_file_that_is_cut_off_is_named) {
  const std::string whole = bytes("test-013.csv.gz");
  write("test-013.csv.gz", whole.substr(0, whole.size() - 12));
  expect_refused("test-013.csv.gz: ", "cut off", 2);
}

TEST_F(GraniteFolder, a_missing_outcome_a_missing_file_and_a_missing_field_are_named) {
  write("test-017.csv", motion(5));
  expect_refused("test-017.csv: ", "no outcome", 3);
  fs::remove(folder_ / "test-017.csv");
  fs::remove(folder_ / "test-011.csv");
  expect_refused("outcomes.csv:2: ", "no test-011", 2);
  write("test-011.csv", motion(56));
  write("outcomes.csv", k_head + k_rows + "17,0.0992,0.0626,,0,5000,0.010000,95.1\n");
  expect_refused("outcomes.csv:5: sp1_overturned: ", "is missing");
}

TEST_F(GraniteFolder, a_test_that_is_there_twice_is_named) {
  write("outcomes.csv", k_head + k_rows + "13,0.0994,0.0279,0,1,3000,0.010000,96.0\n");
  expect_refused("outcomes.csv:5: test: ", "in line 3 already");
  write("outcomes.csv", k_head + k_rows);
  write("test-013.csv", motion(96));
  expect_refused("test-013.csv.gz: ", "twice");
}

TEST_F(GraniteFolder, times_that_run_backwards_or_leap_are_named) {
  std::string text = motion(56);
  text.replace(text.find("0.050000,"), 9, "0.030000,");
  write("test-011.csv", text);
  expect_refused("test-011.csv:7: time_s: ", "does not come after", 2);
  text.replace(text.find("0.030000,2.5"), 8, "0.055000");
  write("test-011.csv", text);
  expect_refused("test-011.csv:7: time_s: ", "equal steps", 2);
}

TEST_F(GraniteFolder, other_units_are_named) {
  std::string text = motion(56);
  text.replace(text.find("ax_gal"), 6, "ax_g");
  write("test-011.csv", text);
  expect_refused("test-011.csv:1: ", "no column ax_gal", 2);
  write("test-011.csv", motion(0.56));
  expect_refused("test-011.csv: ax_gal: ", "outcomes.csv says 56 gal", 2);
}

TEST_F(GraniteFolder, what_is_no_number_is_named) {
  for (const char* bad : {"nan", "inf", "1e999", "twelve", ""}) {
    std::string text = motion(56);
    text.replace(text.find("0.050000,2.500000"), 17, std::string("0.050000,") + bad);
    write("test-011.csv", text);
    expect_refused("test-011.csv:7: ax_gal: ", *bad ? "no finite number" : "is missing", 2);
  }
}

TEST_F(GraniteFolder, an_empty_folder_and_none_are_named) {
  fs::create_directory(folder_ / "empty");
  EXPECT_THROW(read_granite(folder_ / "empty", true), io::InputError);
  EXPECT_THROW(read_granite(folder_ / "none", true), io::InputError);
  fs::remove(folder_ / "outcomes.csv");
  expect_refused("", "has no outcomes.csv");
}

}  // namespace
}  // namespace topple::study
