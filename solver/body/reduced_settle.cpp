// Rest of a ReducedBody.
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "solver/body/reduced_body.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/find_rest.h"
#include "solver/math/rotation.h"

namespace topple {

// Of find_rest, on the normal forces of Eq. 2 with stick springs.
class ReducedBody::RestOnPlanes {
 public:
  RestOnPlanes(ReducedBody& body, const Parameters& parameters, BodyState& state, std::span<Vec3> stick)
      : size(body.reach_),
        body_(body),
        still_(without_ramp(at_rest(parameters))),
        now_(still_, 0),
        s_(state),
        stick_(stick),
        origin_(state.position),
        modes_(body.modes(state)) {
    s_.velocity.setZero();
    s_.angular_velocity.setZero();
    s_.rate.setZero();
    // rounding of the coordinates moves the forces of the springs
    const BodyContacts& contacts = body_.contacts_;
    balanced = k_balance * body_.mass_ * parameters.gravity.norm();
    balanced += 8 * std::numeric_limits<double>::epsilon() * (size + origin_.norm()) * now_.law.alpha *
                std::max(now_.law.q, k_stick_stiffness) * contacts.pairs() / contacts.least_length();
    balanced += 8 * std::numeric_limits<double>::epsilon() * (size + origin_.norm()) *
                body_.anchors_.greatest_stiffness();
  }

  double unbalance() {
    body_.balance(still_, now_, s_, stick_);
    r_ = s_.rotation.toRotationMatrix();
    const int n = 6 + modes_;
    load_.resize(n);
    load_.head<3>() = s_.force;
    load_.segment<3>(3) = s_.moment;
    stiffness_ = Matrix::Zero(n, n), inertia_ = Matrix::Zero(n, n);
    inertia_.topLeftCorner<3, 3>() = body_.mass_ * Mat3::Identity();
    inertia_.block<3, 3>(3, 3) = r_ * body_.model_.bodies[body_.body_].inertia * r_.transpose();
    if (modes_ > 0) {
      const auto frequency = body_.basis_->frequency.head(modes_);
      load_.tail(modes_) = s_.load.head(modes_) - frequency.square() * s_.amplitude.head(modes_);
      inertia_.bottomRightCorner(modes_, modes_).setIdentity();
      stiffness_.bottomRightCorner(modes_, modes_).diagonal() = frequency.square();
    }
    add_contacts();
    body_.anchors_.add_stiffness(s_, modes_, stiffness_);
    double left = std::max(s_.force.cwiseAbs().maxCoeff(), s_.moment.cwiseAbs().maxCoeff() / size);
    if (modes_ > 0) left = std::max(left, load_.tail(modes_).cwiseAbs().maxCoeff() * std::sqrt(body_.mass_));
    return left;
  }

  // A balance that tips over by itself: Newton finds it as readily as a stable one.
  Balance look() const {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver((stiffness_ + stiffness_.transpose()) / 2,
                                                                  inertia_, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0] > -1e-3 * still_.gravity.norm() / size ? Balance::rest
                                                                          : Balance::tips_over;
  }

  std::optional<RestStep> step(double sigma) {
    const Vector x = (stiffness_ + inertia_ / (sigma * sigma)).partialPivLu().solve(load_);
    before_ = s_;
    s_.position += x.head<3>();
    s_.rotation = (exp_quaternion(x.segment<3>(3)) * s_.rotation).normalized();
    if (modes_ > 0) s_.amplitude.head(modes_) += x.tail(modes_).array();
    const double length = x.head<3>().norm() + size * x.segment<3>(3).norm();
    return RestStep{length, (s_.position - origin_).norm() + length};
  }

  void follow() {
    BodyContacts& contacts = body_.contacts_;
    const PackMat3 r1 = rotation_matrix(packed(s_.rotation));
    contacts.begin_substep();
    contacts.find(s_, r1, stick_);
    contacts.follow(before_, packed(r_), s_, r1);
    body_.respond_at<ContactSums::none>(now_.law, s_);
    contacts.keep_sticks(now_.law, stick_);
    body_.found_.reset();
  }

  const double size;
  double balanced;

 private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  static Parameters without_ramp(Parameters parameters) {
    parameters.contact_ramp = {};
    return parameters;
  }

  void add_contacts() {
    constexpr double k_gamma_dt = 1;  // s, beside which damping is nothing
    BodyContacts& contacts = body_.contacts_;
    contacts.evaluate_forces<true>(now_.law, {{0, 0, 0}, {0, 0, 0}, Amplitudes::Zero()}, k_gamma_dt);
    contacts.each([&](const BodyContacts::Touch& touch, int which, int, std::size_t) {
      const Mat3 slope = contacts.slope(touch, which);
      const Vec3 arm = lane(touch.arm, which);
      Matrix j(3, 6 + modes_);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm);
      for (int k = 0; k < modes_; ++k) j.block<3, 1>(0, 6 + k) = r_ * contacts.shape(touch, which, k);
      stiffness_ -= j.transpose() * slope * j / k_gamma_dt;
      stiffness_.block<3, 3>(3, 3) -=
          skew(contacts.force(touch, which)) * skew(arm);  // the arm turns with the body
    });
  }

  ReducedBody& body_;
  const Parameters still_;
  const StepInputs now_;
  BodyState& s_;
  BodyState before_;
  std::span<Vec3> stick_;
  const Vec3 origin_;
  const int modes_;
  Mat3 r_;  // of s_
  Vector load_;
  Matrix stiffness_, inertia_;
};

StepStatus::Kind ReducedBody::settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick) {
  std::vector<BodyContacts::TouchBuffer> buffers;
  const BodyContacts::ScratchLease lease(contacts_, buffers);
  RestOnPlanes body(*this, parameters, s, stick);
  return find_rest(body) == Balance::rest ? StepStatus::Kind::ok : StepStatus::Kind::not_settled;
}

}  // namespace topple
