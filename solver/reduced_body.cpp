#include "solver/reduced_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/excitation.h"
#include "solver/rotation.h"
#include "solver/step_control.h"

namespace topple {
namespace {

constexpr double k_stable_turn = 1.2;  // rad per part of a step, of the stiffest motion on contacts; limit 2
constexpr double k_swing = 2.5;        // rad per part, of the highest mode
constexpr double k_small_turn = 0.02;      // rad
constexpr double k_velocity_error = 1e-7;  // of the speed
constexpr double k_good_rate = 0.1;        // of Newton with an old matrix
constexpr double k_slow = 1e-3;            // m/s, below it errors are absolute
constexpr int k_most_iterations = 40;

double mean_width(const ContactPoint& point, const Plane& plane) {
  return (point.width + (plane.width > 0 ? plane.width : point.width)) / 2;
}

Pack power(Pack depth, double q) {
  if (q == 1) return depth;
  if (q == 2) return depth * depth;
  for (int i = 0; i < k_lanes; ++i) depth[i] = std::pow(depth[i], q);
  return depth;
}

}  // namespace

Instant::Instant(const Parameters& parameters, double t)
    : time(t), law(contact_law(parameters, t)), floor(floor_acceleration(parameters.shakes, t)) {}

ReducedBody::ReducedBody(const Model& model, int body)
    : model_(model),
      body_(body),
      mass_(model.bodies[body].mass),
      reach_(model.bodies[body].reach),
      inertia_(model.bodies[body].inertia),
      inverse_inertia_(inertia_.inverse()),
      basis_(model.bodies[body].elastic),
      contact_mass_(mass_ / std::max(1, model.bodies[body].contact_point_count)) {
  const Body& b = model.bodies[body];
  std::vector<int> order(b.contact_point_count);
  for (int p = 0; p < b.contact_point_count; ++p) order[p] = b.first_contact_point + p;
  const auto place_of = [&](int p) -> Vec3 {
    return model.node_position[model.contact_points[p].node] - b.centre_of_gravity;
  };
  // points that touch together stand together
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) { return place_of(p).z() < place_of(q).z(); });
  const int modes = basis_ ? basis_->modes : 0;
  groups_.resize((order.size() + k_lanes - 1) / k_lanes);
  sides_.resize(model.planes.size() * groups_.size());
  for (Side& side : sides_) side = {pack(-std::numeric_limits<double>::infinity()), pack(1), pack(1), pack(0)};
  nearest_.assign(model.planes.size(), 0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    group.place = pack3(Vec3::Zero());
    group.point.fill(-1);
    group.shape.assign(modes, pack3(Vec3::Zero()));
    for (int lane = 0; lane < k_lanes && g * k_lanes + lane < order.size(); ++lane) {
      const int p = order[g * k_lanes + lane];
      const ContactPoint& point = model.contact_points[p];
      group.point[lane] = p;
      group.place.set(lane, place_of(p));
      for (int k = 0; k < modes; ++k)
        group.shape[k].set(lane, basis_->shape.block<3, 1>(6 * (point.node - b.first_node), k));
      for (std::size_t k = 0; k < model.planes.size(); ++k) {
        Side& side = sides_[k * groups_.size() + g];
        side.L[lane] = mean_width(point, model.planes[k]);
        side.stick[lane] = k_stick_stiffness / side.L[lane];
        side.damping[lane] = 2 * k_stick_damping * std::sqrt(side.stick[lane] * contact_mass_);
        side.gap[lane] = point.width / 2;
        nearest_[k] = std::max(nearest_[k], point.width / 2 + 1.1 * reach_);
      }
    }
  }
  touches_.reserve(sides_.size());
  touches_start_.reserve(sides_.size());
  shapes_.reserve(sides_.size() * modes);
  derivatives_.resize(sides_.size());
}

Pack3 ReducedBody::place(const BodyState& s, const Group& group) const {
  Pack3 at = group.place;
  for (int k = 0; k < modes(s); ++k) at = at + s.amplitude[k] * group.shape[k];
  return at;
}

