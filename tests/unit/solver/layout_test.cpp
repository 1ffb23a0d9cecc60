// Who may know whom, and how much lies in one place: reads the #include lines of the source tree and counts
// its files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace topple::test {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // path in the tree, "solver/element/beam.cpp"
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

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

// The rooms of a part of the program, each with those of the same part that it may include beside itself.
using Rooms = std::map<std::string, std::set<std::string>>;
const std::map<std::string, Rooms> k_parts = {
    {"solver",
     {{"solver/math", {}},
      {"solver/model", {"math"}},
      {"solver/planar", {"contact", "model", "math"}},
      {"solver/element", {"model", "math"}},
      {"solver/contact", {"model", "math"}},
      {"solver/state", {"planar", "contact", "element", "model", "math"}},
      {"solver/frame", {"state", "contact", "element", "model", "math"}},
      {"solver/reduced", {"frame", "state", "contact", "element", "model", "math"}},
      {"solver/body", {"reduced", "frame", "state", "planar", "contact", "element", "model", "math"}},
      {"solver/step", {"body", "reduced", "frame", "state", "contact", "element", "model", "math"}},
      {"solver/run", {"step", "body", "reduced", "frame", "state", "contact", "element", "model", "math"}}}},
    {"solver/io",
     {{"solver/io/host", {}},
      {"solver/io/common", {"host"}},
      {"solver/io/accelerogram", {"common"}},
      {"solver/io/document", {"common"}},
      {"solver/io/builtin", {"document", "common"}},
      {"solver/io/scene", {"builtin", "accelerogram", "document", "common"}},
      {"solver/io/check", {"scene", "document", "common"}},
      {"solver/io/edit", {"scene", "document", "common"}},
      {"solver/io/recording", {"edit", "scene", "document", "common", "host"}},
      {"solver/io/export", {"recording", "edit", "scene", "document", "common", "host"}}}},
    {"solver/study",
     {{"solver/study/common", {}},
      {"solver/study/elements", {"common"}},
      {"solver/study/penalty", {"common"}},
      {"solver/study/precision", {"common"}},
      {"solver/study/stability", {"common"}},
      {"solver/study/overturn", {"common"}},
      {"solver/study/validate", {"overturn", "common"}}}},
    {"render",
     {{"render/gl", {}},  //
      {"render/scene", {"gl"}},
      {"render/output", {"scene", "gl"}}}},
    {"app",
     {{"app/support", {}},
      {"app/picture", {"support"}},
      {"app/batch", {"support"}},
      {"app/gltf", {"picture", "support"}},
      {"app/report", {"support"}},
      {"app/page", {"report", "batch", "picture", "support"}},
      {"app/page/web", {"page", "picture", "support"}},
      {"app/live", {"batch", "picture", "support"}},
      {"app/study", {"batch", "support"}},
      {"app/validate", {"report", "study", "support"}},
      {"app/chart", {"live", "picture", "support"}},
      {"app/panels", {"chart", "live", "study", "picture", "support"}},
      {"app/furnish", {"panels", "chart", "picture", "support"}},
      {"app/window", {"furnish", "panels", "chart", "live", "study", "picture", "support"}},
      {"app/cli",
       {"window", "validate", "panels", "report", "live", "study", "batch", "gltf", "page", "picture",
        "support"}},
      {"app/python", {"page", "panels", "batch", "picture", "support"}},
      {"app", {"cli"}}}},  // main.cpp
};

constexpr int k_most_files = 40;  // in a folder

// "app" of "app/live/player.h"; "" of what belongs to no part of the table.
std::string part_of(const std::string& path) {
  std::string longest;
  for (const auto& [part, rooms] : k_parts)
    if (starts_with(path, part + "/") && part.size() > longest.size()) longest = part;
  return longest;
}

// Empty when the arrow stays within a room, leaves the part or is in the table, else what is wrong with it.
std::string objection_within_part(const Include& include) {
  const std::string part = part_of(include.file);
  if (part.empty()) return "";
  const Rooms& rooms = k_parts.at(part);
  const auto from = rooms.find(folder_of(include.file));
  if (from == rooms.end()) return include.file + " lies in no room of " + part;
  const std::string to = folder_of(include.target);
  if (!include.quoted || part_of(include.target) != part || to == from->first) return "";
  if (rooms.contains(to) && from->second.contains(to.substr(to.rfind('/') + 1))) return "";
  return include.file + " includes " + include.target + ": " + from->first + " does not know " + to;
}

// A header and a source of one name are one module, generated or not.
std::string module_of(const std::string& path) {
  return path.substr(0, path.find('.'));
}

