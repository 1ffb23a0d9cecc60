#include "bench/engines/block.h"

#include <limits>
#include <memory>

namespace topple::bench {

Simulation stepped(const Case& c, double h, std::function<bool(double)> step, std::function<double()> tilt) {
  const long settling = std::lround(-c.begin() / h);
  bool going = true;
  for (long k = 0; k < settling && going; ++k) going = step(0);
  auto count = std::make_shared<long>(0);
  return {[c, h, going, count, step = std::move(step)] {
            const double t = static_cast<double>(*count) * h;
            if (!going || !step(c.floor_acceleration(t + h / 2)))
              return std::numeric_limits<double>::quiet_NaN();
            return static_cast<double>(++*count) * h;
          },
          std::move(tilt)};
}

}  // namespace topple::bench
