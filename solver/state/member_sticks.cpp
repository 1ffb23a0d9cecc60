#include "solver/state/member_sticks.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "solver/math/ranges.h"

namespace topple {
namespace {

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

// Those of `pairs` become those in `sticks`. All are in order.
void replace(std::span<const MemberPair> pairs, const std::vector<MemberStick>& sticks,
             std::vector<MemberStick>& all, std::vector<MemberStick>& merged) {
  auto pair = pairs.begin();
  const auto own = [&](const MemberStick& stick) {
    const auto is_before = [&](const MemberPair& one) { return one.elements < stick.elements; };
    if (pair != pairs.end() && is_before(*pair)) ++pair;  // mostly the next one has it, or none for long
    if (pair != pairs.end() && is_before(*pair)) pair = std::partition_point(pair, pairs.end(), is_before);
    return pair != pairs.end() && pair->elements == stick.elements;
  };
  std::erase_if(all, own);
  pair = pairs.begin();
  ranges::copy_if(sticks, std::back_inserter(all), own);
  sort(all, merged);
}

}  // namespace

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
  replace(pairs, new_, keeps_ ? own_ : state.member_sticks, merged_);
}

void MemberSticks::store(std::span<const int> which, std::span<const MemberPair> pairs, State& state) {
  new_.clear();
  for (const int p : which)
    for (int place = 0; place < static_cast<int>(pairs[p].stick.size()); ++place)
      if (const Vec3& stick = pairs[p].stick[place]; !stick.isZero(0))
        new_.push_back({pairs[p].elements, place, stick});
  replace(pairs, new_, keeps_ ? own_ : state.member_sticks, merged_);
}

void MemberSticks::take(const State& state) {
  own_ = state.member_sticks;
  keeps_ = true;
}

void MemberSticks::give(std::span<const MemberPair> pairs, State& state) {
  keeps_ = false;
  replace(pairs, own_, state.member_sticks, merged_);
}

}  // namespace topple
