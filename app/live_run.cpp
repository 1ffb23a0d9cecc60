#include "app/live_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>
#include <variant>

#include <nlohmann/json.hpp>

#include "app/live_recorder.h"
#include "app/summary.h"
#include "solver/io/rerun.h"

namespace topple::app {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::chrono::milliseconds k_report_interval{8};  // a picture lasts longer
constexpr std::chrono::milliseconds k_follow_interval{200};
constexpr std::chrono::milliseconds k_patience{300};  // with a step under way when the run is closed
constexpr double k_most_lag = 0.1;     // s that a run which cannot keep its pace tries to make up
constexpr double k_rate_window = 0.5;  // s
constexpr std::size_t k_rows_at_once = 256;
constexpr std::int64_t k_return_steps = 50;  // between two looks at the stop flag

struct Go {
  double speed;
};
struct Halt {};
struct OneStep {};
struct Fork {
  std::int32_t branch;
  std::int64_t step;
  std::vector<Edit> edits;
};
using Command = std::variant<Go, Halt, OneStep, Edit, Fork>;

/// A run at a checkpoint of a branch.
struct Point {
  std::int32_t branch;
  RunPoint run;
};

}  // namespace

class LiveRun::Worker {
 public:
  Worker(LiveSource source, std::function<void()> wake, Advance advance)
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
  void start(std::shared_ptr<Worker> self) {
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
  void start_recording();
  void obey(const Command& command);
  void change(const Edit& edit);
  void fork(const Fork& from);
  void carry_on_recording();
  void fail(const StepStatus& status);
  Run run_before(std::int32_t branch, std::int64_t step) const;
  void step_once();
  void run_some();
  void record(io::Observation observation);
  template <typename Add>
  void tell(Add add);
  void report_head();
  void set(LiveStatus::Kind kind);
  void finish();
  bool can_step() const { return run_ && !run_->over(); }
  void pace() {
    pace_wall_ = Clock::now();
    pace_time_ = run_->state().time;
  }

  LiveSource source_;
  const Setup& setup_;
  const std::function<void()> wake_;
  const Advance advance_;

  // Shared; the lock is never held while anything is computed or written.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Command> commands_;
  LiveReport report_;
  std::string end_status_;
  std::shared_ptr<LiveRecorder> recorder_;
  std::atomic<bool> pending_ = false, stop_ = false;
  std::promise<void> closed_;

  // Of the thread.
  LiveStatus status_;
  std::optional<Run> run_;
  io::Observer observer_;
  History history_;
  std::vector<Point> points_;
  std::vector<RowPtr> read_rows_;  // of the recording that is replayed
  std::vector<io::Checkpoint> read_checkpoints_;
  std::size_t read_events_ = 0, read_edits_ = 0, read_branches_ = 0;
  bool going_ = false;
  double speed_ = 1;
  Clock::time_point pace_wall_, rate_wall_;
  double pace_time_ = 0, rate_time_ = 0;
  double wall_ = 0;  // s, spent in steps
  std::thread thread_;
};

void LiveRun::Worker::work() {
  try {
    begin();
    obey_and_run();
    finish();
  } catch (const std::exception& error) {
    going_ = false;
    status_.message = error.what();
    set(LiveStatus::Kind::ended);
    wait_for_stop();
    if (recorder_) recorder_->finish(end_status_, "");
  }
  closed_.set_value();
}

void LiveRun::Worker::wait_for_stop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_.load(); });
}

void LiveRun::Worker::obey_and_run() {
  while (!stop_) {
    std::vector<Command> commands;
    {
      std::unique_lock lock(mutex_);
      const auto called = [this] { return pending_ || stop_; };
      if (status_.kind == LiveStatus::Kind::replay)
        changed_.wait_for(lock, k_follow_interval, called);
      else if (!going_)
        changed_.wait(lock, called);
      commands.swap(commands_);
      pending_ = false;
    }
    for (const Command& command : commands)
      if (!stop_) obey(command);
    if (stop_) break;
    if (status_.kind == LiveStatus::Kind::replay) follow();
    if (going_) run_some();
  }
}

