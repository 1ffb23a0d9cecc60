// Tips of members on panels.
#include <Eigen/LU>
#include <cmath>

#include "solver/contact/member_contact.h"
#include "solver/contact/panel_place.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_sheet_width = 0.03;

/// A sheet of 0.4 m by 0.3 m with a member along each side and one across, in the plane z = 0.
Panel sheet() {
  Panel panel{0, {2, 3, 4, 5}, k_sheet_width, {}, {}};
  panel.corner = {Panel::Place(0, 0), Panel::Place(0.4, 0), Panel::Place(0.4, 0.3), Panel::Place(0, 0.3)};
  for (int k = 0; k < 4; ++k) panel.members.push_back({panel.corner[k], panel.corner[(k + 1) % 4]});
  panel.members.push_back({panel.corner[0], panel.corner[2]});
  return panel;
}

/// An element whose first end is a tip at `tip`, m, in the sheet's axes; corners off their places by `warp`,
/// m; turned and moved.
struct OnSheet {
  Panel panel = sheet();
  std::vector<MemberPair> pairs{1};
  std::vector<Vec3> position, velocity{6, Vec3::Zero()};

  OnSheet(const Vec3& tip, double warp, std::mt19937& rng) {
    position = {tip, tip + Vec3(0.05, 0.02, 0.3)};
    for (const Panel::Place& corner : panel.corner)
      position.push_back(Vec3(corner.x(), corner.y(), 0) + warp * random_vector(rng));
    const Quat turn = random_rotation(rng);
    const Vec3 origin = random_vector(rng);
    for (Vec3& x : position) x = origin + turn * x;
    MemberPair& pair = pairs[0];
    pair.elements = {0, 1};
    pair.panel = &panel;
    pair.tip = {true, false};
    pair.node = {0, 1, 2, 3, 4, 5};
    pair.L = k_sheet_width;
    pair.mass = 1;
    pair.stick.fill(Vec3::Zero());
    start();
  }
  OnSheet(const OnSheet&) = delete;

  void start() {
    for (int k = 0; k < 6; ++k) pairs[0].start[k] = position[k];
  }
  MemberContacts find(const ContactLaw& law) const {
    MemberContacts found;
    find_member_contacts(law, pairs, position, velocity, position, found);
    return found;
  }
  std::vector<Vec3> force(const ContactLaw& law) const {
    std::vector<Vec3> force(6, Vec3::Zero());
    add_forces(find(law), pairs, force);
    return force;
  }
  double energy(const ContactLaw& law) const { return stored_energy(law, find(law), pairs); }
  /// df/dx of f() by central differences over h, m.
  template <class F>
  auto derivative(int direction, double h, F f) {
    double& x = position[direction / 3][direction % 3];
    const double x0 = x;
    x = x0 + h;
    const auto above = f();
    x = x0 - h;
    const auto below = f();
    x = x0;
    return std::pair(above, below);
  }
};

/// Above and below the sheet, in its middle and within reach of members.
std::vector<Vec3> tips(std::mt19937& rng) {
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec3> at;
  for (int trial = 0; trial < 40; ++trial) {
    const double side = trial % 2 == 0 ? 1 : -1, z = side * k_sheet_width * (0.5 + 0.4 * u(rng));
    at.push_back({0.3 + 0.002 * u(rng), 0.1 + 0.002 * u(rng), z});     // clear of all members
    at.push_back({0.2 + 0.1 * u(rng), 0.008 + 0.006 * u(rng), z});     // beside a side
    at.push_back({0.008 + 0.006 * u(rng), 0.29 + 0.006 * u(rng), z});  // in a corner of two sides
    at.push_back({0.2 + 0.01 * u(rng), 0.15 + 0.002 * u(rng), z});     // beside the diagonal
  }
  return at;
}

