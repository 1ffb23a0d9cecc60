#include "solver/run/overturn.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/model/block.h"
#include "solver/run/bearer.h"
#include "solver/state/sections.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

constexpr double k_depth = 0.38, k_breadth = 0.88, k_height = 1.05;  // of the centre of gravity
const double k_edge_angle = std::atan2(k_depth / 2, k_height);

struct Standing {
  Model model = steel_model();
  BodyStart start;
};

Standing standing(double tilt_angle = 0) {
  Standing s;
  CabinetSpec spec = tall_cabinet();
  spec.tilt = tilt_angle;
  s.start = add_cabinet(s.model, spec);
  s.model.planes.push_back(ground());
  return s;
}

BodyPose turned(const Model& model, const Vec3& rotation) {
  return {model.bodies[0].centre_of_gravity, exp_quaternion(rotation)};
}

TEST(Overturn, pose_of_a_rigidly_moved_body_is_its_motion) {
  std::mt19937 rng(61);
  const Standing s = standing();
  for (int i = 0; i < 20; ++i) {
    BodyStart start;
    start.pivot = random_vector(rng);
    start.rotation = 3 * random_direction(rng);
    SCOPED_TRACE(start.rotation.transpose());
    const BodyPose pose = body_pose(s.model, start_state(s.model, {start}), 0);
    const Quat exact = exp_quaternion(start.rotation);
    EXPECT_LT((exact.conjugate() * pose.rotation).vec().norm(), 1e-12);
    const Vec3 centre = start.pivot + exact * (s.model.bodies[0].centre_of_gravity - start.pivot);
    EXPECT_LT((pose.centre - centre).norm(), 1e-12);
  }
}

TEST(Overturn, pose_fits_the_nodes_best) {
  std::mt19937 rng(62);
  const Standing s = standing();
  State state = start_state(s.model, {BodyStart{}});
  for (Vec3& x : state.position) x += random_vector(rng, 0.02);
  const BodyPose pose = body_pose(s.model, state, 0);
  const auto misfit = [&](const Quat& q) {
    double sum = 0;
    for (int i = 0; i < s.model.node_total(); ++i)
      sum += s.model.node_mass[i] * (state.position[i] - pose.centre -
                                     q * (s.model.node_position[i] - s.model.bodies[0].centre_of_gravity))
                                        .squaredNorm();
    return sum;
  };
  for (int i = 0; i < 20; ++i)
    EXPECT_GT(misfit(exp_quaternion(1e-4 * random_direction(rng)) * pose.rotation), misfit(pose.rotation));
}

TEST(Overturn, tilt_is_the_angle_of_the_vertical_axis_whatever_the_yaw) {
  const Standing s = standing();
  for (double angle : {0., 1e-9, 0.1, 1.5, 3.}) {
    const Quat lean = exp_quaternion(angle * Vec3(0.6, 0.8, 0));
    for (double yaw : {0., 1., -2.}) {
      const BodyPose pose{Vec3::Zero(), exp_quaternion(yaw * Vec3::UnitZ()) * lean};
      EXPECT_NEAR(tilt(pose), angle, 1e-14) << yaw;
    }
  }
}

Stack alone(const Model& model) {
  return {model.bodies[0].mass, model.bodies[0].centre_of_gravity};
}

double critical_angle_alone(const Model& model, const BodyPose& pose) {
  return critical_angle(model, 0, pose, alone(model));
}

OverturnBarrier barrier_alone(const Model& model, const BodyPose& pose) {
  return overturn_barrier(model, 0, pose, alone(model), k_g);
}

