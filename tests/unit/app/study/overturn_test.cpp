// topple study overturn as a program: files, workers, interruption.
#include <chrono>
#include <sstream>
#include <thread>

#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/study_rows.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

class OverturnTest : public ProgramTest {
 protected:
  /// A map of a rigid block under half-sines, 40 ms a run.
  static std::vector<std::string> call(const std::string& folder,
                                       const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"study",
                                   "overturn",
                                   "verify/rocking-defaults-half-sine-4-above",
                                   "-o",
                                   folder,
                                   "--x",
                                   "shake.1.duration=0.2 s..0.6 s:4",
                                   "--y",
                                   "shake.1.amplitude=3..9:3",
                                   "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static std::string rows(const std::string& folder) { return rows_of(folder + "/overturn.csv"); }
};

TEST_F(OverturnTest, an_ensemble_gives_probabilities_charts_and_a_fragility) {
  const Ended ended = topple(call("new/out", {"--ensemble", "4", "--spread", "20%", "--jobs", "2"}));
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(files(),
            (std::vector<std::string>{"new", "new/out", "new/out/overturn.csv", "new/out/overturn.json",
                                      "new/out/overturn.png", "new/out/overturn.svg"}));
  EXPECT_TRUE(bytes_of("new/out/overturn.png").starts_with("\x89PNG"));
  EXPECT_NE(bytes_of("new/out/overturn.svg").find("topple " TOPPLE_VERSION), std::string::npos);
  EXPECT_EQ(lines_in("new/out/overturn.csv"), 13);
  for (const char* part : {"48 of 48 runs", "fragility at shake.1.duration = "})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
  const ordered_json json = json_of(bytes_of("new/out/overturn.json"));
  EXPECT_EQ(json["run"], 48);
  EXPECT_EQ(json["x"]["key"], "shake.1.duration");
  EXPECT_EQ(json["x"]["unit"], "s");
  EXPECT_EQ(json["y"]["unit"], "gal");
  EXPECT_EQ(json["y"]["values"], (std::vector<double>{300, 600, 900}));
  EXPECT_EQ(json["settings"]["ensemble"], 4);
  EXPECT_EQ(json["bodies"][0]["name"], "block");
  EXPECT_EQ(json["criteria"]["curves"].size(), 3u);
  EXPECT_EQ(json["fragility"]["fits"].size(), 4u);
  for (const auto& fit : json["fragility"]["fits"]) {
    EXPECT_EQ(fit.contains("median"), fit["pga"].contains("median"));
    EXPECT_TRUE(fit.contains("pgv"));
    if (!fit.contains("median")) continue;
    EXPECT_NEAR(fit["pga"]["median"].get<double>() / fit["median"].get<double>(), 1, 1e-3);
    EXPECT_LT(fit["pga"]["median_low"], fit["pga"]["median"]);
    EXPECT_GT(fit["pgv"]["beta_high"], fit["pgv"]["beta"]);
  }
  for (const char* array :
       {"verdict", "runs", "overturned", "probability", "probability_low", "overturn_time_s"}) {
    ASSERT_EQ(json[array].size(), 3u) << array;
    for (const auto& row : json[array]) EXPECT_EQ(row.size(), 4u) << array;
  }
  EXPECT_EQ(json["probability"][0][0], 0);
  EXPECT_EQ(json["probability"][2][3], 1);
  EXPECT_EQ(json["rows"].size(), 12u);
}

// A block that lies across the room leaves 0.45 m beside it; one that stands leaves 1.75 m.
TEST_F(OverturnTest, says_after_how_many_runs_a_way_out_is_open) {
  write_bytes("room.toml",
              "topple = 1\n[run]\nduration = 2.5\n[floor]\n"
              "[[shake]]\ntype = \"pulse\"\nshape = \"half-sine\"\nduration = 0.4\namplitude = 1\n"
              "direction = [0, -1, 0]\n"
              "[[wall]]\nname = \"right\"\nat = [0, -1]\nnormal = [0, 1, 0]\n"
              "[[wall]]\nname = \"left\"\nat = [0, 1]\nnormal = [0, -1, 0]\n"
              "[[wall]]\nname = \"front\"\nat = [2, 0]\nnormal = [-1, 0, 0]\n"
              "[[block]]\nname = \"a\"\nsize = [0.5, 0.18, 1.28]\nmass = 30\nwidth = 0.02\nat = [0, -0.85]\n"
              "[[door]]\nname = \"door\"\nwall = \"front\"\nat = 0\nwidth = 0.8\n"
              "[[place]]\nname = \"desk\"\nat = [-1, 0]\n");
  const Ended ended =
      topple({"study", "overturn", "room.toml", "-o", "out", "--x", "shake.1.duration=0.4 s..0.45 s:2", "--y",
              "shake.1.amplitude=1..8:2", "--ensemble", "2", "--spread", "5%", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const ordered_json json = json_of(bytes_of("out/overturn.json"));
  EXPECT_EQ(json["overturned"], ordered_json::parse("[[0, 0], [2, 2]]"));
  EXPECT_EQ(json["ways"][0]["place"], "desk");
  EXPECT_EQ(json["ways"][0]["open"], ordered_json::parse("[[2, 2], [0, 0]]"));
  EXPECT_EQ(json["rows"][0]["open_desk"], 2);
  EXPECT_EQ(json["rows"][0]["open_desk_high"], 1);
  EXPECT_NEAR(json["rows"][0]["open_desk_low"].get<double>(), 2 / (2 + 1.96 * 1.96), 1e-3);  // Wilson's score
  EXPECT_EQ(json["rows"][3]["open_desk"], 0);
}

TEST_F(OverturnTest, quick_says_when_it_left_nothing_out) {
  const Ended ended = topple(call("out", {"--quick", "--jobs", "2"}));
  EXPECT_EQ(ended.code, 0);
  for (const char* part : {"12 of 12 runs", "--quick left nothing out"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
}

TEST_F(OverturnTest, rows_are_the_same_on_one_thread_on_two_and_on_two_ranks) {
  ASSERT_EQ(topple(call("one", {"--jobs", "1"})).code, 0);
  ASSERT_EQ(topple(call("two", {"--jobs", "2"})).code, 0);
  EXPECT_EQ(rows("one"), rows("two"));
  if (!run_on_two_ranks(call("ranks", {"--jobs", "1"}))) return;
  EXPECT_EQ(rows("one"), rows("ranks"));
  EXPECT_EQ(json_of(bytes_of("ranks/overturn.json"))["settings"]["ranks"], 2);
}

TEST_F(OverturnTest, parts_in_lanes_are_the_same_on_two_threads_and_on_two_ranks) {
  const auto parts = [](const std::string& folder, const std::string& jobs) {
    return std::vector<std::string>{"study",
                                    "overturn",
                                    "cabinet",
                                    "-o",
                                    folder,
                                    "--x",
                                    "shake.1.frequency=0.4..0.6:2",
                                    "--y",
                                    "shake.1.amplitude=150 gal..300 gal:2",
                                    "--ensemble",
                                    "70",
                                    "--jobs",
                                    jobs,
                                    "--quiet"};
  };
  const Ended one = topple(parts("one", "1"));
  ASSERT_EQ(one.code, 0) << one.err;
  for (const char* part : {"280 runs as planar blocks", "8 of 8 parts of up to 64 runs"})
    EXPECT_NE(one.out.find(part), std::string::npos) << part << "\n" << one.out;
  ASSERT_EQ(topple(parts("two", "2")).code, 0);
  EXPECT_EQ(rows("one"), rows("two"));
  if (!run_on_two_ranks(parts("ranks", "1"))) return;
  EXPECT_EQ(rows("one"), rows("ranks"));
}

TEST_F(OverturnTest, under_an_mpirun_that_it_cannot_join_it_does_not_run_as_if_alone) {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    expect_one_line(call("out"), 2, "mpirun: this build of topple ", {.set = {{size, "2"}}});
    expect_one_line({"study", "elements", "-o", "out"}, 2,
                    "mpirun: study elements does not share its work among ranks", {.set = {{size, "2"}}});
  }
  EXPECT_FALSE(std::filesystem::exists("out"));
}

TEST_F(OverturnTest, an_interrupted_sweep_keeps_its_rows_and_resumes_to_the_same_file) {
  ASSERT_EQ(topple(call("whole", {"--jobs", "2"})).code, 0);
  for (const int signal : {SIGINT, SIGKILL}) {
    std::filesystem::remove_all("out");
    const int out = memory(), err = memory();
    const pid_t child = start(call("out", {"--jobs", "1"}), out, err);
    for (int i = 0; i < 3000 && lines_in("out/overturn.rows") < 4; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    kill(child, signal);
    EXPECT_EQ(wait_for(child), signal == SIGINT ? 130 : 1000 + SIGKILL);
    const int kept = lines_in("out/overturn.rows") - 1;
    EXPECT_GE(kept, 3);
    EXPECT_LT(kept, 12);
    if (signal == SIGINT) {
      EXPECT_EQ(content(err), "topple: interrupted; " + std::to_string(kept) +
                                  " of 12 runs are kept in out/overturn.rows, --resume goes on from there\n");
    }
    EXPECT_EQ(files().size(), 2u + 5u);  // no results yet; those of "whole"
    const std::string before = bytes_of("out/overturn.rows");
    expect_one_line(call("out", {"--resume", "--ensemble", "2"}), 2,
                    "--resume: out/overturn.rows was begun with other settings (ensemble: 1, now 2)");
    EXPECT_EQ(bytes_of("out/overturn.rows"), before);
    const Ended resumed = topple(call("out", {"--resume", "--jobs", "2"}));
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find("12 of 12 runs (" + std::to_string(kept) + " from before)"), std::string::npos)
        << resumed.out;
    EXPECT_EQ(rows("out"), rows("whole"));
    EXPECT_FALSE(std::filesystem::exists("out/overturn.rows"));
    close(out);
    close(err);
  }
}

TEST_F(OverturnTest, a_run_that_diverges_is_a_row_and_the_sweep_goes_on) {
  write_bytes("beam.toml", k_beam);
  const Ended ended = topple({"study", "overturn", "beam.toml", "-o", "out", "--set",
                              "run.integrator=central-difference", "--x", "run.time_step=0.01 ms..1 ms:2",
                              "--y", "section.post.thickness=1 mm..2 mm:2", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const ordered_json table = json_of(bytes_of("out/overturn.json"))["rows"];
  ASSERT_EQ(table.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const bool fine = k % 2 == 0;  // the first step of the two
    EXPECT_EQ(table[k]["verdict"].get<std::string>(), fine ? "stands" : "failed");
    EXPECT_EQ(table[k]["failed"], fine ? 0 : 1);
    EXPECT_EQ(table[k]["status"] == "completed", fine) << table[k]["status"];
  }
  EXPECT_NE(bytes_of("out/overturn.svg").find("No criteria are drawn"), std::string::npos);
}

TEST_F(OverturnTest, a_full_disk_is_told_and_what_was_kept_can_be_resumed) {
  const Ended ended = topple(call("out", {"--jobs", "1"}), {.most_bytes = 2700});
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("out/overturn.rows: cannot be written: "), std::string::npos) << ended.err;
  EXPECT_EQ(topple(call("out", {"--resume"})).code, 0);
}

}  // namespace
}  // namespace topple::app
