#include "solver/reduced/member_coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "solver/contact/member_pairs.h"
#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
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
      modes_(bodies_.size(), 0),
      loads_(bodies_.size()),
      acceleration_(bodies_.size()) {
  const auto is_own = [this](int body) { return std::ranges::find(bodies_, body) != bodies_.end(); };
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
  const auto known = std::ranges::find(nodes_, node, &Node::node);
  if (known != nodes_.end()) return static_cast<int>(known - nodes_.begin());
  const int index = model_.node_body[node];
  const auto own = std::ranges::find(bodies_, index);
  const int number = static_cast<int>(nodes_.size());
  if (own == bodies_.end()) {
    nodes_.push_back({-1, node, Vec3::Zero()});
  } else {
    const int body = static_cast<int>(own - bodies_.begin());
    nodes_.push_back({body, node, model_.node_position[node] - model_.bodies[index].centre_of_gravity});
    nodes_of_[body].push_back(number);
  }
  return number;
}

void MemberCoupling::start(std::span<MemberPair> pairs) const {
  for (MemberPair& pair : pairs) {
    std::array<Vec3, 4>& x = pair.start;
    for (int k = 0; k < 4; ++k) x[k] = position_[pair.node[k]];
    pair.gap = nearest_points(x[0], x[1], x[2], x[3]).between.norm() - pair.L;
  }
}

void MemberCoupling::go_on(std::span<MemberPair> pairs) const {
  for (MemberPair& pair : pairs) {
    std::array<double, 4> way;
    for (int k = 0; k < 4; ++k) {
      const Vec3& x = position_[pair.node[k]];
      way[k] = (x - pair.start[k]).squaredNorm();
      pair.start[k] = x;
    }
    pair.gap -= std::sqrt(std::max(way[0], way[1])) + std::sqrt(std::max(way[2], way[3]));
    if (!(pair.gap > k_wide)) start({&pair, 1});
  }
}

double first_substep(const ContactLaw& law, std::span<const MemberPair> pairs) {
  double least = std::numeric_limits<double>::infinity();
  for (const MemberPair& pair : pairs)
    least = std::min(least,
                     k_resolved_bounce * std::sqrt(pair.mass * pair.L / (law.alpha * std::max(1., law.q))));
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
  const auto& x = position_;
  for (const MemberPair& pair : pairs) {
    if (!(pair.gap > 0)) continue;
    double way = 0;
    for (const int body : bodies_of(pair)) {
      if (body < 0) continue;
      const Acceleration& of = acceleration_[body];
      way += modes_[body] > 0 ? pair.gap : soonest * (of.speed + soonest / 2 * of.gain);
    }
    if (way < pair.gap) continue;
    const auto& n = pair.node;
    const NearestPoints at = nearest_points(x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
    const double l = at.between.norm(), gap = l - pair.L;
    const auto closing = [&](const auto& of) {
      return -at.between.dot((1 - at.s) * of(n[0]) + at.s * of(n[1]) - (1 - at.t) * of(n[2]) -
                             at.t * of(n[3])) /
             l;
    };
    // gap - v t - a t^2/2 = 0, the first t > 0
    const double v = closing([&](int k) { return velocity_[k]; }),
                 a = closing([&](int k) { return acceleration(k); });
    const double root = v * v + 2 * a * gap, down = v + std::sqrt(std::max(root, 0.));
    if (root >= 0 && down > 0) soonest = std::min(soonest, 2 * gap / down);
  }
  return soonest < within ? soonest : std::numeric_limits<double>::infinity();
}

const std::vector<BodyVelocity>& MemberCoupling::loads(const MemberContacts& contacts,
                                                       std::span<const MemberPair> pairs) {
  for (BodyVelocity& load : loads_) {
    load.linear = load.angular = {0, 0, 0};
    load.rate.setZero();
  }
  const auto push = [&](int k, const Vec3& force) {
    const int body = nodes_[k].body;
    if (body < 0) return;
    BodyVelocity& load = loads_[body];
    load.linear = load.linear + packed(force);
    load.angular = load.angular + packed(Vec3(arm_[k].cross(force)));
    for (int mode = 0; mode < modes_[body]; ++mode) load.rate[mode] += shape_[k * k_modes + mode].dot(force);
  };
  for (const MemberTouch& touch : contacts.touches)
    for (int k = 0; k < 4; ++k) push(pairs[touch.pair].node[k], touch.share[k] * touch.out.force);
  for (const MemberBlend& blend : contacts.blends)
    for (int k = 0; k < 4; ++k)
      push(pairs[blend.pair].node[k], -blend.slope * blend.surplus * blend.by_sine[k]);
  return loads_;
}

namespace {

// Unknowns of a rigid body: J^T of a force on a point, and of a 3 x 3 slope between points of two bodies.
struct RigidArm {
  double share;  // of the point's motion that is the body's
  Vec3 arm;      // m, from the centre of gravity, times that

  Vec6 carry(const Vec3& force) const {
    Vec6 out;
    out << share * force, arm.cross(force);
    return out;
  }
};

Mat6 carried(const RigidArm& a, const Mat3& slope, const RigidArm& b) {
  Mat3 turned;  // -slope [arm]
  for (int k = 0; k < 3; ++k) turned.row(k) = b.arm.cross(slope.row(k).transpose()).transpose();
  Mat6 out;
  out.topLeftCorner<3, 3>() = a.share * b.share * slope;
  out.topRightCorner<3, 3>() = a.share * turned;
  for (int k = 0; k < 3; ++k) {
    out.block<3, 1>(3, k) = b.share * a.arm.cross(slope.col(k));
    out.block<3, 1>(3, 3 + k) = a.arm.cross(turned.col(k));
  }
  return out;
}

}  // namespace

// Of two rigid bodies that touch in many places: their blocks, added up before they are handed on.
struct MemberCoupling::RigidSum {
  std::array<int, 2> bodies{-1, -1};
  Mat6 block[2][2], of_stick[2][2];

  void add(const MemberCoupling& of, const MemberPair& pair, const PairTangent& tangent) {
    RigidArm at_touch[2];
    Vec6 left[2][2], right[2][2];
    for (int side = 0; side < 2; ++side) {
      if (bodies[side] < 0) continue;
      at_touch[side] = {0, Vec3::Zero()};
      for (int p = 0; p < tangent.product_count; ++p) left[side][p] = right[side][p] = Vec6::Zero();
      for (int k = 2 * side; k < 2 * side + 2; ++k) {
        const RigidArm end{1, of.arm_[pair.node[k]]};
        at_touch[side].share += tangent.share[k];
        at_touch[side].arm += tangent.share[k] * end.arm;
        for (int p = 0; p < tangent.product_count; ++p) {
          left[side][p] += end.carry(tangent.products[p].left[k]);
          right[side][p] += end.carry(tangent.products[p].right[k]);
        }
      }
    }
    const bool sticks = !tangent.stick.isZero(0);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        if (bodies[a] < 0 || bodies[b] < 0) continue;
        block[a][b] += carried(at_touch[a], tangent.local, at_touch[b]);
        for (int p = 0; p < tangent.product_count; ++p)
          block[a][b].noalias() += left[a][p] * right[b][p].transpose();
        if (sticks) of_stick[a][b] += carried(at_touch[a], tangent.stick, at_touch[b]);
      }
  }
  void begin(const std::array<int, 2>& which) {
    bodies = which;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        block[a][b].setZero();
        of_stick[a][b].setZero();
      }
  }
  void hand_on(const AddBlock& add) const {
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        if (bodies[a] >= 0 && bodies[b] >= 0) add(bodies[a], 0, bodies[b], 0, block[a][b], of_stick[a][b]);
  }
};

