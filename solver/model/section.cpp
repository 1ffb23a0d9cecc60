#include "solver/model/section.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/math/elementary.h"
#include "solver/math/types.h"

namespace topple {
namespace {

struct Inertia {
  double area, iy, iz;
};

Inertia rectangle(double b, double h) {
  return {b * h, b * h * h * h / 12, h * b * b * b / 12};
}

// Plastic modulus of a rectangle bent across its height h.
double rectangle_plastic(double b, double h) {
  return b * h * h / 4;
}

// Saint-Venant torsion of a solid rectangle, Fourier series (Timoshenko & Goodier, Theory of Elasticity, art.
// 109).
double rectangle_torsion(double a, double b) {
  if (a < b) std::swap(a, b);
  double sum = 0;
  for (int n = 1; n < 40; n += 2)
    sum += (1 - 2 / (elementary::exp(n * k_pi * a / b) + 1)) / elementary::pow(n, 5);
  return a * b * b * b * (1. / 3 - 64 / elementary::pow(k_pi, 5) * b / a * sum);
}

// Shear coefficients after Cowper (1966). Box: thin-walled rectangular tube of uniform wall, web height along
// the shear force m = flange width / web height.
double box_shear(double poisson, double along, double across) {
  const double m = across / along, n = poisson;
  return 10 * (1 + n) * elementary::pow(1 + 3 * m, 2) /
         ((12 + 72 * m + 150 * m * m + 90 * m * m * m) + n * (11 + 66 * m + 135 * m * m + 90 * m * m * m) +
          10 * m * m * ((3 + n) * m + 3 * m * m));
}

// n: Poisson's ratio.
void complete_box(Section& section, double n) {
  const double a = section.size_y, b = section.size_z, t = section.thickness;
  const Inertia outer = rectangle(a, b), inner = rectangle(a - 2 * t, b - 2 * t);
  section.area = outer.area - inner.area;
  section.iy = outer.iy - inner.iy;
  section.iz = outer.iz - inner.iz;
  section.j = 2 * t * (a - t) * (a - t) * (b - t) * (b - t) / (a + b - 2 * t);
  section.ky = box_shear(n, a - t, b - t);
  section.kz = box_shear(n, b - t, a - t);
  section.zy = rectangle_plastic(a, b) - rectangle_plastic(a - 2 * t, b - 2 * t);
  section.zz = rectangle_plastic(b, a) - rectangle_plastic(b - 2 * t, a - 2 * t);
  section.zt = 2 * (a - t) * (b - t) * t;
}

void complete_solid(Section& section, double n) {
  const double a = section.size_y, b = section.size_z;
  const Inertia outer = rectangle(a, b);
  section.area = outer.area;
  section.iy = outer.iy;
  section.iz = outer.iz;
  section.j = rectangle_torsion(a, b);
  section.ky = section.kz = 10 * (1 + n) / (12 + 11 * n);
  section.zy = rectangle_plastic(a, b);
  section.zz = rectangle_plastic(b, a);
  section.zt = std::min(a, b) * std::min(a, b) * (3 * std::max(a, b) - std::min(a, b)) / 6;
}

void complete_pipe(Section& section, double n) {
  const double a = section.size_y, t = section.thickness;
  const double outer = a / 2, inner = outer - t, m = inner / outer, m2 = 1 + m * m;
  section.size_z = a;
  section.area = k_pi * (outer * outer - inner * inner);
  section.iy = section.iz = k_pi / 4 * (elementary::pow(outer, 4) - elementary::pow(inner, 4));
  section.j = 2 * section.iy;
  section.ky = section.kz = 6 * (1 + n) * m2 * m2 / ((7 + 6 * n) * m2 * m2 + (20 + 12 * n) * m * m);
  section.zy = section.zz = 4. / 3 * (elementary::pow(outer, 3) - elementary::pow(inner, 3));
  section.zt = k_pi / 2 * section.zy;
}

constexpr SectionTraits k_section_shapes[] = {
    {Section::Shape::box, "box", false, true, complete_box},
    {Section::Shape::solid, "solid", false, false, complete_solid},
    {Section::Shape::pipe, "pipe", true, true, complete_pipe},
    {Section::Shape::custom, "custom", false, false, nullptr},
};

}  // namespace

std::span<const SectionTraits> section_shapes() {
  return k_section_shapes;
}

void complete_section(Section& section, double poisson) {
  const auto complete = traits(section.shape).complete;
  if (!complete) return;
  complete(section, poisson);
  section.width = (section.size_y + section.size_z) / 2;
}

}  // namespace topple
