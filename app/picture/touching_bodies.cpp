#include "app/picture/touching_bodies.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <set>

#include "app/picture/row.h"
#include "solver/contact/nearest_places.h"
#include "solver/contact/panel_place.h"
#include "solver/contact/proximity.h"
#include "solver/math/disjoint_sets.h"

namespace topple::app {
namespace {

/// An element or a panel that something touches.
struct TouchedPart {
  int part;
  std::size_t body;
  Vec3 force, place;             // on it; in the floor's frame
  std::vector<Vec3> corner;      // of its nodes
  std::set<std::size_t> others;  // touched parts that it touches
};

double distance(const TouchedPart& part, const Vec3& p) {
  const std::vector<Vec3>& c = part.corner;
  if (c.size() == 4) return nearest_on_panel(p, {c[0], c[1], c[2], c[3]}).between.norm();
  return nearest_points(p, c[0], c[1]).between.norm();
}

std::vector<TouchedPart> touched_parts(const Model& model, const io::FrameRow& row) {
  std::vector<TouchedPart> out;
  const auto add = [&](int part, const float* on, double u) {
    const Vec3 force(on[0], on[1], on[2]);
    if (force.isZero(0)) return;
    TouchedPart one{part, static_cast<std::size_t>(body_of(model, part)), force, Vec3::Zero(), {}, {}};
    each_share(model, part, on[3], u, [&](int node, double share) {
      one.corner.push_back(position(row, node));
      one.place += share * one.corner.back();
    });
    out.push_back(std::move(one));
  };
  const std::size_t elements = row.member_contact.size() / 4, panels = row.panel_contact.size() / 5;
  for (std::size_t e = 0; e < elements; ++e) add(static_cast<int>(e), &row.member_contact[4 * e], 0);
  for (std::size_t k = 0; k < panels; ++k)
    add(static_cast<int>(model.elements.size() + k), &row.panel_contact[5 * k], row.panel_contact[5 * k + 4]);
  return out;
}

/// Between two parts, elements or panels that an element's end is over.
double distance(const TouchedPart& a, const TouchedPart& b) {
  if (a.corner.size() == 4) return distance(b, a);
  if (b.corner.size() == 4) return std::min(distance(b, a.corner[0]), distance(b, a.corner[1]));
  return nearest_points(a.corner[0], a.corner[1], b.corner[0], b.corner[1]).between.norm();
}

/// Parts of different bodies that are as near as those that touch, or else nearest.
void join(const Model& model, std::vector<TouchedPart>& parts) {
  constexpr double k_slack = 1 + 1e-3;  // places of rows are floats
  const auto add = [&](std::size_t i, std::size_t j) {
    parts[i].others.insert(j);
    parts[j].others.insert(i);
  };
  const auto is_panel = [](const TouchedPart& part) { return part.corner.size() == 4; };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::size_t nearest = i;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (parts[j].body == parts[i].body || (is_panel(parts[i]) && is_panel(parts[j]))) continue;
      const double away =
          distance(parts[i], parts[j]) / contact_length(model, {std::min(parts[i].part, parts[j].part),
                                                                std::max(parts[i].part, parts[j].part)});
      if (away < k_slack) add(i, j);
      if (away < least) least = away, nearest = j;
    }
    if (nearest != i) add(i, nearest);
  }
}

/// The forces between parts that touch, the least that sum up to the resultant of each: differences of
/// potentials of the parts. f(part, other, force on part).
template <class F>
void each_pair(const std::vector<TouchedPart>& parts, F f) {
  const auto count = static_cast<int>(parts.size());
  std::vector<Eigen::Triplet<double>> sums;
  Eigen::MatrixX3d resultants(count, 3);
  DisjointSets sets(count);
  for (int i = 0; i < count; ++i) {
    resultants.row(i) = parts[i].force;
    sums.emplace_back(i, i, parts[i].others.size());
    for (const std::size_t j : parts[i].others) {
      sums.emplace_back(i, static_cast<int>(j), -1);
      sets.join(i, static_cast<int>(j));
    }
  }
  // Of what touches each other they sum up to nothing but rounding and, between rows, interpolation.
  Eigen::MatrixX3d surplus = Eigen::MatrixX3d::Zero(count, 3);
  Eigen::VectorXd members = Eigen::VectorXd::Zero(count);
  for (int i = 0; i < count; ++i) {
    surplus.row(sets.first_of(i)) += resultants.row(i);
    ++members[sets.first_of(i)];
  }
  for (int i = 0; i < count; ++i) {
    const int first = sets.first_of(i);
    resultants.row(i) -= surplus.row(first) / members[first];
  }
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(sums.begin(), sums.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(graph);
  solver.setTolerance(1e-6);  // resultants of rows are floats: less is not there to be found
  const Eigen::MatrixX3d potential = solver.solve(resultants);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const std::size_t j : parts[i].others) f(i, j, Vec3(potential.row(i) - potential.row(j)));
}

void add(BodyTouch& touch, const Vec3& force, const Vec3& place, double& weight) {
  const double size = force.norm();
  if (!(size > 0)) return;
  weight += size;
  touch.force += force;
  touch.place += size / weight * (place - touch.place);
}

}  // namespace

bool any_force(const std::vector<float>& of, int first, int count, int stride) {
  const auto begin = std::min(of.size(), static_cast<std::size_t>(first * stride)),
             end = std::min(of.size(), static_cast<std::size_t>((first + count) * stride));
  return std::any_of(of.begin() + static_cast<std::ptrdiff_t>(begin),
                     of.begin() + static_cast<std::ptrdiff_t>(end), [](float f) { return f != 0; });
}

bool touches_another(const Body& body, const io::FrameRow& row) {
  return any_force(row.member_contact, body.first_element, body.element_count, 4) ||
         any_force(row.panel_contact, body.first_panel, body.panel_count, 5);
}

std::vector<BodyTouch> touches(const Model& model, const io::FrameRow& row, std::size_t body) {
  const Body& own = model.bodies[body];
  const std::size_t planes = model.planes.size();
  std::vector<BodyTouch> all;
  for (const Plane& plane : model.planes) all.push_back({plane.name});
  for (const Body& other : model.bodies) all.push_back({other.name});
  std::vector<double> weight(all.size(), 0);
  for (std::size_t c = 0; c < model.contact_points.size() * planes; ++c) {
    const int node = model.contact_points[c / planes].node;
    if (node < own.first_node || node >= own.first_node + own.node_count) continue;
    const float* const on = &row.contact_force[3 * c];
    add(all[c % planes], Vec3(on[0], on[1], on[2]), position(row, node), weight[c % planes]);
  }
  std::vector<TouchedPart> parts = touched_parts(model, row);
  join(model, parts);
  each_pair(parts, [&](std::size_t i, std::size_t j, const Vec3& force) {
    const std::size_t other = planes + parts[j].body;
    if (parts[i].body == body) add(all[other], force, parts[i].place, weight[other]);
  });
  std::vector<BodyTouch> out;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (weight[k] > 0) out.push_back(std::move(all[k]));
  return out;
}

}  // namespace topple::app
