#include "render/scene/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {
namespace {

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto p = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.vertices[mesh.indices[i + k]].position.cast<double>();
    };
    sum += p(0).dot(p(1).cross(p(2))) / 6;
  }
  return sum;
}

SceneFrame one_beam(const Profile& profile) {
  SceneFrame frame;
  frame.profiles = {profile};
  add_beam(frame, {0.3f, -1, 0.2f}, {0.9f, 1, 0.7f}, {0, 0, 0}, 0, 1, 0);
  return frame;
}

TEST(Mesh, swept_section_is_closed_and_holds_area_times_length) {
  const double length = std::sqrt(0.6 * 0.6 + 4 + 0.25);
  LeftOut left_out;
  const Profile l_section{{{0, 0}, {0.05f, 0}, {0.05f, 0.01f}, {0.01f, 0.01f}, {0.01f, 0.04f}, {0, 0.04f}},
                          false};
  const double l_area = 0.05 * 0.01 + 0.01 * 0.03;
  EXPECT_NEAR(volume(solid_mesh(one_beam(box_profile(0.02f)), left_out)), 0.04 * 0.04 * length, 1e-8);
  EXPECT_NEAR(volume(solid_mesh(one_beam(l_section), left_out)), l_area * length, 1e-8);
  EXPECT_EQ(left_out.total(), 0);
}

TEST(Mesh, outline_drawn_clockwise_is_turned) {
  Profile clockwise = box_profile(0.02f);
  std::reverse(clockwise.outline.begin(), clockwise.outline.end());
  LeftOut left_out;
  EXPECT_GT(volume(solid_mesh(one_beam(clockwise), left_out)), 0);
}

TEST(Mesh, lead_and_trail_draw_the_section_on) {
  SceneFrame frame = one_beam(box_profile(0.02f));
  frame.tubes[0].lead = 0.1f;
  frame.tubes[0].trail = 0.3f;
  LeftOut left_out;
  const double length = std::sqrt(0.6 * 0.6 + 4 + 0.25) + 0.4;
  EXPECT_NEAR(volume(solid_mesh(frame, left_out)), 0.04 * 0.04 * length, 1e-8);
}

TEST(Mesh, a_ring_is_a_torus_and_one_without_axis_or_size_is_left_out) {
  SceneFrame frame;
  frame.rings.push_back({{1, 2, 3}, {0, 0, 5}, 0.1f, {1, 0.5f, 0, 1}});
  LeftOut left_out;
  // 2 pi^2 R r^2, less what 40 x 10 facets cut off: 1 - sin(2 pi/n)/(2 pi/n) of each circle
  const double torus = 2 * 9.8696 * 0.1 * 0.013 * 0.013;
  EXPECT_NEAR(volume(solid_mesh(frame, left_out)), torus, 0.08 * torus);
  EXPECT_EQ(left_out.total(), 0);
  frame.rings = {
      {{0, 0, 0}, {0, 0, 0}, 0.1f, {}}, {{0, 0, 0}, {0, 0, 1}, 0, {}}, {{NAN, 0, 0}, {0, 0, 1}, 0.1f, {}}};
  EXPECT_TRUE(solid_mesh(frame, left_out).vertices.empty());
  EXPECT_EQ(left_out.rings, 3);
}

TEST(Mesh, a_ring_that_turns_is_open_and_its_arrow_head_points_along_the_turn) {
  SceneFrame frame;
  frame.rings.push_back({{0, 0, 0}, {0, 0, 1}, 0.1f, {1, 0.5f, 0, 1}, true});
  LeftOut left_out;
  const Mesh mesh = solid_mesh(frame, left_out);
  double turns = 0;  // the last vertices are those of the head: foot and tip in turn
  for (std::size_t i = mesh.vertices.size() - 48; i < mesh.vertices.size(); i += 3) {
    const Eigen::Vector3f foot = mesh.vertices[i].position, tip = mesh.vertices[i + 1].position;
    turns += foot.cross(tip).z();
  }
  EXPECT_GT(turns, 0);
  frame.rings[0].axis = {0, 0, -1};
  const Mesh other = solid_mesh(frame, left_out);
  turns = 0;
  for (std::size_t i = other.vertices.size() - 48; i < other.vertices.size(); i += 3)
    turns += other.vertices[i].position.cross(other.vertices[i + 1].position).z();
  EXPECT_LT(turns, 0);
  EXPECT_EQ(left_out.total(), 0);
}

