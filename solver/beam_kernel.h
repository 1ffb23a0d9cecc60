// The element of beam.h for a pack of elements at once: P is Four, or another type with its operations.
#pragma once

#include "solver/pack.h"
#include "solver/rotation.h"

namespace topple {

/// Below this |psi|^2 the series of PackAngle hold to rounding.
inline constexpr double k_small_angle = 0.04;

/// What stays of an element. A broken one has no stiffness.
template <class P>
struct PackBeam {
  PackQuaternion<P> triad;                   ///< local to world axes
  PackMatrix<P> triad_matrix;                ///< the same
  P length, inverse_length;                  ///< m, 1/m
  P t;                                       ///< (1+s)/2
  PackVector<P> normal_stiffness;            ///< EA, kGAy, kGAz, N
  PackVector<P> bending_stiffness;           ///< GJ, EIy, EIz, N m^2
  PackVector<P> offset_gamma, offset_kappa;  ///< strain at which the section forces vanish
};

template <class P>
struct PackEnds {
  PackVector<P> x1, x2;      ///< m
  PackQuaternion<P> q1, q2;  ///< rotations of the nodes
};

/// Functions of the angle between the ends, x = |psi|^2.
template <class P>
struct PackAngle {
  P x;
  P cosine, sine;  ///< exp(t psi) = cosine + sine psi, as a quaternion
  P left1, left2;  ///< T(t psi) = I + left1 [psi] + left2 [psi]^2
  P g;             ///< T(psi)^-1 = I - [psi]/2 + g [psi]^2
};

/// Rotation vector over the vector part of a quaternion.
template <class P>
P log_factor(const PackQuaternion<P>& q) {
  const P r = P(1) / q.w;
  const P x = dot(q.v, q.v) * r * r;
  return (r + r) *
         (P(1) + x * (P(-1. / 3) +
                      x * (P(1. / 5) +
                           x * (P(-1. / 7) +
                                x * (P(1. / 9) + x * (P(-1. / 11) + x * (P(1. / 13) - x * P(1. / 15))))))));
}

template <class P>
PackAngle<P> small_angle(P x, P t) {
  const P y = t * t * x, z = y * P(0.25);
  return {
      x,
      P(1) + z * (P(-0.5) + z * (P(1. / 24) + z * (P(-1. / 720) + z * P(1. / 40320)))),
      P(0.5) * t * (P(1) + z * (P(-1. / 6) + z * (P(1. / 120) + z * (P(-1. / 5040) + z * P(1. / 362880))))),
      t * (P(0.5) +
           y * (P(-1. / 24) +
                y * (P(1. / 720) + y * (P(-1. / 40320) + y * (P(1. / 3628800) - y * P(1. / 479001600)))))),
      t * t *
          (P(1. / 6) +
           y * (P(-1. / 120) + y * (P(1. / 5040) + y * (P(-1. / 362880) + y * P(1. / 39916800))))),
      P(1. / 12) + x * (P(1. / 720) + x * (P(1. / 30240) + x * (P(1. / 1209600) + x * P(1. / 47900160))))};
}

/// log_factor and small_angle lane by lane, for any angle below pi.
inline Four any_log_factor(const PackQuaternion<Four>& q) {
  Four factor;
  for (int k = 0; k < 4; ++k) {
    const double s = std::sqrt(q.v.x[k] * q.v.x[k] + q.v.y[k] * q.v.y[k] + q.v.z[k] * q.v.z[k]);
    factor.set(k,
               s < 1e-3 ? 2 / q.w[k] * (1 - s * s / (3 * q.w[k] * q.w[k])) : 2 * std::atan2(s, q.w[k]) / s);
  }
  return factor;
}

inline PackAngle<Four> any_angle(Four x, Four t) {
  PackAngle<Four> out = small_angle(x, t);
  for (int k = 0; k < 4; ++k) {
    if (x[k] < k_small_angle) continue;
    const double half = t[k] * std::sqrt(x[k]) / 2;
    const ExpCoefficients f(t[k] * t[k] * x[k]);
    out.cosine.set(k, std::cos(half));
    out.sine.set(k, half > 0 ? t[k] / 2 * (std::sin(half) / half) : 0);
    out.left1.set(k, t[k] * f.f1);
    out.left2.set(k, t[k] * t[k] * f.f2);
    out.g.set(k, InverseJacobianCoefficient(x[k]).g);
  }
  return out;
}

/// Strains of a pack and what forces need beside them.
template <class P>
struct PackStrain {
  PackAngle<P> angle;
  PackVector<P> psi;     ///< first end's axes
  PackQuaternion<P> e1;  ///< axes of the first end
  PackMatrix<P> rs;      ///< axes of the integration point
  PackVector<P> d;       ///< rs^T (x2 - x1), m
  PackVector<P> gamma, kappa;
};

template <class P>
PackStrain<P> pack_strain(const PackBeam<P>& beam, const PackEnds<P>& ends) {
  PackStrain<P> s;
  PackQuaternion<P> turn = conjugate(ends.q1) * ends.q2;
  const P one = with_sign_of(P(1), turn.w);
  turn = {one * turn.v, one * turn.w};
  const PackVector<P> along = transposed_times(beam.triad_matrix, turn.v);
  s.psi = log_factor(turn) * along;
  P x = dot(s.psi, s.psi);
  if (any_above(x, k_small_angle)) [[unlikely]] {
    s.psi = any_log_factor(turn) * along;
    x = dot(s.psi, s.psi);
    s.angle = any_angle(x, beam.t);
  } else {
    s.angle = small_angle(x, beam.t);
  }
  s.e1 = ends.q1 * beam.triad;
  s.rs = rotation_matrix(s.e1 * PackQuaternion<P>{s.angle.sine * s.psi, s.angle.cosine});
  s.d = transposed_times(s.rs, ends.x2 - ends.x1);
  s.gamma = {(s.d.x - beam.length) * beam.inverse_length, s.d.y * beam.inverse_length,
             s.d.z * beam.inverse_length};
  s.kappa = beam.inverse_length * s.psi;
  return s;
}

/// Section forces at the stress point.
template <class P>
struct PackSection {
  PackVector<P> normal, moment;
};

template <class P>
PackSection<P> elastic_section(const PackBeam<P>& beam, const PackStrain<P>& s) {
  return {times(beam.normal_stiffness, s.gamma - beam.offset_gamma),
          times(beam.bending_stiffness, s.kappa - beam.offset_kappa)};
}

/// BeamGradient: the second node's, and the first node's moment; the forces are opposite.
template <class P>
struct PackGradient {
  PackVector<P> force2, moment1, moment2;
};

/// With p = n x d in the integration point's axes and T(t psi)^T r1^T = T(t psi) rs^T:
///   q = t T(t psi) p,  moment2 = r1 T(psi)^-T (q + m0),  moment1 = rs p - moment2
template <class P>
PackGradient<P> pack_gradient(const PackBeam<P>& beam, const PackStrain<P>& s,
                              const PackSection<P>& section) {
  const PackVector<P> p = cross(section.normal, s.d);
  const PackVector<P> p1 = cross(s.psi, p), p2 = cross(s.psi, p1);
  const PackVector<P> v = beam.t * (p + s.angle.left1 * p1 + s.angle.left2 * p2) + section.moment;
  const PackVector<P> v1 = cross(s.psi, v), v2 = cross(s.psi, v1);
  PackGradient<P> g;
  g.force2 = s.rs * section.normal;
  g.moment2 = rotate(s.e1, v + P(0.5) * v1 + s.angle.g * v2);
  g.moment1 = s.rs * p - g.moment2;
  return g;
}

/// J
template <class P>
P pack_energy(const PackBeam<P>& beam, const PackStrain<P>& s, const PackSection<P>& section) {
  return P(0.5) * beam.length *
         (dot(section.normal, s.gamma - beam.offset_gamma) +
          dot(section.moment, s.kappa - beam.offset_kappa));
}

}  // namespace topple