void LiveRun::Worker::begin() {
  if (source_.recording) {
    status_.kind = LiveStatus::Kind::reading;
    read_recording();
    set(LiveStatus::Kind::replay);
    return;
  }
  history_.branches.push_back({});
  tell([](LiveReport& report) { report.branches.push_back({}); });
  run_.emplace(setup_);
  if (!run_->status().ok()) {
    fail(run_->status());
    run_.reset();
    set(status_.kind);
    return;
  }
  if (stop_) return;
  start_recording();
  record(observer_.observe(*run_));
  report_head();
  set(LiveStatus::Kind::halted);
}

void LiveRun::Worker::read_recording() {
  const io::Recording& from = *source_.recording;
  io::check_edits(from.history(), setup_);
  history_ = from.history();
  status_.branch = from.newest_branch();
  tell([this](LiveReport& report) {
    for (; read_branches_ < history_.branches.size(); ++read_branches_)
      report.branches.push_back(history_.branches[read_branches_]);
    for (; read_edits_ < history_.edits.size(); ++read_edits_)
      report.edits.push_back(history_.edits[read_edits_]);
  });
  read_rows();
  try {
    while (static_cast<std::int64_t>(read_checkpoints_.size()) < from.checkpoint_count() && !stop_)
      read_checkpoints_.push_back(from.checkpoint(static_cast<std::int64_t>(read_checkpoints_.size())));
  } catch (const io::InputError&) {  // a fork then goes back farther
  }
  const std::vector<io::RecordedEvent> events = from.events();
  tell([&](LiveReport& report) {
    for (; read_events_ < events.size(); ++read_events_) report.events.push_back(events[read_events_]);
  });
}

void LiveRun::Worker::read_rows() {
  const io::Recording& from = *source_.recording;
  std::vector<RowPtr> rows;
  const auto tell_rows = [&] {
    tell([&rows](LiveReport& report) {
      report.rows.insert(report.rows.end(), rows.begin(), rows.end());
      rows.clear();
    });
    if (!stop_) wake_();
  };
  try {
    while (static_cast<std::int64_t>(read_rows_.size()) < from.frame_count() && !stop_) {
      read_rows_.push_back(
          std::make_shared<const io::FrameRow>(from.frame(static_cast<std::int64_t>(read_rows_.size()))));
      rows.push_back(read_rows_.back());
      if (rows.size() == k_rows_at_once) tell_rows();
    }
  } catch (const io::InputError& error) {  // what came before the damage can be seen
    status_.message = error.what();
  }
  tell_rows();
}

void LiveRun::Worker::follow() {
  try {
    if (!status_.message.empty() || !source_.recording->refresh()) return;
    read_recording();
  } catch (const io::InputError& error) {
    status_.message = error.what();
  }
  set(LiveStatus::Kind::replay);
}

void LiveRun::Worker::start_recording() {
  if (source_.output.empty()) return;
  try {
    auto recorder = std::make_shared<LiveRecorder>(source_.output, *source_.scene);
    const std::lock_guard lock(mutex_);
    recorder_ = std::move(recorder);
    status_.recording = source_.output;
  } catch (const io::WriteError& error) {
    status_.record_failure = error.what();
  }
}

void LiveRun::Worker::obey(const Command& command) {
  if (const auto* go = std::get_if<Go>(&command)) {
    speed_ = go->speed;
    if (!can_step()) return;
    going_ = true;
    pace();
    rate_wall_ = pace_wall_;
    rate_time_ = pace_time_;
    set(LiveStatus::Kind::going);
  } else if (std::holds_alternative<Halt>(command)) {
    if (!going_) return;
    going_ = false;
    report_head();
    set(LiveStatus::Kind::halted);
  } else if (std::holds_alternative<OneStep>(command)) {
    if (going_ || !can_step()) return;
    step_once();
    report_head();
  } else if (const auto* edit = std::get_if<Edit>(&command)) {
    if (run_) change(*edit);
  } else if (const auto* where = std::get_if<Fork>(&command)) {
    fork(*where);
    ++status_.forks;
    set(status_.kind);
  }
}

