#include "solver/reduced/tipping.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/math/elementary.h"
#include "solver/math/ranges.h"
#include "solver/model/excitation.h"
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

// Nodes of the base, counted from the first of the body.
std::vector<int> base_nodes(const Model& model, const Body& body) {
  std::vector<int> nodes;
  for (const int point : body.base_points)
    nodes.push_back(model.contact_points[point].node - body.first_node);
  ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<int> nodes_on(const Model& model, const Body& body, const TippingEdge& edge) {
  constexpr double k_on_edge = 1e-3;  // of the reach
  std::vector<int> nodes = base_nodes(model, body);
  std::erase_if(nodes, [&](int node) {
    const Vec3& x = model.node_position[body.first_node + node];
    return std::abs(edge.outward.dot(x - edge.start)) > k_on_edge * body.reach;
  });
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
    const auto n = static_cast<Eigen::Index>(nodes.size());
    const VectorXd forces = force.replicate(n, 1), turns = turn.replicate(n, 1);
    const double change = turns.dot(flexibility(*body.elastic, nodes) * forces);
    greatest = std::max(greatest, std::abs(change) / edge.angle());
  });
  return greatest;
}

// Of the deflection b that the weight on the feet has across, held by forces f = C^-1 b: b C^-1 b / 2.
double splay_energy(const Model& model, int index, double gravity) {
  const Body& body = model.bodies[index];
  const std::vector<int> nodes = base_nodes(model, body);
  if (!body.elastic || nodes.empty()) return 0;
  const Eigen::MatrixXd all = flexibility(*body.elastic, nodes);
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd across(2 * n, 2 * n);
  VectorXd spread = VectorXd::Zero(2 * n);
  const double weight = body.mass * gravity / static_cast<double>(n);  // on each
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      across.block<2, 2>(2 * i, 2 * j) = all.block<2, 2>(3 * i, 3 * j);
      spread.segment<2>(2 * i) += weight * all.block<2, 1>(3 * i, 3 * j + 2);
    }
  return spread.dot(across.completeOrthogonalDecomposition().solve(spread)) / 2;
}

double rigid_error(const Model& model, const Parameters& parameters, int index) {
  const Body& body = model.bodies[index];
  const double angle = least_tipping_angle(body), gravity = parameters.gravity.norm();
  if (!body.elastic || !(angle < std::numeric_limits<double>::infinity())) return 0;
  const ContactLaw law = gripped(parameters.contact, body.grip);
  const double floor = greatest_acceleration(parameters.shakes);
  const double friction = std::max(law.friction, law.friction_static);
  const double passed = std::min(floor, friction * gravity);
  const double height = body.centre_of_gravity.z() - body.support_polygon.front().z();
  const double sway = passed / (body.elastic->frequency[0] * body.elastic->frequency[0]) / (height * angle);
  const bool stays = floor > 0 && floor < gravity * std::min(friction, elementary::tan(angle));
  if (stays) return sway;
  const double barrier = body.mass * gravity * height / elementary::cos(angle) * (1 - elementary::cos(angle));
  return std::max(
      {sway, tipping_error(model, index, gravity), std::sqrt(splay_energy(model, index, gravity) / barrier)});
}

}  // namespace topple
