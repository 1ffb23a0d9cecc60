#include "solver/reduced/reduced_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/contact_law.h"
#include "solver/element/damping.h"
#include "solver/math/elementary.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_stable_turn = 0.6;          // rad per substep, of the stiffest motion on contacts; limit 2
constexpr double k_quiet_turn = 1.5;           // likewise, of a quiet body
constexpr double k_free_turn = 2.5;            // rad per substep, of the highest mode
constexpr double k_small_turn = 0.02;          // rad
constexpr double k_least_substep = 1. / 4096;  // of a step
constexpr double k_substep_rounding = 1e-12;   // of it

// Of a contact's springs, in any direction, over alpha/L.
double greatest_stiffness(const ContactLaw& law) {
  const auto [normal, tangential] = stiffness_bound(law);
  return std::max(normal, tangential);
}

// f(k) for the modes k .. k + 3 of Amplitudes, which Eigen would take one by one.
template <class F>
[[gnu::always_inline]] inline void each_four_modes(F f) {
  static_assert(k_modes % 4 == 0);
  for (int k = 0; k < k_modes; k += 4) f(k);
}
// sum += factor a b
[[gnu::always_inline]] inline void add_product(double factor, const Amplitudes& a, const Amplitudes& b,
                                               Amplitudes& sum) {
  each_four_modes([&](int k) { store(&sum[k], load(&sum[k]) + Four(factor) * load(&a[k]) * load(&b[k])); });
}

}  // namespace

ReducedBody::ReducedBody(const Model& model, int body)
    : model_(model),
      body_(body),
      mass_(model.bodies[body].mass),
      reach_(model.bodies[body].reach),
      least_inertia_(Eigen::SelfAdjointEigenSolver<Mat3>(model.bodies[body].inertia).eigenvalues()[0]),
      inertia_(packed(model.bodies[body].inertia)),
      inverse_inertia_(packed(Mat3(model.bodies[body].inertia.inverse()))),
      basis_(model.bodies[body].elastic),
      contacts_(model, body),
      anchors_(model, body) {
  if (!basis_) return;
  const Body& own = model.bodies[body];
  for (int p = own.first_contact_point; p < own.first_contact_point + own.contact_point_count; ++p) {
    const int node = node_of(p) - own.first_node;
    const Vec3 stress = basis_->rest_stress.segment<3>(3 * node),
               beyond = basis_->beyond.segment<3>(3 * node);
    greatest_shape_ = std::max(greatest_shape_, basis_->shape.middleRows<3>(6 * node).norm());
    greatest_beyond_ = std::max(greatest_beyond_, beyond.maxCoeff());
    greatest_stress_ = std::max(greatest_stress_, stress.maxCoeff());
    if (ranges::find(own.base_points, p) == own.base_points.end()) continue;
    base_beyond_ = std::max(base_beyond_, beyond.z());
    base_stress_ = std::max(base_stress_, stress.z());
  }
}

Vec3 ReducedBody::angular_acceleration(const BodyState& s) const {
  const PackVec3 omega = packed(s.angular_velocity),
                 moment = rotate(conjugate(packed(s.rotation)), packed(s.moment));
  return unpacked(inverse_inertia_ * (moment - cross(omega, inertia_ * omega)));
}

void ReducedBody::find_propagator(double h, double damping) {
  if (free_step_ == h && free_damping_ == damping) return;
  free_step_ = h;
  free_damping_ = damping;
  for (int k = 0; k < k_modes; ++k) {
    const double w = basis_->frequency[k], half = w * h / 2;
    cosine_[k] = elementary::cos(w * h);
    sine_[k] = w > 0 ? elementary::sin(w * h) / w : 0;
    back_[k] = -w * elementary::sin(w * h);
    kick_[k] = half > 0 ? elementary::tan(half) / half : 1;
    damped_[k] = damping > 0 ? elementary::exp(-damping * h * (w * w)) : 1;
  }
}

