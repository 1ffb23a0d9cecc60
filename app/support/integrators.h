// What moves a body on a level: the integrator of a scene is that of frames.
#pragma once

#include <string_view>

#include "solver/frame/integrator.h"
#include "solver/model/body_state.h"
#include "solver/model/table.h"

namespace topple::app {

/// Of a level without an integrator of its own the scene's.
struct LevelIntegrator {
  ModelLevel kind;
  std::string_view word;  ///< as in summaries; empty: the scene's
};
/// reduced_body.h, planar/integrator.h. A rigid body takes TR-BDF2 while it stands on stiff contacts.
inline constexpr LevelIntegrator k_level_integrators[] = {{ModelLevel::planar, "taylor-series"},
                                                          {ModelLevel::rigid, "central-difference, tr-bdf2"},
                                                          {ModelLevel::elastic, "central-difference"},
                                                          {ModelLevel::frame, ""}};

/// The word of what moves a body on `level` where frames have `frames`.
inline std::string_view integrator_of(ModelLevel level, Integrator frames) {
  const std::string_view own = row_of(k_level_integrators, level).word;
  return own.empty() ? std::string_view(traits(frames).word) : own;
}

}  // namespace topple::app
