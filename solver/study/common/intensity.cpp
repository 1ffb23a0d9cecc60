#include "solver/study/common/intensity.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "solver/model/excitation.h"

namespace topple::study {
namespace {

constexpr double k_interval = 0.005;  // s: half of what JMA's instruments have
constexpr double k_reached = 0.3;     // s
constexpr double k_silence = 20;  // s after the motion, in which the filters' response to its end dies away

std::size_t power_of_two_from(std::size_t least) {
  std::size_t n = 1;
  while (n < least) n *= 2;
  return n;
}

/// One component, gal, filtered; as long as `padded`.
std::vector<double> filtered(const Motion& motion, int axis, std::size_t padded) {
  std::vector<double> signal(padded, 0.);
  for (std::size_t i = 0; i < motion.samples.size(); ++i) signal[i] = motion.samples[i][axis] / k_gal;
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, signal);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const std::size_t turn = std::min(k, padded - k);
    spectrum[k] *=
        intensity_filter(static_cast<double>(turn) / (static_cast<double>(padded) * motion.interval));
  }
  fft.inv(signal, spectrum);
  return signal;
}

}  // namespace

Motion floor_motion(const std::vector<Shake>& shakes, double duration) {
  Motion motion{.interval = k_interval, .samples = {}};
  const auto last = static_cast<std::size_t>(duration / k_interval * (1 + 1e-12));
  for (std::size_t i = 0; i <= last; ++i)
    motion.samples.push_back(floor_acceleration(shakes, static_cast<double>(i) * k_interval));
  return motion;
}

double peak(const Motion& motion) {
  double largest = 0;
  for (const Vec3& a : motion.samples) largest = std::max(largest, a.norm());
  return largest;
}

double intensity_filter(double f) {
  if (!(f > 0)) return 0;
  const double y = f * f / 100;
  const double high_cut =
      1 + y * (0.694 + y * (0.241 + y * (0.0557 + y * (0.009664 + y * (0.00134 + y * 0.000155)))));
  return std::sqrt(-std::expm1(-std::pow(f / 0.5, 3)) / (f * high_cut));
}

double intensity_acceleration(const Motion& motion) {
  const auto needed = static_cast<std::size_t>(std::llround(k_reached / motion.interval));
  if (motion.samples.size() < needed) return 0;
  const std::size_t padded =
      power_of_two_from(motion.samples.size() + static_cast<std::size_t>(k_silence / motion.interval));
  std::vector<double> size(padded, 0.);
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> component = filtered(motion, axis, padded);
    for (std::size_t i = 0; i < padded; ++i) size[i] = std::hypot(size[i], component[i]);
  }
  const auto place = size.begin() + static_cast<std::ptrdiff_t>(needed - 1);
  std::nth_element(size.begin(), place, size.end(), std::greater<>());
  return *place;
}

double instrumental_intensity(double a_gal) {
  const double intensity = 2 * std::log10(a_gal) + 0.94;
  if (!(intensity > 0)) return 0;
  const auto tenths = std::llround(100 * intensity) / 10;
  return static_cast<double>(tenths) / 10;
}

IntensityScale intensity_scale(double intensity) {
  constexpr double k_from[] = {0.5, 1.5, 2.5, 3.5, 4.5, 5.0, 5.5, 6.0, 6.5};
  return static_cast<IntensityScale>(std::upper_bound(std::begin(k_from), std::end(k_from), intensity) -
                                     std::begin(k_from));
}

}  // namespace topple::study
