#include "solver/io/rerun.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "solver/io/edit_text.h"
#include "solver/io/scene.h"

namespace topple::io {
namespace {

State state_of(const Model& model, const Checkpoint& checkpoint) {
  try {
    return unpack(model, checkpoint.state);
  } catch (const std::invalid_argument&) {
    throw InputError(k_another_model);
  }
}

/// The newest checkpoint that led to the fork of `branch`, or that of its parent at the fork itself.
std::optional<Checkpoint> checkpoint_before(const Recording& recording, const Branch& branch) {
  std::optional<Checkpoint> newest;
  const std::vector<Instant>& all = recording.checkpoint_index();
  for (const Stretch& stretch : recording.history().way_to(branch.parent))
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].branch == stretch.branch && all[i].step <= std::min(stretch.last_step, branch.fork_step))
        newest = recording.checkpoint(static_cast<std::int64_t>(i));
  return newest;
}

/// The branch where it begins. Nothing when that cannot be reached.
std::optional<topple::Run> start(const Recording& recording, const Setup& setup, const Branch& branch) {
  State state;
  if (branch.parent < 0) {
    topple::Run settled(setup);
    if (!settled.status().ok()) return std::nullopt;
    state = settled.state();
  } else {
    const std::optional<Checkpoint> checkpoint = checkpoint_before(recording, branch);
    if (!checkpoint) return std::nullopt;
    state = state_of(setup.model, *checkpoint);
  }
  const History& history = recording.history();
  Parameters parameters = parameters_at(setup, history, branch.id, state.step);
  topple::Run run(setup, std::move(state), std::move(parameters));
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

Rerun rerun(const Recording& recording, const std::function<void(std::int64_t)>& seen) {
  const Setup setup = recorded_scene(recording).setup;
  const History& history = recording.history();
  check_edits(history, setup);
  const std::vector<Instant>& all = recording.checkpoint_index();
  Rerun result;
  std::int64_t passed = 0;
  for (const Branch& branch : history.branches) {
    std::optional<topple::Run> run = start(recording, setup, branch);
    bool same = true;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].branch != branch.id) continue;
      if (same) {
        const Checkpoint recorded = recording.checkpoint(static_cast<std::int64_t>(i));
        same = hash(state_of(setup.model, recorded)) == recorded.hash && run &&
               repeat(*run, history, branch.id, recorded.step) && hash(run->state()) == recorded.hash;
        if (same)
          ++result.checkpoints;
        else
          result.differences.push_back(all[i]);
      }
      seen(++passed);
    }
  }
  return result;
}

}  // namespace topple::io
