// Rows that outlive a sweep.
#include "solver/study/common/kept_rows.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "solver/io/scene/scene.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

const ordered_json k_settings{{"ensemble", 64}, {"scene text", std::string(100, 'a')}};

class KeptRowsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "topple-rows-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    file_ = name + "/x.rows";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string text() const {
    std::ifstream in(file_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void fill(int count) const {
    KeptRows rows(file_, k_settings, 5, false);
    for (int k = 0; k < count; ++k) rows.add(4 - k, R"({"value":)" + std::to_string(k) + "}");
  }
  void expect_refused(const ordered_json& settings, const std::string& part) const {
    const std::string before = text();
    try {
      KeptRows(file_, settings, 5, true);
      ADD_FAILURE() << part;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(text(), before);
  }

  std::string folder_, file_;
};

TEST_F(KeptRowsTest, what_was_added_is_there_when_it_is_resumed) {
  fill(3);
  KeptRows rows(file_, k_settings, 5, true);
  EXPECT_EQ(rows.count(), 3);
  EXPECT_EQ(rows.rows(),
            (std::vector<std::string>{"", "", R"({"value":2})", R"({"value":1})", R"({"value":0})"}));
  rows.add(0, R"({"value":3})");
  EXPECT_EQ(rows.count(), 4);
}

TEST_F(KeptRowsTest, a_line_that_was_cut_off_is_no_row_and_the_next_is_whole) {
  fill(3);
  const std::string whole = text();
  for (std::size_t cut = whole.rfind('\n', whole.size() - 2) + 1; cut < whole.size(); ++cut) {
    std::ofstream(file_) << whole.substr(0, cut);
    {
      KeptRows rows(file_, k_settings, 5, true);
      EXPECT_EQ(rows.count(), 2) << cut;
      rows.add(2, R"({"value":2})");
    }
    EXPECT_EQ(text(), whole);
  }
  std::ofstream(file_) << whole.substr(0, 5);  // of the settings
  EXPECT_EQ(KeptRows(file_, k_settings, 5, true).count(), 0);
}

TEST_F(KeptRowsTest, without_resume_it_begins_anew) {
  fill(3);
  EXPECT_EQ(KeptRows(file_, k_settings, 5, false).count(), 0);
  EXPECT_EQ(text(), k_settings.dump() + "\n");
}

TEST_F(KeptRowsTest, other_settings_and_damage_are_refused_and_left_as_they_are) {
  fill(3);
  ordered_json other = k_settings;
  other["ensemble"] = 16;
  expect_refused(other, "was begun with other settings (ensemble: 64, now 16); without --resume");
  other = k_settings;
  other["scene text"] = "b";
  expect_refused(other, "(scene text has changed)");
  std::ofstream(file_, std::ios::app) << "{\"case\":9,\"row\":{}}\n";
  expect_refused(k_settings, "x.rows:5: is damaged");
  fill(1);
  std::ofstream(file_, std::ios::app) << "no json\n";
  expect_refused(k_settings, "x.rows:3: is damaged");
}

TEST_F(KeptRowsTest, two_sweeps_do_not_write_one_file) {
  const KeptRows rows(file_, k_settings, 5, false);
  expect_refused(k_settings, "is being written by another sweep");
}

}  // namespace
}  // namespace topple::study
