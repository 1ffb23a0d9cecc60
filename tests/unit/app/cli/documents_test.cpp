// README.md and the guide are about the program as it is.
#include <cctype>
#include <regex>
#include <set>
#include <sstream>

#include "solver/io/scene/scene.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

const fs::path k_source = TOPPLE_SOURCE_DIR;
const std::string k_guide = "assets/guide/";

std::string page(const fs::path& name) {
  return bytes_of(k_source / name);
}

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), regex), none; i != none; ++i) found.insert((*i)[1]);
  return found;
}

/// README.md and the pages of the guide, from the top of the sources.
std::vector<std::string> documents() {
  std::vector<std::string> names{"README.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(k_source / k_guide))
    if (entry.path().extension() == ".md") names.push_back(k_guide + entry.path().filename().string());
  return names;
}

/// What a link to a heading of `text` ends with: its words in lower case, joined by "-", without punctuation.
std::set<std::string> fragments(const std::string& text) {
  std::set<std::string> found;
  for (const std::string& heading : matches("\n" + text, R"(\n#+ ([^\n]+))")) {
    std::string fragment;
    for (const unsigned char c : heading)
      if (c == ' ')
        fragment += '-';
      else if (c >= 0x80 || std::isalnum(c) || c == '-' || c == '_')
        fragment += static_cast<char>(std::tolower(c));
    found.insert(fragment);
  }
  return found;
}

/// The first block of code after `heading` that begins with the line `opening`.
std::string block(const std::string& text, const std::string& heading, const std::string& opening) {
  const std::size_t section = text.find("\n## " + heading + "\n");
  const std::size_t start = text.find("\n" + opening + "\n", section);
  if (section == std::string::npos || start == std::string::npos) return {};
  const std::size_t first = start + opening.size() + 2;
  return text.substr(first, text.find("```", first) - first);
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) found.push_back(line);
  return found;
}

TEST(Documents, the_table_of_accuracy_has_the_figures_of_verify) {
  std::set<std::string> expected;
  for (const io::BuiltinScene& scene : io::verification_scenes()) {
    const io::Scene loaded = io::load_scene(std::string(scene.name));
    for (const io::Expectation& e : loaded.expectations) expected.insert(loaded.name + " | " + e.name);
  }
  const std::string theory = page(k_guide + "theory.md");
  const std::string table = theory.substr(theory.find("<!-- accuracy -->"));
  EXPECT_EQ(matches(table, R"(\n\| ([^|\n]+ \| [^|\n]+) \| [-+.0-9e]+ \|)"), expected)
      << "write it anew with assets/accuracy PROGRAM";
}

TEST(Documents, files_that_they_name_exist) {
  for (const std::string& name : documents()) {
    const std::string text = page(name);
    ASSERT_FALSE(text.empty());
    for (const std::string& file :
         matches(text, R"([^/\w]((?:host|solver|render|app|assets|tests)/[\w/.-]*\w))"))
      EXPECT_TRUE(fs::exists(k_source / file)) << name << " names " << file;
  }
}

TEST(Documents, links_lead_somewhere) {
  for (const std::string& name : documents()) {
    for (const std::string& link : matches(page(name), R"(\]\(([^()\s]+)\))")) {
      if (link.find("://") != std::string::npos) continue;
      const std::size_t hash = std::min(link.find('#'), link.size());
      const fs::path file = hash == 0 ? fs::path(name) : fs::path(name).parent_path() / link.substr(0, hash);
      ASSERT_TRUE(fs::exists(k_source / file)) << name << " links to " << link;
      if (hash < link.size()) {
        EXPECT_TRUE(fragments(page(file)).contains(link.substr(hash + 1))) << name << " links to " << link;
      }
    }
  }
}

TEST(Documents, the_readme_is_read_in_one_sitting) {
  std::istringstream readme(page("README.md"));
  EXPECT_LE(std::distance(std::istream_iterator<std::string>(readme), {}), 2000);
  EXPECT_LT(fs::file_size(k_source / "assets/pictures/cabinet.gif"), 1'000'000u);
}

TEST(Documents, every_page_of_the_guide_is_in_the_table_of_the_readme) {
  std::set<std::string> rows;
  for (const std::string& line : lines(page("README.md")))
    if (line.starts_with("| ["))
      for (const std::string& link : matches(line, R"(\]\((assets/guide/[\w-]+\.md)\))")) rows.insert(link);
  for (const std::string& name : documents()) EXPECT_TRUE(name == "README.md" || rows.contains(name)) << name;
}

TEST(Documents, identifiers_that_developers_are_sent_to_exist) {
  std::string sources;
  for (const char* room : {"solver", "app"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_source / room))
      if (entry.is_regular_file()) sources += page(fs::relative(entry.path(), k_source));
  for (const std::string& function : matches(page(k_guide + "developers.md"), R"(`([a-z_]+)\(\)`)"))
    EXPECT_NE(sources.find(function + "("), std::string::npos) << function;
}

class ReadmeTest : public ProgramTest {};

TEST_F(ReadmeTest, the_scene_of_ten_lines_prints_what_it_says) {
  const std::string readme = page("README.md");
  const std::string scene = block(readme, "A scene of ten lines", "```toml");
  EXPECT_EQ(lines(scene).size(), 10u);
  write_bytes("cabinet.toml", scene);
  const Ended ended = topple({"run", "cabinet.toml"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  // All but how long it took.
  const std::regex time(R"( \([^()]* of wall time[^()]*\))");
  EXPECT_EQ(std::regex_replace(ended.out, time, ""),
            std::regex_replace(block(readme, "A scene of ten lines", "```text"), time, ""));
}

}  // namespace
}  // namespace topple::app
