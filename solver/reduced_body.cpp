#include "solver/reduced_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "solver/excitation.h"
#include "solver/rotation.h"
#include "solver/step_control.h"

namespace topple {
namespace {

constexpr double k_stable_turn = 0.6;  // rad per part of a step, of the stiffest motion on contacts; limit 2
constexpr double k_swing = 2.5;        // rad per part, of the highest mode
constexpr double k_small_turn = 0.02;  // rad
constexpr double k_velocity_error = 1e-7;  // of the speed
constexpr double k_good_rate = 0.1;        // of Newton with an old matrix
constexpr double k_same_line = 1e-6;       // m
constexpr double k_bend = 0.05;            // of the reach: more than an elastic body deforms
constexpr double k_slow = 1e-3;            // m/s, below it errors are absolute
constexpr int k_most_iterations = 20;
constexpr double k_least_part = 1. / 4096;  // of a step

double mean_width(const ContactPoint& point, const Plane& plane) {
  return (point.width + (plane.width > 0 ? plane.width : point.width)) / 2;
}

Four power(Four depth, double q) {
  if (q == 1) return depth;
  if (q == 2) return depth * depth;
  for (int i = 0; i < 4; ++i) depth.set(i, std::pow(depth[i], q));
  return depth;
}

// In place, of `fixed` unknowns or n. Damping makes the matrix more than M, so that nothing needs a pivot.
template <int fixed, class Matrix>
void factor(Matrix& a, int unknowns) {
  const int n = fixed > 0 ? fixed : unknowns;
  for (int k = 0; k < n; ++k) {
    a[k][k] = 1 / a[k][k];
    for (int i = k + 1; i < n; ++i) {
      const double part = a[i][k] *= a[k][k];
#pragma GCC unroll 6
      for (int j = k + 1; j < n; ++j) a[i][j] -= part * a[k][j];
    }
  }
}

template <int fixed, class Matrix>
void solve(const Matrix& a, double* x, int unknowns) {
  const int n = fixed > 0 ? fixed : unknowns;
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) x[i] -= a[i][j] * x[j];
    x[i] *= a[i][i];
  }
}

// Of a contact's springs, in any direction, over alpha/L.
double greatest_stiffness(const ContactLaw& law) {
  const double slope = law.q < 1 ? law.q * std::pow(0.01, law.q - 1) : law.q;
  return std::max(slope, law.kind == ContactLawKind::coulomb ? k_stick_stiffness : 0.);
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
  // Points that touch together stand together: a face's, then an edge's.
  std::sort(order.begin(), order.end(), [&](int p, int q) {
    const auto key = [&](int point) {
      const Vec3 at = (place_of(point) / k_same_line).array().round();
      return std::tuple(at.z(), at.x(), at.y(), point);
    };
    return key(p) < key(q);
  });
  const int modes = basis_ ? basis_->modes : 0;
  groups_.resize((order.size() + 4 - 1) / 4);
  sides_.resize(model.planes.size() * groups_.size());
  for (Side& side : sides_)
    side = {Four(-std::numeric_limits<double>::infinity()), Four(1), Four(1), Four(0)};
  widest_.assign(model.planes.size(), 0);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    group.place = in_all_lanes(Vec3::Zero());
    group.point.fill(-1);
    group.shape.assign(modes, in_all_lanes(Vec3::Zero()));
    for (int which = 0; which < 4 && g * 4 + which < order.size(); ++which) {
      const int p = order[g * 4 + which];
      const ContactPoint& point = model.contact_points[p];
      group.point[which] = p;
      set_lane(group.place, which, place_of(p));
      box_.extend(place_of(p));
      for (int k = 0; k < modes; ++k)
        set_lane(group.shape[k], which, basis_->shape.block<3, 1>(6 * (point.node - b.first_node), k));
      for (std::size_t k = 0; k < model.planes.size(); ++k) {
        Side& side = sides_[k * groups_.size() + g];
        side.L.set(which, mean_width(point, model.planes[k]));
        side.stick.set(which, k_stick_stiffness / side.L[which]);
        side.damping.set(which, 2 * k_stick_damping * std::sqrt(side.stick[which] * contact_mass_));
        side.gap.set(which, point.width / 2);
        widest_[k] = std::max(widest_[k], point.width / 2);
      }
    }
  }
  for (Touches* touches : {&touches_, &touches_before_}) touches->all.reserve(sides_.size());
  shapes_.reserve(sides_.size() * modes);
  const double inverse_moment = inverse_inertia_.trace();
  for (const Side& here : sides_)
    for (int which = 0; which < 4; ++which) {
      const Group& group = groups_[(&here - sides_.data()) % groups_.size()];
      if (group.point[which] < 0) continue;
      double inverse_mass = 1 / mass_ + lane(group.place, which).squaredNorm() * inverse_moment;
      for (const Points& shape : group.shape) inverse_mass += lane(shape, which).squaredNorm();
      stiffest_ += inverse_mass / here.L[which];
    }
}

