#include "solver/reduced/tipping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/math/elementary.h"
#include "solver/reduced/elastic_basis.h"

namespace topple {
namespace {

using Eigen::VectorXd;

struct TippingEdge {
  Vec3 start, outward;   // m; unit, horizontal
  double depth, height;  // m, from the edge to the centre of gravity
  double angle() const { return elementary::atan2(depth, height); }
};

// Calls f on every edge that the centre of gravity stands within.
template <class F>
void each_edge(const Body& body, F f) {
  const std::vector<Vec3>& polygon = body.support_polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 edge = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec3 outward = Vec3(edge.y(), -edge.x(), 0).normalized();
    const Vec3 arm = polygon[i] - body.centre_of_gravity;
    if (outward.dot(arm) > 0) f(TippingEdge{polygon[i], outward, outward.dot(arm), -arm.z()});
  }
}

// Nodes of the base on an edge, counted from the first of the body.
std::vector<int> nodes_on(const Model& model, const Body& body, const TippingEdge& edge) {
  constexpr double k_on_edge = 1e-3;  // of the reach
  std::vector<int> nodes;
  for (const int point : body.base_points) {
    const int node = model.contact_points[point].node;
    if (std::abs(edge.outward.dot(model.node_position[node] - edge.start)) < k_on_edge * body.reach)
      nodes.push_back(node - body.first_node);
  }
  return nodes;
}

}  // namespace

double least_tipping_angle(const Body& body) {
  double least = std::numeric_limits<double>::infinity();
  each_edge(body, [&](const TippingEdge& edge) { least = std::min(least, edge.angle()); });
  return least;
}

double tipping_error(const Model& model, int index, double gravity) {
  const Body& body = model.bodies[index];
  if (!body.elastic) return 0;
  const ElasticBasis& basis = *body.elastic;
  const auto frequency = basis.frequency.head(static_cast<Eigen::Index>(basis.modes));
  double greatest = 0;
  each_edge(body, [&](const TippingEdge& edge) {
    const std::vector<int> nodes = nodes_on(model, body, edge);
    if (nodes.empty()) return;
    // the floor's force on each, through the centre of gravity, and how much the angle changes by the travel
    // of each
    const double share = 1 / static_cast<double>(nodes.size());
    const double radius = elementary::hypot(edge.depth, edge.height);
    const Vec3 force =
        share * body.mass * gravity / radius * (edge.height * Vec3::UnitZ() - edge.depth * edge.outward);
    const Vec3 turn = share / (radius * radius) * (edge.height * edge.outward + edge.depth * Vec3::UnitZ());
    const auto at_nodes = [&](const Vec3& of_each) {
      VectorXd all = VectorXd::Zero(6 * body.node_count);
      for (const int node : nodes) all.segment<3>(6 * node) = of_each;
      return all;
    };
    const VectorXd forces = at_nodes(force), turns = at_nodes(turn);
    double change = ((basis.shape.transpose() * forces).array() * (basis.shape.transpose() * turns).array() /
                     frequency.square())
                        .sum();
    for (const int node : nodes) change += turns.dot(basis.residual_shape.middleCols<3>(3 * node) * force);
    greatest = std::max(greatest, std::abs(change) / edge.angle());
  });
  return greatest;
}

}  // namespace topple
