// What each body is computed as, from step to step (model_level.h).
#pragma once

#include <vector>

#include "solver/body/model_level.h"
#include "solver/body/parts.h"

namespace topple {

class ModelSwitch {
 public:
  explicit ModelSwitch(const Model& model);
  /// The parameters changed.
  void forget() { base_.clear(); }
  /// Every body on its base, or a frame where another is near. Nothing is booked: the run begins here.
  void start(const Model& model, const Parameters& parameters, State& state, Parts& parts);
  /// Contacts of what is not a frame, then the models with which `state` goes on. True: a body became a frame
  /// or is one no longer.
  bool update(const Model& model, const Parameters& parameters, const StepInputs& now, State& state,
              Parts& parts);

 private:
  struct Switching;

  void find_base(const Model& model, const Parameters& parameters);
  void find_near(const Model& model, const State& state);
  LevelChoice choose(const Switching& on, int body);
  void change(const Switching& on, LevelChoice choice, int body);

  std::vector<LevelChoice> base_;  // per body; empty: not found for these parameters
  std::vector<char> near_;         // per body: another is
  std::vector<char> new_frames_;   // per body: since the last step
  BodyMotion motion_;
};

}  // namespace topple
