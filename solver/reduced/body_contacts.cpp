#include "solver/reduced/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "solver/contact/coulomb.h"
#include "solver/contact/penalty.h"
#include "solver/math/elementary.h"
#include "solver/reduced/elastic_basis.h"

namespace topple {
namespace {

constexpr double k_same_line = 1e-6;  // m
constexpr double k_bend = 0.05;       // of the reach: more than an elastic body deforms

}  // namespace

BodyContacts::BodyContacts(const Model& model, int body)
    : model_(model),
      mass_(model.bodies[body].mass),
      reach_(model.bodies[body].reach),
      contact_mass_(mass_ / std::max(1, model.bodies[body].contact_point_count)),
      grip_(model.bodies[body].grip),
      least_length_(std::numeric_limits<double>::infinity()) {
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
  const int modes = b.elastic ? b.elastic->modes : 0;
  groups_.resize((order.size() + 4 - 1) / 4);
  sides_.resize(model.planes.size() * groups_.size());
  for (Side& side : sides_)
    side = {Four(-std::numeric_limits<double>::infinity()), Four(1), Four(1), Four(0), {}};
  widest_.assign(model.planes.size(), 0);
  Eigen::AlignedBox3d box;
  const double inverse_moment = b.inertia.inverse().trace();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    group.place = in_all_lanes(Vec3::Zero());
    group.shape.assign(modes, in_all_lanes(Vec3::Zero()));
    group.give = in_all_lanes(packed(Mat3(Mat3::Zero())));
    for (int which = 0; which < 4 && g * 4 + which < order.size(); ++which) {
      const int p = order[g * 4 + which];
      const ContactPoint& point = model.contact_points[p];
      const Vec3 at = place_of(p);
      group.point[which] = p;
      group.size = which + 1;
      set_lane(group.place, which, at);
      box.extend(at);
      double inverse_mass = 1 / mass_ + at.squaredNorm() * inverse_moment;
      for (int k = 0; k < modes; ++k) {
        const Vec3 shape = b.elastic->shape.block<3, 1>(6 * (point.node - b.first_node), k);
        set_lane(group.shape[k], which, shape);
        inverse_mass += shape.squaredNorm();
      }
      if (b.elastic) {
        const int node = point.node - b.first_node;
        set_lane(group.give, which, Mat3(b.elastic->residual_shape.block<3, 3>(6 * node, 3 * node)));
      }
      for (std::size_t k = 0; k < model.planes.size(); ++k) {
        Side& side = sides_[k * groups_.size() + g];
        const double L = contact_length(point, model.planes[k]);
        const int spring = static_cast<int>(p * model.planes.size() + k);
        if (which == 0) side.spring.fill(spring);
        side.spring[which] = spring;
        side.L.set(which, L);
        side.stick.set(which, k_stick_stiffness / L);
        side.damping.set(which, 2 * k_stick_damping * std::sqrt(side.stick[which] * contact_mass_));
        side.gap.set(which, point.width / 2);
        widest_[k] = std::max(widest_[k], point.width / 2);
        least_length_ = std::min(least_length_, L);
        stiffest_ += inverse_mass / L;
      }
    }
  }
  box_centre_ = box.center();
  box_half_ = box.sizes() / 2;
  now_.all.reset(new Touch[sides_.size()]);
  shapes_.resize(sides_.size() * modes);
}

BodyContacts::Points BodyContacts::place(const BodyState& s, const Group& group) const {
  Points at = group.place;
  if (s.level == ModelLevel::elastic)
    for (std::size_t k = 0; k < group.shape.size(); ++k) at = at + s.amplitude[k] * group.shape[k];
  return at;
}

// Height of the box over a plane's face along n, the normal in reference axes.
double BodyContacts::clearance(const Vec3& n, double height) const {
  return height + n.x() * box_centre_.x() + n.y() * box_centre_.y() + n.z() * box_centre_.z() -
         (std::abs(n.x()) * box_half_.x() + std::abs(n.y()) * box_half_.y() +
          std::abs(n.z()) * box_half_.z());
}

// dP/d depth over alpha where a contact bears a quarter of the weight.
double BodyContacts::slope_at_rest(const ContactLaw& law) const {
  if (law.q == 1) return 1;
  return law.q * elementary::pow(mass_ * k_standard_gravity / 4 / law.alpha, 1 - 1 / law.q);
}

