#include "render/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "render/drawable.h"

namespace topple::render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int k_shadow_side = 2048;
constexpr int k_contact_side = 1024;

/// Margin of the contact map around the bodies, m: as far as their contact shade reaches.
constexpr float k_contact_margin = 0.2f;

// From the left of the named views and above, so that shadows fall away from the viewer.
const Vector3f k_to_key = Vector3f(-0.28f, -0.52f, 1.0f).normalized();

constexpr GLuint k_colour_unit = 0;
constexpr GLuint k_shadow_unit = 1;
constexpr GLuint k_contact_unit = 2;

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

/// Orthographic matrix with the rows x, y, z as axes; the box low..high in these becomes -1..1.
Matrix4f box_matrix(const Eigen::Matrix3f& rows, const Vector3f& low, const Vector3f& high) {
  Matrix4f m = Matrix4f::Identity();
  for (int i = 0; i < 3; ++i) {
    const float scale = 2 / (high[i] - low[i]);
    m.block<1, 3>(i, 0) = scale * rows.row(i);
    m(i, 3) = -scale * (high[i] + low[i]) / 2;
  }
  return m;
}

/// The box low..high seen along the axes of `rows`.
std::pair<Vector3f, Vector3f> turned_box(const Eigen::Matrix3f& rows, const Vector3f& low,
                                         const Vector3f& high) {
  const Vector3f middle = rows * ((low + high) / 2);
  const Vector3f half = rows.cwiseAbs() * ((high - low) / 2);
  return {middle - half, middle + half};
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
      backdrop_(gl, "backdrop.vert", {"backdrop.frag"}),
      ground_(gl, "ground.vert", {"light.glsl", "ground.frag"}),
      solid_(gl, "solid.vert", {"light.glsl", "solid.frag"}),
      panel_(gl, "panel.vert", {"panel.frag"}),
      shadow_(gl, "shadow.vert", {"shadow.frag"}),
      contact_(gl, "shadow.vert", {"contact.frag"}),
      mesh_array_(make_vertex_array(gl)),
      mesh_vertices_(make_buffer(gl)),
      mesh_indices_(make_buffer(gl)),
      panel_array_(make_vertex_array(gl)),
      panel_vertices_(make_buffer(gl)),
      empty_array_(make_vertex_array(gl)),
      shadow_map_(make_texture(gl, {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT}, k_shadow_side,
                               k_shadow_side, nullptr)),
      contact_map_(),
      shadow_target_(make_framebuffer(gl)),
      contact_target_(make_framebuffer(gl)) {
  gl.BindTexture(GL_TEXTURE_2D, shadow_map_.id());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const float lit[] = {1, 1, 1, 1};
  gl.TexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
  contact_map_ =
      make_texture(gl, {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, true}, k_contact_side, k_contact_side, nullptr);

  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow_target_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_map_.id(), 0);
  const GLenum none = GL_NONE;
  gl.DrawBuffers(1, &none);
  check_framebuffer(gl, "shadow map");
  gl.BindFramebuffer(GL_FRAMEBUFFER, contact_target_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, contact_map_.id(), 0);
  check_framebuffer(gl, "contact map");

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

void ScenePainter::draw(const SceneFrame& frame, const Camera& camera, ColourMap map, const Target& target,
                        LeftOut& left_out) {
  view_projection_ = camera.projection * camera.view;
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Enable(GL_CULL_FACE);
  gl_.BlendEquation(GL_FUNC_ADD);
  upload(frame, camera, left_out);
  draw_key_shadow();
  draw_contact_map(frame);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.width, target.height);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_BLEND);
  backdrop_.use();
  gl_.BindVertexArray(empty_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);

  bind(k_colour_unit, colour_maps_[static_cast<std::size_t>(map)]);
  bind(k_shadow_unit, shadow_map_);
  bind(k_contact_unit, contact_map_);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.Enable(GL_BLEND);
  draw_grounds(frame, camera, target.height, left_out);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_CULL_FACE);
  solid_.use();
  set_light(solid_, camera);
  solid_.set("u_colour_map", static_cast<int>(k_colour_unit));
  draw_solids();
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  draw_panels(camera);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(0);
}

void ScenePainter::upload(const SceneFrame& frame, const Camera& camera, LeftOut& left_out) {
  mesh_ = solid_mesh(frame, left_out);
  std::tie(low_, high_) = drawable_bounds(frame);
  for (const Vertex& vertex : mesh_.vertices) {
    low_ = low_.cwiseMin(vertex.position);
    high_ = high_.cwiseMax(vertex.position);
  }
  gl_.BindVertexArray(mesh_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, mesh_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh_.vertices.size() * sizeof(Vertex)),
                 mesh_.vertices.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh_.indices.size() * sizeof(std::uint32_t)), mesh_.indices.data(),
                 GL_STREAM_DRAW);
  const std::vector<PanelVertex> panels = panel_mesh(frame, camera.eye, left_out);
  panel_vertex_count_ = static_cast<GLsizei>(panels.size());
  gl_.BindBuffer(GL_ARRAY_BUFFER, panel_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(panels.size() * sizeof(PanelVertex)), panels.data(),
                 GL_STREAM_DRAW);
}

