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

std::vector<bool> drawn_marks(const std::vector<PlacedMark>& marks, float apart) {
  std::set<float> taken;
  for (const PlacedMark& mark : marks)
    if (!mark.yields) taken.insert(mark.x);
  std::vector<bool> drawn;
  for (const PlacedMark& mark : marks) {
    const auto next = taken.upper_bound(mark.x - apart);
    drawn.push_back(!mark.yields || next == taken.end() || *next >= mark.x + apart);
    if (drawn.back()) taken.insert(mark.x);
  }
  return drawn;
}

}  // namespace topple::app