void BodyContacts::find(const BodyState& s, const PackMat3& r, std::span<const Vec3> stick) {
  now_.clear();
  gives_ = s.level == ModelLevel::elastic;
  modes_ = gives_ && !groups_.empty() ? static_cast<int>(groups_[0].shape.size()) : 0;
  const double bend = gives_ ? k_bend * reach_ : 0;
  for (int k = 0; k < static_cast<int>(widest_.size()); ++k) {
    const Plane& plane = model_.planes[k];
    const double height = plane.normal.dot(s.position - plane.point);
    const Vec3 n = unpacked(transposed_times(r, packed(plane.normal)));
    if (clearance(n, height) > widest_[k] + bend) continue;
    gives_ ? find_on<true>(k, n, height, s, r, stick) : find_on<false>(k, n, height, s, r, stick);
  }
}

// `n`: the normal in reference axes; `height`: of the centre of gravity.
template <bool bends>
void BodyContacts::find_on(int plane, const Vec3& n, double height, const BodyState& s, const PackMat3& r,
                           std::span<const Vec3> stick) {
  const bool level = model_.planes[plane].normal == Vec3::UnitZ();
  const Points normal = in_all_lanes(n);
  const PackMatrix<Four> turn = in_all_lanes(r);
  const int count = static_cast<int>(groups_.size());
  const Side* side = &sides_[plane * count];
  Points* shape = shapes_.data() + now_.count * modes_;
  for (int g = 0; g < count; ++g, ++side) {
    const Group& group = groups_[g];
    const Four above = Four(height) - side->gap;
    if (bends && bits(dot(normal, group.place) + above < Four(k_bend * reach_)) == 0) continue;
    const Points at = bends ? place(s, group) : group.place;
    const Four gap = dot(normal, at) + above;
    const Four::Mask touching = gap < 0;
    if (bits(touching) == 0) continue;
    Touch& touch = now_.add(plane, g, plane * count + g, touching);
    touch.level = level;
    touch.depth = choose(touching, -gap / side->L, Four(0));
    touch.arm = turn * at;
    touch.stick = gather(stick.data(), side->spring);
    if constexpr (bends) {
      for (int j = 0; j < modes_; ++j) *shape++ = turn * group.shape[j];
      touch.give = dot(normal, group.give * normal);
      touch.give_across =
          0.5 * (group.give.row[0].x + group.give.row[1].y + group.give.row[2].z - touch.give);
    }
  }
}

void BodyContacts::follow(const BodyState& before, const PackMat3& r0, const BodyState& s,
                          const PackMat3& r) {
  const Points shift = in_all_lanes(Vec3(s.position - before.position));
  if (modes_ > 0) {
    const PackMatrix<Four> from = in_all_lanes(r0);
    for (Touch& touch : now_.list()) {
      touch.travel = shift + (touch.arm - from * place(before, groups_[touch.group]));
      touch.stick = touch.stick + touch.travel;
    }
    return;
  }
  const PackMatrix<Four> turn = in_all_lanes(r - r0);
  for (Touch& touch : now_.list()) {
    touch.travel = shift + turn * groups_[touch.group].place;
    touch.stick = touch.stick + touch.travel;
  }
}

// contact_force, four by four.
template <bool with_slope, bool plain, class Normal>
[[gnu::always_inline]] inline void BodyContacts::respond_coulomb(const PreparedLaw& law, const Normal& n,
                                                                 const Points& v, double gamma_dt,
                                                                 Touch& touch) const {
  const Side& here = side(touch);
  const Four zero = Four(0);
  const Four depth = plain ? touch.depth : penalty_power(touch.depth, law.q);
  touch.conservative = choose(touch.touching, touch.alpha * depth, zero);
  const Four k = touch.stick_stiffness, c = law.root_alpha * here.damping;
  const bool weakens = !plain && law.excess() > 0;
  const auto f =
      coulomb_force(law, law.loss, weakens, n, v, touch.stick, touch.touching, touch.conservative, k, c);
  touch.normal = f.normal;
  touch.limit = f.limit;
  touch.tangential = in_space(-f.scale * f.trial);
  touch.stick_energy = choose(touch.touching, stick_energy(k, dot(f.stick, f.stick), f.limit), zero);
  if constexpr (with_slope) {
    Four slope = normal_slope(law, law.loss, touch.conservative, f.inverse), across = c;
    if (gamma_dt > 0) {
      Four stiffness = touch.alpha / here.L;
      if (!plain) stiffness = stiffness * penalty_slope(touch.depth, law.q);
      slope -= choose(touch.touching, gamma_dt * stiffness * f.factor, zero);
      across += gamma_dt * k;
    }
    across = across * f.scale;
    touch.tangent_nn = slope + across;
    touch.tangent_identity = across;
    touch.drag = choose(f.sticks, across, zero);
    touch.has_tangent_rest = f.slips;
    if (f.slips) touch.tangent_rest = slip_slope(law, weakens, f, n, slope, across);
  }
}

