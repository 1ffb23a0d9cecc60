#include "solver/contact/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact/coulomb.h"
#include "solver/contact/penalty.h"
#include "solver/math/elementary.h"

namespace topple {
namespace {

// Hardening between members over alpha, as a function of x = (depth - 0.8)/0.2.
constexpr double k_hardening = 10, k_hardening_range = 1 - k_hardening_depth, k_steepest = 0.98;

double hardening_place(double depth) {
  return (depth - k_hardening_depth) / k_hardening_range;
}

double hardening_slope(double x) {
  const double y = std::min(x, k_steepest);
  return k_hardening * 2 * y / ((1 - y) * (1 - y) * (1 - y));
}

double hardening_force(double x) {
  const double y = std::min(x, k_steepest), root = y / (1 - y);
  return k_hardening * root * root + hardening_slope(x) * (x - y);
}

// Integral of hardening_force from 0.
double hardening_energy(double x) {
  const double y = std::min(x, k_steepest), beyond = x - y;
  return k_hardening * (y + 2 * elementary::log1p(-y) + y / (1 - y)) + hardening_force(y) * beyond +
         hardening_slope(x) * beyond * beyond / 2;
}

// -mu P v / sqrt(v^2 + eps^2), eps: slip_speed
void add_drag(const ContactLaw& law, const ContactInput& in, double p, double dp, ContactOutput& out,
              ContactDerivatives derivatives) {
  const double speed = std::sqrt(in.velocity.squaredNorm() + law.slip_speed * law.slip_speed);
  const Vec3 direction = in.velocity / speed;
  const Vec3 drag = -law.friction * p * direction;
  const double normal_drag = in.normal.dot(drag);
  out.normal += normal_drag;
  out.tangential = drag - normal_drag * in.normal;
  if (!derivatives.by_position) return;
  *derivatives.by_position -= law.friction * dp * direction * in.normal.transpose();
  *derivatives.by_velocity -=
      law.friction * p / speed * (Mat3::Identity() - direction * direction.transpose());
}

// What is left of the spring's travel when its force is capped.
void take_stick(double k, const Vec3& stick, double limit, ContactOutput& out) {
  const double travel2 = stick.squaredNorm();
  out.stick = held_share(k, travel2, limit, true) * stick;
  out.stick_energy = stick_energy(k, travel2, limit);
}

void coulomb(const ContactLaw& law, const ContactInput& in, double p, double dp, ContactOutput& out,
             ContactDerivatives derivatives) {
  const PackVector<double> n = packed(in.normal);
  const auto [k, c] = StickSpring(law.alpha, in.L, in.mass);
  const double loss = normal_loss(law.restitution);
  const bool weakens = law.excess() > 0;
  const auto f = coulomb_force(law, loss, weakens, n, packed(in.velocity), packed(in.stick), true, p, k, c);
  out.conservative = p;
  out.normal = f.normal;
  out.tangential = unpacked(-f.scale * f.trial);
  take_stick(k, unpacked(f.stick), f.limit, out);
  if (!derivatives.by_position) return;
  const auto derivative = [&](double normal, double spring, bool with_friction) -> Mat3 {
    const double across = f.scale * spring;
    Mat3 slope = (normal + across) * in.normal * in.normal.transpose() - across * Mat3::Identity();
    if (f.slips) slope += unpacked(slip_slope(law, with_friction, f, n, normal, across));
    return slope;
  };
  *derivatives.by_position = derivative(dp * f.factor, k, false);
  *derivatives.by_velocity = derivative(normal_slope(law, loss, p, f.inverse), c, weakens);
}

// P n - mu P v/sqrt(v^2 + eps^2)
void paper(const ContactLaw& law, const ContactInput& in, double p, double dp, ContactOutput& out,
           ContactDerivatives derivatives) {
  out.conservative = out.normal = p;
  if (derivatives.by_position) {
    *derivatives.by_position = dp * in.normal * in.normal.transpose();
    derivatives.by_velocity->setZero();
  }
  add_drag(law, in, p, dp, out, derivatives);
}

// -P v_n/sqrt(v_n^2 + eps^2) n - mu P v/sqrt(v^2 + eps^2): Eq. 3 as it is printed
void printed(const ContactLaw& law, const ContactInput& in, double p, double dp, ContactOutput& out,
             ContactDerivatives derivatives) {
  const Vec3& n = in.normal;
  const double vn = n.dot(in.velocity), eps2 = law.slip_speed * law.slip_speed;
  const double root = std::sqrt(vn * vn + eps2);
  out.normal = -p * vn / root;
  if (derivatives.by_position) {
    *derivatives.by_position = -dp * vn / root * n * n.transpose();
    *derivatives.by_velocity = -p * eps2 / (root * root * root) * n * n.transpose();
  }
  add_drag(law, in, p, dp, out, derivatives);
}

ContactOutput coulomb_at_new_velocity(const ContactLaw& law, ContactInput& in, double impedance,
                                      const Vec3& free) {
  const Vec3& n = in.normal;
  ContactOutput out;
  const double p = out.conservative = penalty_force(law, in.depth, in.between_members);
  const double loss = p * normal_loss(law.restitution), eps2 = law.normal_speed * law.normal_speed;
  const double free_n = n.dot(free);
  double vn = n.dot(in.velocity);
  // what is left grows with vn, steeply where it changes sign: Newton leaps to and fro over that unless the
  // speeds with less and with more that are known are halved where a step is not half of the one before
  double less = free_n + (p - loss) / impedance, more = free_n + (p + loss) / impedance;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double inverse = 1 / std::sqrt(vn * vn + eps2), direction = vn * inverse;
    const double left = impedance * (vn - free_n) - p + loss * direction;
    (left > 0 ? more : less) = vn;
    double step = -left / (impedance + loss * eps2 * inverse * inverse * inverse);
    if (!(std::abs(step) <= last / 2 && vn + step >= less && vn + step <= more))
      step = (less + more) / 2 - vn;
    last = std::abs(step);
    vn += step;
    // what is left after a step is its square over that of the smoothing
    if (!(step * step > 1e-12 * (1 + std::abs(vn)) * law.normal_speed)) break;
  }
  out.normal = std::max(impedance * (vn - free_n), 0.);  // rounding may be more than is left of it

