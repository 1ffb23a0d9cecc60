// Where a cabinet or a block stands or lies, and how it starts.
#pragma once

#include "solver/model/model.h"

namespace topple {

/// Of a box whose own axes begin at the middle of its base: x to its front, y across, z up.
struct Placement {
  enum class Pose { upright, on_back, on_front, on_side };
  /// Where it touches planes: at its eight corners, as Housner's block does, or at the middles of edges and
  /// faces too, which take a part of each landing.
  enum class Base { corners, edges };
  Vec3 at = Vec3::Zero();  ///< m, point of the floor below the middle of the posed box
  double yaw = 0;          ///< rad
  Pose pose = Pose::upright;
  double tilt = 0;               ///< rad, about the bottom edge on the +x side before yaw; negative: -x side
  Vec3 velocity = Vec3::Zero();  ///< m/s, as in BodyStart
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, likewise
  Base base = Base::corners;
};

/// How a box stands or lies.
struct PoseTraits {
  Placement::Pose kind;
  const char* word;   ///< in scenes
  double turn[3][3];  ///< from upright, about the axes of the box
};
/// A new one is a Placement::Pose and a row here.
inline constexpr PoseTraits k_poses[] = {
    {Placement::Pose::upright, "upright", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    {Placement::Pose::on_back, "on-back", {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}},
    {Placement::Pose::on_front, "on-front", {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}},
    {Placement::Pose::on_side, "on-side", {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}},
};

/// From the box's own axes to the world's.
struct Placing {
  Mat3 rotation;
  Vec3 offset;
  Vec3 operator()(const Vec3& x) const { return rotation * x + offset; }
};

/// Of a box of this size between the centre lines of its edges, whose lowest ones touch the height of `at`
/// with a surface width/2 outside; m.
Placing place(const Placement& of, const Vec3& size, double width);

/// How a body placed so starts: tilted about the lowest edge of its nodes on the side of the tilt.
BodyStart start_of(const Placement& of, const Model& model, const Body& body);

}  // namespace topple
