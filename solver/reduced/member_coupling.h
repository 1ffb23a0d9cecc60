// Contact between members of rigid and elastic bodies, and with floors and walls made of members: how the
// ends of their elements move with the bodies, and what forces there do to these.
//   x_i = X + R (r_i + shape_i q),  v_i = J_i u,  J_i = [1, -[R (r_i + shape_i q)], R shape_i]
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "solver/contact/member_contact.h"
#include "solver/math/types.h"
#include "solver/model/model.h"
#include "solver/reduced/body_contacts.h"
#include "solver/reduced/body_ties.h"
#include "solver/state/state.h"
#include "solver/state/step_result.h"

namespace topple {

/// Elements of some bodies that may touch each other; of rigid ones whole members, which stay straight.
/// `body` is a place in the constructor's list; nodes are numbered within this.
class MemberCoupling {
 public:
  /// Unknowns of a body in groups of six: its rigid motion, then modes, filled up with zeros.
  static constexpr int k_most_groups = 1 + (k_modes + 5) / 6;
  static int groups(int modes) { return 1 + (modes + 5) / 6; }

  /// Of each of `candidate_pairs`, in order, one or both elements belong to `bodies`, indices into the model;
  /// the other belongs to a body that is held. Bodies stay on the levels that they have in `states`, one per
  /// body of the model.
  MemberCoupling(const Model& model, std::vector<int> bodies, std::span<const ElementPair> candidate_pairs,
                 std::span<const BodyState> states);

  /// A pair's elements: of a member the first one.
  std::span<MemberPair> pairs() { return pairs_; }
  /// Bodies of a pair's elements; -1: held.
  std::array<int, 2> bodies_of(const MemberPair& pair) const {
    return {nodes_[pair.node[0]].body, nodes_[pair.node[2]].body};
  }

  /// f(node, its body).
  template <class F>
  void each_node(F f) const {
    for (int k = 0; k < static_cast<int>(nodes_.size()); ++k) f(k, nodes_[k].body);
  }

  /// Anchors between the bodies; place() places them too.
  BodyTies& ties() { return ties_; }

  /// pairs() start where the nodes are; their gaps there are known from here on.
  void start();
  void start(std::span<const int> which);  ///< some of them
  /// The same for copies of pairs that moved little since they started; gaps of some millimetres are lower
  /// bounds.
  void go_on(std::span<MemberPair> pairs) const;
  /// Held nodes stand where they are in `state`.
  void place_held(const State& state);
  /// Nodes of a body at `pose` that moves at u; r: its rotation matrix.
  void place(int body, const BodyState& pose, const PackMat3& r, const BodyVelocity& u);
  void place(int body, const BodyState& s);
  const std::vector<Vec3>& position() const { return position_; }  ///< m, per node as placed
  const std::vector<Vec3>& velocity() const { return velocity_; }  ///< m/s
  int modes(int body) const { return modes_[body]; }               ///< as placed
  /// m, from its body's centre of gravity, of the point of a touch on part `side` of its pair, 0 or 1.
  Vec3 arm(const MemberTouch& touch, const MemberPair& pair, int side) const;

  /// Time until the next open one of `pairs` closes, s, as the bodies were placed by their states, where the
  /// pairs start; infinite: not within `within`.
  double next_touch(std::span<const MemberPair> pairs, double within) const;

  /// Of the forces on nodes and of anchors between the bodies, per body: N, N m about the centre of gravity,
  /// N/sqrt(kg).
  const std::vector<BodyVelocity>& loads(const MemberContacts& contacts, std::span<const MemberPair> pairs);
  /// The part of them by MemberContacts::blends.
  const std::vector<BodyVelocity>& blend_loads(const MemberContacts& contacts,
                                               std::span<const MemberPair> pairs);
  /// Calls add with the parts of J^T t J, t: PairTangent of all that touches, and with those of anchors.
  /// Block (i, j) of six unknowns belongs to group i of body a and j of b.
  using AddBlock = BodyTies::AddBlock;
  void each_block(const ContactLaw& law, const MemberContacts& contacts, std::span<const MemberPair> pairs,
                  double velocity_factor, const AddBlock& add) const;

 private:
  using Columns = Eigen::Matrix<double, 3, 6>;
  struct Acceleration {
    Vec3 linear, angular, spin;  // m/s^2, rad/s^2, rad/s
    double speed, gain;          // m/s, m/s^2: of no point of an undeformed body greater
  };
  struct Node {
    int body, node;  // index into the model
    Vec3 place;      // m, from the centre of gravity, reference axes
  };
  int number_of(int node);
  void clear_loads();
  void add_blends(const MemberContacts& contacts, std::span<const MemberPair> pairs);
  void add_blocks(const PairTangent& tangent, const MemberPair& pair, const AddBlock& add) const;
  Vec3 acceleration(int node) const;
  Vec3 shape(const Node& node, int mode) const;

  const Model& model_;
  const std::vector<int> bodies_;
  std::vector<Node> nodes_;
  std::vector<int> number_;                 // per node of the model, within this; -1: none
  std::vector<std::vector<int>> nodes_of_;  // per body
  std::vector<MemberPair> pairs_;
  BodyTies ties_;
  std::vector<int> modes_;  // per body
  std::vector<Vec3> position_, velocity_, arm_;
  std::vector<Vec3> shape_;  // k_modes per node, floor's axes
  std::vector<BodyVelocity> loads_;
  std::vector<Acceleration> acceleration_;  // per body, as placed by its state
};

/// A first guess at an implicit substep after one of `pairs` touched, s; infinite without pairs.
double first_substep(const ContactLaw& law, std::span<const MemberPair> pairs);

/// To what acts on a body: a load of MemberCoupling::loads.
inline void add_load(const BodyVelocity& load, BodyState& s) {
  s.force += unpacked(load.linear);
  s.moment += unpacked(load.angular);
  s.load += load.rate;
}

}  // namespace topple
