#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "render/gl/window.h"

namespace topple::render {
namespace {

TEST(Window, without_a_display_says_so_in_one_line) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  testing::internal::CaptureStderr();
  for (const char* display : {"", ":987"}) {
    if (*display != '\0') setenv("DISPLAY", display, 1);
    try {
      Window window("topple");
      FAIL() << "a window opened";
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind("no display: ", 0), 0u) << text;
      EXPECT_NE(text.find("topple render draws without one"), text.npos) << text;
      EXPECT_EQ(text.find('\n'), text.npos) << text;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace topple::render
