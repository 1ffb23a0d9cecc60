// The anchors of all bodies at a state (anchor.h), whatever the bodies are computed as.
#pragma once

#include <vector>

#include "solver/contact/anchor.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"

namespace topple {

/// Displacement of the attached point in a mode of the level elastic, reference axes, per amplitude.
Vec3 anchor_shape(const Model& model, const Anchor& anchor, int mode);

/// Where an anchor is attached and how fast that moves, m and m/s, floor's frame, whatever the body's level.
struct AnchorPoint {
  Vec3 at, velocity;
};
AnchorPoint anchor_point(const Model& model, const State& state, int anchor);

/// Of every anchor at `state`, N and J.
std::vector<AnchorForce> anchor_forces(const Model& model, const State& state);

/// Puts anchors in place and takes them away as `parameters` say; sets `changed` of their bodies. False:
/// nothing changed.
bool switch_anchors(const Model& model, const Parameters& parameters, State& state,
                    std::vector<char>& changed);

/// Breaks those that hold more than their strength. As switch_anchors.
bool break_anchors(const Model& model, State& state, std::vector<char>& changed);

/// Longest step that resolves the anchors at `state`, s: a twentieth of the period of a body on one that
/// holds, the time until one begins to hold.
double anchor_look_ahead(const Model& model, const State& state);

}  // namespace topple
