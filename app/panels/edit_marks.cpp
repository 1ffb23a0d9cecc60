#include "app/panels/edit_marks.h"

#include <set>

namespace topple::app {
namespace {

// A pull goes on until it is let go of.
bool holds_on(const Edit& edit) {
  return edit.key == Edit::Key::pull && !edit.value.isZero(0);
}

}  // namespace

std::vector<EditMark> edit_marks(const std::vector<LoggedEdit>& edits,
                                 const std::function<bool(const LoggedEdit&)>& goes_on) {
  constexpr double k_of_one_drag = 0.5;  // s
  std::vector<EditMark> marks;
  for (const LoggedEdit& edit : edits) {
    const bool same = !marks.empty() && marks.back().last.edit.key == edit.edit.key &&
                      marks.back().last.edit.index == edit.edit.index &&
                      marks.back().last.branch == edit.branch &&
                      (holds_on(marks.back().last.edit) ||
                       edit.time - marks.back().last.time < k_of_one_drag || goes_on(edit));
    if (same)
      marks.back().last = edit;
    else
      marks.push_back({edit, edit});
  }
  return marks;
}

std::vector<bool> drawn_marks(const std::vector<PlacedMark>& marks, float apart, float far_apart) {
  std::set<float> breaks, taken;
  const auto is_free = [](const std::set<float>& places, float x, float room) {
    const auto next = places.upper_bound(x - room);
    return next == places.end() || *next >= x + room;
  };
  for (const PlacedMark& mark : marks)
    if (mark.breaks) breaks.insert(mark.x);
  std::vector<bool> drawn;
  for (const PlacedMark& mark : marks) {
    drawn.push_back(mark.gives_way == GivesWay::to_none ||
                    (mark.gives_way == GivesWay::to_breaks && is_free(breaks, mark.x, apart)));
    if (drawn.back()) taken.insert(mark.x);
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i].gives_way != GivesWay::to_all || !is_free(taken, marks[i].x, far_apart)) continue;
    drawn[i] = true;
    taken.insert(marks[i].x);
  }
  return drawn;
}

}  // namespace topple::app
