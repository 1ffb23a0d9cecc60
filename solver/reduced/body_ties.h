// Anchors between rigid and elastic bodies that are stepped together (anchor.h): F on the first body's point,
// -F on the second's, so that the bodies' momentum stays; where the points meet along the force, so does
// their angular momentum.
//   block (a, b) of the stiffness: s_a s_b J_a^T (-dF/d(at)) J_b, s = 1, -1, and of a body with itself what
//   the turn of its arm adds;  J = [1, -[arm], R shape]
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "solver/contact/anchor.h"
#include "solver/reduced/body_contacts.h"

namespace topple {

/// Those of a model whose two ends are on `bodies`; `body`: a place in that list.
class BodyTies {
 public:
  BodyTies(const Model& model, const std::vector<int>& bodies);

  /// State::anchors holds from here on.
  void remember(std::span<const AnchorState> all);
  /// A body's ends where it stands at `pose`; r: its rotation matrix.
  void place(int body, const BodyState& pose, const PackMat3& r);

  /// f(first body, second body) of each that is in place.
  template <class F>
  void each_in_place(F f) const {
    for (const Tie& tie : ties_)
      if (tie.state.hold == AnchorHold::in_place) f(tie.end[0].body, tie.end[1].body);
  }
  double energy() const;  ///< J, as placed
  /// Adds the forces, as placed, to those on each body: N, N m about the centre of gravity, N/sqrt(kg).
  void add_loads(std::vector<BodyVelocity>& loads) const;
  /// f(node of the model, force on it, N).
  template <class F>
  void each_force(F f) const {
    for (const Tie& tie : ties_) {
      const Vec3 force = now(tie).force;
      f(tie.end[0].node, force);
      f(tie.end[1].node, Vec3(-force));
    }
  }
  /// Calls add with the parts of their stiffness, as MemberCoupling::each_block does.
  using AddBlock = std::function<void(int a, int i, int b, int j, const Mat6& block, const Mat6& of_stick)>;
  void each_block(const AddBlock& add) const;
  double greatest_stiffness() const;  ///< N/m, sum of those in place
  /// A first guess at an implicit substep, s; infinite without ties in place.
  double first_substep() const;

 private:
  struct End {
    int body, node;
    Vec3 place;               // m, from the centre of gravity, reference axes
    std::vector<Vec3> shape;  // per mode, 1/sqrt(kg), reference axes
    double mass;              // kg, of the body
    int modes = 0;            // as placed
    Vec3 arm, at;             // m, floor's axes
    std::vector<Vec3> turned;
  };
  struct Tie {
    int index;
    std::array<End, 2> end;
    AnchorState state;
  };
  const Anchor& anchor(const Tie& tie) const { return model_.anchors[tie.index]; }
  AnchorForce now(const Tie& tie) const {
    return anchor_force(anchor(tie), tie.state, tie.end[0].at, tie.end[1].at);
  }

  static void add_turning(const End& end, int i, int j, const Vec3& force, Mat6& block);

  const Model& model_;
  std::vector<Tie> ties_;
};

}  // namespace topple
