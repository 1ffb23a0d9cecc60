// Bodies that meet each other while they move.
#include <cmath>
#include <cstdlib>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

/// One cabinet on the floor and one above it in any orientation, thrown down.
topple::Setup random_drop(int seed) {
  std::mt19937 rng(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> u(-1, 1);
  topple::Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.name = "under";
  setup.starts.push_back(add_cabinet(setup.model, spec));
  spec.name = "falling";
  const Quat turn = random_rotation(rng);
  const double x = 0.3 * u(rng), y = 0.6 * u(rng);
  spec.at = Vec3(x, y, 3.1 - spec.cg_height);
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  BodyStart& start = setup.starts[1];
  const Eigen::AngleAxisd axis(turn);
  start.rotation = axis.angle() * axis.axis();
  start.pivot = setup.model.bodies[1].centre_of_gravity;
  start.velocity = Vec3(u(rng), u(rng), -2 + u(rng));
  start.angular_velocity = random_vector(rng, 3);
  setup.run.duration = 1.2;
  setup.run.settle = false;
  setup.parameters.adaptive = true;
  return setup;
}

/// Volumes spanned by pairs of elements whose lines cross between their ends: their signs tell the side.
class Sides {
 public:
  /// False when a pair has changed sides since the last call while it crossed both times.
  bool follow(const Model& model, const State& state) {
    std::vector<std::pair<ElementPair, bool>> now;
    bool kept = true;
    for (const ElementPair& pair : state.candidate_pairs) {
      if (panel_of(model, pair.b) != nullptr) continue;
      const int *m = model.elements[pair.a].node, *n = model.elements[pair.b].node;
      const Vec3 &a0 = state.position[m[0]], &b0 = state.position[n[0]];
      const Vec3 u = state.position[m[1]] - a0, v = state.position[n[1]] - b0, across = u.cross(v);
      const double square = across.squaredNorm();
      const double s = (b0 - a0).cross(v).dot(across) / square, t = (b0 - a0).cross(u).dot(across) / square;
      if (!(s > 0.02 && s < 0.98 && t > 0.02 && t < 0.98)) continue;
      const bool above = (a0 - b0).dot(across) > 0;
      const auto before = std::lower_bound(known_.begin(), known_.end(), std::pair(pair, false));
      if (before != known_.end() && before->first == pair && before->second != above) kept = false;
      now.emplace_back(pair, above);
    }
    known_ = std::move(now);
    return kept;
  }

 private:
  std::vector<std::pair<ElementPair, bool>> known_;
};

// All 200 with TOPPLE_ALL_DROPS, as tests/run --all does.
TEST(Collision, cabinets_dropped_on_cabinets_gain_no_energy_and_go_not_through_each_other) {
  const int drops = std::getenv("TOPPLE_ALL_DROPS") ? 200 : 12;
  for (int seed = 0; seed < drops; ++seed) {
    const topple::Setup setup = random_drop(seed);
    topple::Run run(setup);
    const State& state = run.state();
    Sides sides;
    double lost = 0;
    while (!run.over()) {
      run.advance();
      ASSERT_TRUE(run.status().ok()) << seed << ": " << run.status().message(setup.model);
      lost = std::max(lost, state.energy.balance_error());
      ASSERT_TRUE(sides.follow(setup.model, state)) << seed << " at " << state.time;
    }
    EXPECT_TRUE(is_finite(state)) << seed;
    // what was not there at the start and did not come from falling was not made
    EXPECT_LT(lost, 1e-3) << seed;
    for (const BodyOutcome& body : run.outcome().bodies()) EXPECT_LT(body.peak_pinch, 1) << seed;
  }
}

/// Bars along x and, above it, y.
Model crossing_bars(double gap) {
  Model model = steel_model();
  for (int k = 0; k < 2; ++k) {
    BodyBuilder builder(model, k == 0 ? "below" : "above");
    const double z = k * gap;
    const Vec3 along = k == 0 ? Vec3::UnitX() : Vec3::UnitY();
    builder.line("bar", Vec3(0, 0, z) - 0.3 * along, Vec3(0, 0, z) + 0.3 * along, 1, 2, 0, 0, Vec3::UnitZ());
    builder.add_material_mass();
    builder.close();
  }
  return model;
}

TEST(Collision, bars_that_meet_across_exchange_momentum_and_no_more) {
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    Model model = crossing_bars(0.05);
    BodyStart still, moving;
    moving.velocity = Vec3(0.3, 0, -1);
    moving.angular_velocity = Vec3(0, 0, 0.5);
    Parameters p = weightless();
    p.integrator = integrator;
    p.time_step = integrator == Integrator::central_difference ? 2e-6 : 2e-4;
    Simulation sim(model, {still, moving}, p);
    const Vec3 linear = linear_momentum(model, sim.state);
    const double energy = kinetic_energy(model, sim.state);
    const int steps = static_cast<int>(std::lround(0.12 / p.time_step));
    ASSERT_TRUE(sim.advance(steps));
    // forces are equal and opposite to rounding in every step
    EXPECT_LT((linear_momentum(model, sim.state) - linear).norm(), 1e-9 * linear.norm());
    const Vec3 below = sim.state.velocity[1], above = sim.state.velocity[4];
    EXPECT_LT(below.z(), above.z());  // they parted
    EXPECT_LT(kinetic_energy(model, sim.state), energy);
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

TEST(Collision, fast_bars_cut_the_step_and_do_not_pass) {
  Model model = crossing_bars(0.5);
  BodyStart still, moving;
  moving.velocity = Vec3(0, 0, -40);  // 40 mm a step, more than L
  Parameters p = weightless();
  Simulation sim(model, {still, moving}, p);
  int rejected = 0;
  for (int i = 0; i < 40; ++i) {
    const StepStatus status = sim.advance();
    ASSERT_TRUE(status.ok()) << status.message(model);
    rejected += status.rejected;
  }
  EXPECT_GT(rejected, 0);
  EXPECT_LT(sim.state.position[1].z(), sim.state.position[4].z());
}

TEST(Collision, state_goes_on_from_a_checkpoint_in_the_middle_of_a_collision) {
  const topple::Setup setup = random_drop(1);
  topple::Run run(setup);
  while (run.state().member_sticks.empty()) {
    ASSERT_FALSE(run.over());
    ASSERT_TRUE(run.advance().ok());
  }
  topple::Run other(setup, unpack(setup.model, pack(run.state())), run.parameters());
  EXPECT_EQ(hash(other.state()), hash(run.state()));
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(run.advance().ok() && other.advance().ok());
    ASSERT_EQ(hash(other.state()), hash(run.state())) << i;
  }
}

/// A bar resting across two others, pushed by a horizontal load below and above the friction limit.
TEST(Collision, members_stick_and_slide_on_members_as_coulomb_has_it) {
  for (const double push : {0.5, 0.7}) {
    Model model = steel_model();
    BodyBuilder rails(model, "rails");
    const int first = model.node_total();
    for (double y : {-0.2, 0.2}) rails.line("rail", {-1, y, 0}, {1, y, 0}, 1, 2, 0, 0, Vec3::UnitZ());
    rails.add_material_mass();
    rails.close();
    for (int i = first; i < model.node_total(); ++i) model.supports.push_back({i, 0x3f});
    BodyBuilder sled(model, "sled");
    for (double x : {-0.1, 0.1})
      sled.line("runner", {x, -0.3, 0.03}, {x, 0.3, 0.03}, 1, 2, 0, 0, Vec3::UnitZ());
    sled.line("tie", {-0.1, 0, 0.03}, {0.1, 0, 0.03}, 1, 2, 0, 0, Vec3::UnitZ());
    sled.add_material_mass();
    sled.close();
    const double weight = model.bodies[1].mass * k_g;
    for (int i = model.bodies[1].first_node; i < model.node_total(); ++i)
      model.loads.push_back({i,
                             push * weight * model.node_mass[i] / model.bodies[1].mass * Vec3::UnitX(),
                             Vec3::Zero(),
                             {{0, 0}, {0.2, 1}}});
    Parameters p;
    p.contact.friction = 0.6;
    Simulation sim(model, {BodyStart{}, BodyStart{}}, p, true);
    ASSERT_TRUE(sim.advance(600));
    if (push < 0.6) {
      EXPECT_LT(std::abs(sim.state.velocity[model.bodies[1].first_node].x()), 1e-6);
    } else {
      // past the limit from 0.2 s * 0.6/0.7 on: integrated twice, mu g taken off
      const double t0 = 0.2 * 0.6 / 0.7, ramp = 0.2 - t0, a = 0.1 * k_g;
      const double v = a * ramp / 2, exact = a * ramp * ramp / 6 + v * 0.4 + a * 0.4 * 0.4 / 2;
      const Vec3& x = sim.state.position[model.bodies[1].first_node];
      EXPECT_NEAR(x.x() - model.node_position[model.bodies[1].first_node].x(), exact, 0.01 * exact);
    }
    EXPECT_LT(sim.state.energy.balance_error(), 1e-3);
  }
}

}  // namespace
}  // namespace topple::test
