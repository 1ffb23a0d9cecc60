// The thread of a live run.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "app/live/live_recorder.h"
#include "app/live/live_report.h"

namespace topple::app {

struct Go {
  double speed;
};
struct Halt {};
struct OneStep {};
struct Edits {
  std::vector<Edit> all;
};
struct Fork {
  std::int32_t branch;
  std::int64_t step;
  std::vector<Edit> edits;
};
using Command = std::variant<Go, Halt, OneStep, Edits, Fork>;

/// A run at a checkpoint of a branch.
struct Point {
  std::int32_t branch;
  RunPoint run;
};

inline constexpr std::chrono::milliseconds k_patience{300};  // of close() with a step under way

class LiveWorker {
 public:
  LiveWorker(LiveSource source, std::function<void()> wake, LiveAdvance advance)
      : source_(std::move(source)),
        setup_(source_.scene->setup),
        wake_(std::move(wake)),
        advance_(std::move(advance)) {}

  void post(Command command) {
    {
      const std::lock_guard lock(mutex_);
      // Steps asked for faster than they can be made do not pile up.
      const bool step = std::holds_alternative<OneStep>(command);
      if (step && !commands_.empty() && std::holds_alternative<OneStep>(commands_.back())) return;
      // Nor do edits, of which each makes a run that has not moved start anew.
      auto* const edits = std::get_if<Edits>(&command);
      auto* const before = commands_.empty() ? nullptr : std::get_if<Edits>(&commands_.back());
      if (edits && before)
        before->all.insert(before->all.end(), edits->all.begin(), edits->all.end());
      else
        commands_.push_back(std::move(command));
      pending_ = true;
    }
    changed_.notify_one();
  }
  LiveReport take() {
    const std::lock_guard lock(mutex_);
    LiveReport report;
    std::swap(report, report_);
    report_.status = report.status;
    return report;
  }
  void start(std::shared_ptr<LiveWorker> self) {
    thread_ = std::thread([self = std::move(self)] { self->work(); });
  }
  LiveStatus close(const std::string& status) {
    {
      const std::lock_guard lock(mutex_);
      end_status_ = status;
      stop_ = true;
    }
    changed_.notify_one();
    if (closed_.get_future().wait_for(k_patience) == std::future_status::ready) {
      thread_.join();
      return report_.status;
    }
    std::shared_ptr<LiveRecorder> recorder;
    LiveStatus last;
    {
      const std::lock_guard lock(mutex_);
      recorder = recorder_;
      last = report_.status;
    }
    thread_.detach();
    if (!recorder) return last;
    recorder->finish(status, "");
    last.record_failure = recorder->failure();
    return last;
  }

 private:
  void work();
  void begin();
  void obey_and_run();
  void wait_for_stop();
  void read_recording();
  void read_rows();
  void follow();
  void start_recording(const std::string& arithmetic);
  void obey(const Command& command);
  void change(const std::vector<Edit>& edits);
  void fork(const Fork& from);
  void carry_on_recording();
  void fail(const StepStatus& status);
  Run run_before(std::int32_t branch, std::int64_t step) const;
  void step_once();
  void run_some();
  void record(io::Observation observation);
  void begin_branch();
  void show_unsettled();
  void record_start();
  template <typename Add>
  void publish(Add add);
  void report_head();
  void set(LiveStatus::Kind kind);
  void finish();
  bool can_step() const { return run_ && !run_->over(); }
  void pace() {
    pace_wall_ = std::chrono::steady_clock::now();
    pace_time_ = run_->state().time;
  }

  LiveSource source_;
  const Setup& setup_;
  const std::function<void()> wake_;
  const LiveAdvance advance_;

  // Shared; the lock is never held while anything is computed or written.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Command> commands_;
  LiveReport report_;
  std::string end_status_;
  std::shared_ptr<LiveRecorder> recorder_;
  std::atomic<bool> pending_ = false, stop_ = false;
  std::promise<void> closed_;

  // Used by the thread alone.
  LiveStatus status_;
  std::optional<Run> run_;
  io::Observer observer_;
  std::optional<io::Observation> start_;  // of a run that has not moved: not recorded yet
  History history_;
  std::vector<Point> points_;
  std::int64_t read_rows_ = 0;  // of the recording that is replayed
  bool repeats_ = false;        // from its start rather than from its checkpoints
  std::vector<io::Checkpoint> read_checkpoints_;
  std::size_t read_events_ = 0, read_edits_ = 0, read_branches_ = 0;
  bool going_ = false;
  double speed_ = 1;
  std::chrono::steady_clock::time_point pace_wall_, rate_wall_;
  double pace_time_ = 0, rate_time_ = 0;
  double wall_ = 0;  // s, spent in steps
  std::thread thread_;
};

// Under one lock, so that news and status of a report belong together.
template <typename Add>
void LiveWorker::publish(Add add) {
  const std::lock_guard lock(mutex_);
  add(report_);
  report_.status = status_;
}

}  // namespace topple::app
