// What each body is computed as, from step to step (model_level.h).
#pragma once

#include <vector>

#include "solver/body/model_level.h"
#include "solver/body/parts.h"

namespace topple {

/// Chooses the level of each body and converts its state when that changes.
class ModelSwitch {
 public:
  explicit ModelSwitch(const Model& model);
  /// Call when the parameters changed.
  void forget() {
    base_.clear();
    rigid_error_.clear();
    watched_.clear();
  }
  /// Every body on its base level, or a frame where one is near. No energy is booked: the run begins here.
  void start(const Model& model, const Parameters& parameters, State& state, Parts& parts);
  /// Of a step from `now` to `end`. Finds the contacts of rigid and elastic bodies, then changes the levels
  /// of bodies that need it and books EnergyLedger::model_switch. True: a body became a frame or is one no
  /// longer.
  bool update(const Model& model, const Parameters& parameters, const StepInputs& now, const StepInputs& end,
              State& state, Parts& parts);

  /// Whether an elastic body that becomes a frame before it yields has yielded at `next`, where a step has
  /// led to: then it is one when the step is taken again.
  bool yielded(const Model& model, const State& next, Parts& parts);

 private:
  struct Switching;
  struct Estimate {
    double error;        // as Parameters::accuracy; infinite: not known
    LevelReason reason;  // for a frame, where that is not allowed
  };

  double error_estimate(const Model& model, const Parameters& parameters, const State& state, Parts& parts,
                        int body) const;
  void find_base(const Model& model, const Parameters& parameters);
  LevelChoice choose(const Switching& on, int body);
  LevelChoice choose_of_block(const Switching& on, int body);
  Estimate elastic_estimate(const Model& model, const Parameters& parameters, const BodyState& s,
                            const ReducedBody& elastic, int body) const;
  bool may_descend_to(const Switching& on, ModelLevel level, int body, double strain) const;
  void begin_block(const Switching& on, int body);
  void find_near(const std::vector<Island>& islands);
  void find_meetings(const std::vector<Island>& islands, const Switching& on);
  void choose_islands(const std::vector<Island>& islands, const Parameters& parameters, State& state);
  void change(const Switching& on, LevelChoice choice, int body);

  std::vector<LevelChoice> base_;    // per body; empty: not found for these parameters
  std::vector<double> rigid_error_;  // per body, likewise
  std::vector<char> watched_;        // per body, likewise: it becomes a frame before it yields
  std::vector<char> yields_;         // per body: in the step that is taken again
  std::vector<LevelChoice> choice_;  // per body
  std::vector<char> changed_;        // per body: its level, since the last step
  std::vector<char> near_;           // per body: another may touch it
  std::vector<char> near_yield_;     // per body: likewise, and one of those that may is watched_
  std::vector<double> meets_;        // per body: m/s, at which another soon strikes it; 0: none does
};

}  // namespace topple
