#include "solver/contact/member_contact.h"

#include <Eigen/LU>
#include <cmath>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_member_width = 0.03;

/// Two elements on four nodes of their own.
struct Pair {
  std::vector<MemberPair> pairs{1};
  std::vector<Vec3> position, velocity{4, Vec3::Zero()};

  explicit Pair(std::vector<Vec3> ends) : position(std::move(ends)) {
    MemberPair& pair = pairs[0];
    pair.elements = {0, 1};
    pair.node = {0, 1, 2, 3};
    pair.L = k_member_width;
    pair.mass = 1;
    for (int k = 0; k < 4; ++k) pair.start[k] = position[k];
    pair.stick.fill(Vec3::Zero());
  }
  MemberContacts find(const ContactLaw& law) const {
    MemberContacts found;
    find_member_contacts(law, pairs, position, velocity, position, found);
    return found;
  }
  std::vector<Vec3> force(const ContactLaw& law) const {
    std::vector<Vec3> force(4, Vec3::Zero());
    add_forces(find(law), pairs, force);
    return force;
  }
  double energy(const ContactLaw& law) const { return stored_energy(law, find(law), pairs); }
};

/// Lines at any place that touch; `angle`: between them, rad.
Pair random_pair(std::mt19937& rng, double angle) {
  std::uniform_real_distribution<double> u(-1, 1);
  const Quat turn = random_rotation(rng);
  const Vec3 origin = random_vector(rng);
  const Vec3 a = 0.2 * Vec3::UnitX(), b = 0.15 * Vec3(std::cos(angle), std::sin(angle), 0.02 * u(rng));
  const Vec3 off(0.1 * u(rng), 0.008 * u(rng), k_member_width * (0.5 + 0.4 * u(rng)));
  std::vector<Vec3> ends = {-a, a, off - b, off + b};
  for (Vec3& x : ends) x = origin + turn * x;
  return Pair(ends);
}

// Angles on either side of where two lines count as parallel, and across.
constexpr double k_angles[] = {0, 0.01, 0.03, 0.07, 0.099, 0.11, 0.5, 1.5};

TEST(MemberContact, force_is_the_derivative_of_the_energy) {
  std::mt19937 rng(1);
  const ContactLaw law = elastic_law();
  int touching = 0;
  for (double angle : k_angles)
    for (int trial = 0; trial < 20; ++trial) {
      Pair pair = random_pair(rng, angle);
      const std::vector<Vec3> force = pair.force(law);
      touching += !force[0].isZero(0) || !force[1].isZero(0);
      double scale = 0;
      for (const Vec3& f : force) scale = std::max(scale, f.norm());
      for (int i = 0; i < 12; ++i) {
        const double h = 1e-7;
        double& x = pair.position[i / 3][i % 3];
        const double x0 = x;
        x = x0 + h;
        const double above = pair.energy(law);
        x = x0 - h;
        const double below = pair.energy(law);
        x = x0;
        // central differences: h^2 times third derivatives, and rounding eps U/h
        EXPECT_NEAR(force[i / 3][i % 3], -(above - below) / (2 * h), 1e-5 * (1 + scale))
            << "angle " << angle << " trial " << trial << " direction " << i;
      }
    }
  EXPECT_GT(touching, 80);
}

TEST(MemberContact, force_and_moment_of_the_pair_vanish) {
  std::mt19937 rng(2);
  for (double angle : k_angles)
    for (int trial = 0; trial < 20; ++trial) {
      const Pair pair = random_pair(rng, angle);
      const std::vector<Vec3> force = pair.force(elastic_law());
      Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
      double scale = 0;
      for (int k = 0; k < 4; ++k) {
        sum += force[k];
        moment += pair.position[k].cross(force[k]);
        scale = std::max(scale, force[k].norm());
      }
      EXPECT_LT(sum.norm(), 1e-13 * scale + 1e-13) << angle;
      EXPECT_LT(moment.norm(), 1e-12 * scale + 1e-12) << angle;
    }
}

