#include "solver/reduced/member_coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "solver/contact/member_pairs.h"
#include "solver/contact/nearest_places.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/reduced/rigid_pair_slopes.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_wide = 5e-3;  // m, gap that is not followed exactly

}  // namespace

MemberCoupling::MemberCoupling(const Model& model, std::vector<int> bodies,
                               std::span<const ElementPair> candidate_pairs,
                               std::span<const BodyState> states)
    : model_(model),
      bodies_(std::move(bodies)),
      nodes_of_(bodies_.size()),
      ties_(model, bodies_),
      modes_(bodies_.size(), 0),
      loads_(bodies_.size()),
      acceleration_(bodies_.size()) {
  number_.assign(model.node_total(), -1);
  const auto is_own = [this](int body) { return ranges::find(bodies_, body) != bodies_.end(); };
  pairs_ = member_pairs(model, candidate_pairs,
                        {.by_elements = [&](int body, int) { return traits(states[body].level).has_modes; },
                         .number = [this](int node) { return number_of(node); },
                         .inverse_mass =
                             [&](int body) {
                               const Body& own = model.bodies[body];
                               return is_own(body) ? std::max(1, own.contact_point_count) / own.mass : 0;
                             }});
  for (auto* array : {&position_, &velocity_, &arm_}) array->assign(nodes_.size(), Vec3::Zero());
  shape_.assign(nodes_.size() * k_modes, Vec3::Zero());
}

int MemberCoupling::number_of(int node) {
  int& number = number_[node];
  if (number >= 0) return number;
  const int index = model_.node_body[node];
  const auto own = ranges::find(bodies_, index);
  number = static_cast<int>(nodes_.size());
  if (own == bodies_.end()) {
    nodes_.push_back({-1, node, Vec3::Zero()});
  } else {
    const int body = static_cast<int>(own - bodies_.begin());
    nodes_.push_back({body, node, model_.node_position[node] - model_.bodies[index].centre_of_gravity});
    nodes_of_[body].push_back(number);
  }
  return number;
}

namespace {

// Gaps of pairs where they start, four at a time.
class GapFinder {
 public:
  ~GapFinder() { find(); }
  void add(MemberPair& pair) {
    if (pair.panel != nullptr) {
      pair.gap = nearest_gap(pair, pair.start);
      return;
    }
    pair_[count_++] = &pair;
    if (count_ == 4) find();
  }

 private:
  void find() {
    if (count_ == 0) return;
    std::array<PackVector<Four>, 4> x{};
    for (int k = 0; k < 4; ++k)
      for (int end = 0; end < 4; ++end) set_lane(x[end], k, pair_[k < count_ ? k : 0]->start[end]);
    const PackVector<Four> u = x[1] - x[0], v = x[3] - x[2], r = x[0] - x[2];
    const auto [s, t] = nearest_places(u, v, r);
    const PackVector<Four> between = r + s * u - t * v;
    const Four distance = sqrt(dot(between, between));
    for (int k = 0; k < count_; ++k) pair_[k]->gap = distance[k] - pair_[k]->L;
    count_ = 0;
  }

  std::array<MemberPair*, 4> pair_;
  int count_ = 0;
};

}  // namespace

void MemberCoupling::start() {
  GapFinder gaps;
  for (MemberPair& pair : pairs_) {
    bool known = pair.gap != 0;
    for (int k = 0; k < pair.nodes(); ++k) {
      const Vec3& x = position_[pair.node[k]];
      known = known && x == pair.start[k];
      pair.start[k] = x;
    }
    if (!known) gaps.add(pair);
  }
}

void MemberCoupling::start(std::span<const int> which) {
  GapFinder gaps;
  for (const int p : which) {
    MemberPair& pair = pairs_[p];
    for (int k = 0; k < pair.nodes(); ++k) pair.start[k] = position_[pair.node[k]];
    gaps.add(pair);
  }
}