void ScenePainter::draw_key_shadow() {
  Eigen::Matrix3f rows;
  rows.row(2) = -k_to_key;  // depth grows away from the light
  rows.row(0) = Vector3f::UnitZ().cross(k_to_key).normalized();
  rows.row(1) = Vector3f(rows.row(0)).cross(Vector3f(rows.row(2)));
  const Vector3f margin = Vector3f::Constant(0.02f);
  const auto [low, high] = turned_box(rows, low_ - margin, high_ + margin);
  shadow_matrix_ = box_matrix(rows, low, high);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, shadow_target_.id());
  gl_.Viewport(0, 0, k_shadow_side, k_shadow_side);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5f, 4.0f);
  shadow_.use();
  shadow_.set("u_view_projection", shadow_matrix_);
  draw_solids();
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
}

void ScenePainter::draw_contact_map(const SceneFrame& frame) {
  PlaneAxes axes{Vector3f::UnitX(), Vector3f::UnitY(), Vector3f::UnitZ()};
  contact_plane_.point = {0, 0, low_.z()};
  for (const Ground& ground : frame.grounds) {
    if (ground.is_floor && plane_axes(ground, axes)) {
      contact_plane_.point = Vector3f(ground.centre.data());
      break;
    }
  }
  contact_plane_.normal = axes.normal;
  Eigen::Matrix3f rows;
  rows << axes.along.transpose(), axes.across.transpose(), axes.normal.transpose();
  const auto [low, high] = turned_box(rows, low_, high_);
  contact_plane_.size = std::max(high.x() - low.x(), high.y() - low.y()) + 2 * k_contact_margin;
  const Vector3f middle = (low + high) / 2;
  const Vector3f half = Vector3f::Constant(contact_plane_.size / 2);
  contact_plane_.to_map = box_matrix(rows, middle - half, middle + half);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, contact_target_.id());
  gl_.Viewport(0, 0, k_contact_side, k_contact_side);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);  // the undersides, which nothing else shows, are the nearest
  gl_.Enable(GL_DEPTH_CLAMP);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_MAX);  // the lowest point above each place counts
  contact_.use();
  contact_.set("u_view_projection", contact_plane_.to_map);
  contact_.set("u_up", contact_plane_.normal);
  contact_.set("u_floor", contact_plane_.point);
  draw_solids();
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_DEPTH_CLAMP);
  bind(k_contact_unit, contact_map_);
  gl_.GenerateMipmap(GL_TEXTURE_2D);
}

void ScenePainter::draw_grounds(const SceneFrame& frame, const Camera& camera, int height,
                                LeftOut& left_out) {
  const auto [low, high] = drawable_bounds(frame);
  ground_.use();
  set_light(ground_, camera);
  ground_.set("u_contact", static_cast<int>(k_contact_unit));
  ground_.set("u_contact_matrix", contact_plane_.to_map);
  ground_.set("u_contact_size", contact_plane_.size);
  ground_.set("u_focus", ((low + high) / 2).eval());
  ground_.set("u_wall", wall_before_which_the_floor_lies(frame, camera.eye));
  ground_.set("u_fade_radius", 2.2f * (high - low).norm());
  ground_.set("u_line_width", std::max(1.0f, static_cast<float>(height) / 720));
  gl_.BindVertexArray(empty_array_.id());
  // Floors first: walls stand on them and fade out over them.
  for (const bool floors : {true, false}) {
    for (const Ground& ground : frame.grounds) {
      if (ground.is_floor != floors) continue;
      PlaneAxes axes;
      if (!plane_axes(ground, axes)) {
        ++left_out.grounds;
        continue;
      }
      Vector2f half(ground.half_length, ground.half_width);
      const bool upright = std::abs(axes.normal.z()) < 0.5f;
      if (upright && std::abs(axes.along.z()) > std::abs(axes.across.z())) {
        std::swap(axes.along, axes.across);
        std::swap(half.x(), half.y());
      }
      if (upright && axes.across.z() < 0) axes.across = -axes.across;
      const bool seen_from_behind = axes.normal.dot(camera.eye - Vector3f(ground.centre.data())) < 0;
      ground_.set("u_centre", Vector3f(ground.centre.data()));
      ground_.set("u_along", axes.along);
      ground_.set("u_across", axes.across);
      ground_.set("u_normal", axes.normal);
      ground_.set("u_half", half);
      ground_.set("u_grid_origin", Vector2f(0, upright ? -half.y() : 0));
      ground_.set("u_is_floor", ground.is_floor ? 1.0f : 0.0f);
      ground_.set("u_strength", seen_from_behind ? 0.12f : 1.0f);
      gl_.DepthMask(seen_from_behind ? GL_FALSE : GL_TRUE);
      gl_.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
  }
  gl_.DepthMask(GL_TRUE);
}

void ScenePainter::draw_solids() {
  gl_.BindVertexArray(mesh_array_.id());
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh_.indices.size()), GL_UNSIGNED_INT, nullptr);
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

void ScenePainter::set_light(const Program& program, const Camera& camera) {
  program.set("u_view_projection", view_projection_);
  program.set("u_eye", camera.eye);
  program.set("u_to_key", k_to_key);
  program.set("u_shadow", static_cast<int>(k_shadow_unit));
  program.set("u_shadow_matrix", shadow_matrix_);
  program.set("u_shadow_texel", 1.0f / k_shadow_side);
}

void ScenePainter::bind(GLuint unit, const GlObject& texture) {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture.id());
}

}  // namespace topple::render