Vec3 ReducedBody::drift(double h, BodyState& s) const {
  s.position += h * s.velocity;
  // The angular momentum stays. Lie midpoint for the turn: from the velocity in the middle of the step.
  const PackVec3 omega = packed(s.angular_velocity), momentum = inertia_ * omega;
  const auto turn_of = [](const PackVec3& v) { return packed(exp_quaternion(unpacked(v))); };
  PackVec3 middle = omega + h / 2 * (inverse_inertia_ * cross(momentum, omega));
  if (h * h * dot(middle, middle) > k_small_turn * k_small_turn)
    for (int pass = 0; pass < 4; ++pass)
      middle = inverse_inertia_ * rotate(conjugate(turn_of(h / 2 * middle)), momentum);
  const PackVec3 spin = h * middle;
  const PackQuaternion<double> turn = turn_of(spin), now = normalized(packed(s.rotation) * turn);
  s.rotation.coeffs() << now.v.x, now.v.y, now.v.z, now.w;
  s.angular_velocity = unpacked(inverse_inertia_ * rotate(conjugate(turn), momentum));
  if (s.level != ModelLevel::elastic) return unpacked(spin);
  each_four_modes([&](int k) {
    const Four q = load(&s.amplitude[k]), rate = load(&s.rate[k]), cosine = load(&cosine_[k]);
    store(&s.amplitude[k], cosine * q + load(&sine_[k]) * rate);
    store(&s.rate[k], cosine * rate + load(&back_[k]) * q);
  });
  return unpacked(spin);
}

// An elastic body on which forces are near balance, while its modes are near rest: what it bears hardly
// changes as it bounces.
bool ReducedBody::is_quiet(const Parameters& parameters, const BodyState& s) const {
  constexpr double k_part = 0.02;
  if (s.level != ModelLevel::elastic) return false;
  const double weight = mass_ * parameters.gravity.norm();
  const double swings = s.rate.square().sum(), holds = (basis_->frequency * s.amplitude).square().sum();
  return s.force.norm() < k_part * weight && s.moment.norm() < k_part * weight * reach_ &&
         swings < k_part * k_part * holds;
}

// The longest substep that is stable on what touches.
double ReducedBody::stable_substep(const Parameters& parameters, const ContactLaw& law, const BodyState& s) {
  const int m = modes(s);
  const double free_limit =
      m > 0 ? k_free_turn / basis_->frequency[m - 1] : std::numeric_limits<double>::infinity();
  if (!contacts_.any() && !anchors_.holds()) return free_limit / parameters.substep_refinement;
  const std::uint64_t touching = contacts_.hash() ^ anchors_.hash();
  const double turn = is_quiet(parameters, s) ? k_quiet_turn : k_stable_turn;
  const auto step = [&](double frequency) {
    return std::min(free_limit, turn / frequency) / parameters.substep_refinement;
  };
  for (const Known& known : known_)
    if (known.touching == touching && known.alpha == law.alpha && known.q == law.q &&
        known.kind == law.kind && known.level == s.level)
      return step(known.frequency);
  const double frequency = highest_frequency(law, s);
  known_[next_known_] = {touching, law.alpha, law.q, law.kind, s.level, frequency};
  next_known_ = (next_known_ + 1) % static_cast<int>(known_.size());
  return step(frequency);
}

// rad/s, on what touches, with springs and stick springs as stiff as they get, in all directions.
double ReducedBody::highest_frequency(const ContactLaw& law, const BodyState& s) const {
  const int m = modes(s), n = 6 + m;
  const Mat3 root = model_.bodies[body_].inertia.llt().matrixL().solve(Mat3::Identity()).transpose();
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6 + k_modes, 6 + k_modes>;
  Matrix stiffness = Matrix::Zero(n, n);
  contacts_.each([&](const BodyContacts::Touch& touch, int lane, int, std::size_t) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6 + k_modes> j(3, n);
    j.leftCols<3>() = Mat3::Identity() / std::sqrt(mass_);
    j.middleCols<3>(3) = -skew(contacts_.place(touch, lane)) * root;
    for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = contacts_.shape(touch, lane, k);
    stiffness += law.alpha / contacts_.length(touch, lane) * greatest_stiffness(law) * j.transpose() * j;
  });
  for (const BodyAnchors::Tie& tie : anchors_.ties()) {
    if (tie.state.hold != AnchorHold::in_place) continue;
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6 + k_modes> j(3, n);
    j.leftCols<3>() = Mat3::Identity() / std::sqrt(mass_);
    j.middleCols<3>(3) = -skew(tie.place) * root;
    for (int k = 0; k < m; ++k) j.block<3, 1>(0, 6 + k) = tie.shape[k];
    stiffness += tie.anchor->stiffness * j.transpose() * j;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(stiffness, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues().tail<1>()[0]);
}

