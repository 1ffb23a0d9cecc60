#include "solver/reduced/rigid_pair_slopes.h"

#include <gtest/gtest.h>

#include <random>

#include "solver/math/rotation.h"

namespace topple::test {
namespace {

Mat6 carried_one_by_one(const PairTangent& tangent, const MemberPair& pair, std::span<const Vec3> arm, int i,
                        int j) {
  Mat6 sum = Mat6::Zero();
  const auto motion = [&](int k) {
    Eigen::Matrix<double, 3, 6> out;
    out << Mat3::Identity(), -skew(arm[pair.node[k]]);
    return out;
  };
  for (int k = 2 * i; k < 2 * i + 2; ++k)
    for (int m = 2 * j; m < 2 * j + 2; ++m) {
      Mat3 block = tangent.share[k] * tangent.share[m] * tangent.local;
      for (int p = 0; p < tangent.product_count; ++p)
        block += tangent.products[p].left[k] * tangent.products[p].right[m].transpose();
      sum += motion(k).transpose() * block * motion(m);
    }
  return sum;
}

// Against the tangents of single touches and blends between the ends of elements, whose derivatives
// member_contact_test.cpp looks at: to rounding. Parallel, blended and crossing, sticking and slipping.
TEST(RigidPairSlopes, are_those_of_single_touches_carried_to_the_bodies) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto random = [&](double size) { return Vec3(size * Vec3(any(rng), any(rng), any(rng))); };
  for (const double angle : {0., 0.05, 0.8})
    for (const double factor : {0., 300.})
      for (const double slip : {0., 0.5}) {
        ContactLaw law;
        law.friction_static = 0.9;
        std::vector<Vec3> position, arm, velocity;
        std::vector<MemberPair> pairs;
        const Vec3 centres[2] = {{0.3, -0.2, 0.5}, {-0.4, 0.1, -0.6}};
        for (int n = 0; n < 3; ++n) {
          MemberPair pair{};
          const Vec3 ends[4] = {{-0.5, 0, 0.027},
                                {0.5, 0.01 * n, 0.026},
                                {-0.5 * std::cos(angle), -0.5 * std::sin(angle), 0},
                                {0.45 * std::cos(angle), 0.45 * std::sin(angle), 0.001}};
          for (int k = 0; k < 4; ++k) {
            pair.node[k] = static_cast<int>(position.size());
            position.push_back(ends[k] + Vec3(0, n, 0));
            arm.push_back(position.back() - centres[k / 2]);
            velocity.push_back((k < 2 ? Vec3(slip, 0.3 * slip, -0.02) : Vec3(0, 0, 0)) + random(1e-3));
            pair.start[k] = position.back();
          }
          pair.L = 0.03;
          pair.mass = 5;
          pair.stick.fill(random(1e-7));
          pairs.push_back(pair);
        }
        MemberContacts contacts;
        find_member_contacts(law, pairs, position, velocity, position, contacts);
        ASSERT_GE(contacts.touches.size(), 3u);
        RigidPairSlopes slopes(law, position, arm, factor);
        for (const MemberTouch& touch : contacts.touches) slopes.add(touch, pairs[touch.pair]);
        for (const MemberBlend& blend : contacts.blends)
          slopes.add_blend(blend_tangent(blend), pairs[blend.pair]);
        slopes.end();
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) {
            Mat6 expected = Mat6::Zero();
            const auto add = [&](const PairTangent& tangent) {
              expected += carried_one_by_one(tangent, pairs[tangent.pair], arm, i, j);
            };
            for (const MemberTouch& touch : contacts.touches)
              add(touch_tangent(law, touch, pairs[touch.pair], position, factor));
            for (const MemberBlend& blend : contacts.blends) add(blend_tangent(blend));
            EXPECT_LT((slopes.block(i, j) - expected).cwiseAbs().maxCoeff(),
                      1e-10 * expected.cwiseAbs().maxCoeff())
                << angle << ' ' << factor << ' ' << slip << ' ' << i << j;
          }
      }
}

}  // namespace
}  // namespace topple::test