void MemberCoupling::each_block(const ContactLaw& law, const MemberContacts& contacts,
                                std::span<const MemberPair> pairs, double velocity_factor,
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
  RigidSum rigid;
  const auto add_all = [&](const PairTangent& tangent) {
    const MemberPair& pair = pairs[tangent.pair];
    const std::array<int, 2> bodies = bodies_of(pair);
    if (std::ranges::all_of(bodies, [&](int body) { return body < 0 || modes_[body] == 0; })) {
      if (bodies != rigid.bodies) {
        rigid.hand_on(add);
        rigid.begin(bodies);
      }
      rigid.add(*this, pair, tangent);
      return;
    }
    std::array<std::array<Columns, k_most_groups>, 2> at_touch;
    std::array<std::array<std::array<Vec6, 2>, k_most_groups>, 2> left, right;
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; bodies[side] >= 0 && i < groups(modes_[bodies[side]]); ++i) {
        const Columns first = columns_at(pair.node[2 * side], i),
                      second = columns_at(pair.node[2 * side + 1], i);
        at_touch[side][i] = tangent.share[2 * side] * first + tangent.share[2 * side + 1] * second;
        for (int p = 0; p < tangent.product_count; ++p) {
          const PairTangent::Product& product = tangent.products[p];
          left[side][i][p] =
              first.transpose() * product.left[2 * side] + second.transpose() * product.left[2 * side + 1];
          right[side][i][p] =
              first.transpose() * product.right[2 * side] + second.transpose() * product.right[2 * side + 1];
        }
      }
    }
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        if (bodies[a] < 0 || bodies[b] < 0) continue;
        for (int i = 0; i < groups(modes_[bodies[a]]); ++i)
          for (int j = 0; j < groups(modes_[bodies[b]]); ++j) {
            Mat6 block = at_touch[a][i].transpose() * (tangent.local * at_touch[b][j]);
            for (int p = 0; p < tangent.product_count; ++p)
              block += left[a][i][p] * right[b][j][p].transpose();
            const Mat6 of_stick = at_touch[a][i].transpose() * (tangent.stick * at_touch[b][j]);
            add(bodies[a], i, bodies[b], j, block, of_stick);
          }
      }
  };
  each_tangent(law, contacts, pairs, velocity_factor, std::ref(add_all));
  rigid.hand_on(add);
}

}  // namespace topple