BodyEnergy ReducedBody::energy(const ContactLaw& law, const BodyState& s) const {
  BodyEnergy out;
  const PackVec3 omega = packed(s.angular_velocity);
  out.kinetic = 0.5 * mass_ * s.velocity.squaredNorm() + 0.5 * dot(omega, inertia_ * omega);
  if (s.level == ModelLevel::elastic) {
    out.kinetic += 0.5 * s.rate.square().sum();
    out.strain = 0.5 * (basis_->frequency * s.amplitude).square().sum();
  }
  out.contact = contacts_.energy(law);
  out.anchor = anchors_.energy();
  return out;
}

// Forces of what touches at the velocity of `s`.
template <ContactSums sums>
ContactLoads ReducedBody::respond_at(const PreparedLaw& law, const BodyState& s) {
  Found& found = found_ ? *found_ : found_.emplace();
  found.level = s.level;
  found.rotation = s.rotation;
  found.position = s.position;
  found.velocity = s.velocity;
  found.angular_velocity = s.angular_velocity;
  found.law = static_cast<const ContactLaw&>(law);
  if (s.level == ModelLevel::elastic) {
    found.amplitude = s.amplitude;
    found.rate = s.rate;
  }
  return contacts_.evaluate_forces<false, sums>(
      law, {packed(s.velocity), rotate(packed(s.rotation), packed(s.angular_velocity)), s.rate}, 0);
}
template ContactLoads ReducedBody::respond_at<ContactSums::none>(const PreparedLaw&, const BodyState&);
template ContactLoads ReducedBody::respond_at<ContactSums::loads>(const PreparedLaw&, const BodyState&);

bool ReducedBody::known(const StepInputs& now, const BodyState& s) const {
  if (!found_ || found_->level != s.level || !(found_->law == now.law)) return false;
  const Found& found = *found_;
  Four::Mask same = load(found.rotation.coeffs().data()) == load(s.rotation.coeffs().data());
  const auto look = [&](const Vec3& a, const Vec3& b) {
    same &= Four(Four::Vector{a.x(), a.y(), a.z(), 0}) == Four(Four::Vector{b.x(), b.y(), b.z(), 0});
  };
  look(found.position, s.position);
  look(found.velocity, s.velocity);
  look(found.angular_velocity, s.angular_velocity);
  return bits(same) == k_all_lanes &&
         (!traits(s.level).has_modes ||
          ((found.amplitude == s.amplitude).all() && (found.rate == s.rate).all()));
}

void ReducedBody::find_contacts(const StepInputs& now, const BodyState& s, std::span<const Vec3> stick) {
  if (!known(now, s)) {
    contacts_.find(s, rotation_matrix(packed(s.rotation)), stick);
    respond_at<ContactSums::none>(now.law, s);
  }
  anchors_.take(now.pulls);
  anchors_.find(s);
}

BodyEnergy ReducedBody::balance(const Parameters& parameters, const StepInputs& now, BodyState& s,
                                std::span<const Vec3> stick) {
  contacts_.find(s, rotation_matrix(packed(s.rotation)), stick);
  anchors_.take(now.pulls);
  anchors_.find(s);
  const ContactLoads loads = respond_at<ContactSums::loads>(now.law, s);
  s.load.setZero();
  contacts_.modal_loads(modes(s), s.load);
  s.force = mass_ * (parameters.gravity - now.floor) + unpacked(loads.force);
  s.moment = unpacked(loads.moment);
  if (anchors_.any()) {
    anchors_.modal_loads(s, modes(s), s.load);
    s.force += anchors_.force();
    s.moment += anchors_.moment();
  }
  return energy(now.law, s);
}

