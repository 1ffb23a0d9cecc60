#include "solver/reduced/elastic_basis.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "solver/element/beam.h"
#include "solver/element/plasticity.h"
#include "solver/element/section_forces.h"
#include "solver/frame/modes.h"
#include "solver/math/block_lu.h"
#include "solver/math/elementary.h"

namespace topple {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double k_rounding = 1e-9;  // relative: more than what one body in two places differs by
constexpr double k_shift =
    1e-6;  // of the lowest w^2: makes K regular, and changes no residual more than that

// Section forces at the stress points of small displacements in columns, six rows per node.
MatrixXd recover(const Model& model, const Body& body, const MatrixXd& u) {
  MatrixXd out(6 * body.element_count, u.cols());
  for (int e = 0; e < body.element_count; ++e) {
    const Element& element = model.elements[body.first_element + e];
    const int i = 6 * (element.node[0] - body.first_node), j = 6 * (element.node[1] - body.first_node);
    const double t = (1 + element.s) / 2;
    const Mat3 local = element.triad.transpose();
    const auto rows = [&](int r) { return u.middleRows<3>(r); };
    MatrixXd gamma = local * (rows(j) - rows(i)) / element.length;
    const MatrixXd turn = local * ((1 - t) * rows(i + 3) + t * rows(j + 3));
    gamma.row(1) -= turn.row(2);
    gamma.row(2) += turn.row(1);
    const MatrixXd kappa = local * (rows(j + 3) - rows(i + 3)) / element.length;
    out.middleRows<3>(6 * e) = element.normal_stiffness.asDiagonal() * gamma;
    out.middleRows<3>(6 * e + 3) = element.bending_stiffness.asDiagonal() * kappa;
  }
  return out;
}

// Per column, the greatest f(element, section forces) at an end of an element.
template <class F>
VectorXd greatest_at_ends(const Model& model, const Body& body, const MatrixXd& sections, F f) {
  VectorXd out = VectorXd::Zero(sections.cols());
  for (int c = 0; c < sections.cols(); ++c)
    for (int e = 0; e < body.element_count; ++e) {
      const Element& element = model.elements[body.first_element + e];
      const SectionForces forces{sections.block<3, 1>(6 * e, c), sections.block<3, 1>(6 * e + 3, c)};
      for (const int end : {-1, 1})
        out[c] = std::max(out[c], f(element, forces_along(forces, element.length, element.s, end)));
    }
  return out;
}

MatrixXd mass_times(const Model& model, const Body& body, const MatrixXd& v) {
  MatrixXd out(v.rows(), v.cols());
  for (int i = 0; i < body.node_count; ++i) {
    out.middleRows<3>(6 * i) = model.node_mass[body.first_node + i] * v.middleRows<3>(6 * i);
    out.middleRows<3>(6 * i + 3) = model.node_inertia[body.first_node + i] * v.middleRows<3>(6 * i + 3);
  }
  return out;
}

// K + shift M about the reference pose, factored.
BlockLu shifted_stiffness(const Model& model, const Body& body, double shift) {
  std::vector<std::pair<int, int>> edges;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
    edges.emplace_back(model.elements[e].node[0] - body.first_node,
                       model.elements[e].node[1] - body.first_node);
  BlockLu lu(body.node_count, edges);
  lu.set_zero();
  for (int e = 0; e < body.element_count; ++e) {
    const Mat12 tangent = beam_stiffness(model, model.elements[body.first_element + e]);
    const auto [i, j] = edges[e];
    lu.add(i, i, tangent.block<6, 6>(0, 0));
    lu.add(i, j, tangent.block<6, 6>(0, 6));
    lu.add(j, i, tangent.block<6, 6>(6, 0));
    lu.add(j, j, tangent.block<6, 6>(6, 6));
  }
  for (int i = 0; i < body.node_count; ++i) {
    Mat6 block = Mat6::Zero();
    block.diagonal().head<3>().setConstant(shift * model.node_mass[body.first_node + i]);
    block.bottomRightCorner<3, 3>() = shift * model.node_inertia[body.first_node + i];
    lu.add(i, i, block);
  }
  lu.factor();
  return lu;
}

template <class A, class B>
bool near(const A& a, const B& b, double size) {
  return (a - b).cwiseAbs().maxCoeff() <= k_rounding * size;
}

// Whether elements e and f of bodies a and b have the same place in them.
bool same_element(const Element& e, const Body& a, const Element& f, const Body& b) {
  return e.node[0] - a.first_node == f.node[0] - b.first_node &&
         e.node[1] - a.first_node == f.node[1] - b.first_node && e.s == f.s && near(e.triad, f.triad, 1) &&
         e.normal_stiffness == f.normal_stiffness && e.bending_stiffness == f.bending_stiffness &&
         e.capacity == f.capacity && e.hinge_place[0] == f.hinge_place[0] &&
         e.hinge_place[1] == f.hinge_place[1];
}

// Whether b is a in another place.
bool same_body(const Model& model, const Body& a, const Body& b) {
  if (a.node_count != b.node_count || a.element_count != b.element_count) return false;
  for (int i = 0; i < a.node_count; ++i) {
    const int g = a.first_node + i, h = b.first_node + i;
    const Vec3 at = model.node_position[g] - model.node_position[a.first_node];
    if (!near(at, model.node_position[h] - model.node_position[b.first_node], a.reach) ||
        std::abs(model.node_mass[g] - model.node_mass[h]) > k_rounding * a.mass ||
        !near(model.node_inertia[g], model.node_inertia[h], a.inertia.norm()))
      return false;
  }
  for (int e = 0; e < a.element_count; ++e)
    if (!same_element(model.elements[a.first_element + e], a, model.elements[b.first_element + e], b))
      return false;
  return true;
}

// What follows from the shapes.
void complete(const Model& model, const Body& body, ElasticBasis& basis) {
  basis.section = recover(model, body, basis.shape);
  basis.residual_section = recover(model, body, basis.residual_shape);
  const auto yield = [](const Element& element, const SectionForces& forces) {
    return std::isfinite(element.capacity[0]) ? std::sqrt(yield_function(element, forces) + 1) : 0;
  };
  const auto stress = [&](const Element& element, const SectionForces& forces) {
    return equivalent_stress(model.sections[model.members[element.member].section], forces);
  };
  basis.mode_yield = greatest_at_ends(model, body, basis.section, yield);
  basis.residual_yield = greatest_at_ends(model, body, basis.residual_section, yield);
  basis.mode_stress = greatest_at_ends(model, body, basis.section, stress);
  basis.residual_stress = greatest_at_ends(model, body, basis.residual_section, stress);
  MatrixXd at_rest = basis.residual_section;
  const VectorXd soft = basis.frequency.head(basis.modes).square().inverse();
  for (int i = 0; i < body.node_count; ++i)
    at_rest.middleCols<3>(3 * i) +=
        basis.section * soft.asDiagonal() * basis.shape.middleRows<3>(6 * i).transpose();
  basis.rest_stress = greatest_at_ends(model, body, at_rest, stress);
  basis.mode_rotation = VectorXd::Zero(basis.modes);
  for (int k = 0; k < basis.modes; ++k)
    for (int i = 0; i < body.node_count; ++i)
      basis.mode_rotation[k] = std::max(basis.mode_rotation[k], basis.shape.block<3, 1>(6 * i + 3, k).norm());
}

}  // namespace

