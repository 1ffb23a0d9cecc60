#include "solver/contact/contact_period.h"

#include <algorithm>
#include <cmath>

#include "solver/math/elementary.h"

namespace topple {

double contact_period(const Model& model, int index, const ContactLaw& law, const Vec3& gravity) {
  const Body& body = model.bodies[index];
  if (model.planes.empty() || gravity.isZero(0) || body.contact_point_count == 0) return 0;
  const double points = static_cast<double>(std::max<std::size_t>(1, body.base_points.size()));
  const double L = contact_length(model.contact_points[body.first_contact_point], model.planes.front()),
               g = gravity.norm();
  const double depth = elementary::pow(body.mass * g / (points * law.alpha), 1 / law.q);
  return 2 * k_pi * std::sqrt(L * depth / (law.q * g));
}

double contact_period(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  double longest = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    longest = std::max(longest, contact_period(model, b, law, gravity));
  return longest;
}

}  // namespace topple