// A substep, from its start to where it leads. What `before` leads to is filled in by move_freely.
struct ReducedBody::ExplicitSubstep {
  ExplicitSubstep(const StepInputs& start_, const StepInputs& end_, double h_, const BodyState& s)
      : start(start_), end(end_), h(h_), bends(s.level == ModelLevel::elastic), before(s) {}
  const StepInputs &start, &end;
  double h;
  bool bends;
  BodyState before;
  Amplitudes rate0;  // of `before`, after damping; when it bends
  PackMat3 r0, r;    // rotation matrices at the start and the end
  Vec3 spin, shift;  // rad, material axes; m
};

// Half an impulse of what acts at the start, and free motion.
[[gnu::always_inline]] inline ReducedBody::ExplicitSubstep ReducedBody::move_freely(
    const Parameters& parameters, const StepInputs& start, const StepInputs& end, double h, BodyState& s) {
  ExplicitSubstep substep(start, end, h, s);
  if (substep.bends) {
    find_propagator(h, damping_time(model_, parameters, body_));
    each_four_modes([&](int k) { store(&s.rate[k], load(&s.rate[k]) * load(&damped_[k])); });
    substep.rate0 = s.rate;
  }
  substep.r0 = rotation_matrix(packed(s.rotation));
  const PackVec3 kick0 = h / 2 * (inverse_inertia_ * transposed_times(substep.r0, packed(s.moment)));
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += unpacked(kick0);
  if (substep.bends) add_product(h / 2, kick_, s.load, s.rate);
  substep.spin = drift(h, s);
  substep.r = rotation_matrix(packed(s.rotation));
  substep.shift = s.position - substep.before.position;
  return substep;
}

// Half an impulse of what acts at the end, with contacts at the velocity that they leave. None: that is not
// found.
[[gnu::always_inline]] inline ReducedBody::Solution ReducedBody::push_at_end(const Parameters& parameters,
                                                                             const ExplicitSubstep& substep,
                                                                             BodyState& s,
                                                                             ReducedScratch& w) {
  const double h = substep.h;
  const PackMat3& r = substep.r;
  const BodyState& before = substep.before;
  const Vec3 field = parameters.gravity - substep.end.floor;
  const bool bends = substep.bends, tied = anchors_.any();
  const Vec3 pull = anchors_.force(), twist = anchors_.moment();
  Amplitudes anchor_loads;
  if (bends) {
    anchor_loads.setZero();
    anchors_.modal_loads(s, modes(s), anchor_loads);
    s.load.setZero();
  }
  ContactLoads loads{{0, 0, 0}, {0, 0, 0}, 0, 0};
  if (contacts_.any()) {
    const BodyVelocity drifted{packed(s.velocity), r * packed(s.angular_velocity), s.rate};
    BodyVelocity u = drifted;
    u.linear = mul_add(h / 2 / mass_, packed(before.force), u.linear);
    u.angular = u.angular + r * (inverse_inertia_ * transposed_times(r, h / 2 * packed(before.moment)));
    if (bends) add_product(h / 2, kick_, before.load, u.rate);
    BodyVelocity free{mul_add(h / 2, packed(field), drifted.linear), drifted.angular, drifted.rate};
    if (tied) {
      free.linear = mul_add(h / 2 / mass_, packed(pull), free.linear);
      free.angular = free.angular + r * (inverse_inertia_ * transposed_times(r, h / 2 * packed(twist)));
      if (bends) add_product(h / 2, kick_, anchor_loads, free.rate);
    }
    if (solve_velocity(parameters, {substep.end.law, r, h, free, modes(s)}, u, loads, s.load, w) ==
        Solution::none)
      return Solution::none;
  }
  s.force = mass_ * field + unpacked(loads.force);
  s.moment = unpacked(loads.moment);
  if (tied) {
    s.force += pull;
    s.moment += twist;
    if (bends) s.load += anchor_loads;
  }
  s.velocity += h / 2 / mass_ * s.force;
  s.angular_velocity += unpacked(h / 2 * (inverse_inertia_ * transposed_times(r, packed(s.moment))));
  if (bends) add_product(h / 2, kick_, s.load, s.rate);
  return Solution::found;
}

