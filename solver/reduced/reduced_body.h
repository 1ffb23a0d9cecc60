// A body of few unknowns (reduced model), rigid or elastic, on planes.
//
//   x_i = X + R (r_i + shape_i q),  u = (V, omega, dq/dt),  M = diag(m, R J R^T, 1)
//
// X: centre of gravity, q: modal amplitudes (ElasticBasis). Inertia is that of the undeformed body. A step is
// taken in substeps, by one of two methods:
//
// Explicit, for modes and soft contacts, in substeps that are stable: half an impulse of what acts at the
// start, free motion (exact for X and q; R keeps the angular momentum and is of second order), half an
// impulse of what acts at the end, with contacts taken at the velocity that they leave:
//   u1 = u_free + (h/2) M^-1 (G1 + sum_c J_c^T f_c(x1, J_c u1)),  G1: gravity, floor and anchors
// Rates of damped modes are multiplied by exp(-2 zeta w h) at the start of a substep: so what is at rest
// stays at rest, and an amplitude decays as exp(-zeta w t).
//
// Implicit, for a rigid body on contacts that would make those substeps short: a stage by the trapezoidal
// rule and one by backward differences, of second order together, that damp what is too fast for the substep
// (TR-BDF2, gamma = 1 - 1/sqrt 2; Bank et al. 1985), on the rotation vector from the start of the substep.
// Both stages are of second order by themselves: a body that turns about a stiff contact strains it by the
// third power of the substep. The local error of the velocity, from the forces at the three instants, decides
// how long a substep may be. It is filtered by (M - gamma h S)^-1 M with S the slope of the stick springs:
// their fast vibration does not count, since no result depends on it. A substep ends where a point is about
// to touch.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/frame/step_span.h"
#include "solver/reduced/body_anchors.h"
#include "solver/reduced/body_contacts.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/state/energy.h"
#include "solver/state/step_result.h"

