// topple study as a program: files, table, and what may go wrong with them.
#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include "app/study/study_results.h"
#include "app/study/sweep.h"
#include "unit/app/program.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

class StudyTest : public ProgramTest {};

const std::vector<std::string> k_call{"study",   "elements", "-o", "new/out",
                                      "--quick", "--jobs",   "2",  "--quiet"};

TEST_F(StudyTest, elements_gives_numbers_and_charts) {
  const Ended ended = topple(k_call);
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(files().size(), 6u);
  const std::string csv = bytes_of("new/out/elements.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 199);
  EXPECT_TRUE(bytes_of("new/out/elements.png").starts_with("\x89PNG"));
  EXPECT_NE(bytes_of("new/out/elements.svg").find("topple " TOPPLE_VERSION), std::string::npos);

  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  for (const char* part :
       {"cantilever", "asi-gauss", "CPU time, ms", "new/out/elements.csv", "--quick left "})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part;

  const nlohmann::ordered_json json = json_of(bytes_of("new/out/elements.json"));
  EXPECT_EQ(json["topple"], TOPPLE_VERSION);
  EXPECT_EQ(json["of"], 126);
  EXPECT_EQ(json["rows"].size(), 198u);
  EXPECT_EQ(json["cases"].size(), 11u);
  EXPECT_EQ(json["settings"]["jobs"], 2);
  EXPECT_GE(json["machine"]["cores"], 1);
  for (const auto& row : json["rows"]) EXPECT_EQ(row.size(), 11u);
  for (const auto& found : json["cases"]) EXPECT_NE(found["source"], "");
}

TEST_F(StudyTest, quick_gives_up_runs_that_are_under_way_when_its_time_is_over) {
  const auto endless = [](int, const std::function<bool()>& give_up) {
    while (!give_up()) std::this_thread::yield();
    return std::string();
  };
  Crew crew(2);
  const SweepPlan plan{.label = "test",
                       .stem = "test",
                       .settings = {{"of", "a test"}},
                       .order = {0, 1, 2},
                       .broadcast = {},
                       .make = [&] { return endless; },
                       .start = Clock::now() - std::chrono::duration_cast<Clock::duration>(Seconds(k_quick))};
  StudyOptions options;
  options.quick = options.quiet = true;
  const std::optional<SweepEnd> end = sweep(crew, plan, options);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->run, 0);
  EXPECT_NE(end->left_in_words(true, "the last").find("--quick left out 3, the last first"),
            std::string::npos);
}

TEST_F(StudyTest, places_that_cannot_be_written_to_are_refused_before_anything_runs) {
  const auto refused = [](const std::string& folder, const std::string& part) {
    expect_one_line({"study", "elements", "-o", folder}, 2, part);
  };
  refused("/proc/out", "/proc/out: cannot be created: ");
  write_bytes("file", "kept");
  refused("file", "file: cannot be created: ");
  refused("file/out", "file/out: cannot be created: ");
  EXPECT_EQ(bytes_of("file"), "kept");
  std::filesystem::create_directories("out/elements.json");
  refused("out", "out/elements.json: cannot be written: is a folder");
  EXPECT_EQ(files(), (std::vector<std::string>{"file", "out", "out/elements.json"}));
}

TEST_F(StudyTest, its_scenes_are_run_by_name_but_not_listed) {
  EXPECT_EQ(topple({"run", "elements/beam-collapse", "--quiet"}).code, 0);
  EXPECT_EQ(topple({"modes", "elements/cabinet-frame", "--set", "run.elements=midpoint"}).code, 0);
  EXPECT_EQ(topple({"scenes"}).out.find("elements/"), std::string::npos);
}

/// A cabinet that slides before it tips, so that no long run is needed.
const std::string k_slippery = R"(topple = 1
title = "A cabinet on ice"
[contact]
alpha = "50 kgf"
friction = 0.1
[floor]
width = "90 mm"
)" + k_library + k_cabinet;

TEST_F(StudyTest, penalty_gives_numbers_charts_and_its_advice) {
  write_bytes("ice.toml", k_slippery);
  const std::vector<std::string> call{"study",   "penalty", "ice.toml", "-o",
                                      "new/out", "--jobs",  "2",        "--quiet"};
  expect_one_line(call, 1, "charts need the Debian package gnuplot-nox; new/out/penalty.csv and",
                  {.set = {{"PATH", "/none"}}});
  EXPECT_EQ(files(), (std::vector<std::string>{"ice.toml", "new", "new/out", "new/out/penalty.csv",
                                               "new/out/penalty.json"}));
  const Ended ended = topple(call);
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(bytes_of("new/out/penalty.png").starts_with("\x89PNG"));
  EXPECT_NE(bytes_of("new/out/penalty.svg").find("topple " TOPPLE_VERSION), std::string::npos);
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  for (const char* part : {"alpha, kgf", "creep in 10 s", "over the bound", "restitution at",
                           "recommended alpha: 500 kgf", "slides before it tips",
                           "The scene's alpha, 50 kgf, "
                           "cannot give the right verdict within 2 %: depth at rest 8.9 % of L."})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part;

  const nlohmann::ordered_json json = json_of(bytes_of("new/out/penalty.json"));
  EXPECT_EQ(json["topple"], TOPPLE_VERSION);
  EXPECT_EQ(json["scene"], "ice");
  EXPECT_EQ(json["run"], json["of"]);
  EXPECT_EQ(json["settings"]["contact"]["law"], "coulomb");
  EXPECT_NEAR(json["recommendation"]["alpha_N"].get<double>(), 4903.325, 1e-6);
  EXPECT_EQ(json["recommendation"]["scene"]["keeps_bounds"], false);
  EXPECT_EQ(json["cases"].size(), 8u);
  EXPECT_EQ(json["bodies"][0]["contacts"], 9);
  for (const auto& row : json["rows"]) EXPECT_EQ(row.size(), 13u);
}

TEST_F(StudyTest, a_table_that_may_not_grow_leaves_the_older_one) {
  std::filesystem::create_directory("out");
  write_bytes("ice.toml", k_slippery);
  write_bytes("out/penalty.csv", "older,table\n");
  expect_one_line({"study", "penalty", "ice.toml", "-o", "out", "--jobs", "2", "--quiet"}, 1,
                  "out/penalty.csv: cannot be written: File too large", {.most_bytes = 500});
  EXPECT_EQ(bytes_of("out/penalty.csv"), "older,table\n");
  EXPECT_EQ(files(), (std::vector<std::string>{"ice.toml", "out", "out/penalty.csv"}));
}

TEST_F(StudyTest, penalty_refuses_scenes_in_which_nothing_stands_on_a_floor) {
  const auto refused = [](const std::string& scene, const std::string& part) {
    expect_one_line({"study", "penalty", scene, "-o", "out"}, 2, part);
  };
  refused("none.toml", "none.toml");
  refused("tumble", "study penalty: tumble has no floor that is a horizontal plane");
  refused("portal-pushover", "study penalty: portal-pushover is not dynamic");
  refused("verify/restitution-printed", "has no gravity that points down");
  EXPECT_EQ(files(), std::vector<std::string>{});
}

}  // namespace
}  // namespace topple::app
