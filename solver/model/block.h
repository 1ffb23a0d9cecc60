// Blocks: solid pieces without members.
#pragma once

#include <optional>
#include <string>

#include "solver/model/placement.h"

namespace topple {

/// A rigid box. It has the edges, corners and faces of a cabinet, so that it touches as one does, but no
/// strength: it is never elastic nor a frame (Body::solid).
struct BlockSpec : Placement {
  std::string name;
  Vec3 size{0.3, 0.3, 0.3};  ///< m, depth (x), width (y), height (z) between centre lines of edges, about
                             ///< which it rocks; its surface lies width/2 outside
  double mass = 1;           ///< kg
  Vec3 cg{0, 0, 0.15};       ///< m, centre of gravity from the middle of the base, in its own axes
  /// kg m^2 about the centre of gravity, in its own axes; none: that of a uniform block of this size about
  /// its middle, wherever the centre of gravity is.
  std::optional<Vec3> inertia;
  double width = 0;  ///< m, contact width of edges and faces; 0: contact_width_of()
};

/// Default of BlockSpec::width, m: a twentieth of the smallest side, at most 20 mm.
double contact_width_of(const Vec3& size);

/// Its inertia about its centre of gravity, kg m^2, along its own axes.
Vec3 inertia_of(const BlockSpec& spec);

/// Adds a block whose lowest edges touch the height of `at` with their surface. Its first node is its centre
/// of gravity and has all of the mass; its first two panels are its base and its top, corner above corner in
/// its own axes. Throws BuildError.
BodyStart add_block(Model& model, const BlockSpec& spec);

}  // namespace topple
