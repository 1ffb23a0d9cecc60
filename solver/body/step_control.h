// How long the next step of an adaptive run may be.
#pragma once

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/state.h"
#include "solver/state/step_limits.h"

namespace topple {

/// What the motion at `state` allows, s, but for what each part knows of itself (Part::time_limit): as these
/// where members near each other, and anchors of any body, close or hold; the time between two samples of a
/// record that shakes the floor.
double look_ahead(const Model& model, const Parameters& parameters, const State& state);

/// Local error of a step of the implicit methods over what the tolerance allows it; at most 1 passes.
///   |e|/h <= tolerance V,  e = (|1/6 - beta - delta/2| + |gamma - 1/2 + delta|) h^2 (a1 - a0),
/// delta = alpha_m - alpha_f, a the algorithmic acceleration, |.| the mass-weighted mean over a body, the
/// greatest of all frames. V: its speed, not below a tenth of what the largest energy exchanged amounts to.
/// Likewise the energy that the step leaves unexplained, against 0.02 of the tolerance of that energy. That
/// energy counts as not less than a fall by 1e-8 of their reach gives the bodies.
double step_error(const Model& model, const Parameters& parameters, const State& before, const State& after,
                  double h);

/// First instant after t at which a shake or a load has a kink, s; infinite when there is none.
double next_kink(const Model& model, const Parameters& parameters, double t);

/// Makes `state` consistent with a step of size h after one of State::step_size: the algorithmic acceleration
/// is that of an instant which lies a part of the step off.
void change_step(State& state, double h);

}  // namespace topple
