// The penalty coefficient of scenes that name none.
#pragma once

#include <optional>

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple {

/// Least alpha, N, with which every body stands, lifts and lands on the edges of its base as a rigid body on
/// a rigid floor does; q of `law`. None: no floor, no gravity, or no body that stands on its own.
///   alpha = W/n (L/d)^q,  d = min(0.04 b^2/h, 0.02 b^4/h^3, 0.01 L)
/// W: weight; n: contact points on the edge; h, b: height of the centre of gravity above the base, its
/// distance from the edge; d: how deep the body sinks on this edge alone, m. The three bounds:
///   A side lifts when the body leans by d/2b, which brings g b/h down by the part d h/2b^2: at most 2 %.
///   A landing takes sqrt(d/g); sqrt(g d) is at most a fifth of the speed b w of the edge, w that of a
///   slender uniform block let go at half of its critical angle, w^2 = 9/16 g b^2/h^3. At rest it sinks by
///   less than a hundredth of the contact width.
std::optional<double> rigid_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity);

}  // namespace topple