// As book_work, and what the method itself takes out, from its own kinematics.
[[gnu::always_inline]] inline void ReducedBody::book_explicit(const Parameters& parameters,
                                                              const ExplicitSubstep& substep,
                                                              const BodyState& s, StepEnergy& booked) const {
  const BodyState& before = substep.before;
  const Vec3& shift = substep.shift;
  booked.gravity -= mass_ * parameters.gravity.dot(shift);
  booked.input -= mass_ * 0.5 * (substep.start.floor + substep.end.floor).dot(shift);
  booked.input += anchors_.pull_work(substep.start.pulls, substep.end.pulls, before, s);
  contacts_.book_travel(shift, s, substep.r, booked);
  const Vec3 faster = s.angular_velocity - before.angular_velocity;
  booked.numerical +=
      0.5 * (before.force + s.force).dot(shift) -
      0.5 * mass_ * (s.velocity + before.velocity).dot(s.velocity - before.velocity) +
      0.5 * dot(packed(Vec3(before.moment + s.moment)), substep.r0 * packed(substep.spin)) -
      0.5 * dot(packed(Vec3(s.angular_velocity + before.angular_velocity)), inertia_ * packed(faster));
  if (substep.bends) {
    Amplitudes damping_loss, numerical;
    each_four_modes([&](int k) {
      const auto square = [](Four x) { return x * x; };
      const Four half = 0.5, a0 = load(&before.amplitude[k]), a = load(&s.amplitude[k]),
                 square0 = square(load(&substep.rate0[k]));
      store(&damping_loss[k], square(load(&before.rate[k])) - square0);
      store(&numerical[k], half * (load(&before.load[k]) + load(&s.load[k])) * (a - a0) -
                               half * (square(load(&s.rate[k])) - square0) -
                               half * square(load(&basis_->frequency[k])) * (square(a) - square(a0)));
    });
    booked.damping += 0.5 * damping_loss.sum();
    booked.numerical += numerical.sum();
  }
}

// too_long: what touches at the end asks for substeps as short as `stable`. unsolved: the velocity is not
// found.
ReducedBody::ExplicitOutcome ReducedBody::explicit_substep(const Parameters& parameters,
                                                           const StepInputs& start, const StepInputs& end,
                                                           double h, BodyState& s, std::span<Vec3> stick,
                                                           StepEnergy& booked, ReducedScratch& w) {
  const std::uint64_t touched = contacts_.hash();
  contacts_.begin_substep();
  const ExplicitSubstep substep = move_freely(parameters, start, end, h, s);
  const auto give_up = [&](SubstepEnd how, double stable) {
    s = substep.before;
    contacts_.give_up_substep();
    return ExplicitOutcome{how, stable};
  };
  contacts_.find(s, substep.r, stick);
  if (contacts_.hash() != touched)
    if (const double stable = stable_substep(parameters, start.law, s); stable < h)
      return give_up(SubstepEnd::too_long, stable);
  contacts_.follow(substep.before, substep.r0, s, substep.r);
  anchors_.take(end.pulls);
  anchors_.find(s);
  if (push_at_end(parameters, substep, s, w) == Solution::none) return give_up(SubstepEnd::unsolved, h);
  book_explicit(parameters, substep, s, booked);
  contacts_.book_law_change(start.law, end.law, booked);
  contacts_.keep_sticks(end.law, stick);
  respond_at<ContactSums::none>(end.law, s);
  return {SubstepEnd::reached, h};
}

StepStatus::Kind ReducedBody::advance(const Parameters& parameters, const StepInputs& start,
                                      const StepInputs& end, double h, BodyState& s, std::span<Vec3> stick,
                                      StepEnergy& booked, ReducedScratch& w) {
  const BodyContacts::ScratchLease lease(contacts_, w.buffers);
  const bool touches =
      contacts_.any() || anchors_.holds() || (s.level == ModelLevel::rigid && next_landing(s, h) < h);
  const auto equal_substeps = [](double way, double stable) {
    return stable < way ? way / std::ceil(way / stable - 1e-9) : way;
  };
  double size = !touches && s.level == ModelLevel::rigid
                    ? h
                    : equal_substeps(h, stable_substep(parameters, start.law, s));
  bool implicit = s.level == ModelLevel::rigid && touches && (parameters.adaptive || size < h);
  double left = h, most = h;
  w.substep = 0;
  w.from.reset();
  while (!implicit) {
    // of equal substeps the last is as long as the others to the bit: its propagator is there
    const bool last = left <= (1 + k_substep_rounding) * size;
    const double way = left < (1 - k_substep_rounding) * size ? left : size;
    const StepInputs& from = w.from ? *w.from : start;
    if (!last) w.to.emplace(parameters, from.time + size, from);
    const ExplicitOutcome outcome =
        explicit_substep(parameters, from, last ? end : *w.to, way, s, stick, booked, w);
    if (outcome.end == SubstepEnd::reached) {
      if (last) break;
      left -= size;
      w.from = w.to;
      size = std::min(equal_substeps(left, stable_substep(parameters, w.from->law, s)), most);
    } else if (outcome.end == SubstepEnd::too_long) {
      implicit = s.level == ModelLevel::rigid;
      size = equal_substeps(size, outcome.stable);
    } else {
      size = most = size / 2;
      if (most < k_least_substep * h) return StepStatus::Kind::newton_diverged;
    }
  }
  return implicit ? advance_implicit(parameters, start, end, h, s, stick, booked) : StepStatus::Kind::ok;
}