TEST(Overturn, critical_angle_is_that_of_the_edge_or_corner_ahead) {
  const Standing s = standing();
  const auto critical = [&](double direction, double angle) {  // direction of the lean from +x towards +y
    const Vec3 axis(-std::sin(direction), std::cos(direction), 0);
    return critical_angle_alone(s.model, turned(s.model, angle * axis));
  };
  const double hx = k_depth / 2, hy = k_breadth / 2, corner = std::atan2(hy, hx);
  for (double angle : {1e-3, 0.1, 0.5}) {
    SCOPED_TRACE(angle);
    EXPECT_NEAR(critical(0, angle), std::atan2(hx, k_height), 1e-9);
    EXPECT_NEAR(critical(k_pi, angle), std::atan2(hx, k_height), 1e-9);
    EXPECT_NEAR(critical(k_pi / 2, angle), std::atan2(hy, k_height), 1e-9);
    EXPECT_NEAR(critical(corner, angle), std::atan2(std::hypot(hx, hy), k_height), 1e-9);
    // between: the distance to the edge that is met first
    for (double direction : {0.3, 0.9, 1.3, 2.2, 4.}) {
      const double distance =
          std::min(hx / std::abs(std::cos(direction)), hy / std::abs(std::sin(direction)));
      EXPECT_NEAR(critical(direction, angle), std::atan2(distance, k_height), 1e-9) << direction;
    }
  }
  // upright, within what counts as that: the nearest edge
  EXPECT_NEAR(critical_angle_alone(s.model, turned(s.model, Vec3::Zero())), k_edge_angle, 1e-9);
  EXPECT_NEAR(critical(k_pi / 2, 0.9 * k_uplift_angle), k_edge_angle, 1e-9);
}

// The centre of gravity of a body that turns about its edge rises by what the barrier says.
TEST(Overturn, barrier_is_the_weight_times_the_rise_to_above_the_edge) {
  const Standing s = standing();
  const Body& body = s.model.bodies[0];
  const Vec3 edge(body.base_centre.x() + k_depth / 2, 0, body.base_centre.z());
  const auto height = [&](double angle) {
    return (exp_quaternion(angle * Vec3::UnitY()) * (body.centre_of_gravity - edge)).z();
  };
  for (const double angle : {1e-9, 0.02, 0.1, 0.9 * k_edge_angle}) {
    const OverturnBarrier barrier = barrier_alone(s.model, turned(s.model, angle * Vec3::UnitY()));
    EXPECT_NEAR(barrier.left, body.mass * k_g * (height(k_edge_angle) - height(angle)), 1e-9) << angle;
    EXPECT_NEAR(barrier.whole, body.mass * k_g * (height(k_edge_angle) - height(0)), 1e-9) << angle;
  }
  // leaning to its wide side, both are of that one; upright of the narrow one
  const double wide = std::hypot(k_breadth / 2, k_height), wide_angle = std::atan2(k_breadth / 2, k_height);
  const OverturnBarrier aside = barrier_alone(s.model, turned(s.model, 0.02 * Vec3::UnitX()));
  EXPECT_NEAR(aside.left, body.mass * k_g * wide * (1 - std::cos(wide_angle - 0.02)), 1e-9);
  EXPECT_NEAR(aside.whole, body.mass * k_g * wide * (1 - std::cos(wide_angle)), 1e-9);
  const OverturnBarrier upright = barrier_alone(s.model, turned(s.model, Vec3::Zero()));
  EXPECT_NEAR(upright.left, body.mass * k_g * (height(k_edge_angle) - height(0)), 1e-9);
  EXPECT_EQ(upright.whole, upright.left);
  EXPECT_EQ(barrier_alone(s.model, turned(s.model, 0.3 * Vec3::UnitY())).left, 0);
  EXPECT_TRUE(std::isinf(barrier_alone(sled(1, 0.06, 0.03), turned(s.model, Vec3::Zero())).left));
}

TEST(Overturn, critical_angle_tells_front_from_back) {
  // a tripod: far to its foot on +x, near to its edge on -x; also to the left and right of its middle
  Model model = steel_model();
  FrameSpec spec;
  spec.name = "tripod";
  spec.nodes = {{1, 0.1, 0}, {-0.5, 0.8, 0}, {-0.5, -0.6, 0}, {0, 0, 1}};
  for (int leg = 0; leg < 3; ++leg) spec.members.push_back({{leg, 3}, 0, 0});
  add_frame(model, spec);
  model.planes.push_back(ground());
  const Vec3 c = model.bodies[0].centre_of_gravity;
  // distance along d from c to the side a-b
  const auto ahead = [&](int a, int b, const Vec3& d) {
    const Vec3 edge = spec.nodes[b] - spec.nodes[a], outward(edge.y(), -edge.x(), 0);
    return outward.dot(spec.nodes[a] - c) / outward.dot(d);
  };
  const auto critical = [&](const Vec3& d) {
    return critical_angle_alone(model, turned(model, 0.1 * Vec3::UnitZ().cross(d)));
  };
  EXPECT_NEAR(critical(-Vec3::UnitX()), std::atan2(c.x() + 0.5, c.z()), 1e-9);
  EXPECT_NEAR(critical(Vec3::UnitY()), std::atan2(ahead(0, 1, Vec3::UnitY()), c.z()), 1e-9);
  EXPECT_NEAR(critical(-Vec3::UnitY()), std::atan2(ahead(2, 0, -Vec3::UnitY()), c.z()), 1e-9);
  EXPECT_GT(critical(Vec3::UnitX()), critical(-Vec3::UnitX()) + 0.1);
}