ReducedBody::Points ReducedBody::place(const BodyState& s, const Group& group) const {
  Points at = group.place;
  for (int k = 0; k < modes(s); ++k) at = at + s.amplitude[k] * group.shape[k];
  return at;
}

// Height of the box over a plane's face along n, the normal in reference axes.
double ReducedBody::clearance(const Vec3& n, double height) const {
  return height + n.dot(box_.center()) - 0.5 * n.cwiseAbs().dot(box_.sizes());
}

void ReducedBody::find_touching(const BodyState& s, const Mat3& r) {
  touches_.count = 0;
  shapes_.clear();
  const int m = modes(s);
  const double bend = m > 0 ? k_bend * reach_ : 0;
  for (std::size_t k = 0; k < model_.planes.size(); ++k) {
    const Plane& plane = model_.planes[k];
    const double height = plane.normal.dot(s.position - plane.point);
    const Vec3 normal = r.transpose() * plane.normal;
    if (clearance(normal, height) > widest_[k] + bend) continue;
    const Points n = in_all_lanes(normal);
    const Four level = Four(height);
    const Side* const sides = &sides_[k * groups_.size()];
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Points at = groups_[g].place;
      for (int j = 0; j < m; ++j) at = at + s.amplitude[j] * groups_[g].shape[j];
      const Four gap = dot(n, at) + level - sides[g].gap;
      const Four::Mask touching = gap < 0;
      if (bits(touching) == 0) continue;
      Touch& touch = touches_.add();
      touch.plane = static_cast<int>(k);
      touch.group = static_cast<int>(g);
      touch.touching = touching;
      touch.depth = choose(touching, -gap / sides[g].L, Four(0));
      touch.arm = r * at;
      for (int j = 0; j < m; ++j) shapes_.push_back(r * groups_[g].shape[j]);
    }
  }
}

void ReducedBody::read_stick(std::span<const Vec3> stick, Touch& touch) const {
  touch.stick = in_all_lanes(Vec3::Zero());
  for (int which = 0; which < 4; ++which)
    if (touch.touching[which])
      set_lane(touch.stick, which,
               stick[groups_[touch.group].point[which] * model_.planes.size() + touch.plane]);
}

ReducedBody::Points ReducedBody::velocity_at(std::size_t touch, const Velocity& u, int m) const {
  Points v = in_all_lanes(u.linear) + cross(in_all_lanes(u.angular), touches_[touch].arm);
  for (int k = 0; k < m; ++k) v = v + u.rate[k] * shapes_[touch * m + k];
  return v;
}

