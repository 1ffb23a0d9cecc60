// The penalty coefficient of scenes that name none.
#pragma once

#include <optional>

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple {

/// Least alpha, N, at the q of `law`, with which every body stands, lifts and lands on the edges of its base
/// nearly as a rigid body on a rigid floor. None: no floor, no gravity, or no body that stands on its own.
///   alpha = W/n (L/d)^q,  d = min(0.04 b^2/h, 0.02 b^4/h^3, 0.01 L)
/// and the greatest of all edges. W: weight, N; n: contact points on the edge; L: of Eq. 2, m; h: height of
/// the centre of gravity above the base; b: its distance from the edge; d: depth to which the body sinks on
/// this edge alone, m. The three bounds on d:
/// - A side lifts when the body leans by d/2b, which lowers g b/h by the part d h/2b^2: at most 2 %.
/// - A landing takes sqrt(d/g); sqrt(g d) is at most a fifth of the speed b w of the edge, w that of a
///   slender uniform block let go at half of its critical angle, w^2 = 9/16 g b^2/h^3.
/// - The depth is at most a hundredth of L.
std::optional<double> rigid_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity);

/// The alpha of `law` is that at least, but for rounding: its contacts stand for a hard floor.
bool stands_for_hard_floor(const Model& model, const ContactLaw& law, const Vec3& gravity);

/// Least alpha between members, N, with which bodies that knock and lean on each other move nearly as rigid
/// ones; none, and the formula for alpha, as above.
///   d = min(1e-4 h, 0.01 b, 0.01 L)
/// - A knock of a body on as many contacts takes pi sqrt(d/g), at most 0.031 sqrt(h/g), half a hundredth of
///   what its fall takes.
/// - A body that leans with all its weight leans by d/h more, a hundredth of b/h.
/// - The depth is at most a hundredth of L.
std::optional<double> member_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity);

/// Share by which a side of some body lifts at less acceleration than on a rigid floor, d h/2b^2 as above at
/// the alpha of `law`: the greatest of all edges. None as above.
std::optional<double> early_uplift(const Model& model, const ContactLaw& law, const Vec3& gravity);

}  // namespace topple