// The modules of the parts that include one another in a circle, or lie on a way from one circle to another.
std::set<std::string> modules_in_circles(const std::vector<Include>& all) {
  std::map<std::string, std::set<std::string>> includes;
  for (const Include& include : all) {
    const std::string from = module_of(include.file), to = module_of(include.target);
    if (!include.quoted || part_of(include.file).empty() || part_of(include.target).empty() || from == to)
      continue;
    includes[from].insert(to);
    includes[to];
  }
  // Those that include nothing, then those that nobody includes, go until no more do.
  for (std::size_t before = 0; before != includes.size();) {
    before = includes.size();
    std::set<std::string> included;
    for (auto& [module, targets] : includes) {
      std::erase_if(targets, [&](const std::string& target) { return !includes.contains(target); });
      included.insert(targets.begin(), targets.end());
    }
    std::erase_if(includes,
                  [&](const auto& one) { return one.second.empty() || !included.contains(one.first); });
  }
  std::set<std::string> left;
  for (const auto& [module, targets] : includes) left.insert(module);
  return left;
}

// Folders with more files than they should hold.
std::vector<std::string> overfull(const std::vector<std::string>& files) {
  std::map<std::string, int> count;
  for (const std::string& file : files) ++count[folder_of(file)];
  std::vector<std::string> found;
  for (const auto& [folder, number] : count)
    if (number > k_most_files) found.push_back(folder + " holds " + std::to_string(number) + " files");
  return found;
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
      const bool intrinsics = include.file == "solver/math/pack.h" && include.target == "immintrin.h";
      if (!standard && !intrinsics && !starts_with(include.target, "Eigen/"))
        return arrow + "mechanics needs Eigen and the standard library alone";
      if (std::find(k_outside.begin(), k_outside.end(), include.target) != k_outside.end())
        return arrow + "mechanics has no clock, thread, file or environment";
    }
  }
  return objection_within_part(include);
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

std::vector<std::string> files_of_tree(std::initializer_list<const char*> folders) {
  std::vector<std::string> files;
  const fs::path root = TOPPLE_SOURCE_DIR;
  for (const char* folder : folders)
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), root).generic_string());
  return files;
}

std::vector<Include> includes_of_tree() {
  std::vector<Include> all;
  for (const std::string& file : files_of_tree({"solver", "render", "app"})) {
    const std::string extension = fs::path(file).extension().string();
    if (extension != ".h" && extension != ".cpp" && extension != ".in") continue;
    std::ifstream text(fs::path(TOPPLE_SOURCE_DIR) / file);
    const std::vector<Include> found = includes_of(file, text);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

TEST(Layout, no_arrow_points_the_wrong_way) {
  const std::vector<Include> all = includes_of_tree();
  // the tree was found: the solver alone has more
  ASSERT_GT(all.size(), 100u);
  for (const Include& include : all) EXPECT_EQ(objection(include), "");
}

TEST(Layout, no_modules_include_one_another_in_a_circle) {
  EXPECT_EQ(modules_in_circles(includes_of_tree()), std::set<std::string>{});
}

TEST(Layout, no_folder_holds_more_than_forty_files) {
  const std::vector<std::string> files = files_of_tree({"solver", "render", "app", "shaders", "tests"});
  ASSERT_GT(files.size(), 100u);
  EXPECT_EQ(overfull(files), std::vector<std::string>{});
}

TEST(Layout, reader_finds_includes_however_they_are_written) {
  std::istringstream text(
      "#include \"solver/element/beam.h\"\n  #  include <vector>  // why\n// #include "
      "<thread>\n#include<Eigen/Core>\n");
  const std::vector<Include> found = includes_of("solver/element/x.cpp", text);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].target, "solver/element/beam.h");
  EXPECT_TRUE(found[0].quoted);
  EXPECT_EQ(found[1].target, "vector");
  EXPECT_FALSE(found[1].quoted);
  EXPECT_EQ(found[2].target, "Eigen/Core");
}

