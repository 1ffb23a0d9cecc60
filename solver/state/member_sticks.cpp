#include "solver/state/member_sticks.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>
#include <tuple>

#include "solver/math/ranges.h"

namespace topple {
namespace {

bool is_same(const MemberStick& a, const MemberStick& b) {
  return a.elements == b.elements && a.place == b.place;
}

bool in_order(const MemberStick& a, const MemberStick& b) {
  return std::tie(a.elements, a.place) < std::tie(b.elements, b.place);
}

// Mostly they are two that are in order one behind the other.
void sort(std::vector<MemberStick>& sticks, std::vector<MemberStick>& merged) {
  const auto second = std::is_sorted_until(sticks.begin(), sticks.end(), in_order);
  if (second == sticks.end()) return;
  if (!std::is_sorted(second, sticks.end(), in_order)) {
    std::sort(sticks.begin(), sticks.end(), in_order);
    return;
  }
  merged.clear();
  std::merge(sticks.begin(), second, second, sticks.end(), std::back_inserter(merged), in_order);
  sticks.swap(merged);
}

// Of sticks in order, whether they are of `pairs`.
auto of_pairs(std::span<const MemberPair> pairs) {
  return [pair = pairs.begin(), pairs](const MemberStick& stick) mutable {
    const auto is_before = [&](const MemberPair& one) { return one.elements < stick.elements; };
    if (pair != pairs.end() && is_before(*pair)) ++pair;  // mostly the next one has it, or none for long
    if (pair != pairs.end() && is_before(*pair)) pair = std::partition_point(pair, pairs.end(), is_before);
    return pair != pairs.end() && pair->elements == stick.elements;
  };
}

}  // namespace

// Those of `pairs` in `all` become new_. All are in order.
void MemberSticks::replace(std::span<const MemberPair> pairs, std::vector<MemberStick>& all) {
  if (std::equal(all.begin(), all.end(), new_.begin(), new_.end(), is_same)) {
    all.swap(new_);
    return;
  }
  auto own = of_pairs(pairs);
  std::erase_if(all, std::ref(own));
  all.insert(all.end(), new_.begin(), new_.end());
  sort(all, merged_);
}

void MemberSticks::load(const State& state, std::span<MemberPair> pairs) const {
  const std::vector<MemberStick>& sticks = keeps_ ? own_ : state.member_sticks;
  auto stick = sticks.begin();
  for (MemberPair& pair : pairs) {
    pair.stick.fill(Vec3::Zero());
    while (stick != sticks.end() && stick->elements < pair.elements) ++stick;
    for (; stick != sticks.end() && stick->elements == pair.elements; ++stick)
      pair.stick[stick->place] = stick->stick;
  }
}

void MemberSticks::store(std::span<const MemberTouch> touches, std::span<const MemberPair> pairs,
                         State& state) {
  new_.clear();
  for (const MemberTouch& touch : touches)
    new_.push_back({pairs[touch.pair].elements, touch.place, touch.out.stick});
  sort(new_, merged_);
  replace(pairs, keeps_ ? own_ : state.member_sticks);
}

void MemberSticks::store(std::span<const int> which, std::span<const std::uint8_t> places,
                         std::span<const MemberPair> pairs, State& state) {
  new_.clear();
  for (const int p : which)
    for (unsigned left = places[p]; left != 0; left &= left - 1) {
      const int place = std::countr_zero(left);
      if (const Vec3& stick = pairs[p].stick[place]; !stick.isZero(0))
        new_.push_back({pairs[p].elements, place, stick});
    }
  replace(pairs, keeps_ ? own_ : state.member_sticks);
}

void MemberSticks::take(const State& state) {
  own_ = state.member_sticks;
  keeps_ = true;
}

void MemberSticks::give(std::span<const MemberPair> pairs, State& state) {
  keeps_ = false;
  new_.clear();
  auto own = of_pairs(pairs);
  ranges::copy_if(own_, std::back_inserter(new_), std::ref(own));
  replace(pairs, state.member_sticks);
}

}  // namespace topple