std::shared_ptr<const ElasticBasis> elastic_basis(const Model& model, int index) {
  const Body& body = model.bodies[index];
  for (const Support& support : model.supports)
    if (model.node_body[support.node] == index) return nullptr;
  for (int other = index; other-- > 0;)
    if (model.bodies[other].elastic && same_body(model, model.bodies[other], body))
      return model.bodies[other].elastic;
  constexpr int k_rigid = 6;
  const std::vector<Mode> modes = natural_modes(model, index, k_rigid + k_modes);
  const auto rigid = std::count_if(modes.begin(), modes.end(), [](const Mode& mode) { return mode.rigid; });
  if (rigid != k_rigid || static_cast<int>(modes.size()) <= k_rigid) return nullptr;

  auto basis = std::make_shared<ElasticBasis>();
  const int n = body.node_count;
  basis->modes = static_cast<int>(modes.size()) - k_rigid;
  basis->frequency.setZero();
  MatrixXd all(6 * n, modes.size());
  for (std::size_t c = 0; c < modes.size(); ++c)
    for (int i = 0; i < n; ++i) {
      all.block<3, 1>(6 * i, c) = modes[c].displacement[i];
      all.block<3, 1>(6 * i + 3, c) = modes[c].rotation[i];
    }
  basis->shape = all.rightCols(basis->modes);
  for (int k = 0; k < basis->modes; ++k) basis->frequency[k] = 2 * k_pi * modes[k_rigid + k].frequency;

  const BlockLu lu = shifted_stiffness(model, body, k_shift * elementary::pow(basis->frequency[0], 2));
  const MatrixXd mass_all = mass_times(model, body, all);
  MatrixXd& residual = basis->residual_shape;
  residual = MatrixXd::Zero(6 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) residual(6 * i + k, 3 * i + k) = 1;
  residual -= mass_all * (all.transpose() * residual).eval();
  for (int c = 0; c < residual.cols(); ++c) lu.solve(residual.col(c).data());
  residual -= all * (mass_all.transpose() * residual).eval();
  complete(model, body, *basis);
  basis->beyond = basis->residual_stress.cwiseQuotient(basis->rest_stress);
  for (int i = 0; i < n; ++i)
    basis->beyond.segment<3>(3 * i).array() *= residual.block<3, 3>(6 * i, 3 * i).diagonal().array();
  return basis;
}

