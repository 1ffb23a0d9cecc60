#include "solver/element/plasticity.h"

#include <gtest/gtest.h>

#include "solver/element/beam.h"
#include "unit/solver/element_pose.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

using Vec4 = Eigen::Vector4d;

Element element_that_yields(std::mt19937& rng, double s) {
  Element e{};
  e.length = 0.8;
  e.s = s;
  e.triad = random_rotation(rng).toRotationMatrix();
  e.normal_stiffness = {3, 1.7, 2.3};
  e.bending_stiffness = {0.9, 1.4, 0.6};
  e.capacity = {0.4, 0.2, 0.3, 0.15};
  return e;
}

double uniform(std::mt19937& rng, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(rng);
}

/// Stiffnesses and capacities over two powers of ten, hinges at the ends or in the middle.
Element random_element(std::mt19937& rng, int sample) {
  Element e = element_that_yields(rng, uniform(rng, -0.3, 0.3));
  const auto spread = [&] { return std::pow(10, uniform(rng, -1, 1)); };
  for (double& x : e.normal_stiffness) x *= spread();
  for (double& x : e.bending_stiffness) x *= spread();
  for (double& x : e.capacity) x *= spread();
  if (sample % 5 == 0) e.hinge_place[0] = e.hinge_place[1] = 0;
  return e;
}

const ElementState k_new;

BeamStrain random_strain(std::mt19937& rng, double size) {
  return {random_vector(rng, size), random_vector(rng, size)};
}

double f_at(const Element& e, const SectionForces& forces, int place) {
  return yield_function(e, forces_along(forces, e.length, e.s, e.hinge_place[place]));
}

SectionForces sum(const SectionForces& a, const SectionForces& b, double factor) {
  return {a.normal + factor * b.normal, a.moment + factor * b.moment};
}

/// Twice the complementary energy of a difference of forces: what the projection makes least.
double distance(const Element& e, const SectionForces& a, const SectionForces& b) {
  return 2 / e.length * section_energy(e, sum(a, b, -1));
}

// Brute force: no other forces that are within both surfaces, near or far, are closer to the elastic ones.
TEST(Plasticity, forces_are_the_closest_that_both_ends_bear) {
  std::mt19937 rng(5);
  int flows[3] = {};
  for (int sample = 0; sample < 500; ++sample) {
    SCOPED_TRACE(sample);
    const Element e = random_element(rng, sample);
    const BeamStrain strain = random_strain(rng, std::pow(10, uniform(rng, -2.5, 1)));
    const SectionForces trial = section_forces(e, strain);
    const SectionResponse response = respond(e, k_new, strain);
    ++flows[(response.multiplier[0] > 0) + (response.multiplier[1] > 0)];
    for (int k = 0; k < 2; ++k) {
      EXPECT_LE(f_at(e, response.forces, k), 1e-12);
      EXPECT_GE(response.multiplier[k], 0);
      if (response.multiplier[k] > 0) {
        EXPECT_NEAR(f_at(e, response.forces, k), 0, 1e-12);
      }
    }
    const double least = distance(e, trial, response.forces);
    if (!response.flows()) {
      EXPECT_EQ(least, 0);
    }
    for (int n = 0; n < 400; ++n) {
      const double reach = std::pow(10, -(n % 8));
      const SectionForces away = section_forces(e, random_strain(rng, reach));
      SectionForces other = sum(response.forces, away, 1);
      const double size = std::sqrt(1 + std::max({0., f_at(e, other, 0), f_at(e, other, 1)}));
      other = {other.normal / size, other.moment / size};
      EXPECT_GE(distance(e, trial, other), least * (1 - 1e-12) - 1e-15);
    }
  }
  for (const int count : flows) EXPECT_GT(count, 50);
}

// The same normals at both ends: who flows is open, the forces are not.
TEST(Plasticity, pure_tension_twist_and_even_bending_end_on_the_capacity) {
  std::mt19937 rng(3);
  Element e = element_that_yields(rng, k_gauss_shift);
  const auto only = [&](double gamma, double twist, double bend) {
    return respond(e, k_new, {{gamma, 0, 0}, {twist, bend, 0}}).forces;
  };
  EXPECT_NEAR(only(7, 0, 0).normal.x(), e.capacity[0], 1e-14);
  EXPECT_NEAR(only(-7, 0, 0).normal.x(), -e.capacity[0], 1e-14);
  EXPECT_NEAR(only(0, 9, 0).moment.x(), e.capacity[1], 1e-14);
  EXPECT_NEAR(only(0, 0, -5).moment.y(), -e.capacity[2], 1e-14);
  EXPECT_NEAR(only(0, 0, -5).normal.z(), 0, 1e-13);
}

