// Penalty forces at one contact, after Eqs. 2 and 3 of the paper.
#pragma once

#include <cmath>
#include <span>

#include "solver/math/types.h"
#include "solver/model/parameters.h"
#include "solver/model/table.h"

namespace topple {

/// Tangential stiffness of a sticking contact over alpha/L. Ten times the normal stiffness at q = 1: elastic
/// travel before slipping stays below mu/10 of the normal depth, while the stick frequency stays within what
/// the time step of the normal contact resolves.
inline constexpr double k_stick_stiffness = 10;
/// Damping ratio of a sticking contact with its share of the body's mass (ContactInput::mass).
inline constexpr double k_stick_damping = 0.2;
/// The stick spring and its damping at one contact (P: double) or four (Four); mass: ContactInput::mass, kg.
template <class P>
struct StickSpring {
  P k, c;  ///< N/m, N s/m
  [[gnu::always_inline]] StickSpring(P alpha, P L, P mass) : k(k_stick_stiffness * alpha / L) {
    using std::sqrt;
    c = 2 * k_stick_damping * sqrt(k * mass);
  }
};

/// The law at time t. During the ramp of an edit alpha (evenly in its logarithm), q, both frictions and
/// restitution go from the old to the new values; the rest is new at once.
ContactLaw contact_law(const Parameters& parameters, double t);
/// The stiffer of the two between which an edit changes.
ContactLaw stiffest_law(const Parameters& parameters);

/// Between members the force hardens beyond this depth, 1 - l/L.
inline constexpr double k_hardening_depth = 0.8;

/// P = alpha (1 - l/L)^q for l <= L, else 0, N (Eq. 2; the direction is the geometric normal).
/// depth: 1 - l/L. Between members, whose centre lines must not meet, from x = (depth - 0.8)/0.2 > 0 on
///   + 10 alpha x^2/(1 - x)^2,  with constant slope from x = 0.98 on.
double penalty_force(const ContactLaw& law, double depth, bool between_members = false);

/// -dP/dl, N/m, for depth > 0.
double penalty_stiffness(const ContactLaw& law, double depth, double L, bool between_members = false);

/// Energy stored by penalty_force at `depth`, J: alpha L / (q + 1) depth^(q + 1), and that of the hardening.
double penalty_energy(const ContactLaw& law, double depth, double L, bool between_members = false);

/// m_n = (1 - e^2)/(1 + e^2): share of P by which the normal force is greater while closing and less while
/// opening, so that an impact returns with restitution e.
double normal_loss(double restitution);

/// State of one contact.
struct ContactInput {
  Vec3 normal;    ///< unit, towards the body that the force acts on
  double depth;   ///< 1 - l/L, > 0
  double L;       ///< m
  Vec3 velocity;  ///< m/s, relative to the other side
  Vec3 stick;     ///< m, tangential travel since sticking began (coulomb law)
  double mass;    ///< kg, share of the body that the contact carries
  bool between_members = false;
};

/// Force on the point and its parts.
struct ContactOutput {
  Vec3 force;           ///< N
  double normal;        ///< N, along the normal
  double conservative;  ///< N, the part of `normal` that is the spring P of Eq. 2; 0: the law has no spring
  Vec3 tangential;      ///< N
  Vec3 stick;           ///< m, travel of the stick spring after slipping
  double stick_energy;  ///< J, held by it
};

/// Derivatives of the force by the position and velocity of the point, N/m and N s/m; null: not asked for.
struct ContactDerivatives {
  Mat3* by_position = nullptr;
  Mat3* by_velocity = nullptr;
};

/// How the normal force N depends on the speed v at which bodies part, v < 0 where they close:
///   N/P = 1 - loss v/sqrt(v^2 + smoothing^2),  of laws that store energy
struct NormalLoss {
  double loss, smoothing;  ///< -, m/s
};

/// What a contact law is. A new one is a row of the table in contact_law.cpp, the function that it names, and
/// a ContactLawKind.
struct ContactLawTraits {
  ContactLawKind kind;
  const char* word;  ///< in scenes, tables and charts
  /// P of Eq. 2 is a spring that gives back what it takes in; false: P does work that is dissipated.
  bool stores_energy;
  /// A spring of k_stick_stiffness holds what does not slip; false: friction is smoothed over slip_speed.
  bool sticks;
  /// Uses restitution, normal_speed and friction_static of ContactLaw.
  bool has_restitution;
  /// BodyContacts computes it four contacts at a time.
  bool in_packs;
  /// Fills the parts of the force (not `force`), and the derivatives if asked for. P: of Eq. 2, N; dP: its
  /// derivative by position along the normal, N/m. What it does not fill was zero before.
  void (*evaluate)(const ContactLaw&, const ContactInput&, double p, double dp, ContactOutput&,
                   ContactDerivatives);
  /// Contact at the new velocity v of a point that would move at `free` without it:
  ///   impedance (v - free) = force(v),  impedance in kg/s.
  /// The input's velocity is where the iteration begins, and then v. Null: solve with contact_force.
  ContactOutput (*at_new_velocity)(const ContactLaw&, ContactInput&, double impedance, const Vec3& free);
  NormalLoss (*normal_loss)(const ContactLaw&);
  bool trusted;  ///< false: verdicts with it mean nothing
};

/// All laws, in the order in which lists show them.
std::span<const ContactLawTraits> contact_laws();
const ContactLawTraits& traits(ContactLawKind kind);
inline const ContactLawTraits& traits(const ContactLaw& law) {
  return traits(law.kind);
}

/// `law` for finding rest: coulomb with e = 1, which has Eq. 2's spring, no loss along the normal, and stick
/// springs, as smoothed friction creeps.
ContactLaw law_at_rest(ContactLaw law);
/// `parameters` with that law and without shakes.
Parameters at_rest(Parameters parameters);

/// A contact law with what is the same at all contacts.
struct PreparedLaw : ContactLaw {
  double root_alpha, loss;  ///< sqrt(alpha), normal_loss()
  double bend;              ///< m/s, least smoothing speed of the law: how far a tangent by velocity is good
  bool in_packs;            ///< ContactLawTraits
  bool plain;               ///< in_packs, q = 1, static friction no higher than dynamic
  explicit PreparedLaw(const ContactLaw& law);
};

/// `law` with its frictions times `grip` (Body::grip).
template <class Law>
Law gripped(Law law, double grip) {
  law.friction *= grip, law.friction_static *= grip;
  return law;
}

/// Greatest stiffness of a law's springs over alpha/L, along the normal (before hardening; q < 1: at a depth
/// of 0.01) and tangential.
struct StiffnessBound {
  double normal, tangential;
};
StiffnessBound stiffness_bound(const ContactLaw& law);

/// Force of the law, for depth > 0 (formulas: coulomb.h, contact_law.cpp).
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input);
ContactOutput contact_force(const ContactLaw& law, const ContactInput& input, Mat3& by_position,
                            Mat3& by_velocity);

}  // namespace topple