void MemberCoupling::go_on(std::span<MemberPair> pairs) const {
  GapFinder gaps;
  for (MemberPair& pair : pairs) {
    std::array<double, 2> way2{};
    for (int k = 0; k < pair.nodes(); ++k) {
      const Vec3& x = position_[pair.node[k]];
      double& greatest = way2[k > 1];
      greatest = std::max(greatest, (x - pair.start[k]).squaredNorm());
      pair.start[k] = x;
    }
    pair.gap -= std::sqrt(way2[0]) + std::sqrt(way2[1]);
    if (!(pair.gap > k_wide)) gaps.add(pair);
  }
}

double first_substep(const ContactLaw& law, std::span<const MemberPair> pairs) {
  double least = std::numeric_limits<double>::infinity();
  for (const MemberPair& pair : pairs)
    least = std::min(
        least, k_resolved_bounce *
                   std::sqrt(pair.mass * pair.L / (law.member_share * law.alpha * std::max(1., law.q))));
  return least;
}

void MemberCoupling::place_held(const State& state) {
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    if (nodes_[k].body < 0) position_[k] = state.position[nodes_[k].node];
}

Vec3 MemberCoupling::shape(const Node& node, int mode) const {
  const Body& body = model_.bodies[bodies_[node.body]];
  return body.elastic->shape.block<3, 1>(6 * (node.node - body.first_node), mode);
}

void MemberCoupling::place(int body, const BodyState& pose, const PackMat3& r, const BodyVelocity& u) {
  const Vec3 linear = unpacked(u.linear), angular = unpacked(u.angular);
  const bool bends = traits(pose.level).has_modes;
  modes_[body] = bends ? model_.bodies[bodies_[body]].elastic->modes : 0;
  ties_.place(body, pose, r);
  for (const int k : nodes_of_[body]) {
    const Node& node = nodes_[k];
    Vec3 arm = unpacked(r * packed(node.place)), relative = Vec3::Zero();
    for (int mode = 0; mode < modes_[body]; ++mode) {
      Vec3& turned = shape_[k * k_modes + mode] = unpacked(r * packed(shape(node, mode)));
      arm += pose.amplitude[mode] * turned;
      relative += u.rate[mode] * turned;
    }
    arm_[k] = arm;
    position_[k] = pose.position + arm;
    velocity_[k] = linear + angular.cross(arm) + relative;
  }
}

void MemberCoupling::place(int body, const BodyState& s) {
  const PackQuaternion<double> q = packed(s.rotation);
  place(body, s, rotation_matrix(q), {packed(s.velocity), rotate(q, packed(s.angular_velocity)), s.rate});
  const Body& own = model_.bodies[bodies_[body]];
  const Vec3& omega = s.angular_velocity;
  const Vec3 turning = s.rotation.conjugate() * s.moment - omega.cross(own.inertia * omega);
  const Vec3 linear = s.force / own.mass, angular = own.inertia.inverse() * turning;
  acceleration_[body] = {linear, s.rotation * angular, s.rotation * omega,
                         s.velocity.norm() + own.reach * omega.norm(),
                         linear.norm() + own.reach * (angular.norm() + omega.squaredNorm())};
}

Vec3 MemberCoupling::acceleration(int k) const {
  if (nodes_[k].body < 0) return Vec3::Zero();
  const Acceleration& of = acceleration_[nodes_[k].body];
  return of.linear + of.angular.cross(arm_[k]) + of.spin.cross(of.spin.cross(arm_[k]));
}

double MemberCoupling::next_touch(std::span<const MemberPair> pairs, double within) const {
  double soonest = within;
  for (const MemberPair& pair : pairs) {
    if (!(pair.gap > 0)) continue;
    double way = 0;
    for (const int body : bodies_of(pair)) {
      if (body < 0) continue;
      const Acceleration& of = acceleration_[body];
      way += modes_[body] > 0 ? pair.gap : soonest * (of.speed + soonest / 2 * of.gain);
    }
    if (way < pair.gap) continue;
    const NearestShares near = nearest_shares(pair, gather(pair, position_));
    for (int k = 0; k < near.count; ++k) {
      const auto& [share, between, gap] = near.at[k];
      const auto closing = [&, &share = share, &between = between](const auto& of) {
        Vec3 relative = Vec3::Zero();
        for (int i = 0; i < pair.nodes(); ++i) relative += share[i] * of(pair.node[i]);
        return -between.dot(relative) / between.norm();
      };
      // gap - v t - a t^2/2 = 0, the first t > 0
      const double v = closing([&](int node) { return velocity_[node]; }),
                   a = closing([&](int node) { return acceleration(node); });
      const double root = v * v + 2 * a * gap, down = v + std::sqrt(std::max(root, 0.));
      if (root >= 0 && down > 0) soonest = std::min(soonest, 2 * gap / down);
    }
  }
  return soonest < within ? soonest : std::numeric_limits<double>::infinity();
}

