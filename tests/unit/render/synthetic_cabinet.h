// A cabinet made for pictures: a slightly bent box frame on a floor before a wall, without mechanics.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "render/scene/scene_frame.h"

namespace topple::render {

inline constexpr float k_cabinet_depth = 0.45f;
inline constexpr float k_cabinet_width = 0.90f;
inline constexpr float k_cabinet_height = 1.80f;
inline constexpr float k_post_half = 0.016f;

inline Profile box_profile(float half) {
  return {{{-half, -half}, {half, -half}, {half, half}, {-half, half}}, false};
}

inline Profile pipe_profile(float radius) {
  Profile pipe;
  pipe.smooth = true;
  for (int i = 0; i < 20; ++i) {
    const float angle = 2 * 3.14159265f * static_cast<float>(i) / 20;
    pipe.outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return pipe;
}

/// Adds a beam of `stations` points from a to b that is bowed by `sag`, m, in the middle, with a
/// value that runs from `value_a` to `value_b`.
inline void add_beam(SceneFrame& frame, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                     const Eigen::Vector3f& sag, float value_a, float value_b, std::uint32_t profile,
                     float closing = 0, int stations = 9) {
  Tube tube;
  tube.first_station = static_cast<std::uint32_t>(frame.stations.size());
  tube.station_count = static_cast<std::uint32_t>(stations);
  tube.profile = profile;
  tube.member = static_cast<std::uint32_t>(frame.tubes.size());
  tube.lead = tube.trail = closing;
  const auto at = [&](float s) -> Eigen::Vector3f { return a + s * (b - a) + 4 * s * (1 - s) * sag; };
  for (int i = 0; i < stations; ++i) {
    const float s = static_cast<float>(i) / static_cast<float>(stations - 1);
    const Eigen::Vector3f x = (at(s + 0.01f) - at(s - 0.01f)).normalized();
    const Eigen::Vector3f reference =
        std::abs(x.z()) > 0.8f ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
    const Eigen::Vector3f y = reference.cross(x).normalized();
    Eigen::Matrix3f turn;
    turn << x, y, x.cross(y);
    const Eigen::Quaternionf q(turn);
    const Eigen::Vector3f p = at(s);
    frame.stations.push_back(
        {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}, value_a + s * (value_b - value_a)});
  }
  frame.tubes.push_back(tube);
}

/// The cabinet tipped by `degrees` about its edge at greatest x and raised by `lift`, m.
inline SceneFrame synthetic_cabinet(float degrees, float lift = 0) {
  using Eigen::Vector3f;
  SceneFrame frame;
  frame.profiles = {box_profile(k_post_half), box_profile(0.010f), pipe_profile(0.008f)};
  const float d = k_cabinet_depth / 2;
  const float w = k_cabinet_width / 2;
  const float angle = degrees * 3.14159265f / 180;
  const Vector3f edge(d + k_post_half, 0, 0);
  const Eigen::AngleAxisf tip(angle, Vector3f::UnitY());
  const auto place = [&](const Vector3f& p) -> Vector3f {
    return tip * (p - edge) + edge + Vector3f(0, 0, lift);
  };
  const auto stress = [&](const Vector3f& p) {
    return 25 + 190 * std::exp(-1.6f * p.z()) * (0.35f + 0.65f * (p.x() / d + 1) / 2);
  };
  const auto join = [&](const Vector3f& a, const Vector3f& b, const Vector3f& sag, std::uint32_t profile,
                        float closing) {
    add_beam(frame, place(a), place(b), tip * sag, stress(a), stress(b), profile, closing);
  };
  constexpr int k_levels = 6;  // 24 nodes on the posts, one in the middle of the back, one of the top
  const auto level = [&](int i) {
    return k_post_half + (k_cabinet_height - 2 * k_post_half) * static_cast<float>(i) / (k_levels - 1);
  };
  for (const float x : {-d, d}) {
    for (const float y : {-w, w}) {
      for (int i = 0; i + 1 < k_levels; ++i) {
        const float closing = i == 0 || i + 2 == k_levels ? k_post_half : 0;
        join({x, y, level(i)}, {x, y, level(i + 1)}, {0.004f, 0, 0}, 0, closing);
      }
    }
  }
  for (int i = 0; i < k_levels; ++i) {
    const float z = level(i);
    for (const float side : {-1.0f, 1.0f}) {
      join({side * d, -w, z}, {side * d, w, z}, {0, 0, -0.010f}, i == 0 || i + 1 == k_levels ? 0 : 1, 0);
      join({-d, side * w, z}, {d, side * w, z}, {0, 0, -0.003f}, i == 0 || i + 1 == k_levels ? 0 : 1, 0);
    }
  }
  const Vector3f back_middle(-d, 0, k_cabinet_height / 2);
  for (const float y : {-w, w}) {
    join({-d, y, level(0)}, back_middle, Vector3f::Zero(), 2, 0);
    join({-d, y, level(k_levels - 1)}, back_middle, Vector3f::Zero(), 2, 0);
    join({-d, y, level(0)}, {d, y, level(2)}, Vector3f::Zero(), 2, 0);
    join({-d, y, level(3)}, {d, y, level(5)}, Vector3f::Zero(), 2, 0);
  }
  join({-d, -w, level(5)}, {0, 0, level(5)}, {0, 0, 0}, 2, 0);
  join({d, w, level(5)}, {0, 0, level(5)}, {0, 0, 0}, 2, 0);
  for (int i = 0; i < k_levels; i += 1) {  // shelves
    Panel panel;
    const std::array<Vector3f, 4> corners{Vector3f(-d, -w, level(i)), Vector3f(d, -w, level(i)),
                                          Vector3f(d, w, level(i)), Vector3f(-d, w, level(i))};
    for (std::size_t c = 0; c < 4; ++c) {
      const Vector3f p = place(corners[c]);
      panel.corners[c] = {p.x(), p.y(), p.z()};
    }
    frame.panels.push_back(panel);
  }
  frame.grounds.push_back({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 4, 4, true});
  frame.grounds.push_back({{-0.55f, 0, 1.25f}, {1, 0, 0}, {0, 1, 0}, 2.5f, 1.25f, false});
  frame.bounds_min = {-0.50f, -0.55f, 0};
  frame.bounds_max = {0.65f, 0.55f, 1.95f};
  return frame;
}

/// Words, legend, trace and arrows for it.
inline void add_words(SceneFrame& frame) {
  frame.caption.title = "Steel cabinet on a 20th floor, 1995 record × 1.2";
  frame.caption.lines = {"t = 12.48 s    floor −182 gal, 34 cm/s", "rocking, 6.0° of 14.0°"};
  frame.caption.note =
      "26 nodes, linear Timoshenko elements, α = 10⁶ N, μ = 0.30; deformation × 1; contents as added mass";
  frame.legend = {"von Mises stress", "MPa", "whole run", 0, 270, false, 235, "yield 235"};
  frame.trace.label = "floor acceleration, gal";
  for (int i = 0; i <= 2000; ++i) {
    const float t = 0.015f * static_cast<float>(i);
    frame.trace.at.push_back(t);
    frame.trace.value.push_back(330 * std::exp(-0.012f * (t - 11) * (t - 11)) *
                                (std::sin(5.1f * t) + 0.4f * std::sin(13.7f * t + 1)));
  }
  frame.trace.cursor = 12.48f;
  frame.arrows.push_back({{0.245f, -0.45f, 0.005f}, {0.17f, -0.45f, 0.42f}, {0.83f, 0.33f, 0.13f, 1}});
  frame.arrows.push_back({{0.245f, 0.45f, 0.005f}, {0.17f, 0.45f, 0.36f}, {0.83f, 0.33f, 0.13f, 1}});
}

}  // namespace topple::render