namespace topple {

/// Scratch of a step, for one body after the other: factors of Newton's matrix, a right side, and the ends of
/// a substep. Factors serve the substeps of one step, no longer: a run that goes on from a state has none,
/// and must give the same bits.
struct ReducedScratch {
  ModeMatrix matrix;
  double substep = 0;          ///< s, size that the factors are for; 0: there are none
  std::uint64_t touching = 0;  ///< BodyContacts::hash() that they are for
  double side[6 + k_modes];
  std::optional<StepInputs> from, to;
  std::vector<BodyContacts::TouchBuffer> buffers;
};

inline constexpr double k_blow_ahead = 0.015;  ///< s before a blow, more than a step

/// How a substep went: unless its end is reached, nothing is changed.
enum class SubstepEnd { reached, too_long, unsolved };

/// One body: its constants, and its contacts and anchors as found last.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// State::anchors hold from here on.
  void remember(std::span<const AnchorState> anchors) { anchors_.remember(anchors); }
  /// These pulls, of all bodies, act from here on.
  void take(std::span<const PulledNode> pulls) { anchors_.take(pulls); }
  /// Contacts of `s` with the springs `stick` (State::stick).
  void find_contacts(const StepInputs& now, const BodyState& s, std::span<const Vec3> stick);
  /// Energies of the body with the contacts found last, J.
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;
  /// Finds the contacts, sets force, moment and load of `s`; returns the energies.
  BodyEnergy balance(const Parameters& parameters, const StepInputs& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Advances `s` and `stick` from `start`, whose contacts were found last, to `end`, h (s) later; adds to
  /// `energy`. newton_diverged: contact forces did not converge; not_accurate: no substep is short enough for
  /// the tolerance; `s` is then undefined.
  StepStatus::Kind advance(const Parameters& parameters, const StepInputs& start, const StepInputs& end,
                           double h, BodyState& s, std::span<Vec3> stick, StepEnergy& energy,
                           ReducedScratch& scratch);
  /// Longest step that resolves contacts and turning, s. Elastic: BodyContacts::look_ahead. Rigid:
  /// BodyState::substep while it touches, and next_kink(). Contacts of `s` have been found.
  double look_ahead(const Parameters& parameters, const ContactLaw& law, const BodyState& s) const;

  /// s: the time until an open point reaches a plane, infinite when that is not within `within`; until that
  /// or until one that slips comes to rest; a first guess at an implicit substep that follows a touch.
  /// Contacts of `s` have been found.
  double next_landing(const BodyState& s, double within) const;
  double next_kink(const BodyState& s, double within) const;
  double first_substep(const ContactLaw& law) const;
  BodyContacts& contacts() { return contacts_; }
  const BodyContacts& contacts() const { return contacts_; }
  double mass() const { return mass_; }                 ///< kg
  double reach() const { return reach_; }               ///< m
  const PackMat3& inertia() const { return inertia_; }  ///< kg m^2, material axes
  const PackMat3& inverse_inertia() const { return inverse_inertia_; }
  double least_inertia() const { return least_inertia_; }  ///< kg m^2, about any axis
  PackMat3 inertia_at(const PackMat3& r) const { return r * inertia_ * transposed(r); }  ///< floor's axes
  /// Neither an anchor nor a pull holds it.
  bool is_free() const { return !anchors_.any(); }

  /// Free motion for h, s; returns the turn, a rotation vector in material axes.
  Vec3 drift(double h, BodyState& s) const;
  /// At the end `s` of a substep from `before` its contacts, with springs that were `stick`, are found, as
  /// those at its start were (BodyContacts::ScratchLease).
  void find_contacts_after(const BodyState& before, const PreparedLaw& law, const BodyState& s,
                           std::span<const Vec3> stick);
  /// Then springs that slipped are shorter in `stick`, and forces of `s` are those of the shorter ones, of
  /// anchors as found last and of `field`, m/s^2.
  void finish_substep(const PreparedLaw& law, const Vec3& field, BodyState& s, std::span<Vec3> stick);

  /// Index into the model of the node of a contact point.
  int node_of(int point) const { return model_.contact_points[point].node; }
  /// Other forces than those of contacts with planes and of anchors: between members. N, floor's axes, on
  /// nodes of the model.
  void clear_member_forces() { member_forces_.clear(); }
  void add_member_force(int node, const Vec3& force);
  /// Appends the contacts found last.
  void list_contacts(std::vector<ContactForce>& forces) const;
  /// Section forces of the body's elements at `s`, on a level with stresses, under the forces found last,
  /// into those of the model.
  void section_forces(const BodyState& s, std::vector<SectionForces>& sections);
  /// J, of what the forces found last deflect it statically beyond the modes.
  double residual_strain(const BodyState& s) const;
  /// Adds to the nodes of `state` what the forces found last deflect them statically beyond the modes.
  void add_residual(const BodyState& s, State& state) const;
  /// Whether a contact found last, of a point that is not of the base, has a local spring (body_contacts.h)
  /// softer than itself. `alpha`: N, of Eq. 2. Where a whole side lands, its points are pressed in together,
  /// less than each would be alone: the local springs are then far too soft.
  bool lands_on_what_gives(double alpha) const;
  /// Fastest of its points, m/s, that meet a plane within k_blow_ahead, or met it as shortly before: of its
  /// base, of the others; 0: none does.
  struct Strikes {
    double on_base = 0, aside = 0;
  };
  Strikes strikes_soon(const BodyState& s) const;
  /// Upper bound of the speeds of its points, m/s.
  double speed_bound(const BodyState& s) const;
  /// Estimated error of the stresses that a blow raises, on its base from below or, not `on_base`, anywhere,
  /// as a share of them: 7.5 times the greatest ratio of a contact's stiffness to that of the point which the
  /// modes leave out, times the share of the stress at rest under a force there that they leave out, at most
  /// 1. Measured (assets/guide/models.md).
  double blow_error(const ContactLaw& law, bool on_base) const;
  /// The same of a blow at `speed`, m/s, as a share of the greatest stress so far: what it raises is that at
  /// rest under its force v sqrt(k m). 0 where twice as much beside the present stresses makes no new peak.
  double blow_error(const ContactLaw& law, const BodyState& s, double speed, bool on_base) const;
  /// Tangential springs `stick` of the contacts found last have travelled with the local springs behind them
  /// (body_contacts.h), which a frame has not: to those of a frame that bear the same, and back.
  void scale_sticks_to_frame(std::span<Vec3> stick) const;
  void scale_sticks_from_frame(std::span<Vec3> stick) const;
  /// Upper bounds over all sections under the forces found last: of sqrt(f + 1) (plasticity.h), of
  /// equivalent_stress, Pa.
  double yield_bound(const BodyState& s) const;
  double stress_bound(const BodyState& s) const;
  /// Upper bound of the rotation of a node relative to the body by the modes, rad.
  double rotation_bound(const BodyState& s) const;

 private:
  friend class ImplicitSubstep;
  friend class RestOfBodies;
  struct ExplicitSubstep;
  struct ExplicitOutcome {
    SubstepEnd end;
    double stable;  // s, longest stable substep
  };
  /// What became of an iteration, or of a substep's equations.
  enum class Solution { found, none };
  /// Half a substep's impulse of contacts, (h/2) F(u), on a body that moves at `free` without it.
  struct ContactImpulse {
    const PreparedLaw& law;
    const PackMat3& r;  // rotation matrix
    double h;           // s
    const BodyVelocity& free;
    int modes;
  };

  int modes(const BodyState& s) const { return s.level == ModelLevel::elastic ? basis_->modes : 0; }
  Vec3 angular_acceleration(const BodyState& s) const;
  template <ContactSums sums>
  ContactLoads respond_at(const PreparedLaw& law, const BodyState& s);
  bool known(const StepInputs& now, const BodyState& s) const;
  bool is_quiet(const Parameters& parameters, const BodyState& s) const;
  template <class F>
  void each_force(const BodyState& s, F f) const;
  template <class F>
  void each_stick(F f) const;
  double bound(const BodyState& s, const Eigen::VectorXd& of_modes, const Eigen::VectorXd& of_forces) const;
  void add_motion_of_contacts(const BodyState& s, Eigen::VectorXd& u) const;

  Solution solve_velocity(const Parameters& parameters, const ContactImpulse& impulse, BodyVelocity& u,
                          ContactLoads& loads, Amplitudes& load, ReducedScratch& w);
  Solution iterate_velocity(const ContactImpulse& impulse, double error, BodyVelocity& u, ContactLoads& loads,
                            Amplitudes& load);
  Solution correct_velocity(const ContactImpulse& impulse, BodyVelocity& u, ContactLoads& loads,
                            Amplitudes& load, ReducedScratch& w);
  void factor_with_modes(const ContactImpulse& impulse, const PackMat3& inertia, ReducedScratch& w) const;
  ExplicitSubstep move_freely(const Parameters& parameters, const StepInputs& start, const StepInputs& end,
                              double h, BodyState& s);
  Solution push_at_end(const Parameters& parameters, const ExplicitSubstep& substep, BodyState& s,
                       ReducedScratch& w);
  void book_explicit(const Parameters& parameters, const ExplicitSubstep& substep, const BodyState& s,
                     StepEnergy& energy) const;
  ExplicitOutcome explicit_substep(const Parameters& parameters, const StepInputs& start,
                                   const StepInputs& end, double h, BodyState& s, std::span<Vec3> stick,
                                   StepEnergy& energy, ReducedScratch& w);
  void find_propagator(double h, double damping);
  double stable_substep(const Parameters& parameters, const ContactLaw& law, const BodyState& s);
  double highest_frequency(const ContactLaw& law, const BodyState& s) const;

  StepStatus::Kind advance_implicit(const Parameters& parameters, const StepInputs& start,
                                    const StepInputs& end, double h, BodyState& s, std::span<Vec3> stick,
                                    StepEnergy& energy);
  void fill(double factor, const PackMat3& inertia, const ContactSlope& slope, int modes,
            ModeMatrix& matrix) const;

  const Model& model_;
  const int body_;
  const double mass_, reach_, least_inertia_;
  const PackMat3 inertia_, inverse_inertia_;  // material axes
  // m/N, ElasticBasis::beyond, of points of the base along z, of all
  double base_beyond_ = 0, greatest_beyond_ = 0;
  double base_stress_ = 0, greatest_stress_ = 0;  // Pa/N, ElasticBasis::rest_stress, likewise
  double greatest_shape_ = 0;  // 1/sqrt(kg), norm of the displacements of a point in all modes
  std::shared_ptr<const ElasticBasis> basis_;
  BodyContacts contacts_;
  BodyAnchors anchors_;
  std::vector<Vec3> member_forces_;  // N, floor's axes, per node of the body; empty: none
  // What the forces of contacts_ were evaluated for.
  struct Found {
    ModelLevel level;
    Quat rotation;
    Vec3 position, velocity, angular_velocity;
    ContactLaw law;
    Amplitudes amplitude, rate;  // of an elastic body
  };
  std::optional<Found> found_;
  Eigen::VectorXd section_;
  // Exact free motion of the modes over free_step_, s: cos(w h), sin(w h)/w, -w sin(w h); tan(w h/2)/(w h/2),
  // by which impulses are multiplied so that a constant load leaves its static deflection; exp(-2 zeta w h),
  // factor on the rates by damping, free_damping_ being damping_time().
  double free_step_ = 0, free_damping_ = 0;
  Amplitudes cosine_, sine_, back_, kick_, damped_;
  // Highest frequencies by what touches.
  struct Known {
    std::uint64_t touching;
    double alpha, q;
    ContactLawKind kind;
    ModelLevel level;
    double frequency;
  };
  std::array<Known, 8> known_{};
  int next_known_ = 0;
};

/// A body of a model.
struct ModelBody {
  int index;  ///< into the model
  ReducedBody* body;
};

}  // namespace topple
