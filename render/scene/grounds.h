// Floors and walls, cut into tiles by whether shadows may fall on them.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "render/scene/mesh.h"
#include "render/scene/scene_frame.h"
#include "render/scene/shadows.h"

namespace topple::render {

/// A floor or wall as it is drawn.
struct DrawnGround {
  Eigen::Vector3f centre;                 ///< m
  Eigen::Vector3f along, across, normal;  ///< unit; across is upwards on a wall
  Eigen::Vector2f half;                   ///< m, along and across
  Eigen::Vector2f grid_origin;            ///< m likewise, from the centre
  bool is_floor = true;
  bool seen_from_behind = false;
  IndexRange lit, shaded;  ///< corners of tiles where no shadow can fall, and where one may
};

/// In the order in which they are drawn.
struct Grounds {
  std::vector<DrawnGround> grounds;
  std::vector<Eigen::Vector2f> corners;  ///< m along and across; three a triangle
  Eigen::Vector3f focus;                 ///< middle of the frame's bounds, m
  float fade_radius;                     ///< m from there, where nothing is left of them
  /// Plane (normal, offset) of the first wall that is seen from its face, where the floor ends; one that is
  /// never reached when there is none.
  Eigen::Vector4f wall;
};

/// `shadows` are those of the frame. walls_first: a wall that hides the floor is drawn before it, for speed,
/// instead of fading out over it. Counts what has no plane or no area in `left_out`.
Grounds grounds_of(const SceneFrame& frame, const Eigen::Vector3f& eye, bool walls_first,
                   const Shadows& shadows, LeftOut& left_out);

/// The first floor that has a plane; a level one at `height` when there is none.
FloorPlane floor_plane(const SceneFrame& frame, float height);

}  // namespace topple::render
