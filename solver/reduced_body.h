// A body of few unknowns, rigid or elastic, on planes.
//
//   x_i = X + R (r_i + shape_i q),  u = (V, omega, dq/dt),  M = (m, R J R^T, 1)
//
// Inertia is that of the undeformed body. The step is symmetric: half an impulse of what acts at its start,
// free motion (exact for X and q; R keeps the angular momentum and is of second order), half an impulse of
// what acts at its end, with contacts taken at the velocity that they leave:
//
//   u1 = u_free + (h/2) M^-1 (G1 + sum_c J_c^T f_c(x1, J_c u1))
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "solver/body_system.h"
#include "solver/elastic_basis.h"
#include "solver/energy.h"
#include "solver/pack.h"
#include "solver/step.h"

namespace topple {

/// What all bodies share at one instant.
struct Instant {
  double time;
  ContactLaw law;
  Vec3 floor;  ///< m/s^2, acceleration
  Instant(const Parameters& parameters, double t);
};

struct ReducedScratch;

/// Constants of one body, and its contacts.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// Contacts of `s` with the springs `stick` (State::stick); returns what the body holds.
  BodyEnergy find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick);
  /// The same, and all that acts on the body into `s`.
  BodyEnergy balance(const Parameters& parameters, const Instant& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Advances `s` and `stick` from `start`, whose contacts were found last, to `end`, h later, in parts that
  /// are stable. `energy` is added to;
  /// `held`: what the body holds then. False: the contacts have no converged forces; `s` is then undefined.
  bool advance(const Parameters& parameters, const Instant& start, const Instant& end, double h, BodyState& s,
               std::span<Vec3> stick, StepEnergy& energy, BodyEnergy& held, ReducedScratch& scratch);
  /// Rest under gravity on planes; false: none was found, or it tips over by itself.
  bool settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick);
  /// As look_ahead of step_control.h.
  double look_ahead(const ContactLaw& law, const BodyState& s);

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
  friend struct ReducedScratch;
  using Points = PackVector<Four>;
  static constexpr int k_unknowns = 6 + k_modes;
  /// Contact points, four by four; those that fill up the last group never touch.
  struct Group {
    Points place;               // m, from the centre of gravity, reference axes
    std::array<int, 4> point;   // index into the model, -1: none
    std::vector<Points> shape;  // per mode
  };
  /// Of a group and a plane.
  struct Side {
    Four gap;      // m, of the centre line on the face
    Four L;        // m
    Four stick;    // 1/m, stiffness of the stick spring over alpha
    Four damping;  // its damping over sqrt(alpha)
  };
  /// A group of which some points touch a plane. Vectors in the floor's axes.
  struct Touch {
    int plane, group;
    Four::Mask touching;
    Four depth;
    Points arm;     // m, from the centre of gravity
    Points stick;   // m, travel since sticking began
    Points travel;  // m, in the part of a step that led here
    Four conservative, normal;
    Points tangential;
    Four stick_energy;
  };
  /// A list that keeps what it ever had room for.
  struct Touches {
    std::vector<Touch> all;
    std::size_t count = 0;
    Touch& add() {
      if (count == all.size()) all.emplace_back();
      return all[count++];
    }
    std::size_t size() const { return count; }
    Touch& operator[](std::size_t c) { return all[c]; }
    const Touch& operator[](std::size_t c) const { return all[c]; }
    Touch* begin() { return all.data(); }
    Touch* end() { return all.data() + count; }
    const Touch* begin() const { return all.data(); }
    const Touch* end() const { return all.data() + count; }
  };
  struct Velocity {
    Vec3 linear, angular;  // floor's axes
    Amplitudes rate;
  };
  using Derivative = std::array<std::array<Four, 3>, 3>;  // of the force by the velocity

  int modes(const BodyState& s) const { return s.rung == Rung::elastic ? basis_->modes : 0; }
  Points place(const BodyState& s, const Group& group) const;
  double clearance(const Vec3& n, double height) const;
  void find_touching(const BodyState& s, const Mat3& r);
  void read_stick(std::span<const Vec3> stick, Touch& touch) const;
  Points velocity_at(std::size_t touch, const Velocity& u, int modes) const;
  template <bool with_derivative>
  void respond(const ContactLaw& law, const Points& velocity, Touch& touch, Derivative& derivative) const;
  template <bool with_derivative>
  void respond_coulomb(const ContactLaw& law, const Points& velocity, Touch& touch,
                       Derivative& derivative) const;
  Points held_stick(const ContactLaw& law, const Touch& touch) const;
  const Side& side(const Touch& touch) const { return sides_[touch.plane * groups_.size() + touch.group]; }
  void respond_at(const ContactLaw& law, const BodyState& s);
  bool known(const Instant& now, const BodyState& s) const;
  void sum_loads(const Vec3& field, BodyState& s) const;
  bool solve_velocity(const ContactLaw& law, const Mat3& inertia, double h, const Velocity& free, Velocity& u,
                      const BodyState& s, ReducedScratch& w);
  void fill_rigid(const Mat3& inertia, double h, ReducedScratch& w) const;
  void fill_modes(double h, int modes, ReducedScratch& w) const;
  bool advance_part(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                    BodyState& s, std::span<Vec3> stick, StepEnergy& energy, ReducedScratch& w);
  void find_swing(double h);
  Vec3 drift(double h, BodyState& s) const;
  double stable_part(const ContactLaw& law, const BodyState& s);
  double stable_size(const ContactLaw& law, double h, const BodyState& s);
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;
  void book_law_change(const ContactLaw& before, const ContactLaw& after, const Touches& at_start,
                       StepEnergy& energy) const;
  void keep_sticks(const ContactLaw& law, std::span<Vec3> stick);
  template <class F>
  void each_force(const BodyState& s, F f) const;
  template <class F>
  void each_touching(const Touches& touches, F f) const;

  const Model& model_;
  const int body_;
  const double mass_, reach_;
  const Mat3 inertia_, inverse_inertia_;  // material axes
  std::shared_ptr<const ElasticBasis> basis_;
  double contact_mass_;
  double stiffest_ = 0;  // 1/(kg m), w^2 over alpha is below it whatever touches
  std::vector<Group> groups_;
  std::vector<Side> sides_;           // per plane, then group
  Eigen::AlignedBox3d box_;           // m, of the contact points, from the centre of gravity, reference axes
  std::vector<double> widest_;        // m, per plane: greatest gap of centre lines on its face
  Touches touches_, touches_before_;  // the latter: where a part of a step starts
  // The state at which `touches_` is.
  std::optional<BodyState> found_at_;
  ContactLaw found_law_;
  std::vector<Points> shapes_;  // per touch and mode, floor's axes
  Eigen::VectorXd section_;
  // Swing of the modes over a step of this size: cosine, sine over frequency, less frequency times sine, and
  // tan(x)/x of half the angle, by which impulses count so that a constant load leaves its static deflection.
  double swing_step_ = 0;
  Amplitudes cosine_, sine_, back_, kick_;
  // Stable steps by what touches.
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

/// Scratch of a step, for one body after the other.
struct ReducedScratch {
  std::vector<ReducedBody::Derivative> derivatives;  // per touch
  // Newton: M - (h/2) sum J^T (df/dv) J and its factors, and a right side. Rows of whole packs.
  double matrix[ReducedBody::k_unknowns][ReducedBody::k_unknowns + 2], side[ReducedBody::k_unknowns];
};

}  // namespace topple
