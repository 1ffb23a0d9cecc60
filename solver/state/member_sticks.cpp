#include "solver/state/member_sticks.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "solver/contact/proximity.h"

namespace topple {
namespace {

bool in_order(const MemberStick& a, const MemberStick& b) {
  return std::tie(a.elements, a.place) < std::tie(b.elements, b.place);
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

void MemberSticks::store(std::span<const MemberTouch> touches, std::span<const MemberPair> pairs) {
  own_.clear();
  for (const MemberTouch& touch : touches)
    own_.push_back({pairs[touch.pair].elements, touch.place, touch.out.stick});
  std::sort(own_.begin(), own_.end(), in_order);
}

void MemberSticks::store(std::span<const int> which, std::span<const std::uint8_t> places,
                         std::span<const MemberPair> pairs) {
  own_.clear();
  for (const int p : which)
    for (unsigned left = places[p]; left != 0; left &= left - 1) {
      const int place = std::countr_zero(left);
      if (const Vec3& stick = pairs[p].stick[place]; !stick.isZero(0))
        own_.push_back({pairs[p].elements, place, stick});
    }
}

// The next ones, of elements before `end`.
void MemberSticks::give(int end, std::vector<MemberStick>& all) {
  const auto first = own_.begin() + static_cast<std::ptrdiff_t>(given_);
  const auto last =
      std::find_if(first, own_.end(), [&](const MemberStick& stick) { return stick.elements.a >= end; });
  all.insert(all.end(), first, last);
  given_ = static_cast<std::size_t>(last - own_.begin());
}

void take_sticks(const Model& model, std::span<MemberSticks* const> of_body, const State& state) {
  for (MemberSticks* const holder : of_body) {
    if (!holder) continue;
    holder->own_.clear();
    holder->keeps_ = true;
  }
  for (const MemberStick& stick : state.member_sticks)
    for (const int part : {stick.elements.a, stick.elements.b})
      if (MemberSticks* const holder = of_body[body_of(model, part)]) {
        holder->own_.push_back(stick);
        break;
      }
}

void give_sticks(const Model& model, std::span<MemberSticks* const> of_body, State& state) {
  for (MemberSticks* const holder : of_body) {
    if (!holder) continue;
    holder->given_ = 0;
    holder->keeps_ = false;
  }
  std::vector<MemberStick>& all = state.member_sticks;
  all.clear();
  for (std::size_t b = 0; b < of_body.size(); ++b) {
    const int end = model.bodies[b].first_element + model.bodies[b].element_count;
    if (of_body[b]) {
      of_body[b]->give(end, all);
      continue;
    }
    const auto first = static_cast<std::ptrdiff_t>(all.size());
    for (MemberSticks* const holder : of_body)
      if (holder) holder->give(end, all);
    std::sort(all.begin() + first, all.end(), in_order);
  }
}

}  // namespace topple
