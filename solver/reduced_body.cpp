#include "solver/reduced_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/excitation.h"
#include "solver/plasticity.h"
#include "solver/rotation.h"
#include "solver/section_forces.h"
#include "solver/step_control.h"

namespace topple {
namespace {

constexpr double k_stable_turn =
    1.2;  // rad per part of a step, of the stiffest motion on the contacts; 2 is the limit
constexpr double k_swing = 2.5;            // rad per part, of the highest mode
constexpr double k_velocity_error = 1e-7;  // of the speed
constexpr int k_most_iterations = 30;

using Matrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6 + k_modes, 6 + k_modes>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6 + k_modes, 1>;

double contact_width(const ContactPoint& point, const Plane& plane) {
  return (point.width + (plane.width > 0 ? plane.width : point.width)) / 2;
}

}  // namespace

Instant::Instant(const Parameters& parameters, double t)
    : time(t), law(contact_law(parameters, t)), floor(floor_acceleration(parameters.shakes, t)) {}

ReducedBody::ReducedBody(const Model& whole, int body)
    : model(whole),
      index(body),
      mass(whole.bodies[body].mass),
      inertia(whole.bodies[body].inertia),
      inverse_inertia(inertia.inverse()),
      reach(whole.bodies[body].reach),
      basis_(whole.bodies[body].elastic),
      contact_mass_(mass / std::max(1, whole.bodies[body].contact_point_count)),
      first_point_(whole.bodies[body].first_contact_point),
      points_(whole.bodies[body].contact_point_count) {
  const Body& b = model.bodies[body];
  groups_.resize((points_ + k_width - 1) / k_width);
  for (Group& group : groups_) group.x = group.y = group.z = Pack::Zero();
  sides_.resize(model.planes.size() * groups_.size());
  for (Side& side : sides_) {
    side.threshold.setConstant(-std::numeric_limits<double>::infinity());
    side.L.setOnes();
  }
  const int modes = basis_ ? basis_->modes : 0;
  point_shape_.resize(3 * points_, modes);
  for (int p = 0; p < points_; ++p) {
    const ContactPoint& point = model.contact_points[first_point_ + p];
    const Vec3 place = model.node_position[point.node] - b.centre_of_gravity;
    place_.push_back(place);
    Group& group = groups_[p / k_width];
    group.x[p % k_width] = place.x();
    group.y[p % k_width] = place.y();
    group.z[p % k_width] = place.z();
    for (std::size_t k = 0; k < model.planes.size(); ++k) {
      Side& side = sides_[k * groups_.size() + p / k_width];
      const double L = contact_width(point, model.planes[k]);
      side.L[p % k_width] = L;
      side.threshold[p % k_width] = point.width / 2;
    }
    if (basis_)
      point_shape_.middleRows<3>(3 * p) = basis_->shape.middleRows<3>(6 * (point.node - b.first_node));
  }
}

ReducedBody::Frame ReducedBody::frame_of(const BodyState& s) const {
  const Mat3 r = s.rotation.toRotationMatrix();
  return {r, r * inertia * r.transpose(), r * inverse_inertia * r.transpose()};
}

Vec3 ReducedBody::point(const BodyState& s, int p) const {
  Vec3 place = place_[p];
  if (s.rung == Rung::elastic)
    place += point_shape_.middleRows<3>(3 * p) * s.amplitude.head(basis_->modes).matrix();
  return place;
}

void ReducedBody::find_touching(const BodyState& s, const Mat3& r) {
  contacts_.clear();
  arm_.clear();
  const bool bends = s.rung == Rung::elastic;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    const double height = plane.normal.dot(s.position - plane.point);
    // no corner reaches this plane
    if (height > reach + sides_[k * groups_.size()].L[0] && !bends) continue;
    const Vec3 n = r.transpose() * plane.normal;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Group& group = groups_[g];
      const Side& side = sides_[k * groups_.size() + g];
      Pack gap = n.x() * group.x + n.y() * group.y + n.z() * group.z + height - side.threshold;
      if (bends)
        for (int lane = 0; lane < k_width; ++lane)
          if (const int p = static_cast<int>(g) * k_width + lane; p < points_)
            gap[lane] = n.dot(point(s, p)) + height - side.threshold[lane];
      if (!(gap < 0).any()) continue;
      for (int lane = 0; lane < k_width; ++lane) {
        if (!(gap[lane] < 0)) continue;
        const int p = static_cast<int>(g) * k_width + lane;
        TouchingPair& pair = contacts_.emplace_back();
        pair.point = first_point_ + p;
        pair.plane = static_cast<int>(k);
        pair.node = p;
        pair.own_body = 0;
        pair.L = side.L[lane];
        pair.depth = -gap[lane] / pair.L;
        arm_.push_back(r * point(s, p));
      }
    }
  }
}

