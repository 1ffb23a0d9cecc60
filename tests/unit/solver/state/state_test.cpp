#include "solver/state/state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <set>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Simulation rocking(Integrator integrator = Integrator::generalized_alpha) {
  Model model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.tilt = 0.05;
  const BodyStart start = add_cabinet(model, spec);
  model.planes.push_back(ground());
  Parameters p;
  p.integrator = integrator;
  p.time_step = integrator == Integrator::central_difference ? 3e-5 : 1e-3;
  Shake shake;
  shake.amplitude = 1;
  p.shakes.push_back(shake);
  return Simulation(model, {start}, p);
}

/// Where a checkpoint holds the level of the first body, its reason, the hinges and the contact law.
std::vector<std::size_t> places_of_choices(State state) {
  const std::vector<double> numbers = pack(state);
  state.bodies[0].level = ModelLevel::elastic;
  state.bodies[0].reason = LevelReason::stress;
  for (ElementState& element : state.elements) element.hinge = Hinge::first;
  state.law = ContactLawKind::paper;
  const std::vector<double> other = pack(state);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (std::bit_cast<std::uint64_t>(numbers[i]) != std::bit_cast<std::uint64_t>(other[i]))
      places.push_back(i);
  return places;
}

TEST(State, pack_and_unpack_give_the_same_bits) {
  Simulation sim = rocking();
  ASSERT_TRUE(sim.advance(30));
  const std::vector<double> numbers = pack(sim.state);
  const State back = unpack(sim.model, numbers);
  EXPECT_EQ(hash(back), hash(sim.state));
  const std::vector<double> again = pack(back);
  ASSERT_EQ(again.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(again[i]), std::bit_cast<std::uint64_t>(numbers[i])) << i;
  EXPECT_EQ(back.step, 30);
  EXPECT_EQ(back.energy.friction, sim.state.energy.friction);
}

TEST(State, every_member_has_its_own_place_in_a_checkpoint) {
  // 25 numbers per node, 3 per stick spring, 7 per element, 23 and three per mode of a body, time, step,
  // floor's six, step size, load factor, slack, contact law, 13 energies; then the counts of near pairs and
  // of stick springs between members
  const Simulation sim = rocking();
  const std::size_t expected = 25 * static_cast<std::size_t>(sim.model.node_total()) +
                               3 * sim.model.contact_points.size() * sim.model.planes.size() +
                               7 * sim.model.elements.size() + 23 + 3 * k_modes + 2 + 6 + 4 + 13;
  std::vector<double> numbers = pack(sim.state);
  EXPECT_EQ(numbers.size(), expected + 2);
  const std::vector<std::size_t> choices = places_of_choices(sim.state);
  ASSERT_EQ(choices.size(), 3 + sim.model.elements.size());
  for (std::size_t i = 1; i < expected; ++i)
    if (std::find(choices.begin(), choices.end(), i) == choices.end()) numbers[i] = static_cast<double>(i);
  EXPECT_EQ(pack(unpack(sim.model, numbers)), numbers);
}

TEST(State, a_peak_stress_adds_its_own_to_a_checkpoint_and_none_adds_nothing) {
  Simulation sim = rocking();
  const std::vector<double> without = pack(sim.state);
  sim.state.bodies[0].peak_stress = 3.7e6;
  const std::vector<double> numbers = pack(sim.state);
  EXPECT_EQ(numbers.size(), without.size() + 2);
  EXPECT_EQ(unpack(sim.model, numbers).bodies[0].peak_stress, 3.7e6);
  EXPECT_EQ(unpack(sim.model, without).bodies[0].peak_stress, 0);
  EXPECT_NE(hash(numbers), hash(without));
  std::vector<double> other = numbers;
  other[numbers.size() - 2] = std::bit_cast<double>(std::int64_t{3});  // of a second of one
  EXPECT_THROW(unpack(sim.model, other), std::invalid_argument);
}

TEST(State, anchors_add_their_own_to_a_checkpoint_and_none_add_nothing) {
  Simulation without = rocking();
  Model model = without.model;
  model.anchors.assign(3, {.name = "strap",
                           .body = 0,
                           .node = 7,
                           .arm = Vec3::Zero(),
                           .to = Vec3(-1, 0, 2),
                           .other = {},
                           .type = Anchor::Type::strap,
                           .stiffness = 1e4,
                           .length = 5});
  Simulation sim(model, {BodyStart{}}, without.parameters);
  ASSERT_TRUE(sim.advance(3));
  sim.state.anchors[1] = {.length = 4, .hold = AnchorHold::broken};
  sim.state.anchors[2].hold = AnchorHold::away;
  const std::vector<double> numbers = pack(sim.state);
  EXPECT_EQ(numbers.size(), pack(without.state).size() + 2 + 2 * 3);
  const State back = unpack(model, numbers);
  EXPECT_EQ(hash(back), hash(sim.state));
  EXPECT_EQ(back.anchors[1].hold, AnchorHold::broken);
  EXPECT_EQ(back.anchors[1].length, 4);
  EXPECT_EQ(back.anchors[2].hold, AnchorHold::away);
  EXPECT_THROW(unpack(without.model, numbers), std::invalid_argument);
}

