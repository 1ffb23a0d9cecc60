// Branches and edits as they are read.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "solver/io/common/errors.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/recording/recording_reader.h"

namespace topple::io {
namespace {

Hdf5Error damaged(const char* set, const char* what, std::size_t number, const std::string& why) {
  return Hdf5Error(std::string(set) + " is damaged (" + what + " " + std::to_string(number) + " " + why +
                   ")");
}

LoggedEdit read_edit(const EditRecord& record, std::size_t number) {
  const auto fail = [&](const std::string& why) { throw damaged("edits", "edit", number, why); };
  if (record.kind != 0) fail("is of a kind that this version does not know");
  const std::string key(record.key, strnlen(record.key, sizeof record.key));
  std::optional<Edit> edit = parse_edit_key(key);
  if (!edit) fail("has a key that this version does not know");
  edit->value = Vec3(record.value);
  const double time = record.value[3];
  if (record.step < 0 || !std::isfinite(time) || time < 0) fail("has no place in time");
  try {
    check_edit_value(*edit);
  } catch (const InputError& error) {
    fail(std::string("says ") + error.what());
  }
  return {.branch = record.branch, .step = record.step, .time = time, .edit = *edit};
}

}  // namespace

bool has_branch(const History& history, std::int32_t id) {
  return std::any_of(history.branches.begin(), history.branches.end(),
                     [id](const Branch& branch) { return branch.id == id; });
}

History read_history(const std::vector<BranchRecord>& branches, const std::vector<EditRecord>& edits) {
  History history;
  for (const BranchRecord& record : branches) {
    const std::size_t number = history.branches.size();
    const auto fail = [&](const char* why) { throw damaged("branches", "branch", number, why); };
    if (has_branch(history, record.branch)) fail("is there twice");
    if (number == 0 ? record.branch != 0 || record.parent != -1 || record.fork_step != 0
                    : record.branch < 0 || record.fork_step < 0 || !has_branch(history, record.parent))
      fail("has no place among the others");
    history.branches.push_back({.id = record.branch, .parent = record.parent, .fork_step = record.fork_step});
  }
  if (history.branches.empty()) throw Hdf5Error("branches is empty");
  for (const EditRecord& record : edits) {
    history.edits.push_back(read_edit(record, history.edits.size()));
    if (!has_branch(history, record.branch))
      throw damaged("edits", "edit", history.edits.size() - 1, "belongs to no branch");
  }
  return history;
}

}  // namespace topple::io
