#include "solver/section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/types.h"

namespace topple::test {
namespace {

Section made(Section::Shape shape, double y, double z, double t, double poisson = 0.3) {
  Section s;
  s.shape = shape;
  s.size_y = y;
  s.size_z = z;
  s.thickness = t;
  complete_section(s, poisson);
  return s;
}

// Sums over a fine grid of the section's own points.
struct Sums {
  double area = 0, iy = 0, iz = 0;
};
template <class Inside>
Sums integrate(double y, double z, Inside inside) {
  Sums sums;
  const int n = 1000;
  const double dy = y / n, dz = z / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double py = (i + 0.5) * dy - y / 2, pz = (j + 0.5) * dz - z / 2;
      if (!inside(py, pz)) continue;
      sums.area += dy * dz;
      sums.iy += dy * dz * pz * pz;
      sums.iz += dy * dz * py * py;
    }
  return sums;
}

TEST(Section, solid_rectangle_has_its_textbook_values) {
  const Section s = made(Section::Shape::solid, 0.02, 0.05, 0);
  EXPECT_DOUBLE_EQ(s.area, 1e-3);
  // iy resists bending in the x-z plane: the depth along z counts cubed
  EXPECT_NEAR(s.iy, 0.02 * std::pow(0.05, 3) / 12, 1e-20);
  EXPECT_NEAR(s.iz, 0.05 * std::pow(0.02, 3) / 12, 1e-20);
  EXPECT_NEAR(s.ky, 13. / 15.3, 1e-15);  // Cowper: 10 (1+nu)/(12 + 11 nu)
  EXPECT_NEAR(s.kz, 13. / 15.3, 1e-15);
  EXPECT_DOUBLE_EQ(s.width, 0.035);
}

TEST(Section, torsion_of_solid_rectangles_is_saint_venants) {
  // Timoshenko & Goodier, table of k1: J = k1 a b^3 to three or four digits
  const double table[][2] = {{1, 0.1406}, {1.5, 0.196}, {2, 0.229}, {3, 0.263}, {5, 0.291}, {10, 0.312}};
  for (const auto& [ratio, k] : table) {
    const double tolerance = ratio == 1 ? 5e-5 : 5.1e-4;
    EXPECT_NEAR(made(Section::Shape::solid, ratio, 1, 0).j / ratio, k, tolerance) << ratio;
    EXPECT_NEAR(made(Section::Shape::solid, 1, ratio, 0).j / ratio, k, tolerance) << ratio;
  }
}

TEST(Section, box_agrees_with_integration_and_bredt) {
  const double a = 0.03, b = 0.06, t = 0.0015;
  const Section s = made(Section::Shape::box, a, b, t);
  const Sums sums =
      integrate(a, b, [&](double y, double z) { return std::abs(y) > a / 2 - t || std::abs(z) > b / 2 - t; });
  // the wall is a whole number of cells: the midpoint rule errs 1/(cells across)^2
  EXPECT_NEAR(s.area, sums.area, 1e-12);
  EXPECT_NEAR(s.iy, sums.iy, 1e-5 * s.iy);
  EXPECT_NEAR(s.iz, sums.iz, 1e-5 * s.iz);
  const double enclosed = (a - t) * (b - t), way = 2 * (a - t + b - t);
  EXPECT_NEAR(s.j, 4 * enclosed * enclosed * t / way, 1e-15 * 1e-3);
  EXPECT_DOUBLE_EQ(s.width, 0.045);
}

TEST(Section, pipe_agrees_with_its_closed_forms) {
  const Section s = made(Section::Shape::pipe, 0.05, 0, 0.002);
  EXPECT_NEAR(s.area, k_pi * 0.048 * 0.002, 1e-15);
  const double i = k_pi / 64 * (std::pow(0.05, 4) - std::pow(0.046, 4));
  EXPECT_NEAR(s.iy, i, 1e-12 * i);
  EXPECT_NEAR(s.iz, i, 1e-12 * i);
  EXPECT_NEAR(s.j, 2 * i, 1e-12 * i);
  EXPECT_DOUBLE_EQ(s.width, 0.05);
  EXPECT_DOUBLE_EQ(s.fibre_z(), 0.025);
}

TEST(Section, shear_coefficients_are_cowpers_in_their_limits) {
  for (double nu : {0., 0.3, 0.5}) {
    SCOPED_TRACE(nu);
    // thin square tube: 20 (1+nu)/(48 + 39 nu); the formula takes the centre lines' sides, here equal
    const Section square = made(Section::Shape::box, 0.05, 0.05, 0.001, nu);
    EXPECT_NEAR(square.ky, 20 * (1 + nu) / (48 + 39 * nu), 1e-14);
    EXPECT_NEAR(square.kz, square.ky, 1e-14);
    // thin round tube 2 (1+nu)/(4 + 3 nu), to the square of thickness over radius; solid round
    // 6 (1+nu)/(7 + 6 nu)
    EXPECT_NEAR(made(Section::Shape::pipe, 1, 0, 1e-4, nu).ky, 2 * (1 + nu) / (4 + 3 * nu), 1e-7);
    EXPECT_NEAR(made(Section::Shape::pipe, 1, 0, 0.5 - 1e-9, nu).ky, 6 * (1 + nu) / (7 + 6 * nu), 1e-12);
    // a narrow tall tube carries shear in its webs alone, like a rectangle
    const Section tall = made(Section::Shape::box, 1, 1e-3, 1e-7, nu);
    EXPECT_NEAR(tall.ky, 10 * (1 + nu) / (12 + 11 * nu), 5e-3);
    EXPECT_LT(tall.kz, 0.01);
  }
  // nu = 0, side ratio 2: shear along the long side m = 1/2, along the short side m = 2
  const Section box = made(Section::Shape::box, 2.001, 1.001, 0.001, 0);
  EXPECT_NEAR(box.ky, 10 * 6.25 / (12 + 36 + 37.5 + 11.25 + 2.5 * (1.5 + 0.75)), 1e-12);
  EXPECT_NEAR(box.kz, 10 * 49. / (12 + 144 + 600 + 720 + 40 * (6 + 12)), 1e-12);
}

TEST(Section, custom_is_left_alone) {
  Section s;
  s.shape = Section::Shape::custom;
  s.area = 1;
  s.width = 2;
  complete_section(s, 0.3);
  EXPECT_EQ(s.area, 1);
  EXPECT_EQ(s.width, 2);
  EXPECT_EQ(s.j, 0);
}

}  // namespace
}  // namespace topple::test
