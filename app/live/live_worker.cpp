#include "app/live/live_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "app/batch/load_steps.h"
#include "app/batch/run_warnings.h"
#include "app/batch/scene_warnings.h"
#include "app/batch/summary.h"
#include "app/picture/thinning.h"
#include "app/support/clock.h"
#include "app/support/terms.h"

namespace topple::app {
namespace {

constexpr std::chrono::milliseconds k_report_interval{8};  // shorter than a picture of the window
constexpr std::chrono::milliseconds k_follow_interval{200};
constexpr double k_most_lag = 0.1;     // s that a run which cannot keep its pace tries to make up
constexpr double k_rate_window = 0.5;  // s

}  // namespace

void LiveWorker::work() {
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

void LiveWorker::wait_for_stop() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stop_.load(); });
}

void LiveWorker::obey_and_run() {
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

void LiveWorker::begin() {
  if (source_.recording) {
    status_.kind = LiveStatus::Kind::reading;
    read_recording();
    set(LiveStatus::Kind::replay);
    return;
  }
  history_.branches.push_back({});
  publish([](LiveReport& report) { report.branches.push_back({}); });
  run_.emplace(setup_);
  if (!run_->status().ok()) {
    fail(run_->status());
    run_.reset();
    show_unsettled();
    set(status_.kind);
    return;
  }
  if (stop_) return;
  start_recording(arithmetic());
  begin_branch();
  report_head();
  set(LiveStatus::Kind::halted);
}

void LiveWorker::obey(const Command& command) {
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
  } else if (const auto* edits = std::get_if<Edits>(&command)) {
    if (run_) change(edits->all);
  } else if (const auto* where = std::get_if<Fork>(&command)) {
    fork(*where);
    ++status_.forks;
    set(status_.kind);
  }
}

void LiveWorker::change(const std::vector<Edit>& edits) {
  status_.message.clear();
  status_.warnings.clear();
  status_.element = -1;
  if (status_.kind == LiveStatus::Kind::failed) status_.kind = LiveStatus::Kind::halted;
  run_->edit(edits);
  for (const Edit& edit : edits) {
    const LoggedEdit logged{status_.branch, run_->step(), run_->time(), edit};
    history_.edits.push_back(logged);
    if (recorder_) recorder_->post(logged);
    publish([&logged](LiveReport& report) { report.edits.push_back(logged); });
  }
  if (!run_->status().ok()) fail(run_->status());
  if (run_->step() == 0) begin_branch();
  if (!going_) report_head();  // an anchor that was taken away is seen to be
  set(status_.kind);
}

// What a run starts with is seen at once and recorded when it moves or is left: until then edits change it.
void LiveWorker::begin_branch() {
  observer_ = io::Observer(status_.branch);
  io::Observation start = observer_.observe(*run_);
  if (run_->step() > 0) return record(std::move(start));
  publish([&start](LiveReport& report) {
    for (const io::FrameRow& frame : start.frames)
      report.rows.push_back(std::make_shared<const io::FrameRow>(frame));
  });
  start_ = std::move(start);
}

// Of a run that finds no rest: its bodies as the scene has them.
void LiveWorker::show_unsettled() {
  Setup unsettled = setup_;
  unsettled.run.settle = false;
  if (Run run(unsettled); run.status().ok())
    for (const io::FrameRow& frame : io::Observer(status_.branch).observe(run).frames)
      publish([&frame](LiveReport& report) {
        report.rows.push_back(std::make_shared<const io::FrameRow>(frame));
      });
}

void LiveWorker::record_start() {
  if (start_) record(*std::exchange(start_, std::nullopt));
}

void LiveWorker::fail(const StepStatus& status) {
  going_ = false;
  status_.message = status.message(setup_.model);
  status_.element = status.element;
  status_.kind = LiveStatus::Kind::failed;
}

