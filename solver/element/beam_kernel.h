// The element of beam.h for a pack of elements at once: P is Four, double for one element, or another type
// with their operations.
#pragma once

#include "solver/math/elementary.h"
#include "solver/math/pack.h"
#include "solver/math/rotation.h"

namespace topple {

/// rad^2: below this |psi|^2 the series of PackAngle are exact to rounding.
inline constexpr double k_small_angle = 0.04;

/// Constants of an element, but for the offset. A broken one has no stiffness.
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

/// Derivatives of left1, left2 and g of PackAngle by x.
template <class P>
struct PackAngleSlope {
  P left1, left2, g;
};

/// f of psi = f q.v, the rotation vector of a unit quaternion with |psi|^2 < k_small_angle, by its series.
template <class P>
[[gnu::always_inline]] inline P log_factor(const PackQuaternion<P>& q) {
  const P r = P(1) / q.w;
  return (r + r) *
         polynomial(dot(q.v, q.v) * r * r, 1, -1. / 3, 1. / 5, -1. / 7, 1. / 9, -1. / 11, 1. / 13, -1. / 15);
}

/// PackAngle and its derivatives by series, for x < k_small_angle.
template <class P>
[[gnu::always_inline]] inline PackAngle<P> small_angle(P x, P t) {
  const P tt = t * t, y = tt * x, z = y * P(0.25);
  return {x,
          polynomial(z, 1, -1. / 2, 1. / 24, -1. / 720, 1. / 40320),
          P(0.5) * t * polynomial(z, 1, -1. / 6, 1. / 120, -1. / 5040, 1. / 362880),
          t * polynomial(y, 1. / 2, -1. / 24, 1. / 720, -1. / 40320, 1. / 3628800, -1. / 479001600),
          tt * polynomial(y, 1. / 6, -1. / 120, 1. / 5040, -1. / 362880, 1. / 39916800),
          polynomial(x, 1. / 12, 1. / 720, 1. / 30240, 1. / 1209600, 1. / 47900160)};
}

template <class P>
[[gnu::always_inline]] inline PackAngleSlope<P> small_angle_slope(P x, P t) {
  const P tt = t * t, y = tt * x;
  return {tt * t * polynomial(y, -1. / 24, 1. / 360, -1. / 13440, 1. / 907200, -1. / 95800320),
          tt * tt * polynomial(y, -1. / 120, 1. / 2520, -1. / 120960, 1. / 9979200),
          polynomial(x, 1. / 720, 1. / 15120, 1. / 403200, 1. / 11975040)};
}

/// log_factor, small_angle and small_angle_slope in closed form, for 0 < |psi| < 2 pi.
inline double large_log_factor(const PackQuaternion<double>& q) {
  const double s = std::sqrt(q.v.x * q.v.x + q.v.y * q.v.y + q.v.z * q.v.z);
  return 2 * elementary::atan2(s, q.w) / s;
}

inline PackAngle<double> large_angle(double x, double t) {
  const double half = t * std::sqrt(x) / 2;
  const ExpCoefficients f(t * t * x);
  return {x,        elementary::cos(half), half > 0 ? t / 2 * (elementary::sin(half) / half) : 0,
          t * f.f1, t * t * f.f2,          InverseJacobianCoefficient(x).g};
}

inline PackAngleSlope<double> large_angle_slope(double x, double t) {
  const double tt = t * t;
  const ExpCoefficients f(tt * x);
  return {tt * t * f.df1, tt * tt * f.df2, InverseJacobianCoefficient(x).dg};
}

/// The same for any |psi| < 2 pi: per lane the series or the closed form.
inline double any_log_factor(const PackQuaternion<double>& q) {
  const double s2 = q.v.x * q.v.x + q.v.y * q.v.y + q.v.z * q.v.z;
  return s2 > k_small_angle / 4 * (q.w * std::abs(q.w)) ? large_log_factor(q) : log_factor(q);
}
inline Four any_log_factor(const PackQuaternion<Four>& q) {
  Four factor = log_factor(q);
  for (int k = 0; k < 4; ++k) {
    const double s2 = q.v.x[k] * q.v.x[k] + q.v.y[k] * q.v.y[k] + q.v.z[k] * q.v.z[k];
    if (s2 > k_small_angle / 4 * (q.w[k] * std::abs(q.w[k])))
      factor.set(k, large_log_factor({{q.v.x[k], q.v.y[k], q.v.z[k]}, q.w[k]}));
  }
  return factor;
}

inline PackAngle<double> any_angle(double x, double t) {
  return x < k_small_angle ? small_angle(x, t) : large_angle(x, t);
}
inline PackAngle<Four> any_angle(Four x, Four t) {
  PackAngle<Four> out = small_angle(x, t);
  for (int k = 0; k < 4; ++k) {
    if (x[k] < k_small_angle) continue;
    const PackAngle<double> one = large_angle(x[k], t[k]);
    out.cosine.set(k, one.cosine);
    out.sine.set(k, one.sine);
    out.left1.set(k, one.left1);
    out.left2.set(k, one.left2);
    out.g.set(k, one.g);
  }
  return out;
}

inline PackAngleSlope<double> any_angle_slope(double x, double t) {
  return x < k_small_angle ? small_angle_slope(x, t) : large_angle_slope(x, t);
}
inline PackAngleSlope<Four> any_angle_slope(Four x, Four t) {
  PackAngleSlope<Four> out = small_angle_slope(x, t);
  for (int k = 0; k < 4; ++k) {
    if (x[k] < k_small_angle) continue;
    const PackAngleSlope<double> one = large_angle_slope(x[k], t[k]);
    out.left1.set(k, one.left1);
    out.left2.set(k, one.left2);
    out.g.set(k, one.g);
  }
  return out;
}

/// The same, faster where all lanes are small.
template <class P>
[[gnu::always_inline]] inline PackAngle<P> angle_functions(P x, P t) {
  return any_above(x, k_small_angle) ? any_angle(x, t) : small_angle(x, t);
}
template <class P>
[[gnu::always_inline]] inline PackAngleSlope<P> angle_slopes(P x, P t) {
  return any_above(x, k_small_angle) ? any_angle_slope(x, t) : small_angle_slope(x, t);
}

/// exp [psi] as a unit quaternion.
template <class P>
PackQuaternion<P> exponential(const PackVector<P>& psi) {
  const PackAngle<P> angle = angle_functions(dot(psi, psi), P(1));
  return {angle.sine * psi, angle.cosine};
}

/// T(psi)^-1, where exp(psi + dpsi) = exp(T dpsi) exp(psi).
template <class P>
[[gnu::always_inline]] inline PackMatrix<P> inverse_left_jacobian(const PackVector<P>& psi) {
  const PackAngle<P> angle = angle_functions(dot(psi, psi), P(1));
  return polynomial_of(psi, double_cross(psi), P(1), P(-0.5), angle.g);
}

/// Strains of a pack, and what its forces and tangent need beside them.
template <class P>
struct PackStrain {
  PackAngle<P> angle;
  PackVector<P> psi;           ///< rotation vector between the ends, axes of the first
  PackQuaternion<P> e1;        ///< axes of the first end to world axes; as a matrix r1 below
  PackMatrix<P> rs;            ///< axes of the integration point to world axes
  PackVector<P> d;             ///< rs^T (x2 - x1), m
  PackVector<P> gamma, kappa;  ///< BeamStrain
};

/// Formulas: beam_strain.
template <class P>
[[gnu::always_inline]] inline PackStrain<P> pack_strain(const PackBeam<P>& beam, const PackEnds<P>& ends) {
  PackStrain<P> s;
  const PackQuaternion<P> turn = conjugate(ends.q1) * ends.q2;
  const PackVector<P> along = transposed_times(beam.triad_matrix, turn.v);
  // tan^2 of half the angle: the series may fold back; none beyond half a turn
  const P limit = P(k_small_angle / 4) * (turn.w * with_sign_of(turn.w, P(1)));
  if (any_above(dot(turn.v, turn.v) - limit, 0)) [[unlikely]] {
    s.psi = any_log_factor(turn) * along;
    s.angle = any_angle(dot(s.psi, s.psi), beam.t);
  } else {
    s.psi = log_factor(turn) * along;
    s.angle = small_angle(dot(s.psi, s.psi), beam.t);
  }
  s.e1 = ends.q1 * beam.triad;
  s.rs = rotation_matrix(normalized(s.e1 * PackQuaternion<P>{s.angle.sine * s.psi, s.angle.cosine}));
  s.d = transposed_times(s.rs, ends.x2 - ends.x1);
  s.gamma = {(s.d.x - beam.length) * beam.inverse_length, s.d.y * beam.inverse_length,
             s.d.z * beam.inverse_length};
  s.kappa = beam.inverse_length * s.psi;
  return s;
}

/// SectionForces of a pack.
template <class P>
struct PackSection {
  PackVector<P> normal, moment;
};

template <class P>
[[gnu::always_inline]] inline PackSection<P> elastic_section(const PackBeam<P>& beam,
                                                             const PackStrain<P>& s) {
  return {times(beam.normal_stiffness, s.gamma - beam.offset_gamma),
          times(beam.bending_stiffness, s.kappa - beam.offset_kappa)};
}

/// Velocities of the ends, world axes.
template <class P>
struct PackEndRates {
  PackVector<P> v1, v2;  ///< m/s
  PackVector<P> w1, w2;  ///< rad/s
};

/// Viscous section forces, time D (rates of the strains); time: damping_time, s. With w, the angular velocity
/// of the integration point, w = w1 + r1 t T(t psi) dpsi/dt:
///   dpsi/dt = T(psi)^-1 r1^T (w2 - w1),  dgamma/dt = rs^T (v2 - v1 - w x (x2 - x1))/L
template <class P>
[[gnu::always_inline]] inline PackSection<P> viscous_section(const PackBeam<P>& beam, const PackStrain<P>& s,
                                                             const PackEndRates<P>& rates, P time) {
  const PackVector<P> turn = rotate(conjugate(s.e1), rates.w2 - rates.w1);
  const PackVector<P> t1 = cross(s.psi, turn), t2 = cross(s.psi, t1);
  const PackVector<P> psi_rate = mul_add(s.angle.g, t2, mul_add(P(-0.5), t1, turn));
  const PackVector<P> p1 = cross(s.psi, psi_rate), p2 = cross(s.psi, p1);
  const PackVector<P> relative_spin =
      rotate(s.e1, beam.t * mul_add(s.angle.left2, p2, mul_add(s.angle.left1, p1, psi_rate)));
  const PackVector<P> apart = transposed_times(s.rs, rates.v2 - rates.v1) -
                              cross(transposed_times(s.rs, rates.w1 + relative_spin), s.d);
  const P factor = time * beam.inverse_length;
  return {factor * times(beam.normal_stiffness, apart), factor * times(beam.bending_stiffness, psi_rate)};
}

/// BeamGradient of a pack, N and N m; force1 = -force2.
template <class P>
struct PackGradient {
  PackVector<P> force2, moment1, moment2;
};

/// n, m0: section forces. With p = n x d in the integration point's axes and T(t psi)^T r1^T = T(t psi) rs^T:
///   q = t T(t psi) p,  moment2 = r1 T(psi)^-T (q + m0),  moment1 = rs p - moment2
template <class P>
[[gnu::always_inline]] inline PackGradient<P> pack_gradient(const PackBeam<P>& beam, const PackStrain<P>& s,
                                                            const PackSection<P>& section) {
  const PackVector<P> p = cross(section.normal, s.d);
  const PackVector<P> p1 = cross(s.psi, p), p2 = cross(s.psi, p1);
  const PackVector<P> v =
      mul_add(beam.t, mul_add(s.angle.left2, p2, mul_add(s.angle.left1, p1, p)), section.moment);
  const PackVector<P> v1 = cross(s.psi, v), v2 = cross(s.psi, v1);
  PackGradient<P> g;
  g.force2 = s.rs * section.normal;
  g.moment2 = rotate(s.e1, mul_add(s.angle.g, v2, mul_add(P(0.5), v1, v)));
  g.moment1 = s.rs * p - g.moment2;
  return g;
}

/// Elastic energy of each lane, J.
template <class P>
[[gnu::always_inline]] inline P pack_energy(const PackBeam<P>& beam, const PackStrain<P>& s,
                                            const PackSection<P>& section) {
  return P(0.5) * beam.length *
         (dot(section.normal, s.gamma - beam.offset_gamma) +
          dot(section.moment, s.kappa - beam.offset_kappa));
}

/// Blocks of the tangent, derivatives of PackGradient by x2, spin1 and spin2. Rows of force1 are those of
/// force2 with the other sign, columns by x1 those by x2 with the other sign.
template <class P>
struct PackTangent {
  PackMatrix<P> force_x2, force_spin1, force_spin2;  ///< of force2
  PackMatrix<P> moment1_x2, moment1_spin1, moment1_spin2;
  PackMatrix<P> moment2_x2, moment2_spin1, moment2_spin2;
};

/// Derivatives of the section forces by the strains where no section flows: N and N m^2.
template <class P>
struct PackStiffness {
  PackVector<P> normal_gamma, moment_kappa;  ///< diagonal
};
/// The same where some flow (SectionTangent).
template <class P>
struct PackFlowing {
  PackMatrix<P> normal_gamma, normal_kappa, moment_kappa;
};

/// Adds what the coupling of normal and shear forces with curvature, normal_kappa, makes where sections flow.
/// e: derivative of force2 by spin2 - spin1 through kappa; e^T: of r1 T(psi)^-T m0 by x2 - x1 through gamma.
template <class P>
[[gnu::always_inline]] inline void add_coupling(const PackMatrix<P>& e, const PackVector<P>& d,
                                                const PackMatrix<P>& b, PackTangent<P>& k) {
  const PackMatrix<P> et = transposed(e), x = skew_times(d, e), y = times_skew(et, d);
  const PackMatrix<P> bt_x = transposed(b) * x, y_b = y * b;
  const PackMatrix<P> spin1 = bt_x + y - y_b, spin2 = y_b - bt_x;
  k.force_spin1 = k.force_spin1 - e;
  k.force_spin2 = k.force_spin2 + e;
  k.moment2_x2 = k.moment2_x2 + et;
  k.moment1_x2 = k.moment1_x2 - et;
  k.moment2_spin1 = k.moment2_spin1 + spin1;
  k.moment2_spin2 = k.moment2_spin2 + spin2;
  k.moment1_spin1 = k.moment1_spin1 + (x - spin1);
  k.moment1_spin2 = k.moment1_spin2 - (x + spin2);
}

/// Derivatives of pack_gradient. `stiffness`: PackStiffness or PackFlowing. In world axes throughout, psi
/// included; b turns the integration point with the second end: its spin is (I - b) spin1 + b spin2.
///   b = t T(t psi) T(psi)^-1 = t I + b1 [psi] + b2 [psi]^2
template <class P, template <class> class Stiffness>
[[gnu::always_inline]] inline PackTangent<P> pack_tangent(const PackBeam<P>& beam, const PackStrain<P>& s,
                                                          const PackSection<P>& section,
                                                          const PackGradient<P>& gradient,
                                                          const PackAngleSlope<P>& slope,
                                                          const Stiffness<P>& stiffness) {
  const P half(0.5), x = s.angle.x, t = beam.t, l1 = s.angle.left1, l2 = s.angle.left2, g = s.angle.g;
  const PackMatrix<P> r1 = rotation_matrix(s.e1);
  const PackVector<P> psi = r1 * s.psi, d = s.rs * s.d, n = gradient.force2, p = cross(n, d);

  const PackMatrix<P> square = double_cross(psi);
  const P b1 = t * (l1 - half - x * (l1 * g - half * l2)), b2 = t * (l2 - half * l1 + g - x * (l2 * g));
  const PackMatrix<P> b = polynomial_of(psi, square, t, b1, b2);
  const PackMatrix<P> inverse = polynomial_of(psi, square, P(1), -half, g);

  const PackMatrix<P> cs = spread(s.rs, beam.inverse_length * stiffness.normal_gamma);
  const PackMatrix<P> n_spin = times_skew(cs, d) - skew(n);
  const PackMatrix<P> p_spin = -skew_times(d, n_spin);

  // what turns with psi: q = t T(t psi)^T p and T(psi)^-T (q + m0)
  const PackVector<P> p1 = cross(psi, p), p2 = cross(psi, p1);
  const PackVector<P> q = t * (p - l1 * p1 + l2 * p2), v = q + r1 * section.moment;
  const PackVector<P> v2 = cross(psi, cross(psi, v));
  const P two(2);
  const PackMatrix<P> dq = t * (l1 * skew(p) + l2 * derivative_of_double_cross(psi, p) +
                                outer(two * (slope.left2 * p2 - slope.left1 * p1), psi));
  const PackMatrix<P> dv =
      g * derivative_of_double_cross(psi, v) - half * skew(v) + outer(two * slope.g * v2, psi);
  const PackMatrix<P> inverse_transposed = transposed(inverse);
  const PackMatrix<P> bending = spread(r1, beam.inverse_length * stiffness.moment_kappa);
  const PackMatrix<P> h = (dv + inverse_transposed * (dq + bending)) * inverse;

  PackTangent<P> k;
  k.force_x2 = cs;
  k.force_spin2 = n_spin * b;
  k.force_spin1 = n_spin - k.force_spin2;
  k.moment2_x2 = transposed(k.force_spin2);
  k.moment1_x2 = transposed(n_spin) - k.moment2_x2;
  const PackMatrix<P> bt = transposed(b), bt_p_spin = bt * p_spin, bt_p_spin_b = bt_p_spin * b;
  k.moment2_spin1 = bt_p_spin - bt_p_spin_b + times_skew(bt, p) - skew(gradient.moment2) - h;
  k.moment2_spin2 = bt_p_spin_b + h;
  const PackMatrix<P> p_spin_b = p_spin * b;
  k.moment1_spin1 = p_spin - p_spin_b - k.moment2_spin1;
  k.moment1_spin2 = p_spin_b - k.moment2_spin2;
  if constexpr (requires { stiffness.normal_kappa; })
    add_coupling(s.rs * (beam.inverse_length * stiffness.normal_kappa) * transposed(r1) * inverse, d, b, k);
  return k;
}

}  // namespace topple