Vec3 ReducedBody::velocity_of(const Velocity& u, const Mat3& r, const BodyState& s, int touching) const {
  Vec3 v = u.linear + u.angular.cross(arm_[touching]);
  if (s.rung == Rung::elastic)
    v += r * (point_shape_.middleRows<3>(3 * contacts_[touching].node) * u.rate.head(basis_->modes).matrix());
  return v;
}

void ReducedBody::sum_loads(const Frame& frame, const Vec3& field, BodyState& s) const {
  s.force = mass * field;
  s.moment.setZero();
  s.load.setZero();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Vec3& f = contacts_[c].out.force;
    s.force += f;
    s.moment += arm_[c].cross(f);
    if (s.rung == Rung::elastic)
      s.load.head(basis_->modes) +=
          (point_shape_.middleRows<3>(3 * contacts_[c].node).transpose() * (frame.r.transpose() * f)).array();
  }
}

// The velocity u after half a step of what acts at its end, and the contact forces there. `free`: without
// contacts. Newton.
void ReducedBody::solve_velocity(const ContactLaw& law, const Frame& frame, double h, const Velocity& free,
                                 std::span<const Vec3> stick, Velocity& u, const BodyState& s) {
  const int m = modes(s), n = 6 + m;
  const std::size_t planes = model.planes.size();
  Matrix a(n, n);
  Vector residual(n);
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    a.setZero();
    a.topLeftCorner<3, 3>() = mass * Mat3::Identity();
    a.block<3, 3>(3, 3) = frame.inertia;
    residual.head<3>() = mass * (u.linear - free.linear);
    residual.segment<3>(3) = frame.inertia * (u.angular - free.angular);
    for (int k = 0; k < m; ++k) {
      a(6 + k, 6 + k) = 1;
      residual[6 + k] = u.rate[k] - free.rate[k];
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      TouchingPair& pair = contacts_[c];
      Mat3 by_position, d;
      const ContactInput input{model.planes[pair.plane].normal,
                               pair.depth,
                               pair.L,
                               velocity_of(u, frame.r, s, static_cast<int>(c)),
                               stick[pair.point * planes + pair.plane] + travel_[c],
                               contact_mass_,
                               false};
      pair.out = contact_force(law, input, by_position, d);
      const Vec3 impulse = h / 2 * pair.out.force;
      d *= h / 2;
      const Mat3 x = skew(arm_[c]);
      residual.head<3>() -= impulse;
      residual.segment<3>(3) -= arm_[c].cross(impulse);
      a.topLeftCorner<3, 3>() -= d;
      a.block<3, 3>(0, 3) += d * x;
      a.block<3, 3>(3, 0) -= x * d;
      a.block<3, 3>(3, 3) += x * d * x;
      if (m > 0) {
        const auto shape = point_shape_.middleRows<3>(3 * pair.node);
        const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, k_modes> moved = frame.r * shape;
        residual.tail(m) -= moved.transpose() * impulse;
        a.block(0, 6, 3, m) -= d * moved;
        a.block(3, 6, 3, m) -= x * d * moved;
        a.block(6, 0, m, 3) -= moved.transpose() * d;
        a.block(6, 3, m, 3) += moved.transpose() * d * x;
        a.block(6, 6, m, m) -= moved.transpose() * d * moved;
      }
    }
    Vector correction(n);
    if (m == 0)
      correction = Mat6(a).partialPivLu().solve(Vec6(residual));
    else
      correction = a.partialPivLu().solve(residual);
    u.linear -= correction.head<3>();
    u.angular -= correction.segment<3>(3);
    for (int k = 0; k < m; ++k) u.rate[k] -= correction[6 + k];
    const double size = correction.head<3>().norm() + reach * correction.segment<3>(3).norm();
    if (!(size > k_velocity_error * (1e-3 + u.linear.norm() + reach * u.angular.norm()))) break;
  }
}