double ReducedBody::look_ahead(const Parameters& parameters, const ContactLaw& law,
                               const BodyState& s) const {
  double limit = k_longest_step;
  if (s.level == ModelLevel::elastic) {
    limit = contacts_.look_ahead(law, is_quiet(parameters, s), s);
  } else {
    if ((contacts_.any() || anchors_.holds()) && s.substep > 0) limit = std::min(limit, s.substep);
    if (const double kink = next_kink(s, limit); kink < limit)
      limit = std::max(kink, std::min(limit, first_substep(law)));
  }
  const double turning = s.angular_velocity.norm();
  return turning * limit > k_turn ? k_turn / turning : limit;
}

void ReducedBody::list_contacts(std::vector<ContactForce>& forces) const {
  contacts_.each([&](const BodyContacts::Touch& touch, int k, int point, std::size_t) {
    forces.push_back(
        {point, touch.plane, contacts_.own_depth(touch, k), touch.normal[k], contacts_.force(touch, k)});
  });
}

// Calls f with the nodes that contacts push, numbered within the body, and the forces in reference axes.
template <class F>
void ReducedBody::each_force(const BodyState& s, F f) const {
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  contacts_.each([&](const BodyContacts::Touch& touch, int k, int point, std::size_t) {
    f(model_.contact_points[point].node - model_.bodies[body_].first_node,
      Vec3(back * contacts_.force(touch, k)));
  });
  for (const BodyAnchors::Tie& tie : anchors_.ties()) f(tie.node, Vec3(back * tie.now.force));
  for (int node = 0; node < static_cast<int>(member_forces_.size()); ++node)
    if (!member_forces_[node].isZero(0)) f(node, Vec3(back * member_forces_[node]));
}

void ReducedBody::add_member_force(int node, const Vec3& force) {
  const Body& body = model_.bodies[body_];
  if (member_forces_.empty()) member_forces_.assign(body.node_count, Vec3::Zero());
  member_forces_[node - body.first_node] += force;
}

// to += n columns of the matrix, from the first on, times the factors
template <int n>
void add_columns(const Eigen::MatrixXd& matrix, int first, const double* factors, Eigen::VectorXd& to) {
  double factor[n];
  std::copy_n(factors, n, factor);
  const double* const __restrict column = matrix.col(first).data();
  double* const __restrict sum = to.data();
  const Eigen::Index rows = matrix.rows();
  for (Eigen::Index i = 0; i < rows; ++i) {
    double row = column[i] * factor[0];
    for (int k = 1; k < n; ++k) row += column[i + k * rows] * factor[k];
    sum[i] += row;
  }
}

void ReducedBody::section_forces(const BodyState& s, std::vector<SectionForces>& sections) {
  const Body& body = model_.bodies[body_];
  section_.setZero(basis_->section.rows());
  int k = 0;
  for (; k + 4 <= basis_->modes; k += 4) add_columns<4>(basis_->section, k, &s.amplitude[k], section_);
  for (; k < basis_->modes; ++k) add_columns<1>(basis_->section, k, &s.amplitude[k], section_);
  each_force(s, [&](int node, const Vec3& f) {
    add_columns<3>(basis_->residual_section, 3 * node, f.data(), section_);
  });
  for (int e = 0; e < body.element_count; ++e)
    sections[body.first_element + e] = {section_.segment<3>(6 * e), section_.segment<3>(6 * e + 3)};
}

