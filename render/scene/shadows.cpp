#include "render/scene/shadows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace topple::render {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

/// Margin of the contact map around the bodies, m: as far as their contact shade reaches.
constexpr float k_contact_margin = 0.2f;

constexpr GLuint k_key_unit = 1;
constexpr GLuint k_contact_unit = 2;
constexpr GLuint k_near_unit = 3;

constexpr int k_coarse_side = 256;  // of the maps of what is near the floor, or between it and light, texels
/// Of the key map, that light.glsl looks aside, with a texel's slack.
constexpr float k_shadow_reach = 8.0f / 2048;
constexpr float k_contact_high = 0.38f;  // m, above which contact.frag has nothing that eight bits hold

/// Orthographic matrix with the rows x, y, z as axes; the box low..high in these becomes -1..1.
Matrix4f box_matrix(const Matrix3f& rows, const Vector3f& low, const Vector3f& high) {
  Matrix4f m = Matrix4f::Identity();
  for (int i = 0; i < 3; ++i) {
    const float scale = 2 / (high[i] - low[i]);
    m.block<1, 3>(i, 0) = scale * rows.row(i);
    m(i, 3) = -scale * (high[i] + low[i]) / 2;
  }
  return m;
}

/// The box low..high seen along the axes of `rows`.
std::pair<Vector3f, Vector3f> turned_box(const Matrix3f& rows, const Vector3f& low, const Vector3f& high) {
  const Vector3f middle = rows * ((low + high) / 2);
  const Vector3f half = rows.cwiseAbs() * ((high - low) / 2);
  return {middle - half, middle + half};
}

/// Texels from the corner of a coarse map.
Eigen::Vector2f on_coarse_map(const Matrix4f& to_map, const Vector3f& place) {
  return (to_map.topLeftCorner<2, 3>() * place + to_map.topRightCorner<2, 1>() + Eigen::Vector2f::Ones()) *
         (k_coarse_side / 2.0f);
}

void bind_to(const Gl& gl, GLuint unit, const GlObject& texture) {
  gl.ActiveTexture(GL_TEXTURE0 + unit);
  gl.BindTexture(GL_TEXTURE_2D, texture.id());
}

}  // namespace

// From the left of the named views and above, so that shadows fall away from the viewer.
const Vector3f& Shadows::to_key() {
  static const Vector3f direction = Vector3f(-0.28f, -0.52f, 1.0f).normalized();
  return direction;
}

Shadows::Shadows(const Gl& gl, std::string_view constants, const ShadowSize& size)
    : gl_(gl),
      size_(size),
      key_program_(gl, "shadow.vert", {"shadow.frag"}),
      contact_program_(gl, "shadow.vert", {"contact.frag"}),
      shade_program_(gl, "whole.vert", {constants, "contact_shade.frag"}),
      key_map_(make_texture(gl, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, size.key, size.key,
                            nullptr)),
      key_target_(make_framebuffer(gl)),
      contact_target_(make_framebuffer(gl)),
      shade_target_(make_framebuffer(gl)),
      empty_array_(make_vertex_array(gl)) {
  gl.BindTexture(GL_TEXTURE_2D, key_map_.id());
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  contact_map_ =
      make_texture(gl, {GL_RG8, GL_RG, GL_UNSIGNED_BYTE, true}, size.contact, size.contact, nullptr);

  near_map_ = make_texture(gl, {GL_R8, GL_RED, GL_UNSIGNED_BYTE}, k_coarse_side, k_coarse_side, nullptr);

  gl.BindFramebuffer(GL_FRAMEBUFFER, key_target_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, key_map_.id(), 0);
  const GLenum none = GL_NONE;
  gl.DrawBuffers(1, &none);
  check_framebuffer(gl, "shadow map");
  gl.BindFramebuffer(GL_FRAMEBUFFER, contact_target_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, contact_map_.id(), 0);
  check_framebuffer(gl, "contact map");
  shade_map_ = make_texture(gl, {GL_R8, GL_RED, GL_UNSIGNED_BYTE}, size.shade, size.shade, nullptr);
  gl.BindFramebuffer(GL_FRAMEBUFFER, shade_target_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, shade_map_.id(), 0);
  check_framebuffer(gl, "contact shade");
}

void Shadows::draw(const Vector3f& low, const Vector3f& high, const FloorPlane& floor, const Mesh& solids,
                   const std::function<void()>& draw_solids) {
  set_up_key(low, high);
  draw_solids();
  set_up_contact(low, high, floor);
  draw_solids();
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.Disable(GL_BLEND);
  bind_to(gl_, k_contact_unit, contact_map_);
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  constexpr float k_any = std::numeric_limits<float>::infinity();
  near_ = marked(contact_matrix_, k_contact_margin / contact_width_, {floor, k_contact_high}, solids);
  casters_ = marked(key_matrix_, k_shadow_reach, {floor, k_any}, solids);
  nearest_to_light_ = k_any;
  for (const Vertex& vertex : solids.vertices)
    nearest_to_light_ = std::min(nearest_to_light_, -to_key().dot(vertex.position));
  shade_contact();
}

