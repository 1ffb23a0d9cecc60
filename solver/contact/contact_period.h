// How fast bodies bounce on the contacts that they rest on.
#pragma once

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple {

/// Longest period with which a body bounces on the contacts that it rests on, s: 2 pi sqrt(L depth / (q g)),
/// depth = (W / (n alpha))^(1/q), n contact points on its base. 0 without gravity or planes.
double contact_period(const Model& model, const ContactLaw& law, const Vec3& gravity);

/// The same of one body; 0 without gravity, planes or contact points.
double contact_period(const Model& model, int body, const ContactLaw& law, const Vec3& gravity);

}  // namespace topple
