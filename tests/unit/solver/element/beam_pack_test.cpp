#include "solver/element/beam_pack.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "solver/element/beam.h"
#include "solver/element/beam_kernel.h"
#include "solver/element/plasticity.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

enum class Memory { none, offsets, hinges };

// Five members in space, ten elements: the last pack is not full. Any nodes may turn against each other by
// about `angle`.
struct MemberPose {
  Model model;
  std::vector<ElementState> memory;
  BodyMotion motion;
};

MemberPose random_pose(std::mt19937& rng, double angle, Memory memory) {
  MemberPose pose;
  Material material = steel();
  if (memory != Memory::none) material.yield = 235e6;
  pose.model.materials.push_back(material);
  Section section = plain_section(3e-4, 4e-8, 9e-8, 6e-8, 0.7, 0.6);
  section.zy = 2e-6;
  section.zz = 3e-6;
  section.zt = 2.5e-6;
  pose.model.sections.push_back(section);
  FrameSpec spec;
  spec.name = "tree";
  for (int i = 0; i < 6; ++i) spec.nodes.push_back(random_vector(rng));
  for (int i = 0; i < 5; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
  add_frame(pose.model, spec);
  pose.motion = reference_motion(pose.model);
  const Quat whole = random_rotation(rng);
  const Vec3 shift = random_vector(rng);
  for (int i = 0; i < pose.model.node_total(); ++i) {
    pose.motion.position[i] = whole * pose.model.node_position[i] + shift + random_vector(rng, 0.03 * angle);
    // some little, so that small and large angles meet in one pack
    pose.motion.rotation[i] = exp_quaternion(random_vector(rng, i % 3 == 0 ? angle : 0.01 * angle)) * whole;
    pose.motion.velocity[i] = random_vector(rng);
  }
  pose.memory.resize(pose.model.elements.size());
  std::uniform_int_distribution<int> any(0, 3);
  for (ElementState& state : pose.memory) {
    if (memory == Memory::none) continue;
    state.offset = {random_vector(rng, 1e-3), random_vector(rng, 1e-2)};
    if (memory == Memory::hinges) state.hinge = static_cast<Hinge>(any(rng));
  }
  return pose;
}

struct Scalar {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd tangent;
  double energy = 0;
  std::vector<SectionForces> sections;
};

Scalar element_by_element(const MemberPose& pose) {
  const int n = 6 * pose.model.node_total();
  Scalar out{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n), 0, {}};
  const BodyMotion& m = pose.motion;
  for (std::size_t e = 0; e < pose.model.elements.size(); ++e) {
    const Element& element = pose.model.elements[e];
    const int i = element.node[0], j = element.node[1];
    const BeamEnds ends = beam_ends(m.position[i], m.rotation[i], m.position[j], m.rotation[j]);
    BeamGradient g;
    Mat12 k;
    beam_tangent(element, pose.memory[e], ends, g, k);
    const int at[2] = {6 * i, 6 * j};
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) out.tangent.block<6, 6>(at[a], at[b]) += k.block<6, 6>(6 * a, 6 * b);
    out.gradient.segment<3>(6 * i) += g.force1;
    out.gradient.segment<3>(6 * i + 3) += g.moment1;
    out.gradient.segment<3>(6 * j) += g.force2;
    out.gradient.segment<3>(6 * j + 3) += g.moment2;
    const BeamStrain elastic = elastic_strain(pose.memory[e], beam_strain(element, ends));
    out.energy += beam_energy(element, elastic);
    out.sections.push_back(section_forces(element, elastic));
  }
  return out;
}

void expect_the_same(const MemberPose& pose) {
  BodySystem system(pose.model, 0);
  system.elements = pose.memory;
  const Scalar scalar = element_by_element(pose);
  const double stiffness = scalar.tangent.cwiseAbs().maxCoeff();
  // a strain is rounded to 1e-16, a large angle to a few of them
  const double rounding = 1e-14 * stiffness;

  const auto gradient_of = [&] {
    Eigen::VectorXd g(6 * system.count);
    for (int i = 0; i < system.count; ++i) g.segment<6>(6 * i) << -system.force[i], -system.moment[i];
    return g;
  };
  system.evaluate_free(weightless(), {weightless(), 0}, pose.motion);
  EXPECT_LT((gradient_of() - scalar.gradient).cwiseAbs().maxCoeff(), rounding);

  system.lu.set_zero();
  system.evaluate_with_tangent(weightless(), {weightless(), 0}, pose.motion, {}, pose.motion.position, 0);
  EXPECT_LT((gradient_of() - scalar.gradient).cwiseAbs().maxCoeff(), rounding);
  // unit columns through the factorisation of tangent + shift, well conditioned, against the matrix itself
  const double shift = 100 * stiffness;
  for (int i = 0; i < system.count; ++i) system.lu.add(i, i, Mat6(shift * Mat6::Identity()));
  ASSERT_EQ(system.lu.factor(), -1);
  Eigen::MatrixXd shifted = scalar.tangent;
  shifted.diagonal().array() += shift;
  const Eigen::MatrixXd inverse = shifted.inverse();
  for (int k = 0; k < 6 * system.count; ++k) {
    Eigen::VectorXd column = Eigen::VectorXd::Unit(6 * system.count, k);
    system.lu.solve(column.data());
    EXPECT_LT((column - inverse.col(k)).cwiseAbs().maxCoeff() * shift * 100, 1e-12);
  }

  std::vector<SectionForces> sections(pose.model.elements.size());
  const BodyEnergy energy = system.energy({}, pose.motion, {}, sections);
  EXPECT_NEAR(energy.strain, scalar.energy,
              1e-12 * scalar.energy + 1e-14 * std::sqrt(stiffness * scalar.energy) + 1e-28 * stiffness);
  for (std::size_t e = 0; e < sections.size(); ++e) {
    EXPECT_LT((sections[e].normal - scalar.sections[e].normal).norm(), rounding);
    EXPECT_LT((sections[e].moment - scalar.sections[e].moment).norm(), rounding);
  }
}

