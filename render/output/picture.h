// The front of the renderer: one recorded instant in, one image out.
#pragma once

#include <memory>
#include <vector>

#include "render/gl/gl.h"
#include "render/output/image.h"
#include "render/scene/camera.h"
#include "render/scene/colour_map.h"
#include "render/scene/mesh.h"
#include "render/scene/overlay.h"
#include "render/scene/scene_frame.h"

namespace topple::render {

struct PictureOptions {
  ColourMap map = ColourMap::viridis;  ///< of an unsigned legend; a signed one has the diverging map
  bool overlay = true;                 ///< words, legend and trace
};

/// Draws still pictures of one size off screen, with four samples a pixel. The same frame, camera and
/// options give the same bytes.
///
///   auto context = make_osmesa_context();
///   Picture picture(context->get_proc(), 1280, 720);
///   write_png("cabinet.png", picture.draw(frame, fit_camera(NamedView::iso, frame, picture.aspect())));
class Picture {
 public:
  /// Needs a current context, now and in every call, that outlives the picture. width, height: 16 to
  /// 8192 px. Throws std::runtime_error when the context, the size or the font will not do.
  Picture(GetProc get_proc, int width, int height, const Letters& letters = {});
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  /// width / height, for the camera.
  float aspect() const;

  /// Numbers that are not finite never reach a pixel: what holds them is left out, and a camera that
  /// holds them is replaced by the fitted iso view. Throws
  /// std::runtime_error when OpenGL reports an error.
  Image draw(const SceneFrame& frame, const Camera& camera, const PictureOptions& options = {});

  /// What the last picture lacks.
  const LeftOut& left_out() const;

  /// Where the words of the last picture lie.
  const std::vector<OverlayBox>& overlay_boxes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace topple::render