void ReducedBody::find_touching(const BodyState& s, const Mat3& r) {
  touches_.clear();
  shapes_.clear();
  const int m = modes(s);
  for (std::size_t k = 0; k < model_.planes.size(); ++k) {
    const Plane& plane = model_.planes[k];
    const double height = plane.normal.dot(s.position - plane.point);
    if (height > nearest_[k]) continue;
    const Pack3 n = pack3(r.transpose() * plane.normal);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Side& side = sides_[k * groups_.size() + g];
      const Pack3 at = place(s, groups_[g]);
      const Pack gap = dot(n, at) + height - side.gap;
      const PackMask touching = gap < 0;
      if (bits(touching) == 0) continue;
      Touch& touch = touches_.emplace_back();
      touch.plane = static_cast<int>(k);
      touch.group = static_cast<int>(g);
      touch.touching = touching;
      touch.depth = touching ? -gap / side.L : pack(0);
      touch.arm = r * at;
      for (int j = 0; j < m; ++j) shapes_.push_back(r * groups_[g].shape[j]);
    }
  }
}

void ReducedBody::read_stick(std::span<const Vec3> stick, Touch& touch) const {
  touch.stick = pack3(Vec3::Zero());
  for (int lane = 0; lane < k_lanes; ++lane)
    if (touch.touching[lane])
      touch.stick.set(lane, stick[groups_[touch.group].point[lane] * model_.planes.size() + touch.plane]);
}

Pack3 ReducedBody::velocity_at(std::size_t touch, const Velocity& u, int m) const {
  Pack3 v = pack3(u.linear) + cross(pack3(u.angular), touches_[touch].arm);
  for (int k = 0; k < m; ++k) v = v + u.rate[k] * shapes_[touch * m + k];
  return v;
}

// As contact_force, four by four, without position derivatives.
template <bool with_derivative>
void ReducedBody::respond_coulomb(const ContactLaw& law, const Pack3& v, Touch& touch,
                                  Derivative& derivative) const {
  const Side& here = side(touch);
  const Pack zero = pack(0);
  const Pack3 normal = pack3(model_.planes[touch.plane].normal);
  const Pack vn = dot(normal, v);
  const double loss = normal_loss(law.restitution), eps = law.normal_speed;
  const Pack inverse = 1 / square_root(vn * vn + eps * eps);
  const Pack spring = law.alpha * power(touch.depth, law.q);
  touch.conservative = touch.touching ? spring : zero;
  touch.normal = touch.conservative * (1 - loss * vn * inverse);

  const Pack k = law.alpha * here.stick, c = std::sqrt(law.alpha) * here.damping;
  const Pack3 stick = touch.stick - dot(normal, touch.stick) * normal;
  const Pack3 trial = k * stick + c * (v - vn * normal);
  const Pack limit = law.friction * touch.normal, size2 = dot(trial, trial);
  const PackMask sticks = size2 <= limit * limit;  // a NaN must not pass for sticking
  Pack scale = pack(1), inverse_size = zero;
  if (bits(sticks | ~touch.touching) != k_all_lanes) {
    inverse_size = 1 / square_root(size2);
    scale = sticks ? scale : limit * inverse_size;
    inverse_size = sticks ? zero : inverse_size;
  }
  scale = touch.touching ? scale : zero;
  touch.tangential = -scale * trial;
  const Pack spring2 = k * k * dot(stick, stick);
  touch.stick_energy = 0.5 / k * (spring2 <= limit * limit ? spring2 : limit * limit);
  touch.stick_energy = touch.touching ? touch.stick_energy : zero;
  if constexpr (with_derivative) {
    const Pack slope = -loss * eps * eps * touch.conservative * inverse * inverse * inverse;
    const Pack across = c * scale, drag = law.friction * slope;
    const Pack3 along = inverse_size * trial;
    const Pack n[3] = {normal.x, normal.y, normal.z}, d[3] = {along.x, along.y, along.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        derivative[i][j] = (slope + across) * n[i] * n[j] + d[i] * (across * d[j] - drag * n[j]);
      derivative[i][i] -= across;
    }
  }
}