// At ends, at nearest points, and where the two are blended: to rounding.
TEST(MemberContact, share_of_alpha_is_as_an_alpha_of_that_size) {
  std::mt19937 rng(5);
  ContactLaw shared, own;
  shared.member_share = 0.25;
  own.alpha *= 0.25;
  int compared = 0;
  for (double angle : {0., 0.03, 0.06, 0.5})
    for (int trial = 0; trial < 10; ++trial) {
      Pair pair = random_pair(rng, angle);
      const MemberContacts a = pair.find(shared), b = pair.find(own);
      std::vector<Vec3> of_a(4, Vec3::Zero()), of_b = of_a;
      add_forces(a, pair.pairs, of_a);
      add_forces(b, pair.pairs, of_b);
      for (int k = 0; k < 4; ++k)
        EXPECT_LT((of_a[k] - of_b[k]).norm(), 1e-12 * (1 + of_b[k].norm())) << angle;
      EXPECT_NEAR(stored_energy(shared, a, pair.pairs), stored_energy(own, b, pair.pairs), 1e-12) << angle;
      compared += static_cast<int>(b.touches.size());
    }
  EXPECT_GT(compared, 40);
}

/// -d(force)/d(position) - factor d(force)/d(velocity).
Eigen::Matrix<double, 12, 12> tangent_of(const ContactLaw& law, const MemberContacts& found, const Pair& pair,
                                         double factor) {
  Eigen::Matrix<double, 12, 12> sum = Eigen::Matrix<double, 12, 12>::Zero();
  add_tangent(law, found, pair.pairs, pair.position, factor,
              [&](int i, int j, const Mat3& block) { sum.block<3, 3>(3 * i, 3 * j) += block; });
  return sum;
}

TEST(MemberContact, tangent_is_the_derivative_of_the_force) {
  std::mt19937 rng(3);
  ContactLaw law;  // with damping and friction
  for (double angle :
       {0., 0.11, 0.5, 1.5})  // where the lines are blended kappa's second derivative is left out
    for (int trial = 0; trial < 10; ++trial) {
      Pair pair = random_pair(rng, angle);
      const Vec3 slide = random_vector(rng, 0.03);
      pair.velocity[0] = pair.velocity[1] = slide;
      MemberContacts found = pair.find(law);
      if (found.touches.empty()) continue;
      Eigen::Matrix<double, 12, 12> by_difference;
      double scale = 0;
      const double h = 1e-7, factor = 200;
      // slipping or sticking from one start: the stick springs see the travel, the velocity goes along
      const auto force_at = [&](int i, double step) {
        MemberContacts contacts;
        std::vector<Vec3> x = pair.position, v = pair.velocity, force(4, Vec3::Zero());
        x[i / 3][i % 3] += step;
        v[i / 3][i % 3] += factor * step;
        find_member_contacts(law, pair.pairs, x, v, pair.position, contacts);
        add_forces(contacts, pair.pairs, force);
        return force;
      };
      for (int i = 0; i < 12; ++i) {
        const std::vector<Vec3> above = force_at(i, h), below = force_at(i, -h);
        for (int k = 0; k < 4; ++k) {
          by_difference.block<3, 1>(3 * k, i) = -(above[k] - below[k]) / (2 * h);
          scale = std::max(scale, by_difference.block<3, 1>(3 * k, i).norm());
        }
      }
      // normals turn with the lines: velocities along the old ones are left out, of the order v/(w h)
      const Eigen::Matrix<double, 12, 12> off = tangent_of(law, found, pair, factor) - by_difference;
      EXPECT_LT(off.norm(), 0.02 * by_difference.norm()) << angle << " " << trial;
    }
}

TEST(MemberContact, side_is_kept_when_centre_lines_go_through_each_other) {
  Pair pair({{-0.2, 0, 0.01}, {0.2, 0, 0.01}, {0, -0.2, 0}, {0, 0.2, 0}});
  for (double height : {0.01, 0.001, -0.001, -0.01}) {
    pair.position[0].z() = pair.position[1].z() = height;
    const MemberContacts found = pair.find(elastic_law());
    ASSERT_EQ(found.touches.size(), 1u);
    EXPECT_NEAR(found.touches[0].l, height, 1e-15);
    EXPECT_GT(found.touches[0].out.force.z(), 0);
    EXPECT_EQ(passed_unseen(found, pair.pairs, pair.position, pair.position), height > 0 ? -1 : 0);
  }
}

