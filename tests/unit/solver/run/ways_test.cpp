// The way out against rooms with a known answer, and against a grid that knows nothing of chains and
// tangents.
#include "solver/run/ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

Footprint box(double x, double y, double depth, double width, double turn = 0) {
  Footprint print;
  for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    print.core.push_back(Vec2(x, y) + Eigen::Rotation2Dd(turn) * Vec2(a * depth / 2, b * width / 2));
  return print;
}

/// 6 m by 4 m, x from 0 and y from -2, with a door of 900 mm in the middle of the wall x = 6.
Room closed_room() {
  Room room;
  room.walls = {{"back", {0, 0}, {1, 0}},
                {"front", {6, 0}, {-1, 0}},
                {"right", {0, -2}, {0, 1}},
                {"left", {0, 2}, {0, -1}}};
  room.doors = {{"door", 1, 0, 0.9}};
  room.places = {{"desk", {1, 0}}};
  return room;
}

RoomPlan plan_of(std::vector<Footprint> lying) {
  RoomPlan plan;
  for (std::size_t k = 0; k < lying.size(); ++k) plan.body.push_back(static_cast<int>(k));
  plan.lying = std::move(lying);
  return plan;
}

TEST(Convex, distances_are_those_of_the_figures) {
  const Convex square = convex_hull({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.5, 0}});
  ASSERT_EQ(square.size(), 4u);
  EXPECT_EQ(distance(square, {0.3, 0.3}), 0);
  EXPECT_DOUBLE_EQ(distance(square, {1.3, 1.4}), 0.5);
  EXPECT_DOUBLE_EQ(nearest_points(square, {{2, -5}, {2, 5}}).distance, 1);
  EXPECT_EQ(nearest_points(square, {{-1, 0.5}, {3, 0.6}}).distance, 0);
  EXPECT_EQ(nearest_points(square, {{0.2, 0.2}, {0.4, 0.2}, {0.3, 0.3}}).distance, 0);  // within
  EXPECT_DOUBLE_EQ(nearest_points({{0, 0}}, {{3, 4}}).distance, 5);
}

TEST(Ways, a_gap_of_510_mm_lets_a_person_pass_and_one_of_490_mm_does_not) {
  const Room room = closed_room();
  for (const double gap : {0.49, 0.51})
    for (const double shift : {0., 0.3, -0.71}) {
      const double right = 2 + shift - gap / 2, left = 2 - shift - gap / 2;  // widths of what stands across
      const Way way =
          ways(room, plan_of({box(3, -2 + right / 2, 0.4, right), box(3, 2 - left / 2, 0.4, left)}))[0];
      EXPECT_NEAR(way.widest, gap, 1e-12);
      EXPECT_EQ(way.open, gap > 0.5);
      EXPECT_EQ(way.blocked_by, gap > 0.5 ? std::vector<int>{} : (std::vector<int>{0, 1}));
    }
}

// From a bed of 1 m by 2 m, with a cupboard across the room behind its foot that leaves 1.4 m.
TEST(Ways, who_lies_on_a_piece_walks_over_it) {
  Room room = closed_room();
  const RoomPlan plan = plan_of({box(1, 0, 2, 1), box(2.5, -0.7, 0.4, 2.6)});
  EXPECT_TRUE(ways(room, plan)[0].caught);
  EXPECT_EQ(ways(room, plan)[0].blocked_by, std::vector<int>{0});
  room.places[0].on = 0;
  const Way over = ways(room, plan)[0];
  EXPECT_TRUE(over.open && !over.caught);
  EXPECT_NEAR(over.widest, 0.9, 1e-12);  // the door's
  // around the cupboard's corners at 0.6 m, a quarter of a disc farther: no shorter than the straight parts
  const auto line = shortest_way(room, plan, 0, over.door);
  ASSERT_TRUE(line);
  EXPECT_GT(line->length, std::hypot(1.3, 0.6) + std::hypot(3.3, 0.6));
  const RoomPlan fallen = plan_of({box(1, 0, 2, 1), box(1.2, 0, 0.4, 1)});
  EXPECT_EQ(ways(room, fallen)[0].blocked_by, std::vector<int>{1});
}

TEST(Ways, what_lies_before_a_door_closes_it_by_its_gaps_to_the_jambs) {
  const Room room = closed_room();
  const auto before_door = [&](double away) {
    return ways(room, plan_of({box(6 - away - 0.1, 0, 0.2, 1.2)}))[0];
  };
  // the jambs stand at +-0.45: the gap to the wall beside the door is what passes
  EXPECT_NEAR(before_door(0.49).widest, 0.49, 1e-12);
  EXPECT_FALSE(before_door(0.49).open);
  EXPECT_EQ(before_door(0.49).blocked_by, std::vector<int>{0});
  EXPECT_NEAR(before_door(0.51).widest, 0.51, 1e-12);
  EXPECT_TRUE(before_door(0.51).open);
}

