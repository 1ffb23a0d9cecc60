#include "solver/element/beam.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "unit/solver/element_pose.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

// All stiffnesses differ, so that exchanged components show.
const Section k_uneven = plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6);

struct Stiffness {
  double ea, gay, gaz, gj, eiy, eiz;
};

Stiffness stiffness(const Section& s, const Material& m) {
  const double g = m.young / (2 * (1 + m.poisson));
  return {m.young * s.area, g * s.area * s.ky, g * s.area * s.kz, g * s.j, m.young * s.iy, m.young * s.iz};
}

// Displacement and rotation of the tip of a clamped member under a small load: the linear theory.
struct Tip {
  Vec3 displacement, rotation;
};

Tip linear_tip(const Model& model) {
  BodySystem system(model, 0);
  const std::vector<double> b = static_correction(system, weightless(), 1, reference_motion(model));
  return {Vec3(&b[6]), Vec3(&b[9])};
}

void shift_stress_points(Model& model, double factor) {
  for (Element& e : model.elements) e.s *= factor;
}

// A stubby member: the condition of its stiffness matrix, about 1e4, is what rounding is multiplied with.
constexpr double k_rounding = 1e-12;
constexpr double k_beam_length = 0.4;

TEST(Beam, cantilever_tip_is_exact_with_two_elements_for_force_and_moment_in_both_planes) {
  const Stiffness c = stiffness(k_uneven, steel());
  const double l = k_beam_length, p = 10, m = 7;
  const auto load = [&](const Vec3& force, const Vec3& moment) {
    return linear_tip(cantilever(k_uneven, steel(), l, 1, force, moment));
  };
  Tip tip = load({0, p, 0}, Vec3::Zero());
  const double vy = p * l * l * l / (3 * c.eiz) + p * l / c.gay, rz = p * l * l / (2 * c.eiz);
  EXPECT_NEAR(tip.displacement.y(), vy, k_rounding * vy);
  EXPECT_NEAR(tip.rotation.z(), rz, k_rounding * rz);

  tip = load({0, 0, p}, Vec3::Zero());
  const double vz = p * l * l * l / (3 * c.eiy) + p * l / c.gaz, ry = p * l * l / (2 * c.eiy);
  EXPECT_NEAR(tip.displacement.z(), vz, k_rounding * vz);
  EXPECT_NEAR(tip.rotation.y(), -ry, k_rounding * ry);

  tip = load(Vec3::Zero(), {0, 0, m});
  EXPECT_NEAR(tip.displacement.y(), m * l * l / (2 * c.eiz), k_rounding * m * l * l / (2 * c.eiz));
  EXPECT_NEAR(tip.rotation.z(), m * l / c.eiz, k_rounding * m * l / c.eiz);

  tip = load(Vec3::Zero(), {0, m, 0});
  EXPECT_NEAR(tip.displacement.z(), -m * l * l / (2 * c.eiy), k_rounding * m * l * l / (2 * c.eiy));
  EXPECT_NEAR(tip.rotation.y(), m * l / c.eiy, k_rounding * m * l / c.eiy);

  tip = load({p, 0, 0}, {m, 0, 0});
  EXPECT_NEAR(tip.displacement.x(), p * l / c.ea, k_rounding * p * l / c.ea);
  EXPECT_NEAR(tip.rotation.x(), m * l / c.gj, k_rounding * m * l / c.gj);
}

TEST(Beam, cantilever_tip_does_not_depend_on_the_members_direction) {
  std::mt19937 rng(11);
  const Stiffness c = stiffness(plain_section(3e-4, 5e-8, 5e-8, 6e-8, 0.7, 0.7), steel());
  for (int i = 0; i < 20; ++i) {
    const Vec3 along = random_direction(rng);
    const Vec3 across = along.cross(random_direction(rng)).normalized();
    SCOPED_TRACE(along.transpose());
    // node positions are rounded, a strain of 1e-16: times kGA = 1e7 N it must not show against the load
    const double p = 1e4;
    const Tip tip = linear_tip(cantilever(plain_section(3e-4, 5e-8, 5e-8, 6e-8, 0.7, 0.7), steel(),
                                          k_beam_length, 1, p * across, Vec3::Zero(), along));
    const double exact = p * std::pow(k_beam_length, 3) / (3 * c.eiz) + p * k_beam_length / c.gay;
    EXPECT_LT((tip.displacement - exact * across).norm(), k_rounding * exact);
  }
}

