#include "solver/contact/contact_default.h"

#include <algorithm>
#include <cmath>

#include "solver/math/elementary.h"

namespace topple {
namespace {

constexpr double k_early_uplift = 0.02, k_landing = 0.02, k_depth = 0.01, k_knock = 1e-4, k_lean = 0.01;

struct Edge {
  double distance;  // m, of the centre of gravity
  int points;       // contact points on it
  double width;     // m, L of the first of them
};

Edge edge_of_base(const Model& model, const Body& body, const Plane& floor, std::size_t i) {
  const std::vector<Vec3>& polygon = body.support_polygon;
  const Vec3 along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
  const auto inside = [&](const Vec3& x) { return along.cross(x - polygon[i]).z(); };
  Edge edge{inside(body.centre_of_gravity), 0, 0};
  const double same_line = 1e-6 * std::abs(edge.distance);
  for (const int p : body.base_points) {
    const ContactPoint& point = model.contact_points[p];
    if (std::abs(inside(model.node_position[point.node])) > same_line) continue;
    if (edge.points++ == 0) edge.width = contact_length(point, floor);
  }
  return edge;
}

// Depths to which a body may sink, m.
double on_floor(const Edge& edge, double height) {
  const double b = edge.distance, slope = b / height;
  return std::min(b * slope * std::min(2 * k_early_uplift, k_landing * slope * slope), k_depth * edge.width);
}

double on_members(const Edge& edge, double height) {
  return std::min({k_knock * height, k_lean * edge.distance, k_depth * edge.width});
}

bool is_supported(const Model& model, int body) {
  return std::any_of(model.supports.begin(), model.supports.end(),
                     [&](const Support& support) { return model.node_body[support.node] == body; });
}

// The greatest of all edges of bases. depth(edge, height of the centre of gravity over it, m)
template <class Depth>
std::optional<double> greatest_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity,
                                     Depth depth) {
  constexpr double k_upright = 0.7;  // of the normal of a floor
  const auto floor = std::find_if(model.planes.begin(), model.planes.end(),
                                  [](const Plane& plane) { return plane.normal.z() > k_upright; });
  const bool of_beams =
      std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return body.ground; });
  if ((floor == model.planes.end() && !of_beams) || gravity.isZero(0)) return std::nullopt;
  const Plane face = floor == model.planes.end() ? Plane{"", Vec3::Zero(), Vec3::UnitZ(), 0} : *floor;
  std::optional<double> alpha;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const Body& body = model.bodies[b];
    if (body.support_polygon.empty() || is_supported(model, b)) continue;
    const double height = body.centre_of_gravity.z() - body.support_polygon.front().z();
    for (std::size_t i = 0; i < body.support_polygon.size(); ++i) {
      const Edge edge = edge_of_base(model, body, face, i);
      if (!(edge.distance > 0) || !(height > 0)) continue;
      const double each = body.mass * gravity.norm() / edge.points;
      alpha = std::max(alpha.value_or(0), each * elementary::pow(edge.width / depth(edge, height), law.q));
    }
  }
  return alpha;
}

}  // namespace

std::optional<double> rigid_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  return greatest_alpha(model, law, gravity, on_floor);
}

bool stands_for_hard_floor(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  constexpr double k_rounding = 1e-6;
  const std::optional<double> least = rigid_alpha(model, law, gravity);
  return least && law.alpha >= (1 - k_rounding) * *least;
}

std::optional<double> early_uplift(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  const auto needed = greatest_alpha(model, law, gravity, [](const Edge& edge, double height) {
    return 2 * k_early_uplift * edge.distance * edge.distance / height;
  });
  if (!needed) return std::nullopt;
  return k_early_uplift * elementary::pow(*needed / law.alpha, 1 / law.q);
}

std::optional<double> member_alpha(const Model& model, const ContactLaw& law, const Vec3& gravity) {
  return greatest_alpha(model, law, gravity, on_members);
}

}  // namespace topple
