// Anchors of a rigid or elastic body to the floor's frame (anchor.h), and pulls on its nodes, which are
// anchors without stiffness. Vectors are in the floor's axes where nothing else is said.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/frame/step_span.h"
#include "solver/reduced/body_contacts.h"

namespace topple {

class BodyAnchors {
 public:
  /// One anchor of the body, or a pull.
  struct Tie {
    const Anchor* anchor;     ///< of a pull one of no stiffness
    int index;                ///< into Model::anchors; -1: a pull
    int node;                 ///< within the body
    Vec3 place;               ///< m, of the attached point from the centre of gravity, reference axes
    std::vector<Vec3> shape;  ///< 1/sqrt(kg), anchor_shape() per mode
    AnchorState state;
    Vec3 arm;         ///< m, of the attached point from the centre of gravity, at the last find
    AnchorForce now;  ///< at the last find; of a pull as it was taken
  };

  BodyAnchors(const Model& model, int body);
  /// State::anchors holds from here on.
  void remember(std::span<const AnchorState> all);
  /// These pulls act from here on, of all bodies.
  void take(std::span<const PulledNode> pulls);
  /// Forces at the pose of `s`.
  void find(const BodyState& s);
  /// Work of the pulls taken last while `before` became `s`, J; `start`: of all bodies, at `before`.
  double pull_work(std::span<const PulledNode> start, std::span<const PulledNode> end,
                   const BodyState& before, const BodyState& s) const;

  bool any() const;       ///< an anchor is in place, or there is a pull
  bool holds() const;     ///< an anchor is in place
  Vec3 force() const;     ///< N
  Vec3 moment() const;    ///< N m, about the centre of gravity
  double energy() const;  ///< J
  /// Adds their forces on the modes, N/sqrt(kg).
  void modal_loads(const BodyState& s, int modes, Amplitudes& load) const;
  /// Adds `gamma_dt`, s, times the derivatives of force and moment by displacement and rotation: those by the
  /// velocity in an implicit stage, which moves the body by gamma_dt times it. `s`: the pose that find had.
  void add_slope(const BodyState& s, double gamma_dt, ContactSlope& slope) const;
  /// Adds -d(force, moment, modal loads)/d(displacement, rotation, amplitudes); 6 + modes rows and columns.
  /// `s`: the pose that find had.
  void add_stiffness(const BodyState& s, int modes, Eigen::MatrixXd& stiffness) const;
  // Of those in place, taken to be as stiff in all directions.
  double greatest_stiffness() const;  ///< N/m, their sum
  double stiffest() const;            ///< 1/s^2: no squared frequency of the body on them is greater
  std::uint64_t hash() const;         ///< of which are in place
  const std::vector<Tie>& ties() const { return ties_; }

 private:
  Tie tie_of(const Anchor& anchor, int index, const AnchorEnd& end) const;

  const Model& model_;
  const int body_;
  double mass_, inverse_moment_;
  std::vector<Tie> ties_;  // pulls last
};

}  // namespace topple
