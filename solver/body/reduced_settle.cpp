// Rest of a ReducedBody.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "solver/body/reduced_body.h"
#include "solver/math/rotation.h"

namespace topple {

// Newton with K + M/sigma^2, sigma growing, on the normal forces of Eq. 2 with stick springs, as settle.h
// does for frames.
bool ReducedBody::settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick) {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  constexpr int k_rounds = 400;
  constexpr double k_first = 1e-3, k_last = 1e3;           // s, sigma
  constexpr double k_lever = 1;                            // s, beside which damping is nothing
  constexpr double k_balanced = 1e-10, k_furthest = 0.25;  // of the weight, of the reach
  Parameters still = parameters;
  still.shakes.clear();
  still.contact.kind = ContactLawKind::coulomb;
  still.contact.restitution = 1;
  still.contact_passage = {};
  const Instant now(still, 0);
  s.velocity.setZero();
  s.angular_velocity.setZero();
  s.rate.setZero();
  const Vec3 origin = s.position;
  const int m = modes(s), n = 6 + m;
  // rounding of the coordinates moves the forces of the springs
  double balanced = k_balanced * mass_ * parameters.gravity.norm();
  balanced += 8 * std::numeric_limits<double>::epsilon() * (reach_ + origin.norm()) * now.law.alpha *
              std::max(now.law.q, k_stick_stiffness) * contacts_.pairs() / contacts_.least_length();
  balanced +=
      8 * std::numeric_limits<double>::epsilon() * (reach_ + origin.norm()) * anchors_.greatest_stiffness();
  std::vector<BodyContacts::Room> rooms;
  const BodyContacts::Loan loan(contacts_, rooms);
  double sigma = k_first;
  for (int round = 0; round < k_rounds; ++round) {
    balance(still, now, s, stick);
    const Mat3 r = s.rotation.toRotationMatrix();
    Vector load(n);
    load.head<3>() = s.force;
    load.segment<3>(3) = s.moment;
    Matrix stiffness = Matrix::Zero(n, n), inertia = Matrix::Zero(n, n);
    inertia.topLeftCorner<3, 3>() = mass_ * Mat3::Identity();
    inertia.block<3, 3>(3, 3) = r * model_.bodies[body_].inertia * r.transpose();
    if (m > 0) {
      load.tail(m) = s.load.head(m) - basis_->frequency.head(m).square() * s.amplitude.head(m);
      inertia.bottomRightCorner(m, m).setIdentity();
      stiffness.bottomRightCorner(m, m).diagonal() = basis_->frequency.head(m).square();
    }
    contacts_.press<true>(now.law, {{0, 0, 0}, {0, 0, 0}, Amplitudes::Zero()}, k_lever);
    contacts_.each([&](const BodyContacts::Touch& touch, int which, int, std::size_t) {
      const Mat3 slope = contacts_.slope(touch, which);
      const Vec3 arm = lane(touch.arm, which);
      Matrix j(3, n);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm);
      for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = r * contacts_.shape(touch, which, k);
      stiffness -= j.transpose() * slope * j / k_lever;
      stiffness.block<3, 3>(3, 3) -=
          skew(contacts_.force(touch, which)) * skew(arm);  // the arm turns with the body
    });
    anchors_.add_stiffness(s, m, stiffness);
    double left = std::max(s.force.cwiseAbs().maxCoeff(), s.moment.cwiseAbs().maxCoeff() / reach_);
    if (m > 0) left = std::max(left, load.tail(m).cwiseAbs().maxCoeff() * std::sqrt(mass_));
    if (left < balanced && sigma > 1) {
      // a balance that tips over by itself: Newton finds it as readily as a stable one
      const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver((stiffness + stiffness.transpose()) / 2,
                                                                    inertia, Eigen::EigenvaluesOnly);
      return solver.eigenvalues()[0] > -1e-3 * parameters.gravity.norm() / reach_;
    }
    const Vector x = (stiffness + inertia / (sigma * sigma)).partialPivLu().solve(load);
    const BodyState before = s;
    s.position += x.head<3>();
    s.rotation = (exp_quaternion(x.segment<3>(3)) * s.rotation).normalized();
    if (m > 0) s.amplitude.head(m) += x.tail(m).array();
    const double size = x.head<3>().norm() + reach_ * x.segment<3>(3).norm();
    if (!((s.position - origin).norm() + size < k_furthest * reach_)) return false;
    const PackMat3 r1 = rotation_matrix(packed(s.rotation));
    contacts_.begin_part();
    contacts_.find(s, r1, stick);
    contacts_.follow(before, packed(r), s, r1);
    respond_at<ContactSums::none>(now.law, s);
    contacts_.keep_sticks(now.law, stick);
    found_.reset();
    sigma = std::clamp(sigma * (size < 0.01 * reach_ ? 2 : 0.5), k_first / 16, k_last);
  }
  return false;
}

}  // namespace topple
