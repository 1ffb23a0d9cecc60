// What a window shows: the scene in its region, the interface around and over it.
#pragma once

#include <optional>

#include "render/gl/gl.h"
#include "render/output/canvas.h"
#include "render/output/image.h"
#include "render/output/imgui_painter.h"
#include "render/scene/camera.h"
#include "render/scene/colour_map.h"
#include "render/scene/mesh.h"
#include "render/scene/scene_frame.h"
#include "render/scene/scene_painter.h"

struct ImDrawData;
struct ImFontAtlas;

namespace topple::render {

/// The whole of what is shown, pixels of the framebuffer.
struct Surface {
  int width = 0;
  int height = 0;
  int scene_left = 0;  ///< of the scene's upper left corner, from the surface's
  int scene_top = 0;
  Float3 background{0.93f, 0.94f, 0.95f};  ///< sRGB, 0..1: what neither scene nor interface covers
};

/// For a scene that moves, of the 33 ms of a frame, s (Stage::set_budget).
inline constexpr double k_scene_budget = 0.018;

/// Draws the scene when it changed, and the interface over the kept scene as often as need be. It is
/// the same under a window and off screen. Every call needs the context current that it was made in.
class Stage {
 public:
  /// The context must outlive the stage. Throws std::runtime_error when it will not do.
  explicit Stage(GetProc get_proc);

  /// The context draws with the processor: everything costs by the pixel.
  bool software() const { return software_; }

  /// Call before the first present, and again when the atlas has other fonts.
  void upload_fonts(ImFontAtlas& atlas) { interface_.upload_fonts(atlas); }

  /// Draws the scene's region, width x height px, as Picture does without its overlay; `interactive`
  /// only makes a difference to a software context. Throws std::runtime_error when OpenGL reports an
  /// error or a side is not 1 to 8192 px.
  void draw_scene(const SceneFrame& frame, const Camera& camera, ColourMap map, int width, int height,
                  Quality quality);

  /// From here on interactive scenes of a software context that take longer than this, s, are drawn coarser,
  /// down to half of the pixels of each side; none: at their full size.
  void set_budget(std::optional<double> seconds);

  /// Puts the scene drawn last and the interface into the window's framebuffer.
  void present(const Surface& surface, const ImDrawData& interface_lists);

  /// What present would show, without a window.
  Image shot(const Surface& surface, const ImDrawData& interface_lists);

  /// A scene by itself, at its best; what draw_scene drew stays.
  Image portrait(const SceneFrame& frame, const Camera& camera, ColourMap map, int width, int height);

  /// Keeps a picture for the interface as long as the stage lives; returns its ImTextureID.
  void* keep(const Image& image) { return interface_.keep(image); }

  /// The interface alone, on white.
  Image sheet(int width, int height, const ImDrawData& interface_lists);

  /// What the last scene lacks.
  const LeftOut& left_out() const { return left_out_; }

 private:
  void present(const Surface& surface, const ImDrawData& interface_lists, GLuint framebuffer);

  Gl gl_;
  bool software_;
  ScenePainter scene_;
  ImguiPainter interface_;
  std::optional<Canvas> canvas_, shot_;
  int width_ = 0, height_ = 0;  // px, of the scene's region
  std::optional<double> budget_;
  int coarseness_ = 0;  // index into k_shares
  LeftOut left_out_;
};

}  // namespace topple::render
