// Vocabulary types of the solver.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace topple {

using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Quat = Eigen::Quaterniond;

inline constexpr double k_pi = 3.14159265358979323846;
inline constexpr double k_standard_gravity = 9.80665;  ///< m/s^2; also 1 kgf in N
inline constexpr double k_gal = 0.01;                  ///< 1 gal in m/s^2
/// In SI units. What is larger in a state or in parameters counts as infinite: legal values stay far below.
inline constexpr double k_largest_number = 1e30;

}  // namespace topple
