#include "render/scene/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "render/scene/drawable.h"

namespace topple::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr GLuint k_colour_unit = 0;

// Of the highlighted member, px of a picture 720 high from its side: white within, magenta without,
// so that one of them stands out from any colour of a map.
constexpr float k_inner_outline = 1.5f;
constexpr float k_outer_outline = 4;
constexpr float k_body_outline = 1.6f;                  // of all members of a body, magenta alone
constexpr float k_trail = 2.2f, k_band_outline = 1.6f;  // px likewise, wide
constexpr Float4 k_inner_colour{1, 1, 1, 1};
constexpr Float4 k_outer_colour{0.86f, 0.05f, 0.45f, 1};

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

/// Adds `part` to the mesh and returns where its indices lie.
IndexRange append(Mesh& mesh, const Mesh& part) {
  const IndexRange range{static_cast<std::uint32_t>(mesh.indices.size()),
                         static_cast<std::uint32_t>(part.indices.size())};
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const std::uint32_t index : part.indices) mesh.indices.push_back(base + index);
  return range;
}

struct PlaneAxes {
  Vector3f along, across, normal;
};

/// False when the ground has no plane or no area.
bool plane_axes(const Ground& ground, PlaneAxes& axes) {
  if (!drawable(ground.centre) || !drawable(ground.normal) || !drawable(ground.along) ||
      !drawable(ground.half_length) || !drawable(ground.half_width) || ground.half_length <= 0 ||
      ground.half_width <= 0) {
    return false;
  }
  const Vector3f normal(ground.normal.data());
  const Vector3f along(ground.along.data());
  const Vector3f across = normal.cross(along);
  if (across.norm() < 1e-6f) return false;
  axes.normal = normal.normalized();
  axes.across = across.normalized();
  axes.along = axes.across.cross(axes.normal);
  return true;
}

/// The first floor that has a plane; a level one at `height` when there is none.
FloorPlane floor_plane(const SceneFrame& frame, float height) {
  for (const Ground& ground : frame.grounds) {
    PlaneAxes axes;
    if (ground.is_floor && plane_axes(ground, axes)) {
      return {Vector3f(ground.centre.data()), axes.along, axes.across, axes.normal};
    }
  }
  FloorPlane level;
  level.point.z() = height;
  return level;
}

/// Plane (normal, offset) of the first wall that is seen from its face; one that is never reached
/// when there is none. The room ends there, so the floor does not go on behind it.
Eigen::Vector4f wall_before_which_the_floor_lies(const SceneFrame& frame, const Vector3f& eye) {
  for (const Ground& ground : frame.grounds) {
    PlaneAxes axes;
    if (ground.is_floor || !plane_axes(ground, axes)) continue;
    const float offset_m = axes.normal.dot(Vector3f(ground.centre.data()));
    if (axes.normal.dot(eye) > offset_m) return {axes.normal.x(), axes.normal.y(), axes.normal.z(), offset_m};
  }
  return {0, 0, 0, -1};
}

}  // namespace

ScenePainter::ScenePainter(const Gl& gl)
    : gl_(gl),
      backdrop_(gl, "whole.vert", {"backdrop.frag"}),
      panel_(gl, "panel.vert", {"panel.frag"}),
      ghost_(gl, "solid.vert", {"ghost.frag"}),
      outline_(gl, "solid.vert", {"outline.frag"}),
      mesh_array_(make_vertex_array(gl)),
      mesh_vertices_(make_buffer(gl)),
      mesh_indices_(make_buffer(gl)),
      panel_array_(make_vertex_array(gl)),
      panel_vertices_(make_buffer(gl)),
      empty_array_(make_vertex_array(gl)) {
  for (std::size_t i = 0; i < colour_maps_.size(); ++i) {
    const ColourTable& table = colour_table(static_cast<ColourMap>(i));
    colour_maps_[i] =
        make_texture(gl, {GL_RGB8, GL_RGB, GL_UNSIGNED_BYTE}, k_colour_map_size, 1, table.data());
  }

  gl.BindVertexArray(mesh_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, mesh_vertices_.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh_indices_.id());
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, position)));
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, normal)));
  gl.VertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset(offsetof(Vertex, at)));
  gl.VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex), offset(offsetof(Vertex, rgba)));
  for (GLuint i = 0; i < 4; ++i) gl.EnableVertexAttribArray(i);
  gl.BindVertexArray(panel_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, panel_vertices_.id());
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PanelVertex),
                         offset(offsetof(PanelVertex, position)));
  gl.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(PanelVertex),
                         offset(offsetof(PanelVertex, normal)));
  gl.VertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, sizeof(PanelVertex), offset(offsetof(PanelVertex, uv)));
  for (GLuint i = 0; i < 3; ++i) gl.EnableVertexAttribArray(i);
}

