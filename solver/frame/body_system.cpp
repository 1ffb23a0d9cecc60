#include "solver/frame/body_system.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>
#include <utility>

#include "solver/contact/contact_law.h"
#include "solver/element/beam.h"
#include "solver/element/damping.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"

namespace topple {
double load_factor(const Load& load, double t) {
  const auto& h = load.history;
  if (h.empty()) return 1;
  if (t <= h.front().first) return h.front().second;
  for (std::size_t i = 1; i < h.size(); ++i)
    if (t < h[i].first)
      return h[i - 1].second +
             (h[i].second - h[i - 1].second) * (t - h[i - 1].first) / (h[i].first - h[i - 1].first);
  return h.back().second;
}

void BodyMotion::resize(int nodes) {
  position.resize(nodes);
  velocity.resize(nodes);
  rotation.resize(nodes);
  angular_velocity.resize(nodes);
}

int BodySystem::local(int global) const {
  int before = 0;
  for (const int b : bodies) {
    const Body& body = model.bodies[b];
    if (global >= body.first_node && global < body.first_node + body.node_count)
      return before + global - body.first_node;
    before += body.node_count;
  }
  const auto held =
      std::find(node.begin() + std::min<std::ptrdiff_t>(before, node.size()), node.end(), global);
  return held == node.end() ? -1 : static_cast<int>(held - node.begin());
}

void BodySystem::damp(const Parameters& parameters) {
  if (damping_ == parameters.damping) return;
  damping_ = parameters.damping;
  std::size_t begin = 0;
  for (const int b : bodies) {
    const std::size_t end = begin + (is_rigid(b) ? 0 : model.bodies[b].element_count);
    beams_.damp(begin, end, damping_time(model, parameters, b));
    begin = end;
  }
}

void BodySystem::start_forces(const Parameters& parameters, const StepInputs& now) {
  const Vec3 field = parameters.gravity - now.floor;
  for (int i = 0; i < count; ++i) {
    const Vec3 weight = node_mass[i] * field;
    node_force_[i] = {{weight.x(), weight.y(), weight.z(), 0}, {}};
  }
  for (const auto& [load, i] : loads) {
    const double factor = loads_grow && load->history.empty() ? now.time : load_factor(*load, now.time);
    for (int k = 0; k < 3; ++k) {
      node_force_[i].force[k] += factor * load->force[k];
      node_force_[i].moment[k] += factor * load->moment[k];
    }
  }
  for (const PulledNode& pull : now.pulls)
    if (const int i = local(pull.node); i >= 0)
      for (int k = 0; k < 3; ++k) node_force_[i].force[k] += pull.force[k];
  if (remembers) beams_.remember(elements);
  damp(parameters);
  ends_here = false;
}

void BodySystem::take_forces() {
  for (int i = 0; i < count; ++i) {
    force[i] = Eigen::Map<const Vec3>(node_force_[i].force);
    moment[i] = Eigen::Map<const Vec3>(node_force_[i].moment);
  }
}

// Where both ends of an anchor are.
std::array<Vec3, 2> BodySystem::ends(const OwnAnchor& one, const BodyMotion& motion) const {
  const auto at = [&](const EndOfAnchor& end) {
    return end.node < 0 ? model.anchors[one.index].to : Vec3(motion.position[end.node] + end.arm(motion));
  };
  return {at(one.own), at(one.other)};
}

template <bool with_tangent>
void BodySystem::add_anchors(const BodyMotion& motion) {
  for (const OwnAnchor& one : anchors) {
    const Anchor& anchor = model.anchors[one.index];
    const auto [at, to] = ends(one, motion);
    const AnchorForce now = anchor_force(anchor, one.state, at, to);
    const auto push = [&](const EndOfAnchor& end, const Vec3& by) {
      if (end.node < 0) return;
      force[end.node] += by;
      moment[end.node] += end.arm(motion).cross(by);
    };
    push(one.own, now.force);
    push(one.other, -now.force);
    if constexpr (with_tangent) {
      const Mat3 tangent = anchor_tangent(anchor, one.state, at, to);
      const auto add_own = [&](const EndOfAnchor& end, const Vec3& by) {
        if (end.node < 0) return;
        const Mat6 slope = -anchor_slope(tangent, end.arm(motion), by);
        lu.add(end.node, end.node, slope);
      };
      const auto add_across = [&](const EndOfAnchor& end, const EndOfAnchor& far) {
        if (end.node < 0 || far.node < 0) return;
        const Mat3 lever = skew(end.arm(motion)), across = -tangent * skew(far.arm(motion));
        Mat6 slope;
        slope << tangent, across, lever * tangent, lever * across;
        lu.add(end.node, far.node, slope);
      };
      add_own(one.own, now.force);
      add_own(one.other, -now.force);
      add_across(one.own, one.other);
      add_across(one.other, one.own);
    }
  }
}

ContactInput BodySystem::plane_contact(const TouchingPair& pair, const BodyMotion& motion,
                                       std::span<const Vec3> stick_start, std::span<const Vec3> start) const {
  return {model.planes[pair.plane].normal,
          pair.depth,
          pair.L,
          motion.velocity[pair.node],
          stick_start[pair.point * model.planes.size() + pair.plane] + motion.position[pair.node] -
              start[pair.node],
          contact_mass_[pair.own_body],
          false};
}

void BodySystem::find_plane_contacts(const BodyMotion& motion, std::vector<TouchingPair>& found) const {
  found.clear();
  const int planes = static_cast<int>(model.planes.size());
  found.reserve(4 * point_packs_.size() * planes);
  const ContactOutput open{Vec3::Zero(), 0, 0, Vec3::Zero(), Vec3::Zero(), 0};
  for (const PointPack& pack : point_packs_) {
    const PackVector<Four> x = gather(motion.position.data(), pack.node);
    const auto travel = [&](int k) {  // into plane k, m
      const Vec3& n = model.planes[k].normal;
      return reaches_[pack.reach + k].place - (x.x * Four(n.x()) + x.y * Four(n.y()) + x.z * Four(n.z()));
    };
    int touching = 0;  // bits
    for (int k = 0; k < planes; ++k) touching |= lanes_above(travel(k), 0);
    if (touching == 0) continue;
    for (int lane = 0; lane < pack.count; ++lane)
      for (int k = 0; (touching >> lane & 1) && k < planes; ++k) {
        const double L = reaches_[pack.reach + k].L[lane], depth = travel(k)[lane] / L;
        if (depth > 0)
          found.push_back({pack.first + lane, k, pack.node[lane], pack.own_body, depth, L, open});
      }
  }
}

void BodySystem::find_contacts(const ContactLaw& law, const BodyMotion& motion,
                               std::span<const Vec3> stick_start, std::span<const Vec3> start,
                               Contacts& found) const {
  find_plane_contacts(motion, found.planes);
  for (TouchingPair& pair : found.planes)
    new (&pair.out)  // in its place: a copy waits for what was just stored
        ContactOutput(
            contact_force(on_plane(law, pair.node), plane_contact(pair, motion, stick_start, start)));
  find_member_contacts(law, member_pairs_, motion.position, motion.velocity, start, found.members);
}

// Slope of the force on node i by the place of node j, N/m, taken off; both move with what carries them.
void BodySystem::add_slope(int i, int j, const Mat3& slope, const BodyMotion& motion) {
  const int a = moves_with_[i], b = moves_with_[j];
  Mat6 block = Mat6::Zero();
  block.topLeftCorner<3, 3>() = slope;
  if (b != j) block.topRightCorner<3, 3>() = -slope * skew(motion.position[j] - motion.position[b]);
  if (a != i) block.bottomRows<3>() = skew(motion.position[i] - motion.position[a]) * block.topRows<3>();
  lu.add(a, b, block);
}

// Forces on nodes that rigid bodies carry become theirs.
template <bool with_tangent>
void BodySystem::carry_forces(const BodyMotion& motion) {
  for (const RigidInSystem& one : rigid) {
    Mat6 turning = Mat6::Zero();
    for (int i = one.first; i < one.first + one.count; ++i) {
      const Vec3 arm = motion.position[i] - motion.position[one.own];
      force[one.own] += force[i];
      moment[one.own] += arm.cross(force[i]);
      if constexpr (with_tangent) turning.bottomRightCorner<3, 3>() -= skew(force[i]) * skew(arm);
      force[i].setZero();
    }
    if constexpr (with_tangent) lu.add(one.own, one.own, turning);
  }
}

template <bool with_tangent>
void BodySystem::add_contacts(const ContactLaw& law, const BodyMotion& motion,
                              std::span<const Vec3> stick_start, std::span<const Vec3> start,
                              double velocity_factor) {
  find_contacts(law, motion, stick_start, start, contacts);
  for (const TouchingPair& pair : contacts.planes) {
    force[pair.node] += pair.out.force;
    if constexpr (with_tangent) {
      Mat3 by_position, by_velocity;
      contact_force(on_plane(law, pair.node), plane_contact(pair, motion, stick_start, start), by_position,
                    by_velocity);
      add_slope(pair.node, pair.node, -by_position - velocity_factor * by_velocity, motion);
    }
  }
  add_forces(contacts.members, member_pairs_, force);
  if constexpr (with_tangent) {
    const auto add = [&](int i, int j, const Mat3& slope) { add_slope(i, j, slope, motion); };
    add_tangent(law, contacts.members, member_pairs_, motion.position, velocity_factor, std::ref(add));
  }
  carry_forces<with_tangent>(motion);
}

void BodySystem::evaluate(const Parameters& parameters, const StepInputs& now, const BodyMotion& motion,
                          std::span<const Vec3> stick_start, std::span<const Vec3> start) {
  evaluate_free(parameters, now, motion);
  add_contacts<false>(now.law, motion, stick_start, start, 0);
}

void BodySystem::evaluate_free(const Parameters& parameters, const StepInputs& now,
                               const BodyMotion& motion) {
  start_forces(parameters, now);
  beams_.subtract_gradient(elements, motion, node_force_);
  take_forces();
  add_anchors<false>(motion);
}

void BodySystem::evaluate_with_tangent(const Parameters& parameters, const StepInputs& now,
                                       const BodyMotion& motion, std::span<const Vec3> stick_start,
                                       std::span<const Vec3> start, double velocity_factor) {
  start_forces(parameters, now);
  beams_.subtract_gradient(elements, motion, velocity_factor, node_force_, lu);
  take_forces();
  add_anchors<true>(motion);
  add_contacts<true>(now.law, motion, stick_start, start, velocity_factor);
}

BodyEnergy BodySystem::energy(const ContactLaw& law, const BodyMotion& motion, const Contacts& now,
                              std::vector<SectionForces>& sections) {
  BodyEnergy sum;
  sum.kinetic = kinetic_energy(motion);
  if (ends_here && !remembers) {
    sum.strain = beams_.latest_energy(sections);
    ends_here = false;
  } else {
    sum.strain = elastic_energy(motion, sections);
  }
  for (const TouchingPair& pair : now.planes) {
    // the printed law has no spring: what it takes in is dissipated
    if (traits(law).stores_energy) sum.contact += penalty_energy(law, pair.depth, pair.L);
    sum.contact += pair.out.stick_energy;
  }
  sum.contact += stored_energy(law, now.members, member_pairs_);
  for (const OwnAnchor& own : anchors) {
    const auto [at, to] = ends(own, motion);
    sum.anchor += anchor_force(model.anchors[own.index], own.state, at, to).energy;
  }
  return sum;
}

double BodySystem::elastic_energy(const BodyMotion& motion, std::vector<SectionForces>& sections) {
  if (remembers) beams_.remember(elements);
  return beams_.energy(motion.position, motion.rotation, sections);
}

double BodySystem::kinetic_energy(const BodyMotion& motion) const {
  Four total(0);
  for (const NodePack& pack : node_packs) {
    const PackVector<Four> v = gather(motion.velocity.data(), pack.node),
                           w = gather(motion.angular_velocity.data(), pack.node);
    total = total + pack.mass * dot(v, v) + dot(w, pack.inertia * w);
  }
  return sum(total) / 2;
}

void BodySystem::load(const State& state, BodyMotion& motion) const {
  take(state.position, motion.position);
  take(state.velocity, motion.velocity);
  take(state.rotation, motion.rotation);
  take(state.angular_velocity, motion.angular_velocity);
  for (const RigidInSystem& one : rigid) {
    const BodyState& s = state.bodies[one.body];
    motion.position[one.own] = s.position;
    motion.velocity[one.own] = s.velocity;
    motion.rotation[one.own] = s.rotation;
    motion.angular_velocity[one.own] = s.angular_velocity;
  }
  place_carried(motion);
}

void BodySystem::store(const BodyMotion& motion, State& state) const {
  put(motion.position, state.position);
  put(motion.velocity, state.velocity);
  put(motion.rotation, state.rotation);
  put(motion.angular_velocity, state.angular_velocity);
  for (const RigidInSystem& one : rigid) {
    BodyState& s = state.bodies[one.body];
    s.position = motion.position[one.own];
    s.velocity = motion.velocity[one.own];
    s.rotation = motion.rotation[one.own];
    s.angular_velocity = motion.angular_velocity[one.own];
  }
}

void BodySystem::place_carried(BodyMotion& motion) const {
  for (const RigidInSystem& one : rigid) {
    const Mat3 r = motion.rotation[one.own].toRotationMatrix();
    const Vec3 &centre = model.bodies[one.body].centre_of_gravity, &omega = motion.angular_velocity[one.own];
    for (int i = one.first; i < one.first + one.count; ++i) {
      const Vec3 arm = model.node_position[node[i]] - centre;
      motion.position[i] = motion.position[one.own] + r * arm;
      motion.velocity[i] = motion.velocity[one.own] + r * omega.cross(arm);
      motion.rotation[i] = motion.rotation[one.own];
      motion.angular_velocity[i] = omega;
    }
  }
}

void BodySystem::load_memory(const State& state, const BodyMotion& motion) {
  const auto is_torn = [&](const OwnElement& own) {
    return state.elements[own.element].hinge == Hinge::broken;
  };
  // what tears takes energy: before, there is nothing to look for
  const bool torn = !yields && state.energy.plastic != 0 && ranges::any_of(own_elements, is_torn);
  const bool remembered = std::exchange(remembers, yields || torn);
  for (std::size_t k = 0; (remembers || remembered) && k < own_elements.size(); ++k)
    elements[k] = state.elements[own_elements[k].element];
  if (remembered && !remembers) beams_.remember(elements);
  for (OwnAnchor& own : anchors) own.state = state.anchors[own.index];
  load_sticks(state);
  for (MemberPair& pair : member_pairs_) pair.start = gather(pair, motion.position);
}

void BodySystem::load_sticks(const State& state) {
  sticks_.load(state, member_pairs_);
}

void BodySystem::store_stick(const Contacts& now, State& state) {
  const std::size_t planes = model.planes.size();
  for (const int b : bodies) {
    const Body& body = model.bodies[b];
    std::fill_n(state.stick.begin() + body.first_contact_point * planes, body.contact_point_count * planes,
                Vec3::Zero());
  }
  for (const TouchingPair& pair : now.planes) state.stick[pair.point * planes + pair.plane] = pair.out.stick;
  if (!candidate_pairs.empty()) sticks_.store(now.members.touches, member_pairs_);
}

int BodySystem::element_at(int global) const {
  for (const OwnElement& own : own_elements)
    if (model.elements[own.element].node[0] == global || model.elements[own.element].node[1] == global)
      return own.element;
  return -1;
}

}  // namespace topple
