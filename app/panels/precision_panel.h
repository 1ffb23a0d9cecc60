// Error against CPU time of the scene as it is now, over the scene.
#pragma once

#include <imgui.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/player.h"
#include "app/study/present_studies.h"

namespace topple::app {

/// A case on the chart.
struct PrecisionPoint {
  int k;
  ImVec2 at;  ///< px
};

struct PrecisionState {
  bool open = false;
  std::unique_ptr<PrecisionSearch> search;  ///< null: it was not opened yet
  Parameters of;                            ///< with which it began
  study::Measure measure = study::Measure::tilt;
  std::vector<PrecisionPoint> points;  ///< as drawn last
};

/// A window of its own; begins the computation when there is none. A click on a point computes like that;
/// what was refused, and why, is left in `refused`.
void draw_precision(Player& player, PrecisionState& state, std::string& refused);

/// The edits that lead from the present parameters to others of the same scene, as far as those go that say
/// how it is computed; none: edits cannot say it.
std::optional<std::vector<Edit>> edits_to(const Player& player, const Parameters& wanted);

}  // namespace topple::app