// Rotation of the modes over h, and of the body without moments.
void ReducedBody::drift(double h, BodyState& s) {
  s.position += h * s.velocity;
  // Lie midpoint: omega of the middle of the step from the angular momentum, which stays.
  const Vec3 momentum = inertia * s.angular_velocity;
  Vec3 middle = s.angular_velocity;
  for (int pass = 0; pass < 3; ++pass)
    middle = inverse_inertia * (exp_quaternion(h / 2 * middle).conjugate() * momentum);
  const Quat turn = exp_quaternion(h * middle);
  s.rotation = (s.rotation * turn).normalized();
  s.angular_velocity = inverse_inertia * (turn.conjugate() * momentum);
  if (s.rung != Rung::elastic) return;
  if (swing_step_ != h) {
    swing_step_ = h;
    for (int k = 0; k < k_modes; ++k) {
      const double w = basis_->frequency[k];
      cosine_[k] = std::cos(w * h);
      sine_[k] = w > 0 ? std::sin(w * h) / w : 0;
      back_[k] = -w * std::sin(w * h);
    }
  }
  const Amplitudes q = s.amplitude;
  s.amplitude = cosine_ * q + sine_ * s.rate;
  s.rate = cosine_ * s.rate + back_ * q;
}

// The contacts' springs and stick springs as stiff as they get.
double ReducedBody::stable_part(const ContactLaw& law, const BodyState& s) {
  if (contacts_.empty()) return std::numeric_limits<double>::infinity();
  std::uint64_t touching = 14695981039346656037ull;
  for (const TouchingPair& pair : contacts_) {
    touching ^= static_cast<std::uint64_t>(pair.point * model.planes.size() + pair.plane + 1);
    touching *= 1099511628211ull;
  }
  for (const Known& known : known_)
    if (known.touching == touching && known.alpha == law.alpha && known.q == law.q && known.rung == s.rung)
      return known.step;
  const double slope = law.q < 1 ? law.q * std::pow(0.01, law.q - 1) : law.q;
  const double stick = law.kind == ContactLawKind::coulomb ? k_stick_stiffness : 0;
  const int m = modes(s), n = 6 + m;
  const Eigen::LLT<Mat3> root(inertia);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (const TouchingPair& pair : contacts_) {
    Eigen::MatrixXd j(3, n);
    j.leftCols<3>() = Mat3::Identity() / std::sqrt(mass);
    j.middleCols<3>(3) = -skew(place_[pair.node]) * root.matrixL().solve(Mat3::Identity()).transpose();
    if (m > 0) j.rightCols(m) = point_shape_.middleRows<3>(3 * pair.node);
    sum += law.alpha / pair.L * std::max(slope, stick) * j.transpose() * j;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(sum, Eigen::EigenvaluesOnly);
  double step = k_stable_turn / std::sqrt(solver.eigenvalues().tail<1>()[0]);
  if (m > 0) step = std::min(step, k_swing / basis_->frequency[m - 1]);
  known_[next_known_] = {touching, law.alpha, law.q, s.rung, step};
  next_known_ = (next_known_ + 1) % static_cast<int>(known_.size());
  return step;
}

BodyEnergy ReducedBody::energy(const ContactLaw& law, const BodyState& s) const {
  BodyEnergy out;
  out.kinetic =
      0.5 * mass * s.velocity.squaredNorm() + 0.5 * s.angular_velocity.dot(inertia * s.angular_velocity);
  if (s.rung == Rung::elastic) {
    out.kinetic += 0.5 * s.rate.square().sum();
    out.strain = 0.5 * (basis_->frequency * s.amplitude).square().sum();
  }
  for (const TouchingPair& pair : contacts_) {
    if (law.kind != ContactLawKind::printed) out.contact += penalty_energy(law, pair.depth, pair.L);
    out.contact += pair.out.stick_energy;
  }
  return out;
}

BodyEnergy ReducedBody::find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick) {
  const Mat3 r = s.rotation.toRotationMatrix();
  find_touching(s, r);
  const Velocity u{s.velocity, s.rotation * s.angular_velocity, s.rate};
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    TouchingPair& pair = contacts_[c];
    pair.out = contact_force(now.law, {model.planes[pair.plane].normal, pair.depth, pair.L,
                                       velocity_of(u, r, s, static_cast<int>(c)),
                                       stick[pair.point * model.planes.size() + pair.plane], contact_mass_});
  }
  return energy(now.law, s);
}

