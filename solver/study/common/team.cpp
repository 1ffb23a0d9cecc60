#include "solver/study/common/team.h"

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace topple::study {
namespace {

using Work = std::function<void(int task, int worker)>;
using Clock = std::chrono::steady_clock;

constexpr auto k_patience = std::chrono::microseconds(100);  // before sleep, whose end costs half as much
constexpr int k_turns = 32;                                  // between looks at the clock

// Until done() or k_patience is over; whether done.
template <class Done>
bool turn_until(Done done) {
  const auto end = Clock::now() + k_patience;
  do {
    for (int turn = 0; turn < k_turns; ++turn) {
      if (done()) return true;
      __builtin_ia32_pause();
    }
  } while (Clock::now() < end);
  return done();
}

}  // namespace

// A helper that comes too late for a round is not waited for: it announces itself in `inside` before it looks
// whether the round is open, and the caller closes the round before it looks whether somebody is inside.
// Both in one order for all threads: what is open is not changed while somebody is in it.
struct Team::Shared {
  alignas(64) std::atomic<unsigned> round{0};  // counts calls
  std::atomic<bool> open{false}, over{false};
  const Work* work = nullptr;
  int count = 0;
  alignas(64) std::atomic<int> next{0};
  alignas(64) std::atomic<int> inside{0};
  std::vector<std::jthread> helpers;

  void take_tasks(int worker) {
    for (int task; (task = next.fetch_add(1, std::memory_order_relaxed)) < count;) (*work)(task, worker);
  }

  void help(int worker) {
    for (unsigned seen = 0;;) {
      if (!turn_until([&] { return round != seen; })) round.wait(seen);
      seen = round;
      if (over) return;
      ++inside;
      if (open) take_tasks(worker);
      if (--inside == 0) inside.notify_one();
    }
  }

  void run(int tasks, const Work& f) {
    work = &f;
    count = tasks;
    next = 0;
    open = true;
    ++round;
    round.notify_all();
    take_tasks(0);
    open = false;
    for (int left; (left = inside) > 0;)
      if (!turn_until([&] { return inside == 0; })) inside.wait(left);
  }
};

Team::Team(int workers) : shared_(std::make_unique<Shared>()) {
  for (int worker = 1; worker < workers; ++worker)
    shared_->helpers.emplace_back([shared = shared_.get(), worker] { shared->help(worker); });
}

Team::~Team() {
  shared_->over = true;
  ++shared_->round;
  shared_->round.notify_all();
}

ParallelFor Team::share() {
  return {.workers = static_cast<int>(shared_->helpers.size()) + 1,
          .run = [shared = shared_.get()](int count, const Work& f) { shared->run(count, f); }};
}

}  // namespace topple::study
