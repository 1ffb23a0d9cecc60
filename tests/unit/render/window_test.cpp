// A real window; runs under xvfb-run, in a process without an off-screen context.
#include "render/gl/window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "tests/unit/render/read_png.h"
#include "tests/unit/render/scratch.h"
#include "tests/unit/render/staged.h"

namespace topple::render {
namespace {

/// The framebuffer of the window, as it was drawn.
Image framebuffer_of(const Window& window) {
  const Gl gl = load_gl(window.get_proc());
  const auto [width, height] = window.framebuffer_size();
  Image upward{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height))};
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.rgba.data());
  Image image = upward;
  for (int y = 0; y < height; ++y) {
    std::copy_n(upward.rgba.begin() + 4 * width * (height - 1 - y), 4 * width,
                image.rgba.begin() + 4 * width * y);
  }
  return image;
}

struct Differences {
  double mean = 0;
  double greatest = 0;
};

Differences differences(const Image& a, const Image& b) {
  Differences result;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const double step = std::abs(double{1} * a.rgba[i] - b.rgba.at(i));
    result.mean += step / static_cast<double>(a.rgba.size());
    result.greatest = std::max(result.greatest, step);
  }
  return result;
}

TEST(Window, shows_what_is_drawn_off_screen) {
  const Scratch scratch;
  const std::filesystem::path path = scratch / "stage.png";
  ASSERT_EQ(std::system(("'" TOPPLE_DRAW_STAGE "' '" + path.string() + "'").c_str()), 0);
  const Image wanted = read_png(path);

  Window window("topple", k_staged_width, k_staged_height);
  ASSERT_EQ(window.framebuffer_size().width, k_staged_width);
  ASSERT_EQ(window.framebuffer_size().height, k_staged_height);
  Staged staged(window.get_proc());
  staged.draw_scene(synthetic_cabinet(6), Quality::interactive);
  const Image shot = staged.stage.shot(k_surface, staged.panel());
  staged.stage.present(k_surface, staged.panel());
  const Image shown = framebuffer_of(window);
  window.swap();
  // The window's rows run the other way: edges of letters and panels round by a step.
  EXPECT_LE(differences(shown, shot).greatest, 1);
  // On one version of Mesa these are the same; another may round coverage and filtering differently.
  EXPECT_LE(differences(shown, wanted).mean, 0.25);
}

TEST(Window, opens_again_after_it_was_closed) {
  for (int i = 0; i < 2; ++i) {
    Window window("topple");
    EXPECT_FALSE(window.should_close());
    EXPECT_FALSE(window.iconified());
    EXPECT_GT(window.content_scale(), 0);
    window.set_title("topple: paper-a");
    window.close();
    EXPECT_TRUE(window.should_close());
  }
}

TEST(Window, a_thread_wakes_it_and_that_is_no_input) {
  Window window("topple");
  do {
    window.wait_events(0.2);
  } while (window.take_input());  // until the desktop has shown it
  std::thread other([] { Window::wake(); });
  window.wait_events(1e6);
  other.join();
  EXPECT_FALSE(window.take_input());
}

TEST(Window, files_that_are_dropped_are_handed_over_once_and_are_input) {
  Window window("topple");
  do {
    window.wait_events(0.2);
  } while (window.take_input());
  GLFWwindow* const dropped_on = glfwGetCurrentContext();
  const GLFWdropfun on_drop = glfwSetDropCallback(dropped_on, nullptr);
  ASSERT_NE(on_drop, nullptr);
  const char* paths[] = {"/a scene.toml", "/地震.AT2"};
  on_drop(dropped_on, 2, paths);
  EXPECT_TRUE(window.take_input());
  EXPECT_EQ(window.take_drops(), (std::vector<std::string>{"/a scene.toml", "/地震.AT2"}));
  EXPECT_TRUE(window.take_drops().empty());
}

TEST(Window, another_size_is_input_and_reaches_dear_imgui) {
  ImGuiContext* context = ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().Fonts->Build();
  {
    Window window("topple", 800, 600);
    window.connect_imgui();
    EXPECT_TRUE(window.take_input());  // the first frame
    do {
      window.wait_events(0.2);
    } while (window.take_input());
    window.new_imgui_frame();
    EXPECT_EQ(ImGui::GetIO().DisplaySize.x, 800);
    glfwSetWindowSize(glfwGetCurrentContext(), 900, 650);
    while (!window.take_input()) window.wait_events(1);
    EXPECT_EQ(window.size().width, 900);
    window.new_imgui_frame();
    EXPECT_EQ(ImGui::GetIO().DisplaySize.x, 900);
    EXPECT_EQ(ImGui::GetIO().DisplaySize.y, 650);
  }
  EXPECT_EQ(ImGui::GetCurrentContext(), context);
  ImGui::DestroyContext(context);
}

}  // namespace
}  // namespace topple::render