template <bool with_slope, bool plain, class Normal>
[[gnu::always_inline]] inline void BodyContacts::respond(const PreparedLaw& law, const Normal& n,
                                                         const Points& v, double gamma_dt,
                                                         Touch& touch) const {
  if (plain || law.in_packs) {
    respond_coulomb<with_slope, plain>(law, n, v, gamma_dt, touch);
  } else {
    touch.conservative = touch.normal = touch.limit = touch.stick_energy = Four(0);
    touch.tangential = in_all_lanes(Vec3::Zero());
    if (with_slope) {
      touch.tangent_nn = touch.tangent_identity = touch.drag = Four(0);
      touch.has_tangent_rest = true;
      for (Points& row : touch.tangent_rest.row) row = in_all_lanes(Vec3::Zero());
    }
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
      if (with_slope) set_lane(touch.tangent_rest, which, by_velocity + gamma_dt * by_position);
    }
  }
}

template <bool with_slope, ContactSums sums>
ContactLoads BodyContacts::evaluate_forces(const PreparedLaw& law, const BodyVelocity& u, double gamma_dt) {
  const auto of = [&](const PreparedLaw& own) {
    return own.plain && !gives_ ? evaluate_all<with_slope, true, sums>(own, u, gamma_dt)
                                : evaluate_all<with_slope, false, sums>(own, u, gamma_dt);
  };
  return grip_ == 1 ? of(law) : of(gripped(law, grip_));
}

template <bool with_slope, bool plain, ContactSums sums>
[[gnu::flatten]] ContactLoads BodyContacts::evaluate_all(const PreparedLaw& law, const BodyVelocity& u,
                                                         double gamma_dt) {
  Points force = in_all_lanes(Vec3::Zero()), moment = force;
  Four damping_power = Four(0), friction_power = damping_power;
  const Points linear = in_all_lanes(u.linear), angular = in_all_lanes(u.angular);
  const Points* shape = shapes_.data();
  const double slope = !plain && gives_ ? law.alpha * slope_at_rest(law) : 0;
  for (Touch& touch : now_.list()) {
    const Side& here = side(touch);
    touch.alpha = Four(law.alpha);
    touch.stick_stiffness = law.alpha * here.stick;
    if (!plain && gives_) {
      touch.alpha = touch.alpha / (1 + slope * touch.give / here.L);
      touch.stick_stiffness = touch.stick_stiffness / (1 + touch.give_across * touch.stick_stiffness);
    }
    Points v = linear + cross(angular, touch.arm);
    if constexpr (!plain)
      for (int k = 0; k < modes_; ++k) v = mul_add(Four(u.rate[k]), *shape++, v);
    with_normal(touch, [&](const auto& n) {
      respond<with_slope, plain>(law, n, v, gamma_dt, touch);
      if constexpr (sums == ContactSums::none) return;
      const auto rub = lying(n, touch.tangential);
      const Points push = mul_add(touch.normal, n, rub);
      force = force + push;
      moment = moment + cross(touch.arm, push);
      if constexpr (sums == ContactSums::loads) return;
      damping_power -= (touch.normal - touch.conservative) * dot(n, v);
      friction_power -= dot(rub, v);
    });
  }
  if constexpr (sums == ContactSums::none) return {};
  const Four first = topple::sums(force.x, force.y, force.z, damping_power),
             second = topple::sums(moment.x, moment.y, moment.z, friction_power);
  return {{first[0], first[1], first[2]}, {second[0], second[1], second[2]}, first[3], second[3]};
}
template ContactLoads BodyContacts::evaluate_forces<false, ContactSums::none>(const PreparedLaw&,
                                                                              const BodyVelocity&, double);
template ContactLoads BodyContacts::evaluate_forces<false, ContactSums::loads>(const PreparedLaw&,
                                                                               const BodyVelocity&, double);
template ContactLoads BodyContacts::evaluate_forces<false>(const PreparedLaw&, const BodyVelocity&, double);
template ContactLoads BodyContacts::evaluate_forces<true>(const PreparedLaw&, const BodyVelocity&, double);

ContactPower BodyContacts::power(const BodyVelocity& u) const {
  Four damping = Four(0), friction = damping;
  const Points linear = in_all_lanes(u.linear), angular = in_all_lanes(u.angular);
  const Points* shape = shapes_.data();
  for (const Touch& touch : now_.list()) {
    Points v = linear + cross(angular, touch.arm);
    for (int k = 0; k < modes_; ++k) v = mul_add(Four(u.rate[k]), *shape++, v);
    with_normal(touch, [&](const auto& n) {
      damping -= (touch.normal - touch.conservative) * dot(n, v);
      friction -= dot(lying(n, touch.tangential), v);
    });
  }
  return {sum(damping), sum(friction)};
}

