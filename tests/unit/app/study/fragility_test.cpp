// topple study fragility as a program: files, workers, records in a folder, interruption, a full disk.
#include <chrono>
#include <filesystem>
#include <set>
#include <sstream>
#include <thread>

#include "unit/app/program.h"
#include "unit/app/scenes.h"
#include "unit/app/study_rows.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

class FragilityTest : public ProgramTest {
 protected:
  static std::vector<std::string> call(const std::string& folder,
                                       const std::vector<std::string>& options = {}) {
    std::vector<std::string> words{"study",
                                   "fragility",
                                   "cabinet",
                                   "-o",
                                   folder,
                                   "--x",
                                   "pga=150 gal..600 gal:6",
                                   "--quiet",
                                   "--vary",
                                   "amplitude=lognormal:0.2",
                                   "--vary",
                                   "friction=normal:20%"};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }
  static std::string rows(const std::string& folder) { return rows_of(folder + "/fragility.csv"); }
};

TEST_F(FragilityTest, writes_curves_with_intervals_beside_criteria) {
  const Ended ended = topple(call("new/out", {"--ensemble", "200", "--slide", "30 mm"}));
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(files(),
            (std::vector<std::string>{"new", "new/out", "new/out/fragility.csv", "new/out/fragility.json",
                                      "new/out/fragility.png", "new/out/fragility.svg"}));
  EXPECT_EQ(lines_in("new/out/fragility.csv"), 1 + 3 * 6);
  for (const char* part :
       {"sliding over 30 mm", "overturn median ", "1200 of 1200 runs as planar blocks", "West 206"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\n" << ended.out;
  const ordered_json json = json_of(bytes_of("new/out/fragility.json"));
  EXPECT_EQ(json["run"], 1200);
  EXPECT_EQ(json["planar"], 1200);
  EXPECT_EQ(json["settings"]["seed"], 1);
  const ordered_json& overturn = json["bodies"][0]["overturn"];
  EXPECT_LT(overturn["median_95"][0], overturn["median"]);
  EXPECT_GT(overturn["median_95"][1], overturn["median"]);
  EXPECT_TRUE(overturn["median_95_of_records"].is_null());
  EXPECT_NE(bytes_of("new/out/fragility.svg").find("overturning"), std::string::npos);
}

TEST_F(FragilityTest, rows_are_the_same_on_one_thread_on_two_and_on_two_ranks_and_differ_by_seed) {
  ASSERT_EQ(topple(call("one", {"--jobs", "1"})).code, 0);
  ASSERT_EQ(topple(call("two", {"--jobs", "2"})).code, 0);
  ASSERT_EQ(topple(call("other", {"--seed", "2"})).code, 0);
  EXPECT_EQ(rows("one"), rows("two"));
  EXPECT_NE(rows("one"), rows("other"));
  if (!run_on_two_ranks(call("ranks", {"--jobs", "1"}))) return;
  EXPECT_EQ(rows("one"), rows("ranks"));
}

// Every run bounces, so is one of the rigid model: slow enough to be interrupted.
TEST_F(FragilityTest, killed_and_resumed_it_has_no_row_twice) {
  const std::vector<std::string> slow{"--set", "contact.restitution=0.1", "--ensemble", "8", "--jobs", "1"};
  ASSERT_EQ(topple(call("whole", slow)).code, 0);
  EXPECT_EQ(json_of(bytes_of("whole/fragility.json"))["planar"], 0);
  const int out = memory(), err = memory();
  const pid_t child = start(call("out", slow), out, err);
  for (int i = 0; i < 3000 && lines_in("out/fragility.rows") < 4; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGKILL);
  EXPECT_EQ(wait_for(child), 1000 + SIGKILL);
  const std::string kept = bytes_of("out/fragility.rows");
  std::set<int> cases;
  std::istringstream lines(kept);
  std::string line;
  for (int n = 0; std::getline(lines, line); ++n)
    if (n > 0) {
      EXPECT_TRUE(cases.insert(json_of(line)["case"].get<int>()).second) << line;
    }
  EXPECT_LT(cases.size(), 12u);
  expect_one_line(call("out", {"--set", "contact.restitution=0.1", "--ensemble", "16", "--resume"}), 2,
                  "--resume: out/fragility.rows was begun with other settings (runs: 8, now 16)");
  std::vector<std::string> again = slow;
  again.push_back("--resume");
  const Ended resumed = topple(call("out", again));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(
      resumed.out.find("12 of 12 parts of up to 4 runs (" + std::to_string(cases.size()) + " from before)"),
      std::string::npos)
      << resumed.out;
  EXPECT_EQ(rows("out"), rows("whole"));
  close(out);
  close(err);
}

TEST_F(FragilityTest, a_million_runs_on_a_full_disk_say_so_and_can_be_resumed) {
  const Ended ended = topple(call("out", {"--ensemble", "1000000"}), {.most_bytes = 20000});
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.err.find("out/fragility.rows: cannot be written: "), std::string::npos) << ended.err;
  EXPECT_GT(lines_in("out/fragility.rows"), 5);
}

TEST_F(FragilityTest, a_folder_of_records_counts_for_its_files_and_bad_ones_are_named) {
  std::filesystem::create_directories("records");
  for (const char* name : {"a", "b", "c"}) {
    std::string text = "time_s,ax_gal\n";
    for (int i = 0; i < 400; ++i)
      text += std::to_string(0.01 * i) + "," +
              std::to_string(200 * std::sin(0.01 * i * (5 + name[0] - 'a')) * (i < 350)) + "\n";
    write_bytes("records/" + std::string(name) + ".csv", text);
  }
  const Ended ended = topple({"study", "fragility", "cabinet", "-o", "out", "--ensemble", "30", "--vary",
                              "records=records", "--x", "pgv=10 cm/s..200 cm/s:5", "--quiet"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  const ordered_json json = json_of(bytes_of("out/fragility.json"));
  EXPECT_EQ(json["settings"]["records"],
            (std::vector<std::string>{"records/a.csv", "records/b.csv", "records/c.csv"}));
  EXPECT_EQ(json["run"], 150);
  write_bytes("records/d.csv", "time_s,ax_gal\n0,1\n0.01,2\n0.05,3\n");
  const std::vector<std::string> bad{"study", "fragility", "cabinet",        "-o",
                                     "bad",   "--vary",    "records=records"};
  expect_one_line(bad, 2, "--vary records: records/d.csv: ");
  EXPECT_FALSE(std::filesystem::exists("bad"));
}

TEST_F(FragilityTest, what_it_cannot_do_is_told_in_one_line) {
  const auto refused = [](const std::vector<std::string>& options, const std::string& line) {
    std::vector<std::string> words{"study", "fragility", "cabinet", "-o", "out"};
    words.insert(words.end(), options.begin(), options.end());
    expect_one_line(words, 2, line);
  };
  refused({"--slide", "0"}, "--slide: \"0\" is not above 0 m up to 100 m");
  refused({"--slide", "3 kg"}, "--slide: \"3 kg\" is a mass, expected a length");
  refused({"--x", "pgd=1..2:3"},
          "--x \"pgd\": is not a measure of the floor's motion; known: pga, pgv, arias, jma");
  refused({"--y", "pga=1..2:3"}, "--y: not of study fragility");
  refused({"--vary", "weight=normal:5%"}, "--vary weight=normal:5%: \"weight\" is not a factor; known: ");
  refused({"--seed", "x"}, "--seed: \"x\" is not a whole number in 0..2147483647");
  expect_one_line({"study", "overturn", "cabinet", "-o", "out", "--slide", "30 mm"}, 2,
                  "--slide: not of study overturn");
  expect_one_line({"study", "stability", "cabinet", "-o", "out", "--vary", "phase"}, 2,
                  "--vary: not of study stability");
  EXPECT_FALSE(std::filesystem::exists("out"));
}

TEST_F(FragilityTest, bodies_that_a_run_of_the_scene_makes_finer_are_told) {
  write_bytes("s.toml", shelves_of_books(1));
  const auto said = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"study",      "fragility", "s.toml", "--x", "pga=280 gal..300 gal:2lin",
                                   "--ensemble", "2",         "-o",     "out", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = topple(words);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
  };
  const std::string coarser = said({});
  EXPECT_NE(coarser.find("shelf-0: rigid here, at run.accuracy = 0.05; a run of the scene has elastic"),
            std::string::npos)
      << coarser;
  const std::string alike = said({"--set", "run.accuracy=0.01"});
  EXPECT_EQ(alike.find("a run of the scene has"), std::string::npos) << alike;
  // a scene that wants stresses has them in a run, and what they come of
  const std::string text = shelves_of_books(1), motion = "want = [\"motion\"]";
  ASSERT_NE(text.find(motion), std::string::npos);
  write_bytes("s.toml", std::string(text).replace(text.find(motion), motion.size(), ""));
  const std::string wants = said({});
  EXPECT_NE(
      wants.find("shelf-0: rigid here, where motion alone is asked for, at run.accuracy = 0.05; a run of "
                 "the scene has elastic, which may lift earlier, slide where this rocks, spring back from "
                 "what it strikes, and"),
      std::string::npos)
      << wants;
  // where people are, how far pieces slide counts
  write_bytes("s.toml", shelves_of_books(1) + "[[place]]\nat = [3, 3]\n");
  const std::string as_run = said({});
  EXPECT_EQ(as_run.find("a run of the scene has"), std::string::npos) << as_run;
}

}  // namespace
}  // namespace topple::app
