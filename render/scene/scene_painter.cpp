#include "render/scene/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "render/scene/drawable.h"

namespace topple::render {
namespace {

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
      ground_array_(make_vertex_array(gl)),
      ground_corners_(make_buffer(gl)),
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
  gl.BindVertexArray(ground_array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, ground_corners_.id());
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(Vector2f), offset(0));
  gl.EnableVertexAttribArray(0);
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
  bind(k_colour_unit, colour_maps_[static_cast<std::size_t>(map)]);
  lighting.shadows.bind();

  const Grounds grounds =
      grounds_of(frame, camera.eye, quality == Quality::interactive, lighting.shadows, left_out);
  gl_.BindBuffer(GL_ARRAY_BUFFER, ground_corners_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(grounds.corners.size() * sizeof(Vector2f)),
                 grounds.corners.data(), GL_STREAM_DRAW);
  for (const Program* program : {&lighting.ground, &lighting.shaded_ground}) {
    use_lit(*program, lighting, camera);
    program->set("u_focus", grounds.focus);
    program->set("u_fade_radius", grounds.fade_radius);
    program->set("u_wall", grounds.wall);
    program->set("u_line_width", std::max(1.0f, static_cast<float>(target.height) / 720));
    program->set("u_dark", frame.dark ? 1 : 0);
  }
  backdrop_.use();
  backdrop_.set("u_dark", frame.dark ? 1 : 0);

  gl_.Viewport(0, 0, target.width, target.height);
  gl_.Enable(GL_SCISSOR_TEST);
  PixelRect bodies{0, 0, target.width, target.height};
  if (target.samples != 0) {
    // The room has no edges but those that its shader draws smooth, so that it needs no samples.
    bodies = seen(target);
    const int top = bodies.bottom + bodies.height, right = bodies.left + bodies.width;
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    for (const PixelRect& around :
         {PixelRect{0, 0, target.width, bodies.bottom}, PixelRect{0, top, target.width, target.height - top},
          PixelRect{0, bodies.bottom, bodies.left, bodies.height},
          PixelRect{right, bodies.bottom, target.width - right, bodies.height}})
      draw_room(around, lighting, grounds);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.samples != 0 ? target.samples : target.framebuffer);
  // What bodies hide of the room need not be shaded, but for walls that one looks through from behind.
  const auto from_behind = [](const DrawnGround& ground) { return ground.seen_from_behind; };
  if (target.samples == 0 && std::none_of(grounds.grounds.begin(), grounds.grounds.end(), from_behind)) {
    draw_backdrop(bodies);
    draw_solids(lighting, camera);
    draw_grounds(lighting, grounds);
  } else {
    draw_room(bodies, lighting, grounds);
    draw_solids(lighting, camera);
  }
  draw_over_solids(lighting, camera);
  gl_.Disable(GL_SCISSOR_TEST);
  if (target.samples == 0) return;
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, target.samples);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  const int top = bodies.bottom + bodies.height, right = bodies.left + bodies.width;
  gl_.BlitFramebuffer(bodies.left, bodies.bottom, right, top, bodies.left, bodies.bottom, right, top,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void ScenePainter::draw_lit(const Program& program, const Lighting& lighting, const Camera& camera,
                            const IndexRange& part) {
  use_lit(program, lighting, camera);
  program.set("u_colour_map", static_cast<int>(k_colour_unit));
  draw(part);
}

void ScenePainter::draw_solids(const Lighting& lighting, const Camera& camera) {
  gl_.Enable(GL_CULL_FACE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  draw_lit(lighting.shaded_solid, lighting, camera, towards_light_);
  draw_lit(lighting.solid, lighting, camera, away_from_light_);
}

void ScenePainter::draw_over_solids(const Lighting& lighting, const Camera& camera) {
  gl_.Enable(GL_CULL_FACE);
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
  draw_lit(lighting.shaded_solid, lighting, camera, arrows_);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.BindVertexArray(0);
}

void ScenePainter::upload(const SceneFrame& frame, const Camera& camera, int height, LeftOut& left_out) {
  solid_mesh_ = solid_mesh(frame, left_out);
  mesh_ = solid_mesh_;
  solids_ = {0, static_cast<std::uint32_t>(mesh_.indices.size())};
  sort_by_light();
  std::tie(low_, high_) = drawable_bounds(frame);
  for (const Vertex& vertex : mesh_.vertices) {
    low_ = low_.cwiseMin(vertex.position);
    high_ = high_.cwiseMax(vertex.position);
  }
  ghosts_ = append(mesh_, ghost_mesh(frame, left_out));
  const float pixel = 2 / (camera.projection(1, 1) * static_cast<float>(height));  // m at a metre
  const float unit = std::max(1.0f, static_cast<float>(height) / 720);
  if (frame.highlighted_body >= 0) {
    shells_ = append(mesh_, shell_mesh(frame, camera.eye, k_body_outline * unit * pixel, k_outer_colour));
  } else {
    shells_ = append(mesh_, shell_mesh(frame, camera.eye, k_inner_outline * unit * pixel, k_inner_colour));
    shells_.count +=
        append(mesh_, shell_mesh(frame, camera.eye, k_outer_outline * unit * pixel, k_outer_colour)).count;
  }
  trails_ = append(mesh_, trail_mesh(frame, camera.eye, k_trail * unit * pixel, left_out));
  bands_ = append(mesh_, band_mesh(frame, camera.eye, k_band_outline * unit * pixel, left_out));
  arrows_ = append(mesh_, arrow_mesh(frame, left_out));
  gl_.BindVertexArray(mesh_array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, mesh_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh_.vertices.size() * sizeof(Vertex)),
                 mesh_.vertices.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh_.indices.size() * sizeof(std::uint32_t)), mesh_.indices.data(),
                 GL_STREAM_DRAW);
  panels_ = panel_mesh(frame, camera.eye, left_out);
  gl_.BindBuffer(GL_ARRAY_BUFFER, panel_vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(panels_.size() * sizeof(PanelVertex)),
                 panels_.data(), GL_STREAM_DRAW);
}