TEST(Overturn, bodies_without_a_base_or_a_floor_or_with_supports_of_the_base_cannot_overturn) {
  const BodyPose upright{Vec3::Zero(), Quat::Identity()};
  EXPECT_TRUE(std::isinf(critical_angle_alone(sled(1, 0.06, 0.03), upright)));
  Standing s = standing();
  EXPECT_FALSE(std::isinf(critical_angle_alone(s.model, upright)));
  s.model.supports.push_back({0, 0x7});
  EXPECT_TRUE(std::isinf(critical_angle_alone(s.model, upright)));
  const auto top = std::ranges::max_element(s.model.node_position, {}, [](const Vec3& x) { return x.z(); });
  s.model.supports[0].node = static_cast<int>(top - s.model.node_position.begin());  // that may break
  EXPECT_FALSE(std::isinf(critical_angle_alone(s.model, upright)));
  s.model.supports.clear();
  s.model.planes[0].normal = Vec3::UnitX();
  EXPECT_TRUE(std::isinf(critical_angle_alone(s.model, upright)));
}

TEST(Overturn, slide_is_the_horizontal_travel_of_the_base) {
  const Standing s = standing();
  const Vec3 centre = s.model.bodies[0].centre_of_gravity;
  const Bearer bearer = bearers_of(s.model, {s.start})[0];
  EXPECT_NEAR(slide(s.model, 0, {centre + Vec3(0.3, -0.4, 2), Quat::Identity()}, bearer, {}), 0.5, 1e-12);
  // turning about the base's middle does not slide it
  const Quat turn = exp_quaternion(Vec3(0.2, 0.1, 1));
  const Vec3 base = s.model.bodies[0].base_centre;
  EXPECT_NEAR(slide(s.model, 0, {base + turn * (centre - base), turn}, bearer, {}), 0, 1e-12);
}

BlockSpec piece(const std::string& name, double height, const Vec3& at) {
  BlockSpec spec;
  spec.name = name;
  spec.size = {0.4, 0.4, height};
  spec.mass = 10;
  spec.at = at;
  return spec;
}

TEST(Overturn, slide_of_what_stands_on_another_body_is_along_that) {
  Model model = steel_model();
  add_block(model, piece("pedestal", 1, Vec3::Zero()));
  add_block(model, piece("vase", 0.5, {0.05, 0, 1}));
  add_block(model, piece("beside", 0.5, {1, 0, 0}));
  add_block(model, piece("hangs", 0.5, {1, 0, 0.6}));
  model.planes.push_back(ground());
  const std::vector<Bearer> bearers = bearers_of(model, std::vector<BodyStart>(4));
  for (const int b : {0, 2, 3}) EXPECT_EQ(bearers[b].body, -1) << b;
  ASSERT_EQ(bearers[1].body, 0);
  // carried along as the pedestal tips and walks, and then 30 mm along its top
  const Quat turn = exp_quaternion(Vec3(0.2, 0.1, 1));
  const Vec3 walked(0.3, -0.2, 0.05);
  const auto moved = [&](int body, const Vec3& along) {
    return BodyPose{walked + turn * (model.bodies[body].centre_of_gravity + along), turn};
  };
  EXPECT_NEAR(slide(model, 1, moved(1, Vec3::Zero()), bearers[1], moved(0, Vec3::Zero())), 0, 1e-12);
  EXPECT_NEAR(slide(model, 1, moved(1, {0.018, 0.024, 0.1}), bearers[1], moved(0, Vec3::Zero())), 0.03,
              1e-12);
}

