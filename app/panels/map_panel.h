// The overturning map of the scene as it is now, beside the scene.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/panels/panels.h"
#include "app/study/present_studies.h"
#include "app/support/language.h"

namespace topple::app {

struct MapState {
  std::unique_ptr<OverturnSearch> search;      ///< null: there is none yet
  std::shared_ptr<const OverturnFound> shown;  ///< the newest map, of an earlier search until this one ends
  Parameters of, shown_of;                     ///< with which the search began, and that of `shown`
  /// It is computed anew whenever parameters change: where planar blocks do it, unless it was closed.
  enum class Follows { untried, yes, no } follows = Follows::untried;
  /// Steady acceleration, m/s^2, that tips the body of the lines of `shown` on the scene's soft contacts;
  /// none: they are nearly rigid, or there are no lines.
  std::optional<double> soft_limit;
  std::string bends;  ///< a body that bends too much to be rigid in the run, but is a block in the map
  Box cells;          ///< as drawn last
};

/// What the map says of the shake as it is now: the cell that it lies in, as that of another shake unless it
/// is the one that was run.
std::string present_in_words(const OverturnFound& found, const Parameters& now);

/// Why there are no lines, `why` of study::criteria.
std::string no_lines_in_words(Language language, const std::string& why);

/// Begins a search where the map follows the parameters, and takes over what is found.
void update_map(const Player& player, MapState& state);

/// Cells, criteria and the present shake. A click on a cell shakes like that; what was refused, and why, is
/// left in `refused`. False: there is no map.
bool draw_map(Player& player, MapState& state, std::string& refused);

/// Begins a map, tells how far it is, stops it, takes it away.
void draw_map_controls(const Player& player, MapState& state);

}  // namespace topple::app
