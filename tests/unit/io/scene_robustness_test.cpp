// Damaged scenes give a Scene or an InputError of one line, nothing else.
#include <gtest/gtest.h>

#include "scene_samples.h"

namespace topple::io {
namespace {

// True when it was read.
bool survives(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
    return true;
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_TRUE(line.rfind("s.toml:", 0) == 0 || line.rfind("--set ", 0) == 0) << line;
  }
  return false;
}

TEST(SceneRobustness, every_prefix_of_paper_a_is_read_or_refused) {
  const std::string text(load_scene("paper-a").text);
  ASSERT_NE(text.find("190 gal"), std::string::npos);
  int read = 0;
  for (std::size_t size = 0; size <= text.size(); ++size) {
    SCOPED_TRACE(size);
    read += survives(text.substr(0, size));
  }
  EXPECT_GT(read, 0);
}

TEST(SceneRobustness, every_flipped_byte_of_a_small_scene_is_read_or_refused) {
  const std::string small =
      k_scene + "[contact]\nalpha = \"50 kgf\"\n[[shake]]\nfrequency = 1\namplitude = 1.9\n";
  int read = 0, refused = 0;
  for (std::size_t k = 0; k < small.size(); ++k) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string text = small;
      text[k] = static_cast<char>(text[k] ^ (1 << bit));
      SCOPED_TRACE(text);
      ++(survives(text) ? read : refused);
    }
  }
  EXPECT_GT(read, 100);
  EXPECT_GT(refused, 100);
}

TEST(SceneRobustness, every_line_may_be_missing_or_doubled) {
  const std::string text = std::string(builtin_scenes().at(0).text);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    SCOPED_TRACE(text.substr(begin, end - begin));
    survives(text.substr(0, begin) + text.substr(end));
    survives(text.substr(0, end) + text.substr(begin));
    begin = end;
  }
}

TEST(SceneRobustness, deep_nesting_is_refused) {
  std::string dots = "topple = 1\na", brackets = "topple = 1\na = ";
  for (int k = 0; k < 200000; ++k) dots += ".a";
  EXPECT_FALSE(survives(dots + " = 1\n"));
  EXPECT_FALSE(survives(brackets + std::string(200000, '[') + "\n"));
  std::string tables = "topple = 1\na = ";
  for (int k = 0; k < 100000; ++k) tables += "{a=";
  EXPECT_FALSE(survives(tables + "\n"));
}

TEST(SceneRobustness, huge_bodies_are_refused) {
  std::string members = k_head + k_library + "[[frame]]\nnodes = [[0, 0, 0], [1, 0, 0]]\nmembers = [\n";
  for (int k = 0; k < 200; ++k) {
    members += "{ nodes = [0, 1], section = \"post\", material = \"steel\", elements = 1000 },\n";
  }
  EXPECT_NE(error_of(members + "]\n").find("200000 elements, more than 100000"), std::string::npos);
}

TEST(SceneRobustness, odd_overrides_are_refused) {
  for (const char* text : {"",
                           "=",
                           "=1",
                           "contact",
                           ".",
                           "..=1",
                           "contact.=1",
                           ".contact=1",
                           "contact..alpha=1",
                           "frame=1",
                           "frame.beam=1",
                           "frame.beam.=1",
                           "frame.nobody.mass=1",
                           "frame.7.mass=1",
                           "topple.a=1",
                           "a.b.c.d=1",
                           "contact=5",
                           "shake.1.amplitude=1",
                           "shake=[{}]",
                           "contact.alpha=",
                           "contact.alpha=\n",
                           "contact.alpha=1\nb = 2",
                           "contact.friction=nan"}) {
    SCOPED_TRACE(text);
    EXPECT_FALSE(survives(k_scene, {text}));
  }
}

}  // namespace
}  // namespace topple::io
