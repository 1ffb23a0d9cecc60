#include "solver/model/section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "solver/math/types.h"

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

// Plastic moduli of bending, by the integral of the distance from the axis that halves the area, here that of
// symmetry, and of torsion, by twice the volume under Nadai's heap: slope 1 towards the nearest edge.
struct Moduli {
  double zy = 0, zz = 0, heap = 0;
};
template <class Inside, class Height>
Moduli integrate_moduli(double y, double z, int n, Inside inside, Height height) {
  Moduli sums;
  const double dy = y / n, dz = z / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double py = (i + 0.5) * dy - y / 2, pz = (j + 0.5) * dz - z / 2;
      if (!inside(py, pz)) continue;
      sums.zy += dy * dz * std::abs(pz);
      sums.zz += dy * dz * std::abs(py);
      sums.heap += 2 * dy * dz * height(py, pz);
    }
  return sums;
}

TEST(Section, plastic_moduli_of_a_solid_rectangle_agree_with_integration) {
  for (const auto& [a, b] : {std::pair(0.02, 0.05), std::pair(0.05, 0.02), std::pair(0.03, 0.03)}) {
    SCOPED_TRACE(a / b);
    const Section s = made(Section::Shape::solid, a, b, 0);
    const Moduli m = integrate_moduli(
        a, b, 600, [](double, double) { return true; },
        [a = a, b = b](double y, double z) { return std::min(a / 2 - std::abs(y), b / 2 - std::abs(z)); });
    EXPECT_NEAR(m.zy, s.zy, 1e-12 * s.zy);  // the midpoint rule is exact for what is linear in each cell
    EXPECT_NEAR(m.zz, s.zz, 1e-12 * s.zz);
    EXPECT_NEAR(m.heap, s.zt, 1e-5 * s.zt);
  }
}

TEST(Section, plastic_moduli_of_a_box_agree_with_integration) {
  const double a = 0.03, b = 0.06, t = 0.0015;
  const Section s = made(Section::Shape::box, a, b, t);
  const Moduli m = integrate_moduli(
      a, b, 1000, [&](double y, double z) { return std::abs(y) > a / 2 - t || std::abs(z) > b / 2 - t; },
      [](double, double) { return 0.; });
  EXPECT_NEAR(m.zy, s.zy, 1e-9 * s.zy);
  EXPECT_NEAR(m.zz, s.zz, 1e-9 * s.zz);
  EXPECT_GT(s.zy, s.iy / s.fibre_z());
  // Bredt: the shear flow, t at yield, about the axis: its lever is half a side on each of four walls
  const double flow = 2 * t * ((a - t) * (b - t) / 2 + (b - t) * (a - t) / 2);
  EXPECT_NEAR(s.zt, flow, 1e-15);
}

TEST(Section, plastic_moduli_of_a_pipe_agree_with_integration) {
  const double d = 0.05, t = 0.002, outer = d / 2, inner = outer - t;
  const Section s = made(Section::Shape::pipe, d, 0, t);
  Moduli m;
  const int rings = 400, sectors = 4000;
  double torsion = 0;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double r = inner + (i + 0.5) * t / rings, angle = 2 * k_pi * (j + 0.5) / sectors;
      const double cell = r * t / rings * 2 * k_pi / sectors;
      m.zy += cell * std::abs(r * std::sin(angle));
      m.zz += cell * std::abs(r * std::cos(angle));
      torsion += cell * r;
    }
  EXPECT_NEAR(m.zy, s.zy, 1e-6 * s.zy);
  EXPECT_NEAR(m.zz, s.zz, 1e-6 * s.zz);
  EXPECT_NEAR(torsion, s.zt, 1e-6 * s.zt);
}

TEST(Section, custom_is_left_alone) {
  Section s;
  s.shape = Section::Shape::custom;
  s.area = 1;
  s.zy = 3;
  s.zz = 4;
  s.zt = 5;
  s.width = 2;
  complete_section(s, 0.3);
  EXPECT_EQ(s.area, 1);
  EXPECT_EQ(s.width, 2);
  EXPECT_EQ(s.j, 0);
  EXPECT_EQ(s.zy, 3);
  EXPECT_EQ(s.zz, 4);
  EXPECT_EQ(s.zt, 5);
}

TEST(Section, torsion_of_a_thin_plate_is_that_of_the_endless_one_less_its_edges_either_way_round) {
  // tanh is 1 to rounding: J = a b^3/3 (1 - 192/pi^5 b/a (sum of 1/n^5 over odd n)), the sum 31/32 zeta(5)
  const double sum = 31. / 32 * 1.0369277551433699, thick = 0.002;
  for (const double ratio : {20., 100.}) {
    const double wide = ratio * thick;
    const double exact = wide * std::pow(thick, 3) / 3 * (1 - 192 / std::pow(k_pi, 5) / ratio * sum);
    // terms from 1/41^5 on are left out: 5e-8 of the edges' part
    EXPECT_NEAR(made(Section::Shape::solid, wide, thick, 0).j, exact, 1e-8 * exact) << ratio;
    EXPECT_NEAR(made(Section::Shape::solid, thick, wide, 0).j, exact, 1e-8 * exact) << ratio;
  }
}

}  // namespace
}  // namespace topple::test
