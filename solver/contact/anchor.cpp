#include "solver/contact/anchor.h"

#include "solver/math/rotation.h"

namespace topple {

namespace {

// From the other end to the attached point; of a strap that is a pin without what presses the point down.
Vec3 stretched(const Anchor& anchor, const AnchorState& state, const Vec3& at, const Vec3& to) {
  Vec3 d = at - to;
  if (anchor.type == Anchor::Type::strap && state.length == 0 && d.z() < 0) d.z() = 0;
  return d;
}

}  // namespace

bool holds(const Anchor& anchor, const AnchorState& state, double length) {
  if (state.hold != AnchorHold::in_place) return false;
  return anchor.type == Anchor::Type::bracket ||
         (anchor.type == Anchor::Type::strap ? length > state.length : length < state.length);
}

AnchorForce anchor_force(const Anchor& anchor, const AnchorState& state, const Vec3& at, const Vec3& to) {
  const Vec3 d = stretched(anchor, state, at, to);
  const double length = d.norm();
  if (!holds(anchor, state, length)) return {};
  const double stretch = length - state.length, tension = anchor.stiffness * stretch;
  AnchorForce out{tension, tension * stretch / 2, Vec3::Zero()};
  if (length > 0) out.force = -tension / length * d;
  return out;
}

Mat3 anchor_tangent(const Anchor& anchor, const AnchorState& state, const Vec3& at, const Vec3& to) {
  const Vec3 d = stretched(anchor, state, at, to);
  const double length = d.norm();
  if (state.length == 0 && state.hold == AnchorHold::in_place) {
    Mat3 pin = -anchor.stiffness * Mat3::Identity();
    if (anchor.type == Anchor::Type::strap && at.z() < to.z()) pin(2, 2) = 0;
    return pin;
  }
  if (!holds(anchor, state, length)) return Mat3::Zero();
  if (!(length > 0)) return Mat3::Zero();
  const Mat3 along = d * d.transpose() / (length * length);
  const double across = anchor.stiffness * (length - state.length) / length;
  return -anchor.stiffness * along - across * (Mat3::Identity() - along);
}

Mat6 anchor_slope(const Mat3& tangent, const Vec3& arm, const Vec3& force) {
  const Mat3 lever = skew(arm);
  Mat6 slope;
  slope.topLeftCorner<3, 3>() = tangent;
  slope.topRightCorner<3, 3>() = -tangent * lever;
  slope.bottomLeftCorner<3, 3>() = lever * tangent;
  slope.bottomRightCorner<3, 3>() = skew(force) * lever - lever * tangent * lever;
  return slope;
}

}  // namespace topple
