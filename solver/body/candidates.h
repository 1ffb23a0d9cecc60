// Candidate pairs: parts of different bodies that may come to touch. They are searched for with a margin, and
// again when it is used up: when surfaces of two bodies may have come closer by that much.
#pragma once

#include <vector>

#include "solver/contact/proximity.h"
#include "solver/model/model.h"
#include "solver/reduced/rigid_motion.h"
#include "solver/state/state.h"

namespace topple {

/// How much closer surfaces of two bodies come, where they do not stay `margin` apart, m; keeps its memory
/// from one step to the next.
class Approach {
 public:
  /// Most of it that is likely within h, s, as nodes and bodies move and are accelerated at `state`. The
  /// margin is State::candidate_margin.
  double likely(const Model& model, const State& state, double h);
  /// A bound of it from one state to the other, of rigid and elastic bodies without deformation.
  double greatest(const Model& model, const State& from, const State& to, double margin);

 private:
  // A body that moves as a rigid one and by `more` besides.
  struct Motion {
    RigidMotion rigid;
    double half_width;             // m
    double more = 0;               // m
    double way = 0, radius = 0;    // m; of `rigid`, and of a sphere in which its surfaces stay
    Eigen::AlignedBox3d box = {};  // of its nodes at the start, when it is asked for

    double first() const { return rigid.centre.x() - radius; }
  };
  void start(const Model& model, const State& state);
  double greatest(const Model& model, const State& state, double margin);
  const Eigen::AlignedBox3d& box(const Model& model, const State& state, int body);

  std::vector<Motion> motions_;  // per body
  std::vector<int> order_;       // bodies by Motion::first
};

/// Searches again unless State::candidate_margin is above `approach`, m.
void update_candidates(const Model& model, NearSearch& search, State& state, double approach);

}  // namespace topple
