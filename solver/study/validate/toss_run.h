// A tossed cube computed, and how far from the measured one it ends.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "solver/study/validate/toss_data.h"

namespace topple::study {

/// What is fitted once for all tosses.
struct CubeContact {
  double friction = 0, restitution = 0;
};
/// As the authors of the data state them.
inline constexpr CubeContact k_published{0.18, 0.125};

/// The cube of the rigid model from the first row of a toss on, at the times of its rows; the board lies
/// `offset` (m) over z = 0. Empty: gave up, or the run failed.
std::vector<CubePose> computed_toss(const Toss& toss, const CubeContact& contact, double offset,
                                    const std::function<bool()>& give_up);

/// Instants after the first row at which errors are told, s.
inline constexpr std::array k_instants{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0};

/// A computed toss against the measured one.
struct TossErrors {
  double place = 0;                ///< m, of the last place
  double place_share = 0;          ///< of how far the cube went, horizontally
  bool face = false;               ///< the same one is up at the end
  double yaw = 0;                  ///< rad, about the vertical at the end; of those with the right face
  double rest = 0;                 ///< s, of the time to rest
  double position = 0, angle = 0;  ///< m and rad, means over time
  std::vector<double> position_at, angle_at;  ///< at k_instants; behind the last row: of that
};
/// `computed` has a pose for each row.
TossErrors errors_of(const Toss& toss, const std::vector<CubePose>& computed);

/// Face that is up: 2 axis + (turned over), 0..5.
int face_up(const Quat& rotation);
/// s, from which on it stays within 2 mm and 2 deg of its last pose.
double time_to_rest(const std::vector<CubePose>& rows);

}  // namespace topple::study