// Three blocks on each other that tilt as one, then without the topmost, which lies on the floor.
TEST(Overturn, what_a_body_bears_counts_while_it_is_above_its_base) {
  constexpr double k_tilt = 0.05;
  Model model;
  double height = 0;
  for (const double mass : {20., 30., 5.}) {
    BlockSpec spec;
    spec.name = copy_name("block", model.bodies.size());
    spec.size = Vec3(0.3, 0.4, 0.5);
    spec.cg = Vec3(0, 0, 0.2);
    spec.mass = mass;
    spec.at = Vec3(0.01 * static_cast<double>(model.bodies.size()), 0, height);
    add_block(model, spec);
    height += spec.size.z() + contact_width_of(spec.size);
  }
  model.planes.push_back(ground(0));
  const Vec3 pivot(0.15, 0, 0);
  const Quat turn = exp_quaternion(k_tilt * Vec3::UnitY());
  std::vector<BodyPose> poses;
  for (const Body& body : model.bodies)
    poses.push_back({pivot + turn * (body.centre_of_gravity - pivot), turn});
  const double base = model.bodies[0].support_polygon[0].z();
  const auto critical = [&](std::span<const double> masses) {
    double sum = 0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t b = 0; b < masses.size(); ++b) {
      sum += masses[b];
      moment += masses[b] * model.bodies[b].centre_of_gravity;
    }
    return std::atan2(0.15 - moment.x() / sum, moment.z() / sum - base);
  };
  BodyStart leaning;
  leaning.pivot = pivot;
  leaning.rotation = k_tilt * Vec3::UnitY();
  const std::vector<Bearer> bearers = bearers_of(model, {leaning, leaning, leaning});
  for (const int b : {0, 1, 2}) {
    ASSERT_EQ(bearers[b].body, b - 1);
    EXPECT_LT((bearers[b].place - model.bodies[b].base_centre).norm(), 1e-12) << b;
  }
  std::vector<Stack> all, left, lying;
  find_stacks(model, bearers, poses, all);
  EXPECT_NEAR(critical_angle(model, 0, poses[0], all[0]), critical(std::vector{20., 30., 5.}), 1e-12);
  EXPECT_NEAR(all[0].mass, 55, 1e-12);
  EXPECT_NEAR(all[1].mass, 35, 1e-12);
  EXPECT_EQ(all[2].centre_of_gravity, model.bodies[2].centre_of_gravity);
  poses[2].centre = Vec3(0.5, 0, 0.2);
  find_stacks(model, bearers, poses, left);
  EXPECT_NEAR(critical_angle(model, 0, poses[0], left[0]), critical(std::vector{20., 30.}), 1e-12);
  EXPECT_NEAR(left[1].mass, 30, 1e-12);
  // both upper ones lie beyond the head of the lowest, which lies on its side
  const Quat quarter = exp_quaternion(k_pi / 2 * Vec3::UnitY());
  for (const int b : {0, 1, 2}) poses[b] = {Vec3(1.2 * b, 0, 0.15), quarter};
  find_stacks(model, bearers, poses, lying);
  for (const int b : {0, 1, 2}) EXPECT_EQ(lying[b].mass, model.bodies[b].mass) << b;
}

struct Observed {
  std::vector<Event> events;
  BodyOutcome outcome;
  double final_tilt = 0;
};

Observed watch(Simulation& sim, double seconds) {
  Observed o;
  std::vector<SectionForces> sections;
  Outcome outcome(sim.model, std::vector<BodyStart>(sim.model.bodies.size()));
  const int steps = static_cast<int>(std::lround(seconds / sim.parameters.time_step));
  for (int i = 0; i <= steps; ++i) {
    if (i > 0 && !sim.advance(1)) break;
    section_forces(sim.model, sim.state, sections);
    outcome.observe_stresses(sim.model, 0, sections);
    outcome.observe(sim.model, sim.parameters, sim.state, sim.contacts(), {}, o.events);
  }
  o.outcome = outcome.bodies()[0];
  o.final_tilt = o.outcome.tilt;
  return o;
}

Simulation released(double angle, double alpha_kgf) {
  const Standing s = standing(angle);
  Parameters p;
  p.contact.alpha = alpha_kgf * k_g;
  return Simulation(s.model, {s.start}, p);
}

