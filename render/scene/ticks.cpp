#include "render/scene/ticks.h"

#include <algorithm>
#include <cmath>

namespace topple::render {

Ticks nice_ticks(double minimum, double maximum, int count) {
  const double rough = (maximum - minimum) / std::max(count, 1);
  if (!(rough > 0) || !std::isfinite(rough)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  Ticks ticks;
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double first = std::ceil(minimum / step - 1e-6);
  const double last = std::floor(maximum / step + 1e-6);
  for (double n = first; n <= last && ticks.values.size() <= 100; ++n) ticks.values.push_back(n * step);
  return ticks;
}

Ticks root_ticks(double maximum) {
  Ticks ticks;
  if (!(maximum > 0) || !std::isfinite(maximum)) return ticks;
  constexpr double k_apart = 0.12;  // of the bar, least
  double last = 1 + k_apart;
  double power = std::pow(10.0, std::floor(std::log10(maximum)));
  for (int decade = 0; decade < 4; ++decade, power /= 10) {
    for (const double factor : {5.0, 2.0, 1.0}) {
      const double share = std::sqrt(factor * power / maximum);
      if (factor * power > maximum || last - share < k_apart || share < k_apart) continue;
      ticks.values.push_back(factor * power);
      last = share;
    }
  }
  ticks.values.push_back(0);
  return ticks;
}

}  // namespace topple::render
