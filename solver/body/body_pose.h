// A body as a rigid one.
#pragma once

#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Pose of a body as a rigid one, floor's frame: of a frame the mass-weighted best fit of its nodes (Kabsch),
/// found by the iteration of Müller et al. 2016.
struct BodyPose {
  Vec3 centre;    ///< m, centre of gravity
  Quat rotation;  ///< reference to current
};
BodyPose body_pose(const Model& model, const State& state, int body);

/// Momentum of a body, in the floor's frame.
struct BodyMomentum {
  Vec3 velocity;          ///< m/s, of the centre of gravity
  Vec3 angular_momentum;  ///< kg m^2/s, about the centre of gravity
};
BodyMomentum body_momentum(const Model& model, const State& state, int body);

/// Angle between the body's vertical axis now and in its reference pose, rad, 0..pi.
double tilt(const BodyPose& pose);

}  // namespace topple
