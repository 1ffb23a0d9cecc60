#include "solver/math/rotation.h"

#include <gtest/gtest.h>

#include "solver/element/beam_kernel.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// Angles on both sides of the switch from series to closed form (0.3), and up to pi.
const double k_turns[] = {0, 1e-9, 1e-4, 0.1, 0.2999999, 0.3, 0.3000001, 0.7, 1.5, 2.5, 3.14};

struct Reference {
  long double f0 = 0, f1 = 0, f2 = 0, df1 = 0, df2 = 0, g = 0, dg = 0;
};

// Power series in x = a^2 in long double; entire functions, and for g radius (2 pi)^2.
Reference reference(long double x) {
  Reference r;
  long double power = 1, factorial = 1;  // x^n, (2n)!
  for (int n = 0; n < 25; ++n) {
    const long double sign = n % 2 == 0 ? 1 : -1;
    const long double one = factorial * (2 * n + 1), two = one * (2 * n + 2), three = two * (2 * n + 3);
    r.f0 += sign * power / one;
    r.f1 += sign * power / two;
    r.f2 += sign * power / three;
    // d/dx of the next term
    const long double four = three * (2 * n + 4), five = four * (2 * n + 5);
    r.df1 -= sign * (n + 1) * power / four;
    r.df2 -= sign * (n + 1) * power / five;
    power *= x;
    factorial *= static_cast<long double>(2 * n + 1) * (2 * n + 2);
  }
  // g = sum of |B_2n| x^(n-1) / (2n)! = sum of 2 zeta(2n) x^(n-1) / (2 pi)^(2n)
  const long double two_pi_squared = 4 * 9.8696044010893586188344909998762L;
  long double coefficient = 1;
  for (int n = 1; n < 60; ++n) {
    coefficient /= two_pi_squared;
    long double zeta = 1;
    if (n == 1)
      zeta = 9.8696044010893586188344909998762L / 6;
    else if (n == 2)
      zeta = 97.409091034002437236440332688705L / 90;
    else if (n == 3)
      zeta = 961.38919357530443703021944365242L / 945;
    else
      for (int k = 300; k >= 2; --k) zeta += std::pow(static_cast<long double>(k), -2 * n);
    r.g += 2 * zeta * coefficient * std::pow(x, static_cast<long double>(n - 1));
    if (n > 1) r.dg += 2 * zeta * coefficient * (n - 1) * std::pow(x, static_cast<long double>(n - 2));
  }
  return r;
}

TEST(Rotation, coefficients_agree_with_their_power_series_on_both_sides_of_the_switch) {
  for (double a : k_turns) {
    SCOPED_TRACE(a);
    const double x = a * a;
    const Reference r = reference(x);
    const ExpCoefficients f(x);
    const InverseJacobianCoefficient c(x);
    const auto relative = [](double value, long double exact) {
      return std::abs(static_cast<double>((value - exact) / exact));
    };
    // The closed forms cancel most at a = 0.3: f1 and f2 lose 2/x = 22 and 6/x = 67 roundings, their
    // derivatives another factor of about 60/x. dg serves the tangent alone: its series is cut at 1.3e-10.
    EXPECT_LT(relative(f.f0, r.f0), 1e-13 * (1 + 1 / std::abs(r.f0)));
    EXPECT_LT(relative(f.f1, r.f1), 2e-14);
    EXPECT_LT(relative(f.f2, r.f2), 5e-14);
    EXPECT_LT(relative(f.df1, r.df1), 5e-12);
    EXPECT_LT(relative(f.df2, r.df2), 3e-11);
    EXPECT_LT(relative(c.g, r.g), 5e-13);
    EXPECT_LT(relative(c.dg, r.dg), 3e-10);
  }
}

TEST(Rotation, exponential_is_the_rotation_by_the_vectors_angle) {
  std::mt19937 rng(1);
  for (double a : k_turns) {
    SCOPED_TRACE(a);
    const Vec3 axis = random_direction(rng);
    const Mat3 expected = Eigen::AngleAxisd(a, axis).toRotationMatrix();
    EXPECT_LT((exp_quaternion(a * axis).toRotationMatrix() - expected).norm(), 1e-14);
    const Mat3 k = skew(a * axis);
    const ExpCoefficients f(a * a);
    EXPECT_LT((Mat3::Identity() + f.f0 * k + f.f1 * k * k - expected).norm(), 1e-14);
  }
}

TEST(Rotation, logarithm_inverts_the_exponential) {
  std::mt19937 rng(2);
  for (double a : k_turns)
    for (int i = 0; i < 20; ++i) {
      const Vec3 psi = a * random_direction(rng);
      SCOPED_TRACE(psi.transpose());
      const Quat q = exp_quaternion(psi);
      EXPECT_LT((log_quaternion(q) - psi).norm(), 1e-14);
      // q and -q are the same rotation
      EXPECT_LT((log_quaternion(Quat(-q.coeffs())) - psi).norm(), 1e-14);
    }
}

TEST(Rotation, skew_is_the_cross_product) {
  std::mt19937 rng(3);
  const Vec3 a = random_vector(rng), b = random_vector(rng);
  EXPECT_LT((skew(a) * b - a.cross(b)).norm(), 1e-16);
}

// T of exp(psi + dpsi) = exp(T dpsi) exp(psi), of the beams' coefficients.
Mat3 left_jacobian(const Vec3& psi) {
  const PackVector<double> v = packed(psi);
  const PackAngle<double> angle = angle_functions(dot(v, v), 1.);
  return unpacked(polynomial_of(v, double_cross(v), 1., angle.left1, angle.left2));
}

TEST(Rotation, left_jacobian_carries_increments_to_the_left_of_the_exponential) {
  std::mt19937 rng(4);
  for (double a : {0., 0.01, 0.29, 0.31, 1., 2., 2.8}) {
    const Vec3 psi = a * random_direction(rng), along = random_direction(rng);
    SCOPED_TRACE(psi.transpose());
    double last = 0;
    for (double h : {1e-1, 1e-2, 1e-3, 1e-4}) {
      const Quat plus = exp_quaternion(psi + h * along), minus = exp_quaternion(psi - h * along);
      const Vec3 spin = log_quaternion(plus * minus.conjugate()) / (2 * h);
      const double error = (spin - left_jacobian(psi) * along).norm();
      // second order until rounding, 1e-16/h
      if (last > 0) {
        EXPECT_LT(error, 0.02 * last + 1e-15 / h);
      }
      last = error;
    }
    EXPECT_LT(last, 1e-8);
  }
}

TEST(Rotation, inverse_jacobian_inverts_and_both_keep_the_axis) {
  std::mt19937 rng(5);
  for (double a : k_turns)
    for (int i = 0; i < 10; ++i) {
      const Vec3 psi = a * random_direction(rng);
      SCOPED_TRACE(psi.transpose());
      const Mat3 t = left_jacobian(psi), inverse = unpacked(inverse_left_jacobian(packed(psi)));
      // near pi the inverse grows to about 2
      EXPECT_LT((t * inverse - Mat3::Identity()).norm(), 2e-14);
      EXPECT_LT((t * psi - psi).norm(), 1e-14);
      EXPECT_LT((inverse * psi - psi).norm(), 1e-14);
      EXPECT_LT((left_jacobian(-psi) - t.transpose()).norm(), 1e-15);
      // T(psi) = exp(psi) T(-psi)
      EXPECT_LT((exp_quaternion(psi).toRotationMatrix() * t.transpose() - t).norm(), 1e-14);
    }
}

}  // namespace
}  // namespace topple::test
