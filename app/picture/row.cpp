#include "app/picture/row.h"

namespace topple::app {

SectionForces forces_at(const Model& model, const io::FrameRow& row, std::size_t e, double xi) {
  const float* f = &row.section_force[6 * e];
  return forces_along({{f[0], f[1], f[2]}, {f[3], f[4], f[5]}}, model.elements[e].length, row.s[e], xi);
}

Vec3 ElementCurve::place(double t) const {
  const double span = (x2 - x1).norm(), t2 = t * t, t3 = t2 * t;
  const Vec3 d1 = span * (q1 * Vec3::UnitX()), d2 = span * (q2 * Vec3::UnitX());
  return (2 * t3 - 3 * t2 + 1) * x1 + (t3 - 2 * t2 + t) * d1 + (3 * t2 - 2 * t3) * x2 + (t3 - t2) * d2;
}

ElementCurve element_curve(const Model& model, const io::FrameRow& row, std::size_t e) {
  const Element& element = model.elements[e];
  const Quat triad(element.triad);
  const Vec3 shift = floor_shift(row);
  return {.x1 = position(row, element.node[0]) + shift,
          .x2 = position(row, element.node[1]) + shift,
          .q1 = rotation(row, element.node[0]) * triad,
          .q2 = rotation(row, element.node[1]) * triad,
          .length = element.length};
}

}  // namespace topple::app