TEST(PanelContact, force_is_the_derivative_of_the_energy) {
  std::mt19937 rng(11);
  const ContactLaw law = elastic_law();
  int touching = 0, giving_way = 0;
  for (const double warp : {0., 1e-3})
    for (const Vec3& tip : tips(rng)) {
      OnSheet on(tip, warp, rng);
      const std::vector<Vec3> force = on.force(law);
      const MemberContacts found = on.find(law);
      touching += static_cast<int>(found.touches.size());
      giving_way += static_cast<int>(found.blends.size());
      double scale = 0;
      for (const Vec3& f : force) scale = std::max(scale, f.norm());
      for (int i = 0; i < 18; ++i) {
        const double h = 1e-7;
        const auto [above, below] = on.derivative(i, h, [&] { return on.energy(law); });
        // central differences: h^2 times third derivatives, and rounding eps U/h
        EXPECT_NEAR(force[i / 3][i % 3], -(above - below) / (2 * h), 1e-5 * (1 + scale))
            << tip.transpose() << ", direction " << i;
      }
    }
  EXPECT_GT(touching, 280);
  EXPECT_GT(giving_way, 200);
}

// A parallelogram, whose sides are not square to each other: the tip is over the same place of it.
TEST(PanelContact, a_skewed_panel_is_touched_where_the_tip_is) {
  std::mt19937 rng(14);
  for (const double skew : {-0.8, 0.8})
    for (const auto& [u, v] : {std::pair(0.75, 0.3), std::pair(0.25, 0.7), std::pair(0.9, 0.6)}) {
      OnSheet on(Vec3(0.4 * u, 0.3 * v, 0.5 * k_sheet_width), 0, rng);
      const Vec3 along = skew * (on.position[3] - on.position[2]);
      on.position[0] += v * along;
      on.position[1] += v * along;
      on.position[4] += along;
      on.position[5] += along;
      on.start();
      const MemberContacts found = on.find(elastic_law());
      ASSERT_EQ(found.touches.size(), 1u) << skew << ": " << u << ", " << v;
      EXPECT_NEAR(found.touches[0].t, u, 1e-13);
      EXPECT_NEAR(found.touches[0].u, v, 1e-13);
      EXPECT_NEAR(found.touches[0].l, 0.5 * k_sheet_width, 1e-15);
    }
}

TEST(PanelContact, force_and_moment_of_the_pair_vanish) {
  std::mt19937 rng(12);
  for (const Vec3& tip : tips(rng)) {
    const OnSheet on(tip, 1e-3, rng);
    const std::vector<Vec3> force = on.force(elastic_law());
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double scale = 0;
    for (int k = 0; k < 6; ++k) {
      sum += force[k];
      moment += on.position[k].cross(force[k]);
      scale = std::max(scale, force[k].norm());
    }
    EXPECT_LT(sum.norm(), 1e-13 * scale + 1e-13);
    EXPECT_LT(moment.norm(), 1e-12 * scale + 1e-12);
  }
}

// Where the panel carries all; else the derivatives of its share's slope are left out, by design.
TEST(PanelContact, tangent_is_the_derivative_of_the_force) {
  std::mt19937 rng(13);
  const ContactLaw law = elastic_law();
  for (const double z : {0.5, -0.8, 0.05}) {
    OnSheet on(Vec3(0.3, 0.1, z * k_sheet_width), 0, rng);
    on.velocity[0] = Vec3(0.1, 0.2, 0.3);  // it slides, at no cost
    ASSERT_EQ(on.find(law).touches.size(), 1u);
    Eigen::Matrix<double, 18, 18> exact, tangent = Eigen::Matrix<double, 18, 18>::Zero();
    const double h = 1e-7;
    for (int j = 0; j < 18; ++j) {
      const auto [above, below] = on.derivative(j, h, [&] { return on.force(law); });
      for (int i = 0; i < 18; ++i) exact(i, j) = -(above[i / 3] - below[i / 3])[i % 3] / (2 * h);
    }
    add_tangent(law, on.find(law), on.pairs, on.position, 0,
                [&](int i, int j, const Mat3& block) { tangent.block<3, 3>(3 * i, 3 * j) += block; });
    // central differences err by (h/l)^2 = 4e-9, and rounding of the forces by 1e-16 P/h
    EXPECT_LT((tangent - exact).cwiseAbs().maxCoeff(), 1e-6 * exact.cwiseAbs().maxCoeff()) << z;
  }
}

