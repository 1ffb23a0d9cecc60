#include "render/output/canvas.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace topple::render {

Canvas::Canvas(const Gl& gl, int width, int height, int samples)
    : gl_(gl),
      samples_(samples),
      picture_(make_framebuffer(gl)),
      picture_colour_(make_renderbuffer(gl, GL_RGBA8, width, height, 0)),
      depth_(make_renderbuffer(gl, GL_DEPTH_COMPONENT32F, width, height, 0)),
      target_{picture_.id(), width, height} {
  const auto attach = [&](GLenum point, const GlObject& buffer) {
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, point, GL_RENDERBUFFER, buffer.id());
  };
  gl.BindFramebuffer(GL_FRAMEBUFFER, picture_.id());
  attach(GL_COLOR_ATTACHMENT0, picture_colour_);
  attach(GL_DEPTH_ATTACHMENT, depth_);
  check_framebuffer(gl, "picture");
  if (samples == 0) return;
  sampled_ = make_framebuffer(gl);
  sampled_colour_ = make_renderbuffer(gl, GL_RGBA8, width, height, samples);
  sampled_depth_ = make_renderbuffer(gl, GL_DEPTH_COMPONENT32F, width, height, samples);
  gl.BindFramebuffer(GL_FRAMEBUFFER, sampled_.id());
  attach(GL_COLOR_ATTACHMENT0, sampled_colour_);
  attach(GL_DEPTH_ATTACHMENT, sampled_depth_);
  check_framebuffer(gl, "picture's samples");
  target_.samples = sampled_.id();
}

void Canvas::draw(ScenePainter& painter, const SceneFrame& frame, const Camera& camera, ColourMap map,
                  Quality quality, LeftOut& left_out) {
  const float aspect = static_cast<float>(target_.width) / static_cast<float>(target_.height);
  const Camera& usable = finite(camera) ? camera : fit_camera(NamedView::iso, frame, aspect);
  painter.draw(frame, usable, colour_map_for(frame.legend, map, frame.dark), quality, target_, left_out);
}

Image Canvas::read() const {
  const auto [picture, width, height, samples] = target_;
  const auto rows = static_cast<std::size_t>(height);
  const std::size_t stride = 4 * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> upward(stride * rows);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, picture);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
  Image image{width, height, std::vector<std::uint8_t>(upward.size())};
  for (std::size_t row = 0; row < rows; ++row) {
    std::memcpy(image.rgba.data() + row * stride, upward.data() + (rows - 1 - row) * stride, stride);
  }
  return image;
}

ColourMap colour_map_for(const Legend& legend, ColourMap wanted, bool dark) {
  if (legend.is_signed) return ColourMap::diverging;
  if (!dark) return wanted;
  return wanted == ColourMap::cividis ? ColourMap::cividis_on_dark : ColourMap::viridis_on_dark;
}

}  // namespace topple::render
