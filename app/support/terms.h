// What all parts of the program say of a scene in the same way.
#pragma once

#include <fmt/format.h>

#include <string>

#include "solver/io/scene/scene_words.h"
#include "solver/model/table.h"
#include "solver/run/run.h"

namespace topple::app {

inline constexpr double k_degrees = 180 / k_pi;  ///< in a radian

/// "strap", "bracket" or "pole", as files name it.
inline const char* anchor_type(const Anchor& anchor) {
  return row_of(io::k_anchor_types, anchor.type).word;
}

/// Its rows go by load step and load factor, not by time.
inline bool is_static(const Setup& setup) {
  return setup.run.analysis == Analysis::statics;
}

/// By an anchor that is in place.
inline bool is_held(const Model& model, const Parameters& parameters, int body) {
  for (std::size_t k = 0; k < model.anchors.size(); ++k)
    if ((parameters.anchors.empty() || parameters.anchors[k]) &&
        (model.anchors[k].body == body || model.anchors[k].other.body == body))
      return true;
  return false;
}

/// Else parameters of contact change nothing.
inline bool can_touch(const Model& model) {
  return !model.planes.empty() || model.bodies.size() > 1;
}

/// A share in words: "83 %", "0.9 %"; ">99 %" of what is less than the whole but would be rounded to it.
inline std::string percent_of(double part, double whole) {
  const double percent = 100 * part / whole;
  if (percent > 99 && percent < 100) return ">99 %";
  if (percent < 0.05) return "0 %";
  return percent < 1 ? fmt::format("{:.1g} %", percent) : fmt::format("{:.0f} %", percent);
}

/// Of an anchor in a summary: it held nothing. One that was taken away or broke had a force.
template <class Json>
bool was_never_in_place(const Json& anchor) {
  return !anchor["in_place"].template get<bool>() && anchor["peak_force_N"] == 0;
}

/// The member within which a node lies; null: the node is one of those that scenes name.
inline const Member* member_within(const Model& model, int node) {
  for (const Member& member : model.members)
    for (int e = member.first_element; e + 1 < member.first_element + member.element_count; ++e)
      if (model.elements[static_cast<std::size_t>(e)].node[1] == node) return &member;
  return nullptr;
}

}  // namespace topple::app
