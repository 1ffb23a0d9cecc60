// What moves a body on a level: the integrator of a scene is that of frames.
#pragma once

#include <string_view>

#include "solver/body/frame_part.h"
#include "solver/frame/integrator.h"
#include "solver/model/body_state.h"
#include "solver/model/model.h"
#include "solver/model/table.h"
#include "solver/reduced/rigid_island.h"

namespace topple::app {

/// Whether rigid bodies that meet are moved by impulses.
inline bool has_impulses(const Model& model, const Parameters& parameters) {
  return model.furniture_total() > 1 && takes_impulses(parameters);
}

/// Whether some body takes explicit substeps as a frame.
inline bool has_substeps(const Model& model, const Parameters& parameters) {
  for (int b = 0; b < model.furniture_total(); ++b)
    if (may_take_substeps(model, parameters, b)) return true;
  return false;
}

/// Of a level without an integrator of its own the scene's.
struct LevelIntegrator {
  ModelLevel kind;
  std::string_view word;                                       ///< as in summaries; empty: the scene's
  std::string_view otherwise = word;                           ///< the same where it differs
  bool (*differs)(const Model&, const Parameters&) = nullptr;  ///< null: nowhere
};
/// reduced_body.h, rigid_island.h, planar/integrator.h, frame_part.h. A rigid body takes TR-BDF2 while it
/// stands on stiff contacts.
inline constexpr LevelIntegrator k_level_integrators[] = {
    {ModelLevel::planar, "taylor-series"},
    {ModelLevel::rigid, "central-difference, tr-bdf2", "central-difference, tr-bdf2, impulses", has_impulses},
    {ModelLevel::elastic, "central-difference"},
    {ModelLevel::frame, "", "generalized-alpha, central-difference", has_substeps}};

/// Whether bodies on `level` are moved by what LevelIntegrator::otherwise says.
inline bool moves_otherwise(ModelLevel level, const Model& model, const Parameters& parameters) {
  const auto differs = row_of(k_level_integrators, level).differs;
  return differs && differs(model, parameters);
}

/// The word of what moves a body on `level`.
inline std::string_view integrator_of(ModelLevel level, const Model& model, const Parameters& parameters) {
  const LevelIntegrator& of = row_of(k_level_integrators, level);
  const std::string_view own = moves_otherwise(level, model, parameters) ? of.otherwise : of.word;
  return own.empty() ? std::string_view(traits(parameters.integrator).word) : own;
}

}  // namespace topple::app