TEST(Ways, nothing_in_the_way_leaves_the_width_of_the_door) {
  const Way way = ways(closed_room(), {})[0];
  EXPECT_EQ(way.widest, 0.9);
  EXPECT_TRUE(way.open);
  EXPECT_NEAR(shortest_way(closed_room(), {}, 0, 0)->length, 5, 1e-12);
}

TEST(Ways, a_chain_that_ends_in_the_open_side_blocks_nothing) {
  Room room = closed_room();
  room.walls.pop_back();                                      // the left side is open
  const std::vector<Footprint> across{box(3, -0.5, 0.4, 3)};  // from the right wall to y = 1
  EXPECT_TRUE(ways(room, plan_of(across))[0].open);
  room.walls.push_back({"left", {0, 1.4}, {0, -1}});
  EXPECT_NEAR(ways(room, plan_of(across))[0].widest, 0.4, 1e-12);
}

TEST(Ways, a_way_is_no_wider_than_where_it_begins) {
  // between two shelves along the room whose ends are free
  const Way way = ways(closed_room(), plan_of({box(1, 0.5, 1.2, 0.4), box(1, -0.5, 1.2, 0.4)}))[0];
  EXPECT_TRUE(way.open);
  EXPECT_NEAR(way.widest, 0.6, 1e-12);
}

TEST(Ways, a_ring_of_furniture_holds_who_stands_in_it) {
  const Room room = closed_room();
  std::vector<Footprint> ring;
  for (int k = 0; k < 8; ++k) {
    const double turn = k * k_pi / 4;
    ring.push_back(box(1 + 0.8 * std::cos(turn), 0.8 * std::sin(turn), 0.1, 0.5, turn));
  }
  const Way way = ways(room, plan_of(ring))[0];
  EXPECT_FALSE(way.open);
  EXPECT_EQ(way.blocked_by.size(), 8u);
}

TEST(Ways, what_lies_on_the_place_is_what_blocks) {
  const Way way = ways(closed_room(), plan_of({box(3, 0, 0.4, 0.4), box(1.3, 0, 0.4, 0.4)}))[0];
  EXPECT_FALSE(way.open);
  EXPECT_NEAR(way.widest, 0.2, 1e-12);
  EXPECT_EQ(way.blocked_by, std::vector<int>{1});
}

TEST(Ways, of_two_doors_the_nearer_open_one_serves) {
  Room room = closed_room();
  room.doors.push_back({"side", 2, -2, 0.8});  // of the wall y = -2, whose along() is -x
  EXPECT_EQ(ways(room, {})[0].door, 1);
  const RoomPlan shut = plan_of({box(2, -1.8, 1, 0.3)});
  EXPECT_EQ(ways(room, shut)[0].door, 0);
  EXPECT_TRUE(ways(room, shut)[0].open);
}

TEST(Ways, the_shortest_way_around_a_shelf_is_two_tangents_and_an_arc) {
  Room room = closed_room();
  room.walls.erase(room.walls.begin() + 2, room.walls.end());
  // a screen across x = 3.5 from y = -3 to 1: around its end, where the disc's middle keeps 0.25 m
  Footprint screen{{{3.5, -3}, {3.5, 1}}, 0};
  const double radius = 0.25, d = std::hypot(2.5, 1), tangent = std::sqrt(d * d - radius * radius);
  const double arc = 2 * (std::atan2(1, 2.5) + std::asin(radius / d));  // by which the way turns
  const auto way = shortest_way(room, plan_of({screen}), 0, 0);
  ASSERT_TRUE(way);
  // to the middle of the door; the door's line reaches nearer to the screen's end
  const double to_middle = 2 * tangent + radius * arc;
  const double rise = std::hypot(2.5, 0.8), tangent_up = std::sqrt(rise * rise - radius * radius);
  const double to_jamb =
      tangent + tangent_up + radius * (arc / 2 + std::atan2(0.8, 2.5) + std::asin(radius / rise));
  EXPECT_LT(way->length, to_middle);
  EXPECT_NEAR(way->length, to_jamb, 0.005 * to_jamb);  // as shortest_way.h says
}