TEST(Overturn, block_released_below_the_critical_angle_returns_and_above_it_falls) {
  for (double alpha : {50., 1000.})
    for (double side : {1., -1.}) {
      SCOPED_TRACE(testing::Message() << "alpha " << alpha << " kgf, side " << side);
      // the centre of gravity stands 2 % of the half depth beside the edge; landing on the contacts shifts it
      // less
      Simulation below = released(side * 0.98 * k_edge_angle, alpha);
      const Observed returned = watch(below, 2);
      EXPECT_FALSE(returned.outcome.beyond_since);
      EXPECT_GE(returned.outcome.impacts, 1);
      EXPECT_LT(returned.final_tilt, k_edge_angle);
      EXPECT_NEAR(returned.outcome.peak.share, returned.outcome.peak_tilt / k_edge_angle, 1e-2);
      EXPECT_NEAR(returned.outcome.peak.critical, k_edge_angle, 1e-3);  // its frame bends by less
      Simulation above = released(side * 1.02 * k_edge_angle, alpha);
      const Observed fallen = watch(above, 3);
      EXPECT_TRUE(fallen.outcome.beyond_since);
      EXPECT_GT(fallen.final_tilt, 1.3);
      EXPECT_TRUE(fallen.outcome.over_60_since);
      EXPECT_GT(fallen.outcome.peak_stress, 0);
      EXPECT_EQ(fallen.outcome.impacts, 0);                           // its base is no longer what it lies on
      EXPECT_NEAR(fallen.outcome.peak.critical, k_edge_angle, 1e-3);  // that which it passed
      EXPECT_TRUE(std::ranges::none_of(fallen.events, [&](const Event& event) {
        return event.time > *fallen.outcome.beyond_since &&
               (event.kind == Event::Kind::uplift || event.kind == Event::Kind::impact);
      }));
    }
}

TEST(Overturn, what_came_back_from_farther_overturns_at_its_own_angle_and_keeps_the_farther_if_it_returns) {
  const Standing upright = standing(0);
  Outcome outcome(upright.model, std::vector<BodyStart>(upright.model.bodies.size()));
  std::vector<Event> events;
  std::int64_t step = 0;
  const auto share_after = [&](double share) {
    Simulation there = released(share * k_edge_angle, 1000);
    there.state.step = step++;
    there.state.time = 0.1 * static_cast<double>(step);
    outcome.observe(there.model, there.parameters, there.state, there.contacts(), {}, events);
    return outcome.bodies()[0].peak.share;
  };
  constexpr double k_close = 1e-3;  // as released, the frame has not bent yet
  EXPECT_NEAR(share_after(0.3), 0.3, k_close);
  EXPECT_NEAR(share_after(1.5), 1.5, k_close);
  EXPECT_NEAR(share_after(-0.5), 1.5, k_close);
  EXPECT_NEAR(share_after(-1.02), 1.02, k_close);
  EXPECT_NEAR(share_after(-1.3), 1.02, k_close);
  EXPECT_NEAR(share_after(0), 1.5, k_close);
  EXPECT_NEAR(share_after(-1.1), 1.1, k_close);
}

TEST(Overturn, rocking_run_lifts_and_lands_on_alternate_sides) {
  Simulation sim = released(0.6 * k_edge_angle, 500);
  const Observed o = watch(sim, 2.5);
  int uplifts = 0, impacts = 0;
  double last = -1;
  std::vector<bool> lifted(4, false);
  for (const Event& e : o.events) {
    EXPECT_GE(e.time, last);
    last = e.time;
    EXPECT_EQ(e.body, 0);
    ASSERT_NE(e.kind, Event::Kind::overturn);
    const auto side = static_cast<std::size_t>(e.value);
    ASSERT_LT(side, 4u);
    if (e.kind == Event::Kind::uplift) {
      ++uplifts;
      EXPECT_FALSE(lifted[side]);
      lifted[side] = true;
    } else {
      ++impacts;
      EXPECT_TRUE(lifted[side]);
      lifted[side] = false;
    }
    // it rocks about the edges along y: the sides that run along x never leave the floor alone
    const auto& polygon = sim.model.bodies[0].support_polygon;
    const Vec3 edge = polygon[(side + 1) % 4] - polygon[side];
    EXPECT_GT(std::abs(edge.y()), std::abs(edge.x()));
  }
  EXPECT_GE(uplifts, 2);
  EXPECT_GE(impacts, 2);
  EXPECT_EQ(o.outcome.impacts, impacts);
  ASSERT_TRUE(o.outcome.first_uplift);
  EXPECT_EQ(*o.outcome.first_uplift, o.events.front().time);
  EXPECT_NEAR(o.outcome.peak_tilt, 0.6 * k_edge_angle, 0.05 * k_edge_angle);
}

