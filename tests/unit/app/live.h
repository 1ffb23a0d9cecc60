// A live run for tests, and patience with it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "app/live/live_run.h"
#include "app/live/player.h"
#include "scenes.h"

namespace topple::app {

/// A cabinet that rocks under a sine for a second, and does not fall.
inline const std::string k_rocking = R"(topple = 1
title = "A rocking cabinet for tests"
[run]
duration = "1 s"
[[shake]]
name = "table"
frequency = "2 Hz"
amplitude = "300 gal"
[contact]
alpha = "500 kgf"
[floor]
width = "90 mm"
)" + k_library + k_cabinet;

/// Two points on a wall behind the cabinet of k_rocking. Appended to it.
inline const std::string k_brackets = R"(
[[wall]]
name = "behind"
at = [-0.22, 0]
normal = [1, 0, 0]
[[fixing]]
name = "held"
kind = "L-bracket"
body = "free"
to = "behind"
)";

inline std::shared_ptr<const io::Scene> live_scene(const std::string& text = k_rocking,
                                                   const std::vector<std::string>& overrides = {}) {
  return std::make_shared<const io::Scene>(io::parse_scene(text, "live.toml", overrides));
}

/// Calls `work` until `done`; fails after 30 s, long beyond what any of these runs needs.
template <typename Work, typename Done>
::testing::AssertionResult eventually(Work work, Done done) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < give_up) {
    work();
    if (done()) return ::testing::AssertionSuccess();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return ::testing::AssertionFailure() << "it did not happen in 30 s";
}

/// Lets one step wait until it is released.
class Gate {
 public:
  ~Gate() { open(); }

  /// The run may outlive the gate.
  LiveRun::Advance advance() const {
    return [state = state_](Run& run) {
      std::unique_lock lock(state->mutex);
      if (state->closed) {
        state->waiting = true;
        state->changed.notify_all();
        state->changed.wait(lock, [&] { return !state->closed; });
        state->waiting = false;
      }
      lock.unlock();
      return run.advance();
    };
  }
  void shut() { set(true); }
  void open() { set(false); }
  bool held() const {
    const std::lock_guard lock(state_->mutex);
    return state_->waiting;
  }

 private:
  struct State {
    std::mutex mutex;
    std::condition_variable changed;
    bool closed = false, waiting = false;
  };
  void set(bool closed) {
    {
      const std::lock_guard lock(state_->mutex);
      state_->closed = closed;
    }
    state_->changed.notify_all();
  }
  const std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace topple::app
