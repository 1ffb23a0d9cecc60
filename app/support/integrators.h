// What moves a body on a level: the integrator of a scene is that of frames.
#pragma once

#include <string_view>

#include "solver/frame/integrator.h"
#include "solver/model/body_state.h"
#include "solver/model/model.h"
#include "solver/model/table.h"
#include "solver/reduced/rigid_island.h"

namespace topple::app {

/// Of a level without an integrator of its own the scene's.
struct LevelIntegrator {
  ModelLevel kind;
  std::string_view word;      ///< as in summaries; empty: the scene's
  std::string_view impulses;  ///< the same where bodies that meet are moved by impulses
};
/// reduced_body.h, rigid_island.h, planar/integrator.h. A rigid body takes TR-BDF2 while it stands on stiff
/// contacts.
inline constexpr LevelIntegrator k_level_integrators[] = {
    {ModelLevel::planar, "taylor-series", "taylor-series"},
    {ModelLevel::rigid, "central-difference, tr-bdf2", "central-difference, tr-bdf2, impulses"},
    {ModelLevel::elastic, "central-difference", "central-difference"},
    {ModelLevel::frame, "", ""}};

/// Whether rigid bodies that meet are moved by impulses.
inline bool has_impulses(const Model& model, const Parameters& parameters) {
  return model.furniture_total() > 1 && takes_impulses(parameters);
}

/// The word of what moves a body on `level`.
inline std::string_view integrator_of(ModelLevel level, const Model& model, const Parameters& parameters) {
  const LevelIntegrator& of = row_of(k_level_integrators, level);
  const std::string_view own = has_impulses(model, parameters) ? of.impulses : of.word;
  return own.empty() ? std::string_view(traits(parameters.integrator).word) : own;
}

}  // namespace topple::app