void ScenePainter::draw(const SceneFrame& frame, const Camera& camera, ColourMap map, Quality quality,
                        const Target& target, LeftOut& left_out) {
  view_projection_ = camera.projection * camera.view;
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Enable(GL_CULL_FACE);
  gl_.BlendEquation(GL_FUNC_ADD);
  upload(frame, camera, target.height, left_out);
  Lighting& lighting = this->lighting(quality);
  lighting.shadows.draw(low_, high_, floor_plane(frame, low_.z()), solid_mesh_, [this] { draw(solids_); });

  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.width, target.height);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_BLEND);
  backdrop_.use();
  backdrop_.set("u_dark", frame.dark ? 1 : 0);
  gl_.BindVertexArray(empty_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);

  bind(k_colour_unit, colour_maps_[static_cast<std::size_t>(map)]);
  lighting.shadows.bind();
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.Enable(GL_BLEND);
  draw_grounds(frame, camera, quality, target.height, left_out);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_CULL_FACE);
  use_lit(lighting.solid, lighting, camera);
  lighting.solid.set("u_colour_map", static_cast<int>(k_colour_unit));
  draw(solids_);
  draw_flat(shells_);
  gl_.Enable(GL_BLEND);
  draw_ghosts(camera);
  gl_.Disable(GL_CULL_FACE);
  draw_panels(camera);
  gl_.DepthMask(GL_FALSE);
  draw_flat(trails_);
  gl_.DepthMask(GL_TRUE);
  // Forces begin inside of members: what follows is seen through all that was drawn.
  if (bands_.count + arrows_.count > 0) gl_.Clear(GL_DEPTH_BUFFER_BIT);
  draw_flat(bands_);
  if (bands_.count > 0 && arrows_.count > 0) gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_CULL_FACE);
  use_lit(lighting.solid, lighting, camera);
  draw(arrows_);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(0);
}

void ScenePainter::upload(const SceneFrame& frame, const Camera& camera, int height, LeftOut& left_out) {
  solid_mesh_ = solid_mesh(frame, left_out);
  Mesh mesh = solid_mesh_;
  solids_ = {0, static_cast<std::uint32_t>(mesh.indices.size())};
  std::tie(low_, high_) = drawable_bounds(frame);
  for (const Vertex& vertex : mesh.vertices) {
    low_ = low_.cwiseMin(vertex.position);
    high_ = high_.cwiseMax(vertex.position);
  }
  ghosts_ = append(mesh, ghost_mesh(frame, left_out));
  const float pixel = 2 / (camera.projection(1, 1) * static_cast<float>(height));  // m at a metre
  const float unit = std::max(1.0f, static_cast<float>(height) / 720);
  if (frame.highlighted_body >= 0) {
    shells_ = append(mesh, shell_mesh(frame, camera.eye, k_body_outline * unit * pixel, k_outer_colour));
  } else {
    shells_ = append(mesh, shell_mesh(frame, camera.eye, k_inner_outline * unit * pixel, k_inner_colour));
    shells_.count +=
        append(mesh, shell_mesh(frame, camera.eye, k_outer_outline * unit * pixel, k_outer_colour)).count;
  }
  trails_ = append(mesh, trail_mesh(frame, camera.eye, k_trail * unit * pixel, left_out));
  bands_ = append(mesh, band_mesh(frame, camera.eye, k_band_outline * unit * pixel, left_out));
  arrows_ = append(mesh, arrow_mesh(frame, left_out));
  gl_.BindVertexArray(mesh_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, mesh_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)),
                 mesh.vertices.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(),
                 GL_STREAM_DRAW);
  const std::vector<PanelVertex> panels = panel_mesh(frame, camera.eye, left_out);
  panel_vertex_count_ = static_cast<GLsizei>(panels.size());
  gl_.BindBuffer(GL_ARRAY_BUFFER, panel_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(panels.size() * sizeof(PanelVertex)), panels.data(),
                 GL_STREAM_DRAW);
}

ScenePainter::Lighting::Lighting(const Gl& gl, std::string_view constants, const ShadowSize& size)
    : ground(gl, "ground.vert", {constants, "light.glsl", "ground.frag"}),
      solid(gl, "solid.vert", {constants, "light.glsl", "solid.frag"}),
      shadows(gl, constants, size) {}

