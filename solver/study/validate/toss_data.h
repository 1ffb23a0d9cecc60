// Measured tosses of a cube onto a board: position, rotation and velocities at 148 Hz.
//
// A folder has tosses.csv or tosses.csv.gz. S. Pfrommer, M. Halm, M. Posa, ContactNets: Learning
// Discontinuous Contact Dynamics with Smooth, Implicit Representations, CoRL 2020; repository
// DAIRLab/contact-nets, BSD-3-Clause, copyright (c) 2020, Dynamic Autonomy and Intelligent Robotics Lab.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/math/types.h"

namespace topple::study {

/// The cube as its authors have it.
struct TossedCube {
  static constexpr double half_edge = 0.0524;  ///< m
  static constexpr double mass = 0.370;        ///< kg
  static constexpr double inertia = 0.00081;   ///< kg m^2, about any axis through its middle
};

/// Where and how a cube is at an instant; the board is at z = 0 but for the data's offset.
struct CubePose {
  double time = 0;  ///< s, since the first row
  Vec3 place;       ///< m, of its middle
  Quat rotation;    ///< body to world
};

struct Toss {
  int number = 0;
  std::vector<CubePose> rows;
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  ///< of the first row; m/s, rad/s, world
};

/// Throws io::InputError "FILE:LINE: ..." on what is not of this form: a column that is missing, times that
/// do not rise within a toss, rows of a toss apart from each other, a rotation that is no unit quaternion,
/// first rows that do not move as their velocities say.
std::vector<Toss> read_tosses(const std::filesystem::path& folder);

/// Median height of the cubes' middles at their last rows over half an edge, m: what the data's zero is off
/// the board.
double offset_of(const std::vector<Toss>& tosses);

}  // namespace topple::study