TEST(Overturn, impact_times_and_the_peaks_between_are_kept) {
  topple::Setup setup = rocking_block(0.1, 5e4 * k_g, 2.5e-4);
  setup.run.duration = 2.5;
  topple::Run run(setup);
  std::vector<double> times, peaks{0};
  while (true) {
    const BodyOutcome& o = run.outcome().bodies()[0];
    if (o.impact_times.size() > times.size()) {
      times.push_back(run.state().time);
      peaks.push_back(0);
    }
    peaks.back() = std::max(peaks.back(), o.tilt);
    if (run.over()) break;
    ASSERT_TRUE(run.advance().ok());
  }
  const BodyOutcome& o = run.outcome().bodies()[0];
  ASSERT_GE(times.size(), 3u);
  EXPECT_EQ(o.impact_times, times);
  EXPECT_EQ(o.peak_tilts, peaks);
  EXPECT_NEAR(o.peak_tilts.front(), 0.1, 1e-12);
  for (std::size_t k = 1; k + 1 < peaks.size(); ++k) EXPECT_LT(peaks[k], peaks[k - 1]);
}

// Forces as of a body that stands on one side and on all of its base again, while the body has turned by a
// share of the angle from which that counts.
TEST(Overturn, uplift_and_impact_count_from_the_stated_angle_on) {
  for (const double share : {0.9, 1.1}) {
    SCOPED_TRACE(share);
    const Standing s = standing();
    Simulation sim(s.model, {s.start}, {}, true);
    const double weight = s.model.bodies[0].mass * k_g;
    const auto& points = s.model.bodies[0].base_points;
    double most = -1e9;
    for (const int p : points)
      most = std::max(most, s.model.node_position[s.model.contact_points[p].node].x());
    const auto carried = [&](bool lifted) {
      std::vector<ContactForce> forces;
      for (const int p : points) {
        const double x = s.model.node_position[s.model.contact_points[p].node].x();
        const double normal = lifted && x < most - 1e-6 ? 0 : weight / static_cast<double>(points.size());
        forces.push_back({p, 0, 0, normal, Vec3(0, 0, normal)});
      }
      return forces;
    };
    Outcome outcome(s.model, {s.start});
    std::vector<Event> events;
    const auto observe = [&](double time, double angle, bool lifted) {
      State state = sim.state;
      state.time = time;
      const Quat turn = exp_quaternion(Vec3(0, angle, 0));
      for (Vec3& x : state.position) x = turn * x;
      outcome.observe(sim.model, sim.parameters, state, carried(lifted), {}, events);
    };
    observe(1, 0, true);
    observe(2, share * k_uplift_angle, true);
    observe(3, 0, false);
    const bool counts = share > 1;
    EXPECT_EQ(events.size(), counts ? 2u : 0u);
    EXPECT_EQ(outcome.bodies()[0].impacts, counts ? 1 : 0);
    EXPECT_EQ(outcome.bodies()[0].first_uplift, counts ? std::optional(1.) : std::nullopt);
    EXPECT_EQ(outcome.bodies()[0].first_impact, counts ? std::optional(3.) : std::nullopt);
  }
}

// While it tips over a side on two corners one of these lets go and bears again: the side across has not
// lifted.
TEST(Overturn, a_corner_that_trembles_while_a_body_tips_over_its_side_is_no_uplift) {
  const Standing s = standing();
  Simulation sim(s.model, {s.start}, {}, true);
  const double weight = s.model.bodies[0].mass * k_g;
  const auto at = [&](int point) { return s.model.node_position[s.model.contact_points[point].node]; };
  std::vector<int> points = s.model.bodies[0].base_points;
  double most = -1e9;
  for (const int p : points) most = std::max(most, at(p).x());
  std::erase_if(points, [&](int p) { return at(p).x() < most - 1e-6; });
  const int corner = *std::ranges::max_element(points, {}, [&](int p) { return at(p).y(); });
  Outcome outcome(s.model, {s.start});
  std::vector<Event> events;
  for (int k = 0; k <= 10; ++k) {
    State state = sim.state;
    state.time = 0.01 * k;
    const Quat turn = exp_quaternion(Vec3(0, k * k_uplift_angle, 0));
    for (Vec3& x : state.position) x = turn * x;
    std::vector<ContactForce> forces;
    for (const int p : points) {
      const double normal = k % 2 == 1 && p == corner ? 0 : weight / static_cast<double>(points.size());
      forces.push_back({p, 0, 0, normal, Vec3(0, 0, normal)});
    }
    outcome.observe(sim.model, sim.parameters, state, forces, {}, events);
  }
  EXPECT_EQ(outcome.bodies()[0].impacts, 0);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Event::Kind::uplift);  // of the side behind
}