template <bool with_derivative>
void ReducedBody::respond(const ContactLaw& law, const Pack3& v, Touch& touch, Derivative& derivative) const {
  if (law.kind == ContactLawKind::coulomb) return respond_coulomb<with_derivative>(law, v, touch, derivative);
  touch.conservative = touch.normal = touch.stick_energy = pack(0);
  touch.tangential = pack3(Vec3::Zero());
  for (auto& row : derivative) row.fill(pack(0));
  for (int lane = 0; lane < k_lanes; ++lane) {
    if (!touch.touching[lane]) continue;
    Mat3 by_position, by_velocity;
    const ContactOutput out =
        contact_force(law,
                      {model_.planes[touch.plane].normal, touch.depth[lane], side(touch).L[lane], v.lane(lane),
                       touch.stick.lane(lane), contact_mass_},
                      by_position, by_velocity);
    touch.conservative[lane] = out.conservative;
    touch.normal[lane] = out.normal;
    touch.tangential.set(lane, out.tangential);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) derivative[i][j][lane] = by_velocity(i, j);
  }
}

// Travel of the stick springs after slipping, m.
Pack3 ReducedBody::held_stick(const ContactLaw& law, const Touch& touch) const {
  if (law.kind != ContactLawKind::coulomb) return pack3(Vec3::Zero());
  const Pack3 normal = pack3(model_.planes[touch.plane].normal);
  const Pack3 stick = touch.stick - dot(normal, touch.stick) * normal;
  const Pack limit = law.friction * touch.normal / (law.alpha * side(touch).stick);
  const Pack size2 = dot(stick, stick);
  const Pack scale = size2 <= limit * limit ? pack(1) : limit / square_root(size2);
  return (touch.touching ? scale : pack(0)) * stick;
}

void ReducedBody::sum_loads(const Vec3& field, BodyState& s) const {
  Pack3 force = pack3(Vec3::Zero()), moment = force;
  const int m = modes(s);
  std::array<Pack, k_modes> load{};
  for (std::size_t c = 0; c < touches_.size(); ++c) {
    const Touch& touch = touches_[c];
    const Pack3 f = touch.normal * pack3(model_.planes[touch.plane].normal) + touch.tangential;
    force = force + f;
    moment = moment + cross(touch.arm, f);
    for (int k = 0; k < m; ++k) load[k] += dot(shapes_[c * m + k], f);
  }
  s.force = mass_ * field + sum(force);
  s.moment = sum(moment);
  for (int k = 0; k < m; ++k) s.load[k] = sum(load[k]);
}

// Of M - (h/2) sum J^T (df/dv) J, in place. Damping makes it more than M, so that nothing needs a pivot.
template <int fixed>
void ReducedBody::factor(const Mat3& inertia, double h, int m) {
  const int n = fixed > 0 ? fixed : 6 + m;
  Pack total[k_unknowns][k_unknowns];
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) total[i][j] = pack(0);
  Pack3 column[k_unknowns];
  for (std::size_t c = 0; c < touches_.size(); ++c) {
    const Derivative& d = derivatives_[c];
    const Pack3& arm = touches_[c].arm;
    const Pack zero = pack(0), one = pack(1);
    column[0] = {one, zero, zero};
    column[1] = {zero, one, zero};
    column[2] = {zero, zero, one};
    column[3] = {zero, -arm.z, arm.y};
    column[4] = {arm.z, zero, -arm.x};
    column[5] = {-arm.y, arm.x, zero};
    for (int k = 0; k < m; ++k) column[6 + k] = shapes_[c * m + k];
    for (int j = 0; j < n; ++j) {
      const Pack3& x = column[j];
      const Pack3 f{d[0][0] * x.x + d[0][1] * x.y + d[0][2] * x.z, d[1][0] * x.x + d[1][1] * x.y + d[1][2] * x.z,
                    d[2][0] * x.x + d[2][1] * x.y + d[2][2] * x.z};
      for (int i = 0; i < n; ++i) total[i][j] += dot(column[i], f);
    }
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) matrix_[i][j] = -h / 2 * sum(total[i][j]);
  for (int i = 0; i < 3; ++i) {
    matrix_[i][i] += mass_;
    for (int j = 0; j < 3; ++j) matrix_[3 + i][3 + j] += inertia(i, j);
  }
  for (int k = 6; k < n; ++k) matrix_[k][k] += 1;
  for (int k = 0; k < n; ++k) {
    matrix_[k][k] = 1 / matrix_[k][k];
    for (int i = k + 1; i < n; ++i) {
      const double part = matrix_[i][k] *= matrix_[k][k];
      for (int j = k + 1; j < n; ++j) matrix_[i][j] -= part * matrix_[k][j];
    }
  }
}

