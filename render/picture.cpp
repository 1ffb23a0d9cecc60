#include "render/picture.h"

#include <imgui.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "render/drawable.h"
#include "render/gl_objects.h"
#include "render/imgui_painter.h"
#include "render/scene_painter.h"

namespace topple::render {
namespace {

constexpr int k_samples = 4;
constexpr int k_least_side = 16;
constexpr int k_greatest_side = 8192;

/// A Dear ImGui context of its own, current only while it is used: a window may have another one.
class Words {
 public:
  Words(int width, int height) : previous_(ImGui::GetCurrentContext()), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = 1.0f / 60;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImGui::SetCurrentContext(previous_);
  }
  ~Words() { ImGui::DestroyContext(context_); }
  Words(const Words&) = delete;
  Words& operator=(const Words&) = delete;

  /// Calls `use` with the context current.
  template <typename Use>
  void with(Use use) {
    ImGuiContext* other = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    use();
    ImGui::SetCurrentContext(other);
  }

 private:
  ImGuiContext* previous_;
  ImGuiContext* context_;
};

bool finite(const Camera& camera) {
  return camera.view.allFinite() && camera.projection.allFinite() && camera.eye.allFinite();
}

}  // namespace

struct Picture::Parts {
  Parts(GetProc get_proc, int w, int h)
      : gl(load_gl(get_proc)), width(w), height(h), scene(gl), painter(gl), words(w, h) {
    sampled = make_framebuffer(gl);
    resolved = make_framebuffer(gl);
    sampled_colour = make_renderbuffer(gl, GL_RGBA8, w, h, k_samples);
    sampled_depth = make_renderbuffer(gl, GL_DEPTH_COMPONENT24, w, h, k_samples);
    resolved_colour = make_renderbuffer(gl, GL_RGBA8, w, h, 0);
    gl.BindFramebuffer(GL_FRAMEBUFFER, sampled.id());
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, sampled_colour.id());
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, sampled_depth.id());
    check_framebuffer(gl, "picture's samples");
    gl.BindFramebuffer(GL_FRAMEBUFFER, resolved.id());
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_colour.id());
    check_framebuffer(gl, "picture");
    words.with([&] {
      // Narrow pictures take the letters of a lower one, so that lines keep their room.
      fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, std::min(height, 3 * width / 4));
      painter.upload_fonts(*ImGui::GetIO().Fonts);
    });
    check_gl(gl, "the set-up of a picture");
  }

  void draw_words(const SceneFrame& frame, ColourMap map) {
    words.with([&] {
      ImGui::NewFrame();
      boxes = draw_overlay(*ImGui::GetBackgroundDrawList(), fonts, frame, map, static_cast<float>(width),
                           static_cast<float>(height), left_out);
      ImGui::Render();
      painter.draw(*ImGui::GetDrawData(), {resolved.id(), width, height});
    });
  }

  Image read() {
    const std::size_t stride = 4 * static_cast<std::size_t>(width);
    std::vector<std::uint8_t> upward(stride * static_cast<std::size_t>(height));
    gl.BindFramebuffer(GL_FRAMEBUFFER, resolved.id());
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
    Image image{width, height, std::vector<std::uint8_t>(upward.size())};
    for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row) {
      std::memcpy(image.rgba.data() + row * stride,
                  upward.data() + (static_cast<std::size_t>(height) - 1 - row) * stride, stride);
    }
    return image;
  }

  Gl gl;
  int width, height;
  ScenePainter scene;
  ImguiPainter painter;
  Words words;
  OverlayFonts fonts;
  GlObject sampled, resolved, sampled_colour, sampled_depth, resolved_colour;
  LeftOut left_out;
  std::vector<OverlayBox> boxes;
};

Picture::Picture(GetProc get_proc, int width, int height) {
  if (std::min(width, height) < k_least_side || std::max(width, height) > k_greatest_side) {
    throw std::runtime_error("picture of " + std::to_string(width) + " x " + std::to_string(height) +
                             " px: sides must be " + std::to_string(k_least_side) + " to " +
                             std::to_string(k_greatest_side));
  }
  parts_ = std::make_unique<Parts>(get_proc, width, height);
}

Picture::~Picture() = default;

float Picture::aspect() const {
  return static_cast<float>(parts_->width) / static_cast<float>(parts_->height);
}

Image Picture::draw(const SceneFrame& frame, const Camera& camera, const PictureOptions& options) {
  Parts& p = *parts_;
  p.left_out = {};
  p.boxes.clear();
  const ColourMap map = frame.legend.is_signed ? ColourMap::diverging : options.map;
  const Camera& usable = finite(camera) ? camera : fit_camera(NamedView::iso, frame, aspect());
  p.scene.draw(frame, usable, map, {p.sampled.id(), p.width, p.height}, p.left_out);
  p.gl.BindFramebuffer(GL_READ_FRAMEBUFFER, p.sampled.id());
  p.gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, p.resolved.id());
  p.gl.BlitFramebuffer(0, 0, p.width, p.height, 0, 0, p.width, p.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  if (options.overlay) p.draw_words(frame, map);
  Image image = p.read();
  check_gl(p.gl, "drawing a picture");
  return image;
}

const LeftOut& Picture::left_out() const {
  return parts_->left_out;
}

const std::vector<OverlayBox>& Picture::overlay_boxes() const {
  return parts_->boxes;
}

}  // namespace topple::render