// As contact_force, four by four, without position derivatives.
template <bool with_derivative>
void ReducedBody::respond_coulomb(const ContactLaw& law, const Points& v, Touch& touch,
                                  Derivative& derivative) const {
  const Side& here = side(touch);
  const Four zero = Four(0);
  const Points normal = in_all_lanes(model_.planes[touch.plane].normal);
  const Four vn = dot(normal, v);
  const double loss = normal_loss(law.restitution), eps = law.normal_speed;
  const Four inverse = 1 / sqrt(vn * vn + eps * eps);
  const Four spring = law.alpha * power(touch.depth, law.q);
  touch.conservative = choose(touch.touching, spring, zero);
  touch.normal = touch.conservative * (1 - loss * vn * inverse);

  const Four k = law.alpha * here.stick, c = std::sqrt(law.alpha) * here.damping;
  const Points stick = touch.stick - dot(normal, touch.stick) * normal;
  const Points trial = k * stick + c * (v - vn * normal);
  const Four limit = law.friction * touch.normal, size2 = dot(trial, trial);
  const Four::Mask sticks = size2 <= limit * limit;  // a NaN must not pass for sticking
  Four scale = Four(1), inverse_size = zero;
  if (bits(sticks | ~touch.touching) != k_all_lanes) {
    inverse_size = 1 / sqrt(size2);
    scale = choose(sticks, scale, limit * inverse_size);
    inverse_size = choose(sticks, zero, inverse_size);
  }
  scale = choose(touch.touching, scale, zero);
  touch.tangential = -scale * trial;
  const Four spring2 = k * k * dot(stick, stick);
  touch.stick_energy = 0.5 / k * choose(spring2 <= limit * limit, spring2, limit * limit);
  touch.stick_energy = choose(touch.touching, touch.stick_energy, zero);
  if constexpr (with_derivative) {
    const Four slope = -loss * eps * eps * touch.conservative * inverse * inverse * inverse;
    const Four across = c * scale, drag = law.friction * slope;
    const Points along = inverse_size * trial;
    const Four n[3] = {normal.x, normal.y, normal.z}, d[3] = {along.x, along.y, along.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        derivative[i][j] = (slope + across) * n[i] * n[j] + d[i] * (across * d[j] - drag * n[j]);
      derivative[i][i] -= across;
    }
  }
}

template <bool with_derivative>
void ReducedBody::respond(const ContactLaw& law, const Points& v, Touch& touch,
                          Derivative& derivative) const {
  if (law.kind == ContactLawKind::coulomb) return respond_coulomb<with_derivative>(law, v, touch, derivative);
  touch.conservative = touch.normal = touch.stick_energy = Four(0);
  touch.tangential = in_all_lanes(Vec3::Zero());
  for (auto& row : derivative) row.fill(Four(0));
  for (int which = 0; which < 4; ++which) {
    if (!touch.touching[which]) continue;
    Mat3 by_position, by_velocity;
    const ContactOutput out =
        contact_force(law,
                      {model_.planes[touch.plane].normal, touch.depth[which], side(touch).L[which],
                       lane(v, which), lane(touch.stick, which), contact_mass_},
                      by_position, by_velocity);
    touch.conservative.set(which, out.conservative);
    touch.normal.set(which, out.normal);
    set_lane(touch.tangential, which, out.tangential);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) derivative[i][j].set(which, by_velocity(i, j));
  }
}

// Travel of the stick springs after slipping, m.
ReducedBody::Points ReducedBody::held_stick(const ContactLaw& law, const Touch& touch) const {
  if (law.kind != ContactLawKind::coulomb) return in_all_lanes(Vec3::Zero());
  const Points normal = in_all_lanes(model_.planes[touch.plane].normal);
  const Points stick = touch.stick - dot(normal, touch.stick) * normal;
  const Four limit = law.friction * touch.normal / (law.alpha * side(touch).stick);
  const Four size2 = dot(stick, stick);
  const Four::Mask sticks = size2 <= limit * limit;
  if (bits(sticks | ~touch.touching) == k_all_lanes) return choose(touch.touching, Four(1), Four(0)) * stick;
  const Four scale = choose(sticks, Four(1), limit / sqrt(size2));
  return choose(touch.touching, scale, Four(0)) * stick;
}

void ReducedBody::sum_loads(const Vec3& field, BodyState& s) const {
  Points force = in_all_lanes(Vec3::Zero()), moment = force;
  const int m = modes(s);
  std::array<Four, k_modes> load{};
  for (std::size_t c = 0; c < touches_.size(); ++c) {
    const Touch& touch = touches_[c];
    const Points f = touch.normal * in_all_lanes(model_.planes[touch.plane].normal) + touch.tangential;
    force = force + f;
    moment = moment + cross(touch.arm, f);
    for (int k = 0; k < m; ++k) load[k] += dot(shapes_[c * m + k], f);
  }
  s.force = mass_ * field + sum(force);
  s.moment = sum(moment);
  for (int k = 0; k < m; ++k) s.load[k] = sum(load[k]);
}