BodyEnergy ReducedBody::balance(const Parameters& parameters, const Instant& now, BodyState& s,
                                std::span<const Vec3> stick) {
  const BodyEnergy held = find_contacts(now, s, stick);
  sum_loads(frame_of(s), parameters.gravity - now.floor, s);
  return held;
}

void ReducedBody::advance_part(const Parameters& parameters, const Instant& start, const Instant& end,
                               double h, BodyState& s, std::span<Vec3> stick, StepEnergy& booked) {
  std::swap(contacts_, contacts_start_);
  std::swap(arm_, arm_start_);
  const BodyState before = s;
  // half an impulse, then free motion
  s.velocity += h / 2 / mass * s.force;
  s.angular_velocity += h / 2 * (inverse_inertia * (s.rotation.conjugate() * s.moment));
  s.rate += h / 2 * s.load;
  drift(h, s);

  const Frame frame = frame_of(s);
  find_touching(s, frame.r);
  const Vec3 field = parameters.gravity - end.floor;
  const Vec3 shift = s.position - before.position;
  const auto travel_of = [&](int p, const Vec3& arm) {
    return Vec3(shift + arm - before.rotation * point(before, p));
  };
  travel_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c) travel_.push_back(travel_of(contacts_[c].node, arm_[c]));
  Velocity u{s.velocity + h / 2 * field, s.rotation * s.angular_velocity, s.rate};
  const Vec3 drifted = u.angular;
  if (!contacts_.empty()) {
    const Velocity free = u;
    u.linear = s.velocity + h / 2 / mass * before.force;
    u.angular += h / 2 * frame.inverse * before.moment;
    solve_velocity(end.law, frame, h, free, stick, u, s);
  }
  sum_loads(frame, field, s);
  s.velocity += h / 2 / mass * s.force;
  u.angular = drifted + h / 2 * (frame.inverse * s.moment);
  s.angular_velocity = s.rotation.conjugate() * u.angular;
  s.rate += h / 2 * s.load;

  // Booking: as book_work, and what the method itself takes out from its own kinematics.
  booked.gravity -= mass * parameters.gravity.dot(shift);
  booked.input -= mass * 0.5 * (start.floor + end.floor).dot(shift);
  for (std::size_t c = 0; c < contacts_start_.size(); ++c)
    book_contact(contacts_start_[c].out, model.planes[contacts_start_[c].plane].normal,
                 shift + frame.r * point(s, contacts_start_[c].node) - arm_start_[c], -1, booked);
  for (std::size_t c = 0; c < contacts_.size(); ++c)
    book_contact(contacts_[c].out, model.planes[contacts_[c].plane].normal, travel_[c], 1, booked);
  const Vec3 spin = log_quaternion(s.rotation * before.rotation.conjugate());
  booked.numerical += 0.5 * (before.force + s.force).dot(shift) -
                      0.5 * mass * (s.velocity + before.velocity).dot(s.velocity - before.velocity) +
                      0.5 * (before.moment + s.moment).dot(spin) -
                      0.5 * (s.angular_velocity + before.angular_velocity)
                                .dot(inertia * (s.angular_velocity - before.angular_velocity));
  if (s.rung == Rung::elastic)
    booked.numerical +=
        (0.5 * (before.load + s.load) * (s.amplitude - before.amplitude) -
         0.5 * (s.rate.square() - before.rate.square()) -
         0.5 * basis_->frequency.square() * (s.amplitude.square() - before.amplitude.square()))
            .sum();
  book_law_change(start.law, end.law, contacts_start_, contacts_, booked);

  for (const TouchingPair& pair : contacts_start_)
    stick[pair.point * model.planes.size() + pair.plane].setZero();
  for (const TouchingPair& pair : contacts_)
    stick[pair.point * model.planes.size() + pair.plane] = pair.out.stick;
}

