// topple study elements as a program: files, table, and what may go wrong with them.
#include <algorithm>
#include <sstream>

#include "program.h"

namespace topple::app {
namespace {

class StudyTest : public ProgramTest {};

const std::vector<std::string> k_call{"study",   "elements", "-o", "new/out",
                                      "--quick", "--jobs",   "2",  "--quiet"};

TEST_F(StudyTest, numbers_stand_without_gnuplot_and_charts_come_with_it) {
  expect_one_line(k_call, 1,
                  "new/out/elements.svg: gnuplot: No such file or directory; charts need the Debian package "
                  "gnuplot-nox; new/out/elements.csv and new/out/elements.json are written",
                  {.set = {{"PATH", "/none"}}});
  EXPECT_EQ(files(),
            (std::vector<std::string>{"new", "new/out", "new/out/elements.csv", "new/out/elements.json"}));
  const std::string csv = bytes_of("new/out/elements.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 181);

  const Ended ended = topple(k_call);
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(files().size(), 6u);
  EXPECT_TRUE(bytes_of("new/out/elements.png").starts_with("\x89PNG"));
  EXPECT_NE(bytes_of("new/out/elements.svg").find("topple " TOPPLE_VERSION), std::string::npos);

  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  for (const char* part :
       {"cantilever", "asi-gauss", "CPU time, ms", "new/out/elements.csv", "--quick left "})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part;

  const nlohmann::ordered_json json = json_of(bytes_of("new/out/elements.json"));
  EXPECT_EQ(json["topple"], TOPPLE_VERSION);
  EXPECT_EQ(json["of"], 108);
  EXPECT_EQ(json["rows"].size(), 180u);
  EXPECT_EQ(json["cases"].size(), 10u);
  EXPECT_EQ(json["settings"]["jobs"], 2);
  EXPECT_GE(json["machine"]["cores"], 1);
  for (const auto& row : json["rows"]) EXPECT_EQ(row.size(), 11u);
  for (const auto& found : json["cases"]) EXPECT_NE(found["source"], "");
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

TEST_F(StudyTest, a_table_that_may_not_grow_leaves_the_older_one) {
  std::filesystem::create_directory("out");
  write_bytes("out/elements.csv", "older");
  expect_one_line({"study", "elements", "-o", "out", "--quick", "--jobs", "2", "--quiet"}, 1,
                  "out/elements.csv: cannot be written: File too large", {.most_bytes = 2000});
  EXPECT_EQ(bytes_of("out/elements.csv"), "older");
  EXPECT_EQ(files(), (std::vector<std::string>{"out", "out/elements.csv"}));
}

TEST_F(StudyTest, its_scenes_are_run_by_name_but_not_listed) {
  EXPECT_EQ(topple({"run", "elements/beam-collapse", "--quiet"}).code, 0);
  EXPECT_EQ(topple({"modes", "elements/cabinet-frame", "--set", "run.elements=midpoint"}).code, 0);
  EXPECT_EQ(topple({"scenes"}).out.find("elements/"), std::string::npos);
}

}  // namespace
}  // namespace topple::app
