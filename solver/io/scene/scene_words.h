// The words of scenes for choices that have no table of traits; the first is listed first.
#pragma once

#include <string_view>

#include "solver/model/cabinet.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/run/run.h"

namespace topple::io {

/// A row of a table (model/table.h).
template <class Kind>
struct Word {
  Kind kind;
  const char* word;
};

inline constexpr Word<Analysis> k_analyses[] = {
    {Analysis::dynamic, "dynamic"}, {Analysis::statics, "static"}, {Analysis::modes, "modes"}};
inline constexpr Word<StopWhen> k_stops[] = {
    {StopWhen::never, "never"}, {StopWhen::all_overturned, "all-overturned"}, {StopWhen::at_rest, "at-rest"}};
inline constexpr Word<Shake::Start> k_shake_starts[] = {{Shake::Start::rest, "rest"},
                                                        {Shake::Start::jump, "jump"}};
inline constexpr Word<Anchor::Type> k_anchor_types[] = {
    {Anchor::Type::strap, "strap"}, {Anchor::Type::bracket, "bracket"}, {Anchor::Type::pole, "pole"}};
inline constexpr Word<Placement::Base> k_bases[] = {{Placement::Base::corners, "corners"},
                                                    {Placement::Base::edges, "edges"}};
inline constexpr Word<CabinetSpec::Bracing> k_bracings[] = {{CabinetSpec::Bracing::panels, "panels"},
                                                            {CabinetSpec::Bracing::none, "none"}};
inline constexpr Word<CabinetSpec::Front> k_fronts[] = {{CabinetSpec::Front::closed, "closed"},
                                                        {CabinetSpec::Front::open, "open"}};
/// `given` has no word: its numbers stand in its place.
inline constexpr Word<CabinetSpec::Inertia> k_inertias[] = {{CabinetSpec::Inertia::panels, "panels"},
                                                            {CabinetSpec::Inertia::solid, "solid"}};

/// Directions of a node in the order of Support::fixed.
inline constexpr std::string_view k_directions = "xyzXYZ";

}  // namespace topple::io
