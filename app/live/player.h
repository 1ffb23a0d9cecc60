// The controls of a run (play, pause, rewind, branch, edit, undo), the frame shown, and everything reported
// so far.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "app/live/live_run.h"
#include "app/picture/run_extent.h"
#include "app/picture/thinning.h"
#include "solver/run/bearer.h"

namespace topple::app {

/// Speeds that faster() and slower() go through.
inline constexpr double k_least_speed = 1. / 64, k_most_speed = 8;

class Player {
 public:
  /// At most `most_bytes` of rows are kept (thinning.h).
  Player(std::shared_ptr<const io::Scene> scene, LiveRun& run, std::size_t most_bytes = k_most_row_bytes);

  /// Takes in what was reported and lets a replay go on by `wall_s`. True when anything changed.
  bool update(double wall_s);

  // Transport. At the head, the newest state of the live branch, playing means stepping; elsewhere what was
  // recorded is played, up to there.
  void play();
  void pause();
  void toggle() { playing_ ? pause() : play(); }
  void step(int rows);           ///< one recorded frame back or on; at the head, one step of the run
  void set_speed(double speed);  ///< clipped to k_least_speed..k_most_speed
  void faster();
  void slower();
  /// From the beginning, in a new branch, with the parameters as they are now; plays on if it did. A replay
  /// goes to its start.
  void restart();
  void scrub(double time);  ///< pauses
  void to_start();
  void to_end();
  /// At the end playing begins again, with what there is from the start.
  void set_loop(bool loop) { loop_ = loop; }
  bool loop() const { return loop_; }
  bool playing() const { return playing_; }
  double speed() const { return speed_; }
  double time() const { return cursor_; }
  /// Time of the last frame, and the length of the time axis, s.
  double end() const;
  double length() const;
  bool at_head() const { return following_; }
  bool replay() const {
    return status_.kind == LiveStatus::Kind::replay || status_.kind == LiveStatus::Kind::reading;
  }

  /// A failed step may be tried again at half its length, for which this makes the edit.
  bool can_halve_step() const;
  void halve_step_and_retry();

  // Branches.
  bool can_continue() const { return !following_ && !way_.empty() && !busy(); }
  void continue_from_here();
  void show_branch(std::int32_t branch);
  std::int32_t shown_branch() const { return shown_; }
  /// Whether it is computed, or will be when played: a run that has ended is not.
  bool is_live(std::int32_t branch) const;
  const History& history() const { return history_; }

  // Edits, at the head of the live branch only.
  bool can_edit() const;
  /// The next edit is a new thing to undo. Further ones go on with it, as while a slider is dragged, or where
  /// several keys belong together.
  void begin_edit() { new_undo_ = true; }
  /// Throws io::InputError for what a scene would be refused for.
  void edit(const Edit& edit);
  /// The same of a pull, which is not undone.
  void pull(const Edit& edit);
  /// The edits that turn these parameters, of the same model, into the present ones.
  std::vector<Edit> edits_from(const Parameters& there) const;
  bool can_undo() const { return can_edit() && !undo_.empty(); }
  bool can_redo() const { return can_edit() && !redo_.empty(); }
  void undo();
  void redo();
  /// Of the frame shown, with the edits that the run has not applied yet.
  const Parameters& parameters() const { return parameters_; }
  /// With which the frame shown came about.
  const Parameters& parameters_so_far() const { return parameters_so_far_; }
  bool changed_so_far() const { return changed_so_far_; }  ///< changed_before()

  // What is seen.
  const io::Scene& scene() const { return *scene_; }
  std::span<const Bearer> bearers() const { return bearers_; }  ///< bearers_of the scene
  const LiveStatus& status() const { return status_; }
  /// The frame shown, interpolated between two recorded ones while a replay goes on; nothing before the
  /// first.
  std::optional<io::FrameRow> row() const;
  /// The same time on the way to the branch that was left last.
  std::optional<io::FrameRow> ghost() const;
  /// Recorded frames of the branch shown and, before its forks, of those that it comes from; their extent.
  const std::vector<RowPtr>& way() const { return way_; }
  /// The same of the branch that was left last; empty: there is none.
  const std::vector<RowPtr>& ghost_way() const { return ghost_way_; }
  /// That ghost() is of; none: there is no ghost.
  std::optional<std::int32_t> ghost_branch() const {
    return ghost_way_.empty() ? std::nullopt : std::optional(left_);
  }
  const RunExtent& extent() const { return extent_; }
  /// Recorded on the same branches.
  std::vector<io::RecordedEvent> events() const;
  std::vector<LoggedEdit> edits() const;
  /// Whether one of edits() went on with the one before it of its key, as while a slider was dragged; not
  /// known of what was recorded.
  bool goes_on(const LoggedEdit& edit) const { return going_on_.contains(place_of(edit)); }
  /// Greatest force of each anchor between the frames too, from the start of the branch that goes on to its
  /// newest state, N; empty: another branch is shown, or a recording.
  std::span<const double> anchor_peaks() const {
    return live_shown() ? std::span<const double>(anchor_peaks_) : std::span<const double>();
  }
  /// Of the load step that ends at a recorded frame; null: it is not known.
  const Stability* stability(const io::FrameRow& row) const;

 private:
  struct Undo {
    std::vector<Edit> back, again;  // an entry a key
  };
  bool busy() const;
  bool nothing_goes_on() const;
  bool goes_on_at_end() const;
  bool forking() const { return forks_asked_ > status_.forks; }
  bool live_shown() const { return !replay() && shown_ == status_.branch; }
  using EditPlace = std::tuple<std::int32_t, std::int64_t, Edit::Key, int>;
  static EditPlace place_of(const LoggedEdit& edit) {
    return {edit.branch, edit.step, edit.edit.key, edit.edit.index};
  }
  void post(const Edit& edit, bool goes_on = false);
  void take(LiveReport&& report);
  void keep(RowPtr row);
  void thin();
  void rebuild_way();
  void extend_way(const RowPtr& row);
  void update_parameters();
  std::vector<RowPtr> rows_on_way_to(std::int32_t branch) const;

  const std::shared_ptr<const io::Scene> scene_;
  const std::vector<Bearer> bearers_;
  LiveRun& run_;
  const std::size_t most_bytes_;
  LiveStatus status_;
  History history_;
  std::map<std::int32_t, std::vector<RowPtr>> rows_;  // by branch
  std::size_t row_count_ = 0, rows_since_thinned_ = 0;
  std::vector<io::RecordedEvent> events_;
  std::map<std::pair<std::int32_t, std::int64_t>, Stability> stabilities_;  // by branch and step
  RowPtr head_;
  std::vector<double> anchor_peaks_;
  std::int32_t shown_ = 0;
  std::int32_t left_ = -1;  // branch that was left last; -1: none
  std::vector<RowPtr> way_, ghost_way_;
  RunExtent extent_;
  Parameters parameters_, parameters_so_far_;
  bool changed_so_far_ = false;
  struct Posted {
    Edit edit;
    bool goes_on;
  };
  std::vector<Posted> posted_;  // not yet applied by the run
  std::set<EditPlace> going_on_;
  std::vector<Undo> undo_, redo_;
  bool playing_ = false, loop_ = false, following_ = true;
  bool new_undo_ = true;
  bool play_when_there_ = false;  // asked for on the way to a fork
  std::int64_t forks_asked_ = 0;
  double speed_ = 1, cursor_ = 0;
};

}  // namespace topple::app