TEST(Overturn, resting_cabinet_has_no_events) {
  const Standing s = standing();
  Simulation sim(s.model, {s.start}, {}, true);
  const Observed o = watch(sim, 1);
  EXPECT_TRUE(o.events.empty());
  EXPECT_LT(o.outcome.peak_tilt, 1e-6);
  EXPECT_LT(o.outcome.peak_slide, 1e-6);
}

TEST(Overturn, time_of_overturning_is_that_of_the_critical_angle) {
  // thrown with an angular velocity in free flight, without gravity: the tilt grows linearly
  Standing s = standing();
  s.model.planes[0].point.z() = -10;
  s.start.angular_velocity = {0, 0.5, 0};
  Parameters p;
  p.gravity.setZero();
  p.time_step = 7e-3;
  Simulation sim(s.model, {s.start}, p);
  const Observed o = watch(sim, 1);
  ASSERT_TRUE(o.outcome.beyond_since);
  // linear between steps; the spin stretches the posts a little
  EXPECT_NEAR(*o.outcome.beyond_since, k_edge_angle / 0.5, 1e-4);
  ASSERT_EQ(o.events.size(), 1u);
  EXPECT_EQ(o.events[0].kind, Event::Kind::overturn);
}

// A push that grows so slowly that the balance is static: the rigid block on its edge lifts for good at
// g b/h. On springs in three rows its far one is unloaded from 2/3 of that on, while the middle one still
// carries the share of the weight by which the push is below: none but a thousandth when the side lets go.
TEST(Overturn, slow_push_lifts_a_side_at_g_b_over_h_and_topples_just_above) {
  const double threshold = k_g * (k_depth / 2) / k_height;
  EXPECT_NEAR(threshold / k_gal, 177.4, 0.1);
  for (double share : {0.97, 1.03}) {
    SCOPED_TRACE(share);
    const Standing s = standing();
    Parameters p;
    p.contact.alpha = 5000 * k_g;
    p.contact.friction = 0.9;
    p.time_step = 2e-3;
    Shake push;
    push.kind = Shake::Kind::pulse;
    push.shape = Shake::Shape::rectangle;
    push.duration = 100;
    p.shakes.push_back(push);
    Simulation sim(s.model, {s.start}, p, true);
    Outcome outcome(sim.model, std::vector<BodyStart>(sim.model.bodies.size()));
    std::vector<Event> events;
    double lifted_at = 0, since = 0;
    for (int i = 0; i < 3500; ++i) {
      sim.parameters.shakes[0].amplitude = share * threshold * std::min(1., i / 2000.);
      if (outcome.bodies()[0].beyond_since) break;
      ASSERT_TRUE(sim.advance(1));
      outcome.observe(sim.model, sim.parameters, sim.state, sim.contacts(), {}, events);
      if (lifted_at == 0 && std::ranges::any_of(outcome.bodies()[0].sides, &BodyOutcome::Side::open)) {
        lifted_at = sim.parameters.shakes[0].amplitude;
        since = sim.state.time;
      }
    }
    // it leans by 0.05 degrees before, which brings its weight 0.5 % of b nearer to the edge
    EXPECT_NEAR(lifted_at, share < 1 ? 0 : threshold, 1e-2 * threshold);
    EXPECT_EQ(outcome.bodies()[0].first_uplift, share < 1 ? std::nullopt : std::optional(since));
    if (share < 1)
      EXPECT_LT(outcome.bodies()[0].peak_tilt, 0.2 * k_edge_angle);
    else
      EXPECT_TRUE(outcome.bodies()[0].beyond_since);
  }
}

