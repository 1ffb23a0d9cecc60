// The camera moved by hand: orbit about a point, zoom and pan.
#pragma once

#include <span>

#include <Eigen/Core>

#include "render/scene/camera.h"
#include "render/scene/scene_frame.h"

namespace topple::render {

/// A camera on a sphere about its target. Whatever moves it leaves it finite and within its limits:
/// elevation -60 to 90 degrees, distance 0.02 to 20 times the size of the scene, target at most 5
/// sizes away from the scene's middle. A movement by numbers that are not finite is ignored.
/// Pixel coordinates are those of the scene's region, from its upper left corner.
struct Orbit {
  Eigen::Vector3f target{0, 0, 1};  ///< m
  float distance = 8;               ///< from target to eye, m
  Sight sight{0, 0};                ///< direction from target to eye
  Eigen::Vector3f middle{0, 0, 1};  ///< of the frame's bounds, m
  float size = 3;                   ///< diagonal of the frame's bounds, m

  /// The named view with the frame's whole bounds in the region, for its aspect width / height; the
  /// direction and the lens are those of fit_camera.
  static Orbit fit(NamedView view, const SceneFrame& frame, float aspect);

  /// Other bounds, from which limits and clipping planes come; what is seen stays as it is.
  void set_bounds(const SceneFrame& frame);

  /// Drags the scene by dx px to the right and dy px down: 200 px are about 70 degrees.
  void rotate(float dx, float dy);

  /// Moves what is seen at the target's depth by dx px to the right and dy px down, in a region of
  /// `height` px.
  void pan(float dx, float dy, float height);

  /// Goes nearer by `factor` (> 1) or away (< 1); the point at the target's depth that is seen at x, y
  /// px stays where it is.
  void zoom(float factor, float x, float y, float width, float height);

  /// Moves aside and goes back by `share` (0..1) of what is missing for all points to be seen, with a margin;
  /// called again and again it gets there. Nothing moves while all are seen, or where one is not finite.
  /// aspect: as of camera().
  void keep(std::span<const Eigen::Vector3f> points, float aspect, float share);

  /// From which a region of `aspect` shows all that is seen from here in one of `seen`, of what is within the
  /// bounds; aspects as of camera().
  float distance_for(float aspect, float seen) const;

  /// aspect: width / height of the region, > 0.
  Camera camera(float aspect) const;

  /// On the way from a (u = 0) to b (u = 1), slow at both ends, the shorter way round.
  static Orbit between(const Orbit& a, const Orbit& b, float u);
};

}  // namespace topple::render