Vec3 MemberCoupling::arm(const MemberTouch& touch, const MemberPair& pair, int side) const {
  Vec3 arm = Vec3::Zero();
  for (int k = side == 0 ? 0 : 2; k < (side == 0 ? 2 : pair.nodes()); ++k)
    arm += touch.share[k] * arm_[pair.node[k]];
  return side == 0 ? arm : Vec3(-arm);
}

void MemberCoupling::clear_loads() {
  for (BodyVelocity& load : loads_) {
    load.linear = load.angular = {0, 0, 0};
    load.rate.setZero();
  }
}

void MemberCoupling::add_blends(const MemberContacts& contacts, std::span<const MemberPair> pairs) {
  for (const MemberBlend& blend : contacts.blends)
    for (int k = 0; k < pairs[blend.pair].nodes(); ++k) {
      const int node = pairs[blend.pair].node[k], body = nodes_[node].body;
      if (body < 0) continue;
      const Vec3 force = -blend.slope * blend.surplus * blend.by_sine[k];
      BodyVelocity& load = loads_[body];
      load.linear = load.linear + packed(force);
      load.angular = load.angular + packed(Vec3(arm_[node].cross(force)));
      for (int mode = 0; mode < modes_[body]; ++mode)
        load.rate[mode] += shape_[node * k_modes + mode].dot(force);
    }
}

const std::vector<BodyVelocity>& MemberCoupling::blend_loads(const MemberContacts& contacts,
                                                             std::span<const MemberPair> pairs) {
  clear_loads();
  add_blends(contacts, pairs);
  return loads_;
}

const std::vector<BodyVelocity>& MemberCoupling::loads(const MemberContacts& contacts,
                                                       std::span<const MemberPair> pairs) {
  clear_loads();
  for (const MemberTouch& touch : contacts.touches) {
    const MemberPair& pair = pairs[touch.pair];
    const Vec3& force = touch.out.force;
    for (int side = 0; side < 2; ++side) {
      const int first = side == 0 ? 0 : 2, end = side == 0 ? 2 : pair.nodes();
      const int body = nodes_[pair.node[first]].body;
      if (body < 0) continue;
      BodyVelocity& load = loads_[body];
      load.linear = side == 0 ? load.linear + packed(force) : load.linear - packed(force);
      PackVector<double> arm = touch.share[first] * packed(arm_[pair.node[first]]);
      for (int k = first + 1; k < end; ++k) arm = arm + touch.share[k] * packed(arm_[pair.node[k]]);
      load.angular = load.angular + cross(arm, packed(force));
      for (int mode = 0; mode < modes_[body]; ++mode) {
        Vec3 shape = touch.share[first] * shape_[pair.node[first] * k_modes + mode];
        for (int k = first + 1; k < end; ++k) shape += touch.share[k] * shape_[pair.node[k] * k_modes + mode];
        load.rate[mode] += shape.dot(force);
      }
    }
  }
  add_blends(contacts, pairs);
  ties_.add_loads(loads_);
  return loads_;
}