void LiveRun::Worker::change(const Edit& edit) {
  status_.message.clear();
  status_.element = -1;
  const LoggedEdit logged{status_.branch, run_->state().step, run_->state().time, edit};
  run_->edit(edit);
  history_.edits.push_back(logged);
  if (recorder_) recorder_->post(logged);
  tell([&logged](LiveReport& report) { report.edits.push_back(logged); });
  set(status_.kind == LiveStatus::Kind::failed ? LiveStatus::Kind::halted : status_.kind);
}

// From the nearest point that is kept.
Run LiveRun::Worker::run_before(std::int32_t branch, std::int64_t step) const {
  const std::vector<Stretch> way = history_.way_to(branch);
  const auto on_way = [&](std::int32_t id, std::int64_t at) {
    return at <= step && std::any_of(way.begin(), way.end(),
                                     [&](const Stretch& s) { return s.branch == id && at <= s.last_step; });
  };
  const Point* nearest = nullptr;
  for (const Point& point : points_)
    if (on_way(point.branch, point.run.state.step) &&
        (!nearest || point.run.state.step >= nearest->run.state.step))
      nearest = &point;
  const io::Checkpoint* read = nullptr;
  for (const io::Checkpoint& checkpoint : read_checkpoints_)
    if (on_way(checkpoint.branch, checkpoint.step) && (!read || checkpoint.step >= read->step))
      read = &checkpoint;
  if (nearest && (!read || nearest->run.state.step >= read->step)) {
    RunPoint point = nearest->run;
    point.parameters = parameters_at(setup_, history_, branch, point.state.step);
    return Run(setup_, std::move(point));
  }
  if (!read) return Run(setup_);
  return Run(setup_, unpack(setup_.model, read->state), parameters_at(setup_, history_, branch, read->step));
}

void LiveRun::Worker::fork(const Fork& from) {
  const bool replayed = source_.recording.has_value();
  if (run_) record(observer_.last(*run_));
  going_ = false;
  set(LiveStatus::Kind::returning);
  Run run = run_before(from.branch, from.step);
  bool reached = run.status().ok();
  while (reached && run.state().step < from.step && !stop_)
    reached = repeat(run, history_, from.branch, std::min(from.step, run.state().step + k_return_steps));
  if (stop_) return;
  if (!reached) {
    fail(run.status());
    set(replayed ? LiveStatus::Kind::replay : status_.kind);
    return;
  }
  if (replayed) carry_on_recording();
  Branch branch{.id = 0, .parent = from.branch, .fork_step = from.step};
  for (const Branch& other : history_.branches) branch.id = std::max(branch.id, other.id + 1);
  history_.branches.push_back(branch);
  status_.branch = branch.id;
  status_.message.clear();
  if (recorder_) recorder_->post(branch);
  tell([&branch](LiveReport& report) {
    report.branches.push_back(branch);
    report.head = nullptr;
  });
  run_.emplace(std::move(run));
  observer_ = io::Observer(branch.id);
  for (const Edit& edit : from.edits) change(edit);
  record(observer_.observe(*run_));
  report_head();
  set(run_->over() ? LiveStatus::Kind::over : LiveStatus::Kind::halted);
}

// The new file holds all of the one that was replayed, and goes on from there.
void LiveRun::Worker::carry_on_recording() {
  const std::vector<io::RecordedEvent> events = source_.recording->events();
  source_.recording.reset();
  start_recording();
  if (recorder_) {
    for (const Branch& branch : history_.branches)
      if (branch.parent >= 0) recorder_->post(branch);
    for (const LoggedEdit& edit : history_.edits) recorder_->post(edit);
    for (const io::Checkpoint& checkpoint : read_checkpoints_)
      recorder_->post(io::Observation{.frame = {}, .checkpoint = checkpoint, .events = {}});
    for (const RowPtr& row : read_rows_)
      recorder_->post(io::Observation{.frame = *row, .checkpoint = {}, .events = {}});
    recorder_->post(io::Observation{.frame = {}, .checkpoint = {}, .events = events});
  }
  read_rows_.clear();
}

void LiveRun::Worker::fail(const StepStatus& status) {
  going_ = false;
  status_.message = status.message(setup_.model);
  status_.element = status.element;
  status_.kind = LiveStatus::Kind::failed;
}

