// A drawn scene, kept off screen.
#pragma once

#include "render/gl/gl.h"
#include "render/gl/gl_objects.h"
#include "render/output/image.h"
#include "render/scene/camera.h"
#include "render/scene/colour_map.h"
#include "render/scene/mesh.h"
#include "render/scene/scene_frame.h"
#include "render/scene/scene_painter.h"

namespace topple::render {

/// A framebuffer of one size. What is drawn keeps until the next drawing.
class Canvas {
 public:
  /// samples: a pixel, 0 or 4. `gl` must outlive the canvas. Throws std::runtime_error.
  Canvas(const Gl& gl, int width, int height, int samples);

  /// Draws the whole canvas: a signed legend has the diverging map, a camera that is not finite is
  /// replaced by the fitted iso view.
  void draw(ScenePainter& painter, const SceneFrame& frame, const Camera& camera, ColourMap map,
            Quality quality, LeftOut& left_out);

  /// The picture, one sample a pixel.
  const Target& target() const { return target_; }
  int samples() const { return samples_; }

  Image read() const;

 private:
  const Gl& gl_;
  int samples_;
  GlObject picture_, picture_colour_, depth_, sampled_, sampled_colour_, sampled_depth_;
  Target target_;
};

/// The map in which a frame with this legend is drawn when `wanted` is asked for.
ColourMap colour_map_for(const Legend& legend, ColourMap wanted, bool dark);

}  // namespace topple::render