Eigen::Matrix<double, 6, 1> stacked(const SectionForces& g) {
  Eigen::Matrix<double, 6, 1> v;
  v << g.normal, g.moment;
  return v;
}

// Second order in the step of the difference.
TEST(Plasticity, section_tangent_is_the_derivative_and_has_no_stiffness_along_the_flow) {
  std::mt19937 rng(6);
  int both = 0;
  for (int sample = 0; sample < 200; ++sample) {
    SCOPED_TRACE(sample);
    const Element e = random_element(rng, sample);
    const BeamStrain strain = random_strain(rng, 2);
    const SectionResponse response = respond(e, k_new, strain);
    const auto far = [&](int k) { return response.multiplier[k] == 0 || response.multiplier[k] > 0.05; };
    if (!response.flows() || !far(0) || !far(1)) continue;  // no kink nearby
    if (response.multiplier[0] > 0 && response.multiplier[1] > 0) ++both;
    const SectionTangent t = section_tangent(e, response);
    Eigen::Matrix<double, 6, 6> tangent, difference;
    tangent << t.normal_gamma, t.normal_kappa, t.normal_kappa.transpose(), t.moment_kappa;
    constexpr double k_step = 1e-6;
    for (int i = 0; i < 6; ++i) {
      BeamStrain up = strain, down = strain;
      (i < 3 ? up.gamma[i] : up.kappa[i - 3]) += k_step;
      (i < 3 ? down.gamma[i] : down.kappa[i - 3]) -= k_step;
      difference.col(i) =
          (stacked(respond(e, k_new, up).forces) - stacked(respond(e, k_new, down).forces)) / (2 * k_step);
    }
    EXPECT_LT((tangent - difference).norm(),
              1e-5 * stacked(section_forces(e, {Vec3::Ones(), Vec3::Ones()})).norm());
    ElementState state;
    take_flow(e, response, state);
    Eigen::Matrix<double, 6, 1> flow;
    flow << state.offset.gamma, state.offset.kappa;
    EXPECT_LT((tangent * flow).norm(), 1e-8 * stacked(section_forces(e, state.offset)).norm());
  }
  EXPECT_GT(both, 20);
}

Pose random_pose(std::mt19937& rng, double length) {
  const Quat q1 = random_rotation(rng);
  const Vec3 x1 = random_vector(rng);
  return {x1, x1 + length * random_direction(rng), q1, q1 * exp_quaternion(random_vector(rng, 0.5))};
}

Eigen::Matrix<double, 12, 1> stacked(const BeamGradient& g) {
  Eigen::Matrix<double, 12, 1> v;
  v << g.force1, g.moment1, g.force2, g.moment2;
  return v;
}

const double k_point_places[] = {0, k_gauss_shift, -k_gauss_shift};

TEST(Plasticity, beam_tangent_is_the_derivative_of_the_gradient_while_hinges_flow) {
  std::mt19937 rng(7);
  int flowing[3] = {};
  for (int sample = 0; sample < 200; ++sample) {
    Element e = element_that_yields(rng, k_point_places[sample % 3]);
    if (sample % 4 == 0) e.hinge_place[0] = e.hinge_place[1] = 0;
    const ElementState state{Hinge::none, 0, random_strain(rng, 0.1)};
    const Pose pose = random_pose(rng, e.length);
    const SectionResponse response = respond(e, state, beam_strain(e, ends_of(pose)));
    ++flowing[(response.multiplier[0] > 0) + (response.multiplier[1] > 0)];
    if (!response.flows()) continue;
    SCOPED_TRACE(sample);
    BeamGradient g;
    Mat12 tangent, difference;
    beam_tangent(e, state, ends_of(pose), g, tangent);
    constexpr double k_step = 1e-5;
    for (int k = 0; k < 12; ++k)
      difference.col(k) = (stacked(beam_gradient(e, state, ends_of(moved(pose, k, k_step)))) -
                           stacked(beam_gradient(e, state, ends_of(moved(pose, k, -k_step))))) /
                          (2 * k_step);
    EXPECT_LT((difference - tangent).norm(), 1e-6 * (1 + tangent.norm()));
  }
  EXPECT_GT(flowing[1], 40);
  EXPECT_GT(flowing[2], 40);
}