// M - (h/2) sum J^T (df/dv) J of the rigid motions.
void ReducedBody::fill_rigid(const Mat3& inertia, double h, ReducedScratch& w) const {
  // force and moment by V and omega, per column
  Points upper[6], lower[6];
  for (int j = 0; j < 6; ++j) upper[j] = lower[j] = in_all_lanes(Vec3::Zero());
  for (std::size_t c = 0; c < touches_.size(); ++c) {
    const Derivative& d = w.derivatives[c];
    const Points& arm = touches_[c].arm;
    const auto add = [&](int j, const Points& f) {
      upper[j] = upper[j] + f;
      lower[j] = lower[j] + cross(arm, f);
    };
    const Points x{d[0][0], d[1][0], d[2][0]}, y{d[0][1], d[1][1], d[2][1]}, z{d[0][2], d[1][2], d[2][2]};
    add(0, x);
    add(1, y);
    add(2, z);
    add(3, arm.y * z - arm.z * y);
    add(4, arm.z * x - arm.x * z);
    add(5, arm.x * y - arm.y * x);
  }
  for (int j = 0; j < 6; ++j) {
    const Vec3 up = -h / 2 * sum(upper[j]), down = -h / 2 * sum(lower[j]);
    for (int i = 0; i < 3; ++i) {
      w.matrix[i][j] = up[i];
      w.matrix[3 + i][j] = down[i];
    }
  }
  for (int i = 0; i < 3; ++i) {
    w.matrix[i][i] += mass_;
    for (int j = 0; j < 3; ++j) w.matrix[3 + i][3 + j] += inertia(i, j);
  }
}

// The rows and columns of the modes.
void ReducedBody::fill_modes(double h, int m, ReducedScratch& w) const {
  Four left[k_modes][6], top[6][k_modes], corner[k_modes][k_modes];
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) left[k][i] = top[i][k] = Four(0);
    for (int j = 0; j < m; ++j) corner[k][j] = Four(0);
  }
  for (std::size_t c = 0; c < touches_.size(); ++c) {
    const Derivative& d = w.derivatives[c];
    const Points& arm = touches_[c].arm;
    const Points* const shape = &shapes_[c * m];
    for (int k = 0; k < m; ++k) {
      const Points& v = shape[k];
      const Points f{d[0][0] * v.x + d[0][1] * v.y + d[0][2] * v.z,
                     d[1][0] * v.x + d[1][1] * v.y + d[1][2] * v.z,
                     d[2][0] * v.x + d[2][1] * v.y + d[2][2] * v.z};
      const Points moment = cross(arm, f);
      top[0][k] += f.x;
      top[1][k] += f.y;
      top[2][k] += f.z;
      top[3][k] += moment.x;
      top[4][k] += moment.y;
      top[5][k] += moment.z;
      for (int j = 0; j < m; ++j) corner[j][k] += dot(shape[j], f);
      // the transpose's product: forces of the rigid columns on this mode
      const Points b{d[0][0] * v.x + d[1][0] * v.y + d[2][0] * v.z,
                     d[0][1] * v.x + d[1][1] * v.y + d[2][1] * v.z,
                     d[0][2] * v.x + d[1][2] * v.y + d[2][2] * v.z};
      const Points turned = cross(arm, b);
      left[k][0] += b.x;
      left[k][1] += b.y;
      left[k][2] += b.z;
      left[k][3] += turned.x;
      left[k][4] += turned.y;
      left[k][5] += turned.z;
    }
  }
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < 6; ++i) {
      w.matrix[i][6 + k] = -h / 2 * sum(top[i][k]);
      w.matrix[6 + k][i] = -h / 2 * sum(left[k][i]);
    }
    for (int j = 0; j < m; ++j) w.matrix[6 + k][6 + j] = -h / 2 * sum(corner[k][j]);
    w.matrix[6 + k][6 + k] += 1 / kick_[k];
  }
}

