#include "solver/contact/proximity.h"

#include <algorithm>

#include "solver/body/islands.h"
#include "solver/contact/panel_place.h"
#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

TEST(Proximity, nearest_points_of_two_lines_are_nearer_than_any_others) {
  std::mt19937 rng(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 a0 = random_vector(rng), b0 = random_vector(rng);
    Vec3 a1 = random_vector(rng), b1 = random_vector(rng);
    if (trial % 4 == 0) b1 = b0 + 0.7 * (a1 - a0);  // parallel
    const NearestPoints at = nearest_points(a0, a1, b0, b1);
    EXPECT_LT((a0 + at.s * (a1 - a0) - b0 - at.t * (b1 - b0) - at.between).norm(), 1e-14);
    double least = 1e300;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 100; ++j)
        least = std::min(least, (a0 + i / 100. * (a1 - a0) - b0 - j / 100. * (b1 - b0)).norm());
    EXPECT_LE(at.between.norm(), least + 1e-12) << trial;
    // a hundredth of the lines' lengths away it is no nearer
    EXPECT_GE(at.between.norm(), least - 0.01 * ((a1 - a0).norm() + (b1 - b0).norm())) << trial;
  }
}

TEST(Proximity, grid_finds_the_pairs_that_comparing_all_finds) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> u(-1, 1);
  Model model = steel_model();
  for (int k = 0; k < 12; ++k) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "cabinet-" + std::to_string(k);
    spec.at = Vec3(1.5 * u(rng), 1.5 * u(rng), u(rng));
    spec.yaw = 3 * u(rng);
    add_cabinet(model, spec);
  }
  const double margin = 0.04;
  std::vector<ElementPair> all;
  const int count = static_cast<int>(model.elements.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      if (model.members[model.elements[a].member].body == model.members[model.elements[b].member].body)
        continue;
      const int *m = model.elements[a].node, *n = model.elements[b].node;
      const auto& x = model.node_position;
      if (nearest_points(x[m[0]], x[m[1]], x[n[0]], x[n[1]]).between.norm() <=
          contact_length(model, {a, b}) + margin)
        all.push_back({a, b});
    }
  const std::size_t of_elements = all.size();
  for (int e = 0; e < count; ++e)
    for (int end = 0; end < 2; ++end)
      for (std::size_t k = 0; is_tip(model, e, end) && k < model.panels.size(); ++k) {
        const ElementPair pair{e, count + static_cast<int>(k)};
        const auto& x = model.node_position;
        const auto& n = model.panels[k].node;
        if (body_of(model, pair.a) != body_of(model, pair.b) &&
            nearest_on_panel(x[model.elements[e].node[end]], {x[n[0]], x[n[1]], x[n[2]], x[n[3]]})
                    .between.norm() <= contact_length(model, pair) + margin)
          all.push_back(pair);
      }
  std::ranges::sort(all);
  EXPECT_GT(of_elements, 100u);
  EXPECT_GT(all.size(), of_elements + 10);
  EXPECT_EQ(NearSearch(model).find(model.node_position, margin), all);
}

