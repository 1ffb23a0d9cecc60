// Stick springs between members: parts have their own while they advance, the state has one list.
#include "solver/state/member_sticks.h"

#include <gtest/gtest.h>

namespace topple::test {
namespace {

// Four bodies of two elements; the last is held.
Model four_bodies() {
  Model model;
  for (int b = 0; b < 4; ++b) {
    Body& body = model.bodies.emplace_back();
    body.first_element = 2 * b;
    body.element_count = 2;
    model.members.emplace_back().body = b;
    for (int e = 0; e < 2; ++e) model.elements.emplace_back().member = b;
  }
  return model;
}

MemberStick stick(int a, int b, double value) {
  return {{a, b}, 1, {value, 0, 0}};
}

struct StickOf {
  int a, b;
  double value;
  bool operator==(const StickOf&) const = default;
};
std::vector<StickOf> listed(const State& state) {
  std::vector<StickOf> out;
  for (const MemberStick& s : state.member_sticks) out.push_back({s.elements.a, s.elements.b, s.stick.x()});
  return out;
}

MemberPair pair_of(int a, int b) {
  MemberPair pair{};
  pair.elements = {a, b};
  return pair;
}

// Bodies 0 and 2 are one part, 1 is another; either touches the held one.
TEST(MemberSticks, parts_that_alternate_give_back_one_list_in_order) {
  const Model model = four_bodies();
  MemberSticks one, two;
  const std::vector<MemberSticks*> of_body{&one, &two, &one, nullptr};
  State state;
  state.member_sticks = {stick(0, 4, 1), stick(1, 5, 2), stick(1, 7, 3),
                         stick(2, 6, 4), stick(3, 7, 5), stick(5, 6, 6)};
  const std::vector<StickOf> before = listed(state);
  take_sticks(model, of_body, state);
  give_sticks(model, of_body, state);
  EXPECT_EQ(listed(state), before);

  take_sticks(model, of_body, state);
  std::vector<MemberPair> pairs{pair_of(2, 6), pair_of(3, 7)};
  two.load(state, pairs);
  EXPECT_EQ(pairs[0].stick[1].x(), 4);
  EXPECT_EQ(pairs[1].stick[1].x(), 5);
  pairs[0].stick[1].x() = 7;
  const std::vector<int> which{0};
  const std::vector<std::uint8_t> places{1 << 1, 0};
  two.store(which, places, pairs);
  give_sticks(model, of_body, state);
  EXPECT_EQ(listed(state), (std::vector<StickOf>{{0, 4, 1}, {1, 5, 2}, {1, 7, 3}, {2, 6, 7}, {5, 6, 6}}));
}

// Where the first of two parts is of a held body, several parts have pairs with it.
TEST(MemberSticks, of_a_held_body_that_comes_first_go_to_what_stands_on_it) {
  const Model model = four_bodies();
  MemberSticks one, two;
  const std::vector<MemberSticks*> of_body{nullptr, &one, &two, &one};
  State state;
  state.member_sticks = {stick(0, 2, 1), stick(0, 4, 2), stick(0, 6, 3), stick(1, 4, 4), stick(3, 6, 5)};
  const std::vector<StickOf> before = listed(state);
  take_sticks(model, of_body, state);
  std::vector<MemberPair> pairs{pair_of(0, 2), pair_of(0, 4), pair_of(0, 6)};
  two.load(state, pairs);
  EXPECT_EQ(pairs[0].stick[1].x(), 0);
  EXPECT_EQ(pairs[1].stick[1].x(), 2);
  EXPECT_EQ(pairs[2].stick[1].x(), 0);
  give_sticks(model, of_body, state);
  EXPECT_EQ(listed(state), before);
}

}  // namespace
}  // namespace topple::test
