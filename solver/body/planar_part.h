// Bodies on the level planar, each for itself.
#pragma once

#include <utility>
#include <vector>

#include "solver/body/part.h"
#include "solver/body/planar_body.h"

namespace topple {

/// Blocks whose steps PlanarBody has planned.
class PlanarPart final : public Part {
 public:
  struct Member {
    int index;  ///< into the model
    PlanarBody* body;
  };
  /// The bodies outlive it.
  explicit PlanarPart(std::vector<Member> bodies) : bodies_(std::move(bodies)) {}

  bool has(const std::vector<char>& marked) const override;
  StepStatus settle(const Parameters& parameters, State& state, PartScratch& scratch) override;
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, const std::vector<char>& marked,
                     State& state) override;
  BodyEnergy energy(const StepInputs& now, const State& state) override;
  void advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) override;
  double time_limit(const Parameters& parameters, const State& state) override;
  void list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                   Forces& forces) override;
  HardestContact hardest_contact(const HardestContact& hardest) override { return hardest; }

 private:
  const std::vector<Member> bodies_;
};

}  // namespace topple
