// Rigid and elastic bodies of which each is near another or tied to it, or near a floor or wall of members.
// Rigid ones alone are advanced by impulses where the step allows it (rigid_island.h), else those that meet
// take implicit substeps together (coupled_bodies.h).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/body/reduced_part.h"
#include "solver/reduced/coupled_bodies.h"
#include "solver/reduced/rigid_island.h"
#include "solver/state/member_sticks.h"

namespace topple {

/// Bodies that candidate pairs or anchors connect. Those that may touch another within a step, or are tied to
/// it, are advanced together, the others each alone.
class IslandPart final : public ReducedPart {
 public:
  /// The bodies and `model` outlive this. `candidate_pairs` and `states`: as MemberCoupling's.
  IslandPart(const Model& model, std::vector<ModelBody> bodies, std::span<const ElementPair> candidate_pairs,
             std::span<const BodyState> states);

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
  MemberSticks& sticks() { return sticks_; }

 private:
  // Of a step, to take it again.
  struct Start {
    std::vector<BodyState> bodies;
    std::vector<Vec3> stick;     // those of the bodies, one after the other
    std::vector<Vec3> position;  // of the nodes
    std::vector<double> gap;     // m, per pair
    std::vector<char> close;     // per pair: it may close
  };

  void place(const State& state);
  void start_pairs(const State& state);
  void find(const StepInputs& now, const State& state);
  void begin(const StepSpan& span, const State& next);
  void begin_again(State& next) const;
  void advance_by_impulses(const StepSpan& span, State& next, PartOutcome& outcome);
  void advance_by_substeps(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome);
  void advance_once(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome);
  bool missed(const State& next);
  CoupledBodies& coupled(std::vector<int> which);
  template <class AnyState, class F>
  void each_stick(AnyState& state, F f) const;

  const Model& model_;
  MemberCoupling coupling_;
  MemberSticks sticks_;
  RigidIsland rigid_;
  std::vector<std::unique_ptr<CoupledBodies>> coupled_;  // sets that were advanced together
  Start start_;
  MemberContacts found_;                 // of the newest step or balance,
  const MemberContacts* now_ = &found_;  // or those of rigid_
  struct Times {
    double start, end;  // s
  };
  std::optional<Times> impulses_;  // of the newest step, whose end's contacts are those known
};

}  // namespace topple
