#include "solver/element/plasticity.h"

#include <cmath>

namespace topple {
namespace {

constexpr int k_most_iterations = 60;
constexpr double k_converged = 1e-15;  // of the loading: rounding
// of f: a state that a step before left on the surface starts the next one as elastic, or Newton's first
// correction would be that of a mechanism
constexpr double k_on_surface = 1e-12;

Vec4 flowing(const Vec3& normal, const Vec3& moment) {
  return {normal.x(), moment.x(), moment.y(), moment.z()};
}

// From the elastic stress point to the hinge, m.
double arm(const Element& element, Hinge hinge) {
  return element.length / 2 * (hinge_place(element, hinge) + element.s);
}

Vec4 stiffness_at(const Element& element, double arm) {
  const Vec3 &n = element.normal_stiffness, &m = element.bending_stiffness;
  return {n.x(), m.x(), m.y() + arm * arm * n.z(), m.z() + arm * arm * n.y()};
}

BeamStrain flow_of(const Element& element, Hinge hinge, const PlasticReturn& point) {
  const Vec4 flow =
      2 * point.multiplier * point.forces.cwiseQuotient(element.capacity.cwiseProduct(element.capacity));
  const double a = arm(element, hinge);
  return {{flow[0], -a * flow[3], a * flow[2]}, flow.tail<3>()};
}

}  // namespace

double yield_function(const Vec4& forces, const Vec4& capacity) {
  return forces.cwiseQuotient(capacity).squaredNorm() - 1;
}

double yield_function(const Element& element, const SectionForces& forces) {
  return yield_function(flowing(forces.normal, forces.moment), element.capacity);
}

PlasticReturn return_to_yield(const Vec4& trial, const Vec4& stiffness, const Vec4& capacity) {
  const Vec4 loading = trial.cwiseQuotient(capacity);
  const Vec4 softening = 2 * stiffness.cwiseQuotient(capacity.cwiseProduct(capacity));
  PlasticReturn out{trial, 0};
  if (!(loading.squaredNorm() > 1 + k_on_surface)) return out;
  Vec4 shrink = Vec4::Ones();
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    const Vec4 u = loading.cwiseProduct(shrink);
    const double square = u.squaredNorm(), size = std::sqrt(square);
    const double slope = u.dot(u.cwiseProduct(softening).cwiseProduct(shrink)) / (square * size);
    const double step = (1 - 1 / size) / slope;
    out.multiplier += step;
    shrink = (Vec4::Ones() + out.multiplier * softening).cwiseInverse();
    if (!(std::abs(1 - size) > k_converged)) break;
  }
  out.forces = trial.cwiseProduct(shrink);
  return out;
}

Mat4 plastic_tangent(const PlasticReturn& point, const Vec4& stiffness, const Vec4& capacity) {
  const Vec4 square = capacity.cwiseProduct(capacity);
  const Vec4 softened =
      stiffness.cwiseQuotient(Vec4::Ones() + 2 * point.multiplier * stiffness.cwiseQuotient(square));
  const Vec4 normal = point.forces.cwiseQuotient(square);
  const Vec4 flow = softened.cwiseProduct(normal);
  Mat4 tangent = softened.asDiagonal();
  tangent -= flow * flow.transpose() / normal.dot(flow);
  return tangent;
}

double hinge_place(const Element& element, Hinge hinge) {
  if (hinge == Hinge::first) return -1;
  if (hinge == Hinge::second) return 1;
  return -element.s;
}

SectionResponse respond(const Element& element, const ElementState& state, const BeamStrain& strain) {
  SectionResponse out;
  out.forces = {element.normal_stiffness.cwiseProduct(strain.gamma - state.offset.gamma),
                element.bending_stiffness.cwiseProduct(strain.kappa - state.offset.kappa)};
  if (state.hinge == Hinge::none) return out;
  if (state.hinge == Hinge::broken) {
    out.forces = {Vec3::Zero(), Vec3::Zero()};
    return out;
  }
  const double a = arm(element, state.hinge);
  const SectionForces& g = out.forces;
  out.point = return_to_yield(
      {g.normal.x(), g.moment.x(), g.moment.y() + a * g.normal.z(), g.moment.z() - a * g.normal.y()},
      stiffness_at(element, a), element.capacity);
  out.flows = out.point.multiplier > 0;
  if (!out.flows) return out;
  const BeamStrain flow = flow_of(element, state.hinge, out.point);
  out.forces.normal -= element.normal_stiffness.cwiseProduct(flow.gamma);
  out.forces.moment -= element.bending_stiffness.cwiseProduct(flow.kappa);
  return out;
}

SectionTangent section_tangent(const Element& element, Hinge hinge, const SectionResponse& response) {
  const double a = arm(element, hinge);
  const Vec4 stiffness = stiffness_at(element, a), soft = stiffness.cwiseInverse();
  // flow by trial forces at the hinge, D_h^-1 - D_h^-1 C D_h^-1, with D T^T before and T D behind it
  const Mat4 returned = plastic_tangent(response.point, stiffness, element.capacity);
  Mat4 flow = soft.asDiagonal();
  flow -= soft.asDiagonal() * returned * soft.asDiagonal();
  const Vec3 &n = element.normal_stiffness, &m = element.bending_stiffness;
  Eigen::Matrix<double, 3, 4> by_normal = Eigen::Matrix<double, 3, 4>::Zero(), by_moment = by_normal;
  by_normal(0, 0) = n.x();
  by_normal(1, 3) = -a * n.y();
  by_normal(2, 2) = a * n.z();
  by_moment.rightCols<3>() = m.asDiagonal();
  SectionTangent out{n.asDiagonal(), -by_normal * flow * by_moment.transpose(), m.asDiagonal()};
  out.normal_gamma -= by_normal * flow * by_normal.transpose();
  out.moment_kappa -= by_moment * flow * by_moment.transpose();
  return out;
}

void take_flow(const Element& element, const SectionResponse& response, ElementState& state) {
  if (!response.flows) return;
  const BeamStrain flow = flow_of(element, state.hinge, response.point);
  state.offset.gamma += flow.gamma;
  state.offset.kappa += flow.kappa;
}

}  // namespace topple
