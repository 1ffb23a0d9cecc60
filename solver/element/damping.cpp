#include "solver/element/damping.h"

#include <algorithm>

#include "solver/body/elastic_basis.h"
#include "solver/frame/modes.h"

namespace topple {

double first_frequency(const Model& model, int body) {
  if (const ElasticBasis* basis = model.bodies[body].elastic.get()) return basis->frequency[0];
  constexpr int k_rigid = 6;
  const std::vector<Mode> modes = natural_modes(model, body, k_rigid + 1);
  const auto first = std::find_if(modes.begin(), modes.end(), [](const Mode& mode) { return !mode.rigid; });
  return first == modes.end() ? 0 : 2 * k_pi * first->frequency;
}

}  // namespace topple