TEST(Beam, swapped_stress_points_bend_0_884_of_exact_and_the_midpoint_is_off_by_a_sixteenth) {
  const Stiffness c = stiffness(k_uneven, steel());
  Model model = cantilever(k_uneven, steel(), k_beam_length, 1, {0, 10, 0}, Vec3::Zero());
  const double shear = 10 * k_beam_length / c.gay, bending = 10 * std::pow(k_beam_length, 3) / (3 * c.eiz);
  const auto bending_part = [&] { return (linear_tip(model).displacement.y() - shear) / bending; };
  EXPECT_NEAR(bending_part(), 1, k_rounding);
  shift_stress_points(model, -1);
  // by hand: curvatures from the moments at r = -s of the first element and r = s of the second
  const auto by_hand = [](double s) {
    const double k1 = 1 - (1 - s) / 4, k2 = 0.5 - (1 + s) / 4;
    return 3 * 0.25 * ((1 + s) / 2 * k1 + k1 + (1 - s) / 2 * k2);
  };
  EXPECT_NEAR(bending_part(), by_hand(-k_gauss_shift), k_rounding);
  EXPECT_NEAR(bending_part(), 0.884, 5e-4);
  shift_stress_points(model, 0);
  EXPECT_NEAR(bending_part(), 15. / 16, k_rounding);
}

Element random_element(std::mt19937& rng, double s) {
  Element e{};
  e.length = 0.8;
  e.s = s;
  e.triad = random_rotation(rng).toRotationMatrix();
  e.normal_stiffness = {3, 1.7, 2.3};
  e.bending_stiffness = {0.9, 1.4, 0.6};
  return e;
}

// Nodes turned against each other by `angle`, 20 % of stretch and shear.
Pose random_pose(std::mt19937& rng, const Element& e, double angle) {
  Pose p;
  p.x1 = random_vector(rng);
  p.q1 = random_rotation(rng);
  const Vec3 local = angle * random_direction(rng);
  p.q2 = p.q1 * exp_quaternion(e.triad * local);
  const Mat3 middle = p.q1.toRotationMatrix() * e.triad * exp_quaternion(0.5 * local).toRotationMatrix();
  p.x2 = p.x1 + e.length * (middle * (Vec3::UnitX() + random_vector(rng, 0.2)));
  return p;
}

double energy_of(const Element& e, const Pose& p) {
  return beam_energy(e, beam_strain(e, ends_of(p)));
}
Eigen::Matrix<double, 12, 1> gradient_of(const Element& e, const Pose& p) {
  const BeamGradient g = beam_gradient(e, {}, ends_of(p));
  Eigen::Matrix<double, 12, 1> v;
  v << g.force1, g.moment1, g.force2, g.moment2;
  return v;
}

const double k_places[] = {0, k_gauss_shift, -k_gauss_shift, 1, -1};
// Series end at |psi| = 0.2, others at 0.3 of |psi| and of t |psi|.
const double k_turns[] = {0,   1e-6, 0.1, 0.1999, 0.2001, 0.2999, 0.3001, 0.3 * 2 / (1 + k_gauss_shift),
                          0.7, 1.5,  2.5, 3.14,   3.15,   4,      5};

TEST(Beam, rigid_motion_is_free_of_strain) {
  std::mt19937 rng(12);
  for (double s : k_places)
    for (int i = 0; i < 100; ++i) {
      const Element e = random_element(rng, s);
      const Quat turn = random_rotation(rng);
      const Vec3 x1 = random_vector(rng), d = e.length * e.triad.col(0);
      const BeamStrain strain = beam_strain(e, beam_ends(x1, turn, x1 + turn * d, turn));
      EXPECT_LT(strain.gamma.norm(), 1e-14) << turn.coeffs().transpose();
      EXPECT_LT(strain.kappa.norm(), 1e-14) << turn.coeffs().transpose();
    }
}

TEST(Beam, strains_are_those_of_their_definition) {
  std::mt19937 rng(18);
  for (double s : k_places)
    for (double angle : k_turns) {
      SCOPED_TRACE(testing::Message() << "s " << s << ", turn " << angle);
      const Element e = random_element(rng, s);
      const Pose p = random_pose(rng, e, angle);
      const Mat3 r1 = p.q1.toRotationMatrix() * e.triad, r2 = p.q2.toRotationMatrix() * e.triad;
      const Vec3 shortest = log_quaternion(Quat(Mat3(r1.transpose() * r2)));
      const Vec3 psi = angle < k_pi ? shortest : shortest - 2 * k_pi * shortest.normalized();
      const Mat3 rs = r1 * exp_quaternion((1 + s) / 2 * psi).toRotationMatrix();
      const BeamStrain strain = beam_strain(e, ends_of(p));
      EXPECT_LT((strain.gamma - (rs.transpose() * (p.x2 - p.x1) / e.length - Vec3::UnitX())).norm(), 1e-14);
      // rounding of a logarithm of 5 rad over the length
      EXPECT_LT((strain.kappa - psi / e.length).norm(), 2e-14);
    }
}

