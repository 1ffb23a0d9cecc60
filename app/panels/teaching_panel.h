// What the window teaches: criteria of overturning beside the present shake, guided demos, how far to trust a
// run.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/accuracy.h"
#include "app/panels/criteria.h"
#include "app/panels/demo.h"
#include "app/panels/map_panel.h"

namespace topple::app {

struct TeachingState {
  std::optional<int> body;     ///< that the criteria are for
  CriteriaLimits limits = {};  ///< of `body` under `limits_of`
  std::optional<std::pair<int, Parameters>> limits_of;
  std::vector<ShakePlace> path;                ///< where the shake has been, the present place last
  std::shared_ptr<const Accelerogram> record;  ///< of the present place
  double scale = 1;                            ///< likewise
  std::optional<DemoGuide> guide;
  bool begins = false;                ///< the guide, since the last frame
  std::optional<std::size_t> wanted;  ///< index into demos(): asked for in the last frame
  std::string came_from;              ///< what a demo's scene was opened instead of; empty: nothing
  std::string scene_before;           ///< its name
  bool back = false;                  ///< to that: asked for in the last frame
  std::unique_ptr<Accuracy> accuracy;
  bool in_sight = false;  ///< its result has been scrolled to
  MapState map;
};

/// Amplitude over frequency with the present shake: criteria of overturning, or the map.
void draw_excitation(Player& player, TeachingState& state, std::string& refused);

/// The whole panel.
void draw_teaching(Player& player, TeachingState& state, std::string& refused);

}  // namespace topple::app