template <int fixed>
void ReducedBody::solve(int m) {
  const int n = fixed > 0 ? fixed : 6 + m;
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) side_[i] -= matrix_[i][j] * side_[j];
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) side_[i] -= matrix_[i][j] * side_[j];
    side_[i] *= matrix_[i][i];
  }
}

// The velocity u after half a step of what acts at its end, and the contact forces there. `free`: without
// contacts. Newton.
void ReducedBody::solve_velocity(const ContactLaw& law, const Mat3& inertia, double h, const Velocity& free,
                                 Velocity& u, const BodyState& s) {
  const int m = modes(s);
  bool fresh = true;
  double last = 0;
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    Pack3 force = pack3(Vec3::Zero()), moment = force;
    std::array<Pack, k_modes> load;
    for (int k = 0; k < m; ++k) load[k] = pack(0);
    for (std::size_t c = 0; c < touches_.size(); ++c) {
      Touch& touch = touches_[c];
      if (fresh)
        respond<true>(law, velocity_at(c, u, m), touch, derivatives_[c]);
      else
        respond<false>(law, velocity_at(c, u, m), touch, derivatives_[c]);
      const Pack3 f = touch.normal * pack3(model_.planes[touch.plane].normal) + touch.tangential;
      force = force + f;
      moment = moment + cross(touch.arm, f);
      for (int k = 0; k < m; ++k) load[k] += dot(shapes_[c * m + k], f);
    }
    const Vec3 push = mass_ * (u.linear - free.linear) - h / 2 * sum(force),
               spin = inertia * (u.angular - free.angular) - h / 2 * sum(moment);
    for (int i = 0; i < 3; ++i) {
      side_[i] = push[i];
      side_[3 + i] = spin[i];
    }
    for (int k = 0; k < m; ++k) side_[6 + k] = u.rate[k] - free.rate[k] - h / 2 * sum(load[k]);
    if (m == 0) {
      if (fresh) factor<6>(inertia, h, 0);
      solve<6>(0);
    } else {
      if (fresh) factor<0>(inertia, h, m);
      solve<0>(m);
    }
    double size = 0, speed = k_slow;
    for (int i = 0; i < 3; ++i) {
      u.linear[i] -= side_[i];
      u.angular[i] -= side_[3 + i];
      size += std::abs(side_[i]) + reach_ * std::abs(side_[3 + i]);
      speed += std::abs(u.linear[i]) + reach_ * std::abs(u.angular[i]);
    }
    for (int k = 0; k < m; ++k) {
      u.rate[k] -= side_[6 + k];
      size += std::abs(side_[6 + k]) / std::sqrt(mass_);
    }
    // what is left after the correction: its rate, or its square over that of the smoothing
    const double rate = fresh ? std::min(1., size / law.normal_speed) : size / last;
    if (!(size * rate > k_velocity_error * speed)) break;
    fresh = iteration > 0 && rate > k_good_rate;
    last = size;
  }
}

template <class F>
void ReducedBody::each_touching(const std::vector<Touch>& touches, F f) const {
  for (const Touch& touch : touches)
    for (int lane = 0; lane < k_lanes; ++lane)
      if (touch.touching[lane])
        f(touch, lane, groups_[touch.group].point[lane],
          groups_[touch.group].point[lane] * model_.planes.size() + touch.plane);
}

