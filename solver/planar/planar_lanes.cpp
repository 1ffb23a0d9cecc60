#include "solver/planar/planar_lanes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace topple::planar {
namespace {

constexpr int k_lanes_of_pack = k_lanes<Four>;
constexpr std::size_t k_on_their_way = 16;  // enough that four are in the same mode
constexpr std::size_t k_mode_count = 5;

struct Moving {
  int index;
  std::unique_ptr<PlanarRun> run;
};

/// Runs on their way, by the mode of the step that they are about to take.
class Lanes {
 public:
  Lanes(int count, const std::function<std::unique_ptr<PlanarRun>(int)>& make,
        const std::function<void(int, const PlanarRun&)>& ended)
      : count_(count), make_(make), ended_(ended) {
    while (next_ < count_ && waiting() < k_on_their_way) begin_next();
  }

  bool over() const { return waiting() == 0; }

  /// A step of those in the most frequent mode.
  void step() {
    std::vector<Moving>& from = *std::ranges::max_element(by_mode_, {}, &std::vector<Moving>::size);
    const std::size_t n = std::min<std::size_t>(from.size(), k_lanes_of_pack);
    std::array<Moving, k_lanes_of_pack> taken;
    std::ranges::move(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(n), taken.begin());
    from.erase(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(n));
    use_.busy += static_cast<long>(n), use_.lanes += k_lanes_of_pack;
    std::array<Leg*, k_lanes_of_pack> legs;
    for (std::size_t k = 0; k < legs.size(); ++k) legs[k] = &taken[k < n ? k : 0].run->leg();
    std::array<State, k_lanes_of_pack> after;
    const auto events = finish<Four>(legs, static_cast<int>(n), step_, after);
    for (std::size_t k = 0; k < n; ++k) {
      taken[k].run->end(step_, static_cast<int>(k), after[k], events[k]);
      go_on(std::move(taken[k]));
    }
  }

  const LaneUse& use() const { return use_; }

 private:
  std::size_t waiting() const {
    std::size_t sum = 0;
    for (const std::vector<Moving>& of : by_mode_) sum += of.size();
    return sum;
  }

  /// Begins a step of this run, or of the next where it is over.
  void go_on(Moving moving) {
    while (!moving.run->over())
      if (moving.run->begin()) {
        by_mode_[static_cast<std::size_t>(moving.run->leg().start.mode)].push_back(std::move(moving));
        return;
      }
    ended_(moving.index, *moving.run);
    begin_next();
  }
  void begin_next() {
    while (next_ < count_) {
      const int index = next_++;
      if (std::unique_ptr<PlanarRun> run = make_(index)) return go_on({index, std::move(run)});
    }
  }

  int count_, next_ = 0;
  const std::function<std::unique_ptr<PlanarRun>(int)>& make_;
  const std::function<void(int, const PlanarRun&)>& ended_;
  std::array<std::vector<Moving>, k_mode_count> by_mode_;
  PackStep<Four> step_;
  LaneUse use_;
};

}  // namespace

LaneUse run_in_lanes(int count, const std::function<std::unique_ptr<PlanarRun>(int)>& make,
                     const std::function<void(int, const PlanarRun&)>& ended,
                     const std::function<bool()>& give_up) {
  Lanes lanes(count, make, ended);
  while (!lanes.over()) {
    lanes.step();
    if (give_up()) break;
  }
  return lanes.use();
}

}  // namespace topple::planar
