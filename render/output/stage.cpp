#include "render/output/stage.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

namespace topple::render {
namespace {

constexpr int k_samples = 4;
constexpr int k_greatest_side = 8192;
constexpr double k_shares[] = {1, 0.85, 0.7, 0.6, 0.5};  // of the pixels of each side
constexpr double k_reserve = 0.8;  // of the budget, below which a finer picture is tried

bool draws_with_the_processor(const Gl& gl) {
  const auto* text = reinterpret_cast<const char*>(gl.GetString(GL_RENDERER));
  const std::string_view renderer = text == nullptr ? "" : text;
  return std::ranges::any_of(std::array{"llvmpipe", "softpipe", "swrast", "Software Rasterizer"},
                             [&](const char* name) { return renderer.find(name) != renderer.npos; });
}

/// The canvas with this size and number of samples.
Canvas& fitting(std::optional<Canvas>& canvas, const Gl& gl, int width, int height, int samples) {
  if (std::min(width, height) < 1 || std::max(width, height) > k_greatest_side) {
    throw std::runtime_error("region of " + std::to_string(width) + " x " + std::to_string(height) +
                             " px: sides must be 1 to " + std::to_string(k_greatest_side));
  }
  if (!canvas || canvas->target().width != width || canvas->target().height != height ||
      canvas->samples() != samples) {
    canvas.emplace(gl, width, height, samples);
  }
  return *canvas;
}

}  // namespace

Stage::Stage(GetProc get_proc)
    : gl_(load_gl(get_proc)), software_(draws_with_the_processor(gl_)), scene_(gl_), interface_(gl_) {
  check_gl(gl_, "the set-up of a stage");
}

void Stage::draw_scene(const SceneFrame& frame, const Camera& camera, ColourMap map, int width, int height,
                       Quality quality) {
  if (!software_) quality = Quality::still;
  left_out_ = {};
  width_ = width;
  height_ = height;
  const bool still = quality == Quality::still;
  const auto pixels = [&](int side) {
    return still ? side : std::max(1, static_cast<int>(std::lround(k_shares[coarseness_] * side)));
  };
  Canvas& canvas = fitting(canvas_, gl_, pixels(width), pixels(height), still ? k_samples : 0);
  const auto begun = std::chrono::steady_clock::now();
  canvas.draw(scene_, frame, camera, map, quality, left_out_);
  check_gl(gl_, "drawing the scene");
  if (still || !budget_) return;
  gl_.Finish();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
  const int most = static_cast<int>(std::size(k_shares)) - 1;
  if (taken.count() > *budget_) {
    coarseness_ = std::min(coarseness_ + 1, most);
  } else if (coarseness_ > 0) {
    const double ratio = k_shares[coarseness_ - 1] / k_shares[coarseness_];
    if (ratio * ratio * taken.count() < k_reserve * *budget_) --coarseness_;
  }
}

void Stage::set_budget(std::optional<double> seconds) {
  budget_ = seconds;
  if (!seconds) coarseness_ = 0;
}

void Stage::present(const Surface& surface, const ImDrawData& interface_lists) {
  present(surface, interface_lists, 0);
}

Image Stage::shot(const Surface& surface, const ImDrawData& interface_lists) {
  const Canvas& canvas = fitting(shot_, gl_, surface.width, surface.height, 0);
  present(surface, interface_lists, canvas.target().framebuffer);
  return canvas.read();
}

Image Stage::portrait(const SceneFrame& frame, const Camera& camera, ColourMap map, int width, int height) {
  Canvas& canvas = fitting(shot_, gl_, width, height, k_samples);
  LeftOut ignored;
  canvas.draw(scene_, frame, camera, map, Quality::still, ignored);
  check_gl(gl_, "drawing a portrait");
  return canvas.read();
}

Image Stage::sheet(int width, int height, const ImDrawData& interface_lists) {
  const Canvas& canvas = fitting(shot_, gl_, width, height, 0);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, canvas.target().framebuffer);
  gl_.ClearColor(1, 1, 1, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  interface_.draw(interface_lists, canvas.target());
  check_gl(gl_, "drawing a sheet");
  return canvas.read();
}

void Stage::present(const Surface& surface, const ImDrawData& interface_lists, GLuint framebuffer) {
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const auto [red, green, blue] = surface.background;
  gl_.ClearColor(red, green, blue, 1);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  if (canvas_) {
    const auto [picture, width, height, samples] = canvas_->target();
    const int left = surface.scene_left;
    const int top = surface.height - surface.scene_top;  // upwards, as OpenGL counts
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, picture);
    const bool same = width == width_ && height == height_;
    gl_.BlitFramebuffer(0, 0, width, height, left, top - height_, left + width_, top, GL_COLOR_BUFFER_BIT,
                        same ? GL_NEAREST : GL_LINEAR);
  }
  interface_.draw(interface_lists, {framebuffer, surface.width, surface.height});
  check_gl(gl_, "presenting");
}

}  // namespace topple::render