// Its status is published with the next report_head(), not before.
void LiveWorker::step_once() {
  record_start();
  const Clock::time_point start = Clock::now();
  const StepStatus status = advance_(*run_);
  wall_ += seconds_since(start);
  if (!status.ok()) {
    fail(status);
    if (!run_->load_steps().empty()) record(observer_.last(*run_));  // what converged of a load step
    return;
  }
  record(observer_.observe(*run_));
  if (!run_->over()) return;
  record(observer_.last(*run_));
  going_ = false;
  status_.kind = LiveStatus::Kind::over;
  status_.warnings = run_warnings(*run_);
  if (const std::optional<Said> soft = soft_contact(run_->setup(), run_->parameters()))
    status_.warnings.push_back(*soft);
}

// Steps until the next report is due, or the run is ahead of its pace.
void LiveWorker::run_some() {
  const auto due = [this] {
    return pace_wall_ +
           std::chrono::duration_cast<Clock::duration>(Seconds((run_->time() - pace_time_) / speed_));
  };
  const Clock::time_point report_at = Clock::now() + k_report_interval;
  for (Clock::time_point at = Clock::now(); going_ && !pending_ && !stop_ && at < report_at && due() <= at;
       at = Clock::now())
    step_once();
  const Clock::time_point now = Clock::now();
  if (Seconds(now - due()).count() > k_most_lag) pace();
  if (const double window = Seconds(now - rate_wall_).count(); window > k_rate_window) {
    status_.achieved = (run_->time() - rate_time_) / window;
    rate_wall_ = now;
    rate_time_ = run_->time();
  }
  report_head();
  if (!going_) return;
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, due(), [this] { return pending_ || stop_; });
}

void LiveWorker::record(io::Observation observation) {
  if (observation.checkpoint) {
    points_.push_back({status_.branch, run_->point()});
    if (points_.size() * observation.checkpoint->state.size() * sizeof(double) > k_most_point_bytes)
      thin_older_half(points_);
  }
  const std::span<const LoadStep> steps = run_->load_steps();
  const std::vector<Stability> told = stabilities(steps.last(std::min<std::size_t>(2, steps.size())));
  publish([&](LiveReport& report) {
    for (const io::FrameRow& frame : observation.frames)
      report.rows.push_back(std::make_shared<const io::FrameRow>(frame));
    report.events.insert(report.events.end(), observation.events.begin(), observation.events.end());
    if (!told.empty()) report.stabilities.push_back({status_.branch, run_->step(), told.back()});
  });
  if (recorder_ && !observation.empty()) recorder_->post(std::move(observation));
}

void LiveWorker::report_head() {
  io::FrameRow row = io::frame_row(*run_);
  row.branch = status_.branch;
  const std::vector<bool>& on = run_->parameters().anchors;
  for (std::size_t k = 0; k < on.size(); ++k)  // taken away by an edit: the next step lets go of it
    if (!on[k])
      row.anchor[k] = {0, 0, row.anchor[k].natural_length, io::k_anchor_away};
    else if (row.anchor[k].state == io::k_anchor_away)
      row.anchor[k].state = io::k_anchor_slack;  // as the next step begins with it
  auto head = std::make_shared<const io::FrameRow>(std::move(row));
  std::vector<double> peaks;
  for (const AnchorOutcome& anchor : run_->outcome().anchors()) peaks.push_back(anchor.peak_force);
  publish([&](LiveReport& report) {
    report.head = std::move(head);
    report.anchor_peaks = std::move(peaks);
  });
  set(status_.kind);
}

void LiveWorker::set(LiveStatus::Kind kind) {
  status_.kind = kind;
  if (recorder_) status_.record_failure = recorder_->failure();
  publish([](LiveReport&) {});
  if (!stop_) wake_();
}

void LiveWorker::finish() {
  if (!recorder_ || !run_) return;
  record_start();
  record(observer_.last(*run_));
  const std::string status = !run_->status().ok()    ? "diverged"
                             : run_->stopped_early() ? "stopped"
                             : run_->over()          ? "completed"
                                                     : end_status_;
  recorder_->finish(status, json_text(summary(*source_.scene, *run_, status, wall_)));
  status_.record_failure = recorder_->failure();
  publish([](LiveReport&) {});
}

}  // namespace topple::app
