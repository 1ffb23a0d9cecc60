#include "solver/planar/planar_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "solver/math/ranges.h"

namespace topple::planar {
namespace {

#ifdef __AVX2__
constexpr bool k_has_lanes = true;
#else
constexpr bool k_has_lanes = false;  // a Four takes more instructions than its four numbers one by one
#endif

constexpr std::size_t k_on_their_way = 24;  // enough that four are in the same mode
constexpr std::size_t k_modes = 5;

struct Moving {
  int index;
  std::unique_ptr<PlanarRun> run;
};

/// Of a mode, by how long the next step may be: short ones have fewer terms, and a pack computes as many as
/// its lanes need at most.
struct Queues {
  std::array<std::vector<Moving>, 3> of;

  std::size_t size() const { return of[0].size() + of[1].size() + of[2].size(); }
  void push(Moving moving) {
    constexpr double k_short = 0.02, k_medium = 0.2;  // s
    constexpr double k_per_rate = 3;  // s/(rad/s): about how long a cabinet stays up after an impact
    const Leg& leg = moving.run->leg();
    const bool lands_again = leg.start.tilt == 0 && leg.start.rate != 0;
    const double held = leg.end - leg.start.time,
                 span = lands_again ? std::min(held, k_per_rate * std::abs(leg.start.rate)) : held;
    of[span < k_short ? 2 : span < k_medium ? 1 : 0].push_back(std::move(moving));
  }
  /// As many as there is room for, the longest queue and in it the first come first; returns how many.
  std::size_t take(std::span<Moving> to) {
    std::size_t n = 0;
    while (n < to.size() && size() > 0) {
      std::vector<Moving>& from =
          *ranges::max_element(of, {}, [](const std::vector<Moving>& queue) { return queue.size(); });
      const std::size_t here = std::min(from.size(), to.size() - n);
      const auto last = from.begin() + static_cast<std::ptrdiff_t>(here);
      std::move(from.begin(), last, to.begin() + static_cast<std::ptrdiff_t>(n));
      from.erase(from.begin(), last);
      n += here;
    }
    return n;
  }
};

/// Runs on their way, by the mode of the step that they are about to take.
class Lanes {
 public:
  Lanes(int count, const MakeRun& make, const RunEnded& ended) : count_(count), make_(make), ended_(ended) {
    for (std::size_t i = 0; i < k_on_their_way; ++i) begin_next();
  }

  bool over() const {
    return ranges::all_of(by_mode_, [](const Queues& of) { return of.size() == 0; });
  }

  /// A step of those in the most frequent mode.
  void step() {
    Queues& from = *ranges::max_element(by_mode_, {}, [](const Queues& of) { return of.size(); });
    std::array<Moving, k_lanes<Four>> taken;
    const std::size_t n = from.take(taken);
    use_.busy += static_cast<long>(n), use_.lanes += k_lanes<Four>;
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
        by_mode_[static_cast<std::size_t>(moving.run->leg().start.mode)].push(std::move(moving));
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
  std::array<Queues, k_modes> by_mode_;
  PackStep<Four> pack_;
  PackStep<double> one_;
  LaneUse use_;
};

LaneUse run_one_by_one(int count, const MakeRun& make, const RunEnded& ended,
                       const std::function<bool()>& give_up) {
  LaneUse use;
  for (int i = 0; i < count; ++i) {
    const std::unique_ptr<PlanarRun> run = make(i);
    if (!run) continue;
    while (!run->over()) {
      run->advance();
      ++use.busy, ++use.lanes;
      if (give_up()) return use;
    }
    ended(i, *run);
  }
  return use;
}

}  // namespace

LaneUse run_in_lanes(int count, const MakeRun& make, const RunEnded& ended,
                     const std::function<bool()>& give_up) {
  if (!k_has_lanes || count == 1) return run_one_by_one(count, make, ended, give_up);
  Lanes lanes(count, make, ended);
  while (!lanes.over()) {
    lanes.step();
    if (give_up()) break;
  }
  return lanes.use();
}

}  // namespace topple::planar
