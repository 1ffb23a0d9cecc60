// Frames that may touch each other and rigid bodies, or one alone.
#pragma once

#include <optional>

#include "solver/body/part.h"
#include "solver/frame/body_system.h"

namespace topple {

/// Whether a body that is a frame takes explicit substeps where these cost less: in a run with automatic
/// steps one that `auto` made a frame. Where an integrator is named no body is automatic.
bool may_take_substeps(const Model& model, const Parameters& parameters, int body);

/// Longest substep of central differences, s, and what it was found for.
struct StableSubstep {
  ContactLaw law;
  double damping, step;
};

/// One system (islands.h).
class FramePart final : public Part {
 public:
  /// `system` and `sections`, of every element of the model, outlive this.
  FramePart(BodySystem& system, std::vector<SectionForces>& sections)
      : system_(system), sections_(sections) {}

  bool has(const std::vector<char>& marked) const override;
  StepStatus settle(const Parameters& parameters, State& state, PartScratch& scratch) override;
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, const std::vector<char>& marked,
                     State& state) override;
  BodyEnergy energy(const StepInputs& now, const State& state) override;
  void advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) override;
  double time_limit(const Parameters& parameters, const State& state) override;
  double explicit_reach(const Parameters& parameters) override;
  void list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                   Forces& forces) override;
  HardestContact hardest_contact(const HardestContact& hardest) override;

 private:
  void find_contacts(const StepInputs& now, const State& state);
  StepStatus advance_in_substeps(const StepSpan& span, State& next, IntegratorScratch& w, StepEnergy& energy);

  BodySystem& system_;
  std::vector<SectionForces>& sections_;
  BodyMotion motion_;
  Contacts contacts_;
  std::optional<StableSubstep> substep_;
};

}  // namespace topple