  // sticking and slipping forces alike lie along k stick + c free
  const auto [k, c] = StickSpring(law.alpha, in.L, in.mass);
  const Vec3 stick = in.stick - n.dot(in.stick) * n, free_t = free - free_n * n,
             pull = k * stick + c * free_t;
  const double size = pull.norm();
  double limit = 0;
  Vec3 slip = Vec3::Zero();  // static friction holds what was at rest
  for (int iteration = 0; iteration < 30; ++iteration) {
    limit = friction_coefficient(law, slip.squaredNorm()) * out.normal;
    const bool sticks = size * impedance <= limit * (impedance + c);
    out.tangential = -(sticks ? impedance / (impedance + c) : limit / size) * pull;
    const Vec3 before = slip;
    slip = free_t + out.tangential / impedance;
    if (law.excess() == 0 || !((slip - before).squaredNorm() > 1e-24 * (1 + slip.squaredNorm()))) break;
  }
  take_stick(k, stick, limit, out);
  out.force = out.normal * n + out.tangential;
  in.velocity = slip + vn * n;
  return out;
}

NormalLoss by_restitution(const ContactLaw& law) {
  return {normal_loss(law.restitution), law.normal_speed};
}

NormalLoss by_friction(const ContactLaw& law) {
  return {law.friction, law.slip_speed};
}

constexpr ContactLawTraits k_laws[] = {
    {.kind = ContactLawKind::coulomb,
     .word = "coulomb",
     .stores_energy = true,
     .sticks = true,
     .has_restitution = true,
     .in_packs = true,
     .evaluate = coulomb,
     .at_new_velocity = coulomb_at_new_velocity,
     .normal_loss = by_restitution,
     .trusted = true},
    {.kind = ContactLawKind::paper,
     .word = "paper",
     .stores_energy = true,
     .sticks = false,
     .has_restitution = false,
     .in_packs = false,
     .evaluate = paper,
     .at_new_velocity = nullptr,
     .normal_loss = by_friction,
     .trusted = true},
    {.kind = ContactLawKind::printed,
     .word = "printed",
     .stores_energy = false,
     .sticks = false,
     .has_restitution = false,
     .in_packs = false,
     .evaluate = printed,
     .at_new_velocity = nullptr,
     .normal_loss = by_friction,
     .trusted = false},
};

ContactOutput evaluate(const ContactLaw& law, const ContactInput& in, ContactDerivatives derivatives) {
  ContactOutput out{};
  out.tangential.setZero();
  out.stick.setZero();
  const double p = penalty_force(law, in.depth, in.between_members);
  const double dp = derivatives.by_position ? -penalty_stiffness(law, in.depth, in.L, in.between_members) : 0;
  traits(law).evaluate(law, in, p, dp, out, derivatives);
  out.force = out.normal * in.normal + out.tangential;
  return out;
}

}  // namespace

