// What a step advances on its own: some bodies that touch no body of another part within it.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "solver/frame/generalized_alpha.h"
#include "solver/reduced/reduced_body.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// Scratch of the parts that one worker advances; may be thrown away at any time.
struct PartScratch {
  ReducedScratch reduced;
  IntegratorScratch frame;
};

/// What became of a part in a step.
struct PartOutcome {
  StepEnergy exchanged;
  BodyEnergy held;  ///< at the end; undefined when it failed
  StepStatus status;
};

/// Where the greatest normal contact force acts.
struct HardestContact {
  double force = 0;                        ///< N
  int body = -1, node = -1, element = -1;  ///< indices into the model; -1: none
};

/// Forces between bodies and planes, and between members.
struct Forces {
  std::vector<ContactForce> contacts;
  std::vector<MemberForce> members;
  /// Those of all touches, with what their blends do to the parts.
  void add(const MemberContacts& found, std::span<const MemberPair> pairs);
};

/// Parts of one model share no body: each changes only its own bodies' entries of a State, but for the stick
/// springs between members, which are one list (member_sticks.h).
class Part {
 public:
  virtual ~Part() = default;
  /// Whether one of its bodies is marked; `marked`: one per body of the model.
  virtual bool has(const std::vector<char>& marked) const = 0;
  /// Rest under gravity, as settle() of step.h.
  virtual StepStatus settle(const Parameters& parameters, State& state, PartScratch& scratch) = 0;
  /// Contacts and accelerations from the balance of forces, of its marked bodies and of those they may touch;
  /// returns the energies of these.
  virtual BodyEnergy balance(const Parameters& parameters, const StepInputs& now,
                             const std::vector<char>& marked, State& state) = 0;
  /// Energies of its bodies at `state`.
  virtual BodyEnergy energy(const StepInputs& now, const State& state) = 0;
  /// `next`: the state at the start; becomes that at the end. After a failure the part's bodies are
  /// undefined.
  virtual void advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) = 0;
  /// Longest step that resolves how its bodies touch and turn, s (step_limits.h).
  virtual double time_limit(const Parameters& parameters, const State& state) = 0;
  /// Longest step, s, that its frames take in explicit substeps, which cost less than one implicit step; 0:
  /// they never do. Infinite without frames.
  virtual double explicit_reach(const Parameters&) { return std::numeric_limits<double>::infinity(); }
  /// Finds what acts on its rigid and elastic bodies at `state`; with_members: between members too.
  virtual void find_forces(const StepInputs&, const State&, [[maybe_unused]] bool with_members) {}
  /// Appends its contact forces at `state`.
  virtual void list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                           Forces& forces) = 0;
  /// Of those that list_forces found last, or `hardest` where none of its own is greater.
  virtual HardestContact hardest_contact(const HardestContact& hardest) = 0;
};

}  // namespace topple
