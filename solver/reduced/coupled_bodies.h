// Rigid and elastic bodies that touch each other, or may within a step, in implicit substeps that they take
// together (method: reduced_body.h).
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "solver/math/block_lu.h"
#include "solver/reduced/implicit_substep.h"
#include "solver/reduced/member_coupling.h"

namespace topple {

/// One set of bodies, from step to step.
class CoupledBodies {
 public:
  /// Those of `all`, the bodies of `coupling`, with these numbers. They and `coupling` outlive this.
  CoupledBodies(std::span<const ModelBody> all, std::vector<int> which, MemberCoupling& coupling);
  const std::vector<int>& which() const { return which_; }

  /// As ReducedBody::advance, for all of them. `pairs`: what may touch between them, with its stick springs
  /// at the start.
  StepStatus::Kind advance(const StepSpan& span, std::vector<MemberPair> pairs, State& next,
                           StepEnergy& booked);
  /// Between members at the end; pairs as numbered in those of advance.
  const MemberContacts& contacts() const { return now_; }

 private:
  friend struct AllTogether;
  double first(const ContactLaw& law) const;
  double next_kink(double within);
  ImplicitOutcome substep(const SubstepSpan& span);
  void find(const ContactLaw& law);
  void shape_matrices();
  void correct(std::span<const double> corrections, double part);
  bool solve_stage(const SubstepSpan& span, const PreparedLaw& law, StageNewton& newton);
  void factor(const SubstepSpan& span, const ContactLaw& law);
  ContactPower power() const;
  void book(const SubstepSpan& span, const std::array<ContactPower, 3>& powers);  // from the start on
  template <class F>
  void each_body(F f);

  const std::vector<int> which_;
  std::vector<ModelBody> bodies_;  // in that order
  MemberCoupling& coupling_;
  std::vector<int> place_;                                       // per body of the coupling, here; -1: none
  std::vector<std::vector<BodyContacts::TouchBuffer>> buffers_;  // per body
  std::vector<std::optional<ImplicitSubstep>> substeps_;         // per body
  std::vector<MemberPair> pairs_;
  MemberContacts start_, now_;
  std::vector<Vec3> start_position_;  // per node of the coupling
  // of the step
  State* next_ = nullptr;
  StepEnergy* booked_ = nullptr;
  // Newton's matrix, and that of stick springs and modes alone: a row of blocks per group of unknowns
  std::vector<int> row_;                      // per body, its first one; and their number
  std::vector<std::pair<int, int>> coupled_;  // rows that the matrices couple
  BlockLu matrix_, sticks_;
  std::vector<double> side_, correction_;
};

}  // namespace topple
