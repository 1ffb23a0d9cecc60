// The pages in assets/ are about the program as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

const fs::path k_source = TOPPLE_SOURCE_DIR;

std::string page(const std::string& name) {
  std::ifstream in(k_source / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), regex), none; i != none; ++i) found.insert((*i)[1]);
  return found;
}

TEST(Documents, the_table_of_accuracy_has_the_figures_of_verify) {
  std::set<std::string> expected;
  for (const io::BuiltinScene& scene : io::verification_scenes()) {
    const io::Scene loaded = io::load_scene(std::string(scene.name));
    for (const io::Expectation& e : loaded.expectations) expected.insert(loaded.name + " | " + e.name);
  }
  const std::string theory = page("assets/theory.md");
  const std::string table = theory.substr(theory.find("<!-- accuracy -->"));
  EXPECT_EQ(matches(table, R"(\n\| ([^|\n]+ \| [^|\n]+) \| [-+.0-9e]+ \|)"), expected)
      << "write it anew with assets/accuracy PROGRAM";
}

TEST(Documents, files_that_they_name_exist) {
  for (const char* name : {"assets/theory.md", "assets/developers.md"}) {
    const std::string text = page(name);
    ASSERT_FALSE(text.empty());
    for (const std::string& file : matches(text, R"([^/\w]((?:solver|render|app|assets|tests)/[\w/.-]*\w))"))
      EXPECT_TRUE(fs::exists(k_source / file)) << name << " names " << file;
    for (const std::string& link : matches(text, R"(\]\(([\w/.-]+)\))"))
      EXPECT_TRUE(fs::exists(k_source / "assets" / link)) << name << " links to " << link;
  }
}

TEST(Documents, identifiers_that_developers_are_sent_to_exist) {
  std::string sources;
  for (const char* room : {"solver", "app"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_source / room))
      if (entry.is_regular_file()) sources += page(fs::relative(entry.path(), k_source).string());
  for (const std::string& function : matches(page("assets/developers.md"), R"(`([a-z_]+)\(\)`)"))
    EXPECT_NE(sources.find(function + "("), std::string::npos) << function;
}

}  // namespace
}  // namespace topple::app
