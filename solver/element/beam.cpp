#include "solver/element/beam.h"

#include "solver/element/plasticity.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

struct Kinematics {
  double t;
  Vec3 d;   // x2 - x1
  Mat3 rs;  // axes of the integration point
  BeamStrain strain;
};

Kinematics kinematics(const Element& element, double s, const BeamEnds& ends) {
  Kinematics k;
  k.t = (1 + s) / 2;
  k.d = ends.x2 - ends.x1;
  k.rs = ends.r1 * exp_quaternion(k.t * ends.psi).toRotationMatrix();
  k.strain.gamma = k.rs.transpose() * k.d / element.length - Vec3::UnitX();
  k.strain.kappa = ends.psi / element.length;
  return k;
}

// d/dpsi of (psi.v) psi - |psi|^2 v = [psi]^2 v
Mat3 derivative_of_double_cross(const Vec3& psi, const Vec3& v) {
  return psi.dot(v) * Mat3::Identity() + psi * v.transpose() - 2 * v * psi.transpose();
}

// d/dpsi of T(psi)^-T v with v held
Mat3 derivative_of_inverse_transposed(const InverseJacobianCoefficient& c, const Vec3& psi, const Vec3& v) {
  return -0.5 * skew(v) + c.g * derivative_of_double_cross(psi, v) +
         2 * c.dg * psi.cross(psi.cross(v)) * psi.transpose();
}

// What a section adds in which stretch and shear flow along with curvature: `e` is dn / d(spin2 - spin1) by
// the curvature, and its transpose the change of w by the stretch.
void add_coupling(const Mat3& e, const Mat3& skew_d, const Mat3& b, Mat12& tangent) {
  const auto block = [&](int i, int j) { return tangent.block<3, 3>(3 * i, 3 * j); };
  const Mat3 x = skew_d * e, y = e.transpose() * skew_d;
  const Mat3 m2_spin1 = b.transpose() * x + y * (Mat3::Identity() - b), m2_spin2 = y * b - b.transpose() * x;
  block(0, 1) += e;
  block(0, 3) -= e;
  block(2, 1) -= e;
  block(2, 3) += e;
  block(3, 0) -= e.transpose();
  block(3, 1) += m2_spin1;
  block(3, 2) += e.transpose();
  block(3, 3) += m2_spin2;
  block(1, 0) += e.transpose();
  block(1, 1) += x - m2_spin1;
  block(1, 2) -= e.transpose();
  block(1, 3) -= x + m2_spin2;
}

}  // namespace

BeamEnds beam_ends(const Element& element, const Vec3& x1, const Quat& q1, const Vec3& x2, const Quat& q2) {
  return {x1, x2, q1.toRotationMatrix() * element.triad, q2.toRotationMatrix() * element.triad,
          element.triad.transpose() * log_quaternion(q1.conjugate() * q2)};
}

BeamStrain beam_strain(const Element& element, double s, const BeamEnds& ends) {
  return kinematics(element, s, ends).strain;
}

BeamStrain elastic_strain(const ElementState& state, const BeamStrain& strain) {
  if (state.hinge == Hinge::broken) return {Vec3::Zero(), Vec3::Zero()};
  return {strain.gamma - state.offset.gamma, strain.kappa - state.offset.kappa};
}

double beam_energy(const Element& element, const BeamStrain& elastic) {
  return element.length / 2 *
         (elastic.gamma.dot(element.normal_stiffness.cwiseProduct(elastic.gamma)) +
          elastic.kappa.dot(element.bending_stiffness.cwiseProduct(elastic.kappa)));
}

