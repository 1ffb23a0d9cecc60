// Anchors of a rigid or slightly deformed body (anchor.h). Vectors are in the floor's axes where nothing else
// is said.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/body/anchors.h"
#include "solver/body/body_contacts.h"

namespace topple {

class BodyAnchors {
 public:
  struct Tie {
    int index;                ///< into Model::anchors
    int node;                 ///< within the body
    Vec3 place;               ///< m, of the attached point from the centre of gravity, reference axes
    std::vector<Vec3> shape;  ///< of the attached point, per mode, reference axes
    AnchorState state;
    Vec3 arm;  ///< m, from the centre of gravity, at the last find
    AnchorForce now;
  };

  BodyAnchors(const Model& model, int body);
  /// State::anchors holds from here on.
  void remember(std::span<const AnchorState> all);
  /// Forces at the pose of `s`.
  void find(const BodyState& s);

  bool any() const;     ///< in place
  Vec3 force() const;   ///< N
  Vec3 moment() const;  ///< N m, about the centre of gravity
  double energy() const;
  /// Adds what they do to the modes, N/sqrt(kg).
  void modal_loads(const BodyState& s, int modes, Amplitudes& load) const;
  /// At the pose `s` that find had: adds derivatives by the velocity along which the place changes `gamma_dt`
  /// times as much, s.
  void add_slope(const BodyState& s, double gamma_dt, ContactSlope& slope) const;
  /// Adds -d(force)/d(place) to the stiffness of the body's six unknowns and its modes.
  void add_stiffness(const BodyState& s, int modes, Eigen::MatrixXd& stiffness) const;
  /// Of those in place as stiff in all directions.
  double greatest_stiffness() const;  ///< N/m, their sum
  double stiffest() const;            ///< 1/s^2: no squared frequency of the body on them is greater
  std::uint64_t hash() const;         ///< of which are in place
  const std::vector<Tie>& ties() const { return ties_; }

 private:
  const Anchor& anchor(const Tie& tie) const { return model_.anchors[tie.index]; }

  const Model& model_;
  double mass_, inverse_moment_;
  std::vector<Tie> ties_;
};

}  // namespace topple
