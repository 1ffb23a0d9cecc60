// Bodies on the level planar in runs: the block, its energies, and how it becomes a rigid body.
#include "solver/body/planar_body.h"

#include <algorithm>
#include <functional>

#include "solver/contact/contact_default.h"
#include "solver/math/rotation.h"
#include "solver/model/accelerogram.h"
#include "solver/planar/planar_run.h"
#include "unit/solver/body_models.h"

namespace topple::test::planar_bodies {
namespace {

constexpr double k_step = 1e-3;  // s

struct Cabinet {
  double tilt = 0, yaw = 0, cg_height = 1.05, friction = 0.6;
  CabinetSpec::Base base = CabinetSpec::Base::corners;
  BodyModel model = BodyModel::planar;
};

topple::Setup alone(const Cabinet& of = {}) {
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.base = of.base;
  spec.tilt = of.tilt;
  spec.yaw = of.yaw;
  spec.cg_height = of.cg_height;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  setup.run.duration = 4;
  setup.run.settle = of.tilt == 0;
  setup.parameters.contact.friction = of.friction;
  setup.parameters.contact.alpha = 1e6 * k_g;
  setup.parameters.want_stress = false;
  setup.parameters.time_step = k_step;
  setup.parameters.models = {of.model};
  return setup;
}

topple::Setup with_shakes(topple::Setup setup, std::vector<Shake> shakes) {
  setup.parameters.shakes = std::move(shakes);
  return setup;
}

Shake sine(double amplitude, double frequency, const Vec3& direction = Vec3::UnitX()) {
  Shake shake;
  shake.amplitude = amplitude, shake.frequency = frequency, shake.direction = direction;
  return shake;
}

Shake pulse(double amplitude, Shake::Shape shape, double start, double duration) {
  Shake shake = sine(amplitude, 1);
  shake.kind = Shake::Kind::pulse;
  shake.shape = shape, shake.start = start, shake.duration = duration;
  return shake;
}

ModelLevel level_of(const topple::Run& run, int body = 0) {
  return run.state().bodies[static_cast<std::size_t>(body)].level;
}

struct Case {
  const char* what;
  topple::Setup setup;
};
std::vector<Case> cases() {
  Shake jump = sine(3, 1);
  jump.initial_velocity = Shake::Start::jump;
  jump.start = 0.2505;  // within a step
  Shake sweep = sine(4, 0.5);
  sweep.kind = Shake::Kind::sweep;
  sweep.last_frequency = 5, sweep.duration = 3, sweep.taper = 1;
  AccelerogramComponent component{.direction = Vec3::UnitX(), .interval = 0.01, .samples = {}};
  for (int i = 0; i < 300; ++i) component.samples.push_back(4 * std::sin(0.08 * i + 0.001 * i * i));
  Shake recorded;
  recorded.kind = Shake::Kind::record;
  recorded.record = make_accelerogram({component});
  topple::Setup moves = alone({.tilt = 0.05});
  moves.starts[0].velocity = Vec3(0.1, 0, 0.5);
  moves.starts[0].angular_velocity = Vec3(0, 0.1, 0);
  const double turn = k_pi / 6;
  return {
      {"let go", alone({.tilt = 0.1})},
      {"let go, yaw", alone({.tilt = -0.1, .yaw = turn})},
      {"moves at the start", moves},
      {"sine", with_shakes(alone(), {sine(4, 1)})},
      {"sine along and up", with_shakes(alone({.yaw = turn}),
                                        {sine(5, 1, Vec3(std::cos(turn) * 0.8, std::sin(turn) * 0.8, 0.6))})},
      {"sine, points between the edges",
       with_shakes(alone({.base = CabinetSpec::Base::edges}), {sine(4, 1)})},
      {"slides", with_shakes(alone({.cg_height = 0.7, .friction = 0.2}), {sine(5, 1)})},
      {"slides and rocks", with_shakes(alone({.friction = 0.19}), {sine(8, 2)})},
      {"floor's velocity jumps", with_shakes(alone({.friction = 0.5}), {jump})},
      {"sweep", with_shakes(alone(), {sweep})},
      {"rectangle within steps", with_shakes(alone(), {pulse(4, Shake::Shape::rectangle, 0.1003, 0.2)})},
      {"half-sine", with_shakes(alone(), {pulse(5, Shake::Shape::half_sine, 0.1003, 0.3)})},
      {"record", with_shakes(alone(), {recorded})},
  };
}

planar::PlanarCase block_of(const topple::Setup& setup) {
  auto found = planar::planar_case(setup.model, setup.parameters, setup.starts, 0);
  EXPECT_TRUE(found);
  found->controls.tolerance = 1e-16;
  return *found;
}

// Its energy over that at rest goes as the square of the rate at the impact, and is kept between impacts.
TEST(PlanarBody, impact_in_a_run_keeps_the_factor_times_housners_rate) {
  for (const double factor : {0.5, 0.9, 1., 1.02}) {
    topple::Setup setup = alone({.tilt = 0.1, .friction = 1.5});
    setup.model.bodies[0].restitution = factor;
    const planar::Block block = block_of(setup).block;
    topple::Run run(setup);
    const auto height = [&] { return planar::energy(block, run.state().blocks[0].motion); };
    const double before = height();
    const planar::Side side = run.state().blocks[0].motion.side;
    while (!run.over() && run.state().blocks[0].motion.side == side) ASSERT_TRUE(run.advance().ok());
    const double k2h2 = block.inertia_over_mass() + block.height * block.height,
                 b2 = block.right * block.right;
    EXPECT_NEAR(std::sqrt(height() / before), factor * (k2h2 - b2) / (k2h2 + b2), 1e-9) << factor;
  }
}

// Both integrate the same motion to rounding, in other steps; impacts and slips carry differences of 1e-16
// on, a rocking block's grow as exp(2.6 t).
TEST(PlanarBody, run_is_that_of_the_block) {
  for (const Case& one : cases())
    for (const bool adaptive : {false, true}) {
      topple::Setup setup = one.setup;
      setup.parameters.adaptive = adaptive;
      const planar::PlanarCase block = block_of(setup);
      planar::PlanarRun exact(block, setup.parameters.shakes, setup.run.duration);
      topple::Run run(setup);
      ASSERT_EQ(level_of(run), ModelLevel::planar) << one.what;
      double apart = 0;
      while (!run.over() && level_of(run) == ModelLevel::planar) {
        const BodyPose here = body_pose(setup.model, run.state(), 0);
        while (!exact.over() && exact.state().time < run.time()) exact.advance();
        if (exact.state().time < run.time()) break;
        const planar::State then =
            exact.state().time > run.time() ? planar::state_within(exact.step(), run.time()) : exact.state();
        const planar::Pose there = planar::pose(block, then);
        apart = std::max({apart, (here.centre - there.centre).norm(),
                          log_quaternion(there.rotation.conjugate() * here.rotation).norm()});
        ASSERT_TRUE(run.advance().ok()) << one.what;
      }
      EXPECT_LT(apart, 1e-12) << one.what << (adaptive ? ", adaptive" : "");
    }
}

// Works are integrals of the polynomials that the motion consists of, losses differences of kinetic energies.
TEST(PlanarBody, energy_balance_holds_to_rounding) {
  for (const Case& one : cases()) {
    topple::Run run(one.setup);
    double greatest = 0, largest = 0;
    while (!run.over() && level_of(run) == ModelLevel::planar && run.advance().ok()) {
      if (level_of(run) != ModelLevel::planar) break;
      greatest = std::max(greatest, std::abs(run.state().energy.unexplained()));
      largest = run.state().energy.largest;
    }
    EXPECT_LT(greatest, 1e-9 * largest) << one.what;
    EXPECT_EQ(run.state().energy.model_switch == 0, level_of(run) == ModelLevel::planar) << one.what;
  }
}

TEST(PlanarBody, losses_stand_where_they_belong) {
  const topple::Setup let_go = alone({.tilt = 0.1}),
                      shaken = with_shakes(alone({.cg_height = 0.7, .friction = 0.2}), {sine(5, 1)});
  topple::Run rocks(let_go), slides(shaken);
  while (!rocks.over()) rocks.advance();
  while (!slides.over()) slides.advance();
  const EnergyLedger &rocked = rocks.state().energy, &slid = slides.state().energy;
  EXPECT_EQ(rocked.friction, 0);
  EXPECT_GT(rocked.normal_damping, 0);
  EXPECT_NEAR(rocked.normal_damping, rocked.start_total - rocked.gravity - rocked.kinetic,
              1e-9 * rocked.normal_damping);
  EXPECT_GT(slid.friction, 0);
  EXPECT_NEAR(slid.normal_damping, 0, 1e-12 * slid.friction);
  EXPECT_NEAR(slid.input - slid.kinetic, slid.friction, 1e-9 * slid.friction);
}

TEST(PlanarBody, floor_bears_the_weight_at_rest_and_the_edge_when_it_rocks) {
  const topple::Setup upright = alone(), tilted = alone({.tilt = 0.05});
  topple::Run rests(upright), rocks(tilted);
  rests.advance(), rocks.advance();
  const double weight = rests.setup().model.bodies[0].mass * k_g;
  double sum = 0;
  ASSERT_EQ(rests.contacts().size(), 4u);
  for (const ContactForce& f : rests.contacts()) sum += f.normal;
  EXPECT_NEAR(sum, weight, 1e-9 * weight);
  ASSERT_EQ(rocks.contacts().size(), 2u);
  const State& state = rocks.state();
  Vec3 force = Vec3::Zero();
  for (const ContactForce& f : rocks.contacts()) force += f.force;
  force.z() -= weight;
  EXPECT_LT((force - state.bodies[0].force).norm(), 1e-9 * weight);
}

// A base with points between its edges, pushed towards one of them by the floor, hard enough to lift the
// other.
TEST(PlanarBody, what_stands_on_more_than_two_edges_goes_on_as_a_rigid_body_without_a_jump) {
  for (const double q : {0.7, 1., 1.5})
    for (const double push : {0., 0.5, 1.2, 1.6}) {
      topple::Setup setup = with_shakes(alone({.base = CabinetSpec::Base::edges}),
                                        {pulse(push, Shake::Shape::rectangle, 0.01, 1)});
      setup.parameters.contact.q = q;
      topple::Run run(setup);
      while (run.time() < 0.1) ASSERT_TRUE(run.advance().ok());
      ASSERT_EQ(level_of(run), ModelLevel::planar);
      const double weight = setup.model.bodies[0].mass * k_g;
      double sum = 0;
      std::vector<double> before;
      for (const ContactForce& f : run.contacts()) before.push_back(f.normal), sum += f.normal;
      EXPECT_GE(before.size(), push > 0 ? 6u : 9u);
      EXPECT_NEAR(sum, weight, 1e-9 * weight);
      run.edit(set(Edit::Key::model, static_cast<double>(static_cast<int>(BodyModel::rigid))));
      ASSERT_TRUE(run.advance().ok());
      ASSERT_EQ(level_of(run), ModelLevel::rigid);
      ASSERT_EQ(run.contacts().size(), before.size());
      for (std::size_t k = 0; k < before.size(); ++k)
        EXPECT_NEAR(run.contacts()[k].normal, before[k], 1e-4 * weight) << q << ", " << push << ", " << k;
    }
}

TEST(PlanarBody, goes_on_from_any_step_bit_for_bit) {
  for (const Case& one : cases())
    for (const int from : {1, 250, 777}) {
      topple::Run whole(one.setup);
      while (whole.step() < from) ASSERT_TRUE(whole.advance().ok());
      topple::Run rest(one.setup, unpack(one.setup.model, pack(whole.state())), whole.parameters());
      for (int i = 0; i < 700; ++i) {
        ASSERT_TRUE(whole.advance().ok());
        ASSERT_TRUE(rest.advance().ok());
      }
      EXPECT_EQ(hash(whole.state()), hash(rest.state())) << one.what << " from " << from;
    }
}

// The state between two steps is that of the block too, over its impacts.
TEST(PlanarBody, state_within_a_step_is_exact) {
  topple::Setup setup = alone({.tilt = 0.1});
  setup.parameters.adaptive = true;
  topple::Setup fine = setup;
  fine.parameters.adaptive = false;
  fine.parameters.time_step = 1e-3;
  topple::Run run(setup), other(fine);
  double apart = 0;
  while (!other.over()) {
    other.advance();
    while (run.time() < other.time() - 1e-12) run.advance();
    const topple::Snapshot at = run.snapshot(other.time());
    apart = std::max(apart, (at.state.bodies[0].position - other.state().bodies[0].position).norm());
    const EnergyLedger &within = at.state.energy, &there = other.state().energy;
    for (const auto energy : {&EnergyLedger::kinetic, &EnergyLedger::gravity, &EnergyLedger::normal_damping,
                              &EnergyLedger::input, &EnergyLedger::friction})
      EXPECT_NEAR(within.*energy, there.*energy, 1e-9) << other.time();  // of some 40 J
  }
  EXPECT_LT(apart, 1e-12);
}

// Peaks between steps of up to 10 ms, and impacts: to what the exact motion has. Tilts near a peak of 0.1 rad
// go as its square: 1e-4 s beside it 1e-8 rad are missing.
TEST(PlanarBody, peaks_and_impacts_are_told_as_they_are_between_steps) {
  topple::Setup setup = alone({.tilt = 0.1});
  setup.parameters.adaptive = true;
  setup.run.duration = 2.5;
  topple::Run run(setup);
  std::vector<double> peaks;
  double turned = 0, before = 0, peak = 0;
  for (double time = 1e-4; time < setup.run.duration; time += 1e-4) {
    while (run.time() < time) ASSERT_TRUE(run.advance().ok());
    const BodyPose pose = body_pose(setup.model, run.snapshot(time).state, 0);
    const double now = log_quaternion(pose.rotation).y();
    if (now * before < 0) {  // it has landed
      peaks.push_back(peak);
      ASSERT_LT(peaks.size(), run.outcome().bodies()[0].impact_times.size() + 2);
      turned = time;
      peak = 0;
      EXPECT_NEAR(run.outcome().bodies()[0].impact_times.back(), turned, 2e-4) << peaks.size();
    }
    peak = std::max(peak, std::abs(now));
    if (now != 0) before = now;
  }
  const BodyOutcome& body = run.outcome().bodies()[0];
  ASSERT_GT(peaks.size(), 2u);
  for (std::size_t k = 0; k < peaks.size(); ++k) EXPECT_NEAR(body.peak_tilts[k], peaks[k], 1e-7) << k;
}

/// A rigid body throughout, on contacts so stiff that their give is small beside the tolerances here.
topple::Setup as_rigid(topple::Setup setup) {
  std::fill(setup.parameters.models.begin(), setup.parameters.models.end(), BodyModel::rigid);
  return setup;
}

struct Climb {
  double time = -1;
  LevelReason reason = LevelReason::asked;
  double apart = 0;  ///< rad, m; greatest so far from a rigid run
};
Climb climb(const topple::Setup& setup, double until, const std::function<void(topple::Run&)>& at_one = {}) {
  const topple::Setup other = as_rigid(setup);
  topple::Run run(setup), rigid(other);
  Climb out;
  bool done = false;
  while (run.time() < until) {
    if (at_one && !done && run.time() > 1 - 1e-9) at_one(run), at_one(rigid), done = true;
    if (!run.advance().ok() || !rigid.advance().ok()) {
      ADD_FAILURE() << run.status().message(setup.model);
      break;
    }
    for (int b = 0; b < static_cast<int>(setup.model.bodies.size()); ++b) {
      const BodyPose here = body_pose(setup.model, run.state(), b),
                     there = body_pose(setup.model, rigid.state(), b);
      out.apart = std::max({out.apart, (here.centre - there.centre).norm(),
                            log_quaternion(there.rotation.conjugate() * here.rotation).norm()});
    }
    if (out.time < 0 && level_of(run) == ModelLevel::rigid) {
      out.time = run.time();
      out.reason = run.state().bodies[0].reason;
    }
    // 2e-3 where one falls on another in steps of 1 ms, on contacts as stiff as these, as that of `rigid`
    EXPECT_LT(run.state().energy.balance_error(), 5e-3);
  }
  return out;
}

/// The first falls on the other, which stands before it.
topple::Setup falls_on_another() {
  topple::Setup setup = alone({.tilt = 0.25});
  CabinetSpec spec = tall_cabinet();
  spec.base = CabinetSpec::Base::corners;
  spec.name = "other";
  spec.at = Vec3(1.2, 0, 0);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.parameters.models.assign(2, BodyModel::planar);
  return setup;
}

topple::Setup slides_to_a_wall() {
  topple::Setup setup = alone({.cg_height = 0.7, .friction = 0.1});
  setup.model.planes.push_back({"wall", Vec3(0.9, 0, 0), -Vec3::UnitX(), 0});
  setup.starts[0].velocity = Vec3(1.5, 0, 0);
  setup.run.settle = false;
  return setup;
}

topple::Setup with_anchor() {
  topple::Setup setup = with_shakes(alone(), {sine(4, 1)});
  const Body& body = setup.model.bodies[0];
  Anchor anchor;
  anchor.name = "strap", anchor.body = 0, anchor.type = Anchor::Type::strap, anchor.stiffness = 1e4;
  anchor.node = body.first_node;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    if (setup.model.node_position[i].z() - setup.model.node_position[i].x() >
        setup.model.node_position[anchor.node].z() - setup.model.node_position[anchor.node].x())
      anchor.node = i;
  anchor.arm.setZero();
  anchor.to = setup.model.node_position[anchor.node] - Vec3(0.5, 0, 0);
  anchor.length = 0.5;
  setup.model.anchors.push_back(anchor);
  setup.parameters.anchors = {false};
  return setup;
}

// Contacts of 1e6 kgf change the tilt by 1.5e-4 rad within a second of this sine, and by four times that on
// the way to the floor; without a shake by 2e-6. Becoming a rigid body adds less.
TEST(PlanarBody, becomes_a_rigid_body_that_moves_like_one) {
  const topple::Setup rocks = with_shakes(alone(), {sine(4, 1)});
  struct Row {
    const char* what;
    topple::Setup setup;
    double until;
    LevelReason reason;
    double apart;
    std::function<void(topple::Run&)> at_one = {};
  };
  const Row rows[] = {
      {"falls on another", falls_on_another(), 1.2, LevelReason::neighbour, 1e-5},
      {"slides to a wall", slides_to_a_wall(), 1.5, LevelReason::neighbour, 1e-5},
      {"overturns", with_shakes(alone(), {sine(6, 1)}), 2, LevelReason::fall, 2e-3},
      {"an anchor", with_anchor(), 1.5, LevelReason::held, 5e-4,
       [](topple::Run& run) { run.edit(set(Edit::Key::anchor, 1)); }},
      {"another alpha", rocks, 1.5, LevelReason::contact, 5e-4,
       [](topple::Run& run) { run.edit(set(Edit::Key::alpha, 1e5 * k_g)); }},
      {"bounces", rocks, 1.5, LevelReason::contact, 5e-4,
       [](topple::Run& run) { run.edit(set(Edit::Key::restitution, 0.3)); }},
      {"another direction", rocks, 1.5, LevelReason::plane, 5e-4,
       [](topple::Run& run) { run.edit(turn_to(Vec3(1, 1, 0))); }},
      {"asked for", rocks, 1.5, LevelReason::asked, 5e-4,
       [](topple::Run& run) {
         run.edit(set(Edit::Key::model, static_cast<double>(static_cast<int>(BodyModel::rigid))));
       }},
  };
  for (const Row& row : rows) {
    const Climb found = climb(row.setup, row.until, row.at_one);
    EXPECT_GT(found.time, 0.1) << row.what;
    EXPECT_EQ(found.reason, row.reason) << row.what << ": " << name(found.reason);
    EXPECT_LT(found.apart, row.apart) << row.what;
  }
}

// One of many falls on another: whoever advances them.
TEST(PlanarBody, threads_do_not_change_a_bit) {
  const auto run_with = [](int workers) {
    topple::Setup setup = falls_on_another();
    for (int k = 1; k < 40; ++k) {  // more than one part
      CabinetSpec spec = tall_cabinet();
      spec.base = CabinetSpec::Base::corners;
      spec.name = copy_name("far", static_cast<std::size_t>(k));
      spec.at = Vec3(0, 4 * k, 0);
      spec.tilt = 0.004 * k;
      setup.starts.push_back(add_cabinet(setup.model, spec));
    }
    setup.parameters.models.assign(setup.model.bodies.size(), BodyModel::planar);
    topple::Run run(setup);
    if (workers > 1)
      run.share({workers, [workers](int count, const std::function<void(int, int)>& f) {
                   for (int task = count - 1; task >= 0; --task) f(task, task % workers);
                 }});
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(run.advance().ok());
    EXPECT_EQ(level_of(run), ModelLevel::rigid);
    EXPECT_EQ(level_of(run, 2), ModelLevel::planar);
    return hash(run.state());
  };
  const auto alone = run_with(1);
  EXPECT_EQ(alone, run_with(2));
  EXPECT_EQ(alone, run_with(4));
}

TEST(PlanarBody, a_number_that_is_none_ends_the_run) {
  const topple::Setup setup = with_shakes(alone({.tilt = 0.05}), {sine(4, 1)});
  topple::Run run(setup);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.advance().ok());
  const std::function<double&(BlockState&)> numbers[] = {
      [](BlockState& b) -> double& { return b.motion.x; },
      [](BlockState& b) -> double& { return b.motion.tilt; },
      [](BlockState& b) -> double& { return b.motion.rate; },
      [](BlockState& b) -> double& { return b.motion.z_velocity; },
      [](BlockState& b) -> double& { return b.along.x(); },
      [](BlockState& b) -> double& { return b.static_friction; }};
  for (const auto& number : numbers)
    for (const double bad : {std::nan(""), -1e308, std::numeric_limits<double>::infinity()}) {
      State state = run.state();
      number(state.blocks[0]) = bad;
      Workspace workspace(setup.model);
      EXPECT_EQ(step(setup.model, setup.parameters, state, workspace).kind, StepStatus::Kind::not_finite);
    }
}

// Amplitude, frequency and friction are edits that a block knows.
TEST(PlanarBody, takes_edits_within_its_plane) {
  const topple::Setup rocks = with_shakes(alone(), {sine(3.5, 1)});
  const std::function<void(topple::Run&)> edits[] = {
      [](topple::Run& run) { run.edit(set(Edit::Key::amplitude, 3)); },
      [](topple::Run& run) { run.edit(set(Edit::Key::frequency, 1.5)); },
      [](topple::Run& run) { run.edit(set(Edit::Key::on, 0)); },
      [](topple::Run& run) { run.edit(set(Edit::Key::friction, 0.3)); }};
  for (const auto& edit : edits) {
    const Climb found = climb(rocks, 1.5, edit);
    EXPECT_LT(found.time, 0);
    EXPECT_LT(found.apart, 5e-4);
  }
}

TEST(PlanarBody, goes_on_bit_for_bit_after_an_edit) {
  topple::Setup setup = with_shakes(alone(), {sine(3.5, 1)});
  topple::Run whole(setup);
  while (whole.step() < 1100) ASSERT_TRUE(whole.advance().ok());
  whole.edit(set(Edit::Key::friction, 0.3));
  topple::Run rest(setup, unpack(setup.model, pack(whole.state())), whole.parameters());
  for (int i = 0; i < 700; ++i) {
    ASSERT_TRUE(whole.advance().ok());
    ASSERT_TRUE(rest.advance().ok());
  }
  EXPECT_EQ(hash(whole.state()), hash(rest.state()));
}

// `auto` begins so where it may, and says by how much it errs.
TEST(PlanarBody, automatic_begins_so_where_it_may) {
  struct Row {
    const char* what;
    ModelLevel expected;
    void (*change)(topple::Setup&);
  };
  constexpr Row rows[] = {
      {"alone on a hard floor", ModelLevel::planar, [](topple::Setup&) {}},
      {"stresses are asked for", ModelLevel::elastic,
       [](topple::Setup& s) { s.parameters.want_stress = true; }},
      {"soft contacts", ModelLevel::rigid, [](topple::Setup& s) { s.parameters.contact.alpha = 100 * k_g; }},
      {"contacts bounce", ModelLevel::rigid,
       [](topple::Setup& s) { s.parameters.contact.restitution = 0.5; }},
      {"a wall", ModelLevel::rigid,
       [](topple::Setup& s) {
         s.model.planes.push_back({"wall", Vec3(1, 0, 0), -Vec3::UnitX(), 0});
       }},
      {"askew", ModelLevel::rigid,
       [](topple::Setup& s) { s.parameters.shakes[0].direction = Vec3(1, 1, 0).normalized(); }},
  };
  for (const Row& row : rows) {
    topple::Setup setup = with_shakes(alone({.model = BodyModel::automatic}), {sine(4, 1)});
    compute_as(setup, BodyModel::automatic);
    row.change(setup);
    const topple::Run run(setup);
    EXPECT_EQ(level_of(run), row.expected) << row.what;
    const bool planar = row.expected == ModelLevel::planar;
    const State start = start_state(setup.model, setup.starts);
    if (!setup.parameters.want_stress) {
      EXPECT_EQ(why_not_planar(setup.model, setup.parameters, start, 0, false).empty(), planar) << row.what;
    }
  }
}

// Before it lands or passes half of its critical angle: by theory a rigid body leans by d/2b before it lifts,
// by experience that grows thirty times at most where nothing is near a tie.
TEST(PlanarBody, estimate_bounds_what_soft_contacts_change) {
  for (const double kgf : {2e3, 2e4})
    for (const double over : {1.2, 2.}) {
      topple::Setup setup = alone();
      setup.parameters.contact.alpha = kgf * k_g;
      setup.parameters.contact.friction = 1.2;
      const auto block = planar::planar_case(setup.model, setup.parameters, setup.starts, 0);
      ASSERT_TRUE(block);
      const double critical = block->critical(planar::Side::right);
      const double estimate = hard_floor_error(setup.model, 0, *block, setup.parameters.contact);
      setup.parameters.shakes = {sine(over * k_g * std::tan(critical), 0.5)};
      const topple::Setup other = as_rigid(setup);
      topple::Run run(setup), rigid(other);
      double most = 0;
      while (!run.over()) {
        ASSERT_TRUE(run.advance().ok() && rigid.advance().ok());
        const BodyOutcome &a = run.outcome().bodies()[0], &b = rigid.outcome().bodies()[0];
        if (a.impacts > 0 || b.impacts > 0 || a.tilt > critical / 2) break;
        most = std::max(most, std::abs(a.tilt - b.tilt) / critical);
      }
      EXPECT_LT(most, estimate) << kgf << " kgf, " << over;
      EXPECT_GT(most, estimate / 3) << kgf << " kgf, " << over;
    }
  for (const auto base : {CabinetSpec::Base::corners, CabinetSpec::Base::edges}) {
    topple::Setup hard = alone({.base = base});
    const auto block = planar::planar_case(hard.model, hard.parameters, hard.starts, 0);
    hard.parameters.contact.alpha =
        *rigid_alpha(hard.model, hard.parameters.contact, hard.parameters.gravity);
    EXPECT_EQ(hard_floor_error(hard.model, 0, *block, hard.parameters.contact), 0);
  }
}

}  // namespace
}  // namespace topple::test::planar_bodies