TEST(Overturn, members_below_bear_the_sides_that_they_touch_wherever_the_body_stands) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.at = Vec3(3, -2, 0.4);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  GridSpec floor;
  floor.name = "floor";
  setup.starts.push_back(add_grid(setup.model, floor));
  const Model& model = setup.model;
  const State state = start_state(model, setup.starts);
  const Body& body = model.bodies[0];
  const auto& polygon = body.support_polygon;
  const double base = polygon[0].z(), weight = body.mass * k_g;
  int on_base = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
    for (const double place : {0., 0.3, 1.}) {
      SCOPED_TRACE(testing::Message() << "element " << e << " at " << place);
      const Element& element = model.elements[e];
      const Vec3 x =
          (1 - place) * model.node_position[element.node[0]] + place * model.node_position[element.node[1]];
      Outcome outcome(model, std::vector<BodyStart>(model.bodies.size()));
      std::vector<Event> events;
      const MemberForce force{{e, body.element_count}, place, 0.5, 0.1, Vec3(0, 0, weight)};
      outcome.observe(model, {}, state, {}, {force}, events);
      const bool bears = std::abs(x.z() - base) < 1e-9;
      on_base += bears;
      // sides that carry nothing have let go, but only while the body stands on another
      for (std::size_t side = 0; side < polygon.size(); ++side) {
        const Vec3 along = (polygon[(side + 1) % polygon.size()] - polygon[side]).normalized();
        const auto beside = [&](const Vec3& at) { return along.cross(at - polygon[side]).norm(); };
        double depth = 0;
        for (const Vec3& corner : polygon) depth = std::max(depth, beside(corner));
        // one is borne by what touches the half of the base next to it
        EXPECT_EQ(outcome.bodies()[0].sides[side].open, bears && beside(x) > depth / 2 - 1e-9)
            << "side " << side;
      }
    }
  EXPECT_GT(on_base, 10);
}

TEST(Overturn, peak_stress_is_at_the_corner_where_normal_force_and_both_moments_meet_with_torsion) {
  const Standing s = standing();
  const State state = start_state(s.model, {s.start});
  const Section& post = s.model.sections[0];
  std::vector<SectionForces> sections(s.model.elements.size(), {Vec3::Zero(), Vec3::Zero()});
  const Vec3 moment(7, -11, 13);
  const double force = -900, half = 0.015;
  sections[3] = {Vec3(force, 0, 0), moment};
  Outcome outcome(s.model, {s.start});
  outcome.observe_stresses(s.model, 0, sections);
  const double normal = std::abs(force) / post.area + std::abs(moment.y()) * half / post.iy +
                        std::abs(moment.z()) * half / post.iz;
  const double shear = moment.x() * half / post.j;
  const double exact = std::sqrt(normal * normal + 3 * shear * shear);
  EXPECT_NEAR(outcome.bodies()[0].peak_stress, exact, 1e-9 * exact);
}

TEST(Overturn, a_hinge_that_unloads_within_the_step_counts_but_not_one_from_before_a_checkpoint) {
  const Standing s = standing();
  State state = start_state(s.model, {s.start});
  Outcome outcome(s.model, {s.start}), later = outcome;
  std::vector<Event> events;
  outcome.observe(s.model, {}, state, {}, {}, events);
  state.step = 7;
  state.elements[3].offset.kappa = {1e-4, 0, 0};  // twist: at both ends, none of which flows now
  for (int k = 0; k < 2; ++k) outcome.observe(s.model, {}, state, {}, {}, events);
  EXPECT_EQ(outcome.bodies()[0].hinges, 2);
  ASSERT_EQ(std::ranges::count(events, Event::Kind::hinge, &Event::kind), 2);
  EXPECT_EQ(events.back().element, 3);
  EXPECT_EQ(events.back().value, static_cast<double>(Hinge::second));

  events.clear();
  later.observe(s.model, {}, state, {}, {}, events);
  EXPECT_EQ(later.bodies()[0].hinges, 0);
  state.elements[3].hinge = Hinge::second;
  later.observe(s.model, {}, state, {}, {}, events);
  EXPECT_EQ(later.bodies()[0].hinges, 0);  // it had flowed
  EXPECT_EQ(std::ranges::count(events, Event::Kind::hinge, &Event::kind), 0);
}

}  // namespace
}  // namespace topple::test
