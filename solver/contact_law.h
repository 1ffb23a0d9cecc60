// Penalty forces between a point and a plane, after Eqs. 2 and 3.
#pragma once

#include "solver/parameters.h"
#include "solver/types.h"

namespace topple {

/// Tangential stiffness of a sticking contact over alpha/L. Ten times the normal stiffness at q = 1: elastic
/// travel before slipping stays below mu/10 of the normal depth, while the stick frequency stays within what
/// the time step of the normal contact resolves.
inline constexpr double k_stick_stiffness = 10;
/// Damping ratio of a sticking contact that carries its share of the body's mass.
inline constexpr double k_stick_damping = 0.2;

/// The law at time t: between an edit's earlier and new numbers during its passage, alpha evenly in its
/// logarithm.
ContactLaw contact_law(const Parameters& parameters, double t);

/// P = alpha (1 - l/L)^q for l <= L, else 0, N (Eq. 2; the direction is the geometric normal).
/// depth: 1 - l/L.
double penalty_force(const ContactLaw& law, double depth);

/// Energy stored by penalty_force at `depth`, J: alpha L / (q + 1) depth^(q + 1).
double penalty_energy(const ContactLaw& law, double depth, double L);

/// m_n = (1 - e^2)/(1 + e^2): share of the normal force that depends on the direction of motion so that an
/// impact returns with restitution e.
double normal_loss(double restitution);

/// What meets at a contact.
struct ContactInput {
  Vec3 normal;    ///< unit, from the plane to the point
  double depth;   ///< 1 - l/L, > 0
  double L;       ///< m
  Vec3 velocity;  ///< m/s, of the point relative to the plane
  Vec3 stick;     ///< m, tangential travel since sticking began (coulomb law)
  double mass;    ///< kg, share of the body that the contact carries
};

/// Force on the point and its parts; derivatives by the point's position and velocity when asked for.
struct ContactOutput {
  Vec3 force;           ///< N
  double normal;        ///< N, along the normal
  double conservative;  ///< N, the part of `normal` that is Eq. 2's spring
  Vec3 tangential;      ///< N
  Vec3 stick;           ///< m, after slipping
  double stick_energy;  ///< J
};

/// coulomb: N = P (1 - m_n v_n/sqrt(v_n^2 + eps_n^2)); stick spring with damping, capped at mu N.
/// paper:   P n - mu P v/sqrt(v^2 + eps^2).
/// printed: -P v_n/sqrt(v_n^2 + eps^2) n - mu P v/sqrt(v^2 + eps^2).
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input);
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input, Mat3& by_position,
                            Mat3& by_velocity);

}  // namespace topple
