// A body of few unknowns, rigid or elastic, on planes.
//
//   x_i = X + R (r_i + shape_i q),  u = (V, omega, dq/dt),  M = (m, R J R^T, 1)
//
// Inertia is that of the undeformed body. A step is taken in parts, by one of two methods:
//
// Swinging, for modes and soft contacts, in parts that are stable: half an impulse of what acts at the start,
// free motion (exact for X and q; R keeps the angular momentum and is of second order), half an impulse of
// what acts at the end, with contacts taken at the velocity that they leave:
//   u1 = u_free + (h/2) M^-1 (G1 + sum_c J_c^T f_c(x1, J_c u1))
// Damped modes lose exp(-2 zeta w h) of their rate at the start of a part, so that what is at rest stays so
// and an amplitude decays by exp(-zeta w h).
//
// Stiff, for a rigid body on contacts that would make those parts short: two implicit stages of second order
// that damp what is too fast for the part (SDIRK2, gamma = 1 - 1/sqrt 2; Alexander 1977), on the rotation
// vector from the start of the part. The local error of the velocity, from the forces at the three instants,
// decides how long a part may be, that of stick springs aside: nothing asks how they shiver. A part ends
// where a point is about to touch.
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

/// What all bodies share at one instant.
struct Instant {
  double time;
  PreparedLaw law;
  Vec3 floor;  ///< m/s^2, acceleration
  Instant(const Parameters& parameters, double t);
  /// After `before`, an instant of the same parameters.
  Instant(const Parameters& parameters, double t, const Instant& before);
};

/// Scratch of a step, for one body after the other: Newton's matrix or its factors, a right side, and the
/// ends of a part. Factors serve the parts of one step, no longer: a run that goes on from a state starts
/// without.
struct ReducedScratch {
  ModeMatrix matrix;
  double part = 0;             ///< s, of which the factors are; 0: none
  std::uint64_t touching = 0;  ///< what touched
  double side[6 + k_modes];
  std::optional<Instant> from, to;
  std::vector<BodyContacts::Room> rooms;
};

/// Constants of one body, and its contacts.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// State::anchors hold from here on.
  void remember(std::span<const AnchorState> anchors) { anchors_.remember(anchors); }
  /// Contacts of `s` with the springs `stick` (State::stick).
  void find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick);
  /// What the body holds with the contacts found last.
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;
  /// Contacts anew, and all that acts on the body into `s`; returns what it holds.
  BodyEnergy balance(const Parameters& parameters, const Instant& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Advances `s` and `stick` from `start`, whose contacts were found last, to `end`, h later. `energy` is
  /// added to. newton_diverged: the contacts have no converged forces; not_accurate; `s` is then undefined.
  StepStatus::Kind advance(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                           BodyState& s, std::span<Vec3> stick, StepEnergy& energy, ReducedScratch& scratch);
  /// Rest under gravity on planes; false: none was found, or it tips over by itself.
  bool settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick);
  /// As look_ahead of step_control.h; for a stiff rigid body the length of its next part. Contacts of `s`
  /// have been found.
  double look_ahead(const ContactLaw& law, const BodyState& s) const;

  /// Index into the model of the node of a contact point.
  int node_of(int point) const { return model_.contact_points[point].node; }
  /// Appends the contacts found last.
  void list_contacts(std::vector<ContactForce>& forces) const;
  /// Section forces of the body's elements at `s` under the contacts found last, into those of the model;
  /// zero on the rung rigid.
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
    PackVec3 turning;       // rad/s, of the rotation vector
    PackVec3 spin;          // N m s, angular momentum
    double damped, rubbed;  // W
  };
  struct StiffPart;

  int modes(const BodyState& s) const { return s.rung == Rung::elastic ? basis_->modes : 0; }
  PackMat3 inertia_at(const PackMat3& r) const { return r * inertia_ * transposed(r); }
  Vec3 angular_acceleration(const BodyState& s) const;
  template <ContactSums sums>
  ContactLoads respond_at(const PreparedLaw& law, const BodyState& s);
  bool known(const Instant& now, const BodyState& s) const;
  template <class F>
  void each_force(const BodyState& s, F f) const;

  bool solve_velocity(const Parameters& parameters, const PreparedLaw& law, const PackMat3& r, double h,
                      const BodyVelocity& free, BodyVelocity& u, ContactLoads& loads, Amplitudes& load,
                      int modes, ReducedScratch& w);
  bool swing_part(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                  BodyState& s, std::span<Vec3> stick, StepEnergy& energy, ReducedScratch& w, double& stable);
  void find_swing(double h, double damping);
  Vec3 drift(double h, BodyState& s) const;
  double stable_part(const Parameters& parameters, const ContactLaw& law, const BodyState& s);
  double find_stable_part(const ContactLaw& law, const BodyState& s, double swing) const;

  StepStatus::Kind advance_stiffly(const Parameters& parameters, const Instant& start, const Instant& end,
                                   double h, BodyState& s, std::span<Vec3> stick, StepEnergy& energy);
  ContactLoads reach_stage(const StiffPart& part, const PreparedLaw& law, const Origin& from, bool with_slope,
                           BodyState& at, Stage& stage, PackMat3& r);
  bool solve_stage(StiffPart& part, const Instant& now, const PackVec3& field, const Origin& from,
                   BodyState& at, Stage& stage);
  bool stiff_part(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                  double allowed, BodyState& s, std::span<Vec3> stick, StepEnergy& energy, double& error);
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
    Rung rung;
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
  double swing_step_ = 0, swing_damping_ = 0;
  Amplitudes cosine_, sine_, back_, kick_, damped_;
  // Stable parts by what touches.
  struct Known {
    std::uint64_t touching;
    double alpha, q;
    ContactLawKind kind;
    Rung rung;
    double step;
  };
  std::array<Known, 8> known_{};
  int next_known_ = 0;
};

}  // namespace topple
