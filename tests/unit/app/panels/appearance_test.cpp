// How the window looks is kept between starts.
#include "app/panels/appearance.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "app/panels/phrase_tables.h"
#include "app/picture/window_words.h"
#include "unit/render/scratch.h"

namespace topple::app {
namespace {

/// Without a language of the locale.
class AppearanceTest : public ::testing::Test {
 protected:
  AppearanceTest() {
    for (const char* const name : {"LC_ALL", "LC_MESSAGES", "LANG"}) ::unsetenv(name);
  }
  Appearance read(const std::string& text) {
    std::ofstream(file_) << text;
    warning_.clear();
    return read_appearance(file_, warning_);
  }
  const render::Scratch scratch_;
  const std::filesystem::path file_ = scratch_ / "settings";
  std::string warning_;
};

TEST_F(AppearanceTest, what_is_kept_is_read_again) {
  const auto file = std::filesystem::path(scratch_ / "new") / "topple/settings";
  const Appearance chosen{1.75, true, Language::japanese};
  keep_appearance(file, chosen);
  EXPECT_EQ(read_appearance(file, warning_), chosen);
  EXPECT_EQ(warning_, "");
}

TEST_F(AppearanceTest, without_settings_it_is_the_usual_one_in_the_language_of_the_locale) {
  EXPECT_EQ(read_appearance(scratch_ / "none", warning_), Appearance{});
  ::setenv("LANG", "ja_JP.UTF-8", 1);
  EXPECT_EQ(read_appearance(scratch_ / "none", warning_).language, Language::japanese);
  ::setenv("LC_ALL", "C", 1);
  EXPECT_EQ(read_appearance(scratch_ / "none", warning_).language, Language::english);
  EXPECT_EQ(warning_, "");
}

TEST_F(AppearanceTest, what_is_not_understood_is_told_of_with_its_line_and_changes_nothing) {
  for (const char* const line :
       {"scale = 9", "scale = nan", "scale = 1x", "theme = \"pink\"", "colour", "= 1"}) {
    SCOPED_TRACE(line);
    const Appearance appearance = read("theme = \"dark\"\n" + std::string(line) + "\n");
    EXPECT_EQ(appearance, (Appearance{1, true, Language::english}));
    EXPECT_NE(warning_.find("settings:2: \"" + std::string(line) + "\""), std::string::npos) << warning_;
  }
}

TEST(Scales, go_from_75_to_300_percent_and_back_to_the_usual_one) {
  double scale = 1;
  for (int i = 0; i < 20; ++i) scale = next_scale(scale, 1);
  EXPECT_EQ(scale, k_most_scale);
  for (int i = 0; i < 20; ++i) scale = next_scale(scale, -1);
  EXPECT_EQ(scale, k_least_scale);
  EXPECT_EQ(next_scale(scale, 0), 1);
}

TEST(Scales, are_no_larger_than_the_window_has_room_for_but_never_below_the_usual_one_for_that) {
  const auto fitted = [](double scale, float desktop, float width, float height) {
    return fitting({.scale = scale}, desktop, width, height).scale;
  };
  EXPECT_EQ(fitted(3, 1, 1920, 1080), 3);
  EXPECT_EQ(fitted(3, 1, 1920, 1070), 2.5);
  EXPECT_EQ(fitted(3, 1, 1280, 720), 2);
  EXPECT_EQ(fitted(3, 2, 1280, 720), 1);
  EXPECT_EQ(fitted(1.1, 1, 1280, 720), 1.1);
  EXPECT_EQ(fitted(1, 1, 200, 100), 1);
  EXPECT_EQ(fitted(0.75, 1, 200, 100), 0.75);
  EXPECT_EQ(fitted(3, 1, -1, -1), 3);
}

TEST(PhraseTables, hold_every_letter_of_a_phrase) {
  const std::string tables = phrase_tables();
  EXPECT_NE(tables.find(window_words::k_leaning.japanese), std::string::npos);
  EXPECT_EQ(tables.find("計算開始から"), std::string::npos) << "the report's letters are not drawn";
}

}  // namespace
}  // namespace topple::app
