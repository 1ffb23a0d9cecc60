#include "solver/run/history.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace topple {

std::vector<Stretch> History::way_to(std::int32_t branch) const {
  std::vector<Stretch> way;
  std::int64_t last = std::numeric_limits<std::int64_t>::max();
  for (std::int32_t id = branch; id >= 0;) {
    const auto found =
        std::find_if(branches.begin(), branches.end(), [&](const Branch& b) { return b.id == id; });
    if (found == branches.end() || way.size() == branches.size())
      throw std::invalid_argument("branch " + std::to_string(id) + " has no way from the root");
    way.insert(way.begin(), {id, last});
    last = std::min(last, found->fork_step);
    id = found->parent;
  }
  return way;
}

std::vector<LoggedEdit> History::edits_on_way_to(std::int32_t branch) const {
  std::vector<LoggedEdit> found;
  for (const Stretch& stretch : way_to(branch))
    for (const LoggedEdit& edit : edits)
      if (edit.branch == stretch.branch && edit.step <= stretch.last_step) found.push_back(edit);
  return found;
}

Parameters parameters_at(const Setup& setup, const History& history, std::int32_t branch, std::int64_t step) {
  Parameters parameters = setup.parameters;
  for (const LoggedEdit& edit : history.edits_on_way_to(branch))
    if (edit.step <= step) apply(edit.edit, setup.model, edit.time, parameters);
  return parameters;
}

Parameters parameters_before(const Setup& setup, const History& history, std::int32_t branch,
                             std::int64_t step) {
  return parameters_at(setup, history, branch, std::max<std::int64_t>(step - 1, 0));
}

bool changed_before(const Setup& setup, const History& history, std::int32_t branch, std::int64_t step) {
  const auto keys = editable(setup.model, setup.parameters);
  Parameters now = setup.parameters;
  const std::vector<LoggedEdit> edits = history.edits_on_way_to(branch);
  for (std::size_t k = 0; k < edits.size() && edits[k].step < step; ++k) {
    apply(edits[k].edit, setup.model, edits[k].time, now);
    if (k + 1 < edits.size() && edits[k + 1].step == edits[k].step) continue;
    for (const auto& [key, index] : keys)
      if (edited_value(now, key, index) != edited_value(setup.parameters, key, index)) return true;
  }
  return false;
}

bool repeat(Run& run, const History& history, std::int32_t branch, std::int64_t step) {
  const std::vector<LoggedEdit> edits = history.edits_on_way_to(branch);
  auto next =
      std::find_if(edits.begin(), edits.end(), [&](const LoggedEdit& e) { return e.step > run.step(); });
  while (run.step() < step) {
    const std::int64_t before = run.step();
    // a load step that fails counts when it got a part of its way
    if (!run.advance().ok() && run.step() == before) return false;
    for (; next != edits.end() && next->step == run.step(); ++next) run.edit(next->edit);
  }
  return true;
}

}  // namespace topple