// What became of it is told with the next report of the head, not before.
void LiveRun::Worker::step_once() {
  const Clock::time_point start = Clock::now();
  const StepStatus status = advance_(*run_);
  wall_ += Seconds(Clock::now() - start).count();
  if (!status.ok()) {
    fail(status);
    return;
  }
  record(observer_.observe(*run_));
  if (!run_->over()) return;
  record(observer_.last(*run_));
  going_ = false;
  status_.kind = LiveStatus::Kind::over;
}

// Steps until the next report is due, or the run is ahead of its pace.
void LiveRun::Worker::run_some() {
  const auto due = [this] {
    return pace_wall_ +
           std::chrono::duration_cast<Clock::duration>(Seconds((run_->state().time - pace_time_) / speed_));
  };
  const Clock::time_point report_at = Clock::now() + k_report_interval;
  for (Clock::time_point at = Clock::now(); going_ && !pending_ && !stop_ && at < report_at && due() <= at;
       at = Clock::now())
    step_once();
  const Clock::time_point now = Clock::now();
  if (Seconds(now - due()).count() > k_most_lag) pace();
  if (const double window = Seconds(now - rate_wall_).count(); window > k_rate_window) {
    status_.achieved = (run_->state().time - rate_time_) / window;
    rate_wall_ = now;
    rate_time_ = run_->state().time;
  }
  report_head();
  if (!going_) return;
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, due(), [this] { return pending_ || stop_; });
}

void LiveRun::Worker::record(io::Observation observation) {
  if (observation.checkpoint) points_.push_back({status_.branch, run_->point()});
  tell([&observation](LiveReport& report) {
    if (observation.frame) report.rows.push_back(std::make_shared<const io::FrameRow>(*observation.frame));
    report.events.insert(report.events.end(), observation.events.begin(), observation.events.end());
  });
  if (recorder_ && (observation.frame || observation.checkpoint || !observation.events.empty()))
    recorder_->post(std::move(observation));
}

void LiveRun::Worker::report_head() {
  io::FrameRow row = io::frame_row(*run_);
  row.branch = status_.branch;
  auto head = std::make_shared<const io::FrameRow>(std::move(row));
  tell([&head](LiveReport& report) { report.head = std::move(head); });
  set(status_.kind);
}

void LiveRun::Worker::set(LiveStatus::Kind kind) {
  status_.kind = kind;
  if (recorder_) status_.record_failure = recorder_->failure();
  tell([](LiveReport&) {});
  if (!stop_) wake_();
}

// What happened and how it stands with the run become known together.
template <typename Add>
void LiveRun::Worker::tell(Add add) {
  const std::lock_guard lock(mutex_);
  add(report_);
  report_.status = status_;
}

void LiveRun::Worker::finish() {
  if (!recorder_ || !run_) return;
  record(observer_.last(*run_));
  const std::string status = !run_->status().ok()    ? "diverged"
                             : run_->stopped_early() ? "stopped"
                             : run_->over()          ? "completed"
                                                     : end_status_;
  recorder_->finish(status, json_text(summary(*source_.scene, *run_, status, wall_)));
  status_.record_failure = recorder_->failure();
  tell([](LiveReport&) {});
}

LiveRun::LiveRun(LiveSource source, std::function<void()> wake, Advance advance)
    : worker_(std::make_shared<Worker>(std::move(source), std::move(wake), std::move(advance))) {
  worker_->start(worker_);
}
LiveRun::~LiveRun() {
  close("interrupted");
}
void LiveRun::go(double speed) {
  worker_->post(Go{speed});
}
void LiveRun::halt() {
  worker_->post(Halt{});
}
void LiveRun::one_step() {
  worker_->post(OneStep{});
}
void LiveRun::edit(const Edit& edit) {
  worker_->post(edit);
}
void LiveRun::fork(std::int32_t branch, std::int64_t step, std::vector<Edit> edits) {
  worker_->post(Fork{branch, step, std::move(edits)});
}
LiveReport LiveRun::take() {
  return worker_->take();
}
LiveStatus LiveRun::close(const std::string& status) {
  if (!worker_) return {};
  const LiveStatus last = worker_->close(status);
  worker_.reset();
  return last;
}

}  // namespace topple::app
