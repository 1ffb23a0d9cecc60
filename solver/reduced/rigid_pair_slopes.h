// How the forces of two rigid bodies that touch each other between members change as the bodies move: four
// touches at a time, added up before they are handed on.
#pragma once

#include <array>
#include <span>

#include "solver/contact/member_contact.h"
#include "solver/math/pack.h"

namespace topple {

/// A 6 x 6 block per lane: [linear; angular] by the linear and the angular motion.
struct PackBlock {
  PackMatrix<Four> part[2][2];
};

/// Sums over what touches between two rigid bodies: begin, add, end; then they are read.
class RigidPairSlopes {
 public:
  /// `position` and `arm`, m, per node: arms from the centres of gravity. velocity_factor: see PairTangent.
  /// They outlive this.
  RigidPairSlopes(const ContactLaw& law, std::span<const Vec3> position, std::span<const Vec3> arm,
                  double velocity_factor);

  /// Sums of two bodies begin.
  void begin();
  void add(const MemberTouch& touch, const MemberPair& pair);
  void add_blend(const PairTangent& blend, const MemberPair& pair);
  /// To be called before the sums are read.
  void end();

  /// J_i^T t J_j of the sum of their tangents t, for the bodies i and j of the pairs, 0 or 1; of stick
  /// springs alone.
  Mat6 block(int i, int j) const { return sum(blocks_, i, j); }
  Mat6 of_stick(int i, int j) const { return any_sticks_ ? sum(sticks_, i, j) : Mat6::Zero(); }

 private:
  using Points = PackVector<Four>;
  using Blocks = std::array<std::array<PackBlock, 2>, 2>;
  struct Slopes {
    PackMatrix<Four> local, stick;  // N/m
    bool any_sticks;
  };
  // A motion of both bodies: m, m^2
  struct Motion {
    Points linear[2], angular[2];
  };
  static Mat6 sum(const Blocks& blocks, int i, int j);
  static void add_carried(const PackMatrix<Four>& slope, const Points (&arm)[2], Blocks& to);
  static void add_product(const Motion& left, const Motion& right, Blocks& to);
  void add_four();
  Slopes slopes(const Points& normal, const Four& L) const;

  const ContactLaw& law_;
  const std::span<const Vec3> position_, arm_;
  const double scale_, gamma_dt_, loss_;  // 1/s, s
  const bool with_velocity_, in_packs_;
  std::array<const MemberTouch*, 4> touch_;
  std::array<const MemberPair*, 4> pair_;
  int count_ = 0;
  Blocks blocks_, sticks_;
  bool any_sticks_ = false;
};

}  // namespace topple