// The velocity u after half a step of what acts at its end, and the contact forces there. `free`: without
// contacts. Newton.
bool ReducedBody::solve_velocity(const ContactLaw& law, const Mat3& inertia, double h, const Velocity& free,
                                 Velocity& u, const BodyState& s, ReducedScratch& w) {
  const int m = modes(s);
  double* const side = w.side;
  bool fresh = true;
  double last = 0;
  for (int iteration = 0; iteration < k_most_iterations; ++iteration) {
    Points force = in_all_lanes(Vec3::Zero()), moment = force;
    std::array<Four, k_modes> load;
    for (int k = 0; k < m; ++k) load[k] = Four(0);
    for (std::size_t c = 0; c < touches_.size(); ++c) {
      Touch& touch = touches_[c];
      if (fresh)
        respond<true>(law, velocity_at(c, u, m), touch, w.derivatives[c]);
      else
        respond<false>(law, velocity_at(c, u, m), touch, w.derivatives[c]);
      const Points f = touch.normal * in_all_lanes(model_.planes[touch.plane].normal) + touch.tangential;
      force = force + f;
      moment = moment + cross(touch.arm, f);
      for (int k = 0; k < m; ++k) load[k] += dot(shapes_[c * m + k], f);
    }
    const Vec3 push = mass_ * (u.linear - free.linear) - h / 2 * sum(force),
               spin = inertia * (u.angular - free.angular) - h / 2 * sum(moment);
    for (int i = 0; i < 3; ++i) {
      side[i] = push[i];
      side[3 + i] = spin[i];
    }
    for (int k = 0; k < m; ++k) side[6 + k] = (u.rate[k] - free.rate[k]) / kick_[k] - h / 2 * sum(load[k]);
    if (fresh) {
      fill_rigid(inertia, h, w);
      if (m > 0) fill_modes(h, m, w);
      m > 0 ? factor<0>(w.matrix, 6 + m) : factor<6>(w.matrix, 6);
    }
    m > 0 ? solve<0>(w.matrix, side, 6 + m) : solve<6>(w.matrix, side, 6);
    double size = 0, speed = k_slow;
    for (int i = 0; i < 3; ++i) {
      u.linear[i] -= side[i];
      u.angular[i] -= side[3 + i];
      size += std::abs(side[i]) + reach_ * std::abs(side[3 + i]);
      speed += std::abs(u.linear[i]) + reach_ * std::abs(u.angular[i]);
    }
    for (int k = 0; k < m; ++k) {
      u.rate[k] -= side[6 + k];
      size += std::abs(side[6 + k]) / std::sqrt(mass_);
    }
    // what is left after the correction: its rate, or its square over that of the smoothing
    const double rate = fresh ? std::min(1., size / law.normal_speed) : size / last;
    if (size * rate <= k_velocity_error * speed) return true;
    fresh = iteration > 0 && rate > k_good_rate;
    last = size;
  }
  return false;
}

template <class F>
void ReducedBody::each_touching(const Touches& touches, F f) const {
  for (const Touch& touch : touches)
    for (int which = 0; which < 4; ++which)
      if (touch.touching[which])
        f(touch, which, groups_[touch.group].point[which],
          groups_[touch.group].point[which] * model_.planes.size() + touch.plane);
}

void ReducedBody::find_swing(double h) {
  if (swing_step_ == h) return;
  swing_step_ = h;
  for (int k = 0; k < k_modes; ++k) {
    const double w = basis_->frequency[k], half = w * h / 2;
    cosine_[k] = std::cos(w * h);
    sine_[k] = w > 0 ? std::sin(w * h) / w : 0;
    back_[k] = -w * std::sin(w * h);
    kick_[k] = half > 0 ? std::tan(half) / half : 1;
  }
}

// Returns the turn, a rotation vector in material axes.
Vec3 ReducedBody::drift(double h, BodyState& s) const {
  s.position += h * s.velocity;
  // The angular momentum stays. Lie midpoint for the turn: from the velocity in the middle of the step.
  const Vec3 momentum = inertia_ * s.angular_velocity;
  Vec3 middle = s.angular_velocity + h / 2 * (inverse_inertia_ * momentum.cross(s.angular_velocity));
  if (h * middle.norm() > k_small_turn)
    for (int pass = 0; pass < 4; ++pass)
      middle = inverse_inertia_ * (exp_quaternion(h / 2 * middle).conjugate() * momentum);
  const Vec3 spin = h * middle;
  const Quat turn = exp_quaternion(spin);
  s.rotation = s.rotation * turn;
  s.rotation.coeffs() *= 1.5 - 0.5 * s.rotation.squaredNorm();
  s.angular_velocity = inverse_inertia_ * (turn.conjugate() * momentum);
  if (s.rung != Rung::elastic) return spin;
  const Amplitudes q = s.amplitude;
  s.amplitude = cosine_ * q + sine_ * s.rate;
  s.rate = cosine_ * s.rate + back_ * q;
  return spin;
}

