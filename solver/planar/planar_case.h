// A body of a model as a planar block, and where it cannot be one.
//
// The penalty force holds back the centre line of a contact point at half its width over the floor's face, so
// that with infinitely stiff contacts a body rocks about the nodes of its base: the planar floor lies that
// much over the face.
#pragma once

#include <optional>
#include <span>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/planar/integrator.h"
#include "solver/planar/sprung_base.h"

namespace topple::planar {

/// Why a body is no planar block.
enum class Obstacle {
  none,
  floor,      ///< no level plane under it, or gravity not straight down
  held,       ///< supports, loads, pulls or anchors
  base,       ///< no flat base of one contact width
  law,        ///< the contact law has no limit of stiff contacts in which friction holds and impacts end
  direction,  ///< it is shaken, moved or tilted out of one vertical plane
  stands,     ///< does not begin on the floor
  symmetry,   ///< about that plane: contact points, products of inertia
  edge,       ///< the base ends in one point to a side
  early,      ///< another contact point meets the floor before it has overturned
  near,       ///< a wall or body is within its fall
  jump        ///< the floor's velocity jumps upward or downward
};

/// An Obstacle is an enumerator and a row of the table in planar_case.cpp.
struct ObstacleTraits {
  Obstacle kind;
  const char* word;
  const char* phrase;  ///< "a wall or body is within its fall"
};
const ObstacleTraits& traits(Obstacle obstacle);

/// A block and the motion that it begins with.
struct PlanarCase {
  Block block;
  State start;         ///< x: from below the centre of gravity in the reference pose, along `along`
  Vec3 along, across;  ///< unit, horizontal; a tilt is a rotation about `across`
  Vec3 origin;         ///< m, world: x = z = 0
  int floor = -1;      ///< index into Model::planes
  Controls controls;   ///< last_tilt: at which another contact point meets the floor, on either side
  double farthest;     ///< m, |x| of the centre of gravity up to which nothing else is within reach

  /// Contacts have a restitution e > 0, of which the block knows nothing. What bounces on an edge keeps its
  /// angular momentum about it, so that Housner's ratio is left once it has come to rest there; but it moves
  /// meanwhile. Rigid bodies with e = 0.5, which on stiff contacts have a limit of their own, differ by 0.004
  /// critical angles after four impacts of one that is let go, by 0.05 under a sine.
  bool bounces = false;

  double critical(Side side) const;  ///< rad, at which the centre of gravity stands above this edge
};

/// Of a body that starts so. `obstacle`, if asked for: why there is none. Model levels, integrators, wanted
/// accuracy and the penalty coefficient are the caller's to look at.
std::optional<PlanarCase> planar_case(const Model& model, const Parameters& parameters,
                                      std::span<const BodyStart> starts, int body,
                                      Obstacle* obstacle = nullptr);

/// The base of a body whose motion is along this horizontal unit vector, from left to right.
std::vector<BaseLine> base_lines(const Model& model, int body, const Vec3& along);

/// How a body moves: its centre of gravity, m, and the rotation vector from its reference pose, rad; m/s,
/// rad/s; world.
struct RigidMotion {
  Vec3 centre, rotation, velocity, angular_velocity;
};
/// The same of a body that moves so. `centres`: of gravity of all bodies, m; empty: walls and other bodies
/// are the caller's to look at.
std::optional<PlanarCase> planar_case(const Model& model, const Parameters& parameters,
                                      const RigidMotion& motion, std::span<const Vec3> centres, int body,
                                      Obstacle* obstacle = nullptr);
/// The same of one that moves along this horizontal unit vector already; its state is not looked at, nor are
/// walls and other bodies.
std::optional<PlanarCase> planar_case_along(const Model& model, const Parameters& parameters,
                                            const Vec3& along, int body, Obstacle* obstacle = nullptr);
/// Its block whatever stands in the way by now.
PlanarCase block_along(const Model& model, const Parameters& parameters, const Vec3& along, int body);

/// As body_pose(): of the centre of gravity, m, floor's frame, and from the reference pose.
struct Pose {
  Vec3 centre;
  Quat rotation;
};
Pose pose(const PlanarCase& of, const State& state, const Turned& known = {});

}  // namespace topple::planar
