#include "solver/plasticity.h"

#include <cmath>

namespace topple {
namespace {

constexpr int k_most_iterations = 60;
constexpr double k_converged = 1e-15;  // of the loading: rounding

Vec4 flowing(const Vec3& normal, const Vec3& moment) {
  return {normal.x(), moment.x(), moment.y(), moment.z()};
}

Vec4 stiffness_of(const Element& element) {
  return flowing(element.normal_stiffness, element.bending_stiffness);
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
  if (!(loading.squaredNorm() > 1)) return out;
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

SectionResponse respond(const Element& element, const ElementState& state, const BeamStrain& strain) {
  SectionResponse out;
  out.forces = {element.normal_stiffness.cwiseProduct(strain.gamma - state.offset.gamma),
                element.bending_stiffness.cwiseProduct(strain.kappa - state.offset.kappa)};
  if (state.hinge == Hinge::none) return out;
  if (state.hinge == Hinge::broken) {
    out.forces = {Vec3::Zero(), Vec3::Zero()};
    return out;
  }
  out.point = return_to_yield(flowing(out.forces.normal, out.forces.moment), stiffness_of(element),
                              element.capacity);
  out.flows = out.point.multiplier > 0;
  out.forces.normal.x() = out.point.forces[0];
  out.forces.moment = out.point.forces.tail<3>();
  return out;
}

SectionTangent section_tangent(const Element& element, const SectionResponse& response) {
  const Mat4 c = plastic_tangent(response.point, stiffness_of(element), element.capacity);
  SectionTangent out{element.normal_stiffness.asDiagonal(), Mat3::Zero(), c.bottomRightCorner<3, 3>()};
  out.normal_gamma(0, 0) = c(0, 0);
  out.normal_kappa.row(0) = c.row(0).tail<3>();
  return out;
}

void take_flow(const Element& element, const SectionResponse& response, ElementState& state) {
  if (!response.flows) return;
  const Vec4 flow = 2 * response.point.multiplier *
                    response.point.forces.cwiseQuotient(element.capacity.cwiseProduct(element.capacity));
  state.offset.gamma.x() += flow[0];
  state.offset.kappa += flow.tail<3>();
}

}  // namespace topple