TEST(Beam, strains_do_not_see_a_rigid_motion_on_top_of_a_deformation) {
  std::mt19937 rng(13);
  for (double s : k_places)
    for (double angle : k_turns) {
      SCOPED_TRACE(testing::Message() << "s " << s << ", turn " << angle);
      const Element e = random_element(rng, s);
      const Pose p = random_pose(rng, e, angle);
      const Quat turn = random_rotation(rng);
      const Vec3 shift = random_vector(rng);
      const Pose after{turn * p.x1 + shift, turn * p.x2 + shift, turn * p.q1, turn * p.q2};
      const BeamStrain a = beam_strain(e, ends_of(p)), b = beam_strain(e, ends_of(after));
      EXPECT_LT((a.gamma - b.gamma).norm(), 1e-14);
      // rounding of a logarithm of 5 rad over the length
      EXPECT_LT((a.kappa - b.kappa).norm(), 2e-14);
    }
}

TEST(Beam, gradient_is_the_derivative_of_the_energy) {
  std::mt19937 rng(14);
  for (double s : k_places)
    for (double angle : k_turns) {
      SCOPED_TRACE(testing::Message() << "s " << s << ", turn " << angle);
      const Element e = random_element(rng, s);
      const Pose p = random_pose(rng, e, angle);
      const auto g = gradient_of(e, p);
      double last = 0;
      for (double h : {1e-2, 1e-3, 1e-4}) {
        Eigen::Matrix<double, 12, 1> difference;
        for (int k = 0; k < 12; ++k)
          difference[k] = (energy_of(e, moved(p, k, h)) - energy_of(e, moved(p, k, -h))) / (2 * h);
        const double error = (difference - g).norm();
        // central differences: a hundredth per decade, until rounding of the energy (about 1e-15/h)
        if (last > 0) {
          EXPECT_LT(error, 0.0105 * last + 1e-14 / h) << "step " << h;
        }
        last = error;
      }
      EXPECT_LT(last, 1e-7 * (1 + g.norm()));
    }
}

TEST(Beam, gradient_balances_forces_and_moments) {
  std::mt19937 rng(15);
  for (double s : k_places)
    for (double angle : k_turns) {
      const Element e = random_element(rng, s);
      const Pose p = random_pose(rng, e, angle);
      const BeamGradient g = beam_gradient(e, {}, ends_of(p));
      EXPECT_LT((g.force1 + g.force2).norm(), 1e-15);
      const Vec3 moments = g.moment1 + g.moment2 + (p.x2 - p.x1).cross(g.force2);
      EXPECT_LT(moments.norm(), 1e-14) << "s " << s << ", turn " << angle;
    }
}

TEST(Beam, tangent_is_the_derivative_of_the_gradient) {
  std::mt19937 rng(16);
  for (double s : k_places)
    for (double angle : k_turns) {
      SCOPED_TRACE(testing::Message() << "s " << s << ", turn " << angle);
      const Element e = random_element(rng, s);
      const Pose p = random_pose(rng, e, angle);
      BeamGradient g;
      Mat12 tangent;
      beam_tangent(e, {}, ends_of(p), g, tangent);
      const auto alone = gradient_of(e, p);
      Eigen::Matrix<double, 12, 1> both;
      both << g.force1, g.moment1, g.force2, g.moment2;
      EXPECT_LT((both - alone).norm(), 1e-14 * (1 + alone.norm()));
      double last = 0;
      for (double h : {1e-2, 1e-3, 1e-4}) {
        Mat12 difference;
        for (int k = 0; k < 12; ++k)
          difference.col(k) = (gradient_of(e, moved(p, k, h)) - gradient_of(e, moved(p, k, -h))) / (2 * h);
        const double error = (difference - tangent).norm();
        if (last > 0) {
          EXPECT_LT(error, 0.0105 * last + 1e-13 / h) << "step " << h;
        }
        last = error;
      }
      EXPECT_LT(last, 1e-6 * (1 + tangent.norm()));
    }
}