// With the contacts' springs and stick springs as stiff as they get, in all directions.
double ReducedBody::stable_part(const ContactLaw& law, const BodyState& s) {
  const int m = modes(s), n = 6 + m;
  const double swing = m > 0 ? k_swing / basis_->frequency[m - 1] : std::numeric_limits<double>::infinity();
  if (touches_.count == 0) return swing;
  std::uint64_t touching = 14695981039346656037ull;
  for (const Touch& touch : touches_) {
    std::uint64_t bits =
        static_cast<std::uint64_t>(touch.plane) << 32 | static_cast<std::uint64_t>(touch.group) << 8;
    for (int which = 0; which < 4; ++which) bits |= touch.touching[which] ? 1ull << which : 0;
    touching = (touching ^ bits) * 1099511628211ull;
  }
  for (const Known& known : known_)
    if (known.touching == touching && known.alpha == law.alpha && known.q == law.q &&
        known.kind == law.kind && known.rung == s.rung)
      return known.step;
  const Mat3 root = inertia_.llt().matrixL().solve(Mat3::Identity()).transpose();
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, k_unknowns, k_unknowns>;
  Matrix stiffness = Matrix::Zero(n, n);
  each_touching(touches_, [&](const Touch& touch, int which, int, std::size_t) {
    const Group& group = groups_[touch.group];
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, k_unknowns> j(3, n);
    j.leftCols<3>() = Mat3::Identity() / std::sqrt(mass_);
    j.middleCols<3>(3) = -skew(lane(group.place, which)) * root;
    for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = lane(group.shape[k], which);
    stiffness += law.alpha / side(touch).L[which] * greatest_stiffness(law) * j.transpose() * j;
  });
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(stiffness, Eigen::EigenvaluesOnly);
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
  Four held = Four(0);
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
  Derivative none;
  for (std::size_t c = 0; c < touches_.size(); ++c)
    respond<false>(law, velocity_at(c, u, modes(s)), touches_[c], none);
  found_at_ = s;
  found_law_ = law;
}