// Triangles that look away from the light need no shadow.
void ScenePainter::sort_by_light() {
  std::vector<std::uint32_t> away;
  std::vector<std::uint32_t>& indices = mesh_.indices;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const auto faces_it = [&](std::uint32_t vertex) {
      return Shadows::to_key().dot(mesh_.vertices[vertex].normal) > 0;
    };
    if (faces_it(indices[i]) || faces_it(indices[i + 1]) || faces_it(indices[i + 2])) {
      for (std::size_t k = i; k < i + 3; ++k) indices[kept++] = indices[k];
    } else {
      away.insert(away.end(), {indices[i], indices[i + 1], indices[i + 2]});
    }
  }
  std::copy(away.begin(), away.end(), indices.begin() + static_cast<std::ptrdiff_t>(kept));
  towards_light_ = {0, static_cast<std::uint32_t>(kept)};
  away_from_light_ = {towards_light_.count, static_cast<std::uint32_t>(away.size())};
}

ScenePainter::Lighting::Lighting(const Gl& gl, std::string_view constants, const ShadowSize& size)
    : ground(gl, "ground.vert", {constants, "unshaded.glsl", "light.glsl", "ground.frag"}),
      shaded_ground(gl, "ground.vert", {constants, "shaded.glsl", "light.glsl", "ground.frag"}),
      solid(gl, "solid.vert", {constants, "unshaded.glsl", "light.glsl", "solid.frag"}),
      shaded_solid(gl, "solid.vert", {constants, "shaded.glsl", "light.glsl", "solid.frag"}),
      shadows(gl, constants, size) {}

ScenePainter::Lighting& ScenePainter::lighting(Quality quality) {
  std::unique_ptr<Lighting>& lighting = lightings_[static_cast<std::size_t>(quality)];
  if (lighting == nullptr) {
    lighting = quality == Quality::still
                   ? std::make_unique<Lighting>(gl_, "look_still.glsl", ShadowSize{2048, 512, 256})
                   : std::make_unique<Lighting>(gl_, "look_interactive.glsl", ShadowSize{1024, 256, 128});
  }
  return *lighting;
}

ScenePainter::PixelRect ScenePainter::seen(const Target& target) const {
  const Vector2f size(target.width, target.height);
  Vector2f from = size, to = Vector2f::Zero();
  const auto take = [&](const Vector3f& position) {
    const Eigen::Vector4f clip = view_projection_ * position.homogeneous();
    const bool before = clip.w() > 0;  // what begins behind the eye may be anywhere
    const Vector2f at = ((clip.head<2>() / clip.w() + Vector2f::Ones()) / 2).cwiseProduct(size);
    from = from.cwiseMin(before ? at : Vector2f::Zero());
    to = to.cwiseMax(before ? at : size);
  };
  for (const Vertex& vertex : mesh_.vertices) take(vertex.position);
  for (const PanelVertex& vertex : panels_) take(vertex.position);
  from = (from.array().floor() - 1).max(0.0f).min(size.array());
  to = (to.array().ceil() + 1).min(size.array()).max(from.array());
  const Eigen::Vector2i low = from.cast<int>(), sides = to.cast<int>() - low;
  return {low.x(), low.y(), sides.x(), sides.y()};
}

void ScenePainter::draw_room(const PixelRect& part, const Lighting& lighting, const Grounds& grounds) {
  draw_backdrop(part);
  if (part.width > 0 && part.height > 0) draw_grounds(lighting, grounds);
}

void ScenePainter::draw_backdrop(const PixelRect& part) {
  gl_.Scissor(part.left, part.bottom, part.width, part.height);
  if (part.width == 0 || part.height == 0) return;
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_BLEND);
  gl_.BindVertexArray(empty_array_.id());
  backdrop_.use();
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void ScenePainter::draw_grounds(const Lighting& lighting, const Grounds& grounds) {
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.Enable(GL_BLEND);
  gl_.BindVertexArray(ground_array_.id());
  for (const DrawnGround& ground : grounds.grounds) {
    gl_.DepthMask(ground.seen_from_behind ? GL_FALSE : GL_TRUE);
    draw_tiles(lighting.ground, ground, ground.lit);
    draw_tiles(lighting.shaded_ground, ground, ground.shaded);
  }
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

void ScenePainter::draw_tiles(const Program& program, const DrawnGround& ground, const IndexRange& tiles) {
  if (tiles.count == 0) return;
  program.use();
  program.set("u_centre", ground.centre);
  program.set("u_along", ground.along);
  program.set("u_across", ground.across);
  program.set("u_normal", ground.normal);
  program.set("u_half", ground.half);
  program.set("u_grid_origin", ground.grid_origin);
  program.set("u_is_floor", ground.is_floor ? 1.0f : 0.0f);
  program.set("u_strength", ground.seen_from_behind ? 0.3f : 1.0f);
  gl_.DrawArrays(GL_TRIANGLES, static_cast<GLint>(tiles.first), static_cast<GLsizei>(tiles.count));
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
  gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(panels_.size()));
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