void ReducedBody::drift(double h, BodyState& s) {
  s.position += h * s.velocity;
  // Lie midpoint: the velocity of the middle of the step from the angular momentum, which stays
  const Vec3 momentum = inertia_ * s.angular_velocity;
  Vec3 middle = s.angular_velocity;
  const int passes = h * middle.norm() < k_small_turn ? 2 : 4;
  for (int pass = 0; pass < passes; ++pass)
    middle = inverse_inertia_ * (exp_quaternion(h / 2 * middle).conjugate() * momentum);
  const Quat turn = exp_quaternion(h * middle);
  s.rotation = (s.rotation * turn).normalized();
  s.angular_velocity = inverse_inertia_ * (turn.conjugate() * momentum);
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

// With the contacts' springs and stick springs as stiff as they get, in all directions.
double ReducedBody::stable_part(const ContactLaw& law, const BodyState& s) {
  const int m = modes(s), n = 6 + m;
  const double swing = m > 0 ? k_swing / basis_->frequency[m - 1] : std::numeric_limits<double>::infinity();
  if (touches_.empty()) return swing;
  std::uint64_t touching = 14695981039346656037ull;
  for (const Touch& touch : touches_) {
    std::uint64_t bits = static_cast<std::uint64_t>(touch.plane) << 32 | static_cast<std::uint64_t>(touch.group) << 8;
    for (int lane = 0; lane < k_lanes; ++lane) bits |= touch.touching[lane] ? 1ull << lane : 0;
    touching = (touching ^ bits) * 1099511628211ull;
  }
  for (const Known& known : known_)
    if (known.touching == touching && known.alpha == law.alpha && known.q == law.q && known.kind == law.kind &&
        known.rung == s.rung)
      return known.step;
  const double slope = law.q < 1 ? law.q * std::pow(0.01, law.q - 1) : law.q;
  const double stick = law.kind == ContactLawKind::coulomb ? k_stick_stiffness : 0;
  const Mat3 root = inertia_.llt().matrixL().solve(Mat3::Identity()).transpose();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  each_touching(touches_, [&](const Touch& touch, int lane, int, std::size_t) {
    const Group& group = groups_[touch.group];
    Eigen::MatrixXd j(3, n);
    j.leftCols<3>() = Mat3::Identity() / std::sqrt(mass_);
    j.middleCols<3>(3) = -skew(group.place.lane(lane)) * root;
    for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = group.shape[k].lane(lane);
    stiffness += law.alpha / side(touch).L[lane] * std::max(slope, stick) * j.transpose() * j;
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, Eigen::EigenvaluesOnly);
  const double step = std::min(swing, k_stable_turn / std::sqrt(solver.eigenvalues().tail<1>()[0]));
  known_[next_known_] = {touching, law.alpha, law.q, law.kind, s.rung, step};
  next_known_ = (next_known_ + 1) % static_cast<int>(known_.size());
  return step;
}

BodyEnergy ReducedBody::energy(const ContactLaw& law, const BodyState& s) const {
  BodyEnergy out;
  out.kinetic =
      0.5 * mass_ * s.velocity.squaredNorm() + 0.5 * s.angular_velocity.dot(inertia_ * s.angular_velocity);
  if (s.rung == Rung::elastic) {
    out.kinetic += 0.5 * s.rate.square().sum();
    out.strain = 0.5 * (basis_->frequency * s.amplitude).square().sum();
  }
  Pack held = pack(0);
  for (const Touch& touch : touches_) {
    held += touch.stick_energy;
    if (law.kind != ContactLawKind::printed)
      held += law.alpha / (law.q + 1) * side(touch).L * touch.depth * power(touch.depth, law.q);
  }
  out.contact = sum(held);
  return out;
}

// Forces of the touches at the velocity of `s`.
void ReducedBody::respond_at(const ContactLaw& law, const BodyState& s) {
  const Velocity u{s.velocity, s.rotation * s.angular_velocity, s.rate};
  for (std::size_t c = 0; c < touches_.size(); ++c)
    respond<false>(law, velocity_at(c, u, modes(s)), touches_[c], derivatives_[c]);
  found_at_ = s;
  found_law_ = law;
}

bool ReducedBody::known(const Instant& now, const BodyState& s) const {
  return found_at_ && found_law_ == now.law && found_at_->rung == s.rung && found_at_->position == s.position &&
         found_at_->rotation.coeffs() == s.rotation.coeffs() && found_at_->velocity == s.velocity &&
         found_at_->angular_velocity == s.angular_velocity &&
         (s.rung == Rung::rigid ||
          ((found_at_->amplitude == s.amplitude).all() && (found_at_->rate == s.rate).all()));
}

BodyEnergy ReducedBody::find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick) {
  if (!known(now, s)) {
    find_touching(s, s.rotation.toRotationMatrix());
    for (Touch& touch : touches_) read_stick(stick, touch);
    respond_at(now.law, s);
  }
  return energy(now.law, s);
}

BodyEnergy ReducedBody::balance(const Parameters& parameters, const Instant& now, BodyState& s,
                                std::span<const Vec3> stick) {
  const BodyEnergy held = find_contacts(now, s, stick);
  s.load.setZero();
  sum_loads(parameters.gravity - now.floor, s);
  return held;
}

void ReducedBody::advance_part(const Parameters& parameters, const Instant& start, const Instant& end,
                               double h, BodyState& s, std::span<Vec3> stick, StepEnergy& booked) {
  std::swap(touches_, touches_start_);
  const BodyState before = s;
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += h / 2 * (inverse_inertia_ * (s.rotation.conjugate() * s.moment));
  s.rate += h / 2 * s.load;
  drift(h, s);

  const Mat3 r0 = before.rotation.toRotationMatrix(), r = s.rotation.toRotationMatrix();
  const Vec3 shift = s.position - before.position, field = parameters.gravity - end.floor;
  find_touching(s, r);
  for (Touch& touch : touches_) {
    read_stick(stick, touch);
    touch.stick = touch.stick + pack3(shift) + (touch.arm - r0 * place(before, groups_[touch.group]));
  }
  const Velocity drifted{s.velocity, s.rotation * s.angular_velocity, s.rate};
  if (!touches_.empty()) {
    const Mat3 inertia = r * inertia_ * r.transpose();
    Velocity u = drifted;
    u.linear += h / 2 / mass_ * before.force;
    u.angular += r * (inverse_inertia_ * (r.transpose() * (h / 2 * before.moment)));
    u.rate += h / 2 * before.load;
    solve_velocity(end.law, inertia, h, {drifted.linear + h / 2 * field, drifted.angular, drifted.rate}, u, s);
  }
  sum_loads(field, s);
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += h / 2 * (inverse_inertia_ * (r.transpose() * s.moment));
  s.rate += h / 2 * s.load;

  // As book_work, and what the method itself takes out, from its own kinematics.
  booked.gravity -= mass_ * parameters.gravity.dot(shift);
  booked.input -= mass_ * 0.5 * (start.floor + end.floor).dot(shift);
  Pack damped = pack(0), rubbed = damped;
  const auto book = [&](const Touch& touch, const Pack3& travel, double sign) {
    damped -= 0.5 * (touch.normal - touch.conservative) * dot(pack3(model_.planes[touch.plane].normal), travel);
    rubbed -= 0.5 * dot(touch.tangential, travel) + sign * touch.stick_energy;
  };
  for (const Touch& touch : touches_start_)
    book(touch, pack3(shift) + (r * place(s, groups_[touch.group]) - touch.arm), -1);
  for (const Touch& touch : touches_)
    book(touch, pack3(shift) + (touch.arm - r0 * place(before, groups_[touch.group])), 1);
  booked.normal_damping += sum(damped);
  booked.friction += sum(rubbed);
  const Vec3 spin = before.rotation * log_quaternion(before.rotation.conjugate() * s.rotation);
  booked.numerical += 0.5 * (before.force + s.force).dot(shift) -
                      0.5 * mass_ * (s.velocity + before.velocity).dot(s.velocity - before.velocity) +
                      0.5 * (before.moment + s.moment).dot(spin) -
                      0.5 * (s.angular_velocity + before.angular_velocity)
                                .dot(inertia_ * (s.angular_velocity - before.angular_velocity));
  if (s.rung == Rung::elastic)
    booked.numerical +=
        (0.5 * (before.load + s.load) * (s.amplitude - before.amplitude) -
         0.5 * (s.rate.square() - before.rate.square()) -
         0.5 * basis_->frequency.square() * (s.amplitude.square() - before.amplitude.square()))
            .sum();
  book_law_change(start.law, end.law, booked);

  each_touching(touches_start_,
                [&](const Touch&, int, int, std::size_t at) { stick[at].setZero(); });
  keep_sticks(end.law, stick);
}

// Stores the stick springs after slipping.
void ReducedBody::keep_sticks(const ContactLaw& law, std::span<Vec3> stick) {
  for (Touch& touch : touches_) touch.stick = held_stick(law, touch);
  each_touching(touches_,
                [&](const Touch& touch, int lane, int, std::size_t at) { stick[at] = touch.stick.lane(lane); });
}

// What a law that changes puts into springs.
void ReducedBody::book_law_change(const ContactLaw& before, const ContactLaw& after, StepEnergy& booked) const {
  if (before.alpha == after.alpha && before.q == after.q) return;
  LawChange change(before, after, booked);
  each_touching(touches_start_, [&](const Touch& touch, int lane, int, std::size_t) {
    change.book_start(touch.depth[lane], side(touch).L[lane], touch.stick_energy[lane]);
  });
  each_touching(touches_, [&](const Touch& touch, int lane, int, std::size_t) {
    change.book_end(touch.depth[lane], side(touch).L[lane], touch.stick_energy[lane]);
  });
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
    respond_at(to.law, s);
    from = to;
  }
  return energy(from.law, s);
}

