#include <cmath>

#include "solver/model/body_builder.h"
#include "solver/model/cabinet.h"

namespace topple {
namespace {

constexpr int k_most_lines = 2000;

}  // namespace

BodyStart add_grid(Model& model, const GridSpec& spec) {
  BodyBuilder builder(model, spec.name);
  builder.body().ground = true;
  const Vec3 origin = spec.origin - model.sections[spec.section].width / 2 * spec.normal;
  const auto place = [&](double u, double v) { return Vec3(origin + u * spec.along + v * spec.up); };
  const int first = model.node_total();
  int lines = 0;
  for (int row = 0; row < 2; ++row) {
    const auto least = std::llround(std::ceil(spec.from[row] / spec.spacing - 1e-9)),
               most = std::llround(std::floor(spec.to[row] / spec.spacing + 1e-9));
    if (most - least >= k_most_lines) throw BuildError("spacing", "makes more lines than any floor has");
    for (auto k = least; k <= most; ++k) {
      const double at = static_cast<double>(k) * spec.spacing;
      const Vec3 a = row == 0 ? place(at, spec.from[1]) : place(spec.from[0], at);
      const Vec3 b = row == 0 ? place(at, spec.to[1]) : place(spec.to[0], at);
      builder.line("line-" + std::to_string(++lines), a, b, 1, 2, spec.section, spec.material, spec.normal);
    }
  }
  if (lines == 0) throw BuildError("spacing", "leaves no line within the extent");
  builder.add_material_mass();
  builder.close();
  for (int node = first; node < model.node_total(); ++node) model.supports.push_back({node, 0x3f});
  return {};
}

}  // namespace topple
