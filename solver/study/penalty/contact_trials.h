// What the solver makes of a body on its contacts: one number a trial.
#pragma once

#include <optional>
#include <string>

#include "solver/run/run.h"
#include "solver/study/common/standing.h"

namespace topple::study {

/// What a trial gave. Without value `status` says why.
struct ContactTrial {
  std::optional<double> value;
  std::string status = "completed";
};

/// Greatest depth 1 - l/L of the contacts of a body at rest.
ContactTrial settled_depth(const Setup& body);

/// Greatest displacement of a node, m, after `duration`, s, from the settled state.
ContactTrial creep(const Setup& body, double duration);

/// Frequency of a body's vertical motion on its contacts, Hz, when its weight grows by a twentieth after
/// settling; contacts without loss. `expected`: Hz, sets the step.
ContactTrial settled_frequency(const Setup& body, double expected);

/// Greatest steady acceleration towards the edge, over g, under which the body settles; to 1e-4 of b/h.
ContactTrial settled_tipping_limit(const Setup& body, const Standing& theory);

/// Time, s, until a body let go at rest at half of its critical angle is upright.
ContactTrial fall_back(const Setup& body, const Standing& theory);

/// Least amplitude, over g, of a half-sine of circular frequency ratio p towards the edge that overturns the
/// body before it falls back. `expected`: over g; found to 1e-3 of it, between 0.3 and 1.3 times it.
ContactTrial overturning_half_sine(const Setup& body, const Standing& theory, double ratio, double expected);

}  // namespace topple::study
