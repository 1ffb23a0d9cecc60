#include "app/live/player.h"

#include <algorithm>

#include "app/picture/bridge.h"
#include "solver/io/edit/edit_text.h"

namespace topple::app {
namespace {

constexpr double k_longest_pause = 0.5;  // s between two updates; more is a machine that slept

using Rows = std::vector<RowPtr>;

/// The first row that is later.
Rows::const_iterator row_after(const Rows& rows, double time) {
  return std::upper_bound(rows.begin(), rows.end(), time,
                          [](double t, const RowPtr& row) { return t < row->time; });
}

/// The last row that is not later.
const RowPtr& row_before(const Rows& rows, double time) {
  const auto after = row_after(rows, time);
  return after == rows.begin() ? rows.front() : *(after - 1);
}

io::FrameRow row_at(const Rows& rows, double time) {
  const auto after = row_after(rows, time);
  const RowPtr& before = row_before(rows, time);
  return after == rows.begin() || after == rows.end() || before->time == time ? *before
                                                                              : blend(*before, **after, time);
}

double nearest_time(const Rows& rows, double time) {
  const auto after = row_after(rows, time);
  const double before = row_before(rows, time)->time;
  return after == rows.end() || time - before < (*after)->time - time ? before : (*after)->time;
}

}  // namespace

Player::Player(std::shared_ptr<const io::Scene> scene, LiveRun& run, std::size_t most_bytes)
    : scene_(std::move(scene)),
      bearers_(bearers_of(scene_->setup.model, scene_->setup.starts)),
      run_(run),
      most_bytes_(most_bytes),
      parameters_(scene_->setup.parameters),
      parameters_so_far_(parameters_) {}

bool Player::update(double wall_s) {
  wall_s = std::min(wall_s, k_longest_pause);
  const double before = cursor_;
  const bool at_tail = replay() && !playing_ && cursor_ > 0 && cursor_ >= end();
  const std::size_t rows_before = way_.size();
  LiveReport report = run_.take();
  bool news = report.head || !report.rows.empty() || !report.edits.empty() || !report.branches.empty() ||
              !report.events.empty() || !report.stabilities.empty() || report.status.kind != status_.kind ||
              report.status.message != status_.message || report.status.warnings != status_.warnings ||
              report.status.achieved != status_.achieved ||
              report.status.record_failure != status_.record_failure;
  take(std::move(report));
  if (at_tail && replay()) cursor_ = end();
  if (following_ && head_ && live_shown()) {
    cursor_ = head_->time;
  } else if (playing_ && !play_when_there_ && !forking()) {
    cursor_ = std::min(cursor_ + speed_ * wall_s, end());
    if (cursor_ >= end() && loop_ && !goes_on_at_end()) {
      cursor_ = way_.front()->time;
    } else if (cursor_ >= end()) {
      following_ = live_shown();
      playing_ = goes_on_at_end();
      if (playing_) run_.go(speed_);
    }
  }
  if (play_when_there_ && can_edit()) {
    play_when_there_ = false;
    run_.go(speed_);
  } else if (following_ && !forking() && nothing_goes_on()) {
    const bool again = playing_ && loop_ && status_.kind == LiveStatus::Kind::over;
    playing_ = again;
    if (again) {
      following_ = false;
      cursor_ = way_.front()->time;
    }
  }
  news = news || cursor_ != before || way_.size() != rows_before;
  if (news) update_parameters();
  return news;
}

void Player::take(LiveReport&& report) {
  status_ = std::move(report.status);
  bool rebuild = false;
  for (const Branch& branch : report.branches) {
    history_.branches.push_back(branch);
    if (branch.id != status_.branch) continue;
    if (replay() && !way_.empty()) continue;  // who looks at a recording chooses
    left_ = way_.empty() ? branch.parent : shown_;
    shown_ = branch.id;
    head_ = nullptr;
    following_ = !replay();
    rebuild = true;
  }
  for (const LoggedEdit& edit : report.edits) {
    history_.edits.push_back(edit);
    if (posted_.empty() || replay()) continue;
    if (posted_.front().goes_on) going_on_.insert(place_of(edit));
    posted_.erase(posted_.begin());
  }
  events_.insert(events_.end(), report.events.begin(), report.events.end());
  for (const StepStability& told : report.stabilities)
    stabilities_[{told.branch, told.step}] = told.stability;
  if (report.head) head_ = std::move(report.head);
  if (!report.anchor_peaks.empty()) anchor_peaks_ = std::move(report.anchor_peaks);
  // a branch begins with rows of others, which may come after it was told
  const std::vector<Stretch> stretches =
      history_.branches.empty() ? std::vector<Stretch>() : history_.way_to(shown_);
  const auto is_shown = [&](const io::FrameRow& row) {
    return std::ranges::any_of(stretches, [&](const Stretch& s) {
      return s.branch == row.branch && (s.branch == shown_ || row.step < s.last_step);
    });
  };
  for (RowPtr& row : report.rows) {
    std::vector<RowPtr>& own = rows_[row->branch];
    if (row->step == 0 && own.size() == 1) {  // edits at the start changed it
      own.front() = std::move(row);
      rebuild = true;
      continue;
    }
    if (!rebuild && is_shown(*row)) extend_way(row);
    keep(std::move(row));
  }
  if (rebuild) rebuild_way();
}

void Player::keep(RowPtr row) {
  const std::size_t most = most_bytes_ / memory_of(*row);
  std::vector<RowPtr>& own = rows_[row->branch];
  own.push_back(std::move(row));
  ++rows_since_thinned_;
  // each of very many branches keeps its first rows: thinning then frees little, and not at each new row
  if (++row_count_ > most && rows_since_thinned_ > most / 8) thin();
}

void Player::thin() {
  extent_.thin();
  row_count_ = rows_since_thinned_ = 0;
  for (auto& [branch, rows] : rows_) {
    thin_older_half(rows);
    rows.shrink_to_fit();  // a run may have thousands of branches
    row_count_ += rows.size();
  }
  way_ = rows_on_way_to(shown_);
  if (!ghost_way_.empty()) ghost_way_ = rows_on_way_to(left_);
}

std::vector<RowPtr> Player::rows_on_way_to(std::int32_t branch) const {
  std::vector<RowPtr> found;
  for (const Stretch& stretch : history_.way_to(branch)) {
    const auto own = rows_.find(stretch.branch);
    if (own == rows_.end()) continue;
    for (const RowPtr& row : own->second)
      if (stretch.branch == branch || row->step < stretch.last_step) found.push_back(row);
  }
  return found;
}

void Player::rebuild_way() {
  way_.clear();
  extent_ = {};
  for (const RowPtr& row : rows_on_way_to(shown_)) extend_way(row);
  const bool other = left_ >= 0 && left_ != shown_;
  ghost_way_ = other ? rows_on_way_to(left_) : std::vector<RowPtr>();
  if (ghost_way_.size() < 2) ghost_way_.clear();  // it was left before it began
}

void Player::extend_way(const RowPtr& row) {
  way_.push_back(row);
  extent_.add(scene_->setup, scene_->setup.parameters, *row);
}

void Player::update_parameters() {
  if (history_.branches.empty() || way_.empty()) return;
  const bool head = following_ && head_;
  const io::FrameRow& here = head ? *head_ : *row_before(way_, cursor_);
  const std::int32_t branch = head ? status_.branch : here.branch;
  parameters_ = parameters_at(scene_->setup, history_, branch, here.step);
  parameters_so_far_ = parameters_before(scene_->setup, history_, branch, here.step);
  changed_so_far_ = changed_before(scene_->setup, history_, branch, here.step);
  if (head)
    for (const Posted& posted : posted_) apply(posted.edit, scene_->setup.model, here.time, parameters_);
}

bool Player::busy() const {
  return forking() || status_.kind == LiveStatus::Kind::starting ||
         status_.kind == LiveStatus::Kind::reading || status_.kind == LiveStatus::Kind::returning ||
         status_.kind == LiveStatus::Kind::ended;
}

// After a failed step only a change of parameters, maybe still on its way, gives reason to try again.
bool Player::nothing_goes_on() const {
  return status_.kind == LiveStatus::Kind::over || status_.kind == LiveStatus::Kind::ended ||
         (status_.kind == LiveStatus::Kind::failed && posted_.empty());
}

// What is played up to where a live run stands goes over into stepping.
bool Player::goes_on_at_end() const {
  return live_shown() && status_.kind == LiveStatus::Kind::halted;
}

bool Player::is_live(std::int32_t branch) const {
  return !replay() && branch == status_.branch && status_.kind != LiveStatus::Kind::over &&
         status_.kind != LiveStatus::Kind::ended;
}

bool Player::can_halve_step() const {
  return status_.kind == LiveStatus::Kind::failed && can_edit() &&
         scene_->setup.run.analysis == Analysis::dynamic &&
         parameters_.time_step >= 2 * io::key_of(Edit::Key::time_step).least;
}

void Player::halve_step_and_retry() {
  if (!can_halve_step()) return;
  begin_edit();
  edit({Edit::Key::time_step, 0, Vec3(parameters_.time_step / 2, 0, 0)});
  play();
}

double Player::end() const {
  const double recorded = way_.empty() ? 0 : way_.back()->time;
  return live_shown() && head_ ? std::max(recorded, head_->time) : recorded;
}

double Player::length() const {
  return std::max({end(), live_shown() ? scene_->setup.run.duration : 0, 1e-3});
}

void Player::play() {
  if (playing_ || status_.kind == LiveStatus::Kind::reading || status_.kind == LiveStatus::Kind::ended)
    return;
  if (busy()) {
    playing_ = play_when_there_ = true;
    return;
  }
  if (way_.empty()) return;
  if (following_) {
    if (nothing_goes_on()) return;
    run_.go(speed_);
  } else if (cursor_ >= end()) {
    cursor_ = way_.front()->time;
  }
  playing_ = true;
}

void Player::pause() {
  if (following_) run_.halt();
  playing_ = play_when_there_ = false;
}

void Player::step(int rows) {
  if (way_.empty() || busy()) return;
  pause();
  if (following_) {
    if (rows > 0) {
      run_.one_step();
      return;
    }
    if (cursor_ > way_.back()->time) {
      scrub(way_.back()->time);
      return;
    }
  }
  const auto here = row_after(way_, cursor_) - way_.begin() - 1;
  const auto last = static_cast<std::ptrdiff_t>(way_.size()) - 1;
  if (here + rows > last)
    to_end();
  else
    scrub(way_[static_cast<std::size_t>(std::max<std::ptrdiff_t>(here + rows, 0))]->time);
}

void Player::set_speed(double speed) {
  speed_ = std::clamp(speed, k_least_speed, k_most_speed);
  if (playing_ && following_) run_.go(speed_);
}

void Player::faster() {
  set_speed(speed_ * 2);
}

void Player::slower() {
  set_speed(speed_ / 2);
}

void Player::scrub(double time) {
  if (way_.empty()) return;
  pause();
  following_ = live_shown() && time >= end();
  cursor_ = following_ ? end() : nearest_time(way_, time);
  update_parameters();
}

void Player::to_start() {
  scrub(0);
}

void Player::to_end() {
  scrub(end());
}

void Player::restart() {
  if (way_.empty() || busy()) return;
  const bool goes_on = playing_;
  if (replay()) {
    to_start();
  } else {
    pause();
    const io::FrameRow& first = *way_.front();
    ++forks_asked_;
    run_.fork(first.branch, first.step,
              edits_from(parameters_at(scene_->setup, history_, first.branch, first.step)));
  }
  if (goes_on) play();
}

std::vector<Edit> Player::edits_from(const Parameters& there) const {
  std::vector<Edit> edits;
  for (const auto& [key, shake] : editable(scene_->setup.model, parameters_)) {
    const Vec3 value = edited_value(parameters_, key, shake);
    if (value != edited_value(there, key, shake)) edits.push_back({key, shake, value});
  }
  return edits;
}

void Player::continue_from_here() {
  if (!can_continue()) return;
  playing_ = false;
  const io::FrameRow& here = *row_before(way_, cursor_);
  cursor_ = here.time;
  ++forks_asked_;
  undo_.clear();
  redo_.clear();
  run_.fork(here.branch, here.step);
}

void Player::show_branch(std::int32_t branch) {
  if (branch == shown_ || busy()) return;
  pause();
  left_ = shown_;
  shown_ = branch;
  rebuild_way();
  following_ = false;
  scrub(cursor_);
}

bool Player::can_edit() const {
  return following_ && live_shown() && head_ && !busy();
}

void Player::post(const Edit& edit, bool goes_on) {
  posted_.push_back({edit, goes_on});
  run_.edit(edit);
  update_parameters();
}

void Player::edit(const Edit& edit) {
  if (!can_edit()) return;
  io::check_edit(edit, parameters_, scene_->setup.model);
  if (new_undo_ || undo_.empty()) undo_.emplace_back();
  new_undo_ = false;
  Undo& undo = undo_.back();
  const auto same = std::ranges::find_if(
      undo.again, [&](const Edit& other) { return other.key == edit.key && other.index == edit.index; });
  const bool goes_on = same != undo.again.end();
  if (goes_on) {
    *same = edit;
  } else {
    undo.back.push_back({edit.key, edit.index, edited_value(parameters_, edit.key, edit.index)});
    undo.again.push_back(edit);
  }
  redo_.clear();
  post(edit, goes_on);
}

void Player::pull(const Edit& edit) {
  if (!can_edit()) return;
  io::check_edit(edit, parameters_, scene_->setup.model);
  post(edit);
}

void Player::undo() {
  if (!can_undo()) return;
  new_undo_ = true;
  for (auto edit = undo_.back().back.rbegin(); edit != undo_.back().back.rend(); ++edit) post(*edit);
  redo_.push_back(undo_.back());
  undo_.pop_back();
}

void Player::redo() {
  if (!can_redo()) return;
  new_undo_ = true;
  for (const Edit& edit : redo_.back().again) post(edit);
  undo_.push_back(redo_.back());
  redo_.pop_back();
}

std::optional<io::FrameRow> Player::row() const {
  if (following_ && head_ && live_shown()) return *head_;
  if (way_.empty()) return std::nullopt;
  return row_at(way_, cursor_);
}

std::optional<io::FrameRow> Player::ghost() const {
  if (ghost_way_.empty() || cursor_ > ghost_way_.back()->time) return std::nullopt;
  return row_at(ghost_way_, cursor_);
}

const Stability* Player::stability(const io::FrameRow& row) const {
  const auto at = stabilities_.find({row.branch, row.step});
  return at == stabilities_.end() || at->second.negative_pivots < 0 ? nullptr : &at->second;
}

std::vector<io::RecordedEvent> Player::events() const {
  if (history_.branches.empty()) return {};
  return io::events_on(history_.way_to(shown_), events_);
}

std::vector<LoggedEdit> Player::edits() const {
  return history_.branches.empty() ? std::vector<LoggedEdit>() : history_.edits_on_way_to(shown_);
}

}  // namespace topple::app
