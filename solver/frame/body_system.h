// Forces on the nodes of one body, or of bodies that may touch each other, and their derivatives.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/contact/member_contact.h"
#include "solver/element/beam_pack.h"
#include "solver/element/section_forces.h"
#include "solver/math/block_lu.h"
#include "solver/math/copy_values.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/energy.h"
#include "solver/state/state.h"

namespace topple {

/// Contact of one point with one plane at some instant.
struct TouchingPair {
  int point;  ///< index into Model::contact_points
  int plane;
  int node;      ///< of the point, numbered within the system
  int own_body;  ///< likewise
  double depth;  ///< 1 - l/L, > 0
  double L;      ///< m
  ContactOutput out;
};

/// What touches at some instant.
struct Contacts {
  std::vector<TouchingPair> planes;
  MemberContacts members;
};

/// Motion of the nodes of a system, numbered from 0 within it.
struct BodyMotion {
  std::vector<Vec3> position, velocity;  ///< m, m/s, floor's frame
  std::vector<Quat> rotation;
  std::vector<Vec3> angular_velocity;  ///< rad/s, material axes

  operator NodeMotion() const { return {position, velocity, rotation, angular_velocity}; }

  void resize(int nodes);
};

/// Four nodes of a system that are worked on together; what fills the last pack repeats its last node.
struct NodePack {
  std::array<int, 4> node;                    ///< numbered within the system
  std::array<int, 4> diagonal;                ///< numbers of blocks in the sparse matrix
  Four real;                                  ///< 1; of what fills 0
  Four mass;                                  ///< kg; of what fills 0
  Four inverse_mass;                          ///< 1/kg
  PackMatrix<Four> inertia, inverse_inertia;  ///< as Model::node_inertia; the former of what fills 0
};

/// Factor of a load at time t.
double load_factor(const Load& load, double t);

/// Bodies of a model that may touch each other, or one alone, with their sparse solver and scratch. Arrays
/// are per node of the system: those of its bodies one after the other, then held nodes of others that they
/// may touch.
class BodySystem {
 public:
  BodySystem(const Model& model, int body);
  /// `candidate_pairs`: pairs of elements that may touch; of each at least one belongs to `bodies`, the other
  /// too or its nodes are held.
  BodySystem(const Model& model, std::vector<int> bodies, std::vector<ElementPair> candidate_pairs);

  /// Applied minus internal force and moment (world axes) at time t: gravity, -m a(t), loads, beams,
  /// anchors, contacts. `stick_start`: State::stick where the step began; `start`: positions there. Fills
  /// `force`, `moment` and `contacts`.
  void evaluate(const Parameters& parameters, double t, const BodyMotion& motion,
                std::span<const Vec3> stick_start, std::span<const Vec3> start);
  /// Without contacts: fills `force` and `moment`.
  void evaluate_free(const Parameters& parameters, double t, const BodyMotion& motion);
  /// With the tangent: adds d(internal - contact)/d(position) + velocity_factor d/d(velocity) into
  /// `lu`.
  void evaluate_with_tangent(const Parameters& parameters, double t, const BodyMotion& motion,
                             std::span<const Vec3> stick_start, std::span<const Vec3> start,
                             double velocity_factor);
  /// Where points touch planes, without forces.
  void find_plane_contacts(const BodyMotion& motion, std::vector<TouchingPair>& found) const;
  /// Contacts alone, into `found`.
  void find_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                     std::span<const Vec3> start, Contacts& found) const;
  /// Also fills this system's part of `sections`, one per element of the model.
  BodyEnergy energy(const ContactLaw& law, const BodyMotion& motion, const Contacts& contacts,
                    std::vector<SectionForces>& sections);
  double kinetic_energy(const BodyMotion& motion) const;  ///< J
  /// Work of viscous stresses from one motion to another, J.
  double viscous_work(const BodyMotion& start, const BodyMotion& end) const {
    return beams_.viscous_work(elements, start, end);
  }
  /// Of the elements' elastic strain, J; also fills this system's part of `sections`: forces without flow.
  double elastic_energy(const BodyMotion& motion, std::vector<SectionForces>& sections);
  /// Copies this system's part of an array over the model's nodes into one over its own, and back.
  template <class T>
  void take(const std::vector<T>& all, std::vector<T>& own) const {
    own.resize(count);
    each_run([&](int global, int i, int nodes) { copy_values(&all[global], nodes, &own[i]); });
    for (int i = count - held_nodes(); i < count; ++i) own[i] = all[node[i]];
  }
  /// Held nodes may be in other systems as well: no step writes to them.
  template <class T>
  void put(const std::vector<T>& own, std::vector<T>& all) const {
    each_run([&](int global, int i, int nodes) { copy_values(&own[i], nodes, &all[global]); });
  }
  /// Copies this system's part of the state.
  void load(const State& state, BodyMotion& motion) const;
  /// Copies what elements, anchors and touching members remember. Steps begin with it; evaluations read it.
  void load_memory(const State& state);
  /// What touching members remember, alone.
  void load_sticks(const State& state);
  /// Keeps the sticks of touching members to itself until give_sticks, so that a step changes no part of the
  /// state that another system has a part in.
  void take_sticks(const State& state);
  void give_sticks(State& state);
  /// Writes stick springs of `contacts`; open contacts forget theirs.
  void store_stick(const Contacts& contacts, State& state);
  /// Of a touching pair at `motion`.
  ContactInput plane_contact(const TouchingPair& pair, const BodyMotion& motion,
                             std::span<const Vec3> stick_start, std::span<const Vec3> start) const;
  const std::vector<MemberPair>& member_pairs() const { return member_pairs_; }
  /// Number of a node within the system, -1: it is not in it.
  int local(int node) const;
  /// Element at a node, for messages.
  int element_at(int node) const;

