// The anchors of all bodies at a state (anchor.h), whatever the bodies are computed as.
#pragma once

#include <vector>

#include "solver/contact/anchor.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"

namespace topple {

/// Where an anchor is attached and how fast that moves, m and m/s, floor's frame, whatever the body's level.
struct AnchorPoint {
  Vec3 at, velocity;
};
AnchorPoint anchor_point(const Model& model, const State& state, int anchor);
/// Its other end likewise.
AnchorPoint anchor_target(const Model& model, const State& state, int anchor);

/// Force of an anchor as its ends stand at `state`; `held`: its own part of the state.
AnchorForce anchor_force_at(const Model& model, const State& state, int anchor, const AnchorState& held);

/// One per anchor of the model, at `state`.
std::vector<AnchorForce> anchor_forces(const Model& model, const State& state);

/// Puts anchors in place and takes them away as `parameters` say; sets `changed`, one per body, of their
/// bodies. False: nothing changed.
bool switch_anchors(const Model& model, const Parameters& parameters, State& state,
                    std::vector<char>& changed);

/// Breaks those whose |tension| is above their strength. `changed` and result as of switch_anchors.
bool break_anchors(const Model& model, State& state, std::vector<char>& changed);

/// Longest step that resolves the anchors at `state`, s: bounce_limit (step_limits.h) of a body on one that
/// holds; of one that does not, the time until it does, but not less than that.
double anchor_look_ahead(const Model& model, const State& state);

}  // namespace topple
