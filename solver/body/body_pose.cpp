#include "solver/body/body_pose.h"

#include <cmath>

#include "solver/math/elementary.h"
#include "solver/math/rotation.h"

namespace topple {

BodyPose body_pose(const Model& model, const State& state, int index) {
  const Body& body = model.bodies[index];
  if (const BodyState& s = state.bodies[index]; s.level != ModelLevel::frame) return {s.position, s.rotation};
  BodyPose pose;
  pose.centre.setZero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    pose.centre += model.node_mass[i] * state.position[i];
  pose.centre /= body.mass;
  Mat3 a = Mat3::Zero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    a += model.node_mass[i] * (state.position[i] - pose.centre) *
         (model.node_position[i] - body.centre_of_gravity).transpose();
  // Rotation closest to the moment matrix by torque-like corrections (Müller et al. 2016) from the first
  // node's own; bodies on one line keep that node's twist.
  pose.rotation = state.rotation[body.first_node];
  for (int pass = 0; pass < 20; ++pass) {
    const Mat3 r = pose.rotation.toRotationMatrix();
    Vec3 torque = Vec3::Zero();
    double size = 0;
    for (int k = 0; k < 3; ++k) {
      torque += r.col(k).cross(a.col(k));
      size += r.col(k).dot(a.col(k));
    }
    if (!(std::abs(size) > 0)) break;
    const Vec3 spin = torque / std::abs(size);
    pose.rotation = exp_quaternion(spin) * pose.rotation;
    pose.rotation.normalize();
    if (spin.norm() < 1e-14) break;
  }
  return pose;
}

double tilt(const BodyPose& pose) {
  const Vec3 up = pose.rotation * Vec3::UnitZ();
  return elementary::atan2(up.head<2>().norm(), up.z());
}

BodyMomentum body_momentum(const Model& model, const State& state, int index) {
  const Body& body = model.bodies[index];
  if (const BodyState& s = state.bodies[index]; s.level != ModelLevel::frame)
    return {s.velocity, s.rotation * (body.inertia * s.angular_velocity)};
  BodyMomentum out{Vec3::Zero(), Vec3::Zero()};
  Vec3 centre = Vec3::Zero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    centre += model.node_mass[i] * state.position[i] / body.mass;
    out.velocity += model.node_mass[i] * state.velocity[i] / body.mass;
  }
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    out.angular_momentum +=
        model.node_mass[i] * (state.position[i] - centre).cross(state.velocity[i] - out.velocity) +
        state.rotation[i] * (model.node_inertia[i] * state.angular_velocity[i]);
  return out;
}

}  // namespace topple