ScenePainter::Lighting& ScenePainter::lighting(Quality quality) {
  std::unique_ptr<Lighting>& lighting = lightings_[static_cast<std::size_t>(quality)];
  if (lighting == nullptr) {
    lighting = quality == Quality::still
                   ? std::make_unique<Lighting>(gl_, "look_still.glsl", ShadowSize{2048, 1024})
                   : std::make_unique<Lighting>(gl_, "look_interactive.glsl", ShadowSize{1024, 256});
  }
  return *lighting;
}

void ScenePainter::draw_grounds(const SceneFrame& frame, const Camera& camera, Quality quality, int height,
                                LeftOut& left_out) {
  const Lighting& lighting = this->lighting(quality);
  const auto [low, high] = drawable_bounds(frame);
  use_lit(lighting.ground, lighting, camera);
  lighting.ground.set("u_focus", ((low + high) / 2).eval());
  lighting.ground.set("u_wall", wall_before_which_the_floor_lies(frame, camera.eye));
  lighting.ground.set("u_fade_radius", 2.2f * (high - low).norm());
  lighting.ground.set("u_line_width", std::max(1.0f, static_cast<float>(height) / 720));
  gl_.BindVertexArray(empty_array_.id());
  // Floors first: walls stand on them and fade out over them. A wall that hides the floor goes first
  // when pixels that are not seen should not be shaded.
  for (const bool first : {true, false}) {
    for (const Ground& ground : frame.grounds) {
      PlaneAxes axes;
      if (!plane_axes(ground, axes)) {
        left_out.grounds += first;
        continue;
      }
      const bool seen_from_behind = axes.normal.dot(camera.eye - Vector3f(ground.centre.data())) < 0;
      const bool early = quality == Quality::still ? ground.is_floor : !ground.is_floor && !seen_from_behind;
      if (early != first) continue;
      Vector2f half(ground.half_length, ground.half_width);
      const bool upright = std::abs(axes.normal.z()) < 0.5f;
      if (upright && std::abs(axes.along.z()) > std::abs(axes.across.z())) {
        std::swap(axes.along, axes.across);
        std::swap(half.x(), half.y());
      }
      if (upright && axes.across.z() < 0) axes.across = -axes.across;
      lighting.ground.set("u_centre", Vector3f(ground.centre.data()));
      lighting.ground.set("u_along", axes.along);
      lighting.ground.set("u_across", axes.across);
      lighting.ground.set("u_normal", axes.normal);
      lighting.ground.set("u_half", half);
      lighting.ground.set("u_grid_origin", Vector2f(0, upright ? -half.y() : 0));
      lighting.ground.set("u_dark", frame.dark ? 1 : 0);
      lighting.ground.set("u_is_floor", ground.is_floor ? 1.0f : 0.0f);
      lighting.ground.set("u_strength", seen_from_behind ? 0.3f : 1.0f);
      gl_.DepthMask(seen_from_behind ? GL_FALSE : GL_TRUE);
      gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
  gl_.DepthMask(GL_TRUE);
}

void ScenePainter::draw(const IndexRange& part) {
  if (part.count == 0) return;
  gl_.BindVertexArray(mesh_array_.id());
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.count), GL_UNSIGNED_INT,
                   offset(part.first * sizeof(std::uint32_t)));
}

/// In the vertices' own colours, without light.
void ScenePainter::draw_flat(const IndexRange& part) {
  outline_.use();
  outline_.set("u_view_projection", view_projection_);
  draw(part);
}

void ScenePainter::draw_ghosts(const Camera& camera) {
  ghost_.use();
  ghost_.set("u_view_projection", view_projection_);
  ghost_.set("u_eye", camera.eye);
  // A ghost that coincides with a body lies behind it.
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1, 5);
  // Its depth first, without colour, and then what lies a little before that: each pixel shows one of
  // the ghosts, the foremost.
  gl_.BlendFuncSeparate(GL_ZERO, GL_ONE, GL_ZERO, GL_ONE);
  draw(ghosts_);
  gl_.PolygonOffset(1, 4);
  gl_.DepthFunc(GL_LESS);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  draw(ghosts_);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void ScenePainter::draw_panels(const Camera& camera) {
  panel_.use();
  panel_.set("u_view_projection", view_projection_);
  panel_.set("u_eye", camera.eye);
  gl_.DepthMask(GL_FALSE);
  gl_.BindVertexArray(panel_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, panel_vertex_count_);
  gl_.DepthMask(GL_TRUE);
}

void ScenePainter::use_lit(const Program& program, const Lighting& lighting, const Camera& camera) {
  program.use();
  program.set("u_view_projection", view_projection_);
  program.set("u_eye", camera.eye);
  lighting.shadows.set(program);
}

void ScenePainter::bind(GLuint unit, const GlObject& texture) {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture.id());
}

}  // namespace topple::render
