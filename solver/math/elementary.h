// Elementary functions that give the same bits with every compiler, library and processor: they use only
// additions, products, quotients and roots as IEEE 754 rounds them. Errors are below 1 ulp. Zeros, infinities
// and values that are not numbers as in C (annex F), without the exceptions' flags.
#pragma once

namespace topple::elementary {

template <class P>
struct SinCosOf {
  P sine, cosine;
};
using SinCos = SinCosOf<double>;

SinCos sin_cos(double x);  ///< x in rad, any
/// In each lane the bits of sin_cos(); quick where no lane is beyond pi/4. P: double, or Four (pack.h).
template <class P>
SinCosOf<P> sin_cos_of_lanes(const P& x);
double sin(double x);
double cos(double x);
double tan(double x);

double asin(double x);  ///< rad
double acos(double x);
double atan(double x);
double atan2(double y, double x);

double exp(double x);
double expm1(double x);
double log(double x);
double log1p(double x);
double pow(double x, double y);

double cbrt(double x);
double hypot(double x, double y);

}  // namespace topple::elementary

namespace topple {

/// Name and number of all that decides the bits of a run: these functions, rounding, the order of operations
/// and the method. Recordings store it; the number is raised when some scene gives other bits than before.
const char* arithmetic();

}  // namespace topple
