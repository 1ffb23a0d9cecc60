// Work beside the window, on a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace topple::app {

/// Work that shows what it has so far. Destroying it stops it.
template <class Result>
class Background {
 public:
  /// `work` asks stopped() often and throws nothing.
  explicit Background(std::function<void(Background&)> work)
      : thread_([this, work = std::move(work)] {
          work(*this);
          over_ = true;
        }) {}
  ~Background() {
    stop();
    thread_.join();
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  // For the window.
  void stop() { stopped_ = true; }
  bool over() const { return over_; }
  double progress() const { return progress_; }  ///< 0..1
  /// The newest that was shown; null: nothing was.
  std::shared_ptr<const Result> result() const {
    const std::lock_guard lock(mutex_);
    return result_;
  }

  // For the work.
  bool stopped() const { return stopped_; }
  void report_progress(double progress) { progress_ = progress; }
  void show(Result result) {
    auto shown = std::make_shared<const Result>(std::move(result));
    const std::lock_guard lock(mutex_);
    result_ = std::move(shown);
  }

 private:
  std::atomic<double> progress_ = 0;
  std::atomic<bool> stopped_ = false, over_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const Result> result_;
  std::thread thread_;  // begins when the others are there
};

}  // namespace topple::app
