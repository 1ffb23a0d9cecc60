// Paths of load steps that go on: arc length, and what is told of the stability of equilibria.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "solver/run/run.h"
#include "unit/solver/fixtures.h"
#include "unit/solver/step/lees_frame.h"

namespace topple::test {
namespace {

// A plane rod with stretch and shear (Reissner 1972) along Lee's frame, from its first foot: force and turn
// there give all that follows.
class ExactFrame {
 public:
  static constexpr double k_leg = 120, k_load_at = 144;
  static constexpr double k_axial = 7.2e6 * 6, k_bend = 7.2e6 * 2, k_shear = 7.2e6 / 2.6 * 6;

  struct Ends {
    Eigen::Vector3d left;  ///< x and z beside the second foot, and the moment there
    double down;           ///< of the loaded point
  };
  // `a`: force on the rod at the foot, x and z; its turn from upright, clockwise; load, downwards.
  static Ends shoot(const Eigen::Vector4d& a) {
    constexpr int k_steps = 400;        // per 24 of length
    Eigen::Vector4d y(0, 0, a[2], 0);   // x, z, turn, moment that turns on clockwise
    Eigen::Vector2d force(a[0], a[1]);  // that the part behind puts on what follows
    Ends out{};
    constexpr double h = 24. / k_steps;
    for (int i = 0; i < 10 * k_steps; ++i) {
      if (i == 5 * k_steps) y[2] += k_pi / 2;  // the corner
      if (i == 6 * k_steps) {
        out.down = k_leg - y[1];
        force.y() -= a[3];
      }
      const auto slope = [&](const Eigen::Vector4d& at) {
        // along the rod, turn measured from +z to +x
        const Eigen::Vector2d t(std::sin(at[2]), std::cos(at[2])), n(std::cos(at[2]), -std::sin(at[2]));
        const Eigen::Vector2d way = (1 - force.dot(t) / k_axial) * t - force.dot(n) / k_shear * n;
        return Eigen::Vector4d(way.x(), way.y(), at[3] / k_bend, way.y() * force.x() - way.x() * force.y());
      };
      const Eigen::Vector4d k1 = slope(y), k2 = slope(y + h / 2 * k1), k3 = slope(y + h / 2 * k2),
                            k4 = slope(y + h * k3);
      y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    out.left = {y[0] - k_leg, y[1] - k_leg, y[3]};
    return out;
  }

  /// The point of the exact path on the line through (down, load) that is normal to `along`, in units of the
  /// two scales; starts from the last one found.
  bool find(double down, double load, const Eigen::Vector2d& along) {
    for (int round = 0; round < 30; ++round) {
      const auto residual = [&](const Eigen::Vector4d& a) {
        const Ends ends = shoot(a);
        Eigen::Vector4d r;
        r << ends.left / k_leg, along.x() * (ends.down - down) / k_down + along.y() * (a[3] - load) / k_load;
        r[2] = ends.left[2] * k_leg / k_bend;
        return r;
      };
      const Eigen::Vector4d r = residual(at_);
      if (r.cwiseAbs().maxCoeff() < 1e-10) return true;
      Eigen::Matrix4d slope;
      for (int k = 0; k < 4; ++k) {
        Eigen::Vector4d moved = at_;
        const double by = k == 2 ? 1e-6 : 1e-2;
        moved[k] += by;
        slope.col(k) = (residual(moved) - r) / by;
      }
      at_ -= slope.lu().solve(r);
    }
    return false;
  }
  double load() const { return at_[3]; }
  double down() const { return shoot(at_).down; }

  static constexpr double k_down = 60, k_load = 1e4;

 private:
  Eigen::Vector4d at_ = Eigen::Vector4d::Zero();
};

// Snapping through and back: over the first limit load (18 546 by method), down where the loaded point turns
// back, and over the second limit load, below zero.
TEST(LoadPath, arc_length_follows_lees_frame_over_both_limit_loads) {
  topple::Setup setup = lees_frame(20);
  const int node = 24;
  for (int i = 0; i < setup.model.node_total(); ++i)
    setup.model.supports.push_back({i, 0x2a});  // in its plane
  setup.run.statics = {.load_steps = 116, .control = PathControl{.to = 138., .arc_length = true}};
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  ExactFrame exact;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  std::vector<double> loads;
  std::vector<int> negative;
  double furthest = 0, back = 1e9;
  while (!run.over()) {
    ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
    const double down = 120 - run.state().position[node].z(), load = 1000 * run.state().load_factor;
    const Eigen::Vector2d here(down / ExactFrame::k_down, load / ExactFrame::k_load);
    ASSERT_TRUE(exact.find(down, load, (here - last).normalized())) << down << " " << load;
    const Eigen::Vector2d off(exact.down() / ExactFrame::k_down - here.x(),
                              exact.load() / ExactFrame::k_load - here.y());
    // second order in the length of members, of which there are 40; straight ones stand for bent ones
    EXPECT_LT(off.norm(), 5e-3) << down << " " << load;
    last = here;
    loads.push_back(load);
    negative.push_back(run.load_steps().back().stability.negative_pivots);
    if (down > furthest) furthest = down;
    if (loads.size() > 1 && down < furthest) back = std::min(back, down);
  }
  const auto first = std::ranges::max_element(loads), second = std::min_element(first, loads.end());
  EXPECT_NEAR(*first, 18546.5, 100);
  EXPECT_LT(*second, -9000);
  EXPECT_LT(back, furthest - 5);            // the loaded point turns back
  EXPECT_GT(loads.back(), *second + 5000);  // and the load rises again
  const auto at = [&](const auto& place) { return static_cast<std::size_t>(place - loads.begin()); };
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const bool falls = i > at(first) + 1 && i < at(second);
    const bool rises = i < at(first) || i > at(second) + 1;
    EXPECT_TRUE(!falls || negative[i] >= 1) << i;
    EXPECT_TRUE(!rises || negative[i] == 0) << i;
  }
  EXPECT_EQ(run.load_steps()[at(first) + 3].stability.loss, Stability::Loss::limit_point);
}

// Out of its plane it buckles before its limit load, in two ways: no limit point is told before the load
// falls.
TEST(LoadPath, what_is_lost_first_is_told_first) {
  topple::Setup setup = lees_frame(20);
  setup.run.statics = {.load_steps = 60, .control = PathControl{.to = 50., .arc_length = true}};
  topple::Run run(setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(setup.model);
  const std::vector<LoadStep>& steps = run.load_steps();
  const auto peak = std::ranges::max_element(steps, {}, &LoadStep::factor);
  int buckled = 0, limits = 0;
  for (auto step = steps.begin(); step != steps.end(); ++step) {
    const Stability::Loss loss = step->stability.loss;
    if (step < peak) {
      EXPECT_NE(loss, Stability::Loss::limit_point) << step->factor;
    }
    buckled += step < peak && loss == Stability::Loss::buckling ? 1 : 0;
    limits += step > peak && loss == Stability::Loss::limit_point ? 1 : 0;
  }
  EXPECT_GT(buckled, 0);
  EXPECT_GT(limits, 0);
  EXPECT_GT(steps.end() - peak, 3);
}

// A stocky cantilever, loaded across its strong axis, goes sideways long before it bends down: at 0.62 of
// this load.
TEST(LoadPath, lateral_buckling_is_called_so) {
  for (const bool stop : {true, false}) {
    topple::Setup setup;
    setup.model.materials.push_back(steel());
    setup.model.sections.push_back(
        plain_section(0.05, 0.5 * 1e-3 / 12, 0.1 * 0.125 / 12, 1e-3, 5. / 6, 5. / 6));
    FrameSpec spec;
    spec.name = "strip";
    for (int i = 0; i <= 8; ++i) spec.nodes.push_back({0.25 * i, 0, 0});
    for (int i = 0; i < 8; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
    spec.supports.push_back({0, k_clamped});
    spec.loads.push_back({8, {0, 6.25e7, 0}, Vec3::Zero(), {}});
    setup.starts = add_frame(setup.model, spec);
    setup.parameters.gravity.setZero();
    setup.run = {.analysis = Analysis::statics,
                 .statics = {.load_steps = 20, .stop_at_instability = stop},
                 .settle = false};
    topple::Run run(setup);
    while (!run.over()) run.advance();
    const auto unstable =
        std::ranges::find_if(run.load_steps(), [](const LoadStep& step) { return !step.stability.stable(); });
    ASSERT_NE(unstable, run.load_steps().end());
    EXPECT_EQ(unstable->stability.loss, Stability::Loss::buckling);
    EXPECT_EQ(unstable->stability.negative_pivots, 1);
    EXPECT_EQ(unstable->stability.node, 8);
    EXPECT_NEAR(std::abs(unstable->stability.direction.z()), 1, 1e-9);
    if (stop) {
      EXPECT_NEAR(run.state().load_factor, 0.62, 0.005);  // as printed, two digits
      EXPECT_TRUE(run.status().ok() && run.stopped_early());
      EXPECT_FALSE(unstable->converged);
    } else {  // on the straight branch, which is told to be unstable from there on
      ASSERT_TRUE(run.status().ok());
      EXPECT_EQ(run.state().load_factor, 1);
      EXPECT_NEAR(unstable->factor, 0.65, 1e-9);
    }
  }
}

}  // namespace
}  // namespace topple::test
