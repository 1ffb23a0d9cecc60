// How long the next step of an adaptive run may be.
#pragma once

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"
#include "solver/state/step_limits.h"

namespace topple {

/// Longest step that the motion at `state` allows, s, but for what each part knows of itself
/// (Part::time_limit): by anchors (anchor_look_ahead), by the time between two samples of a record that
/// shakes the floor; at most k_longest_step.
double look_ahead(const Model& model, const Parameters& parameters, const State& state);

/// Local error of a step over what the tolerance allows it; at most 1 passes.
struct StepError {
  double motion = 0;  ///< of frames, by implicit methods, and of rigid bodies that are stepped with some
  double energy = 0;
  double greatest() const { return motion > energy ? motion : energy; }
};

/// motion:
///   |e|/h <= tolerance V,  e = (|1/6 - beta - delta/2| + |gamma - 1/2 + delta|) h^2 (a1 - a0),
/// delta = alpha_m - alpha_f, a the algorithmic acceleration, |.| the mass-weighted root mean square over a
/// body's nodes, rotations included; the greatest of all frames, and of rigid bodies that are stepped with
/// some (with_frames: one per body). V^2 = |v|^2 + 0.1^2 (2 E/m): E is the largest energy exchanged so far, m
/// the mass of all bodies. energy: what the step leaves unexplained, over 0.02 tolerance E. E counts as at
/// least 1e-8 of sum(m g reach).
StepError step_error(const Model& model, const Parameters& parameters, const State& before,
                     const State& after, double h, const std::vector<char>& with_frames);

/// First instant after t at which a shake starts, ends or has a kink, or a load's history has one, s;
/// infinite when there is none.
double next_kink(const Model& model, const Parameters& parameters, double t);

/// Makes `state` consistent with a step of size h, s, after one of State::step_size. The algorithmic
/// acceleration a of generalized-alpha belongs to an instant a fixed share of the step away, so its distance
/// from the true one goes with the step: a <- acc + (h/step_size) (a - acc).
void change_step(State& state, double h);

}  // namespace topple
