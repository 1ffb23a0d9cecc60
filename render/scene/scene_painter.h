// Draws the bodies, floor, walls, panels and arrows of a SceneFrame into a framebuffer.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "render/gl/gl.h"
#include "render/gl/gl_objects.h"
#include "render/scene/camera.h"
#include "render/scene/colour_map.h"
#include "render/scene/grounds.h"
#include "render/scene/mesh.h"
#include "render/scene/scene_frame.h"
#include "render/scene/shadows.h"

namespace topple::render {

/// What is drawn to.
struct Target {
  GLuint framebuffer = 0;  ///< with a depth buffer; 0 is a window's own
  int width = 0;           ///< pixels
  int height = 0;
  GLuint samples = 0;  ///< multisampled framebuffer of that size, with a depth buffer; 0: none
};

/// interactive: shadows from fewer and coarser samples, for a software rasteriser that has to keep up
/// with a person; still: full quality.
enum class Quality { interactive, still };

/// Holds shaders, buffers and shadow maps for one context. Any call needs that context current.
class ScenePainter {
 public:
  /// `gl` must outlive the painter. Throws std::runtime_error when the context cannot do it.
  explicit ScenePainter(const Gl& gl);

  /// Fills the whole target; what is not floor, wall or backdrop is drawn by way of the samples where there
  /// are any. Counts what cannot be drawn in `left_out`.
  void draw(const SceneFrame& frame, const Camera& camera, ColourMap map, Quality quality,
            const Target& target, LeftOut& left_out);

 private:
  /// Lit programs and shadow maps of one quality.
  struct Lighting {
    Lighting(const Gl& gl, std::string_view constants, const ShadowSize& size);
    Program ground, shaded_ground, solid, shaded_solid;  // shaded: where shadows may fall
    Shadows shadows;
  };

  /// Of a picture, from its lower left corner.
  struct PixelRect {
    int left, bottom, width, height;
  };

  Lighting& lighting(Quality quality);
  void upload(const SceneFrame& frame, const Camera& camera, int height, LeftOut& left_out);
  /// Triangles of solids that face the light first.
  void sort_by_light();
  /// The rectangle of the picture in which all that was uploaded is seen.
  PixelRect seen(const Target& target) const;
  void draw_room(const PixelRect& part, const Lighting& lighting, const Grounds& grounds);
  void draw_backdrop(const PixelRect& part);
  void draw_grounds(const Lighting& lighting, const Grounds& grounds);
  void draw_tiles(const Program& program, const DrawnGround& ground, const IndexRange& tiles);
  void draw_lit(const Program& program, const Lighting& lighting, const Camera& camera,
                const IndexRange& part);
  void draw_solids(const Lighting& lighting, const Camera& camera);
  /// Outlines, ghosts, panels, paths and forces.
  void draw_over_solids(const Lighting& lighting, const Camera& camera);
  void draw(const IndexRange& part);
  void draw_ghosts(const Camera& camera);
  void draw_panels(const Camera& camera);
  void draw_flat(const IndexRange& part);
  void use_lit(const Program& program, const Lighting& lighting, const Camera& camera);
  void bind(GLuint unit, const GlObject& texture);

  const Gl& gl_;
  Program backdrop_, panel_, ghost_, outline_;
  std::array<std::unique_ptr<Lighting>, 2> lightings_;  // made when first drawn with
  GlObject mesh_array_, mesh_vertices_, mesh_indices_, panel_array_, panel_vertices_, ground_array_,
      ground_corners_, empty_array_;
  std::array<GlObject, k_colour_map_count> colour_maps_;
  Mesh solid_mesh_, mesh_;  // mesh_: the solids and all other triangles, as uploaded
  std::vector<PanelVertex> panels_;
  IndexRange solids_, towards_light_, away_from_light_, ghosts_, shells_, trails_, bands_, arrows_;
  Eigen::Vector3f low_, high_;  // box around bounds and everything solid
  Eigen::Matrix4f view_projection_;
};

}  // namespace topple::render
