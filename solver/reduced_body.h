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
#include <span>
#include <vector>

#include "solver/body_system.h"
#include "solver/elastic_basis.h"
#include "solver/energy.h"

namespace topple {

/// What all bodies share at one instant.
struct Instant {
  double time;
  ContactLaw law;
  Vec3 floor;  ///< m/s^2, acceleration
  Instant(const Parameters& parameters, double t);
};

/// Constants and scratch of one body. Contact points stand in groups of four.
class ReducedBody {
 public:
  ReducedBody(const Model& model, int body);

  /// Advances `s` and its stick springs (State::stick) by h from `start`, whose contacts were found last, in
  /// parts that are stable. `energy` is added to; returns what the body holds then.
  BodyEnergy advance(const Parameters& parameters, const Instant& start, double h, BodyState& s,
                     std::span<Vec3> stick, StepEnergy& energy);
  /// Contacts of `s`; returns what it holds.
  BodyEnergy find_contacts(const Instant& now, const BodyState& s, std::span<const Vec3> stick);
  /// The same, and all that acts on the body into `s`.
  BodyEnergy balance(const Parameters& parameters, const Instant& now, BodyState& s,
                     std::span<const Vec3> stick);
  /// Rest under gravity on planes; false: none was found, or it tips over by itself.
  bool settle(const Parameters& parameters, BodyState& s, std::span<Vec3> stick);
  /// As look_ahead of step_control.h.
  double look_ahead(const ContactLaw& law, const BodyState& s) const;

  /// Contacts of the last balance, or step.
  const std::vector<TouchingPair>& contacts() const { return contacts_; }
  /// Section forces of the body's elements at `s` under the contacts found last, into those of the model;
  /// zero on the rung rigid.
  void section_forces(const BodyState& s, std::vector<SectionForces>& sections);
  /// Adds the displacements and rotations of all nodes that the contacts found last add to the modes'.
  void add_residual(const BodyState& s, State& state) const;
  /// Not below the greatest sqrt(f + 1) of any section.
  double yield_bound(const BodyState& s) const;
  /// Not below the greatest rotation of a node relative to the body, rad.
  double rotation_bound(const BodyState& s) const;
  /// Modes computed on this rung.
  int modes(const BodyState& s) const { return s.rung == Rung::elastic ? basis_->modes : 0; }

  const Model& model;
  const int index;
  const double mass;
  const Mat3 inertia, inverse_inertia;  ///< material axes
  const double reach;                   ///< m, Body::reach

 private:
  static constexpr int k_width = 4;
  using Pack = Eigen::Array<double, k_width, 1>;
  /// Per contact point of a group.
  struct Group {
    Pack x, y, z;  // m, from the centre of gravity, reference axes
  };
  struct Side {         // of a plane
    Pack threshold, L;  // contact where n.r + n.(X - point) < threshold
  };
  struct Frame {
    Mat3 r;                 // rotation
    Mat3 inertia, inverse;  // floor's axes
  };
  struct Velocity {
    Vec3 linear, angular;  // floor's axes
    Amplitudes rate;
  };

  void advance_part(const Parameters& parameters, const Instant& start, const Instant& end, double h,
                    BodyState& s, std::span<Vec3> stick, StepEnergy& energy);
  void drift(double h, BodyState& s);
  void find_touching(const BodyState& s, const Mat3& r);
  Vec3 point(const BodyState& s, int p) const;  // material axes, from the centre of gravity
  Vec3 velocity_of(const Velocity& u, const Mat3& r, const BodyState& s, int touching) const;
  void solve_velocity(const ContactLaw& law, const Frame& frame, double h, const Velocity& free,
                      std::span<const Vec3> stick, Velocity& u, const BodyState& s);
  void sum_loads(const Frame& frame, const Vec3& field, BodyState& s) const;
  double stable_part(const ContactLaw& law, const BodyState& s);
  Frame frame_of(const BodyState& s) const;
  BodyEnergy energy(const ContactLaw& law, const BodyState& s) const;

  std::shared_ptr<const ElasticBasis> basis_;
  double contact_mass_;
  int first_point_, points_;
  std::vector<Group> groups_;
  std::vector<Side> sides_;      // per plane and group
  std::vector<Vec3> place_;      // m, per contact point, from the centre of gravity
  Eigen::MatrixXd point_shape_;  // 3 per contact point x modes
  std::vector<TouchingPair> contacts_, contacts_start_;
  std::vector<Vec3> arm_, arm_start_, travel_;  // per contact: from the centre of gravity, floor's axes
  Eigen::VectorXd section_;
  // Rotation of a mode over a step of this size: cosine, sine over frequency, frequency times sine.
  double swing_step_ = 0;
  Amplitudes cosine_, sine_, back_;
  // Stable steps by what touches.
  struct Known {
    std::uint64_t touching;
    double alpha, q;
    Rung rung;
    double step;
  };
  std::array<Known, 8> known_{};
  int next_known_ = 0;
};

}  // namespace topple