TEST(Mesh, a_torn_end_stands_back_in_teeth_and_is_closed) {
  SceneFrame frame = one_beam(box_profile(0.02f));
  LeftOut left_out;
  const double whole = volume(solid_mesh(frame, left_out));
  const std::size_t vertices = solid_mesh(frame, left_out).vertices.size();
  frame.tubes[0].torn_last = 0.01f;
  const Mesh torn = solid_mesh(frame, left_out);
  EXPECT_EQ(torn.vertices.size(), vertices);
  float least = 1e9f, most = -1e9f;
  for (std::size_t i = vertices - 4; i < vertices; ++i) {  // its cap
    const float along = torn.vertices[i].position.dot(torn.vertices[i].normal);
    least = std::min(least, along);
    most = std::max(most, along);
    EXPECT_NE(torn.vertices[i].rgba, 0u);
  }
  EXPECT_NEAR(most - least, 0.01f, 1e-6f);
  EXPECT_LT(volume(torn), whole);
  // two of four corners stand back: a third or two thirds of the teeth's depth is gone, by the cap's diagonal
  EXPECT_NEAR((whole - volume(torn)) / (0.01 * 0.04 * 0.04), 0.5, 0.17);
}

TEST(Mesh, lines_face_the_eye_and_fade_with_their_strength) {
  SceneFrame frame;
  frame.trails.push_back({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 0.5f, 1}, {0, 0, 1, 1}});
  const Eigen::Vector3f eye(1, -10, 0);
  LeftOut left_out;
  const Mesh mesh = trail_mesh(frame, eye, 0.01f, left_out);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.indices.size(), 12u);
  EXPECT_NEAR((mesh.vertices[3].position - mesh.vertices[2].position).norm(), 0.1f, 1e-4f);  // 10 m away
  EXPECT_EQ(mesh.vertices[0].rgba >> 24, 0u);
  EXPECT_EQ(mesh.vertices[5].rgba >> 24, 255u);
  frame.trails.push_back({{{0, 0, 0}, {NAN, 0, 0}}, {1, 1}, {0, 0, 1, 1}});
  frame.trails.push_back({{{0, 0, 0}, {1, 0, 0}}, {1}, {0, 0, 1, 1}});
  frame.bands.push_back({{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}}, {1, 0, 0, 1}});
  EXPECT_EQ(trail_mesh(frame, eye, 0.01f, left_out).vertices.size(), 6u);
  EXPECT_TRUE(band_mesh(frame, eye, 0.01f, left_out).vertices.empty());
  EXPECT_EQ(left_out.trails, 2);
  EXPECT_EQ(left_out.bands, 1);
}

TEST(Mesh, every_triangle_faces_the_way_its_normals_point) {
  SceneFrame frame = synthetic_cabinet(6);
  add_words(frame);
  LeftOut left_out;
  const Mesh mesh = solid_mesh(frame, left_out);
  ASSERT_GT(mesh.indices.size(), 3000u);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto v = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]]; };
    const Eigen::Vector3f faces = (v(1).position - v(0).position).cross(v(2).position - v(0).position);
    if (faces.norm() < 1e-12f) continue;
    const Eigen::Vector3f normal = v(0).normal + v(1).normal + v(2).normal;
    ASSERT_GT(faces.normalized().dot(normal.normalized()), 0.7f) << "triangle " << i / 3;
  }
}

TEST(Mesh, tubes_that_point_outside_the_arrays_are_left_out) {
  for (int kind = 0; kind < 4; ++kind) {
    SceneFrame frame = one_beam(box_profile(0.02f));
    if (kind == 0) frame.tubes[0].profile = 7;
    if (kind == 1) frame.tubes[0].station_count = 1000;
    if (kind == 2) frame.tubes[0].first_station = 0xfffffff0u;
    if (kind == 3) frame.tubes[0].station_count = 1;
    LeftOut left_out;
    EXPECT_TRUE(solid_mesh(frame, left_out).vertices.empty()) << "kind " << kind;
    EXPECT_EQ(left_out.tubes, 1) << "kind " << kind;
  }
}

TEST(Mesh, panels_come_farthest_first) {
  const SceneFrame frame = synthetic_cabinet(0);
  const Eigen::Vector3f eye(0, 0, 5);
  LeftOut left_out;
  const std::vector<PanelVertex> vertices = panel_mesh(frame, eye, left_out);
  ASSERT_EQ(vertices.size(), 6 * frame.panels.size());
  for (std::size_t i = 6; i < vertices.size(); i += 6) {
    EXPECT_GE(vertices[i].position.z(), vertices[i - 6].position.z());
  }
}

}  // namespace
}  // namespace topple::render
