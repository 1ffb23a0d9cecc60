// A body of few unknowns, rigid or elastic, on planes.
//
//   x_i = X + R (r_i + shape_i q),  u = (V, omega, dq/dt),  M = (m, R J R^T, 1)
//
// Inertia is that of the undeformed body. A step is taken in substeps, by one of two methods:
//
// Explicit, for modes and soft contacts, in substeps that are stable: half an impulse of what acts at the
// start, free motion (exact for X and q; R keeps the angular momentum and is of second order), half an
// impulse of what acts at the end, with contacts taken at the velocity that they leave:
//   u1 = u_free + (h/2) M^-1 (G1 + sum_c J_c^T f_c(x1, J_c u1))
// Damped modes lose exp(-2 zeta w h) of their rate at the start of a substep, so that what is at rest stays
// so and an amplitude decays by exp(-zeta w h).
//
// Implicit, for a rigid body on contacts that would make those substeps short: two stages of second order
// that damp what is too fast for the substep (SDIRK2, gamma = 1 - 1/sqrt 2; Alexander 1977), on the rotation
// vector from the start of the substep. The local error of the velocity, from the forces at the three
// instants, decides how long a substep may be; the substep of it that is fast vibration of stick springs does
// not count, since no result depends on it. A substep ends where a point is about to touch.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/body/body_anchors.h"
#include "solver/body/body_contacts.h"
#include "solver/body/elastic_basis.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// What all bodies share at an instant of a step.
struct StepInputs {
  double time;
  PreparedLaw law;
  Vec3 floor;  ///< m/s^2, acceleration
  StepInputs(const Parameters& parameters, double t);
  /// After `before`, an instant of the same parameters.
  StepInputs(const Parameters& parameters, double t, const StepInputs& before);
};

/// Scratch of a step, for one body after the other: Newton's matrix or its factors, a right side, and the
/// ends of a substep. Factors serve the substeps of one step, no longer: a run that goes on from a state
/// starts without.
struct ReducedScratch {
  ModeMatrix matrix;
  double substep = 0;          ///< s, of which the factors are; 0: none
  std::uint64_t touching = 0;  ///< what touched
  double side[6 + k_modes];
  std::optional<StepInputs> from, to;
  std::vector<BodyContacts::TouchBuffer> buffers;
};

