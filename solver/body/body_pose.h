// A body as a rigid one.
#pragma once

#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Pose of a body as a rigid one: mass-weighted best fit of its nodes (Kabsch/Horn).
struct BodyPose {
  Vec3 centre;    ///< m, centre of gravity
  Quat rotation;  ///< reference to current
};
BodyPose body_pose(const Model& model, const State& state, int body);

/// Momentum of a body.
struct BodyMomentum {
  Vec3 velocity;          ///< m/s, of the centre of gravity
  Vec3 angular_momentum;  ///< kg m^2/s, about the centre of gravity, world axes
};
BodyMomentum body_momentum(const Model& model, const State& state, int body);

/// Angle between the body's vertical axis now and in its reference pose, rad, 0..pi.
double tilt(const BodyPose& pose);

}  // namespace topple