std::span<const ContactLawTraits> contact_laws() {
  return k_laws;
}

const ContactLawTraits& traits(ContactLawKind kind) {
  return row_of(k_laws, kind);
}

ContactLaw law_at_rest(ContactLaw law) {
  law.kind = ContactLawKind::coulomb;
  law.restitution = 1;
  return law;
}

Parameters at_rest(Parameters parameters) {
  parameters.shakes.clear();
  parameters.pulls.clear();
  parameters.contact = law_at_rest(parameters.contact);
  return parameters;
}

StiffnessBound stiffness_bound(const ContactLaw& law) {
  return {law.q < 1 ? penalty_slope(0.01, law.q) : law.q, traits(law).sticks ? k_stick_stiffness : 0};
}

ContactLaw contact_law(const Parameters& parameters, double t) {
  ContactLaw law = parameters.contact;
  const double share = parameters.contact_ramp.share(t);
  if (share == 1) return law;
  const ContactLaw& before = parameters.contact_before;
  const auto mix = [share](double a, double b) { return (1 - share) * a + share * b; };
  law.alpha = before.alpha * elementary::pow(law.alpha / before.alpha, share);
  law.q = mix(before.q, law.q);
  law.friction_static = mix(before.friction + before.excess(), law.friction + law.excess());
  law.friction = mix(before.friction, law.friction);
  law.restitution = mix(before.restitution, law.restitution);
  return law;
}

ContactLaw stiffest_law(const Parameters& parameters) {
  ContactLaw law = parameters.contact;
  if (parameters.contact_ramp.over > 0) {
    const ContactLaw& before = parameters.contact_before;
    law.alpha = std::max(law.alpha, before.alpha);
    if (stiffness_bound(before).normal > stiffness_bound(law).normal) law.q = before.q;
  }
  return law;
}

double penalty_force(const ContactLaw& law, double depth, bool between_members) {
  if (!(depth > 0)) return 0;
  double force = penalty_power(depth, law.q);
  if (const double x = hardening_place(depth); between_members && x > 0) force += hardening_force(x);
  return law.alpha * force;
}

double penalty_stiffness(const ContactLaw& law, double depth, double L, bool between_members) {
  double slope = penalty_slope(depth, law.q);
  if (const double x = hardening_place(depth); between_members && x > 0)
    slope += hardening_slope(x) / k_hardening_range;
  return law.alpha * slope / L;
}

double penalty_energy(const ContactLaw& law, double depth, double L, bool between_members) {
  if (!(depth > 0)) return 0;
  double energy = depth * penalty_power(depth, law.q) / (law.q + 1);
  if (const double x = hardening_place(depth); between_members && x > 0)
    energy += k_hardening_range * hardening_energy(x);
  return law.alpha * L * energy;
}

double normal_loss(double restitution) {
  const double e2 = restitution * restitution;
  return (1 - e2) / (1 + e2);
}

PreparedLaw::PreparedLaw(const ContactLaw& law)
    : ContactLaw(law),
      root_alpha(std::sqrt(law.alpha)),
      loss(normal_loss(law.restitution)),
      bend(law.excess() > 0 ? std::min(law.normal_speed, law.slip_speed) : law.normal_speed),
      in_packs(traits(law).in_packs),
      plain(in_packs && law.q == 1 && !(law.excess() > 0)) {}

ContactOutput contact_force(const ContactLaw& law, const ContactInput& input) {
  return evaluate(law, input, {});
}

ContactOutput contact_force(const ContactLaw& law, const ContactInput& input, Mat3& by_position,
                            Mat3& by_velocity) {
  return evaluate(law, input, {&by_position, &by_velocity});
}

}  // namespace topple