// A contact point of an elastic body gives by its own force alone, a node of a frame by all of them. Adds the
// rigid motion after which the nodes are as near as can be to where contacts bear what they bear now. u: six
// numbers per node, m and rad, body axes.
void ReducedBody::add_motion_of_contacts(const BodyState& s, Eigen::VectorXd& u) const {
  const Body& body = model_.bodies[body_];
  const Mat3 back = s.rotation.conjugate().toRotationMatrix();
  const auto arm = [&](int i) -> Vec3 {
    return model_.node_position[body.first_node + i] - body.centre_of_gravity;
  };
  std::vector<Eigen::Matrix<double, 1, 6>> ways;
  std::vector<double> left;
  contacts_.each([&](const BodyContacts::Touch& touch, int k, int point, std::size_t) {
    const int i = model_.contact_points[point].node - body.first_node;
    const Vec3 normal = back * model_.planes[touch.plane].normal;
    ways.emplace_back();
    ways.back() << normal.transpose(), arm(i).cross(normal).transpose() / reach_;
    left.push_back(touch.give[k] * touch.conservative[k] - normal.dot(u.segment<3>(6 * i)));
  });
  if (ways.empty()) return;
  Eigen::MatrixXd along(ways.size(), 6);
  for (std::size_t k = 0; k < ways.size(); ++k) along.row(k) = ways[k];
  // what hardly moves a contact stays out, or a small gap takes a large motion: a turn about a post at a wall
  constexpr double k_distinct = 0.01;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> ways_apart(along.rows(), along.cols());
  ways_apart.setThreshold(k_distinct);
  const Eigen::VectorXd motion =
      ways_apart.compute(along).solve(Eigen::Map<const Eigen::VectorXd>(left.data(), left.size()));
  const Vec3 shift = motion.head<3>(), turn = motion.tail<3>() / reach_;
  for (int i = 0; i < body.node_count; ++i) {
    u.segment<3>(6 * i) += shift + turn.cross(arm(i));
    u.segment<3>(6 * i + 3) += turn;
  }
}

double ReducedBody::residual_strain(const BodyState& s) const {
  double work = 0;
  each_force(s, [&](int i, const Vec3& f) {
    each_force(s, [&](int j, const Vec3& g) {
      work += f.dot(basis_->residual_shape.block<3, 3>(6 * i, 3 * j) * g);
    });
  });
  return work / 2;
}

void ReducedBody::add_residual(const BodyState& s, State& state) const {
  if (s.level != ModelLevel::elastic) return;
  const Body& body = model_.bodies[body_];
  Eigen::VectorXd u = Eigen::VectorXd::Zero(6 * body.node_count);
  each_force(s, [&](int node, const Vec3& f) { u += basis_->residual_shape.middleCols<3>(3 * node) * f; });
  add_motion_of_contacts(s, u);
  for (int i = 0; i < body.node_count; ++i) {
    state.position[body.first_node + i] += s.rotation * Vec3(u.segment<3>(6 * i));
    Quat& q = state.rotation[body.first_node + i];
    q = (exp_quaternion(s.rotation * Vec3(u.segment<3>(6 * i + 3))) * q).normalized();
  }
}

// Of a norm of section forces: by its triangle inequality.
double ReducedBody::bound(const BodyState& s, const Eigen::VectorXd& of_modes,
                          const Eigen::VectorXd& of_forces) const {
  double bound = of_modes.dot(s.amplitude.head(basis_->modes).abs().matrix());
  each_force(s, [&](int node, const Vec3& f) { bound += of_forces.segment<3>(3 * node).dot(f.cwiseAbs()); });
  return bound;
}

double ReducedBody::yield_bound(const BodyState& s) const {
  return bound(s, basis_->mode_yield, basis_->residual_yield);
}

double ReducedBody::stress_bound(const BodyState& s) const {
  return bound(s, basis_->mode_stress, basis_->residual_stress);
}

double ReducedBody::rotation_bound(const BodyState& s) const {
  return basis_->mode_rotation.dot(s.amplitude.head(basis_->modes).abs().matrix());
}

}  // namespace topple