TEST(Beam, tangent_is_continuous_where_series_and_closed_forms_meet) {
  std::mt19937 rng(17);
  for (double s : k_places) {
    const Element e = random_element(rng, s);
    const double t = (1 + s) / 2;
    for (double edge : {0.2, 0.3, t > 0.1 ? 0.3 / t : 0.3}) {
      const std::uint32_t seed = rng();
      Mat12 tangent[2];
      for (int side = 0; side < 2; ++side) {
        std::mt19937 same(seed);
        BeamGradient g;
        beam_tangent(e, {}, ends_of(random_pose(same, e, edge * (1 + (side == 0 ? -1e-12 : 1e-12)))), g,
                     tangent[side]);
      }
      // the closed forms of the second derivatives cancel to 3e-11 at 0.3 (rotation_test)
      EXPECT_LT((tangent[0] - tangent[1]).norm(), 1e-10 * tangent[0].norm())
          << "s " << s << ", turn " << edge;
    }
  }
}

// A bar of unit length and EI = GJ = 1; `stretch`: EA = kGA.
Model unit_bar(int members, double stretch, const Vec3& force, const Vec3& moment) {
  Material unit;
  unit.young = 1;
  unit.poisson = 0;
  unit.density = 1;
  return cantilever(plain_section(stretch, 1, 1, 2, 2, 2), unit, 1, members, force, moment);
}

TEST(Beam, bar_rolls_up_to_a_full_circle_under_an_end_moment) {
  for (int members : {4, 8}) {
    SCOPED_TRACE(members);
    const Model model = unit_bar(members, 1e4, Vec3::Zero(), {0, 0, 2 * k_pi});
    BodySystem system(model, 0);
    BodyMotion motion = reference_motion(model);
    for (int i = 1; i <= 20; ++i) ASSERT_GT(solve_statics(system, weightless(), i / 20., motion), 0) << i;
    // constant curvature without force is what the element holds exactly; EA/EI and 2 pi of turning cost
    // six digits
    EXPECT_LT(motion.position[members].norm(), 1e-10);
    const Vec3 x_axis = motion.rotation[members] * Vec3::UnitX();
    EXPECT_LT((x_axis - Vec3::UnitX()).norm(), 1e-10);
    // halfway the bar points back
    EXPECT_LT((motion.rotation[members / 2] * Vec3::UnitX() + Vec3::UnitX()).norm(), 1e-10);
  }
}

TEST(Beam, elastica_under_a_tip_load_is_reached_with_second_order) {
  // Elastica (Mattiasson 1981): shortening, deflection, tip angle at P L^2/EI
  constexpr double k_stretch = 1e6;
  const double table[4][4] = {{1, .056433, .301721, .461352},
                              {2, .160642, .493457, .781750},
                              {5, .387628, .713792, 1.215368},
                              {10, .554996, .810609, 1.430286}};
  for (const auto& row : table) {
    SCOPED_TRACE(testing::Message() << "P L^2/EI = " << row[0]);
    double error[3];
    for (int level = 0; level < 3; ++level) {
      const int members = 4 << level;
      const Model model = unit_bar(members, k_stretch, {0, row[0], 0}, Vec3::Zero());
      BodySystem system(model, 0);
      BodyMotion motion = reference_motion(model);
      for (int i = 1; i <= 40; ++i) ASSERT_GT(solve_statics(system, weightless(), i / 40., motion), 0);
      const Vec3 tip = motion.position[members];
      const double angle = log_quaternion(motion.rotation[members]).z();
      error[level] =
          std::max({std::abs(1 - tip.x() - row[1]), std::abs(tip.y() - row[2]), std::abs(angle - row[3])});
    }
    // the bar stretches and shears by P/EA, which the elastica does not
    const double blur = 2 * row[0] / k_stretch;
    EXPECT_LT(error[1], 0.27 * error[0] + blur);
    EXPECT_LT(error[2], 0.27 * error[1] + blur);
    EXPECT_LT(error[2], 2e-3);
  }
}

TEST(Beam, newton_with_the_tangent_converges_quadratically_at_large_rotations) {
  const Model model = unit_bar(4, 1e4, {0, 5, 2}, {0.5, 0, 0});
  BodySystem system(model, 0);
  BodyMotion motion = reference_motion(model);
  for (int i = 1; i <= 10; ++i) {
    const int iterations = solve_statics(system, weightless(), i / 10., motion);
    ASSERT_GT(iterations, 0);
    // a wrong block of the tangent makes this linear: dozens
    EXPECT_LE(iterations, 12) << "load step " << i;
  }
}

}  // namespace
}  // namespace topple::test