void ReducedBody::list_contacts(std::vector<ContactForce>& forces) const {
  each_touching(touches_, [&](const Touch& touch, int lane, int point, std::size_t) {
    forces.push_back({point, touch.plane, touch.depth[lane], touch.normal[lane],
                      touch.normal[lane] * model_.planes[touch.plane].normal + touch.tangential.lane(lane)});
  });
}

// Calls f with the nodes that contacts push, numbered within the body, and the forces in reference axes.
template <class F>
void ReducedBody::each_force(const BodyState& s, F f) const {
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  each_touching(touches_, [&](const Touch& touch, int lane, int point, std::size_t) {
    f(model_.contact_points[point].node - model_.bodies[body_].first_node,
      Vec3(back * (touch.normal[lane] * model_.planes[touch.plane].normal + touch.tangential.lane(lane))));
  });
}

void ReducedBody::section_forces(const BodyState& s, std::vector<SectionForces>& sections) {
  const Body& body = model_.bodies[body_];
  if (s.rung == Rung::rigid) {
    std::fill_n(sections.begin() + body.first_element, body.element_count,
                SectionForces{Vec3::Zero(), Vec3::Zero()});
    return;
  }
  section_.noalias() = basis_->section * s.amplitude.head(basis_->modes).matrix();
  each_force(s, [&](int node, const Vec3& f) {
    section_.noalias() += basis_->residual_section.middleCols<3>(3 * node) * f;
  });
  for (int e = 0; e < body.element_count; ++e)
    sections[body.first_element + e] = {section_.segment<3>(6 * e), section_.segment<3>(6 * e + 3)};
}

