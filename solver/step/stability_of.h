// Whether an equilibrium of a frame is stable, and what it loses when it is not.
#pragma once

#include <vector>

#include "solver/frame/body_system.h"
#include "solver/state/step_result.h"

namespace topple {

/// By the tangent in system.lu, not factored yet. `growth`: derivative of the loads by their factor, six
/// numbers per node. Nothing is known with loads that have no potential.
Stability stability_of(BodySystem& system, const std::vector<double>& growth);

/// Completes `out`, which stability_of() gave, by the mode that is softest or, with negative pivots, the
/// softest of those in which the system runs away: inverse iteration of several vectors at once.
void add_softest_mode(BodySystem& system, const std::vector<double>& growth, Stability& out);

/// Whether a hinge flows in a body, or the next one is about to form.
bool is_at_yield(const Model& model, const State& state, int body);

/// Completes `out`, which stability_of() gave, as a mechanism that goes where the growing loads move the
/// system. False: they move nothing.
bool add_collapse(const BodySystem& system, const std::vector<double>& growth, Stability& out);

/// Whether some motion of the system meets no resistance: unit forces on all nodes, with the tangent that
/// stability_of() factored, move one 1e8 times as far as they would bend the softest element.
bool is_free(const BodySystem& system);

}  // namespace topple