namespace {

/// On a node of a body, reference axes.
struct UnitForce {
  int node;  ///< of the body
  Vec3 along;
};

// Of its first anchors along their lines, then of the floor on the corners of its base; none: nothing holds
// it.
std::vector<UnitForce> unit_forces(const Model& model, int index) {
  constexpr std::size_t k_anchors = 2, k_corners = 4;
  const Body& body = model.bodies[index];
  std::vector<UnitForce> forces;
  for (const Anchor& anchor : model.anchors) {
    if (!(anchor.length > 0)) continue;
    const Vec3 point = model.node_position[anchor.node] + anchor.arm;
    for (const AnchorEnd& end : {anchor.own(), anchor.other})
      if (end.body == index && forces.size() < k_anchors)
        forces.push_back({end.node - body.first_node, (point - anchor.to).normalized()});
  }
  if (forces.empty()) return forces;
  const auto node_of = [&](int point) { return model.contact_points[point].node; };
  Vec3 middle = Vec3::Zero();
  for (const int point : body.base_points)
    middle += model.node_position[node_of(point)] / static_cast<double>(body.base_points.size());
  double reach = 0;
  const auto away = [&](int point) { return (model.node_position[node_of(point)] - middle).norm(); };
  for (const int point : body.base_points) reach = std::max(reach, away(point));
  std::size_t corners = 0;
  for (const int point : body.base_points)
    if (away(point) > (1 - k_rounding) * reach && corners++ < k_corners)
      forces.push_back({node_of(point) - body.first_node, Vec3::UnitZ()});
  return forces;
}

}  // namespace