BodyEnergy ReducedBody::advance(const Parameters& parameters, const Instant& start, double h, BodyState& s,
                                std::span<Vec3> stick, StepEnergy& booked) {
  Instant from = start;
  double left = h;
  while (left > 0) {
    const double parts = std::ceil(left / stable_part(from.law, s) - 1e-9);
    const double size = parts > 1 ? left / parts : left;
    left = parts > 1 ? left - size : 0;
    const Instant to(parameters, left > 0 ? from.time + size : start.time + h);
    advance_part(parameters, from, to, size, s, stick, booked);
    from = to;
  }
  return energy(from.law, s);
}

void ReducedBody::section_forces(const BodyState& s, std::vector<SectionForces>& sections) {
  const Body& body = model.bodies[index];
  if (s.rung == Rung::rigid) {
    std::fill_n(sections.begin() + body.first_element, body.element_count,
                SectionForces{Vec3::Zero(), Vec3::Zero()});
    return;
  }
  section_ = basis_->section * s.amplitude.head(basis_->modes).matrix();
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  for (const TouchingPair& pair : contacts_) {
    const int node = model.contact_points[pair.point].node - body.first_node;
    section_.noalias() += basis_->residual_section.middleCols<3>(3 * node) * (back * pair.out.force);
  }
  for (int e = 0; e < body.element_count; ++e)
    sections[body.first_element + e] = {section_.segment<3>(6 * e), section_.segment<3>(6 * e + 3)};
}

void ReducedBody::add_residual(const BodyState& s, State& state) const {
  if (s.rung != Rung::elastic) return;
  const Body& body = model.bodies[index];
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6 * body.node_count);
  const Mat3 r = s.rotation.toRotationMatrix();
  for (const TouchingPair& pair : contacts_) {
    const int node = model.contact_points[pair.point].node - body.first_node;
    u += basis_->residual_shape.middleCols<3>(3 * node) * (r.transpose() * pair.out.force);
  }
  for (int i = 0; i < body.node_count; ++i) {
    state.position[body.first_node + i] += r * u.segment<3>(6 * i);
    Quat& q = state.rotation[body.first_node + i];
    q = (exp_quaternion(r * u.segment<3>(6 * i + 3)) * q).normalized();
  }
}

double ReducedBody::yield_bound(const BodyState& s) const {
  double bound = basis_->mode_yield.dot(s.amplitude.head(basis_->modes).abs().matrix());
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  for (const TouchingPair& pair : contacts_) {
    const int node = model.contact_points[pair.point].node - model.bodies[index].first_node;
    bound += basis_->residual_yield.segment<3>(3 * node).dot((back * pair.out.force).cwiseAbs());
  }
  return bound;
}

double ReducedBody::rotation_bound(const BodyState& s) const {
  return basis_->mode_rotation.dot(s.amplitude.head(basis_->modes).abs().matrix());
}

