#include "solver/element/plasticity.h"

#include <algorithm>
#include <cmath>

namespace topple {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec4 = Eigen::Vector4d;
using Mat2 = Eigen::Matrix2d;
using Mat62 = Eigen::Matrix<double, 6, 2>;

constexpr int k_most_iterations = 60;
constexpr double k_converged = 1e-14;  // of the loading
// of the dual's curvature: surfaces with one and the same normal leave open how they share the flow
constexpr double k_distinct = 1e-10;
constexpr double k_rounding = 1e-13;   // of the elastic energy
constexpr double k_least_part = 1e-6;  // of a step of Newton's

// N, Vy, Vz, Mx, My, Mz.
Vec6 stacked(const SectionForces& g) {
  return {g.normal.x(), g.normal.y(), g.normal.z(), g.moment.x(), g.moment.y(), g.moment.z()};
}

// Shear force and moment of a plane of bending, and the sign with which the arm of the first adds to the
// other.
struct BendingPlane {
  int shear, moment;
  double sign;
};
constexpr BendingPlane k_planes[] = {{2, 4, 1}, {1, 5, -1}};
constexpr int k_straight[] = {0, 3};  // what has no arm: N, Mx

// The yield surfaces of an element at its hinge places, of six section forces.
class Surfaces {
 public:
  explicit Surfaces(const Element& element, unsigned held = 0)
      : stiffness(stacked({element.normal_stiffness, element.bending_stiffness})),
        softening_(2 * element.capacity.cwiseAbs2().cwiseInverse()) {
    const double* const xi = element.hinge_place;
    for (int k = 0; k < 2; ++k) {
      arm[k] = element.length / 2 * (xi[k] + element.s);
      there[k] = !(held >> k & 1) && (k == 0 || xi[1] != xi[0]);
    }
  }

  double loading(const Vec6& g, int k) const { return std::sqrt(g.dot(normal(g, k)) / 2); }

  Vec6 normal(const Vec6& g, int k) const {
    Vec6 n;
    for (int i = 0; i < 2; ++i) n[k_straight[i]] = softening_[i] * g[k_straight[i]];
    for (int i = 0; i < 2; ++i) {
      const auto& [shear, moment, sign] = k_planes[i];
      n[moment] = softening_[2 + i] * (g[moment] + sign * arm[k] * g[shear]);
      n[shear] = sign * arm[k] * n[moment];
    }
    return n;
  }

  // X of section_tangent.
  Mat6 softened(const Vec2& lambda) const {
    Mat6 x = Mat6::Zero();
    for (int i = 0; i < 2; ++i) {
      const int at = k_straight[i];
      x(at, at) = stiffness[at] / (1 + lambda.sum() * softening_[i] * stiffness[at]);
    }
    for (int i = 0; i < 2; ++i) {
      const auto& [shear, moment, sign] = k_planes[i];
      const double c = softening_[2 + i];
      const double both = c * sign * (lambda[0] * arm[0] + lambda[1] * arm[1]);
      const double a = 1 / stiffness[shear] + c * (lambda[0] * arm[0] * arm[0] + lambda[1] * arm[1] * arm[1]),
                   b = 1 / stiffness[moment] + c * lambda.sum(), determinant = a * b - both * both;
      x(shear, shear) = b / determinant;
      x(moment, moment) = a / determinant;
      x(shear, moment) = x(moment, shear) = -both / determinant;
    }
    return x;
  }

  bool there[2];
  Vec6 stiffness;
  std::array<double, 2> arm;

 private:
  Vec4 softening_;
};

struct Projection {
  Vec2 lambda = Vec2::Zero();
  Vec6 forces;
};

// What the dual grows by from lambda = 0.
double dual(const Vec6& strain, const Vec6& trial, const Projection& at) {
  return strain.dot(trial - at.forces) / 2 - at.lambda.sum();
}

// Newton on the dual for the multipliers of the surfaces `free`, with 1 - (f_k + 1)^(-1/2) in place of f_k,
// which is nearly linear in lambda; of one surface alone its way is monotonic. Multipliers stay positive:
// none loses more than nine tenths at once.
void flow_on(const Surfaces& surfaces, const std::array<bool, 2>& free, const Vec6& trial, Projection& at) {
  const Vec6 strain = trial.cwiseQuotient(surfaces.stiffness);
  double grown = dual(strain, trial, at);
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    Mat62 normals = Mat62::Zero();
    Vec2 wanted = Vec2::Zero();
    bool done = true;
    for (int k = 0; k < 2; ++k) {
      if (!free[k]) continue;
      const double size = surfaces.loading(at.forces, k);
      normals.col(k) = surfaces.normal(at.forces, k);
      wanted[k] = 2 * size * size * (size - 1);
      done = done && std::abs(size - 1) <= k_converged;
    }
    if (done) return;
    Mat2 curvature = normals.transpose() * surfaces.softened(at.lambda) * normals;
    for (int k = 0; k < 2; ++k) curvature(k, k) = free[k] ? (1 + k_distinct) * curvature(k, k) : 1;
    const Vec2 step = curvature.inverse() * wanted;
    Projection next;
    for (double part = 1; part > k_least_part; part /= 2) {
      next.lambda = (at.lambda + part * step).cwiseMax(0.1 * at.lambda);
      next.forces = surfaces.softened(next.lambda) * strain;
      if (dual(strain, trial, next) >= grown - k_rounding * strain.dot(trial)) break;
    }
    at = next;
    grown = dual(strain, trial, at);
  }
}

