#include "solver/element/plasticity.h"

#include <gtest/gtest.h>

#include "solver/element/beam.h"
#include "unit/solver/element_pose.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Vec4 random_positive(std::mt19937& rng, double least, double most) {
  std::uniform_real_distribution<double> u(std::log(least), std::log(most));
  Vec4 v;
  for (double& x : v) x = std::exp(u(rng));
  return v;
}

Vec4 random_trial(std::mt19937& rng, const Vec4& capacity, double furthest) {
  std::uniform_real_distribution<double> u(-furthest, furthest);
  Vec4 v;
  for (int i = 0; i < 4; ++i) v[i] = u(rng) * capacity[i];
  return v;
}

// Twice the complementary energy of a difference of forces: what the closest point makes least.
double distance(const Vec4& a, const Vec4& b, const Vec4& stiffness) {
  return (a - b).cwiseProduct(a - b).cwiseQuotient(stiffness).sum();
}

TEST(Plasticity, return_is_the_closest_point_of_the_yield_surface) {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  for (int sample = 0; sample < 300; ++sample) {
    SCOPED_TRACE(sample);
    const Vec4 stiffness = random_positive(rng, 1e-2, 1e2), capacity = random_positive(rng, 0.1, 10);
    const Vec4 trial = random_trial(rng, capacity, 30);
    const PlasticReturn point = return_to_yield(trial, stiffness, capacity);
    if (yield_function(trial, capacity) <= 0) {
      EXPECT_EQ(point.forces, trial);
      EXPECT_EQ(point.multiplier, 0);
      continue;
    }
    EXPECT_NEAR(yield_function(point.forces, capacity), 0, 1e-14);
    // brute force: no point of the surface, near or far, is closer
    const double least = distance(trial, point.forces, stiffness);
    for (int k = 0; k < 400; ++k) {
      Vec4 away;
      for (double& x : away) x = normal(rng);
      const double reach = std::pow(10, -(k % 8));
      Vec4 other = point.forces.cwiseQuotient(capacity) + reach * away;
      other = other.normalized().cwiseProduct(capacity);
      EXPECT_GE(distance(trial, other, stiffness), least * (1 - 1e-13));
    }
  }
}

TEST(Plasticity, radial_return_of_one_component_needs_no_iteration_and_ends_on_its_capacity) {
  const PlasticReturn point = return_to_yield({0, 0, -7e9, 0}, {1, 2, 3, 4}, {5, 6, 2, 8});
  EXPECT_EQ(point.forces[2], -2);
  EXPECT_EQ(point.forces[0], 0);
}

TEST(Plasticity, tangent_is_the_derivative_of_the_return_and_has_no_stiffness_along_the_flow) {
  std::mt19937 rng(6);
  for (int sample = 0; sample < 100; ++sample) {
    SCOPED_TRACE(sample);
    const Vec4 stiffness = random_positive(rng, 0.1, 10), capacity = random_positive(rng, 0.3, 3);
    const Vec4 trial = random_trial(rng, capacity, 4);
    const PlasticReturn point = return_to_yield(trial, stiffness, capacity);
    if (!(yield_function(trial, capacity) > 0.1)) continue;
    const Mat4 tangent = plastic_tangent(point, stiffness, capacity);
    Mat4 difference;
    constexpr double k_step = 1e-5;
    for (int i = 0; i < 4; ++i) {
      const Vec4 step = k_step * stiffness[i] * Vec4::Unit(i);
      difference.col(i) = (return_to_yield(trial + step, stiffness, capacity).forces -
                           return_to_yield(trial - step, stiffness, capacity).forces) /
                          (2 * k_step);
    }
    // second order in the step
    EXPECT_LT((tangent - difference).norm(), 1e-6 * stiffness.norm());
    EXPECT_LT((tangent * point.forces.cwiseQuotient(capacity.cwiseAbs2())).norm(), 1e-12 * stiffness.norm());
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-14 * stiffness.norm());
  }
}

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

BeamStrain random_strain(std::mt19937& rng, double size) {
  return {random_vector(rng, size), random_vector(rng, size)};
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

const Hinge k_hinges[] = {Hinge::first, Hinge::second, Hinge::middle};
const double k_point_places[] = {0, k_gauss_shift, -k_gauss_shift};

TEST(Plasticity, beam_tangent_is_the_derivative_of_the_gradient_while_a_hinge_flows) {
  std::mt19937 rng(7);
  int flowing = 0;
  for (int sample = 0; sample < 60; ++sample)
    for (Hinge hinge : k_hinges) {
      const Element e = element_that_yields(rng, k_point_places[sample % 3]);
      const ElementState state{hinge, random_strain(rng, 0.1)};
      const Pose pose = random_pose(rng, e.length);
      if (!respond(e, state, beam_strain(e, ends_of(pose))).flows) continue;
      ++flowing;
      SCOPED_TRACE(testing::Message() << sample << ", hinge " << static_cast<int>(hinge));
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
  EXPECT_GT(flowing, 100);
}

TEST(Plasticity, forces_are_the_gradient_of_the_energy_with_offsets) {
  std::mt19937 rng(8);
  for (int sample = 0; sample < 50; ++sample) {
    const Element e = element_that_yields(rng, k_point_places[sample % 3]);
    const ElementState state{Hinge::none, random_strain(rng, 0.3)};
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

TEST(Plasticity, flow_ends_on_the_surface_at_the_hinge_and_what_it_takes_is_positive) {
  std::mt19937 rng(9);
  for (int sample = 0; sample < 300; ++sample) {
    const Hinge hinge = k_hinges[sample % 3];
    const Element e = element_that_yields(rng, k_gauss_shift);
    ElementState state{hinge, random_strain(rng, 0.1)};
    const BeamStrain strain = random_strain(rng, 1);
    const SectionResponse response = respond(e, state, strain);
    if (!response.flows) continue;
    const SectionForces at_hinge = forces_along(response.forces, e.length, e.s, hinge_place(e, hinge));
    EXPECT_NEAR(yield_function(e, at_hinge), 0, 1e-12);
    const BeamStrain before = state.offset;
    take_flow(e, response, state);
    EXPECT_GT(response.forces.normal.dot(state.offset.gamma - before.gamma) +
                  response.forces.moment.dot(state.offset.kappa - before.kappa),
              0);
    // the elastic law with the new offset gives the same forces: a state in which the hinge goes has no jump
    state.hinge = Hinge::none;
    const SectionForces after = respond(e, state, strain).forces;
    EXPECT_LT((after.normal - response.forces.normal).norm() + (after.moment - response.forces.moment).norm(),
              1e-14);
  }
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
    ElementState state{Hinge::first, {Vec3::Zero(), Vec3::Zero()}};
    const SectionResponse response = respond(e, state, beam_strain(e, ends_of(bent)));
    ASSERT_TRUE(response.flows);
    take_flow(e, response, state);
    const auto before = stacked(beam_gradient(e, state, ends_of(bent)));
    Pose turned = bent;
    turned.q1 = exp_quaternion(e.triad * Vec3(0, turn, 0)) * turned.q1;
    const auto after = stacked(beam_gradient(e, state, ends_of(turned)));
    state.hinge = Hinge::none;
    const auto elastic = stacked(beam_gradient(e, state, ends_of(turned)));
    EXPECT_LT((after - before).norm(), 1e-3 * (elastic - before).norm()) << "s " << s;
  }
}

}  // namespace
}  // namespace topple::test
