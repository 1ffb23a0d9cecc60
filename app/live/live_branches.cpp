// What a live run reads of a recording, and how it returns to an instant of the past.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/batch/load_steps.h"
#include "app/live/live_worker.h"
#include "solver/io/recording/rerun.h"

namespace topple::app {
namespace {

constexpr std::size_t k_rows_at_once = 256;
constexpr std::int64_t k_return_steps = 50;  // between two polls of the stop flag
constexpr double k_longest_repeat = 10;      // s, of wall time

bool took_little(const std::string& summary) {
  const auto told = nlohmann::json::parse(summary, nullptr, false);
  return told.is_object() && told.contains("wall_s") && told["wall_s"].is_number() &&
         told["wall_s"].get<double>() < k_longest_repeat;
}

}  // namespace

void LiveWorker::read_recording() {
  const io::Recording& from = *source_.recording;
  io::check_edits(from.history(), setup_);
  history_ = from.history();
  status_.branch = from.newest_branch();
  publish([this](LiveReport& report) {
    for (; read_branches_ < history_.branches.size(); ++read_branches_)
      report.branches.push_back(history_.branches[read_branches_]);
    for (; read_edits_ < history_.edits.size(); ++read_edits_)
      report.edits.push_back(history_.edits[read_edits_]);
  });
  read_rows();
  repeats_ = took_little(from.summary_json());
  try {
    while (static_cast<std::int64_t>(read_checkpoints_.size()) < from.checkpoint_count() && !stop_)
      read_checkpoints_.push_back(from.checkpoint(static_cast<std::int64_t>(read_checkpoints_.size())));
  } catch (const io::InputError&) {  // a fork then goes back farther
  }
  // A summary is of the newest branch, to its end.
  const std::vector<Stability> told = stabilities(load_steps_in(from.summary_json(), setup_.model));
  const std::int64_t last = from.frame_count() > 0 ? from.index().back().step : 0;
  publish([&](LiveReport& report) {
    for (std::size_t k = 0; k < told.size(); ++k)
      report.stabilities.push_back(
          {status_.branch, last - static_cast<std::int64_t>(told.size() - 1 - k), told[k]});
  });
  const std::vector<io::RecordedEvent> events = from.events();
  publish([&](LiveReport& report) {
    for (; read_events_ < events.size(); ++read_events_) report.events.push_back(events[read_events_]);
  });
}

void LiveWorker::read_rows() {
  const io::Recording& from = *source_.recording;
  std::vector<RowPtr> rows;
  const auto publish_rows = [&] {
    publish([&rows](LiveReport& report) {
      report.rows.insert(report.rows.end(), rows.begin(), rows.end());
      rows.clear();
    });
    if (!stop_) wake_();
  };
  try {
    for (; read_rows_ < from.frame_count() && !stop_; ++read_rows_) {
      rows.push_back(std::make_shared<const io::FrameRow>(from.frame(read_rows_)));
      if (rows.size() == k_rows_at_once) publish_rows();
    }
  } catch (const io::InputError& error) {  // what came before the damage can be seen
    status_.message = error.what();
  }
  publish_rows();
}

void LiveWorker::follow() {
  try {
    if (!status_.message.empty() || !source_.recording->refresh()) return;
    read_recording();
  } catch (const io::InputError& error) {
    status_.message = error.what();
  }
  set(LiveStatus::Kind::replay);
}

void LiveWorker::start_recording(const std::string& arithmetic) {
  if (source_.output.empty()) return;
  try {
    auto recorder = std::make_shared<LiveRecorder>(host::Target(source_.output, source_.force),
                                                   *source_.scene, arithmetic);
    const std::lock_guard lock(mutex_);
    recorder_ = std::move(recorder);
    status_.recording = source_.output;
  } catch (const io::WriteError& error) {
    status_.record_failure = error.what();
  }
}

// From the nearest checkpoint before it, of this run or of the recording that it replays; not from one at the
// start, where each branch begins with its own edits. What came before a checkpoint of a recording is not
// known to a run that begins there: one that takes little time begins at the start.
Run LiveWorker::run_before(std::int32_t branch, std::int64_t step) const {
  const std::vector<Stretch> way = history_.way_to(branch);
  const auto on_way = [&](std::int32_t id, std::int64_t at) {
    return at > 0 && at <= step && std::any_of(way.begin(), way.end(), [&](const Stretch& s) {
             return s.branch == id && at <= s.last_step;
           });
  };
  const Point* nearest = nullptr;
  for (const Point& point : points_)
    if (on_way(point.branch, point.run.state.step) &&
        (!nearest || point.run.state.step >= nearest->run.state.step))
      nearest = &point;
  const io::Checkpoint* read = nullptr;
  for (const io::Checkpoint& checkpoint : read_checkpoints_)
    if (!repeats_ && on_way(checkpoint.branch, checkpoint.step) && (!read || checkpoint.step >= read->step))
      read = &checkpoint;
  if (nearest && (!read || nearest->run.state.step >= read->step)) {
    RunPoint point = nearest->run;
    point.parameters = parameters_at(setup_, history_, branch, point.state.step);
    return Run(setup_, std::move(point));
  }
  if (!read) return Run(setup_, parameters_at(setup_, history_, branch, 0));
  return Run(setup_, unpack(setup_.model, read->state), parameters_at(setup_, history_, branch, read->step));
}

void LiveWorker::fork(const Fork& from) {
  const bool replayed = source_.recording.has_value();
  if (run_) record(observer_.last(*run_));
  going_ = false;
  try {
    if (replayed) io::expect_to_go_on(*source_.recording);
  } catch (const io::InputError& error) {
    status_.message = error.what();
    set(LiveStatus::Kind::replay);
    return;
  }
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
  record_start();
  if (replayed) carry_on_recording();
  Branch branch{.id = 0, .parent = from.branch, .fork_step = from.step};
  for (const Branch& other : history_.branches) branch.id = std::max(branch.id, other.id + 1);
  history_.branches.push_back(branch);
  status_.branch = branch.id;
  status_.message.clear();
  status_.warnings.clear();
  if (recorder_) recorder_->post(branch);
  publish([&branch](LiveReport& report) {
    report.branches.push_back(branch);
    report.head = nullptr;
  });
  run_.emplace(std::move(run));
  if (!from.edits.empty()) change(from.edits);
  begin_branch();
  report_head();
  set(!run_->status().ok() ? LiveStatus::Kind::failed
      : run_->over()       ? LiveStatus::Kind::over
                           : LiveStatus::Kind::halted);
}

// The new file holds all of the one that was replayed, and goes on from there.
void LiveWorker::carry_on_recording() {
  const io::Recording from = std::move(*source_.recording);
  source_.recording.reset();
  start_recording(from.arithmetic());
  if (recorder_) {
    for (const Branch& branch : history_.branches)
      if (branch.parent >= 0) recorder_->post(branch);
    for (const LoggedEdit& edit : history_.edits) recorder_->post(edit);
    for (const io::Checkpoint& checkpoint : read_checkpoints_)
      recorder_->post(io::Observation{.frames = {}, .checkpoint = checkpoint, .events = {}});
    for (std::int64_t i = 0; i < read_rows_; ++i)
      recorder_->post(io::Observation{.frames = {from.frame(i)}, .checkpoint = {}, .events = {}});
    recorder_->post(io::Observation{.frames = {}, .checkpoint = {}, .events = from.events()});
  }
}

}  // namespace topple::app