void ReducedBody::add_residual(const BodyState& s, State& state) const {
  if (s.rung != Rung::elastic) return;
  const Body& body = model_.bodies[body_];
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6 * body.node_count);
  each_force(s, [&](int node, const Vec3& f) { u += basis_->residual_shape.middleCols<3>(3 * node) * f; });
  for (int i = 0; i < body.node_count; ++i) {
    state.position[body.first_node + i] += s.rotation * Vec3(u.segment<3>(6 * i));
    Quat& q = state.rotation[body.first_node + i];
    q = (exp_quaternion(s.rotation * Vec3(u.segment<3>(6 * i + 3))) * q).normalized();
  }
}

double ReducedBody::yield_bound(const BodyState& s) const {
  double bound = basis_->mode_yield.dot(s.amplitude.head(basis_->modes).abs().matrix());
  each_force(s, [&](int node, const Vec3& f) {
    bound += basis_->residual_yield.segment<3>(3 * node).dot(f.cwiseAbs());
  });
  return bound;
}

double ReducedBody::rotation_bound(const BodyState& s) const {
  return basis_->mode_rotation.dot(s.amplitude.head(basis_->modes).abs().matrix());
}

// Newton with K + M/sigma^2, sigma growing, on the normal forces of Eq. 2 with stick springs, as settle.h does
// for frames.
bool ReducedBody::settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick) {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  constexpr int k_rounds = 400;
  constexpr double k_first = 1e-3, k_last = 1e3;            // s, sigma
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
  const double weight = mass_ * parameters.gravity.norm();
  double sigma = k_first;
  for (int round = 0; round < k_rounds; ++round) {
    balance(still, now, s, stick);
    const Mat3 r = s.rotation.toRotationMatrix();
    Vector load(n);
    load.head<3>() = s.force;
    load.segment<3>(3) = s.moment;
    Matrix stiffness = Matrix::Zero(n, n), inertia = Matrix::Zero(n, n);
    inertia.topLeftCorner<3, 3>() = mass_ * Mat3::Identity();
    inertia.block<3, 3>(3, 3) = r * inertia_ * r.transpose();
    if (m > 0) {
      load.tail(m) = s.load.head(m) - basis_->frequency.head(m).square() * s.amplitude.head(m);
      inertia.bottomRightCorner(m, m).setIdentity();
      stiffness.bottomRightCorner(m, m).diagonal() = basis_->frequency.head(m).square();
    }
    each_touching(touches_, [&](const Touch& touch, int lane, int, std::size_t at) {
      Mat3 by_position, by_velocity;
      const Vec3& normal = model_.planes[touch.plane].normal;
      const ContactOutput out =
          contact_force(now.law, {normal, touch.depth[lane], side(touch).L[lane], Vec3::Zero(), stick[at], contact_mass_},
                        by_position, by_velocity);
      const Vec3 arm = touch.arm.lane(lane);
      Matrix j(3, n);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm);
      for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = r * groups_[touch.group].shape[k].lane(lane);
      stiffness -= j.transpose() * by_position * j;
      stiffness.block<3, 3>(3, 3) -= skew(out.force) * skew(arm);  // the arm turns with the body
    });
    double left = std::max(s.force.cwiseAbs().maxCoeff(), s.moment.cwiseAbs().maxCoeff() / reach_);
    if (m > 0) left = std::max(left, load.tail(m).cwiseAbs().maxCoeff() * std::sqrt(mass_));
    if (left < k_balanced * weight && sigma > 1) {
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
    // stick springs travel along
    std::swap(touches_, touches_start_);
    find_touching(s, s.rotation.toRotationMatrix());
    for (Touch& touch : touches_) {
      read_stick(stick, touch);
      touch.stick = touch.stick + pack3(s.position - before.position) +
                    (touch.arm - before.rotation.toRotationMatrix() * place(before, groups_[touch.group]));
    }
    each_touching(touches_start_, [&](const Touch&, int, int, std::size_t at) { stick[at].setZero(); });
    respond_at(now.law, s);
    keep_sticks(now.law, stick);
    found_at_.reset();
    sigma = std::clamp(sigma * (size < 0.01 * reach_ ? 2 : 0.5), k_first / 16, k_last);
  }
  return false;
}

