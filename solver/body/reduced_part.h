// Some rigid and elastic bodies, none of which is near another.
#pragma once

#include <utility>
#include <vector>

#include "solver/body/part.h"

namespace topple {

/// Bodies that ReducedBody advances one after the other.
class ReducedPart : public Part {
 public:
  /// The bodies outlive this.
  explicit ReducedPart(std::vector<ModelBody> bodies) : bodies_(std::move(bodies)) {}

  bool has(const std::vector<char>& marked) const override;
  StepStatus settle(const Parameters& parameters, State& state, PartScratch& scratch) override;
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, const std::vector<char>& marked,
                     State& state) override;
  BodyEnergy energy(const StepInputs& now, const State& state) override;
  void advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) override;
  double time_limit(const Parameters& parameters, const State& state) override;
  void find_forces(const StepInputs& now, const State& state, bool with_members) override;
  void list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                   Forces& forces) override;
  HardestContact hardest_contact(const HardestContact& hardest) override;

 protected:
  const std::vector<ModelBody> bodies_;
};

}  // namespace topple
