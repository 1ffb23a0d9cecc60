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

/// Constants and scratch of one body.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// Contacts of `s` with the springs `stick` (State::stick); returns what the body holds.
  BodyEnergy find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick);
  /// The same, and all that acts on the body into `s`.
  BodyEnergy balance(const Parameters& parameters, const Instant& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Advances `s` and `stick` by h from `start`, whose contacts were found last, in parts that are stable.
  /// `energy` is added to; returns what the body holds then.
  BodyEnergy advance(const Parameters& parameters, const Instant& start, double h, BodyState& s,
                     std::span<Vec3> stick, StepEnergy& energy);
  /// Rest under gravity on planes; false: none was found, or it tips over by itself.
  bool settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick);
  /// As look_ahead of step_control.h.
  double look_ahead(const ContactLaw& law, const BodyState& s);

  /// Appends the contacts found last.
  void list_contacts(std::vector<ContactForce>& forces) const;
  /// Section forces of the body's elements at `s` under the contacts found last, into those of the model; zero
  /// on the rung rigid.
  void section_forces(const BodyState& s, std::vector<SectionForces>& sections);
  /// Adds the displacements and rotations of all nodes that the contacts found last add to the modes'.
  void add_residual(const BodyState& s, State& state) const;
  /// Not below the greatest sqrt(f + 1) of any section.
  double yield_bound(const BodyState& s) const;
  /// Not below the greatest rotation of a node relative to the body, rad.
  double rotation_bound(const BodyState& s) const;

 private:
  static constexpr int k_unknowns = 6 + k_modes;
  /// Contact points, four by four; those that fill up the last group never touch.
  struct Group {
    Pack3 place;  // m, from the centre of gravity, reference axes
    std::array<int, k_lanes> point;  // index into the model, -1: none
    std::vector<Pack3> shape;        // per mode
  };
  /// Of a group and a plane.
  struct Side {
    Pack gap;      // m, of the centre line on the face
    Pack L;        // m
    Pack stick;    // 1/m, stiffness of the stick spring over alpha
    Pack damping;  // its damping over sqrt(alpha)
  };
  /// A group of which some points touch a plane. Vectors in the floor's axes.
  struct Touch {
    int plane, group;
    PackMask touching;
    Pack depth;
    Pack3 arm;    // m, from the centre of gravity
    Pack3 stick;  // m, travel since sticking began
    Pack conservative, normal;
    Pack3 tangential;
    Pack stick_energy;
  };
  struct Velocity {
    Vec3 linear, angular;  // floor's axes
    Amplitudes rate;
  };
  using Derivative = std::array<std::array<Pack, 3>, 3>;  // of the force by the velocity

  int modes(const BodyState& s) const { return s.rung == Rung::elastic ? basis_->modes : 0; }
  Pack3 place(const BodyState& s, const Group& group) const;
  void find_touching(const BodyState& s, const Mat3& r);
  void read_stick(std::span<const Vec3> stick, Touch& touch) const;
  Pack3 velocity_at(std::size_t touch, const Velocity& u, int modes) const;
  template <bool with_derivative>
  void respond(const ContactLaw& law, const Pack3& velocity, Touch& touch, Derivative& derivative) const;
  template <bool with_derivative>
  void respond_coulomb(const ContactLaw& law, const Pack3& velocity, Touch& touch, Derivative& derivative) const;
  Pack3 held_stick(const ContactLaw& law, const Touch& touch) const;
  const Side& side(const Touch& touch) const { return sides_[touch.plane * groups_.size() + touch.group]; }
  void respond_at(const ContactLaw& law, const BodyState& s);
  bool known(const Instant& now, const BodyState& s) const;
  void sum_loads(const Vec3& field, BodyState& s) const;
  void solve_velocity(const ContactLaw& law, const Mat3& inertia, double h, const Velocity& free, Velocity& u,
                      const BodyState& s);
  template <int fixed>
  void factor(const Mat3& inertia, double h, int modes);
  template <int fixed>
  void solve(int modes);
  void advance_part(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                    BodyState& s, std::span<Vec3> stick, StepEnergy& energy);
  void drift(double h, BodyState& s);
  double stable_part(const ContactLaw& law, const BodyState& s);
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;
  void book_law_change(const ContactLaw& before, const ContactLaw& after, StepEnergy& energy) const;
  void keep_sticks(const ContactLaw& law, std::span<Vec3> stick);
  template <class F>
  void each_force(const BodyState& s, F f) const;
  template <class F>
  void each_touching(const std::vector<Touch>& touches, F f) const;

  const Model& model_;
  const int body_;
  const double mass_, reach_;
  const Mat3 inertia_, inverse_inertia_;  // material axes
  std::shared_ptr<const ElasticBasis> basis_;
  double contact_mass_;
  std::vector<Group> groups_;
  std::vector<Side> sides_;      // per plane, then group
  std::vector<double> nearest_;  // per plane: m, of the centre of gravity, from which no point touches
  std::vector<Touch> touches_, touches_start_;
  // The state at which `touches_` is.
  std::optional<BodyState> found_at_;
  ContactLaw found_law_;
  std::vector<Pack3> shapes_;  // per touch and mode, floor's axes
  // Newton: M - (h/2) sum J^T (df/dv) J and its factors, a right side, and the derivatives of all touches.
  double matrix_[k_unknowns][k_unknowns + 2], side_[k_unknowns];
  std::vector<Derivative> derivatives_;
  Eigen::VectorXd section_;
  // Swing of a mode over a step of this size: cosine, sine over frequency, frequency times sine.
  double swing_step_ = 0;
  Amplitudes cosine_, sine_, back_;
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

}  // namespace topple
