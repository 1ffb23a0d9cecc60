// Points that fill a cube more evenly than random ones do.
#pragma once

#include <cstdint>

namespace topple::study {

inline constexpr int k_most_dimensions = 10;

/// Coordinate `dimension` = 0..k_most_dimensions-1 of point `index` of Sobol's sequence, 0 <= u < 1. Of the
/// first 2^k points each of 2^k equal intervals holds one, in every dimension. Direction numbers: S. Joe and
/// F. Y. Kuo, SIAM J. Sci. Comput. 30, 2008, 2635-2654.
double sobol(std::uint32_t index, int dimension);

/// The same with its digits shifted (exclusive or) as `stream` says, 0 < u < 1: sequences that look
/// independent of each other, each as even. The same everywhere.
double shifted_sobol(std::uint64_t stream, std::uint32_t index, int dimension);

/// z of which Phi(z) = u, 0 < u < 1, to a few 1e-16 of it. Source: M. J. Wichura, Algorithm AS 241, Applied
/// Statistics 37, 1988, 477-484.
double normal_quantile(double u);

/// Distribution function Phi of the standard normal distribution.
double normal_probability(double z);

}  // namespace topple::study
