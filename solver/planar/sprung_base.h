// The base of a block on its contacts while it is nearly upright. Where points lie between its edges they
// change how it lifts and lands: it leans on them before it stands on an edge alone, and they take a part of
// a landing. For small tilts, without slip and restitution; good to a thousandth of what is returned.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/model/parameters.h"
#include "solver/planar/block.h"

namespace topple::planar {

/// Contact points of a base that lie across the plane of motion: m, from below the centre of gravity, towards
/// +x; indices into the model.
struct BaseLine {
  double place;
  std::vector<int> points;
};

/// Springs of such a line together, over the mass of the block, 1/s^2 times m^(1 - q).
struct SprungLine {
  double place, stiffness;
};

/// Two degrees of freedom, rise and turn, each landing and lift followed anew. It keeps the springs of the
/// block for which it was made, which is to be handed to it.
class SprungBase {
 public:
  /// `base`: from left to right, three lines at least. L: of Eq. 2, m.
  SprungBase(const Block& block, std::span<const BaseLine> base, const ContactLaw& law, double L);

  /// Factor on the rate that Housner's condition leaves a block that lands on this edge, from the other one,
  /// at this rate, rad/s. The slowest landing that is followed is from twice the tilt at which the block
  /// stands on one edge alone; slower ones have its factor. 1 where Housner's condition lets no block rock
  /// on.
  double landing_factor(const Block& block, Side side, double rate) const;
  /// Rate, rad/s, with which a block lifts about this edge, where one on a rigid floor would have none.
  /// `horizontal`: acceleration of the floor at that instant, m/s^2; `growth`: its change, m/s^3, taken as
  /// even since the floor was at rest; where it does not grow it has jumped to what it is. `vertical`:
  /// gravity plus acceleration of the floor.
  double lift_rate(const Block& block, Side side, double horizontal, double growth, double vertical) const;

 private:
  struct View;
  struct Motion;
  struct Slowest {
    double rate, factor;
  };

  View view(const Block& block, Side on) const;
  double depth(const SprungLine& line, double force) const;
  double tilt_alone(const Block& block, const View& on) const;
  static double work(const Block& block, double edge, double tilt);
  bool advance(const Block& block, const View& on, double h, double gravity, double moment,
               const SprungLine& alone, Motion& s) const;
  double follow_landing(const Block& block, const View& on, double rate) const;

  std::vector<SprungLine> lines_;
  double q_, smoothing_;            // index of Eq. 2; m/s, ContactLaw::normal_speed
  std::array<Slowest, 2> slowest_;  // of landings on the left and the right edge
};

}  // namespace topple::planar
