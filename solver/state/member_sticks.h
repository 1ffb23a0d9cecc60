// Stick springs between members from step to step, for those who advance some candidate pairs of a model.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/contact/member_contact.h"
#include "solver/state/state.h"

namespace topple {

/// Those of some candidate pairs: in State::member_sticks or, while parts advance in parallel, in a copy, as
/// State has one list for all.
class MemberSticks {
 public:
  /// Fills MemberPair::stick. `pairs` are in the order of their elements, as in every function here.
  void load(const State& state, std::span<MemberPair> pairs) const;
  /// What touches leaves its springs; those of the other pairs in `pairs` become zero.
  void store(std::span<const MemberTouch> touches, std::span<const MemberPair> pairs, State& state);
  /// Those of MemberPair::stick of the pairs `which`, in order, at `places`, bits per pair of `pairs`; the
  /// others become zero.
  void store(std::span<const int> which, std::span<const std::uint8_t> places,
             std::span<const MemberPair> pairs, State& state);
  /// From take to give it works on a copy.
  void take(const State& state);
  void give(std::span<const MemberPair> pairs, State& state);

 private:
  void replace(std::span<const MemberPair> pairs, std::vector<MemberStick>& all);

  std::vector<MemberStick> own_, new_, merged_;
  bool keeps_ = false;
};

}  // namespace topple
