// Penalty forces at one contact, after Eqs. 2 and 3.
#pragma once

#include "solver/math/types.h"
#include "solver/model/parameters.h"

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

/// Between members the force hardens beyond this depth.
inline constexpr double k_hardening_depth = 0.8;

/// P = alpha (1 - l/L)^q for l <= L, else 0, N (Eq. 2; the direction is the geometric normal).
/// depth: 1 - l/L. Between members, where centre lines must not meet, and x = (depth - 0.8)/0.2 > 0:
///   + 10 alpha x^2/(1 - x)^2, from x = 0.98 on with constant slope.
double penalty_force(const ContactLaw& law, double depth, bool between_members = false);

/// -dP/dl, N/m.
double penalty_stiffness(const ContactLaw& law, double depth, double L, bool between_members = false);

/// Energy stored by penalty_force at `depth`, J: alpha L / (q + 1) depth^(q + 1), and that of the hardening.
double penalty_energy(const ContactLaw& law, double depth, double L, bool between_members = false);

/// mu of the coulomb law at a slip speed whose square is `speed2`, m^2/s^2, between static and kinetic
/// friction:
///   mu + (mu_s - mu)/(1 + (v/slip_speed)^2)
template <class T>
T friction_coefficient(const ContactLaw& law, T speed2) {
  return law.friction + law.excess() / (1 + speed2 * (1 / (law.slip_speed * law.slip_speed)));
}

/// m_n = (1 - e^2)/(1 + e^2): share of the normal force that depends on the direction of motion so that an
/// impact returns with restitution e.
double normal_loss(double restitution);

/// What meets at a contact.
struct ContactInput {
  Vec3 normal;    ///< unit, towards the body that the force acts on
  double depth;   ///< 1 - l/L, > 0
  double L;       ///< m
  Vec3 velocity;  ///< m/s, relative to the other side
  Vec3 stick;     ///< m, tangential travel since sticking began (coulomb law)
  double mass;    ///< kg, share of the body that the contact carries
  bool between_members = false;
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

/// coulomb: N = P (1 - m_n v_n/sqrt(v_n^2 + eps_n^2)); stick spring with damping, capped at mu N, mu of
/// friction_coefficient at the tangential velocity.
/// paper:   P n - mu P v/sqrt(v^2 + eps^2).
/// printed: -P v_n/sqrt(v_n^2 + eps^2) n - mu P v/sqrt(v^2 + eps^2).
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input);
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input, Mat3& by_position,
                            Mat3& by_velocity);

/// Contact of the coulomb law at the velocity v that it leaves a point which moves at `free` without it:
///   impedance (v - free) = force,  impedance in kg/s.
/// `input.velocity` is where the search begins, and then v.
ContactOutput coulomb_contact(const ContactLaw& law, ContactInput& input, double impedance, const Vec3& free);

}  // namespace topple
