// Who may know whom: reads the #include lines of the source tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace topple::test {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // path in the tree, "solver/beam.cpp"
  std::string target;  // as written
  bool quoted;         // "..." and not <...>
};

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

std::string room_of(const std::string& path) {
  for (const char* room : {"solver/io/", "solver/study/", "solver/", "render/", "app/"})
    if (starts_with(path, room)) return std::string(room, std::string(room).size() - 1);
  return "";
}

// Empty when the arrow is allowed, else what is wrong with it.
std::string objection(const Include& include) {
  // clocks, threads, files, printing and the environment: what mechanics must not touch
  static constexpr std::array k_outside = {
      "thread",  "chrono",   "fstream",  "iostream", "filesystem",
      "mutex",   "future",   "ctime",    "time.h",   "random",
      "cstdlib", "stdlib.h", "unistd.h", "atomic",   "condition_variable",
      "ostream", "istream",  "stdio.h"};
  const std::string from = room_of(include.file), to = room_of(include.target);
  const std::string arrow = include.file + " includes " + include.target + ": ";
  if (to == "app" && from != "app") return arrow + "only app knows app";
  const bool gl = include.target.find("GL/") != std::string::npos ||
                  include.target.find("GLFW") != std::string::npos || include.target == "render/gl/gl.h";
  if (gl && from != "render") return arrow + "OpenGL stays in render";
  if (from == "render" && starts_with(to, "solver")) return arrow + "render draws plain arrays";
  if (starts_with(from, "solver") && to == "render") return arrow + "the solver is not drawn by itself";
  if (from == "solver" && (to == "solver/io" || to == "solver/study"))
    return arrow + "mechanics knows neither files nor studies";
  if (from == "solver/io" && to == "solver/study") return arrow + "files know no studies";
  if (from == "solver") {
    if (include.quoted && to != "solver") return arrow + "mechanics includes solver/ alone";
    if (!include.quoted) {
      const bool standard =
          include.target.find('/') == std::string::npos && include.target.find(".h") == std::string::npos;
      if (!standard && !starts_with(include.target, "Eigen/"))
        return arrow + "mechanics needs Eigen and the standard library alone";
      if (std::find(k_outside.begin(), k_outside.end(), include.target) != k_outside.end())
        return arrow + "mechanics has no clock, thread, file or environment";
    }
  }
  return "";
}

std::vector<Include> includes_of(const std::string& file, std::istream& text) {
  static const std::regex k_include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  std::string line;
  while (std::getline(text, line)) {
    std::smatch match;
    if (std::regex_search(line, match, k_include)) found.push_back({file, match[2], match[1] == "\""});
  }
  return found;
}

std::vector<Include> includes_of_tree() {
  std::vector<Include> all;
  const fs::path root = TOPPLE_SOURCE_DIR;
  for (const char* room : {"solver", "render", "app"}) {
    if (!fs::exists(root / room)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / room)) {
      const std::string extension = entry.path().extension().string();
      if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp" && extension != ".in"))
        continue;
      std::ifstream text(entry.path());
      const std::vector<Include> found = includes_of(fs::relative(entry.path(), root).generic_string(), text);
      all.insert(all.end(), found.begin(), found.end());
    }
  }
  return all;
}

TEST(Layout, no_arrow_points_the_wrong_way) {
  const std::vector<Include> all = includes_of_tree();
  // the tree was found: the solver alone has more
  ASSERT_GT(all.size(), 100u);
  for (const Include& include : all) EXPECT_EQ(objection(include), "");
}

TEST(Layout, reader_finds_includes_however_they_are_written) {
  std::istringstream text(
      "#include \"solver/beam.h\"\n  #  include <vector>  // why\n// #include "
      "<thread>\n#include<Eigen/Core>\n");
  const std::vector<Include> found = includes_of("solver/x.cpp", text);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].target, "solver/beam.h");
  EXPECT_TRUE(found[0].quoted);
  EXPECT_EQ(found[1].target, "vector");
  EXPECT_FALSE(found[1].quoted);
  EXPECT_EQ(found[2].target, "Eigen/Core");
}

TEST(Layout, wrong_arrows_are_found) {
  const Include wrong[] = {{"solver/step.cpp", "solver/io/scene/scene.h", true},
                           {"solver/step.cpp", "solver/study/map.h", true},
                           {"solver/step.cpp", "render/scene/camera.h", true},
                           {"solver/step.cpp", "app/main.h", true},
                           {"solver/step.cpp", "thread", false},
                           {"solver/step.cpp", "chrono", false},
                           {"solver/step.cpp", "fstream", false},
                           {"solver/step.cpp", "iostream", false},
                           {"solver/step.cpp", "filesystem", false},
                           {"solver/step.cpp", "cstdlib", false},
                           {"solver/step.cpp", "hdf5.h", false},
                           {"solver/step.cpp", "toml++/toml.hpp", false},
                           {"solver/io/scene/scene.cpp", "solver/study/map.h", true},
                           {"solver/io/scene/scene.cpp", "app/main.h", true},
                           {"solver/io/scene/scene.cpp", "GL/gl.h", false},
                           {"solver/study/map.cpp", "render/output/image.h", true},
                           {"solver/study/map.cpp", "app/support/files.h", true},
                           {"render/scene/camera.cpp", "solver/types.h", true},
                           {"render/scene/camera.cpp", "solver/io/scene/scene.h", true},
                           {"render/scene/camera.cpp", "app/main.h", true},
                           {"app/main.cpp", "GLFW/glfw3.h", false}};
  for (const Include& include : wrong)
    EXPECT_NE(objection(include), "") << include.file << " " << include.target;
}

TEST(Layout, right_arrows_are_not_objected_to) {
  const Include right[] = {{"solver/step.cpp", "solver/model.h", true},
                           {"solver/step.cpp", "Eigen/LU", false},
                           {"solver/step.cpp", "vector", false},
                           {"solver/io/scene/scene.cpp", "solver/run.h", true},
                           {"solver/io/scene/scene.cpp", "fstream", false},
                           {"solver/io/scene/scene.cpp", "hdf5.h", false},
                           {"solver/study/map.cpp", "solver/io/scene/scene.h", true},
                           {"solver/study/map.cpp", "solver/modes.h", true},
                           {"solver/study/map.cpp", "thread", false},
                           {"app/main.cpp", "solver/study/map.h", true},
                           {"render/gl/gl.cpp", "GL/gl.h", false},
                           {"app/main.cpp", "render/scene/camera.h", true},
                           {"app/main.cpp", "solver/run.h", true}};
  for (const Include& include : right) EXPECT_EQ(objection(include), "");
}

}  // namespace
}  // namespace topple::test
