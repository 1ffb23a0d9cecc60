// Runs of scenes whose bodies are planar blocks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solver/planar/planar_lanes.h"
#include "solver/run/run.h"

namespace topple::study {

/// What became of a piece of furniture.
struct BodyEnd {
  std::optional<double> fell = {};  ///< s; none: it stands
  bool lifted = false;              ///< a side of it
  double slide = 0;                 ///< m, greatest up to the critical angle
};

/// The blocks of a scene that asks for motion alone and for no way out, whose furniture is all `planar`, or
/// `auto` and rigid by its own rules (model_level.h), without restitution, on contacts no softer than those
/// of scenes that name none and hard enough (hard_floor_error()). Empty: it is not; `why`, if asked for:
/// "cabinet: a wall or body is within its fall".
std::vector<planar::PlanarCase> planar_cases(const Setup& setup, std::string* why = nullptr);

/// Runs of an ensemble that are handed out at once, in lanes.
inline constexpr int k_planar_chunk = 64;

/// A run of an ensemble.
struct PlanarMember {
  std::vector<planar::PlanarCase> blocks;
  std::vector<Shake> shakes;
  double duration;  ///< s
};

/// Runs them in lanes (planar_lanes.h), one fate per block. None: give_up() came true, which is asked as they
/// go on, or it is not known what they do: one came within reach of something else, or a slip jammed again
/// and again. `use`, if asked for: how full the lanes were, added.
std::vector<std::optional<std::vector<BodyEnd>>> run_planar(const std::vector<PlanarMember>& members,
                                                            const std::function<bool()>& give_up,
                                                            planar::LaneUse* use = nullptr);

/// What becomes of those runs, behind how many were planar.
inline constexpr const char* k_climbed =
    "; the others came within reach of something else, or stuck again and again";

}  // namespace topple::study
