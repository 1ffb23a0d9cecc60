// Draws the bodies, floor, walls, panels and arrows of a SceneFrame into a framebuffer.
#pragma once

#include <array>

#include <Eigen/Core>

#include "render/camera.h"
#include "render/colour_map.h"
#include "render/gl.h"
#include "render/gl_objects.h"
#include "render/mesh.h"
#include "render/scene_frame.h"

namespace topple::render {

/// What is drawn to.
struct Target {
  GLuint framebuffer = 0;  ///< with a depth buffer; 0 is a window's own
  int width = 0;           ///< pixels
  int height = 0;
};

/// Holds shaders, buffers and shadow maps for one context. Any call needs that context current.
class ScenePainter {
 public:
  /// `gl` must outlive the painter. Throws std::runtime_error when the context cannot do it.
  explicit ScenePainter(const Gl& gl);

  /// Fills the whole target. Counts what cannot be drawn in `left_out`.
  void draw(const SceneFrame& frame, const Camera& camera, ColourMap map, const Target& target,
            LeftOut& left_out);

 private:
  /// Where the one floor is that shows contact shadows, and the square of it that is mapped.
  struct ContactPlane {
    Eigen::Vector3f point{0, 0, 0};
    Eigen::Vector3f normal{0, 0, 1};
    Eigen::Matrix4f to_map = Eigen::Matrix4f::Identity();
    float size = 1;  // m
  };

  void upload(const SceneFrame& frame, const Camera& camera, LeftOut& left_out);
  void draw_key_shadow();
  void draw_contact_map(const SceneFrame& frame);
  void draw_grounds(const SceneFrame& frame, const Camera& camera, int height, LeftOut& left_out);
  void draw_solids();
  void draw_panels(const Camera& camera);
  void set_light(const Program& program, const Camera& camera);
  void bind(GLuint unit, const GlObject& texture);

  const Gl& gl_;
  Program backdrop_, ground_, solid_, panel_, shadow_, contact_;
  GlObject mesh_array_, mesh_vertices_, mesh_indices_, panel_array_, panel_vertices_, empty_array_;
  GlObject shadow_map_, contact_map_, shadow_target_, contact_target_;
  std::array<GlObject, 3> colour_maps_;
  Mesh mesh_;
  GLsizei panel_vertex_count_ = 0;
  Eigen::Vector3f low_, high_;  // box around bounds and everything solid
  Eigen::Matrix4f view_projection_, shadow_matrix_;
  ContactPlane contact_plane_;
};

}  // namespace topple::render