// A tip keeps its side while it goes through the middle plane, from above and from below.
TEST(PanelContact, the_side_of_the_start_pushes_back) {
  std::mt19937 rng(14);
  const ContactLaw law = elastic_law();
  for (const double side : {1., -1.}) {
    OnSheet on(Vec3(0.3, 0.1, side * 0.2 * k_sheet_width), 0, rng);
    const Vec3 up = on.force(law)[0].normalized();
    on.position[0] -= 0.4 * k_sheet_width * up;
    const MemberContacts found = on.find(law);
    ASSERT_EQ(found.touches.size(), 1u);
    EXPECT_NEAR(found.touches[0].l, -0.2 * k_sheet_width, 1e-12);
    EXPECT_GT(on.force(law)[0].dot(up), 0);
    std::vector<Vec3> before(6);
    for (int k = 0; k < 6; ++k) before[k] = on.pairs[0].start[k];
    EXPECT_EQ(passed_unseen(found, on.pairs, before, on.position), 0);
  }
}

TEST(PanelContact, members_in_the_panel_are_touched_in_its_place) {
  std::mt19937 rng(15);
  const double z = 0.5 * k_sheet_width;
  const ContactLaw law = elastic_law();
  EXPECT_LT(OnSheet(Vec3(0.2, 0, z), 0, rng).energy(law), 1e-12);               // on a side
  EXPECT_TRUE(OnSheet(Vec3(0.2, -1e-4, z), 0, rng).find(law).touches.empty());  // beyond it
  EXPECT_LT(OnSheet(Vec3(0.2, 0.15, z), 0, rng).energy(law), 1e-12);            // on the diagonal
  const double whole = OnSheet(Vec3(0.3, 0.1, z), 0, rng).energy(law);
  EXPECT_NEAR(whole, penalty_energy(law, 0.5, k_sheet_width, true), 1e-12 * whole);
  EXPECT_NEAR(OnSheet(Vec3(0.25, k_sheet_width / 4, z), 0, rng).energy(law), whole / 2,
              1e-9 * whole);  // S(1/2)
}

// Newton's method on a warped sheet against a search by halving.
TEST(PanelPlaceTest, foot_is_nearest) {
  std::mt19937 rng(16);
  for (int trial = 0; trial < 50; ++trial) {
    const OnSheet on(Vec3(0.2, 0.1, 0.02), 0.01, rng);
    const std::array<Vec3, 4> corner{on.position[2], on.position[3], on.position[4], on.position[5]};
    const PanelPlace place = panel_place(on.position[0], corner);
    const auto distance = [&](double u, double v) {
      return (on.position[0] - (1 - u) * (1 - v) * corner[0] - u * (1 - v) * corner[1] - u * v * corner[2] -
              (1 - u) * v * corner[3])
          .norm();
    };
    EXPECT_NEAR(distance(place.r[0], place.r[1]), place.between.norm(), 1e-14);
    for (double step = 0.1; step > 1e-6; step /= 2)
      for (const auto& [du, dv] : {std::pair(step, 0.), {-step, 0.}, {0., step}, {0., -step}})
        EXPECT_GE(distance(place.r[0] + du, place.r[1] + dv), place.between.norm() - 1e-15);
  }
}

TEST(PanelPlaceTest, a_segment_crosses_within_the_sides_alone) {
  const std::array<Vec3, 4> corner{Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, 0.3, 0), Vec3(0, 0.3, 0)};
  EXPECT_TRUE(crosses_panel({0.1, 0.1, -1}, {0.1, 0.1, 0.2}, corner));
  EXPECT_FALSE(crosses_panel({0.1, 0.1, 0.1}, {0.1, 0.1, 0.2}, corner));
  EXPECT_FALSE(crosses_panel({0.5, 0.1, -1}, {0.5, 0.1, 1}, corner));
  EXPECT_TRUE(crosses_panel({-0.1, 0.1, -0.1}, {0.2, 0.1, 0.1}, corner));
}

}  // namespace
}  // namespace topple::test