TEST(PlaceHits, a_falling_cabinet_hits_when_its_upper_edge_comes_over_the_person) {
  topple::Setup setup = shaken(5, 0.25);
  setup.room.places = {{"before", {1.2, 0}}, {"behind", {-1.2, 0}}};
  topple::Run run(setup);
  double before = 0;  // tilt
  while (!run.over() && run.places()[0].hits.empty()) {
    before = run.outcome().bodies()[0].tilt;
    ASSERT_TRUE(run.advance().ok());
  }
  ASSERT_EQ(run.places()[0].hits.size(), 1u);
  EXPECT_EQ(run.places()[0].hits[0].body, 0);
  EXPECT_EQ(run.places()[0].hits[0].time, run.time());
  const CabinetSpec spec = tall_cabinet();
  // it turns about its lower edge; the surface lies half a post outside
  const auto reach = [&](double tilt) { return spec.size.x() / 2 + spec.size.z() * std::sin(tilt) + 0.015; };
  constexpr double k_bend = 5e-3;  // m: it is a frame, its edges bend and its feet sink in
  EXPECT_GT(reach(run.outcome().bodies()[0].tilt), 1.2 - 0.25 - k_bend);
  EXPECT_LT(reach(before), 1.2 - 0.25 + k_bend);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_EQ(run.places()[0].hits.size(), 1u);
  EXPECT_TRUE(run.places()[1].hits.empty());
}

TEST(Footprint, is_cut_at_a_height) {
  const topple::Setup setup = shaken(1, 0.25);
  const State start = start_state(setup.model, setup.starts);
  const CabinetSpec spec = tall_cabinet();
  const auto reach = [&](double height) {
    double most = -1;
    const Footprint print = footprint(setup.model, start.position, 0, height).value();
    for (const Vec2& corner : print.core) most = std::max(most, corner.x());
    return most;
  };
  // the front leans by 0.25 rad from its lower edge
  const double foot = setup.model.node_position[0].z();
  EXPECT_NEAR(reach(1), spec.size.x() / 2 + std::tan(0.25) * (1 - foot), 1e-9);
  EXPECT_NEAR(reach(5), spec.size.x() / 2 + std::sin(0.25) * spec.size.z(), 1e-9);
  EXPECT_FALSE(footprint(setup.model, start.position, 0, -1));
}

/// Whether a disc of this width gets from the place to the door, on a grid: `slack` is added to what is free.
bool reaches_on_grid(const Room& room, const RoomPlan& plan, double width, double slack) {
  constexpr double k_cell = 0.02;
  constexpr int k_x = 320, k_y = 200;  // x to 6.4, so that the door is passed
  const std::vector<Convex> walls = faces(room);
  const auto at = [](int i, int j) { return Vec2(k_cell * i, -2 + k_cell * j); };
  const auto is_free = [&](const Vec2& x) {
    for (const Convex& wall : walls)
      if (distance(wall, x) < width / 2 - slack) return false;
    for (const Footprint& print : plan.lying)
      if (print.distance(x) < width / 2 - slack) return false;
    return true;
  };
  if (!is_free(room.places[0].at)) return false;
  std::vector<bool> seen(k_x * k_y, false);
  std::deque<std::pair<int, int>> queue{{50, 100}};
  seen[50 * k_y + 100] = true;
  while (!queue.empty()) {
    const auto [i, j] = queue.front();
    queue.pop_front();
    if (at(i, j).x() > 6.2) return true;
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int x = i + di, y = j + dj;
      if (x < 0 || y < 0 || x >= k_x || y >= k_y || seen[static_cast<std::size_t>(x * k_y + y)]) continue;
      if (!is_free(at(x, y))) continue;
      seen[static_cast<std::size_t>(x * k_y + y)] = true;
      queue.emplace_back(x, y);
    }
  }
  return false;
}

TEST(Ways, agree_with_a_grid_in_random_rooms) {
  const Room room = closed_room();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int narrow = 0, shut = 0;
  for (int n = 0; n < 60; ++n) {
    std::vector<Footprint> lying;
    while (lying.size() < 9) {
      Footprint print = box(1 + 4.8 * unit(random), -2 + 4 * unit(random), 0.2 + 0.4 * unit(random),
                            0.4 + 1.2 * unit(random), k_pi * unit(random));
      print.radius = 0.02 * unit(random);
      if (print.distance(room.places[0].at) > 0.3) lying.push_back(std::move(print));
    }
    const RoomPlan plan = plan_of(std::move(lying));
    const Way way = ways(room, plan)[0];
    SCOPED_TRACE("room " + std::to_string(n) + ", widest " + std::to_string(way.widest));
    // a cell lies within 0.0142 m of any point: what a disc passes, one smaller by as much passes on cells
    EXPECT_FALSE(reaches_on_grid(room, plan, way.widest + 0.002, 0)) << "passes on cells";
    const double narrower = way.widest - 0.04;
    if (narrower > 0.1 && way.widest < 0.55) {
      EXPECT_TRUE(reaches_on_grid(room, plan, narrower, 0.0));
      ++narrow;
    }
    shut += !way.open;
    EXPECT_EQ(way.open, shortest_way(room, plan, 0, 0).has_value());
    if (way.open) {
      EXPECT_GE(shortest_way(room, plan, 0, 0)->length, 5 - 1e-9);
    }
  }
  EXPECT_GT(narrow, 15);
  EXPECT_GT(shut, 3);
}

}  // namespace
}  // namespace topple::test
