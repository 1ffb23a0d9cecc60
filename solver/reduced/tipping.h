// At which angle a body tips over an edge of its base, and how bending changes its motion.
#pragma once

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple {

/// Angle at which the centre of gravity stands above an edge of the base, rad, the least over the edges that
/// it stands within; infinite for a body without a base.
double least_tipping_angle(const Body& body);

/// By how much that angle changes when the body bends while it stands on the edge alone, as a share of the
/// angle; the greatest over the edges. 0 for a body without Body::elastic or a base. gravity: m/s^2.
double tipping_error(const Model& model, int body, double gravity);

/// What friction holds back of the spreading of a body's feet under its weight, with which they spring back
/// as soon as they lift or slide, J. 0 as tipping_error.
double splay_energy(const Model& model, int body, double gravity);

/// Estimated error of the motion of a body that is computed as rigid, as a share of its least tipping angle.
/// The floor's greatest acceleration a, as far as friction passes it on, bends it by a/w^2, w its first
/// angular frequency. Where it lifts or slides, because of a or because nothing shakes the floor, so that it
/// moves for another reason, also the greater of tipping_error() and sqrt(splay energy over the energy that
/// tips it): the share of the velocity with which it begins to rock.
double rigid_error(const Model& model, const Parameters& parameters, int body);

}  // namespace topple
