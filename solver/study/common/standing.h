// What theory says of a rigid body that stands on penalty contacts.
#pragma once

#include <optional>
#include <vector>

#include "solver/model/model.h"
#include "solver/model/parameters.h"

namespace topple::study {

/// A rigid body on the contacts of its base, pushed towards its nearest edge.
struct Standing {
  struct Contact {
    double place, across;  ///< m, from the centre of gravity towards the edge and along it
    double L;              ///< m
    double sunk;           ///< m, L - l in the reference pose
  };
  Vec3 direction;          ///< unit, horizontal, from the centre of gravity to the nearest edge
  Vec3 edge;               ///< m, the point of that edge
  double mass, gravity;    ///< kg, m/s^2
  double base, height;     ///< m, b and h: distance of the edge, height of the centre of gravity above it
  double inertia_of_edge;  ///< kg m^2, about the edge
  std::vector<Contact> contacts;
  double grip = 1;  ///< as of Body

  double weight() const { return mass * gravity; }      ///< N
  double rigid_limit() const { return base / height; }  ///< b/h: over g, acceleration at which it lifts
  double critical() const;                              ///< rad, atan(b/h)
  double p() const;                                     ///< 1/s, sqrt(m g R/inertia_of_edge), R^2 = b^2 + h^2
};

/// Towards the nearest edge. The body must stand freely (alone.h).
Standing standing(const Model& model, const Parameters& parameters, int body);

/// The same pushed towards the edge that lies across `direction`, unit; none: no edge does.
std::optional<Standing> standing_towards(const Model& model, const Parameters& parameters, int body,
                                         const Vec3& direction);

/// Over the edge that a push along `direction`, unit, lifts it from first, and the share of the push that
/// goes across that edge: there the steady push that lifts it is rigid_limit()/share, over g. None: the push
/// has no part across an edge.
struct PushedOver {
  Standing edge;
  double share;
  double limit() const { return edge.rigid_limit() / share; }
};
std::optional<PushedOver> pushed_over(const Model& model, const Parameters& parameters, int body,
                                      const Vec3& direction);

/// Depth 1 - l/L of the deepest contact at rest. n like contacts evenly around the centre of gravity:
///   (W/(n alpha))^(1/q)
/// Others lean until they balance; that the centre of gravity goes with the lean is left out.
double rest_depth(const Standing& body, const ContactLaw& law);

/// Frequency of small vertical motion about rest without leaning, Hz: sqrt(k/m)/2 pi, k the sum of
/// q (alpha/L) depth^(q-1).
double bounce_frequency(const Standing& body, const ContactLaw& law);

/// Greatest steady acceleration that the body withstands, over g: the greatest x(theta)/h - theta of any lean
/// theta, x the place of the floor's resultant. Rigid contact: b/h. Stiff contact, n_e contacts in the row of
/// the edge and the next row s behind it:
///   b/h - (L/s) (W/(n_e alpha))^(1/q)     q = 1; slightly more for q > 1
/// 0: it cannot stand.
double tipping_limit(const Standing& body, const ContactLaw& law);

/// The same on contacts that hardly give way: b/h, but for a base that begins askew, as on a stopper.
double stiff_limit(const Standing& body, ContactLaw law);

/// tipping_limit() as an acceleration, m/s^2, where it is less than 95 % of that on rigid contact; else none.
std::optional<double> soft_limit(const Standing& body, const ContactLaw& law);

/// Smallest alpha, N, from which on the tipping limit is within the fraction `loss` of stiff_limit(). Stiff
/// contact:
///   (W/n_e) (L h/(s b loss))^q            q = 1; slightly less for q > 1
double alpha_for_tipping(const Standing& body, ContactLaw law, double loss);

/// Greatest alpha, N, with which a period of the bounce takes `period` s or more; q alpha^(1/q) grows as
/// 1/period^2.
double alpha_for_period(const Standing& body, ContactLaw law, double period);

/// Time from rest at half of the critical angle until a rigid body on rigid contact is upright, s:
///   th'' = -p^2 sin(critical - th)
double fall_back_time(const Standing& body);

/// Least amplitude, over g, of a half-sine of circular frequency w = ratio p that overturns a rigid body on
/// rigid contact before it falls back:
///   th'' = p^2 (-sin(critical - th) + a/g cos(critical - th))
double least_half_sine(const Standing& body, double ratio);

/// The same of a constant push for `length`/p.
double least_rectangle(const Standing& body, double length);

/// The same of a whole sine, as far as `most`; none: that does not overturn it. A body that falls back lands
/// on its other edge, as far off, after Housner (1963): th' -> (1 - 2 m b^2/I) th', I about the edge. The
/// amplitudes tried are 0.2 % apart, from 1.5 b/h on 1 %, then halved: more than the least may leave the body
/// standing again.
std::optional<double> least_full_sine(const Standing& body, double ratio, double most);

}  // namespace topple::study