// Newton with K + M/sigma^2, sigma growing, on the normal forces of Eq. 2 with stick springs, as settle.h
// does for frames.
bool ReducedBody::settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick) {
  constexpr int k_rounds = 400;
  constexpr double k_first = 1e-3, k_last = 1e3;  // s, sigma
  constexpr double k_balance = 1e-10, k_furthest = 0.25;
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
  const double weight = mass * parameters.gravity.norm();
  double sigma = k_first;
  for (int round = 0; round < k_rounds; ++round) {
    balance(still, now, s, stick);
    const Frame frame = frame_of(s);
    Vector load(n);
    load << s.force, s.moment;
    Matrix k = Matrix::Zero(n, n), inertia_of = Matrix::Zero(n, n);
    inertia_of.topLeftCorner<3, 3>() = mass * Mat3::Identity();
    inertia_of.block<3, 3>(3, 3) = frame.inertia;
    if (m > 0) {
      load.tail(m) = s.load.head(m) - basis_->frequency.head(m).square() * s.amplitude.head(m);
      inertia_of.bottomRightCorner(m, m).setIdentity();
      k.bottomRightCorner(m, m).diagonal() = basis_->frequency.head(m).square();
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      TouchingPair& pair = contacts_[c];
      Mat3 d, by_velocity;
      const Vec3& held = stick[pair.point * model.planes.size() + pair.plane];
      contact_force(now.law,
                    {model.planes[pair.plane].normal, pair.depth, pair.L, Vec3::Zero(), held, contact_mass_},
                    d, by_velocity);
      Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 6 + k_modes> j(3, n);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm_[c]);
      if (m > 0) j.rightCols(m) = frame.r * point_shape_.middleRows<3>(3 * pair.node);
      k -= j.transpose() * d * j;
      // the arm turns with the body
      k.block<3, 3>(3, 3) -= skew(pair.out.force) * skew(arm_[c]);
    }
    double left =
        std::max(load.head<3>().cwiseAbs().maxCoeff(), load.segment<3>(3).cwiseAbs().maxCoeff() / reach);
    if (m > 0) left = std::max(left, load.tail(m).cwiseAbs().maxCoeff() * std::sqrt(mass));
    if (left < k_balance * weight && sigma > 1) {
      for (const TouchingPair& pair : contacts_)
        stick[pair.point * model.planes.size() + pair.plane] = pair.out.stick;
      // a balance that tips over by itself
      const Matrix root = inertia_of.llt().matrixL();
      const Matrix scaled = root.triangularView<Eigen::Lower>().solve(
          Matrix(root.triangularView<Eigen::Lower>().solve((k + k.transpose()) / 2).transpose()));
      Eigen::SelfAdjointEigenSolver<Matrix> solver(scaled, Eigen::EigenvaluesOnly);
      return solver.eigenvalues()[0] > -1e-3 * parameters.gravity.norm() / reach;
    }
    const Vector x = (k + inertia_of / (sigma * sigma)).partialPivLu().solve(load);
    const BodyState before = s;
    const std::vector<Vec3> arms = arm_;
    const std::vector<TouchingPair> touching = contacts_;
    s.position += x.head<3>();
    s.rotation = (exp_quaternion(x.segment<3>(3)) * s.rotation).normalized();
    if (m > 0) s.amplitude.head(m) += x.tail(m).array();
    if (!((s.position - origin).norm() + reach * x.segment<3>(3).norm() < k_furthest * reach)) return false;
    // stick springs travel along
    find_touching(s, s.rotation.toRotationMatrix());
    std::vector<std::pair<std::size_t, Vec3>> moved;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const TouchingPair& pair = contacts_[c];
      const std::size_t at = pair.point * model.planes.size() + pair.plane;
      const Vec3 travel = s.position + arm_[c] - before.position - before.rotation * point(before, pair.node);
      const ContactOutput out = contact_force(now.law, {model.planes[pair.plane].normal, pair.depth, pair.L,
                                                        Vec3::Zero(), stick[at] + travel, contact_mass_});
      moved.emplace_back(at, out.stick);
    }
    for (const TouchingPair& pair : touching) stick[pair.point * model.planes.size() + pair.plane].setZero();
    for (const auto& [at, held] : moved) stick[at] = held;
    const double size = x.head<3>().norm() + reach * x.segment<3>(3).norm();
    sigma = std::clamp(sigma * (size < 0.01 * reach ? 2 : 0.5), k_first / 16, k_last);
  }
  return false;
}

double ReducedBody::look_ahead(const ContactLaw& law, const BodyState& s) const {
  double stiffness = 0, limit = k_longest_step;
  const Vec3 omega = s.rotation * s.angular_velocity;
  const Mat3 r = s.rotation.toRotationMatrix();
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    const double fastest = std::max(0., -plane.normal.dot(s.velocity)) + reach * omega.norm();
    const double height = plane.normal.dot(s.position - plane.point);
    if (height - reach - sides_[k * groups_.size()].threshold[0] > fastest * k_longest_step) continue;
    for (int p = 0; p < points_; ++p) {
      const Vec3 arm = r * place_[p];
      const double L = sides_[k * groups_.size() + p / k_width].L[p % k_width];
      const double gap =
          height + plane.normal.dot(arm) - sides_[k * groups_.size() + p / k_width].threshold[p % k_width];
      const double depth = -gap / L, closing = -plane.normal.dot(s.velocity + omega.cross(arm));
      if (depth > 0)
        stiffness += penalty_stiffness(law, depth, L);
      else if (closing * k_longest_step > gap)
        limit = std::min(limit, std::max(gap / closing, L / (k_closing_part * closing)));
    }
  }
  if (stiffness > 0) limit = std::min(limit, 2 * k_pi * std::sqrt(mass / stiffness) / k_contact_part);
  if (const double turning = omega.norm(); turning * limit > k_turn) limit = k_turn / turning;
  return limit;
}

}  // namespace topple