TEST(State, checkpoint_of_another_model_is_refused) {
  const Simulation sim = rocking();
  std::vector<double> numbers = pack(sim.state);
  numbers.pop_back();
  EXPECT_THROW(unpack(sim.model, numbers), std::invalid_argument);
  numbers.resize(numbers.size() + 2);
  EXPECT_THROW(unpack(sim.model, numbers), std::invalid_argument);
  EXPECT_THROW(unpack(sim.model, std::vector<double>{}), std::invalid_argument);
}

TEST(State, hash_changes_with_any_bit) {
  Simulation sim = rocking();
  ASSERT_TRUE(sim.advance(5));
  const std::vector<double> numbers = pack(sim.state);
  const std::vector<std::size_t> choices = places_of_choices(sim.state);
  std::set<std::uint64_t> seen = {hash(sim.state)};
  std::size_t count = 1;
  for (std::size_t i = 0; i + 2 < numbers.size(); ++i)  // the last two count what touches
    for (int bit : {3, 31, 63}) {
      std::vector<double> changed = numbers;
      changed[i] =
          std::bit_cast<double>(std::bit_cast<std::uint64_t>(changed[i]) ^ (std::uint64_t{1} << bit));
      if (std::find(choices.begin(), choices.end(), i) == choices.end()) {
        seen.insert(hash(unpack(sim.model, changed)));
        ++count;
      } else {
        EXPECT_THROW(unpack(sim.model, changed), std::invalid_argument);
      }
    }
  EXPECT_EQ(seen.size(), count);
}

TEST(State, continuing_from_a_checkpoint_gives_the_same_hashes) {
  for (Integrator integrator : {Integrator::generalized_alpha, Integrator::central_difference}) {
    Simulation sim = rocking(integrator);
    ASSERT_TRUE(sim.advance(100));
    State other = unpack(sim.model, pack(sim.state));
    Workspace fresh(sim.model);
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(sim.advance(1));
      ASSERT_TRUE(step(sim.model, sim.parameters, other, fresh).ok());
      ASSERT_EQ(hash(other), hash(sim.state)) << "step " << i;
    }
  }
}

TEST(State, start_turns_about_its_pivot_and_moves_as_a_rigid_body) {
  Model model = steel_model();
  add_cabinet(model, tall_cabinet());
  BodyStart start;
  start.pivot = {0.19, 0, 0.015};
  start.rotation = {0.1, 0.4, -0.2};
  start.velocity = {1, 2, 3};
  start.angular_velocity = {-0.5, 0.7, 2};
  const State state = start_state(model, {start});
  const Mat3 r = exp_quaternion(start.rotation).toRotationMatrix();
  const Vec3 centre = start.pivot + r * (model.bodies[0].centre_of_gravity - start.pivot);
  for (int i = 0; i < model.node_total(); ++i) {
    EXPECT_LT((state.position[i] - start.pivot - r * (model.node_position[i] - start.pivot)).norm(), 1e-14);
    EXPECT_LT((state.velocity[i] - start.velocity - start.angular_velocity.cross(state.position[i] - centre))
                  .norm(),
              1e-14);
    EXPECT_LT((state.rotation[i] * state.angular_velocity[i] - start.angular_velocity).norm(), 1e-14);
  }
  EXPECT_LT((linear_momentum(model, state) - 40 * start.velocity).norm(), 1e-9);
}

TEST(State, supported_directions_start_at_rest) {
  Model model =
      cantilever(plain_section(1e-4, 1e-8, 1e-8, 1e-8, 1, 1), steel(), 1, 1, Vec3::Zero(), Vec3::Zero());
  BodyStart start;
  start.velocity = {1, 2, 3};
  start.angular_velocity = {1, 1, 1};
  const State state = start_state(model, {start});
  EXPECT_EQ(state.velocity[0], Vec3(Vec3::Zero()));
  EXPECT_EQ(state.angular_velocity[0], Vec3(Vec3::Zero()));
  EXPECT_GT(state.velocity[1].norm(), 0);
  model.supports[0].fixed = 0x1f;  // free to turn about z
  start.rotation = {0, 0, 0.5};
  const State hinged = start_state(model, {start});
  EXPECT_LT((hinged.rotation[0] * hinged.angular_velocity[0] - Vec3(0, 0, 1)).norm(), 1e-15);
}

TEST(State, is_finite_sees_every_number) {
  const Simulation sim = rocking();
  EXPECT_TRUE(is_finite(sim.state));
  const std::vector<double> numbers = pack(sim.state);
  const std::vector<std::size_t> choices = places_of_choices(sim.state);
  for (std::size_t i = 1; i + 2 < numbers.size(); ++i)  // the first and the last two are integers
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e308, 2e30}) {
      std::vector<double> changed = numbers;
      changed[i] = bad;
      if (std::find(choices.begin(), choices.end(), i) == choices.end()) {
        EXPECT_FALSE(is_finite(unpack(sim.model, changed))) << i;
      }
    }
}

}  // namespace
}  // namespace topple::test