// One surface alone where the other is not beyond it, else both: the problem is convex, so that only one of
// these is so.
Projection project(const Surfaces& surfaces, const Vec6& trial) {
  Projection both{Vec2::Zero(), trial};
  for (int k = 0; k < 2; ++k) {
    if (!surfaces.there[k] || surfaces.loading(trial, k) <= 1) continue;
    Projection one{Vec2::Zero(), trial};
    flow_on(surfaces, {k == 0, k == 1}, trial, one);
    if (!surfaces.there[1 - k] || surfaces.loading(one.forces, 1 - k) <= 1 + k_converged) return one;
    both = one;
  }
  flow_on(surfaces, {true, true}, trial, both);
  return both;
}

Vec6 flow_of(const Surfaces& surfaces, const SectionResponse& response) {
  const Vec6 g = stacked(response.forces);
  Vec6 flow = Vec6::Zero();
  for (int k = 0; k < 2; ++k)
    if (response.multiplier[k] > 0) flow += response.multiplier[k] * surfaces.normal(g, k);
  return flow;
}

}  // namespace

double yield_function(const Element& element, const SectionForces& forces) {
  return Vec4(forces.normal.x(), forces.moment.x(), forces.moment.y(), forces.moment.z())
             .cwiseQuotient(element.capacity)
             .squaredNorm() -
         1;
}

SectionResponse respond(const Element& element, const ElementState& state, const BeamStrain& strain) {
  SectionResponse out;
  out.forces = {element.normal_stiffness.cwiseProduct(strain.gamma - state.offset.gamma),
                element.bending_stiffness.cwiseProduct(strain.kappa - state.offset.kappa)};
  if (state.hinge == Hinge::broken) {
    out.forces = {Vec3::Zero(), Vec3::Zero()};
    return out;
  }
  if (!std::isfinite(element.capacity[0])) return out;
  const Surfaces surfaces(element, state.held);
  const Vec6 trial = stacked(out.forces);
  double most = 0;
  for (int k = 0; k < 2; ++k)
    if (surfaces.there[k]) most = std::max(most, surfaces.loading(trial, k));
  if (!(most * most > 1 + k_on_surface)) return out;
  const Projection on = project(surfaces, trial);
  out.forces = {on.forces.head<3>(), on.forces.tail<3>()};
  out.multiplier = {on.lambda[0], on.lambda[1]};
  return out;
}

SectionTangent section_tangent(const Element& element, const SectionResponse& response) {
  const Surfaces surfaces(element);
  const Vec6 g = stacked(response.forces);
  Mat6 x = surfaces.softened({response.multiplier[0], response.multiplier[1]});
  Mat62 along = Mat62::Zero();
  Mat2 curvature = Mat2::Identity();
  for (int k = 0; k < 2; ++k)
    if (response.multiplier[k] > 0) along.col(k) = surfaces.normal(g, k);
  const Mat62 pushed = x * along;
  const Mat2 square = along.transpose() * pushed;
  for (int k = 0; k < 2; ++k) {
    if (!(response.multiplier[k] > 0)) continue;
    curvature(k, k) = (1 + k_distinct) * square(k, k);
    if (response.multiplier[1 - k] > 0) curvature(k, 1 - k) = square(k, 1 - k);
  }
  x -= pushed * curvature.inverse() * pushed.transpose();
  return {x.topLeftCorner<3, 3>(), x.topRightCorner<3, 3>(), x.bottomRightCorner<3, 3>()};
}

void take_flow(const Element& element, const SectionResponse& response, ElementState& state) {
  if (!response.flows()) return;
  const Vec6 flow = flow_of(Surfaces(element), response);
  state.offset.gamma += flow.head<3>();
  state.offset.kappa += flow.tail<3>();
}

std::array<double, 2> flowed_turns(const Element& element, const BeamStrain& offset) {
  const Surfaces surfaces(element);
  const Vec6 flow = stacked({offset.gamma, offset.kappa});
  std::array<double, 2> square = {0, 0};
  for (const auto& [shear, moment, sign] : k_planes) {
    const double span = surfaces.arm[1] - surfaces.arm[0], all = flow[moment];
    const double second = span > 0 ? (sign * flow[shear] - surfaces.arm[0] * all) / span : 0;
    square[0] += (all - second) * (all - second);
    square[1] += second * second;
  }
  return {element.length * std::sqrt(square[0]), element.length * std::sqrt(square[1])};
}

Hinge flowed_at(const Element& element, const ElementState& state) {
  constexpr double k_beside = 1e-9;  // of the other end's turn: rounding
  if (state.hinge == Hinge::broken) return Hinge::broken;
  if (state.offset.gamma.isZero(0) && state.offset.kappa.isZero(0)) return Hinge::none;
  if (element.hinge_place[0] == element.hinge_place[1]) return Hinge::middle;
  const auto [first, second] = flowed_turns(element, state.offset);
  return second < k_beside * first ? Hinge::first : first < k_beside * second ? Hinge::second : Hinge::both;
}

}  // namespace topple