std::vector<std::uint8_t> Shadows::marked(const Matrix4f& to_map, float margin, const Highest& highest,
                                          const Mesh& solids) {
  constexpr float side = k_coarse_side;
  std::vector<std::uint8_t> marked(std::size_t{k_coarse_side} * k_coarse_side);
  std::vector<Vector3f> places;  // of the vertices: on the map, and over the floor
  places.reserve(solids.vertices.size());
  for (const Vertex& vertex : solids.vertices) {
    const Vector3f& x = vertex.position;
    const Eigen::Vector2f at = on_coarse_map(to_map, x);
    places.emplace_back(at.x(), at.y(), highest.floor.normal.dot(x - highest.floor.point));
  }
  for (std::size_t i = 0; i + 2 < solids.indices.size(); i += 3) {
    const Vector3f &a = places[solids.indices[i]], &b = places[solids.indices[i + 1]],
                   &c = places[solids.indices[i + 2]];
    const Vector3f from = a.cwiseMin(b).cwiseMin(c), to = a.cwiseMax(b).cwiseMax(c);
    if (from.z() >= highest.height) continue;
    const auto texel = [](float at) { return std::clamp(static_cast<int>(at), 0, k_coarse_side - 1); };
    for (int y = texel(from.y() - side * margin); y <= texel(to.y() + side * margin); ++y)
      for (int x = texel(from.x() - side * margin); x <= texel(to.x() + side * margin); ++x)
        marked[static_cast<std::size_t>(k_coarse_side * y + x)] = 255;
  }
  return marked;
}

bool Shadows::may_fall_on(const std::array<Vector3f, 4>& places) const {
  const bool behind = std::any_of(places.begin(), places.end(), [&](const Vector3f& place) {
    return -to_key().dot(place) > nearest_to_light_;
  });
  return (behind && any_marked(casters_, key_matrix_, places)) || any_marked(near_, contact_matrix_, places);
}

bool Shadows::any_marked(const std::vector<std::uint8_t>& marked, const Matrix4f& to_map,
                         const std::array<Vector3f, 4>& places) {
  constexpr float side = k_coarse_side;
  Eigen::Vector2f from(side, side), to(-1, -1);
  for (const Vector3f& place : places) {
    const Eigen::Vector2f at = on_coarse_map(to_map, place);
    from = from.cwiseMin(at);
    to = to.cwiseMax(at);
  }
  // a texel around, as far as linear filtering reaches
  const auto first = [](float at) {
    return static_cast<int>(std::clamp(at - 1, 0.0f, float{k_coarse_side}));
  };
  const auto last = [](float at) {
    return static_cast<int>(std::clamp(at + 1, -1.0f, k_coarse_side - 1.0f));
  };
  for (int y = first(from.y()); y <= last(to.y()); ++y)
    for (int x = first(from.x()); x <= last(to.x()); ++x)
      if (marked[static_cast<std::size_t>(k_coarse_side * y + x)] != 0) return true;
  return false;
}

void Shadows::set_up_key(const Vector3f& low, const Vector3f& high) {
  Matrix3f rows;
  rows.row(2) = -to_key();  // depth grows away from the light
  rows.row(0) = Vector3f::UnitZ().cross(to_key()).normalized();
  rows.row(1) = Vector3f(rows.row(0)).cross(Vector3f(rows.row(2)));
  // lit texels at the edges, which what lies beyond them gets
  const Vector3f margin = Vector3f::Constant(std::max(0.02f, 2e-3f * (high - low).norm()));
  const auto [from, to] = turned_box(rows, low - margin, high + margin);
  key_matrix_ = box_matrix(rows, from, to);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, key_target_.id());
  gl_.Viewport(0, 0, size_.key, size_.key);
  gl_.DepthMask(GL_TRUE);
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthFunc(GL_LESS);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5f, 4.0f);
  key_program_.use();
  key_program_.set("u_view_projection", key_matrix_);
}

void Shadows::set_up_contact(const Vector3f& low, const Vector3f& high, const FloorPlane& floor) {
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  Matrix3f rows;
  rows << floor.along.transpose(), floor.across.transpose(), floor.normal.transpose();
  const auto [from, to] = turned_box(rows, low, high);
  contact_width_ = std::max(to.x() - from.x(), to.y() - from.y()) + 2 * k_contact_margin;
  const Vector3f middle = (from + to) / 2;
  const Vector3f half = Vector3f::Constant(contact_width_ / 2);
  contact_matrix_ = box_matrix(rows, middle - half, middle + half);

  gl_.BindFramebuffer(GL_FRAMEBUFFER, contact_target_.id());
  gl_.Viewport(0, 0, size_.contact, size_.contact);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);  // the undersides, which nothing else shows, are the nearest
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_MAX);  // the lowest point above each place counts
  contact_program_.use();
  Matrix4f flat = contact_matrix_;
  flat.row(2).setZero();  // so that nothing is cut off above or below
  contact_program_.set("u_view_projection", flat);
  contact_program_.set("u_up", floor.normal);
  contact_program_.set("u_floor", floor.point);
}

// Once for each place on the floor, and not for each of the pixels that show it.
void Shadows::shade_contact() {
  bind_to(gl_, k_near_unit, near_map_);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, k_coarse_side, k_coarse_side, 0, GL_RED, GL_UNSIGNED_BYTE,
                 near_.data());
  gl_.BindFramebuffer(GL_FRAMEBUFFER, shade_target_.id());
  gl_.Viewport(0, 0, size_.shade, size_.shade);
  gl_.Disable(GL_DEPTH_TEST);
  shade_program_.use();
  shade_program_.set("u_contact", static_cast<int>(k_contact_unit));
  shade_program_.set("u_near", static_cast<int>(k_near_unit));
  shade_program_.set("u_contact_size", contact_width_);
  gl_.BindVertexArray(empty_array_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

void Shadows::bind() const {
  bind_to(gl_, k_key_unit, key_map_);
  bind_to(gl_, k_contact_unit, shade_map_);
}

void Shadows::set(const Program& program) const {
  program.set("u_to_key", to_key());
  program.set("u_shadow", static_cast<int>(k_key_unit));
  program.set("u_shadow_matrix", key_matrix_);
  program.set("u_contact", static_cast<int>(k_contact_unit));
  program.set("u_contact_matrix", contact_matrix_);
}

}  // namespace topple::render
