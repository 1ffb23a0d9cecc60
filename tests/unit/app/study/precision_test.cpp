// topple study precision as a program: files, workers, interruption, cases that fail.
#include <chrono>
#include <sstream>
#include <thread>

#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/study_rows.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

class PrecisionTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_bytes("beam.toml", k_beam);
  }
  /// A clamped beam: no contact, so that there is one law, and frames alone.
  static std::vector<std::string> call(const std::string& folder,
                                       const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"study", "precision", "beam.toml", "-o", folder, "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static std::string rows(const std::string& folder) { return rows_of(folder + "/precision.csv"); }
};

TEST_F(PrecisionTest, gives_numbers_charts_a_reference_and_the_cheapest_settings) {
  const Ended ended = topple(call("new/out"));
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"beam.toml", "new", "new/out", "new/out/precision.csv",
                                               "new/out/precision.json", "new/out/precision.png",
                                               "new/out/precision.svg"}));
  EXPECT_TRUE(bytes_of("new/out/precision.png").starts_with("\x89PNG"));
  const std::string chart = bytes_of("new/out/precision.svg");
  for (const char* part :
       {"topple " TOPPLE_VERSION, "Error against cost of beam", "CPU time per simulated second, ms",
        "frame, central differences", "none within what is compared"})
    EXPECT_NE(chart.find(part), std::string::npos) << part;
  for (const char* part :
       {"reference: frame central-difference, ", "order of convergence ", "cheapest", "scene's own, 1 ms: "})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;

  const ordered_json json = json_of(bytes_of("new/out/precision.json"));
  EXPECT_EQ(json["topple"], TOPPLE_VERSION);
  EXPECT_EQ(json["scene"], "beam");
  EXPECT_EQ(json["run"], json["of"]);
  EXPECT_EQ(json["rows"].size(), json["of"].get<std::size_t>());
  EXPECT_EQ(lines_in("new/out/precision.csv"), 1 + json["of"].get<int>());
  EXPECT_EQ(json["references"].size(), 1u);
  EXPECT_GT(json["references"][0]["window_s"], 0.05);
  EXPECT_EQ(json["cheapest"][0]["within"].size(), 3u);
  EXPECT_TRUE(json["cheapest"][0]["within"][0]["overturn time"].is_null());
  int too_long = 0;
  for (const auto& row : json["rows"]) {
    EXPECT_EQ(row["model"], row["method"] == "scene's own" ? "scene" : "frame");  // it is held
    if (row["status"] == "completed") {
      EXPECT_GT(row["cpu_s_per_s"], 0);
      EXPECT_FALSE(row["tilt_error"].is_null());
      continue;
    }
    EXPECT_NE(row["status"].get<std::string>().find("the time integration is stable up to"),
              std::string::npos);
    EXPECT_TRUE(row["tilt_error"].is_null());
    ++too_long;
  }
  EXPECT_EQ(too_long, 1);
}

TEST_F(PrecisionTest, rows_are_the_same_on_one_thread_on_two_and_on_two_ranks) {
  ASSERT_EQ(topple(call("one", {"--jobs", "1"})).code, 0);
  ASSERT_EQ(topple(call("two", {"--jobs", "2"})).code, 0);
  EXPECT_EQ(rows("one"), rows("two"));
  if (!run_on_two_ranks(call("ranks", {"--jobs", "1"}))) return;
  EXPECT_EQ(rows("one"), rows("ranks"));
  EXPECT_EQ(json_of(bytes_of("ranks/precision.json"))["settings"]["ranks"], 2);
}

TEST_F(PrecisionTest, an_interrupted_study_resumes_to_the_same_rows) {
  ASSERT_EQ(topple(call("whole", {"--jobs", "2"})).code, 0);
  const int out = memory(), err = memory();
  const pid_t child = start(call("out"), out, err);
  for (int i = 0; i < 6000 && lines_in("out/precision.rows") < 4; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  const int kept = lines_in("out/precision.rows") - 1, of = lines_in("whole/precision.csv") - 1;
  EXPECT_GE(kept, 3);
  EXPECT_LT(kept, of);
  EXPECT_EQ(content(err), "topple: interrupted; " + std::to_string(kept) + " of " + std::to_string(of) +
                              " runs are kept in out/precision.rows, --resume goes on from there\n");
  expect_one_line(call("out", {"--resume", "--set", "run.duration=0.2"}), 2,
                  "--resume: out/precision.rows was begun with other settings");
  const Ended resumed = topple(call("out", {"--resume", "--jobs", "2"}));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find(std::to_string(of) + " of " + std::to_string(of) + " runs (" +
                             std::to_string(kept) + " from before)"),
            std::string::npos)
      << resumed.out;
  EXPECT_EQ(rows("out"), rows("whole"));
  EXPECT_FALSE(std::filesystem::exists("out/precision.rows"));
  close(out);
  close(err);
}

TEST_F(PrecisionTest, quick_says_what_it_covered) {
  const Ended ended = topple(call("out", {"--quick"}));
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.out.find(": --quick left nothing out"), std::string::npos) << ended.out;
  EXPECT_EQ(json_of(bytes_of("out/precision.json"))["settings"]["quick"], true);
}

TEST_F(PrecisionTest, scenes_that_have_no_steps_are_refused) {
  expect_one_line({"study", "precision", "portal-pushover", "-o", "out"}, 2,
                  "study precision: portal-pushover is not dynamic; it has no time steps");
  EXPECT_EQ(files(), std::vector<std::string>{"beam.toml"});
}

}  // namespace
}  // namespace topple::app
