// topple study stability as a program: files, workers, interruption.
#include <chrono>
#include <sstream>
#include <thread>

#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/study_rows.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

/// A cabinet that is shaken for 0.3 s, four ways at four points, and two groups of four reference runs.
class StabilityTest : public ProgramTest {
 protected:
  static constexpr int k_runs = 2 * 4 + 4 * 5;

  static std::vector<std::string> call(const std::string& folder,
                                       const std::vector<std::string>& options = {}) {
    write_bytes("shaken.toml", k_shaken);
    std::vector<std::string> words{"study",
                                   "stability",
                                   "shaken.toml",
                                   "-o",
                                   folder,
                                   "--x",
                                   "run.time_step=0.2 ms..4 ms:2",
                                   "--y",
                                   "contact.alpha=50 kgf..5000 kgf:2",
                                   "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static std::string rows(const std::string& folder) { return rows_of(folder + "/stability.csv"); }
};

TEST_F(StabilityTest, gives_a_map_for_each_method_with_the_limits_of_theory) {
  const Ended ended = topple(call("new/out", {"--jobs", "2", "--quick"}));
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  for (const char* part :
       {"central-difference   4 refused", "28 of 28 runs of 0.3 s", "--quick left nothing out"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
  EXPECT_EQ(lines_in("new/out/stability.csv"), 1 + 4 * 5);
  EXPECT_TRUE(bytes_of("new/out/stability.png").starts_with("\x89PNG"));
  const std::string svg = bytes_of("new/out/stability.svg");
  for (const char* part :
       {"topple " TOPPLE_VERSION, "run.time_step, s", "contact.alpha, kgf", "As the scene has it"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_FALSE(std::filesystem::exists("new/out/stability.rows"));
  const ordered_json json = json_of(bytes_of("new/out/stability.json"));
  EXPECT_EQ(json["run"], k_runs);
  EXPECT_EQ(json["of"], k_runs);
  EXPECT_EQ(json["settings"]["simulated_s"], 0.3);
  EXPECT_EQ(json["settings"]["balance"], 0.01);
  EXPECT_EQ(json["x"]["values"], (std::vector<double>{0.0002, 0.004}));
  EXPECT_EQ(json["references"].size(), 2u);
  EXPECT_EQ(json["rows"].size(), 20u);
  std::vector<std::string> methods, limits;
  for (const auto& method : json["methods"]) methods.push_back(method["name"]);
  for (const auto& limit : json["limits"]) limits.push_back(limit["name"]);
  EXPECT_EQ(methods, (std::vector<std::string>{"central-difference", "newmark", "newmark-5/6",
                                               "generalized-alpha", "scene"}));
  EXPECT_EQ(limits,
            (std::vector<std::string>{"explicit", "impact", "bounce", "tunnelling", "damping", "capacity"}));
  // a failed run is a row that says when and why
  EXPECT_EQ(json["rows"][0]["fate"], "refused");
  EXPECT_EQ(json["rows"][0]["reached_s"], 0);
  EXPECT_NE(json["rows"][0]["status"].get<std::string>().find(
                "the time integration is stable up to a time_step of"),
            std::string::npos);
}

TEST_F(StabilityTest, rows_are_the_same_on_one_thread_on_two_and_on_two_ranks) {
  ASSERT_EQ(topple(call("one", {"--jobs", "1"})).code, 0);
  ASSERT_EQ(topple(call("two", {"--jobs", "2"})).code, 0);
  EXPECT_EQ(rows("one"), rows("two"));
  if (!run_on_two_ranks(call("ranks", {"--jobs", "1"}))) return;
  EXPECT_EQ(rows("one"), rows("ranks"));
  EXPECT_EQ(json_of(bytes_of("ranks/stability.json"))["settings"]["ranks"], 2);
}

TEST_F(StabilityTest, an_interrupted_sweep_resumes_to_the_same_rows) {
  ASSERT_EQ(topple(call("whole", {"--jobs", "2"})).code, 0);
  const int out = memory(), err = memory();
  const pid_t child = start(call("out", {"--jobs", "1"}), out, err);
  for (int i = 0; i < 6000 && lines_in("out/stability.rows") < 4; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGINT);
  EXPECT_EQ(wait_for(child), 130);
  const int kept = lines_in("out/stability.rows") - 1;
  EXPECT_LT(kept, k_runs);
  EXPECT_EQ(content(err), "topple: interrupted; " + std::to_string(kept) + " of " + std::to_string(k_runs) +
                              " runs are kept in out/stability.rows, --resume goes on from there\n");
  expect_one_line(call("out", {"--resume", "--set", "contact.friction=0.5"}), 2,
                  "--resume: out/stability.rows was begun with other settings (scene text");
  const Ended resumed = topple(call("out", {"--resume", "--jobs", "2"}));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find("(" + std::to_string(kept) + " from before)"), std::string::npos) << resumed.out;
  EXPECT_EQ(rows("out"), rows("whole"));
  close(out);
  close(err);
}

TEST_F(StabilityTest, a_point_that_cannot_be_settled_is_a_row_that_says_so) {
  std::vector<std::string> words = call("out");
  words[8] = "contact.alpha=2 kgf..50 kgf:2";
  ASSERT_EQ(topple(words).code, 0);
  const ordered_json row = json_of(bytes_of("out/stability.json"))["rows"][4];
  EXPECT_EQ(row["method"], "newmark");
  EXPECT_EQ(row["fate"], "failed");
  EXPECT_NE(row["status"].get<std::string>().find("does not come to rest under gravity"), std::string::npos);
}

}  // namespace
}  // namespace topple::app
