// Equations of motion of each mode as recurrences of power series. With (X, Z) the lever from the centre of
// gravity to the edge that touches, k^2 = I/m, A the floor's horizontal acceleration, G gravity plus its
// vertical one, f and n the forces of the floor per mass:
//   X' = Z th',  Z' = -X th'
//   about the edge   (k^2 + X^2 + Z^2) th'' = Z A - X G;  f = A - X'',  n = G - Z''
//   slipping edge    n (1 + X E/k^2) = G + Z th'^2,  E = X + mu s Z;  k^2 th'' = -E n,  x'' = -mu s n - A
//   on the base      x'' = -mu s G - A
//   in the air       x'' = -A,  z'' = -G,  th'' = 0
// s: sign of the slip velocity. (Yim, Chopra and Penzien 1980; Shenton 1996.)
#pragma once

#include "solver/math/pack.h"
#include "solver/planar/power_series.h"

namespace topple::planar {

/// Of a block in its mode.
template <class P>
struct Coefficients {
  P inertia;   ///< k^2, m^2
  P friction;  ///< mu s
  P size;      ///< m, of the base's points the largest distance from the centre of gravity: scale of rates
};

/// Motion and forces in a step. Which are in use: mode.cpp.
template <class P>
struct Solution {
  Series<P> horizontal, vertical;  ///< A, G, m/s^2
  Series<P> tilt, rate, x, x_velocity, z, z_velocity;
  Series<P> lever_x, lever_z;        ///< X, Z; in the air cosine and sine of the tilt
  Series<P> tangential, normal;      ///< f, n, m/s^2
  Series<P> denominator, arm, spin;  ///< 1 + X E/k^2, E, th'^2
};

/// Term i + 1 of X and Z from terms up to i of the rate; both products in one loop, as product_term.
template <class P>
[[gnu::always_inline]] inline void turn_lever(Solution<P>& s, int i) {
  P even_x(0), odd_x(0), even_z(0), odd_z(0);
  int j = 0;
  for (; j < i; j += 2) {
    const P even = s.rate[j], odd = s.rate[j + 1];
    even_x = even_x + s.lever_z[i - j] * even;
    even_z = even_z + s.lever_x[i - j] * even;
    odd_x = odd_x + s.lever_z[i - j - 1] * odd;
    odd_z = odd_z + s.lever_x[i - j - 1] * odd;
  }
  if (j == i) {
    even_x = even_x + s.lever_z[0] * s.rate[i];
    even_z = even_z + s.lever_x[0] * s.rate[i];
  }
  const P reciprocal(k_reciprocal[static_cast<std::size_t>(i + 1)]);
  s.lever_x[i + 1] = reciprocal * (even_x + odd_x);
  s.lever_z[i + 1] = -(reciprocal * (even_z + odd_z));
}

/// Terms of tilt and rate from term i of the angular acceleration.
template <class P>
[[gnu::always_inline]] inline void turn(Solution<P>& s, int i, P acceleration) {
  const P reciprocal(k_reciprocal[static_cast<std::size_t>(i + 1)]);
  s.tilt[i + 1] = reciprocal * s.rate[i];
  s.rate[i + 1] = reciprocal * acceleration;
}

/// `last`: the greatest of the lanes' last terms, `each`.
template <class P>
[[gnu::always_inline]] inline void end_turn(Solution<P>& s, int last, P each) {
  turn_lever(s, last + 1);
  s.tilt[last + 2] = P(k_reciprocal[static_cast<std::size_t>(last + 2)]) * s.rate[last + 1];
  for (Series<P>* of : {&s.tilt, &s.lever_x, &s.lever_z}) of->end(last + 2, each + P(2));
  s.rate.end(last + 1, each + P(1));
}

/// Term i of the second derivative.
template <class P>
[[gnu::always_inline]] inline P second_derivative(const Series<P>& of, int i) {
  return P((i + 1) * (i + 2)) * of[i + 2];
}

/// Position and velocity from the acceleration, whose terms are called one by one.
template <class P, class Acceleration>
void integrate(Series<P>& position, Series<P>& velocity, int last, P each, const Acceleration& acceleration) {
  for (int i = 0; i <= last; ++i) {
    velocity[i + 1] = P(k_reciprocal[static_cast<std::size_t>(i + 1)]) * acceleration(i);
    position[i + 1] = P(k_reciprocal[static_cast<std::size_t>(i + 1)]) * velocity[i];
  }
  position[last + 2] = P(k_reciprocal[static_cast<std::size_t>(last + 2)]) * velocity[last + 1];
  position.end(last + 2, each + P(2)), velocity.end(last + 1, each + P(1));
}

/// Leaves the terms of the floor's motion that count; returns the last.
template <class P>
int cut_floor(Solution<P>& s, Truncation<P>& truncation) {
  int i = 0;
  while (!truncation.ends(i, magnitude(s.horizontal.or_zero(i)) + magnitude(s.vertical.or_zero(i)))) ++i;
  for (Series<P>* of : {&s.horizontal, &s.vertical})
    of->end(std::min(of->degree, i), lesser(truncation.last(), of->last()));
  return i;
}

template <class P>
void resting(const Coefficients<P>&, Solution<P>& s, Truncation<P>& truncation) {
  cut_floor(s, truncation);
}

template <class P>
void sliding(const Coefficients<P>& c, Solution<P>& s, Truncation<P>& truncation) {
  const int last = cut_floor(s, truncation);
  integrate(s.x, s.x_velocity, last, truncation.last(),
            [&](int i) { return -(s.horizontal.or_zero(i) + c.friction * s.vertical.or_zero(i)); });
}

template <class P>
void rocking(const Coefficients<P>& c, Solution<P>& s, Truncation<P>& truncation) {
  const P inverse = P(1) / (c.inertia + s.lever_x[0] * s.lever_x[0] + s.lever_z[0] * s.lever_z[0]);
  int i = 0;
  for (;; ++i) {
    const P acceleration = inverse * (product_term(s.lever_z, s.horizontal, i, s.horizontal.degree) -
                                      product_term(s.lever_x, s.vertical, i, s.vertical.degree));
    turn(s, i, acceleration);
    turn_lever(s, i);
    if (truncation.ends(i, magnitude(c.size * acceleration))) break;
  }
  end_turn(s, i, truncation.last());
  for (int j = 0; j <= i; ++j) {
    s.tangential[j] = s.horizontal.or_zero(j) - second_derivative(s.lever_x, j);
    s.normal[j] = s.vertical.or_zero(j) - second_derivative(s.lever_z, j);
  }
  for (Series<P>* of : {&s.tangential, &s.normal}) of->end(i, truncation.last());
}

template <class P>
void slide_rocking(const Coefficients<P>& c, Solution<P>& s, Truncation<P>& truncation) {
  const P inverse = P(1) / c.inertia;
  P over_first(0);
  int i = 0;
  for (;; ++i) {
    s.arm[i] = s.lever_x[i] + c.friction * s.lever_z[i];
    s.denominator[i] = P(i == 0 ? 1 : 0) + inverse * product_term(s.lever_x, s.arm, i);
    s.spin[i] = product_term(s.rate, s.rate, i);
    if (i == 0) over_first = P(1) / s.denominator[0];
    const P force = s.vertical.or_zero(i) + product_term(s.lever_z, s.spin, i);
    s.normal[i] = over_first * (force - product_term(s.normal, s.denominator, i, i, 1));
    const P acceleration = -(inverse * product_term(s.arm, s.normal, i));
    turn(s, i, acceleration);
    turn_lever(s, i);
    if (truncation.ends(i, magnitude(c.size * acceleration) + magnitude(c.friction * s.normal[i]) +
                               magnitude(s.horizontal.or_zero(i))))
      break;
  }
  end_turn(s, i, truncation.last());
  for (Series<P>* of : {&s.normal, &s.denominator}) of->end(i, truncation.last());
  integrate(s.x, s.x_velocity, i, truncation.last(), [&](int j) {
    return second_derivative(s.lever_x, j) - s.horizontal.or_zero(j) - c.friction * s.normal[j];
  });
}

template <class P>
void flying(const Coefficients<P>& c, Solution<P>& s, Truncation<P>& truncation) {
  int i = 0;
  for (;; ++i) {
    turn(s, i, P(0));
    const P reciprocal(k_reciprocal[static_cast<std::size_t>(i + 1)]);
    s.lever_x[i + 1] = -(reciprocal * s.rate[0] * s.lever_z[i]);
    s.lever_z[i + 1] = reciprocal * s.rate[0] * s.lever_x[i];
    const P turning = c.size * s.rate[0] * s.rate[0];
    if (truncation.ends(i, magnitude(turning * s.lever_x[i]) + magnitude(turning * s.lever_z[i]) +
                               magnitude(s.horizontal.or_zero(i)) + magnitude(s.vertical.or_zero(i))))
      break;
  }
  s.tilt.end(1, P(1)), s.rate.end(0, P(0));
  s.lever_x[i + 2] = s.lever_z[i + 2] = P(0);
  for (Series<P>* of : {&s.lever_x, &s.lever_z}) of->end(i + 1, truncation.last() + P(1));
  integrate(s.x, s.x_velocity, i, truncation.last(), [&](int j) { return -s.horizontal.or_zero(j); });
  integrate(s.z, s.z_velocity, i, truncation.last(), [&](int j) { return -s.vertical.or_zero(j); });
}

}  // namespace topple::planar