  struct OwnLoad {
    const Load* load;
    int node;
  };
  struct OwnAnchor {
    int index;  ///< into Model::anchors
    int node;
    AnchorState state;
    Vec3 arm(const Model& of, const BodyMotion& motion) const {
      return motion.rotation[node] * of.anchors[index].arm;
    }
  };

  const Model& model;
  const std::vector<int> bodies;
  const std::vector<ElementPair> candidate_pairs;
  const int index, first;  ///< of the first body: its number, its first node
  std::vector<int> node;   ///< per node of the system, index into the model
  int count;               ///< nodes
  std::vector<NodePack> node_packs;
  double size;                      ///< m, greatest distance of a node from its body's centre of gravity
  double mass;                      ///< kg, of the bodies
  std::vector<unsigned> fixed;      ///< per node, bits as in Support
  bool loads_grow = false;          ///< statics: t is the load factor, in which loads without history grow
  std::vector<Vec3> force, moment;  ///< N, N m
  Contacts contacts;
  BlockLu lu;
  std::vector<OwnElement> own_elements;
  std::vector<ElementState> elements;  ///< per own element; elastic until loaded
  std::vector<OwnLoad> loads;
  std::vector<OwnAnchor> anchors;  ///< as they were loaded
  bool yields;                     ///< some element can
  bool ends_here = false;          ///< the latest evaluation is that of the motion with which the step ends
  /// Per node, when it yields: own elements that end there and at which end (0, 1).
  std::vector<std::vector<std::pair<int, int>>> joints;

 private:
  int held_nodes() const {
    int held = count;
    for (const int b : bodies) held -= model.bodies[b].node_count;
    return held;
  }
  // f(index into the model, number within the system, count) of the nodes of each own body.
  template <class F>
  void each_run(F&& f) const {
    int i = 0;
    for (const int b : bodies) {
      f(model.bodies[b].first_node, i, model.bodies[b].node_count);
      i += model.bodies[b].node_count;
    }
  }
  void add_nodes();
  void add_packs();
  MemberPair member_pair(const ElementPair& pair) const;
  void damp(const Parameters& parameters);
  void start_forces(const Parameters& parameters, double t);
  void take_forces();
  template <bool with_tangent>
  void add_anchors(const BodyMotion& motion);
  template <bool with_tangent>
  void add_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                    std::span<const Vec3> start, double velocity_factor);

  // Contact points of one body.
  struct PointPack {
    std::array<int, 4> node;  // numbered within the system
    int first, count;         // of Model::contact_points
    int own_body;
    int reach;  // of `reaches_`, one per plane from here on
  };
  // Where four points begin to touch a plane, m along its normal, and L.
  struct PlaneReach {
    Four place, L;
  };
  std::vector<PointPack> point_packs_;
  std::vector<PlaneReach> reaches_;
  std::vector<double> contact_mass_;      // kg, share of one contact point, per body of the system
  std::vector<MemberPair> member_pairs_;  // per pair in `candidate_pairs`
  std::vector<MemberStick> own_sticks_, new_sticks_;
  bool keeps_sticks_ = false;
  BeamPacks beams_;
  std::vector<double> damping_;        // Parameters::damping of beams_
  std::vector<NodeForce> node_force_;  // applied less those of the beams
};

}  // namespace topple
