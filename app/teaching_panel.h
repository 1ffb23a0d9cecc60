// What the window teaches: criteria of overturning beside the present shake, guided demos, how far to trust a
// run.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/accuracy.h"
#include "app/demo.h"

namespace topple::app {

/// A shake on the diagram. Of a record the frequency at which a sine has its peak acceleration and velocity.
struct ShakePlace {
  double frequency, amplitude;  ///< Hz, m/s^2
};

struct TeachingState {
  std::optional<int> body;                     ///< that the criteria are for
  std::vector<ShakePlace> path;                ///< where the shake has been, the present place last
  std::shared_ptr<const Accelerogram> record;  ///< of the present place
  double scale = 1;                            ///< likewise
  std::optional<DemoGuide> guide;
  std::optional<std::size_t> wanted;  ///< of demos(): it was asked for in the last frame
  std::unique_ptr<Accuracy> accuracy;
};

void draw_teaching(Player& player, TeachingState& state);

}  // namespace topple::app
