#include "solver/planar/planar_lanes.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace topple::planar {
namespace {

#ifdef __AVX2__
using Pack = Four;
#else
using Pack = double;  // compilers make more instructions of a Four than of its four numbers one by one
#endif

constexpr std::size_t k_on_their_way = 16;  // enough that four are in the same mode
constexpr std::size_t k_mode_count = 5;

struct Moving {
  int index;
  std::unique_ptr<PlanarRun> run;
};

/// Runs on their way, by the mode of the step that they are about to take.
class Lanes {
 public:
  Lanes(int count, const MakeRun& make, const RunEnded& ended) : count_(count), make_(make), ended_(ended) {
    for (std::size_t i = 0; i < k_on_their_way; ++i) begin_next();
  }

  bool over() const {
    return std::ranges::all_of(by_mode_, [](const std::vector<Moving>& of) { return of.empty(); });
  }

  /// A step of those in the most frequent mode, the first come first.
  void step() {
    std::vector<Moving>& from =
        *std::ranges::max_element(by_mode_, {}, [](const std::vector<Moving>& of) { return of.size(); });
    std::array<Moving, k_lanes<Pack>> taken;
    const std::size_t n = std::min(from.size(), taken.size());
    const auto last = from.begin() + static_cast<std::ptrdiff_t>(n);
    std::move(from.begin(), last, taken.begin());
    from.erase(from.begin(), last);
    use_.busy += static_cast<long>(n), use_.lanes += k_lanes<Pack>;
    n == 1 ? step(std::span(taken).first(n), one_) : step(std::span(taken).first(n), pack_);
  }

  const LaneUse& use() const { return use_; }

 private:
  template <class P>
  void step(std::span<Moving> taken, PackStep<P>& step) {
    const PerLane<P, Leg*> legs = per_lane<P>([&](int k) {
      const auto lane = static_cast<std::size_t>(k);
      return &taken[lane < taken.size() ? lane : 0].run->leg();
    });
    PerLane<P, State> after;
    const auto events = finish<P>(legs, static_cast<int>(taken.size()), step, after);
    for (int k = 0; k < static_cast<int>(taken.size()); ++k) {
      Moving& moving = taken[static_cast<std::size_t>(k)];
      moving.run->end(step, k, of_lane(after, k), of_lane(events, k));
      go_on(std::move(moving));
    }
  }

  /// Begins the next step of this run or, where it is over, the next run.
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
  const MakeRun& make_;
  const RunEnded& ended_;
  std::array<std::vector<Moving>, k_mode_count> by_mode_;
  PackStep<Pack> pack_;
  PackStep<double> one_;
  LaneUse use_;
};

}  // namespace

LaneUse run_in_lanes(int count, const MakeRun& make, const RunEnded& ended,
                     const std::function<bool()>& give_up) {
  Lanes lanes(count, make, ended);
  while (!lanes.over()) {
    lanes.step();
    if (give_up()) break;
  }
  return lanes.use();
}

}  // namespace topple::planar
