// Elements of different bodies that may come to touch: found with a margin, and again when it is used up.
#pragma once

#include "solver/contact/proximity.h"
#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Most that a node is likely to move within h, m.
double likely_travel(const Model& model, const State& state, double h);

/// Greatest displacement of a node from one state to another, m.
double greatest_travel(const Model& model, const State& from, const State& to);

/// Searches for near elements again where State::candidate_pairs does not cover that every node moves by
/// `travel`, m.
void update_candidates(const Model& model, NearSearch& search, State& state, double travel);

}  // namespace topple
