// A live run for tests, and patience with it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
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
  LiveRun::Advance advance() {
    return [this](Run& run) {
      std::unique_lock lock(mutex_);
      if (closed_) {
        waiting_ = true;
        changed_.notify_all();
        changed_.wait(lock, [this] { return !closed_; });
        waiting_ = false;
      }
      lock.unlock();
      return run.advance();
    };
  }
  void shut() { set(true); }
  void open() { set(false); }
  bool held() {
    const std::lock_guard lock(mutex_);
    return waiting_;
  }

 private:
  void set(bool closed) {
    {
      const std::lock_guard lock(mutex_);
      closed_ = closed;
    }
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool closed_ = false, waiting_ = false;
};

}  // namespace topple::app
