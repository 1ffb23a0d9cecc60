// The overturning map of the scene as it is now, beside the scene.
#pragma once

#include <memory>
#include <string>

#include "app/panels/panels.h"
#include "app/study/present_studies.h"

namespace topple::app {

struct MapState {
  std::unique_ptr<OverturnSearch> search;  ///< null: nobody asked for a map
  Parameters of;                           ///< with which it began
  Box cells;                               ///< as drawn last
};

/// Cells, criteria and the present shake. A click on a cell shakes like that; what was refused, and why, is
/// left in `refused`. False: there is no map.
bool draw_map(Player& player, MapState& state, std::string& refused);

/// Begins a map, tells how far it is, stops it, takes it away.
void draw_map_controls(const Player& player, MapState& state);

}  // namespace topple::app
