// topple validate as a program: files, what is fitted used again, bad files, no data.
#include <cmath>
#include <filesystem>

#include "unit/app/program.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

class ValidateTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directory("data");
    std::string outcomes =
        "test,sheet_pga_g,sheet_pgv_m_s,sp1_overturned,sp2_overturned,samples,dt_s,peak_gal\n";
    for (int n = 0; n < 24; ++n) {  // made up: bursts of 2 Hz, the stronger half fell
      const double peak = 20 + 10 * n;
      char name[32], row[128];
      std::snprintf(name, sizeof name, "data/test-%03d.csv", 2 * n + 1);
      std::string motion = "time_s,ax_gal\n";
      for (int i = 0; i <= 100; ++i) {
        std::snprintf(row, sizeof row, "%.4f,%.4f\n", i * 0.01,
                      i == 25 ? peak : peak * std::sin(0.04 * M_PI * i));
        motion += row;
      }
      write_bytes(name, motion);
      std::snprintf(row, sizeof row, "%d,%.4f,%.4f,%d,%d,101,0.01,%.1f\n", 2 * n + 1, peak / 981, peak / 1256,
                    n > 12, n > 14, peak);
      outcomes += row;
    }
    write_bytes("data/outcomes.csv", outcomes);
  }
  static std::vector<std::string> call(const std::string& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"validate", "granite", "data", "-o", folder, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(ValidateTest, what_is_fitted_predicts_other_tests_and_nothing_is_fitted_again) {
  const Ended fitted = topple(call("fitted"));
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  for (const char* end :
       {"granite.csv", "granite.json", "granite.svg", "granite.png", "granite.html", "fit.json"})
    EXPECT_TRUE(fs::exists(fs::path("fitted") / end)) << end;
  EXPECT_FALSE(fs::exists("fitted/granite.rows") || fs::exists("fitted/granite-fit.rows"));
  const ordered_json json = ordered_json::parse(bytes_of("fitted/granite.json"));
  EXPECT_EQ(json["kind"], "granite");
  EXPECT_EQ(json["tests"], 24);
  EXPECT_EQ(json["fitted_here"], true);
  EXPECT_EQ(json["rocks"][1]["name"], "SP2");
  for (const char* key : {"right", "interval", "brier", "baselines", "confusion"})
    EXPECT_TRUE(json["rocks"][0].contains(key)) << key;
  EXPECT_NE(bytes_of("fitted/granite.html").find("<svg"), std::string::npos);

  const Ended again = topple(call("again", {"--fit", "fitted/fit.json", "--jobs", "2"}));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_FALSE(fs::exists("again/fit.json"));
  const ordered_json predicted = ordered_json::parse(bytes_of("again/granite.json"));
  EXPECT_EQ(predicted["fitted_here"], false);
  EXPECT_EQ(predicted["fitted_on"], 24);
  // 256 rocks drawn from what was fitted stand for it: one test of 24 may lie so near to 1/2 that it differs.
  EXPECT_NEAR(predicted["rocks"][0]["right"].get<double>(),
              json["rocks"][0]["in_sample"]["right"].get<double>(), 1.01 / 24);
  EXPECT_EQ(json["rocks"][0]["halves"].size(), 12u);
  EXPECT_TRUE(predicted["rocks"][0]["halves"].empty());

  // A leak would change what is predicted of a test by its own outcome.
  std::string outcomes = bytes_of("data/outcomes.csv");
  outcomes.replace(outcomes.find(",0,0,101"), 8, ",1,1,101");
  write_bytes("data/outcomes.csv", outcomes);
  ASSERT_EQ(topple(call("changed", {"--fit", "fitted/fit.json", "--jobs", "1"})).code, 0);
  const auto probabilities = [](const std::string& folder) {
    std::vector<std::string> out;
    const std::string text = bytes_of(folder + "/granite.csv");
    for (std::size_t at = text.find('\n') + 1; at < text.size(); at = text.find('\n', at) + 1) {
      std::size_t field = at;
      for (int comma = 0; comma < 4; ++comma) field = text.find(',', field) + 1;
      out.push_back(text.substr(field, text.find(',', field) - field));
    }
    return out;
  };
  EXPECT_EQ(probabilities("again"), probabilities("changed"));
}

TEST_F(ValidateTest, bad_files_are_refused_or_left_out_by_name) {
  write_bytes("data/test-099.csv", "time_s,ax_gal\n0,1\n0.01,2\n");
  expect_one_line(call("out"), 2, "data/test-099.csv: test 99 has no outcome");
  const Ended ended = topple(call("out", {"--keep-going"}));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("left out: data/test-099.csv"), std::string::npos) << ended.err;
  EXPECT_EQ(ordered_json::parse(bytes_of("out/granite.json"))["skipped"].size(), 1u);
}

TEST_F(ValidateTest, bad_calls_are_refused_in_one_line) {
  fs::create_directory("empty");
  write_bytes("no-fit.json", "{}");
  expect_one_line({"validate", "granite", "-o", "out"}, 2,
                  "github.com/ZhangChen/virtual_shake_robot_pybullet");
  expect_one_line({"validate", "tosses", "-o", "out"}, 2, "github.com/DAIRLab/contact-nets");
  expect_one_line({"validate", "granite", "empty", "-o", "out"}, 2, "empty: is an empty folder");
  expect_one_line({"validate", "tosses", "empty", "-o", "out"}, 2, "empty: is an empty folder");
  expect_one_line({"validate", "furniture", "empty", "-o", "out"}, 2, "empty: is an empty folder");
  expect_one_line({"validate", "granite", "nowhere", "-o", "out"}, 2, "nowhere: cannot be read as a folder");
  expect_one_line({"validate", "stones", "data", "-o", "out"}, 2,
                  "\"stones\" is not validated; known: granite, tosses, furniture");
  expect_one_line({"validate", "furniture", "--fit", "no-fit.json", "-o", "out"}, 2,
                  "--fit: not of validate furniture");
  expect_one_line(call("out", {"--fit", "no-fit.json"}), 2, "no-fit.json: is no file of a fit");
  expect_one_line({"validate", "granite", "data"}, 2, "--output is required");
}

TEST_F(ValidateTest, furniture_of_ones_own_is_compared) {
  fs::create_directory("own");
  write_bytes("own/furniture.csv", "name,a0_gal,ar50_gal,height_m\nshelf,174,205,1.8\n");
  const Ended ended = topple({"validate", "furniture", "own", "-o", "out", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const ordered_json json = ordered_json::parse(bytes_of("out/furniture.json"));
  ASSERT_EQ(json["pieces"].size(), 1u);
  EXPECT_EQ(json["pieces"][0]["name"], "shelf");
  EXPECT_NEAR(json["pieces"][0]["formula_gal"].get<double>(), 204.9, 0.1);
}

}  // namespace
}  // namespace topple::app
