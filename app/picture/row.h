// What a recorded row says of one node or element.
#pragma once

#include "render/scene/scene_frame.h"
#include "solver/element/section_forces.h"
#include "solver/io/recording/observer.h"
#include "solver/model/model.h"

namespace topple::app {

inline constexpr std::uint8_t k_broken = 3;  ///< FrameRow::hinge

inline Vec3 position(const io::FrameRow& row, int node) {
  return {row.position[3 * node], row.position[3 * node + 1], row.position[3 * node + 2]};
}

inline Quat rotation(const io::FrameRow& row, int node) {
  const float* q = &row.rotation[4 * node];
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

/// m, from the floor's frame to the picture's.
inline Vec3 floor_shift(const io::FrameRow& row) {
  return Vec3(row.floor_displacement);
}

/// m, of a body, in the picture's frame.
inline Eigen::Vector3f centre_of(const io::FrameRow& row, std::size_t body) {
  return (row.body[body].centre() + floor_shift(row)).cast<float>();
}

inline render::Float3 to_float(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Section forces of element `e` at xi in -1..1 along it.
SectionForces forces_at(const Model& model, const io::FrameRow& row, std::size_t e, double xi);

/// An element as it is drawn: between its nodes a cubic with their directions at its ends, its section
/// turning evenly.
struct ElementCurve {
  Vec3 x1, x2;    ///< m, of the nodes, in the picture's frame
  Quat q1, q2;    ///< local axes there
  double length;  ///< m, reference

  Vec3 place(double t) const;  ///< t in 0..1
  Quat axes(double t) const { return q1.slerp(t, q2); }
};
ElementCurve element_curve(const Model& model, const io::FrameRow& row, std::size_t e);

}  // namespace topple::app