TEST(Layout, wrong_arrows_are_found) {
  const Include wrong[] = {{"solver/step/step.cpp", "solver/io/scene/scene.h", true},
                           {"solver/step/step.cpp", "solver/study/map.h", true},
                           {"solver/step/step.cpp", "render/scene/camera.h", true},
                           {"solver/step/step.cpp", "app/main.h", true},
                           {"solver/step/step.cpp", "thread", false},
                           {"solver/step/step.cpp", "immintrin.h", false},
                           {"solver/step/step.cpp", "chrono", false},
                           {"solver/step/step.cpp", "fstream", false},
                           {"solver/step/step.cpp", "iostream", false},
                           {"solver/step/step.cpp", "filesystem", false},
                           {"solver/step/step.cpp", "cstdlib", false},
                           {"solver/step/step.cpp", "hdf5.h", false},
                           {"solver/step/step.cpp", "toml++/toml.hpp", false},
                           {"solver/io/scene/scene.cpp", "solver/study/map.h", true},
                           {"solver/io/scene/scene.cpp", "app/main.h", true},
                           {"solver/io/scene/scene.cpp", "GL/gl.h", false},
                           {"solver/study/common/map.cpp", "render/output/image.h", true},
                           {"solver/study/common/map.cpp", "app/support/files.h", true},
                           {"render/scene/camera.cpp", "solver/math/types.h", true},
                           {"render/scene/camera.cpp", "solver/io/scene/scene.h", true},
                           {"render/scene/camera.cpp", "app/main.h", true},
                           {"app/main.cpp", "GLFW/glfw3.h", false},
                           {"app/main.cpp", "app/live/player.h", true},
                           {"app/live/player.cpp", "app/cli/manual.h", true},
                           {"app/picture/row.cpp", "app/live/player.h", true},
                           {"app/python/module.cpp", "app/cli/command.h", true},
                           {"app/batch/summary.cpp", "app/python/rows.h", true},
                           {"app/report/report.cpp", "app/batch/summary.h", true},
                           {"app/live/player.cpp", "app/somewhere.h", true},
                           {"app/somewhere/x.cpp", "vector", false},
                           {"render/gl/gl.cpp", "render/scene/camera.h", true},
                           {"render/scene/camera.cpp", "render/output/image.h", true},
                           {"solver/step/step.cpp", "solver/run/run.h", true},
                           {"solver/element/beam.cpp", "solver/contact/contact_law.h", true},
                           {"solver/frame/hinges.cpp", "solver/body/model_level.h", true},
                           {"solver/beam.cpp", "vector", false},
                           {"solver/io/common/units.cpp", "solver/io/scene/scene.h", true},
                           {"solver/io/scene/scene.cpp", "solver/io/recording/recording.h", true},
                           {"solver/io/recording/recover.cpp", "solver/io/export/export_csv.h", true},
                           {"solver/study/common/axis.cpp", "solver/study/overturn/criteria.h", true},
                           {"solver/study/precision/precision.cpp", "solver/study/penalty/impact.h", true}};
  for (const Include& include : wrong)
    EXPECT_NE(objection(include), "") << include.file << " " << include.target;
}

TEST(Layout, right_arrows_are_not_objected_to) {
  const Include right[] = {{"solver/step/step.cpp", "solver/model/model.h", true},
                           {"solver/step/step.cpp", "solver/body/model_level.h", true},
                           {"solver/step/step.cpp", "Eigen/LU", false},
                           {"solver/math/pack.h", "immintrin.h", false},
                           {"solver/step/step.cpp", "vector", false},
                           {"solver/io/scene/scene.cpp", "solver/run/run.h", true},
                           {"solver/io/scene/scene.cpp", "fstream", false},
                           {"solver/io/scene/scene.cpp", "hdf5.h", false},
                           {"solver/study/common/map.cpp", "solver/io/scene/scene.h", true},
                           {"solver/study/common/map.cpp", "solver/frame/modes.h", true},
                           {"solver/study/common/map.cpp", "thread", false},
                           {"app/main.cpp", "solver/study/map.h", true},
                           {"render/gl/gl.cpp", "GL/gl.h", false},
                           {"app/main.cpp", "render/scene/camera.h", true},
                           {"app/main.cpp", "solver/run/run.h", true}};
  for (const Include& include : right) EXPECT_EQ(objection(include), "");
}

TEST(Layout, circles_of_modules_are_found) {
  const std::vector<Include> straight = {{"app/live/a.cpp", "app/live/a.h", true},
                                         {"app/live/a.h", "app/live/b.h", true},
                                         {"app/live/b.cpp", "app/support/c.h", true},
                                         {"app/live/a.cpp", "app/support/c.h", true},
                                         {"app/support/c.cpp", "solver/step/step.h", true}};
  EXPECT_EQ(modules_in_circles(straight), std::set<std::string>{});
  // a header that a source leads back to
  std::vector<Include> round = straight;
  round.push_back({"app/support/c.cpp", "app/live/a.h", true});
  round.push_back({"app/live/above.cpp", "app/live/a.h", true});
  round.push_back({"app/support/c.cpp", "app/support/below.h", true});
  EXPECT_EQ(modules_in_circles(round), (std::set<std::string>{"app/live/a", "app/live/b", "app/support/c"}));
  const std::vector<Include> generated = {{"app/live/x.cpp.in", "app/live/y.h", true},
                                          {"app/live/y.cpp", "app/live/x.h", true}};
  EXPECT_EQ(modules_in_circles(generated), (std::set<std::string>{"app/live/x", "app/live/y"}));
}

TEST(Layout, overfull_folders_are_found) {
  std::vector<std::string> files;
  for (int k = 0; k < k_most_files; ++k) {
    files.push_back("app/live/" + std::to_string(k) + ".h");
    files.push_back("app/live/within/" + std::to_string(k) + ".h");
  }
  EXPECT_EQ(overfull(files), std::vector<std::string>{});
  files.push_back("app/live/within/CMakeLists.txt");
  EXPECT_EQ(overfull(files), std::vector<std::string>{"app/live/within holds 41 files"});
}

}  // namespace
}  // namespace topple::test