// Adds a tangent's blocks, of any bodies.
void MemberCoupling::add_blocks(const PairTangent& tangent, const MemberPair& pair,
                                const AddBlock& add) const {
  // Of a vector at the ends of element `side`, by the unknowns of a group of its body.
  const auto columns_at = [&](int node, int group) {
    Columns j = Columns::Zero();
    if (group == 0) {
      j.leftCols<3>().setIdentity();
      j.rightCols<3>() = -skew(arm_[node]);
    } else {
      const int first = 6 * (group - 1), modes = modes_[nodes_[node].body];
      for (int k = 0; k < 6 && first + k < modes; ++k) j.col(k) = shape_[node * k_modes + first + k];
    }
    return j;
  };
  const std::array<int, 2> bodies = bodies_of(pair);
  std::array<std::array<Columns, k_most_groups>, 2> at_touch;
  std::array<std::array<std::array<Vec6, 4>, k_most_groups>, 2> left, right;
  for (int side = 0; side < 2; ++side) {
    const int first = side == 0 ? 0 : 2, end = side == 0 ? 2 : pair.nodes();
    for (int i = 0; bodies[side] >= 0 && i < groups(modes_[bodies[side]]); ++i) {
      at_touch[side][i].setZero();
      for (int p = 0; p < tangent.product_count; ++p) left[side][i][p] = right[side][i][p] = Vec6::Zero();
      for (int k = first; k < end; ++k) {
        const Columns columns = columns_at(pair.node[k], i);
        at_touch[side][i] += tangent.share[k] * columns;
        for (int p = 0; p < tangent.product_count; ++p) {
          left[side][i][p] += columns.transpose() * tangent.products[p].left[k];
          right[side][i][p] += columns.transpose() * tangent.products[p].right[k];
        }
      }
    }
  }
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      if (bodies[a] < 0 || bodies[b] < 0) continue;
      for (int i = 0; i < groups(modes_[bodies[a]]); ++i)
        for (int j = 0; j < groups(modes_[bodies[b]]); ++j) {
          Mat6 block = at_touch[a][i].transpose() * (tangent.local * at_touch[b][j]);
          for (int p = 0; p < tangent.product_count; ++p) block += left[a][i][p] * right[b][j][p].transpose();
          const Mat6 of_stick = at_touch[a][i].transpose() * (tangent.stick * at_touch[b][j]);
          add(bodies[a], i, bodies[b], j, block, of_stick);
        }
    }
}

void MemberCoupling::each_block(const ContactLaw& law, const MemberContacts& contacts,
                                std::span<const MemberPair> pairs, double velocity_factor,
                                const AddBlock& add) const {
  const auto are_rigid = [&](const std::array<int, 2>& bodies) {
    return ranges::all_of(bodies, [&](int body) { return body < 0 || modes_[body] == 0; });
  };
  RigidPairSlopes rigid(law, position_, arm_, velocity_factor);
  std::array<int, 2> of_rigid{-1, -1};
  const auto hand_on = [&] {
    rigid.end();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (of_rigid[i] >= 0 && of_rigid[j] >= 0)
          add(of_rigid[i], 0, of_rigid[j], 0, rigid.block(i, j), rigid.of_stick(i, j));
  };
  const auto take_rigid = [&](const MemberPair& pair) {
    const std::array<int, 2> bodies = bodies_of(pair);
    if (!are_rigid(bodies)) return false;
    if (bodies != of_rigid) {
      hand_on();
      rigid.begin();
      of_rigid = bodies;
    }
    return true;
  };
  const auto add_one = [&](const auto& of, bool of_members, auto add_rigid, auto tangent) {
    const MemberPair& pair = pairs[of.pair];
    if (of_members && take_rigid(pair))
      add_rigid(pair);
    else
      add_blocks(tangent(), pair, add);
  };
  auto blend = contacts.blends.begin();
  const auto add_blends = [&](int before) {
    for (; blend != contacts.blends.end() && blend->pair < before; ++blend)
      add_one(
          *blend, true, [&](const MemberPair& pair) { rigid.add_blend(blend_tangent(*blend), pair); },
          [&] { return blend_tangent(*blend); });
  };
  for (const MemberTouch& touch : contacts.touches) {
    add_blends(touch.pair);
    add_one(
        touch, pairs[touch.pair].panel == nullptr, [&](const MemberPair& pair) { rigid.add(touch, pair); },
        [&] { return touch_tangent(law, touch, pairs[touch.pair], position_, velocity_factor); });
  }
  add_blends(std::numeric_limits<int>::max());
  hand_on();
  ties_.each_block(add);
}

}  // namespace topple
