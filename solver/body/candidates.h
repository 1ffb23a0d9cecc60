// Candidate pairs: elements of different bodies that may come to touch. They are searched for with a margin,
// and again when that is used up.
#pragma once

#include "solver/contact/proximity.h"
#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Most that a node is likely to move within h, s: h |v| + h^2/2 |a|, m, with its present v and a.
double likely_travel(const Model& model, const State& state, double h);

/// Greatest displacement of a node from one state to another, m. Of rigid and elastic bodies an upper bound
/// by their rigid motion, without deformation.
double greatest_travel(const Model& model, const State& from, const State& to);

/// Searches again unless State::candidate_margin is above twice `travel`, m: by that much two surfaces come
/// closer when no node moves further than `travel`.
void update_candidates(const Model& model, NearSearch& search, State& state, double travel);

}  // namespace topple
