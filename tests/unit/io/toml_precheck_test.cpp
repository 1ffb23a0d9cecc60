// What toml++ cannot bear is refused where it stands, and nothing else is.
#include <gtest/gtest.h>

#include "scene_samples.h"
#include "solver/io/document/toml_precheck.h"

namespace topple::io {
namespace {

void expect_fault(const std::string& text, int line, int column) {
  SCOPED_TRACE(text);
  const std::optional<TomlFault> fault = find_toml_fault(text);
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->line, line);
  EXPECT_EQ(fault->column, column);
}

TEST(TomlPrecheck, letters_beyond_ascii_stand_in_strings_and_comments) {
  for (const char* text :
       {"a = \"é\"", "a = 'é'", "# é\n", "a = 1 # é", "a = \"\"\"\né\n\"\"\"", "a = '''\né\n'''", "\"é\" = 1",
        "\xef\xbb\xbf"
        "a = 1",
        "a = \"\\\"é\"", "a = '\\' # é", "a = \"\"\"é\"\"\"\"\" # é", "a = \"# é\""}) {
    EXPECT_FALSE(find_toml_fault(text).has_value()) << text;
  }
  expect_fault("é = 1", 1, 1);
  expect_fault("a = 1\nb = 2é", 2, 6);
  expect_fault("a = \"é\" é", 1, 9);  // in characters
  expect_fault("a = ''''''é", 1, 11);
  expect_fault("\xef\xbb\xbfé", 1, 1);
  expect_fault("a = \"open\né", 2, 1);
}

// toml++ 3.3 and 3.4 ask of such letters whether they are blanks, which is undefined for most of them.
TEST(TomlPrecheck, no_letter_beyond_ascii_follows_an_escaped_line_break) {
  for (const char* text :
       {"a = \"\"\"b\\\nc é\"\"\"", "a = \"\"\"b\\\n\n  c\\\"é\"\"\"", "a = '''b\\\né'''", "a = \"b\\\"é\""})
    EXPECT_FALSE(find_toml_fault(text).has_value()) << text;
  expect_fault("a = \"\"\"b\\\né\"\"\"", 2, 1);
  expect_fault("a = \"\"\"b\\ \t\n\n  é\"\"\"", 3, 3);
  expect_fault("a = \"\"\"b\\é\"\"\"", 1, 10);
}

TEST(TomlPrecheck, quotes_and_brackets_begin_values_and_stand_in_none) {
  for (const char* text : {"a.\"é\".'b' = 1.5", "a . \"é\" = 1979-05-27 07:32:00Z # \"é\"",
                           "a = { b.\"é\" = 1.5, \"c\" = [1, [2.5,\n\"é\"], { d.'é' = \"é\" }] }\n'b' = 1",
                           "[a.\"é\"]\nb = [1.5,\n  'é']\n[[c.\"é\"]]"})
    EXPECT_FALSE(find_toml_fault(text).has_value()) << text;
  expect_fault("a = +b=\"\"\"é", 1, 7);
  expect_fault("a = [1.5\"é\"]", 1, 9);
  expect_fault("a = [0.'é']", 1, 8);
  expect_fault("a = 5[\"é\"]", 1, 6);
  expect_fault("a = { b = 5'é' }", 1, 12);
  expect_fault("a = 1979-05-27 0'é'", 1, 17);
}

TEST(TomlPrecheck, columns_count_letters_and_bytes_that_are_none) {
  expect_fault("a = 1\na = \"é\" é\n", 2, 9);
  expect_fault("a = 1\na = \"\xff\" é\n", 2, 9);
}

TEST(TomlPrecheck, headers_begin_with_a_name) {
  for (const char* text :
       {"[a]", "[[a]]", "[ a ]", "[\"a\"]", "['a']", "[-]", "a = [\n[1], [.5],\n{ b = 1 }]"}) {
    EXPECT_FALSE(find_toml_fault(text).has_value()) << text;
  }
  expect_fault("[=", 1, 2);
  expect_fault("a = 1\n  [[ .a]]", 2, 6);
  expect_fault("[\na]", 1, 2);
  expect_fault("[#]", 1, 2);
}

TEST(TomlPrecheck, keys_have_at_most_500_dots) {
  std::string key = "a";
  for (int k = 0; k < 500; ++k) key += ".a";
  EXPECT_FALSE(find_toml_fault(key + " = 1.5\n" + key + "= \"" + key + key + "\"").has_value());
  expect_fault(key + ".b = 1", 1, 1002);
}

TEST(TomlPrecheck, the_first_error_of_a_text_is_the_one_told) {
  EXPECT_EQ(error_of("topple = 1\na = 30 µm\n"),
            "s.toml:2:8: a letter beyond ASCII stands in quotes, or in a comment; a number with a unit, and "
            "text, stand in quotes: \"30 µm\"");
  EXPECT_EQ(error_of("topple = tru\na = é\n").rfind("s.toml:1:", 0), 0u);
  EXPECT_EQ(error_of("topple = 1\n[=\n"), "s.toml:2:2: expected a table's name");
}

}  // namespace
}  // namespace topple::io
