// The manual page and shell completion hold what --help holds.
#include "app/cli/manual.h"

#include <regex>
#include <set>
#include <sstream>

#include "app/cli/command_line.h"
#include "unit/app/program.h"

namespace topple::app {
namespace {

class ManualTest : public ProgramTest {
 protected:
  static std::set<std::string> matches(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator i(text.begin(), text.end(), regex), none; i != none; ++i) found.insert((*i)[1]);
    return found;
  }
  static std::set<std::string> commands() { return matches(topple({"--help"}).out, "\n  ([a-z]+)  "); }
  static std::set<std::string> options(const std::string& command) {
    return matches(topple({command, "--help"}).out, "\n  [^\n]{0,4}(--[a-z0-9-]+)");
  }
  static std::string page() {
    std::string page;
    read_commands([&page](const CLI::App& table) {
      page = manual_page(table, bytes_of(TOPPLE_SOURCE_DIR "/assets/topple.1.in"));
    });
    return page;
  }
  /// In place of bash-completion: names what it would be asked for.
  static constexpr const char* k_stand_in =
      R"(_init_completion() { words=("${COMP_WORDS[@]}"); cword=$COMP_CWORD; cur=${words[cword]}; prev=${words[cword - 1]}; }
_filedir() { COMPREPLY+=("files${1:+ $1}"); })";
  /// What bash offers for the last word of a call.
  static std::vector<std::string> offers(const std::string& call, const std::string& library = k_stand_in) {
    read_commands([](const CLI::App& table) { write_bytes("completion", bash_completion(table)); });
    write_bytes("complete", library + R"(
. ./completion
COMP_WORDS=()" + call + R"()
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
COMP_LINE=")" + call + R"("
COMP_POINT=${#COMP_LINE}
_topple
printf '%s\n' "${COMPREPLY[@]}" >offers
)");
    EXPECT_EQ(std::system(library == k_stand_in ? "bash -u ./complete" : "bash ./complete"), 0) << call;
    std::istringstream lines(bytes_of("offers"));
    std::vector<std::string> words;
    for (std::string word; std::getline(lines, word);)
      if (!word.empty()) words.push_back(word);
    return words;
  }
};

TEST_F(ManualTest, page_has_every_command_and_option_of_the_help) {
  const std::string text = std::regex_replace(page(), std::regex(R"(\\-)"), "-");
  EXPECT_EQ(text.find('@'), std::string::npos);
  EXPECT_NE(text.find("topple " TOPPLE_VERSION), std::string::npos);
  ASSERT_GE(commands().size(), 13u);
  for (const std::string& command : commands()) {
    const std::size_t begin = text.find("\n.SS topple " + command + "\n");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = text.substr(begin, text.find("\n.S", begin + 1) - begin);
    for (const std::string& option : options(command))
      EXPECT_TRUE(option == "--help" || section.find(option + "\\fR") != std::string::npos)
          << command << option;
  }
}

TEST_F(ManualTest, page_has_every_folder_of_the_user_that_is_looked_at) {
  const std::string text = page(), files = text.substr(text.find("\n.SH FILES\n")),
                    environment = files.substr(files.find("\n.SH ENVIRONMENT\n"));
  std::set<std::string> variables;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TOPPLE_SOURCE_DIR "/app"))
    if (entry.path().extension() == ".cpp")
      variables.merge(matches(bytes_of(entry.path()), R"re("(XDG_[A-Z_]+)")re"));
  EXPECT_GE(variables.size(), 3u);
  for (const std::string& variable : variables)
    EXPECT_NE(environment.find(variable), std::string::npos) << variable;
  for (const char* file : {"~/.config/topple/settings", "~/.local/state/topple/", "~/.cache/topple/"})
    EXPECT_NE(files.find(std::string("\n.I ") + file + "\n"), std::string::npos) << file;
}

TEST_F(ManualTest, bash_offers_commands_options_scenes_and_files) {
  using Words = std::vector<std::string>;
  const Words first = offers("topple ''");
  for (const std::string& command : commands()) {
    EXPECT_EQ(std::count(first.begin(), first.end(), command), 1) << command;
    const Words offered = offers("topple " + command + " --");
    EXPECT_EQ(std::set<std::string>(offered.begin(), offered.end()), options(command)) << command;
  }
  EXPECT_EQ(offers("topple run paper-"), (Words{"paper-a", "paper-b", "files toml"}));
  EXPECT_EQ(offers("topple check paper-a paper-b"), (Words{"paper-b", "files toml"}));
  for (const char* command : {"render", "view", "info", "compare"})
    EXPECT_EQ(offers(std::string("topple ") + command + " paper-a"), (Words{"paper-a", "files @(toml|h5)"}));
  for (const char* command : {"recover", "export"})
    EXPECT_EQ(offers(std::string("topple ") + command + " a"), (Words{"files h5"}));
  EXPECT_EQ(offers("topple render a.h5 --camera s"), (Words{"side"}));
  EXPECT_EQ(offers("topple render a.h5 --camera f"), (Words{"front", "follow"}));
  EXPECT_EQ(offers("topple render a.h5 --range ''"), (Words{"run", "instant"}));
  EXPECT_EQ(offers("topple report paper-a --lang ''"), (Words{"en", "ja"}));
  EXPECT_EQ(offers("topple render a.h5 --png ''"), (Words{"files -d"}));
  EXPECT_EQ(offers("topple render a.h5 --still ''"), (Words{"files png"}));
  EXPECT_EQ(offers("topple run paper-a -o ''"), (Words{"files h5"}));
  EXPECT_EQ(offers("topple run paper-a --json ''"), (Words{"files"}));
  EXPECT_EQ(offers("topple run paper-a --jobs ''"), (Words{}));
}

TEST_F(ManualTest, bash_offers_scenes_after_the_kind_of_a_study) {
  using Words = std::vector<std::string>;
  const Words kinds{"overturn", "fragility", "stability", "precision", "elements", "penalty"};
  EXPECT_EQ(offers("topple study ''"), kinds);
  EXPECT_EQ(offers("topple study -o overturn-study ''"), kinds);
  EXPECT_EQ(offers("topple study sta"), (Words{"stability"}));
  EXPECT_EQ(offers("topple study stability sta"), (Words{"stack", "files toml"}));
  EXPECT_EQ(offers("topple study --quick stability -o out sta"), (Words{"stack", "files toml"}));
  EXPECT_EQ(offers("topple validate ''"), (Words{"granite", "tosses", "furniture"}));
  EXPECT_EQ(offers("topple validate granite ''"), (Words{"files -d"}));
}

TEST_F(ManualTest, bash_offers_folders_and_the_files_that_a_command_reads) {
  const char* const library = "/usr/share/bash-completion/bash_completion";
  if (!std::filesystem::exists(library)) GTEST_SKIP() << "bash-completion is not installed";
  std::filesystem::create_directory("own");
  std::filesystem::create_directory("own/folder");
  for (const char* name : {"own/a.toml", "own/b.h5", "own/c.txt"}) write_bytes(name, "");
  using Words = std::set<std::string>;
  const auto offered = [&](const std::string& call) {
    const std::vector<std::string> words = offers(call, std::string(". ") + library);
    return Words(words.begin(), words.end());
  };
  EXPECT_EQ(offered("topple run own/"), (Words{"own/a.toml", "own/folder"}));
  EXPECT_EQ(offered("topple info own/"), (Words{"own/a.toml", "own/b.h5", "own/folder"}));
  EXPECT_EQ(offered("topple recover own/"), (Words{"own/b.h5", "own/folder"}));
}

}  // namespace
}  // namespace topple::app