void BodyContacts::modal_loads(int modes, Amplitudes& load) const {
  std::array<Four, k_modes> sum_of;
  sum_of.fill(Four(0));
  const Points* shape = shapes_.data();
  for (const Touch& touch : now_.list()) {
    const Points push = force(touch);
    for (int k = 0; k < modes; ++k) sum_of[k] += dot(*shape++, push);
  }
  for (int k = 0; k < modes; ++k) load[k] = sum(sum_of[k]);
}

// Travel of the stick springs after slipping, m.
[[gnu::always_inline]] inline BodyContacts::Points BodyContacts::held_stick(const PreparedLaw& law,
                                                                            const Touch& touch) const {
  if (!law.in_packs) return in_all_lanes(Vec3::Zero());
  return with_normal(touch, [&](const auto& n) {
    const auto stick = tangential(n, touch.stick);
    return in_space(held_share(touch.stick_stiffness, dot(stick, stick), touch.limit, touch.touching) *
                    stick);
  });
}

void BodyContacts::keep_sticks(const PreparedLaw& law, std::span<Vec3> stick) {
  const Touch* still = now_.list().data();
  const Touch* const end = still + now_.count;
  for (const Touch& touch : now_.hash == start_.hash ? std::span<const Touch>() : start_.list()) {
    while (still != end && std::tie(still->plane, still->group) < std::tie(touch.plane, touch.group)) ++still;
    if (still != end && still->plane == touch.plane && still->group == touch.group) continue;
    for (int k = 0; k < groups_[touch.group].size; ++k) stick[side(touch).spring[k]].setZero();
  }
  for (Touch& touch : now_.list()) {
    touch.stick = held_stick(law, touch);
    const std::array<Four, 4> rows = lanes(touch.stick);
    const std::array<int, 4>& spring = side(touch).spring;
#pragma GCC unroll 4
    for (int k = 3; k >= 0; --k) store_three(stick[spring[k]].data(), rows[k]);  // the first one last
  }
}

double BodyContacts::stick_energy_gained() const {
  Four gained = Four(0);
  for (const Touch& touch : now_.list()) gained += touch.stick_energy;
  for (const Touch& touch : start_.list()) gained -= touch.stick_energy;
  return sum(gained);
}

double BodyContacts::energy(const ContactLaw& law) const {
  Four held = Four(0);
  const bool stores_energy = traits(law).stores_energy;
  for (const Touch& touch : now_.list()) {
    held += touch.stick_energy;
    if (stores_energy) held += 1 / (law.q + 1) * touch.conservative * side(touch).L * touch.depth;
  }
  return sum(held);
}

void BodyContacts::book_travel(const Vec3& shift, const BodyState& s, const PackMat3& r,
                               StepEnergy& booked) const {
  Four damping_loss = Four(0), friction_loss = damping_loss;
  const auto book = [&](const Touch& touch, const Points& travel, double sign) {
    damping_loss -= 0.5 * (touch.normal - touch.conservative) * dot(normal(touch), travel);
    friction_loss -= 0.5 * dot(touch.tangential, travel) + sign * touch.stick_energy;
  };
  if (now_.hash == start_.hash) {
    const Touch* before = start_.list().data();
    for (const Touch& touch : now_.list()) {
      const Four lost = (before->normal - before->conservative) + (touch.normal - touch.conservative);
      with_normal(touch, [&](const auto& n) {
        damping_loss -= 0.5 * lost * dot(n, touch.travel);
        friction_loss -= 0.5 * dot(lying(n, before->tangential) + lying(n, touch.tangential), touch.travel) +
                         (touch.stick_energy - before->stick_energy);
      });
      ++before;
    }
  } else {
    for (const Touch& touch : start_.list())
      book(touch, in_all_lanes(shift) + (in_all_lanes(r) * place(s, groups_[touch.group]) - touch.arm), -1);
    for (const Touch& touch : now_.list()) book(touch, touch.travel, 1);
  }
  booked.normal_damping += sum(damping_loss);
  booked.friction += sum(friction_loss);
}

void BodyContacts::book_law_change(const ContactLaw& before, const ContactLaw& after,
                                   StepEnergy& booked) const {
  if (before.alpha == after.alpha && before.q == after.q) return;
  LawChange change(before, after, booked);
  each_of(start_, [&](const Touch& touch, int which, int, std::size_t) {
    change.book_start(touch.depth[which], side(touch).L[which], touch.stick_energy[which],
                      touch.alpha[which] / before.alpha);
  });
  each_of(now_, [&](const Touch& touch, int which, int, std::size_t) {
    change.book_end(touch.depth[which], side(touch).L[which], touch.stick_energy[which],
                    touch.alpha[which] / after.alpha);
  });
}

}  // namespace topple