TEST(Plasticity, forces_are_the_gradient_of_the_energy_with_offsets) {
  std::mt19937 rng(8);
  for (int sample = 0; sample < 50; ++sample) {
    Element e = element_that_yields(rng, k_point_places[sample % 3]);
    e.capacity.setConstant(std::numeric_limits<double>::infinity());
    const ElementState state{Hinge::none, 0, random_strain(rng, 0.3)};
    const Pose pose = random_pose(rng, e.length);
    const auto energy = [&](const Pose& p) {
      return beam_energy(e, elastic_strain(state, beam_strain(e, ends_of(p))));
    };
    const auto gradient = stacked(beam_gradient(e, state, ends_of(pose)));
    constexpr double k_step = 1e-5;
    for (int k = 0; k < 12; ++k)
      EXPECT_NEAR((energy(moved(pose, k, k_step)) - energy(moved(pose, k, -k_step))) / (2 * k_step),
                  gradient[k], 1e-8);
  }
}

TEST(Plasticity, flow_takes_energy_and_leaves_the_elastic_law_with_the_new_offset) {
  std::mt19937 rng(9);
  for (int sample = 0; sample < 300; ++sample) {
    const Element e = random_element(rng, sample);
    ElementState state{Hinge::none, 0, random_strain(rng, 0.1)};
    const BeamStrain strain = random_strain(rng, 1);
    const SectionResponse response = respond(e, state, strain);
    if (!response.flows()) continue;
    const BeamStrain before = state.offset;
    take_flow(e, response, state);
    EXPECT_GT(response.forces.normal.dot(state.offset.gamma - before.gamma) +
                  response.forces.moment.dot(state.offset.kappa - before.kappa),
              0);
    const SectionForces after = section_forces(e, elastic_strain(state, strain));
    EXPECT_LT((stacked(after) - stacked(response.forces)).norm(),
              1e-12 * stacked(section_forces(e, strain)).norm());
  }
}

TEST(Plasticity, offset_tells_how_far_each_end_turned) {
  std::mt19937 rng(12);
  int seen[3] = {};
  for (int sample = 0; sample < 200; ++sample) {
    const Element e = element_that_yields(rng, k_gauss_shift);
    ElementState state;
    const SectionResponse response = respond(e, state, random_strain(rng, 0.3));
    take_flow(e, response, state);
    const auto turns = flowed_turns(e, state.offset);
    for (int k = 0; k < 2; ++k) {
      const SectionForces at = forces_along(response.forces, e.length, e.s, e.hinge_place[k]);
      const double kappa = 2 * response.multiplier[k] *
                           std::hypot(at.moment.y() / (e.capacity[2] * e.capacity[2]),
                                      at.moment.z() / (e.capacity[3] * e.capacity[3]));
      EXPECT_NEAR(turns[k], e.length * kappa, 1e-12);
    }
    ++seen[(response.multiplier[0] > 0) + (response.multiplier[1] > 0)];
  }
  EXPECT_GT(seen[1], 20);
  EXPECT_GT(seen[2], 20);
}

// The flow of a hinge at an end must turn the element about that end: were it brought back to the elastic
// stress point without the moments' conversion, the shear would not follow and the end moment would miss Mp.
TEST(Plasticity, element_turns_about_its_hinge_without_any_change_of_forces) {
  std::mt19937 rng(10);
  for (double s : k_point_places) {
    Element e = element_that_yields(rng, s);
    e.capacity = Vec4(1e9, 1e9, 1e-6, 1e9);
    const double turn = 1e-6;
    // bent about local y until the first end flows, then the first node alone turns on
    const Pose bent{Vec3::Zero(), e.length * (e.triad * Vec3::UnitX()),
                    exp_quaternion(e.triad * Vec3(0, 1e-5, 0)), Quat::Identity()};
    ElementState state;
    const SectionResponse response = respond(e, state, beam_strain(e, ends_of(bent)));
    ASSERT_GT(response.multiplier[0], 0);
    ASSERT_EQ(response.multiplier[1], 0);
    take_flow(e, response, state);
    const auto before = stacked(beam_gradient(e, state, ends_of(bent)));
    Pose turned = bent;
    turned.q1 = exp_quaternion(e.triad * Vec3(0, turn, 0)) * turned.q1;
    const auto after = stacked(beam_gradient(e, state, ends_of(turned)));
    e.capacity.setConstant(1e9);
    const auto elastic = stacked(beam_gradient(e, state, ends_of(turned)));
    EXPECT_LT((after - before).norm(), 1e-3 * (elastic - before).norm()) << "s " << s;
  }
}

}  // namespace
}  // namespace topple::test