std::shared_ptr<const ElasticBasis> with_attachments(const Model& model, int index) {
  constexpr double k_independent = 1e-6;  // of a shape's square, what others leave of it
  const Body& body = model.bodies[index];
  const std::vector<UnitForce> all = unit_forces(model, index);
  if (all.empty()) return body.elastic;
  auto basis = std::make_shared<ElasticBasis>(*body.elastic);
  // what a shape of this frequency gives is residual, or no more
  const auto move_to_residual = [&](const VectorXd& shape, double frequency, double sign) {
    VectorXd moves(shape.size() / 2);
    for (Eigen::Index i = 0; i < shape.size() / 6; ++i) moves.segment<3>(3 * i) = shape.segment<3>(6 * i);
    basis->residual_shape += sign / (frequency * frequency) * shape * moves.transpose();
  };
  const int kept = std::min(basis->modes, k_modes - static_cast<int>(all.size()));
  for (int k = kept; k < basis->modes; ++k) move_to_residual(basis->shape.col(k), basis->frequency[k], 1);

  MatrixXd shapes(basis->shape.rows(), 0), mass_shapes = shapes;
  std::vector<UnitForce> forces;
  for (const UnitForce& force : all) {
    const VectorXd shape = basis->residual_shape.middleCols<3>(3 * force.node) * force.along,
                   mass_shape = mass_times(model, body, shape);
    const double whole = shape.dot(mass_shape);
    double left = whole;
    if (shapes.cols() > 0) {
      const VectorXd shared = mass_shapes.transpose() * shape;
      left -= shared.dot((mass_shapes.transpose() * shapes).ldlt().solve(shared));
    }
    if (!(left > k_independent * whole)) continue;
    const Eigen::Index n = shapes.cols();
    shapes.conservativeResize(Eigen::NoChange, n + 1);
    mass_shapes.conservativeResize(Eigen::NoChange, n + 1);
    shapes.col(n) = shape;
    mass_shapes.col(n) = mass_shape;
    forces.push_back(force);
  }
  const auto added = static_cast<int>(forces.size());
  if (added == 0) return body.elastic;
  MatrixXd compliance(added, added);
  for (int i = 0; i < added; ++i)
    for (int k = 0; k < added; ++k)
      compliance(i, k) = forces[i].along.dot(shapes.block<3, 1>(6 * forces[i].node, k));
  const MatrixXd mass = mass_shapes.transpose() * shapes;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> ritz((compliance + compliance.transpose()) / 2,
                                                                (mass + mass.transpose()) / 2);
  basis->modes = kept + added;
  basis->shape.conservativeResize(Eigen::NoChange, basis->modes);
  basis->shape.rightCols(added) = shapes * ritz.eigenvectors();
  basis->frequency.tail(k_modes - kept).setZero();
  for (int k = 0; k < added; ++k) {
    basis->frequency[kept + k] = std::sqrt(ritz.eigenvalues()[k]);
    move_to_residual(basis->shape.col(kept + k), basis->frequency[kept + k], -1);
  }
  complete(model, body, *basis);
  return basis;
}

double first_frequency(const Model& model, int body) {
  if (const ElasticBasis* basis = model.bodies[body].elastic.get()) return basis->frequency[0];
  constexpr int k_rigid = 6;
  constexpr double k_slow = 0.02;  // of g/reach
  const double slowest = std::sqrt(k_slow * k_standard_gravity / model.bodies[body].reach);
  for (const Mode& mode : natural_modes(model, body, k_rigid + 1))
    if (const double frequency = 2 * k_pi * mode.frequency; !mode.rigid && frequency > slowest)
      return frequency;
  return 0;
}

MatrixXd flexibility(const ElasticBasis& basis, const std::vector<int>& nodes) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  MatrixXd shape(3 * n, basis.modes), out(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    shape.middleRows<3>(3 * i) = basis.shape.middleRows<3>(6 * nodes[i]);
    for (Eigen::Index j = 0; j < n; ++j)
      out.block<3, 3>(3 * i, 3 * j) = basis.residual_shape.block<3, 3>(6 * nodes[i], 3 * nodes[j]);
  }
  const Eigen::ArrayXd soft = basis.frequency.head(basis.modes).square().inverse();
  return out + shape * soft.matrix().asDiagonal() * shape.transpose();
}

Vec3 anchor_shape(const Model& model, const AnchorEnd& end, int mode) {
  const Body& body = model.bodies[end.body];
  const auto of_node = body.elastic->shape.col(mode).segment<6>(6 * (end.node - body.first_node));
  return of_node.head<3>() + of_node.tail<3>().cross(end.arm);
}

}  // namespace topple