TEST(Islands, bodies_that_may_touch_are_one_system_and_others_stay_alone) {
  Model model = steel_model();
  for (double x : {0., 5., 0.42, 10., 0.84}) {
    CabinetSpec spec = tall_cabinet();
    spec.name = "at-" + std::to_string(x);
    spec.at.x() = x;
    add_cabinet(model, spec);
  }
  GridSpec floor;
  floor.name = "floor";
  floor.from[0] = -1;
  floor.to[0] = 11;
  add_grid(model, floor);
  Islands islands(model);
  EXPECT_EQ(islands.divide({}, {}).size(), 5u);
  const std::vector<Island> divided = islands.divide(NearSearch(model).find(model.node_position, 0.02), {});
  ASSERT_EQ(divided.size(), 3u);  // the floor holds them all and is in none
  EXPECT_EQ(divided[0].bodies, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(divided[1].bodies, (std::vector<int>{1}));
  EXPECT_EQ(divided[2].bodies, (std::vector<int>{3}));
  BodySystem* const system = islands.system(divided[0]);
  EXPECT_EQ(system->bodies, divided[0].bodies);
  islands.keep({system});
  EXPECT_EQ(islands.system(divided[0]), system);
}

TEST(BeamFloor, carries_the_weight_of_what_stands_on_it_and_tells_which_side_lifts) {
  topple::Setup setup;
  setup.model = steel_model();
  setup.starts.push_back(add_cabinet(setup.model, tall_cabinet()));
  GridSpec floor;
  floor.name = "floor";
  setup.starts.push_back(add_grid(setup.model, floor));
  EXPECT_EQ(setup.model.furniture_total(), 1);
  setup.run.duration = 0.6;
  shake(setup, 3, 1);
  topple::Run run(setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(setup.model);
  Vec3 carried = Vec3::Zero();
  for (const MemberForce& f : run.member_contacts()) carried += f.force;
  const double weight = setup.model.bodies[0].mass * k_g;
  EXPECT_NEAR(carried.z(), weight, 1e-6 * weight);
  EXPECT_LT(std::hypot(carried.x(), carried.y()), 1e-6 * weight);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  // 3 m/s^2 are beyond g tan a = 1.74: it rocks
  EXPECT_TRUE(run.outcome().bodies()[0].first_uplift.has_value());
  EXPECT_LT(run.state().energy.balance_error(), 1e-3);
}

TEST(Proximity, nearest_points_do_not_depend_on_the_unit_of_length) {
  std::mt19937 rng(7);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 a0 = random_vector(rng), a1 = random_vector(rng), b0 = random_vector(rng),
               b1 = random_vector(rng);
    const NearestPoints at = nearest_points(a0, a1, b0, b1);
    for (const double unit : {1e-6, 1e6}) {
      const NearestPoints other = nearest_points(unit * a0, unit * a1, unit * b0, unit * b1);
      EXPECT_NEAR(other.s, at.s, 1e-9) << trial;  // 1e-16 over the square of the angle
      EXPECT_NEAR(other.t, at.t, 1e-9) << trial;
    }
  }
}

TEST(Proximity, grid_of_many_cells_finds_the_pairs_that_comparing_all_finds) {
  std::mt19937 rng(8);
  Model model = steel_model();
  for (int k = 0; k < 500; ++k) {
    BodyBuilder builder(model, "bar-" + std::to_string(k));
    const Vec3 x = random_vector(rng, 1.8), along = 0.25 * random_direction(rng);
    builder.line("bar", x - along, x + along, 1, 2, 0, 0, Vec3(0.1, 0.2, 0.3));
    builder.add_material_mass();
    builder.close();
  }
  const double margin = 0.03;
  std::vector<ElementPair> all;
  const int count = static_cast<int>(model.elements.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1 + (a + 1) % 2; b < count; ++b) {
      const int *m = model.elements[a].node, *n = model.elements[b].node;
      const auto& x = model.node_position;
      if (nearest_points(x[m[0]], x[m[1]], x[n[0]], x[n[1]]).between.norm() <=
          contact_length(model, {a, b}) + margin)
        all.push_back({a, b});
    }
  EXPECT_GT(all.size(), 100u);
  EXPECT_EQ(NearSearch(model).find(model.node_position, margin), all);
}

TEST(BeamFloor, lines_stand_at_the_whole_multiples_within_the_extent) {
  Model model = steel_model();
  GridSpec spec;
  spec.name = "wall";
  spec.origin = Vec3(2, 1, 0.5);
  spec.along = Vec3::UnitY();
  spec.up = Vec3::UnitZ();
  spec.normal = Vec3::UnitX();
  spec.spacing = 0.25;
  spec.from[0] = -0.6;
  spec.to[0] = 1.1;
  spec.from[1] = 0.2;
  spec.to[1] = 0.8;
  add_grid(model, spec);
  const double x = 2 - model.sections[0].width / 2;  // half a contact width behind the face
  std::vector<std::pair<Vec3, Vec3>> lines;
  for (const double y : {-0.5, -0.25, 0., 0.25, 0.5, 0.75, 1.})
    lines.emplace_back(Vec3(x, 1 + y, 0.7), Vec3(x, 1 + y, 1.3));
  for (const double z : {0.25, 0.5, 0.75}) lines.emplace_back(Vec3(x, 0.4, 0.5 + z), Vec3(x, 2.1, 0.5 + z));
  ASSERT_EQ(model.members.size(), lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Member& member = model.members[k];
    ASSERT_EQ(member.element_count, 2);
    const Element &first = model.elements[member.first_element],
                  &last = model.elements[member.first_element + 1];
    EXPECT_LT((model.node_position[first.node[0]] - lines[k].first).norm(), 1e-12) << member.name;
    EXPECT_LT((model.node_position[last.node[1]] - lines[k].second).norm(), 1e-12) << member.name;
  }
}

}  // namespace
}  // namespace topple::test
