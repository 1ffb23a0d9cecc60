#include "solver/model/placement.h"

#include <algorithm>
#include <cmath>

#include "solver/math/rotation.h"

namespace topple {

Placing place(const Placement& of, const Vec3& size, double width) {
  Mat3 pose;
  for (int k = 0; k < 3; ++k) pose.row(k) = Eigen::RowVector3d(row_of(k_poses, of.pose).turn[k]);
  const Vec3 half = size / 2;
  const Vec3 posed_half = (pose * half).cwiseAbs();
  const Mat3 rotation = exp_quaternion(of.yaw * Vec3::UnitZ()).toRotationMatrix() * pose;
  // local z runs from 0 to the height: turn about the box's middle
  return {rotation, of.at + Vec3(0, 0, posed_half.z() + width / 2) - rotation * Vec3(0, 0, half.z())};
}

BodyStart start_of(const Placement& of, const Model& model, const Body& body) {
  BodyStart start;
  start.velocity = of.velocity;
  start.angular_velocity = of.angular_velocity;
  if (of.tilt == 0) return start;
  const Quat yaw = exp_quaternion(of.yaw * Vec3::UnitZ());
  double reach = 0, lowest = 1e300;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    const Vec3 x = yaw.conjugate() * (model.node_position[i] - Vec3(of.at.x(), of.at.y(), 0));
    reach = std::max(reach, std::abs(x.x()));
    lowest = std::min(lowest, x.z());
  }
  start.pivot = Vec3(of.at.x(), of.at.y(), lowest) + yaw * Vec3(std::copysign(reach, of.tilt), 0, 0);
  start.rotation = yaw * Vec3(0, of.tilt, 0);
  return start;
}

}  // namespace topple