double ReducedBody::look_ahead(const ContactLaw& law, const BodyState& s) {
  double stiffness = 0, limit = k_longest_step;
  const Vec3 omega = s.rotation * s.angular_velocity;
  const Mat3 r = s.rotation.toRotationMatrix();
  for (std::size_t k = 0; k < model_.planes.size(); ++k) {
    const Plane& plane = model_.planes[k];
    const double fall = -plane.normal.dot(s.velocity), height = plane.normal.dot(s.position - plane.point);
    if (height - nearest_[k] > (std::max(0., fall) + reach_ * omega.norm()) * k_longest_step) continue;
    const Pack3 n = pack3(r.transpose() * plane.normal), turn = pack3(r.transpose() * plane.normal.cross(omega));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Side& side = sides_[k * groups_.size() + g];
      const Pack gap = dot(n, groups_[g].place) + height - side.gap;
      const Pack closing = fall - dot(turn, groups_[g].place);
      for (int lane = 0; lane < k_lanes; ++lane) {
        if (groups_[g].point[lane] < 0) continue;
        if (gap[lane] < 0)
          stiffness += penalty_stiffness(law, -gap[lane] / side.L[lane], side.L[lane]);
        else if (closing[lane] * k_longest_step > gap[lane])
          limit = std::min(limit, std::max(gap[lane] / closing[lane], side.L[lane] / (k_closing_part * closing[lane])));
      }
    }
  }
  if (stiffness > 0) limit = std::min(limit, 2 * k_pi * std::sqrt(mass_ / stiffness) / k_contact_part);
  if (const double turning = omega.norm(); turning * limit > k_turn) limit = k_turn / turning;
  return limit;
}

}  // namespace topple
