// Forces on the nodes of one body and their derivatives.
#pragma once

#include <span>
#include <vector>

#include "solver/block_lu.h"
#include "solver/contact_law.h"
#include "solver/model.h"
#include "solver/parameters.h"
#include "solver/section_forces.h"
#include "solver/state.h"

namespace topple {

/// Contact of one point with one plane at some instant.
struct TouchingPair {
  int point;  ///< index into Model::contact_points
  int plane;
  double depth;  ///< 1 - l/L, > 0
  double L;      ///< m
  ContactOutput out;
};

/// Motion of one body's nodes, numbered from 0 within the body.
struct BodyMotion {
  std::vector<Vec3> position, velocity;  ///< m, m/s, floor's frame
  std::vector<Quat> rotation;
  std::vector<Vec3> angular_velocity;  ///< rad/s, material axes

  void resize(int nodes);
};

/// Energies of one body that depend on where it is, J.
struct BodyEnergy {
  double kinetic = 0, strain = 0, contact = 0;
};

/// Factor of a load at time t.
double load_factor(const Load& load, double t);

/// One body of a model with its sparse solver and scratch. All arrays are per node of the body.
class BodySystem {
 public:
  BodySystem(const Model& model, int body);

  /// Applied minus internal force and moment (world axes) at time t: gravity, -m a(t), loads, beams,
  /// contacts. `stick_start`: State::stick where the step began; `start`: positions there. Fills `force`,
  /// `moment` and `pairs`.
  void evaluate(const Parameters& parameters, double t, const BodyMotion& motion,
                std::span<const Vec3> stick_start, std::span<const Vec3> start);
  /// The same with the tangent: adds d(internal - contact)/d(position) + velocity_factor d/d(velocity) into
  /// `lu`.
  void evaluate_with_tangent(const Parameters& parameters, double t, const BodyMotion& motion,
                             std::span<const Vec3> stick_start, std::span<const Vec3> start,
                             double velocity_factor);
  /// Contacts alone, into `found`.
  void find_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                     std::span<const Vec3> start, std::vector<TouchingPair>& found) const;
  /// Also fills this body's part of `sections`, one per element of the model.
  BodyEnergy energy(const ContactLaw& law, const BodyMotion& motion,
                    const std::vector<TouchingPair>& contacts, std::vector<SectionForces>& sections) const;
  double kinetic_energy(const BodyMotion& motion) const;  ///< J
  /// Copies this body's part of the state.
  void load(const State& state, BodyMotion& motion) const;
  /// Copies the elements of this body. Steps begin with it; evaluations read `elements`.
  void load_elements(const State& state);
  /// Writes stick springs of `contacts`; open contacts forget theirs.
  void store_stick(const std::vector<TouchingPair>& contacts, std::vector<Vec3>& stick) const;
  const std::vector<const Load*>& loads() const { return loads_; }
  /// Element at a node, for messages.
  int element_at(int node) const;

  const Model& model;
  const int index;                  ///< of the body
  const int first, count;           ///< nodes
  double size;                      ///< m, greatest distance of a node from the centre of gravity
  double contact_mass;              ///< kg, share of one contact point
  std::vector<unsigned> fixed;      ///< per node, bits as in Support
  bool loads_grow = false;          ///< statics: t is the load factor, in which loads without history grow
  std::vector<Vec3> force, moment;  ///< N, N m
  std::vector<TouchingPair> pairs;
  BlockLu lu;
  std::vector<ElementState> elements;  ///< per element of the body; elastic until loaded
  bool yields;                         ///< some element can
  /// Per node, when it yields: elements that end there, numbered within the body, and at which end (0, 1).
  std::vector<std::vector<std::pair<int, int>>> joints;

 private:
  void add_applied(const Parameters& parameters, double t);
  template <bool with_tangent>
  void add_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                    std::span<const Vec3> start, double velocity_factor);
  std::vector<const Load*> loads_;
};

}  // namespace topple