/// Constants of one body, and its contacts.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// State::anchors hold from here on.
  void remember(std::span<const AnchorState> anchors) { anchors_.remember(anchors); }
  /// Contacts of `s` with the springs `stick` (State::stick).
  void find_contacts(const StepInputs& now, const BodyState& s, std::span<const Vec3> stick);
  /// What the body holds with the contacts found last.
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;
  /// Contacts anew, and all that acts on the body into `s`; returns what it holds.
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Advances `s` and `stick` from `start`, whose contacts were found last, to `end`, h later. `energy` is
  /// added to. newton_diverged: the contacts have no converged forces; not_accurate; `s` is then undefined.
  StepStatus::Kind advance(const Parameters& parameters, const StepInputs& start, const StepInputs& end,
                           double h, BodyState& s, std::span<Vec3> stick, StepEnergy& energy,
                           ReducedScratch& scratch);
  /// Rest under gravity on planes; false: none was found, or it tips over by itself.
  bool settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick);
  /// As look_ahead of step_control.h; for a stiff rigid body the length of its next substep. Contacts of `s`
  /// have been found.
  double look_ahead(const ContactLaw& law, const BodyState& s) const;

  /// Index into the model of the node of a contact point.
  int node_of(int point) const { return model_.contact_points[point].node; }
  /// Appends the contacts found last.
  void list_contacts(std::vector<ContactForce>& forces) const;
  /// Section forces of the body's elements at `s` under the contacts found last, into those of the model;
  /// zero on the level rigid.
  void section_forces(const BodyState& s, std::vector<SectionForces>& sections);
  /// Adds the displacements and rotations of all nodes that the contacts found last add to the modes'.
  void add_residual(const BodyState& s, State& state) const;
  /// Not below the greatest sqrt(f + 1) of any section.
  double yield_bound(const BodyState& s) const;
  /// Not below the greatest rotation of a node relative to the body, rad.
  double rotation_bound(const BodyState& s) const;

 private:
  /// Where the unknowns of a stage are counted from: m, rad, N s, N m s.
  struct Origin {
    PackVec3 position, turn, momentum, spin;
  };
  struct Stage {
    BodyVelocity u;
    PackVec3 turning;                      // rad/s, of the rotation vector
    PackVec3 spin;                         // N m s, angular momentum
    double damping_power, friction_power;  // W
  };
  struct ImplicitSubstep;
  struct ExplicitSubstep;
  /// How a substep went: unless its end is reached, nothing is changed.
  enum class SubstepEnd { reached, too_long, unsolved };
  struct ExplicitOutcome {
    SubstepEnd end;
    double stable;  // s, of substeps
  };
  struct ImplicitOutcome {
    SubstepEnd end;
    double error;  // over what is allowed
  };
  /// Half an impulse of contacts on a body that moves at `free` without it.
  struct ContactImpulse {
    const PreparedLaw& law;
    const PackMat3& r;  // rotation matrix
    double h;
    const BodyVelocity& free;
    int modes;
  };
  class RestOnPlanes;

  int modes(const BodyState& s) const { return s.level == ModelLevel::elastic ? basis_->modes : 0; }
  PackMat3 inertia_at(const PackMat3& r) const { return r * inertia_ * transposed(r); }
  Vec3 angular_acceleration(const BodyState& s) const;
  template <ContactSums sums>
  ContactLoads respond_at(const PreparedLaw& law, const BodyState& s);
  bool known(const StepInputs& now, const BodyState& s) const;
  template <class F>
  void each_force(const BodyState& s, F f) const;

  bool solve_velocity(const Parameters& parameters, const ContactImpulse& impulse, BodyVelocity& u,
                      ContactLoads& loads, Amplitudes& load, ReducedScratch& w);
  bool insert_velocity(const ContactImpulse& impulse, double error, BodyVelocity& u, ContactLoads& loads,
                       Amplitudes& load);
  bool correct_velocity(const ContactImpulse& impulse, BodyVelocity& u, ContactLoads& loads, Amplitudes& load,
                        ReducedScratch& w);
  void factor_with_modes(const ContactImpulse& impulse, const PackMat3& inertia, ReducedScratch& w) const;
  ExplicitSubstep move_freely(const Parameters& parameters, const StepInputs& start, const StepInputs& end,
                              double h, BodyState& s);
  bool push_at_end(const Parameters& parameters, const ExplicitSubstep& substep, BodyState& s,
                   ReducedScratch& w);
  void book_swing(const Parameters& parameters, const ExplicitSubstep& substep, const BodyState& s,
                  StepEnergy& energy) const;
  ExplicitOutcome explicit_substep(const Parameters& parameters, const StepInputs& start,
                                   const StepInputs& end, double h, BodyState& s, std::span<Vec3> stick,
                                   StepEnergy& energy, ReducedScratch& w);
  void find_swing(double h, double damping);
  Vec3 drift(double h, BodyState& s) const;
  double stable_part(const Parameters& parameters, const ContactLaw& law, const BodyState& s);
  double find_stable_part(const ContactLaw& law, const BodyState& s, double swing) const;

  StepStatus::Kind advance_stiffly(const Parameters& parameters, const StepInputs& start,
                                   const StepInputs& end, double h, BodyState& s, std::span<Vec3> stick,
                                   StepEnergy& energy);
  ContactLoads reach_stage(const ImplicitSubstep& substep, const PreparedLaw& law, const Origin& from,
                           bool with_slope, BodyState& at, Stage& stage, PackMat3& r);
  bool solve_stage(ImplicitSubstep& substep, const StepInputs& now, const PackVec3& field, const Origin& from,
                   BodyState& at, Stage& stage);
  ImplicitOutcome implicit_substep(const Parameters& parameters, const StepInputs& start,
                                   const StepInputs& end, double h, double allowed, BodyState& s,
                                   std::span<Vec3> stick, StepEnergy& energy);
  double next_landing(const BodyState& s, double within) const;
  double first_part(const ContactLaw& law) const;

  const Model& model_;
  const int body_;
  const double mass_, reach_;
  const PackMat3 inertia_, inverse_inertia_;  // material axes
  std::shared_ptr<const ElasticBasis> basis_;
  BodyContacts contacts_;
  BodyAnchors anchors_;
  // What contacts_ was pressed for.
  struct Found {
    ModelLevel level;
    Quat rotation;
    Vec3 position, velocity, angular_velocity;
    ContactLaw law;
    Amplitudes amplitude, rate;  // of an elastic body
  };
  std::optional<Found> found_;
  Eigen::VectorXd section_;
  // Swing of the modes over a step of this size: cosine, sine over frequency, less frequency times sine, and
  // tan(x)/x of half the angle, by which impulses count so that a constant load leaves its static deflection;
  // and what damping leaves of the rates.
  double free_step_ = 0, free_damping_ = 0;
  Amplitudes cosine_, sine_, back_, kick_, damped_;
  // Stable substeps by what touches.
  struct Known {
    std::uint64_t touching;
    double alpha, q;
    ContactLawKind kind;
    ModelLevel level;
    double step;
  };
  std::array<Known, 8> known_{};
  int next_known_ = 0;
};

}  // namespace topple
