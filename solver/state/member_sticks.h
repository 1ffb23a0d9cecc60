// Stick springs between members from step to step, for those who advance some candidate pairs of a model.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/contact/member_contact.h"
#include "solver/state/state.h"

namespace topple {

/// Those of some candidate pairs: in State::member_sticks or, from take_sticks to give_sticks, here, so that
/// parts can advance in parallel although State has one list for all.
class MemberSticks {
 public:
  /// Fills MemberPair::stick. `pairs` are in the order of their elements, as in every function here.
  void load(const State& state, std::span<MemberPair> pairs) const;
  /// Between take_sticks and give_sticks: what touches leaves its springs; the others become zero.
  void store(std::span<const MemberTouch> touches, std::span<const MemberPair> pairs);
  /// Those of MemberPair::stick of the pairs `which`, in order, at `places`, bits per pair of `pairs`; the
  /// others become zero.
  void store(std::span<const int> which, std::span<const std::uint8_t> places,
             std::span<const MemberPair> pairs);

 private:
  friend void take_sticks(const Model& model, std::span<MemberSticks* const> of_body, const State& state);
  friend void give_sticks(const Model& model, std::span<MemberSticks* const> of_body, State& state);

  void give(int end, std::vector<MemberStick>& all);

  std::vector<MemberStick> own_;
  std::size_t given_ = 0;  // of own_, the first
  bool keeps_ = false;
};

/// Each takes its own. `of_body`: per body of the model; null: its pairs are those of the bodies that touch
/// it.
void take_sticks(const Model& model, std::span<MemberSticks* const> of_body, const State& state);
/// And gives them back.
void give_sticks(const Model& model, std::span<MemberSticks* const> of_body, State& state);

}  // namespace topple
