#include "solver/io/recording/rerun.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "solver/io/edit/edit_text.h"
#include "solver/io/recording/recording_format.h"
#include "solver/io/scene/scene.h"

namespace topple::io {
namespace {

State state_of(const Model& model, const Checkpoint& checkpoint) {
  try {
    return unpack(model, checkpoint.state);
  } catch (const std::invalid_argument&) {
    throw InputError(k_another_model);
  }
}

/// The newest checkpoint that led to the fork of `branch`, or that of its parent at the fork itself; none at
/// the start, where each branch begins with its own edits.
std::optional<Checkpoint> checkpoint_before(const Recording& recording, const Branch& branch) {
  std::optional<Checkpoint> newest;
  const std::vector<FrameKey>& all = recording.checkpoint_index();
  for (const Stretch& stretch : recording.history().way_to(branch.parent))
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].branch == stretch.branch && all[i].step > 0 &&
          all[i].step <= std::min(stretch.last_step, branch.fork_step))
        newest = recording.checkpoint(static_cast<std::int64_t>(i));
  return newest;
}

/// The branch where it begins. Nothing when that cannot be reached.
std::optional<topple::Run> start(const Recording& recording, const Setup& setup, const Branch& branch) {
  const History& history = recording.history();
  if (branch.parent >= 0 && !recording.can_go_on()) return std::nullopt;
  const std::optional<Checkpoint> checkpoint = checkpoint_before(recording, branch);
  const auto parameters = [&](std::int64_t step) { return parameters_at(setup, history, branch.id, step); };
  topple::Run run = checkpoint
                        ? topple::Run(setup, state_of(setup.model, *checkpoint), parameters(checkpoint->step))
                        : topple::Run(setup, parameters(0));
  if (!run.status().ok()) return std::nullopt;
  if (!repeat(run, history, branch.id, branch.fork_step)) return std::nullopt;
  return run;
}

}  // namespace

void check_edits(const History& history, const Setup& setup) {
  for (const Branch& branch : history.branches) {
    Parameters parameters =
        branch.parent < 0 ? setup.parameters : parameters_at(setup, history, branch.parent, branch.fork_step);
    for (const LoggedEdit& logged : history.edits) {
      if (logged.branch != branch.id) continue;
      try {
        check_edit(logged.edit, parameters, setup.model);
      } catch (const InputError& error) {
        throw InputError(std::string("the recording has an edit that its scene has no place for: ") +
                         error.what());
      }
      apply(logged.edit, setup.model, logged.time, parameters);
    }
  }
}

namespace {

int element_at(const Model& model, int node) {
  for (std::size_t e = 0; e < model.elements.size(); ++e)
    if (model.elements[e].node[0] == node || model.elements[e].node[1] == node) return static_cast<int>(e);
  return -1;
}

/// The element that item `item` of a field of a row is about, -1: none.
int element_of(const Model& model, std::string_view field, std::size_t item) {
  if (field == "position" || field == "rotation") return element_at(model, static_cast<int>(item));
  if (field == "section_force" || field == "s" || field == "hinge" || field == "member_contact")
    return static_cast<int>(item);
  if (field == "panel_contact") return element_at(model, model.panels[item].node[0]);
  if (field == "contact_depth" || field == "contact_force")
    return element_at(model, model.contact_points[item / model.planes.size()].node);
  if (field == "body" || field == "rung") return model.bodies[item].first_element;
  if (field == "anchor") return element_at(model, model.anchors[item].node);
  return -1;
}

std::optional<Difference> difference(const Model& model, const FrameRow& recorded, const FrameRow& again) {
  const auto fields = frame_fields(row_shape(model));
  const auto left = field_bytes(recorded), right = field_bytes(again);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view field = fields[i].name;
    const auto byte = std::mismatch(left[i].begin(), left[i].end(), right[i].begin()).first;
    if (byte == left[i].end()) continue;
    const std::size_t items = fields[i].dims.empty() ? 1 : fields[i].dims[0];
    const std::size_t item = static_cast<std::size_t>(byte - left[i].begin()) / (left[i].size() / items);
    return Difference{
        {recorded.branch, recorded.step, recorded.time}, std::string(field), element_of(model, field, item)};
  }
  return std::nullopt;
}

Difference difference(const Model& model, const FrameKey& at, const State& recorded, const State& again) {
  Difference out{at, "state"};
  const auto same = [](const auto& a, const auto& b) { return a == b; };
  for (int i = 0; i < model.node_total() && out.element < 0; ++i)
    if (!same(recorded.position[i], again.position[i]) || !same(recorded.velocity[i], again.velocity[i]) ||
        !same(recorded.rotation[i].coeffs(), again.rotation[i].coeffs()) ||
        !same(recorded.angular_velocity[i], again.angular_velocity[i]))
      out.element = element_at(model, i);
  return out;
}

