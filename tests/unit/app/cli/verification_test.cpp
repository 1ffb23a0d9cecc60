// topple verify: theory and published numbers by the public road, and expectations that do not hold.
#include <set>
#include <sstream>

#include "unit/app/program.h"

namespace topple::app {
namespace {

// A bar that falls for 0.1 s: 0.04903325 m.
constexpr const char* k_fall = R"(topple = 1
title = "A bar falls"
[run]
duration = "0.1 s"
time_step = "1 ms"
settle = false
[[material]]
name = "steel"
young = "205 GPa"
poisson = 0.3
density = 7850
[[section]]
name = "bar"
shape = "solid"
size = ["10 mm", "10 mm"]
[[frame]]
name = "bar"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "bar", material = "steel" }]
[[probe]]
name = "bar"
body = "bar"
)";

std::string expectation(const std::string& rest) {
  return "[[expect]]\nname = \"fall\"\n" + rest + "source = \"g t^2/2\"\nreason = \"exact\"\n";
}

const std::string k_pointer = "value = \"/probes/0/final/displacement_m/2\"\n";
const std::string k_right = k_pointer + "reference = -0.04903325\ntolerance = 1e-9\n";
const std::string k_wrong = k_pointer + "reference = -0.05\ntolerance = 1e-9\n";

class VerificationTest : public ProgramTest {
 protected:
  static nlohmann::ordered_json rows_of(const Ended& ended) { return json_of(ended.out)["rows"]; }
};

TEST_F(VerificationTest, every_case_of_theory_and_print_is_met) {
  const Ended ended = topple({"verify", "--json", "-", "--quiet"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  const nlohmann::ordered_json rows = rows_of(ended);
  EXPECT_GE(rows.size(), 312u);
  std::set<std::string> groups;
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row["verdict"], "pass");
    EXPECT_LE(row["error"].get<double>(), row["tolerance"].get<double>());
    for (const char* key : {"source", "reason"}) EXPECT_GT(row[key].get<std::string>().size(), 3u);
    EXPECT_EQ(row["reason"].get<std::string>().find("TBD"), std::string::npos);
    const std::string scene = row["scene"];
    groups.insert(scene.substr(0, scene.find('-')));
  }
  for (const char* group :
       {"beams", "strength", "dynamics", "rocking", "sliding", "restitution", "stability"})
    EXPECT_TRUE(groups.contains(group)) << group;
}

TEST_F(VerificationTest, table_fits_into_100_columns_and_names_source_and_reason) {
  const Ended ended = topple({"verify", "--filter", "restitution", "--quiet"});
  EXPECT_EQ(ended.code, 0);
  for (const char* part : {"computed", "reference", "tolerance", "pass", "from ", "owed: ", "all within"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part;
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_EQ(ended.out.find("beams"), std::string::npos);
}

TEST_F(VerificationTest, cases_are_scenes_that_are_run_by_name_but_not_listed) {
  EXPECT_EQ(topple({"run", "verify/dynamics-free-fall", "--quiet"}).code, 0);
  EXPECT_EQ(topple({"scenes"}).out.find("verify"), std::string::npos);
}

TEST_F(VerificationTest, a_wrong_reference_is_missed) {
  write_bytes("fall.toml", k_fall + expectation(k_wrong));
  const Ended ended = topple({"verify", "fall.toml", "--json", "-"});
  EXPECT_EQ(ended.code, 1);
  const nlohmann::ordered_json row = rows_of(ended).at(0);
  EXPECT_EQ(row["verdict"], "miss");
  EXPECT_EQ(row["name"], "fall");
  EXPECT_NEAR(row["computed"].get<double>(), -0.04903325, 1e-12);
  EXPECT_NEAR(row["error"].get<double>(), 0.019335, 1e-6);
  EXPECT_NE(topple({"verify", "fall.toml", "--quiet"}).out.find("1 rows, 1 missed"), std::string::npos);
  EXPECT_EQ(topple({"run", "fall.toml", "--quiet"}).code, 0);
  write_bytes("fall.toml", k_fall + expectation(k_right));
  EXPECT_EQ(topple({"verify", "fall.toml"}).code, 0);
}

TEST_F(VerificationTest, a_run_that_breaks_off_is_missed_and_told) {
  std::string text = k_fall + expectation(
                                  "value = \"/bodies/0/impacts\"\nreference = 0\nscale = 1\n"
                                  "tolerance = 0\n");
  const std::string fixed = "settle = false";
  text.replace(text.find(fixed), fixed.size(), "settle = true");
  write_bytes("fall.toml", text);
  const Ended ended = topple({"verify", "fall.toml", "--json", "-", "--quiet"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_EQ(rows_of(ended).at(0)["verdict"], "miss");
  EXPECT_TRUE(rows_of(ended).at(0).contains("trouble"));
}

TEST_F(VerificationTest, expectations_that_make_no_sense_are_told_with_their_place) {
  const auto refused = [](const std::string& rest, const std::string& part) {
    write_bytes("fall.toml", k_fall + expectation(rest));
    expect_one_line({"verify", "fall.toml", "--quiet"}, 2, part);
  };
  const std::string numbers = "reference = 1\ntolerance = 0.1\n";
  refused("value = \"/nothing/3\"\n" + numbers,
          "fall.toml:25:9: expect.fall.value: the summary of this scene has no /nothing/3");
  refused("value = \"/status\"\n" + numbers,
          "fall.toml:25:9: expect.fall.value: /status of the summary is not");
  refused("value = \"status\"\n" + numbers, "fall.toml:25:9: expect.fall.value: \"status\" is not a JSON");
  refused("value = \"/a~2\"\n" + numbers,
          "fall.toml:25:9: expect.fall.value: \"/a~2\" is not a JSON pointer");
  refused(k_pointer + "reference = 0\ntolerance = 0.1\n", "expect.fall.scale: missing; nothing is relative");
  refused(k_pointer + "reference = 1\ntolerance = -1\n",
          "fall.toml:27:13: expect.fall.tolerance: -1 is outside");
  refused(k_pointer + "reference = \"1 m\"\ntolerance = 1\n", "fall.toml:26:13: expect.fall.reference: ");
  refused(k_pointer + "tolerance = 1\n", "expect.fall.reference: missing");
  write_bytes("fall.toml", k_fall + expectation(k_right) + expectation(k_right));
  expect_one_line({"run", "fall.toml", "--quiet"}, 2, "expect.fall.name: \"fall\" is used twice");
  write_bytes("fall.toml", k_fall);
  expect_one_line({"verify", "fall.toml"}, 2, "fall.toml: has no [[expect]]");
  expect_one_line({"verify", "--filter", "no such case"}, 2, "--filter: no case has \"no such case\"");
}

}  // namespace
}  // namespace topple::app
