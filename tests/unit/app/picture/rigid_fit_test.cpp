// Rigid motion and deformation told apart.
#include "app/picture/rigid_fit.h"

#include <gtest/gtest.h>

#include "app/picture/row.h"
#include "solver/io/scene/scene.h"
#include "solver/math/rotation.h"
#include "unit/app/scenes.h"

namespace topple::app {
namespace {

// Rows hold places in single precision: 1e-7 of a few metres.
constexpr double k_rounding = 5e-7;

class RigidFitTest : public ::testing::Test {
 protected:
  RigidFitTest()
      : scene_(io::parse_scene(k_shaken, "s.toml")), row_(io::frame_row(topple::Run(scene_.setup))) {}
  const Model& model() const { return scene_.setup.model; }
  /// The reference pose moved by `motion`, with displacements added in its axes.
  io::FrameRow moved(const Eigen::Isometry3d& motion, const std::vector<Vec3>& displacements = {}) const {
    io::FrameRow row = row_;
    const Quat q(motion.linear());
    const double parts[4] = {q.w(), q.x(), q.y(), q.z()};
    for (int i = 0; i < model().node_total(); ++i) {
      const Vec3 own = displacements.empty() ? Vec3(Vec3::Zero()) : displacements[i];
      const Vec3 x = motion * (model().node_position[i] + own);
      for (int k = 0; k < 3; ++k) row.position[3 * i + k] = static_cast<float>(x[k]);
      for (int k = 0; k < 4; ++k) row.rotation[4 * i + k] = static_cast<float>(parts[k]);
    }
    return row;
  }
  static Eigen::Isometry3d some_motion() {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = exp_quaternion({1.1, -0.4, 2.0}).toRotationMatrix();
    motion.translation() = Vec3(0.7, -1.2, 0.4);
    return motion;
  }
  static double apart(const io::FrameRow& a, const io::FrameRow& b, int nodes) {
    double most = 0;
    for (int i = 0; i < nodes; ++i) most = std::max(most, (position(a, i) - position(b, i)).norm());
    return most;
  }

  io::Scene scene_;
  io::FrameRow row_;
};

TEST_F(RigidFitTest, a_rigidly_moved_body_has_no_displacement_at_any_exaggeration) {
  const io::FrameRow row = moved(some_motion());
  const RigidFit fit = rigid_fit(model(), row);
  for (int i = 0; i < model().node_total(); ++i)
    EXPECT_LT(displacement(model(), row, fit, i).norm(), k_rounding);
  for (const double factor : {1., 7., 200.}) {
    io::FrameRow drawn = row;
    exaggerate(model(), fit, factor, drawn);
    EXPECT_LT(apart(drawn, row, model().node_total()), factor * k_rounding);
  }
}

TEST_F(RigidFitTest, displacements_grow_in_proportion_and_the_rigid_motion_stays) {
  std::vector<Vec3> bend;
  for (const Vec3& x : model().node_position)
    bend.emplace_back(1e-3 * std::sin(2 * x.z()), 2e-3 * x.x() * x.z(), 1e-3 * x.y() * x.y());
  const io::FrameRow row = moved(some_motion(), bend);
  const RigidFit fit = rigid_fit(model(), row);
  for (const double factor : {2., 20.}) {
    io::FrameRow drawn = row;
    exaggerate(model(), fit, factor, drawn);
    for (int i = 0; i < model().node_total(); ++i)
      EXPECT_LT((displacement(model(), drawn, fit, i) - factor * displacement(model(), row, fit, i)).norm(),
                factor * k_rounding);
    // a best fit has no net turn left in its residuals, however large these are
    const RigidFit again = rigid_fit(model(), drawn);
    EXPECT_LT((again.motion[0].matrix() - fit.motion[0].matrix()).norm(), 1e-5);
  }
}

TEST_F(RigidFitTest, no_small_motion_beside_it_fits_better) {
  std::vector<Vec3> bend;
  for (const Vec3& x : model().node_position)
    bend.emplace_back(0.02 * x.z() * x.z(), 0.03 * x.x() * x.y(), 0);
  const io::FrameRow row = moved(some_motion(), bend);
  const Eigen::Isometry3d best = rigid_fit(model(), row).motion[0];
  const auto misfit = [&](const Eigen::Isometry3d& motion) {
    double sum = 0;
    for (int i = 0; i < model().node_total(); ++i)
      sum += model().node_mass[i] * (position(row, i) - motion * model().node_position[i]).squaredNorm();
    return sum;
  };
  const Vec3 centre = model().bodies[0].centre_of_gravity;
  for (int axis = 0; axis < 3; ++axis)
    for (const double step : {-1e-3, 1e-3}) {
      Eigen::Isometry3d turned = best, shifted = best;
      turned = best * Eigen::Translation3d(centre) * exp_quaternion(step * Vec3::Unit(axis)) *
               Eigen::Translation3d(-centre);
      shifted.translation()[axis] += step;
      EXPECT_GT(misfit(turned), misfit(best));
      EXPECT_GT(misfit(shifted), misfit(best));
    }
}

TEST_F(RigidFitTest, what_broke_off_moves_on_its_own) {
  io::FrameRow row = moved(Eigen::Isometry3d::Identity());
  // The first member is two elements; both break, and its middle node flies off.
  row.hinge[0] = row.hinge[1] = k_broken;
  const int middle = model().elements[0].node[1];
  row.position[3 * middle] += 0.8f;
  const RigidFit fit = rigid_fit(model(), row);
  EXPECT_EQ(fit.motion.size(), 2u);
  for (int i = 0; i < model().node_total(); ++i) {
    EXPECT_EQ(fit.piece[i] == fit.piece[middle], i == middle);
    EXPECT_LT(displacement(model(), row, fit, i).norm(), k_rounding);
  }
}

// A clamped beam has no rigid motion: what it shows is the deflection of theory, P L^3/(3 E I) + P L/(k G A),
// within what the rotation by 1.5e-4 rad makes different and the rounding of its row.
TEST(RigidFit, supports_that_hold_a_body_leave_it_where_it_is) {
  const io::Scene scene = io::parse_scene(R"(topple = 1
[run]
analysis = "static"
gravity = [0, 0, 0]
)" + k_library + R"(
[[frame]]
name = "beam"
nodes = [[0, 0, 0], [1, 0, 0]]
members = [{ nodes = [0, 1], section = "post", material = "steel" }]
supports = [{ node = 0, fix = "xyzXYZ" }]
loads = [{ node = 1, force = [0, 0, "-1 N"] }]
)",
                                          "beam.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  const io::FrameRow row = io::frame_row(run);
  const Model& model = scene.setup.model;
  const RigidFit fit = rigid_fit(model, row);
  EXPECT_EQ(fit.motion[0].matrix(), Eigen::Matrix4d::Identity());
  const Element& element = model.elements[0];
  const double theory = 1 / (3 * element.bending_stiffness.y()) + 1 / element.normal_stiffness.z();
  EXPECT_NEAR(-displacement(model, row, fit, model.elements[1].node[1]).z(), theory, 1e-3 * theory);
}

}  // namespace
}  // namespace topple::app