TEST(MemberContact, side_by_side_they_touch_as_much_as_across) {
  // aligned: four ends with a quarter each hold as much as one crossing
  const double height = 0.4 * k_member_width;
  const Pair across({{-0.2, 0, height}, {0.2, 0, height}, {0, -0.2, 0}, {0, 0.2, 0}});
  const Pair along({{-0.2, 0, height}, {0.2, 0, height}, {-0.2, 0, 0}, {0.2, 0, 0}});
  const ContactLaw law = elastic_law();
  EXPECT_NEAR(along.energy(law), across.energy(law), 1e-15);
  EXPECT_EQ(along.find(law).touches.size(), 4u);
  EXPECT_EQ(across.find(law).touches.size(), 1u);
}

TEST(MemberContact, hardening_keeps_force_and_energy_smooth_and_takes_any_blow) {
  const ContactLaw law = elastic_law();
  const double L = k_member_width, h = 1e-7;
  for (double depth : {0.3, 0.8, 0.81, 0.9, 0.97, 0.996, 0.999, 1.01}) {
    const double slope =
        (penalty_energy(law, depth + h, L, true) - penalty_energy(law, depth - h, L, true)) / (2 * h * L);
    EXPECT_NEAR(slope / penalty_force(law, depth, true), 1, 1e-6) << depth;
  }
  // 300 J, what a cabinet that falls flat brings, on one contact stay outside the centre line
  EXPECT_GT(penalty_energy(law, 1, L, true), 300);
  EXPECT_EQ(penalty_force(law, 0.79, true), penalty_force(law, 0.79));
}

TEST(MemberContact, tangent_without_friction_is_the_second_derivative_of_the_energy) {
  std::mt19937 rng(4);
  const ContactLaw law = elastic_law();
  const double height = 0.6 * k_member_width;
  const std::vector<std::vector<Vec3>> ends = {
      {{-0.2, 0, height}, {0.3, 0, height}, {0, -0.2, 0}, {0.01, 0.2, 0}},      // between all ends
      {{-0.2, 0, height}, {0.3, 0, height}, {0.02, 0.004, 0}, {0.05, 0.2, 0}},  // b's first over a
      {{0.02, 0.004, height}, {0.05, 0.2, height}, {-0.2, 0, 0}, {0.3, 0, 0}},  // a's first over b
      {{0, 0.004, height}, {0, 0.2, height}, {0.005, 0, 0}, {0.3, 0.01, 0}}};   // both
  const bool free[][2] = {{true, true}, {true, false}, {false, true}, {false, false}};
  for (std::size_t k = 0; k < ends.size(); ++k) {
    Pair pair(ends[k]);
    const Quat turn = random_rotation(rng);
    for (Vec3& x : pair.position) x = turn * x;
    for (int i = 0; i < 4; ++i) pair.pairs[0].start[i] = pair.position[i];
    pair.velocity[0] = pair.velocity[1] = Vec3(0.1, 0.2, 0.3);  // it slides, at no cost
    const MemberContacts found = pair.find(law);
    ASSERT_EQ(found.touches.size(), 1u);
    ASSERT_EQ(found.touches[0].s_free, free[k][0]) << k;
    ASSERT_EQ(found.touches[0].t_free, free[k][1]) << k;
    Eigen::Matrix<double, 12, 12> exact;
    const double h = 1e-6;
    for (int j = 0; j < 12; ++j) {
      double& x = pair.position[j / 3][j % 3];
      const double x0 = x;
      x = x0 + h;
      const std::vector<Vec3> above = pair.force(law);
      x = x0 - h;
      const std::vector<Vec3> below = pair.force(law);
      x = x0;
      for (int i = 0; i < 12; ++i) exact(i, j) = -(above[i / 3] - below[i / 3])[i % 3] / (2 * h);
    }
    // central differences err by (h/l)^2 = 3e-9, and rounding of the forces by 1e-16 P/h
    const double scale = exact.cwiseAbs().maxCoeff();
    EXPECT_LT((tangent_of(law, found, pair, 0) - exact).cwiseAbs().maxCoeff(), 1e-6 * scale) << k;
  }
}

}  // namespace
}  // namespace topple::test
