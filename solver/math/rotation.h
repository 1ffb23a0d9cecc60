// Rotations in space: exponential, logarithm and the tangent of the exponential.
#pragma once

#include <cmath>

#include "solver/math/elementary.h"
#include "solver/math/types.h"

namespace topple {

/// [v]: skew(v) w = v x w.
inline Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Coefficients of the exponential and of its left Jacobian T, exp(psi + dpsi) = exp(T dpsi) exp(psi), with
/// a = |psi|, x = a^2:
///   exp [psi] = I + f0 [psi] + f1 [psi]^2,  T = I + f1 [psi] + f2 [psi]^2
///   f0 = sin a / a,  f1 = (1 - cos a)/a^2,  f2 = (a - sin a)/a^3;  df1, df2: their derivatives by x.
/// Taylor series below a = 0.3, where the closed forms cancel.
struct ExpCoefficients {
  double f0, f1, f2, df1, df2;
  explicit ExpCoefficients(double x) {
    if (x < 0.09) {
      f0 = 1 + x * (-1. / 6 + x * (1. / 120 + x * (-1. / 5040 + x * (1. / 362880 - x / 39916800))));
      f1 = 0.5 + x * (-1. / 24 + x * (1. / 720 + x * (-1. / 40320 + x * (1. / 3628800 - x / 479001600))));
      f2 = 1. / 6 + x * (-1. / 120 + x * (1. / 5040 + x * (-1. / 362880 + x * (1. / 39916800))));
      df1 = -1. / 24 + x * (1. / 360 + x * (-1. / 13440 + x * (1. / 907200 - x / 95800320)));
      df2 = -1. / 120 + x * (1. / 2520 + x * (-1. / 120960 + x * (1. / 9979200)));
    } else {
      const double a = std::sqrt(x), s = elementary::sin(a), c = elementary::cos(a);
      f0 = s / a;
      f1 = (1 - c) / x;
      f2 = (a - s) / (a * x);
      df1 = (f0 - 2 * f1) / (2 * x);
      df2 = (f1 - 3 * f2) / (2 * x);
    }
  }
};

/// exp [psi] as a unit quaternion; psi: rad.
inline Quat exp_quaternion(const Vec3& psi) {
  const double x = psi.squaredNorm() / 4;  // of the half angle
  double cosine, sinc;
  if (x < 0.01) {
    const double x2 = x * x;
    cosine = (1 - 0.5 * x) + x2 * ((1. / 24 - 1. / 720 * x) + 1. / 40320 * x2);
    sinc = (1 - 1. / 6 * x) + x2 * ((1. / 120 - 1. / 5040 * x) + 1. / 362880 * x2);
  } else {
    const double a = std::sqrt(x);
    cosine = elementary::cos(a);
    sinc = elementary::sin(a) / a;
  }
  return Quat(cosine, 0.5 * sinc * psi.x(), 0.5 * sinc * psi.y(), 0.5 * sinc * psi.z());
}

/// Rotation vector psi of a unit quaternion, rad, |psi| <= pi.
inline Vec3 log_quaternion(const Quat& rotation) {
  Quat q = rotation;
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double s2 = q.vec().squaredNorm(), x = s2 / (q.w() * q.w());
  if (x < 0.01) {  // atan z / z in x = z^2
    const double series =
        1 +
        x * (-1. / 3 + x * (1. / 5 + x * (-1. / 7 + x * (1. / 9 + x * (-1. / 11 + x * (1. / 13 - x / 15))))));
    return 2 / q.w() * series * q.vec();
  }
  const double s = std::sqrt(s2);
  return 2 * elementary::atan2(s, q.w()) / s * q.vec();
}

/// g of T^-1 = I - [psi]/2 + g [psi]^2, T as above, and its derivative by x = a^2; a = |psi| < 2 pi.
///   g = (1 - (a/2) cot(a/2)) / a^2, with (a/2) cot(a/2) = f0 / (2 f1).
struct InverseJacobianCoefficient {
  double g, dg;
  explicit InverseJacobianCoefficient(double x) {
    if (x < 0.09) {
      g = 1. / 12 + x * (1. / 720 + x * (1. / 30240 + x * (1. / 1209600 + x * (1. / 47900160))));
      dg = 1. / 720 + x * (1. / 15120 + x * (1. / 403200 + x * (1. / 11975040)));
    } else {
      const ExpCoefficients f(x);
      const double half_cot = f.f0 / (2 * f.f1);
      g = (1 - half_cot) / x;
      const double dhalf_cot = (2 * half_cot / x - 1 / (x * f.f1)) / 4;
      dg = (-dhalf_cot - g) / x;
    }
  }
};

}  // namespace topple
