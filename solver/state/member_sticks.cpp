#include "solver/state/member_sticks.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "solver/math/ranges.h"

namespace topple {
namespace {

// Those of `pairs` become those in `sticks`.
void replace(std::span<const MemberPair> pairs, const std::vector<MemberStick>& sticks,
             std::vector<MemberStick>& all) {
  const auto own = [&](const MemberStick& stick) {
    return ranges::binary_search(pairs, stick.elements, {}, &MemberPair::elements);
  };
  std::erase_if(all, own);
  ranges::copy_if(sticks, std::back_inserter(all), own);
  ranges::sort(all, {}, [](const MemberStick& stick) { return std::tie(stick.elements, stick.place); });
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
  replace(pairs, new_, keeps_ ? own_ : state.member_sticks);
}

void MemberSticks::take(const State& state) {
  own_ = state.member_sticks;
  keeps_ = true;
}

void MemberSticks::give(std::span<const MemberPair> pairs, State& state) {
  keeps_ = false;
  replace(pairs, own_, state.member_sticks);
}

}  // namespace topple