template <typename Row>
FrameKey instant_of(const Row& row) {
  return {row.branch, row.step, row.time};
}

bool has_its_hash(const Checkpoint& checkpoint) {
  return hash(std::span(checkpoint.state)) == checkpoint.hash;
}

/// Reads everything, as the comparison of a branch ends at its first difference.
std::vector<Difference> damage(const Recording& recording) {
  std::vector<Difference> found;
  for (std::int64_t i = 0; i < recording.frame_count(); ++i) recording.frame(i);
  for (std::int64_t i = 0; i < recording.checkpoint_count(); ++i)
    if (const Checkpoint checkpoint = recording.checkpoint(i); !has_its_hash(checkpoint))
      found.push_back({instant_of(checkpoint), "hash of the stored state"});
  return found;
}

/// Steps a branch again; nothing when all is the same.
class Comparison {
 public:
  Comparison(const Recording& recording, const Setup& setup, const Branch& branch)
      : recording_(recording), model_(setup.model), branch_(branch), run_(start(recording, setup, branch)) {}

  /// Up to the checkpoint; false after the first difference and for a state that cannot be compared.
  bool reach(std::int64_t checkpoint) {
    const Checkpoint recorded = recording_.checkpoint(checkpoint);
    if (!compare_frames(recorded.step, recorded.time) || !go_to(recorded)) return false;
    if (!recording_.can_go_on() || !has_its_hash(recorded)) return false;
    const State state = state_of(model_, recorded);
    if (hash(run_->state()) != recorded.hash)
      difference_ = topple::io::difference(model_, instant_of(recorded), state, run_->state());
    return !difference_;
  }
  /// Those that no checkpoint follows.
  bool finish() {
    return compare_frames(std::numeric_limits<std::int64_t>::max(), std::numeric_limits<double>::infinity());
  }
  const std::optional<Difference>& found() const { return difference_; }

 private:
  template <typename Row>
  bool go_to(const Row& row) {
    if (!run_ || !advance_to(row.step)) difference_ = {instant_of(row), "the run does not get there"};
    return !difference_;
  }
  // What was recorded of a step was so before the edits at its end: those wait for the next step. A branch
  // begins after its own.
  bool advance_to(std::int64_t step) {
    if (run_->step() >= step) return true;
    if (edits_wait_)
      for (const LoggedEdit& edit : recording_.history().edits_on_way_to(branch_.id))
        if (edit.step == run_->step()) run_->edit(edit.edit);
    if (!repeat(*run_, recording_.history(), branch_.id, step - 1)) return false;
    edits_wait_ = true;
    // a load step that fails counts when it got a part of its way
    return run_->advance().ok() || run_->step() == step;
  }
  // Rows at or within steps up to the last one.
  bool compare_frames(std::int64_t last_step, double last_time) {
    const std::vector<FrameKey>& all = recording_.index();
    for (; next_frame_ < all.size() && !difference_; ++next_frame_) {
      const FrameKey& at = all[next_frame_];
      if (at.branch != branch_.id) continue;
      if (at.step > last_step || (at.step == last_step && at.time > last_time)) return true;
      if (branch_.parent >= 0 && at.step == branch_.fork_step && at.time <= begun_) continue;
      const FrameRow recorded = recording_.frame(static_cast<std::int64_t>(next_frame_));
      if (!go_to(recorded)) return false;
      while (is_ahead(*run_, recorded.time))
        if (!go_to(FrameKey{at.branch, run_->step() + 1, at.time})) return false;
      FrameRow again = frame_row_due(*run_, recorded.time);
      recording_.leave_out_unrecorded(again);
      difference_ = topple::io::difference(model_, recorded, again);
    }
    return !difference_;
  }

  const Recording& recording_;
  const Model& model_;
  const Branch& branch_;
  std::optional<topple::Run> run_;
  bool edits_wait_ = false;                       // those at run_'s step
  const double begun_ = run_ ? run_->time() : 0;  // s
  std::optional<Difference> difference_;
  std::size_t next_frame_ = 0;
};

}  // namespace

Rerun rerun(const Recording& recording, const std::function<void(std::int64_t)>& seen) {
  const Setup setup = recorded_scene(recording).setup;
  const History& history = recording.history();
  check_edits(history, setup);
  if (recording.frame_count() > 0) expect_same_model(setup.model, recording.frame(0));
  const std::vector<FrameKey>& all = recording.checkpoint_index();
  Rerun result;
  result.damage = damage(recording);
  std::int64_t passed = 0;
  for (const Branch& branch : history.branches) {
    Comparison comparison(recording, setup, branch);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].branch != branch.id) continue;
      if (!comparison.found() && comparison.reach(static_cast<std::int64_t>(i))) ++result.checkpoints;
      seen(++passed);
    }
    if (!comparison.found()) comparison.finish();
    if (comparison.found()) result.differences.push_back(*comparison.found());
  }
  return result;
}

}  // namespace topple::io
