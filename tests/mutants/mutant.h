// Included before everything in a build of mutants: what `run` puts into the formulas. TOPPLE_MUTANT is the
// number of the one that is on; the sites that were reached are added to the file TOPPLE_MUTANT_SITES.
#pragma once

#include <concepts>
#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>

namespace mutant {

inline constexpr int k_most = 1000;
inline int chosen = -1;
inline char reached[k_most];

inline void tell_sites() {
  const char* const path = std::getenv("TOPPLE_MUTANT_SITES");
  std::FILE* const file = path ? std::fopen(path, "a") : nullptr;
  if (!file) return;
  for (int i = 0; i < k_most; ++i)
    if (reached[i]) std::fprintf(file, "%d\n", i);
  std::fclose(file);
}

// Before anything of the formulas is worked out.
__attribute__((constructor(101))) inline void start() {
  static bool started = false;
  if (std::exchange(started, true)) return;
  if (const char* const number = std::getenv("TOPPLE_MUTANT")) chosen = std::atoi(number);
  std::atexit(tell_sites);
}

template <int n>
constexpr bool on() {
  if (std::is_constant_evaluated()) return false;
  reached[n] = 1;
  return chosen == n;
}

template <typename T>
concept Number = std::is_arithmetic_v<std::remove_cvref_t<T>>;

/// `a + Sign<n>() * b`: subtracts when it is on.
template <int n>
struct Sign {};
template <int n, Number T>
constexpr T operator*(Sign<n>, T x) {
  return on<n>() ? static_cast<T>(-x) : x;
}
template <int n, typename T>
requires(!Number<T>) constexpr auto operator*(Sign<n>, const T& x) {
  return (on<n>() ? -1. : 1.) * x;
}

/// `constant<n>(c)` and `component<n>(i)`: another one when it is on.
template <int n, Number T>
constexpr T constant(T c) {
  return on<n>() ? (c == T{0} ? T{1} : static_cast<T>(2 * c)) : c;
}
template <int n>
constexpr int component(int i) {
  return on<n>() ? (i + 1) % 3 : i;
}

template <int n, typename A>
struct Held {
  A a;
};

/// `a * Times<n>() * b` divides when it is on, `a / Over<n>() / b` multiplies.
template <int n>
struct Times {};
template <int n, typename A>
constexpr Held<n, A> operator*(A&& a, Times<n>) {
  return {std::forward<A>(a)};
}
template <int n, typename A, Number B>
requires Number<A>
constexpr auto operator*(Held<n, A> held, B b) {
  return on<n>() ? held.a / b : held.a * b;
}
template <int n>
struct Over {};
template <int n, typename A>
constexpr Held<n, A> operator/(A&& a, Over<n>) {
  return {std::forward<A>(a)};
}
template <int n, typename A, Number B>
constexpr auto operator/(Held<n, A> held, B b) {
  return on<n>() ? held.a * b : held.a / b;
}

/// `a < Order<n>() < b`: the opposite when it is on.
template <int n>
struct Order {};
#define TOPPLE_ORDER(op)                             \
  template <int n, Number A>                         \
  constexpr Held<n, A> operator op(A a, Order<n>) {  \
    return {a};                                      \
  }                                                  \
  template <int n, Number A, Number B>               \
  constexpr bool operator op(Held<n, A> held, B b) { \
    return on<n>() ? !(held.a op b) : (held.a op b); \
  }
TOPPLE_ORDER(<)
TOPPLE_ORDER(>)
TOPPLE_ORDER(<=)
TOPPLE_ORDER(>=)
#undef TOPPLE_ORDER

}  // namespace mutant