TEST(BeamPack, gives_what_the_elements_give_one_by_one_for_small_and_large_rotations) {
  std::mt19937 rng(31);
  for (const double angle : {0., 1e-9, 1e-4, 0.02, 0.1, 0.3, 1.2})
    for (int trial = 0; trial < 20; ++trial) {
      SCOPED_TRACE(testing::Message() << "angle " << angle << ", trial " << trial);
      expect_the_same(random_pose(rng, angle, Memory::none));
    }
}

TEST(BeamPack, gives_what_the_elements_give_at_every_angle_up_to_5_rad) {
  std::mt19937 rng(34);
  const MemberPose still = random_pose(rng, 0, Memory::none);
  const Vec3 axis = random_direction(rng);
  for (int k = 0; k <= 500; ++k) {
    SCOPED_TRACE(testing::Message() << "angle " << 0.01 * k);
    MemberPose pose = still;
    pose.motion.rotation[2] = exp_quaternion(0.01 * k * axis) * pose.motion.rotation[2];
    expect_the_same(pose);
  }
}

TEST(BeamPack, gives_what_elements_with_offsets_and_hinges_give_one_by_one) {
  std::mt19937 rng(32);
  for (const Memory memory : {Memory::offsets, Memory::hinges})
    for (const double angle : {0., 1e-4, 0.02, 0.3})
      for (int trial = 0; trial < 20; ++trial) {
        SCOPED_TRACE(testing::Message() << "angle " << angle << ", trial " << trial);
        expect_the_same(random_pose(rng, angle, memory));
      }
}

TEST(BeamPack, gradient_is_that_of_its_energy) {
  std::mt19937 rng(33);
  for (const double angle : {1e-3, 0.1, 0.8})
    for (int trial = 0; trial < 5; ++trial) {
      MemberPose pose = random_pose(rng, angle, Memory::none);
      SCOPED_TRACE(testing::Message() << "angle " << angle << ", trial " << trial);
      BodySystem system(pose.model, 0);
      std::vector<SectionForces> sections(pose.model.elements.size());
      system.evaluate_free(weightless(), {weightless(), 0}, pose.motion);
      const double size = 1e7, h = 1e-5;
      for (int i = 0; i < system.count; ++i)
        for (int k = 0; k < 6; ++k) {
          const auto energy_at = [&](double step) {
            BodyMotion moved = pose.motion;
            if (k < 3)
              moved.position[i][k] += step;
            else
              moved.rotation[i] = exp_quaternion(step * Vec3::Unit(k - 3)) * moved.rotation[i];
            return system.energy({}, moved, {}, sections).strain;
          };
          const double slope =
              (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) / (12 * h);
          EXPECT_NEAR(slope, -(k < 3 ? system.force[i][k] : system.moment[i][k - 3]), 1e-8 * size);
        }
    }
}

TEST(BeamPack, series_of_small_angles_agree_with_the_closed_forms_up_to_the_switch) {
  for (const double share : {0.5, 1.})
    for (const double t : {1., 0.7887}) {
      SCOPED_TRACE(testing::Message() << share << " of the switch, t " << t);
      const long double a = t * std::sqrt(static_cast<long double>(share * k_small_angle)), x = a * a,
                        s = std::sin(a), c = std::cos(a);
      const long double f0 = s / a, f1 = (1 - c) / x, f2 = (a - s) / (a * x);
      const PackAngle<Four> angle = small_angle(Four(share * k_small_angle), Four(t));
      const PackAngleSlope<Four> slope = small_angle_slope(Four(share * k_small_angle), Four(t));
      const auto relative = [](Four value, long double exact) {
        return std::abs(static_cast<double>(value[3] / exact - 1));
      };
      // Terms left out: 2e-16 and less, but for left2's slope, 5 5!/13! x^4 = 3e-13. Of the closed forms in
      // long double 7e-14 is left there after two cancellations, 1e-15 elsewhere.
      EXPECT_LT(relative(angle.cosine, std::cos(a / 2)), 1e-14);
      EXPECT_LT(relative(angle.sine, t * std::sin(a / 2) / a), 1e-14);
      EXPECT_LT(relative(angle.left1, t * f1), 1e-14);
      EXPECT_LT(relative(angle.left2, t * t * f2), 1e-14);
      EXPECT_LT(relative(slope.left1, t * t * t * (f0 - 2 * f1) / (2 * x)), 1e-14);
      EXPECT_LT(relative(slope.left2, t * t * t * t * (f1 - 3 * f2) / (2 * x)), 1e-12);
    }
}

}  // namespace
}  // namespace topple::test