bool ReducedBody::known(const Instant& now, const BodyState& s) const {
  return found_at_ && found_law_ == now.law && found_at_->rung == s.rung &&
         found_at_->position == s.position && found_at_->rotation.coeffs() == s.rotation.coeffs() &&
         found_at_->velocity == s.velocity && found_at_->angular_velocity == s.angular_velocity &&
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

// False, and nothing is changed, when the velocity is not found.
bool ReducedBody::advance_part(const Parameters& parameters, const Instant& start, const Instant& end,
                               double h, BodyState& s, std::span<Vec3> stick, StepEnergy& booked,
                               ReducedScratch& w) {
  std::swap(touches_, touches_before_);
  const BodyState before = s;
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += h / 2 * (inverse_inertia_ * (s.rotation.conjugate() * s.moment));
  const bool bends = s.rung == Rung::elastic;
  if (bends) {
    find_swing(h);
    s.rate += h / 2 * kick_ * s.load;
  }
  const Vec3 spin = drift(h, s);

  const Mat3 r0 = before.rotation.toRotationMatrix(), r = s.rotation.toRotationMatrix();
  const Vec3 shift = s.position - before.position, field = parameters.gravity - end.floor;
  find_touching(s, r);
  for (Touch& touch : touches_) {
    read_stick(stick, touch);
    touch.travel = in_all_lanes(shift) + (touch.arm - r0 * place(before, groups_[touch.group]));
    touch.stick = touch.stick + touch.travel;
  }
  const Velocity drifted{s.velocity, s.rotation * s.angular_velocity, s.rate};
  if (!touches_.count == 0) {
    const Mat3 inertia = r * inertia_ * r.transpose();
    Velocity u = drifted;
    u.linear += h / 2 / mass_ * before.force;
    u.angular += r * (inverse_inertia_ * (r.transpose() * (h / 2 * before.moment)));
    if (bends) u.rate += h / 2 * kick_ * before.load;
    if (!solve_velocity(end.law, inertia, h, {drifted.linear + h / 2 * field, drifted.angular, drifted.rate},
                        u, s, w)) {
      s = before;
      std::swap(touches_, touches_before_);
      return false;
    }
  }
  sum_loads(field, s);
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += h / 2 * (inverse_inertia_ * (r.transpose() * s.moment));
  if (bends) s.rate += h / 2 * kick_ * s.load;

  // As book_work, and what the method itself takes out, from its own kinematics.
  booked.gravity -= mass_ * parameters.gravity.dot(shift);
  booked.input -= mass_ * 0.5 * (start.floor + end.floor).dot(shift);
  Four damped = Four(0), rubbed = damped;
  const auto book = [&](const Touch& touch, const Points& travel, double sign) {
    damped -= 0.5 * (touch.normal - touch.conservative) *
              dot(in_all_lanes(model_.planes[touch.plane].normal), travel);
    rubbed -= 0.5 * dot(touch.tangential, travel) + sign * touch.stick_energy;
  };
  for (const Touch& touch : touches_before_)
    book(touch, in_all_lanes(shift) + (r * place(s, groups_[touch.group]) - touch.arm), -1);
  for (const Touch& touch : touches_) book(touch, touch.travel, 1);
  booked.normal_damping += sum(damped);
  booked.friction += sum(rubbed);
  booked.numerical += 0.5 * (before.force + s.force).dot(shift) -
                      0.5 * mass_ * (s.velocity + before.velocity).dot(s.velocity - before.velocity) +
                      0.5 * (before.moment + s.moment).dot(r0 * spin) -
                      0.5 * (s.angular_velocity + before.angular_velocity)
                                .dot(inertia_ * (s.angular_velocity - before.angular_velocity));
  if (bends)
    booked.numerical +=
        (0.5 * (before.load + s.load) * (s.amplitude - before.amplitude) -
         0.5 * (s.rate.square() - before.rate.square()) -
         0.5 * basis_->frequency.square() * (s.amplitude.square() - before.amplitude.square()))
            .sum();
  book_law_change(start.law, end.law, touches_before_, booked);

  each_touching(touches_before_, [&](const Touch&, int, int, std::size_t at) { stick[at].setZero(); });
  keep_sticks(end.law, stick);
  return true;
}

// Stores the stick springs after slipping.
void ReducedBody::keep_sticks(const ContactLaw& law, std::span<Vec3> stick) {
  for (Touch& touch : touches_) touch.stick = held_stick(law, touch);
  each_touching(touches_, [&](const Touch& touch, int which, int, std::size_t at) {
    stick[at] = lane(touch.stick, which);
  });
}

// What a law that changes puts into springs.
void ReducedBody::book_law_change(const ContactLaw& before, const ContactLaw& after, const Touches& at_start,
                                  StepEnergy& booked) const {
  if (before.alpha == after.alpha && before.q == after.q) return;
  LawChange change(before, after, booked);
  each_touching(at_start, [&](const Touch& touch, int which, int, std::size_t) {
    change.book_start(touch.depth[which], side(touch).L[which], touch.stick_energy[which]);
  });
  each_touching(touches_, [&](const Touch& touch, int which, int, std::size_t) {
    change.book_end(touch.depth[which], side(touch).L[which], touch.stick_energy[which]);
  });
}

// The longest part of a step of size h that is stable: on what touches, and on what will. `touches_` may be
// those of a trial afterwards.
double ReducedBody::stable_size(const ContactLaw& law, double h, const BodyState& s) {
  const double now = stable_part(law, s), size = now < h ? h / std::ceil(h / now - 1e-9) : h;
  if (size * std::sqrt(law.alpha * greatest_stiffness(law) * stiffest_) < k_stable_turn) return size;
  BodyState ahead = s;
  ahead.velocity += size / 2 / mass_ * s.force;
  drift(size, ahead);
  std::swap(touches_, touches_before_);
  find_touching(ahead, ahead.rotation.toRotationMatrix());
  const double then = stable_part(law, s);
  std::swap(touches_, touches_before_);
  return then < size ? h / std::ceil(h / then - 1e-9) : size;
}

bool ReducedBody::advance(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                          BodyState& s, std::span<Vec3> stick, StepEnergy& booked, BodyEnergy& held,
                          ReducedScratch& w) {
  if (w.derivatives.size() < sides_.size()) w.derivatives.resize(sides_.size());
  Instant from = start;
  double left = h, most = h;
  for (bool last = false; !last;) {
    const double size = std::min(stable_size(from.law, left, s), most);
    last = size >= left;
    const Instant to = last ? end : Instant(parameters, from.time + size);
    if (!advance_part(parameters, from, to, last ? left : size, s, stick, booked, w)) {
      most = size / 2;
      if (most < k_least_part * h) return false;
      last = false;
      continue;
    }
    respond_at(to.law, s);
    left -= size;
    from = to;
  }
  held = energy(end.law, s);
  return true;
}

void ReducedBody::list_contacts(std::vector<ContactForce>& forces) const {
  each_touching(touches_, [&](const Touch& touch, int which, int point, std::size_t) {
    forces.push_back(
        {point, touch.plane, touch.depth[which], touch.normal[which],
         touch.normal[which] * model_.planes[touch.plane].normal + lane(touch.tangential, which)});
  });
}

// Calls f with the nodes that contacts push, numbered within the body, and the forces in reference axes.
template <class F>
void ReducedBody::each_force(const BodyState& s, F f) const {
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  each_touching(touches_, [&](const Touch& touch, int which, int point, std::size_t) {
    f(model_.contact_points[point].node - model_.bodies[body_].first_node,
      Vec3(back * (touch.normal[which] * model_.planes[touch.plane].normal + lane(touch.tangential, which))));
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

// Newton with K + M/sigma^2, sigma growing, on the normal forces of Eq. 2 with stick springs, as settle.h
// does for frames.
bool ReducedBody::settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick) {
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  constexpr int k_rounds = 400;
  constexpr double k_first = 1e-3, k_last = 1e3;           // s, sigma
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
  for (const Side& here : sides_)
    balanced += 8 * std::numeric_limits<double>::epsilon() * (reach_ + origin.norm()) * now.law.alpha *
                greatest_stiffness(now.law) / here.L[0];
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
    each_touching(touches_, [&](const Touch& touch, int which, int, std::size_t at) {
      Mat3 by_position, by_velocity;
      const Vec3& normal = model_.planes[touch.plane].normal;
      const ContactOutput out = contact_force(
          now.law, {normal, touch.depth[which], side(touch).L[which], Vec3::Zero(), stick[at], contact_mass_},
          by_position, by_velocity);
      const Vec3 arm = lane(touch.arm, which);
      Matrix j(3, n);
      j.leftCols<3>().setIdentity();
      j.middleCols<3>(3) = -skew(arm);
      for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = r * lane(groups_[touch.group].shape[k], which);
      stiffness -= j.transpose() * by_position * j;
      stiffness.block<3, 3>(3, 3) -= skew(out.force) * skew(arm);  // the arm turns with the body
    });
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
    // stick springs travel along
    std::vector<std::size_t> before_touching;
    each_touching(touches_, [&](const Touch&, int, int, std::size_t at) { before_touching.push_back(at); });
    find_touching(s, s.rotation.toRotationMatrix());
    for (Touch& touch : touches_) {
      read_stick(stick, touch);
      touch.stick = touch.stick + in_all_lanes(s.position - before.position) +
                    (touch.arm - before.rotation.toRotationMatrix() * place(before, groups_[touch.group]));
    }
    for (const std::size_t at : before_touching) stick[at].setZero();
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
    const Vec3 normal = r.transpose() * plane.normal;
    if (clearance(normal, height) - widest_[k] >
        (std::max(0., fall) + reach_ * omega.norm()) * k_longest_step)
      continue;
    const Points n = in_all_lanes(normal), turn = in_all_lanes(r.transpose() * plane.normal.cross(omega));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Side& side = sides_[k * groups_.size() + g];
      const Four gap = dot(n, groups_[g].place) + height - side.gap;
      const Four closing = fall - dot(turn, groups_[g].place);
      for (int which = 0; which < 4; ++which) {
        if (groups_[g].point[which] < 0) continue;
        if (gap[which] < 0)
          stiffness += penalty_stiffness(law, -gap[which] / side.L[which], side.L[which]);
        else if (closing[which] * k_longest_step > gap[which])
          limit = std::min(limit, std::max(gap[which] / closing[which],
                                           side.L[which] / (k_closing_part * closing[which])));
      }
    }
  }
  if (stiffness > 0) limit = std::min(limit, 2 * k_pi * std::sqrt(mass_ / stiffness) / k_contact_part);
  if (const double turning = omega.norm(); turning * limit > k_turn) limit = k_turn / turning;
  return limit;
}

}  // namespace topple