void beam_tangent(const Element& element, const ElementState& state, const BeamEnds& ends,
                  BeamGradient& gradient, Mat12& tangent) {
  if (state.hinge == Hinge::broken) {
    gradient = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    tangent.setZero();
    return;
  }
  const Kinematics k = kinematics(element, element.s, ends);
  const double t = k.t;
  const Vec3& psi = ends.psi;
  const SectionResponse response = respond(element, state, k.strain);
  const Vec3 n = k.rs * response.forces.normal;
  const Vec3& m0 = response.forces.moment;
  const Vec3 p = n.cross(k.d);

  const double x = psi.squaredNorm();
  const InverseJacobianCoefficient c(x);
  const Mat3 skew_psi = skew(psi);
  const Mat3 skew_psi2 = skew_psi * skew_psi;
  const Mat3 inverse = Mat3::Identity() - 0.5 * skew_psi + c.g * skew_psi2;
  const ExpCoefficients f(t * t * x);
  const Mat3 left = Mat3::Identity() + f.f1 * t * skew_psi + f.f2 * t * t * skew_psi2;

  const Mat3 a = inverse * ends.r1.transpose();
  const Mat3 b = ends.r1 * (t * left) * a;
  const Vec3 p1 = ends.r1.transpose() * p;
  const Vec3 q = t * left.transpose() * p1;
  const Vec3 u = a.transpose() * q;
  const Vec3 w = a.transpose() * m0;

  gradient = {-n, p - u - w, n, u + w};

  const Mat3 skew_d = skew(k.d);
  SectionTangent section;
  if (response.flows) section = section_tangent(element, state.hinge, response);
  const Mat3 cs =
      response.flows ? Mat3(k.rs * section.normal_gamma * k.rs.transpose() / element.length)
                     : Mat3(k.rs * element.normal_stiffness.asDiagonal() * k.rs.transpose() / element.length);
  const Mat3 n_spin = cs * skew_d - skew(n);  // dn / dspin of the integration point
  const Mat3 p_spin = -skew_d * n_spin;       // dp / dspin of the integration point
  const Mat3 p_d = n_spin.transpose();        // dp / dd

  const Vec3 psi_p = psi.cross(p1);
  const Mat3 dq = t * (t * f.f1 * skew(p1) - 2 * t * t * t * f.df1 * psi_p * psi.transpose() +
                       t * t * f.f2 * derivative_of_double_cross(psi, p1) +
                       2 * t * t * t * t * f.df2 * psi.cross(psi_p) * psi.transpose());
  Mat3 h = derivative_of_inverse_transposed(c, psi, q + m0) + inverse.transpose() * dq;
  if (response.flows)
    h += inverse.transpose() * section.moment_kappa * (1 / element.length);
  else
    h += inverse.transpose() * element.bending_stiffness.asDiagonal() * (1 / element.length);
  h = ends.r1 * h * a;  // d(u + w) / d(spin2 - spin1)

  const Mat3 bt = b.transpose();
  const Mat3 one_minus_b = Mat3::Identity() - b;
  const Mat3 bt_p_d = bt * p_d;
  const Mat3 bt_p_spin = bt * p_spin;
  const Mat3 m2_spin1 = bt_p_spin * one_minus_b + bt * skew(p) - skew(u + w) - h;
  const Mat3 m2_spin2 = bt_p_spin * b + h;

  const auto block = [&](int i, int j) { return tangent.block<3, 3>(3 * i, 3 * j); };
  block(2, 0) = -cs;
  block(2, 1) = n_spin * one_minus_b;
  block(2, 2) = cs;
  block(2, 3) = n_spin * b;
  block(3, 0) = -bt_p_d;
  block(3, 1) = m2_spin1;
  block(3, 2) = bt_p_d;
  block(3, 3) = m2_spin2;
  for (int j = 0; j < 4; ++j) block(0, j) = -block(2, j);
  block(1, 0) = -p_d + bt_p_d;
  block(1, 1) = p_spin * one_minus_b - m2_spin1;
  block(1, 2) = p_d - bt_p_d;
  block(1, 3) = p_spin * b - m2_spin2;
  if (response.flows)
    add_coupling(k.rs * section.normal_kappa * a * (1 / element.length), skew_d, b, tangent);
}

}  // namespace topple
