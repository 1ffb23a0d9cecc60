#include "solver/body/candidates.h"

#include "solver/body/model_level.h"
#include "solver/math/ranges.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

struct Row {
  Model model = steel_model();
  State state;
};

// Cabinets 20 mm apart, on the level rigid where they stand.
Row row_of_cabinets(int count, double gap = 0.02) {
  Row row;
  for (int k = 0; k < count; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.at.x() = k * (spec.size.x() + gap);
    add_cabinet(row.model, spec);
  }
  row.state = start_state(row.model, std::vector<BodyStart>(count));
  for (int k = 0; k < count; ++k) {
    BodyState& s = row.state.bodies[k];
    s.level = ModelLevel::rigid;
    s.position = row.model.bodies[k].centre_of_gravity;
  }
  return row;
}

// About a point.
void move(BodyState& s, const Vec3& shift, const Vec3& turn, const Vec3& about) {
  const Quat q = exp_quaternion(turn);
  s.position = about + q * (s.position - about) + shift;
  s.rotation = q * s.rotation;
}

// Of elements of two bodies, m.
double gap(const Model& model, const State& state, const ElementPair& pair) {
  const auto& x = state.position;
  const int *const m = model.elements[pair.a].node, *const n = model.elements[pair.b].node;
  return nearest_points(x[m[0]], x[m[1]], x[n[0]], x[n[1]]).between.norm() - contact_length(model, pair);
}

// Some move as rigid bodies, one by its nodes, at random and so far that they pass through each other: none
// come closer than is said, and what is not listed stays further apart than the margin.
TEST(Candidates, list_what_is_within_the_margin_however_bodies_move) {
  std::mt19937 rng(11);
  auto [model, state] = row_of_cabinets(5);
  state.bodies[2].level = ModelLevel::frame;
  std::vector<ElementPair> all;
  for (int a = 0; a < static_cast<int>(model.elements.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(model.elements.size()); ++b)
      if (body_of(model, a) != body_of(model, b)) all.push_back({a, b});
  NearSearch search(model);
  update_candidates(model, search, state, 0);
  int searches = 0, far = 0;
  for (int step = 0; step < 200; ++step) {
    State next = state;
    for (BodyState& s : next.bodies)
      if (s.level == ModelLevel::rigid)
        move(s, random_vector(rng, 0.002), random_vector(rng, 0.01), s.position + random_vector(rng));
    const Body& frame = model.bodies[2];
    for (int i = frame.first_node; i < frame.first_node + frame.node_count; ++i)
      next.position[i] += random_vector(rng, 0.001);
    place_nodes(model, next);
    const double closer = Approach().greatest(model, state, next, state.candidate_margin);
    for (const ElementPair& pair : all) {
      const double before = gap(model, state, pair), after = gap(model, next, pair);
      ASSERT_TRUE(before > state.candidate_margin || before - after <= closer + 1e-12) << step;
    }
    if (closer < state.candidate_margin) {
      next.candidate_margin -= closer;
    } else {
      ++searches;
      next.candidate_margin = 0;
      update_candidates(model, search, next, 0);
    }
    state = next;
    for (const ElementPair& pair : all) {
      const bool is_far = gap(model, state, pair) > state.candidate_margin;
      far += is_far ? 1 : 0;
      ASSERT_TRUE(is_far || std::ranges::binary_search(state.candidate_pairs.all(), pair)) << step;
    }
  }
  EXPECT_GT(far, 1000000);
  EXPECT_GT(searches, 10);
  EXPECT_LT(searches, 150);
}

TEST(Candidates, bodies_that_move_as_one_or_far_from_each_other_use_up_no_margin) {
  auto [model, state] = row_of_cabinets(4);
  State next = state;
  for (BodyState& s : next.bodies) move(s, Vec3(0.1, -0.2, 0.3), Vec3(0.3, 0.2, -0.1), Vec3(1, 2, 3));
  // rounding of some metres
  EXPECT_LT(Approach().greatest(model, state, next, 0.05), 1e-14);
  EXPECT_LT(Approach().greatest(model, state, next, 10), 1e-14);

  auto [apart, there] = row_of_cabinets(2, 1);
  State here = there;
  here.bodies[0].position.x() += 0.1;
  here.bodies[1].position.x() -= 0.2;
  EXPECT_EQ(Approach().greatest(apart, there, here, 0.05), 0);
  // their surfaces are 1 m apart, less the posts' width
  EXPECT_NEAR(Approach().greatest(apart, there, here, 0.75), 0.3, 1e-12);
}

// In a pair of directions the bound is what surfaces do: one falls against the other, turning about its edge.
TEST(Candidates, bound_of_a_turn_is_that_of_the_furthest_point) {
  auto [model, state] = row_of_cabinets(2);
  const Body& body = model.bodies[0];
  State next = state;
  const double angle = 0.01;
  move(next.bodies[0], Vec3::Zero(), Vec3(0, angle, 0), body.centre_of_gravity);
  // a chord of the circle on which the furthest node moves
  EXPECT_NEAR(Approach().greatest(model, state, next, 0.05), 2 * std::sin(angle / 2) * body.reach, 1e-12);
}

}  // namespace
}  // namespace topple::test
