// The coulomb law, at one contact (template argument P: double) or four (Four).
//   N = P (1 - m_n v_n/sqrt(v_n^2 + eps_n^2)),  m_n: normal_loss, eps_n: normal_speed
//   T = -(k stick + c v_t), capped at mu(v_t) N
// k, c: stick spring and its damping; v_t: tangential velocity.
#pragma once

#include <cmath>

#include "solver/math/lanes.h"
#include "solver/math/pack.h"
#include "solver/math/upwards.h"
#include "solver/model/parameters.h"

namespace topple {

/// Friction between static and kinetic, mu + (mu_s - mu)/(1 + (v/slip_speed)^2); speed2: v^2, m^2/s^2.
template <class T>
T friction_coefficient(const ContactLaw& law, T speed2) {
  return law.friction + law.excess() / (1 + speed2 * (1 / (law.slip_speed * law.slip_speed)));
}

/// Tangential: type of vectors along the plane.
template <class P, class Tangential>
struct CoulombForce {
  P inverse;               ///< s/m, 1/sqrt(v_n^2 + eps_n^2)
  P factor, normal;        ///< N/P; N, in newtons
  Tangential stick, slip;  ///< tangential parts of travel, m, and velocity, m/s
  Tangential trial;        ///< k stick + c slip, N: minus the force if it sticks
  P mu, limit;             ///< mu; mu N, in newtons
  MaskOf<P> sticks;        ///< |trial| <= limit
  bool slips;              ///< some contact that touches does not stick
  P scale;                 ///< T = -scale trial; 0 where nothing touches
  P inverse_size;          ///< 1/|trial|; 0 where it sticks
};

/// loss: normal_loss; weakens: law.excess() > 0; n: normal; v: m/s; stick: m, travel since sticking began; p:
/// P of Eq. 2, N; k, c: N/m and N s/m.
template <class P, class Normal>
[[gnu::always_inline]] inline auto coulomb_force(const ContactLaw& law, double loss, bool weakens,
                                                 const Normal& n, const PackVector<P>& v,
                                                 const PackVector<P>& stick, MaskOf<P> touching, P p, P k,
                                                 P c) {
  using std::sqrt;
  CoulombForce<P, decltype(tangential(n, v))> f;
  const P vn = dot(n, v);
  f.inverse = P(1) / sqrt(mul_add(vn, vn, P(law.normal_speed * law.normal_speed)));
  f.factor = less_product(P(1), P(loss) * vn, f.inverse);
  f.normal = p * f.factor;

  f.stick = tangential(n, stick);
  f.slip = tangential(n, v);
  f.trial = mul_add(c, f.slip, k * f.stick);
  f.mu = weakens ? friction_coefficient(law, dot(f.slip, f.slip)) : P(law.friction);
  f.limit = f.mu * f.normal;
  const P size2 = dot(f.trial, f.trial);
  f.sticks = size2 <= f.limit * f.limit;  // a NaN must not pass for sticking
  f.slips = !holds_where(f.sticks, touching);
  f.scale = P(1);
  f.inverse_size = P(0);
  if (f.slips) {
    f.inverse_size = P(1) / sqrt(size2);
    f.scale = choose(f.sticks, f.scale, f.limit * f.inverse_size);
    f.inverse_size = choose(f.sticks, P(0), f.inverse_size);
  }
  f.scale = choose(touching, f.scale, P(0));
  return f;
}

/// dN/dv_n, N s/m.
template <class P>
[[gnu::always_inline]] inline P normal_slope(const ContactLaw& law, double loss, P p, P inverse) {
  return P(-loss * law.normal_speed * law.normal_speed) * p * inverse * inverse * inverse;
}

/// What slip adds to the derivative of the force by position or velocity, which is otherwise
///   (normal + across) n n^T - across I,
/// normal: dN by motion along n; across: scale times that of trial (k, c or a mix of them). weakens: adds
/// d(mu)/dv; only by velocity.
template <class P, class Tangential, class Normal>
[[gnu::always_inline]] inline PackMatrix<P> slip_slope(const ContactLaw& law, bool weakens,
                                                       const CoulombForce<P, Tangential>& f, const Normal& n,
                                                       P normal, P across) {
  const Tangential along = f.inverse_size * f.trial;
  PackVector<P> side_way = sum_of(across, along, -(f.mu * normal), n);
  if (weakens) {
    const P above = f.mu - P(law.friction);
    side_way = mul_add(P(2) * above * above / P(law.excess() * law.slip_speed * law.slip_speed) * f.normal,
                       f.slip, side_way);
  }
  return outer(in_space(along), side_way);
}

/// Energy of a stick spring, J, its force capped at `limit`, N; k: N/m; travel2: its travel squared, m^2.
template <class P>
[[gnu::always_inline]] inline P stick_energy(P k, P travel2, P limit) {
  const P spring2 = k * k * travel2;
  return P(0.5) / k * choose(spring2 <= limit * limit, spring2, limit * limit);
}
/// Share of its travel that is left when the force is capped; 0 where nothing touches.
template <class P>
[[gnu::always_inline]] inline P held_share(P k, P travel2, P limit, MaskOf<P> touching) {
  using std::sqrt;
  const P furthest = limit / k;
  const MaskOf<P> sticks = travel2 <= furthest * furthest;
  P share = P(1);
  if (!holds_where(sticks, touching)) share = choose(sticks, share, furthest / sqrt(travel2));
  return choose(touching, share, P(0));
}

}  // namespace topple
