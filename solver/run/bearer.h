// What bodies stand on.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "solver/body/body_pose.h"
#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

inline constexpr double k_hangs = 1e-3;   ///< m, gap from which on a body hangs above what is below it
inline constexpr double k_top_of = 0.05;  ///< m, by which what bears a body reaches above its bottom at most

/// Between which heights the members of a body lie, contact widths included, m.
struct Heights {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};
/// position: per node of the model, as everywhere here.
Heights heights(const Model& model, std::span<const Vec3> position, int body);

/// The highest of what lies below a body in plan.
struct Below {
  int body = -1;                                          ///< -1: the floor, or nothing
  double top = -std::numeric_limits<double>::infinity();  ///< m, may be above the bottom of the body
  double aside = 0;  ///< m, of the centre of gravity, in plan; 0: above it, or on two
};
/// floor: there is one, at z = 0.
Below below(const Model& model, std::span<const Vec3> position, int body, bool floor);

/// The piece of furniture on which a body stands: below it in plan, with its top within k_top_of of the
/// bottom of the body. -1: none.
int bearer_of(const Model& model, std::span<const Vec3> position, int body);

/// What bears a body at the start.
struct Bearer {
  int body;    ///< piece that it stands on, upright or leaning with it; -1: the floor, or nothing
  Vec3 place;  ///< m, middle of the base of the body, in the reference axes of the piece or in the floor's
               ///< frame
};
/// Of every body.
std::vector<Bearer> bearers_of(const Model& model, const std::vector<BodyStart>& starts);

/// poses[bearer]; of -1, the floor, that of its frame.
BodyPose bearer_pose(std::span<const BodyPose> poses, int bearer);
/// Where the middle of the base of a body is on its bearer, as Bearer::place. pose, on: of the two now.
Vec3 place_on(const Model& model, int body, const BodyPose& pose, int bearer, const BodyPose& on);

}  // namespace topple
