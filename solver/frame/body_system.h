// Forces on the nodes of one body, or of bodies that may touch each other, and their derivatives.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "solver/contact/contact_law.h"
#include "solver/contact/member_pairs.h"
#include "solver/element/beam_pack.h"
#include "solver/element/section_forces.h"
#include "solver/frame/step_span.h"
#include "solver/math/block_lu.h"
#include "solver/math/copy_values.h"
#include "solver/math/ranges.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/state/energy.h"
#include "solver/state/member_sticks.h"
#include "solver/state/state.h"

namespace topple {

/// Contact of one point with one plane at some instant.
struct TouchingPair {
  int point;     ///< index into Model::contact_points
  int plane;     ///< index into Model::planes
  int node;      ///< of the point, numbered within the system
  int own_body;  ///< index into BodySystem::bodies
  double depth;  ///< 1 - l/L, > 0
  double L;      ///< m
  ContactOutput out;
};

/// All that touches at some instant.
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

/// Four nodes of a system that move by themselves, one per lane; the last node is repeated to fill up the
/// last pack of those that are nodes of frames, and of those that are rigid bodies.
struct NodePack {
  std::array<int, 4> node;                    ///< numbered within the system
  bool rigid;                                 ///< whole bodies
  std::array<int, 4> diagonal;                ///< numbers of their diagonal blocks in BodySystem::lu
  Four real;                                  ///< 1; 0: a repeated node
  Four mass;                                  ///< kg; 0: a repeated node
  Four inverse_mass;                          ///< 1/kg
  PackMatrix<Four> inertia, inverse_inertia;  ///< of the node (0: a repeated one), kg m^2, and its inverse
};

/// Factor of a load at time t: its history, linear between its points and constant outside; without one 1.
double load_factor(const Load& load, double t);

/// A body of a system that keeps its shape.
struct RigidInSystem {
  int body;          ///< index into the model
  int own;           ///< the node that is its motion: at its centre of gravity, with its mass and inertia
  int first, count;  ///< nodes that it carries
};

/// Bodies of a model that may touch each other, or one alone, with their sparse solver and scratch. Arrays
/// are per node of the system: the nodes of its bodies one after the other, nodes of held bodies that they
/// may touch, then one for each rigid body.
class BodySystem {
 public:
  BodySystem(const Model& model, int body);
  /// `candidate_pairs`: pairs of elements that may touch, in order; of each, one or both belong to `bodies`,
  /// the other to a held body. `rigid`: those of `bodies` that are no frames, in order; not all.
  BodySystem(const Model& model, std::vector<int> bodies, std::vector<ElementPair> candidate_pairs,
             std::vector<int> rigid = {});

  /// Fills `force`, `moment` and `contacts`: sum of gravity, -m a of the floor, loads, beams, anchors and
  /// contacts, in world axes; no inertia forces. `stick_start`: State::stick where the step began; `start`:
  /// positions of the nodes there.
  void evaluate(const Parameters& parameters, const StepInputs& now, const BodyMotion& motion,
                std::span<const Vec3> stick_start, std::span<const Vec3> start);
  /// The same without contacts.
  void evaluate_free(const Parameters& parameters, const StepInputs& now, const BodyMotion& motion);
  /// As evaluate, and adds -d(force)/d(motion) - velocity_factor (1/s) d(force)/d(velocity) of beams, anchors
  /// and contacts to `lu`; motion: position and spatial spin.
  void evaluate_with_tangent(const Parameters& parameters, const StepInputs& now, const BodyMotion& motion,
                             std::span<const Vec3> stick_start, std::span<const Vec3> start,
                             double velocity_factor);
  /// Where points touch planes, without forces.
  void find_plane_contacts(const BodyMotion& motion, std::vector<TouchingPair>& found) const;
  /// Contacts with their forces, into `found`.
  void find_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                     std::span<const Vec3> start, Contacts& found) const;
  /// At `motion`, where `contacts` were found. Also fills this system's part of `sections`, one per element
  /// of the model.
  BodyEnergy energy(const ContactLaw& law, const BodyMotion& motion, const Contacts& contacts,
                    std::vector<SectionForces>& sections);
  double kinetic_energy(const BodyMotion& motion) const;  ///< J
  /// Work of viscous stresses from one motion to another, J.
  double viscous_work(const BodyMotion& start, const BodyMotion& end) const {
    return beams_.viscous_work(elements, start, end);
  }
  /// Whether some element was beyond k_torn in the latest evaluation.
  bool tears() const { return beams_.tears(); }
  /// Elastic energy of the elements, J, with the flow so far; also fills this system's part of `sections`.
  double elastic_energy(const BodyMotion& motion, std::vector<SectionForces>& sections);
  /// Copies this system's part of an array over the model's nodes into one over its own; put: back.
  template <class T>
  void take(const std::vector<T>& all, std::vector<T>& own) const {
    own.resize(count);
    each_run([&](int, int global, int i, int nodes) { copy_values(&all[global], nodes, &own[i]); });
    for (int i = count - static_cast<int>(rigid.size()) - held_nodes(); i < count; ++i) own[i] = all[node[i]];
  }
  /// Only of frames. Held nodes may be in several systems: no step writes to them.
  template <class T>
  void put(const std::vector<T>& own, std::vector<T>& all) const {
    each_run([&](int body, int global, int i, int nodes) {
      if (!is_rigid(body)) copy_values(&own[i], nodes, &all[global]);
    });
  }
  /// Copies the motion of this system's nodes, and back to frames and rigid bodies.
  void load(const State& state, BodyMotion& motion) const;
  void store(const BodyMotion& motion, State& state) const;
  /// Nodes that rigid bodies carry, where these are.
  void place_carried(BodyMotion& motion) const;
  /// Whether node i is one of a frame or of a held body.
  bool is_of_frame(int i) const { return node_mass[i] > 0 && i < count - std::ssize(rigid); }
  bool is_rigid(int body) const { return ranges::find(rigid, body, &RigidInSystem::body) != rigid.end(); }
  /// Copies hinges, offsets, anchors and sticks between members, which start at `motion`: evaluations read
  /// them. Steps begin with it.
  void load_memory(const State& state, const BodyMotion& motion);
  /// The same for sticks between members alone.
  void load_sticks(const State& state);
  MemberSticks& sticks() { return sticks_; }
  /// Writes the stick springs of `contacts`; those of open contacts become zero.
  void store_stick(const Contacts& contacts, State& state);
  /// The law between a node of the system and planes.
  ContactLaw on_plane(const ContactLaw& law, int i) const {
    return gripped(law, model.bodies[model.node_body[node[i]]].grip);
  }
  /// Input of the contact law for a touching pair at `motion`; arguments as of evaluate.
  ContactInput plane_contact(const TouchingPair& pair, const BodyMotion& motion,
                             std::span<const Vec3> stick_start, std::span<const Vec3> start) const;
  const std::vector<MemberPair>& member_pairs() const { return member_pairs_; }
  /// Whether a support holds direction k of node i of the system: 0..2 translation, 3..5 rotation.
  bool is_fixed(int i, int k) const { return fixed[i] >> k & 1; }
  /// Sets what supports hold of two vectors of node i to zero.
  void clear_fixed(int i, Eigen::Ref<Vec3> translation, Eigen::Ref<Vec3> rotation) const {
    if (fixed[i] == 0) return;
    for (int k = 0; k < 3; ++k) {
      if (is_fixed(i, k)) translation[k] = 0;
      if (is_fixed(i, 3 + k)) rotation[k] = 0;
    }
  }
  /// Number of a node within the system, -1: it is not in it.
  int local(int node) const;
  /// An element of this system (index into the model) at a node of the model, for messages; -1: none.
  int element_at(int node) const;

  struct OwnLoad {
    const Load* load;
    int node;  ///< numbered within the system
  };
  /// An end of an anchor that is on a body of the system.
  struct EndOfAnchor {
    int node = -1;                  ///< numbered within the system; of a rigid body its own; -1: not in it
    Vec3 reference = Vec3::Zero();  ///< m, from the node to the end, reference axes
    /// The same in the floor's frame.
    Vec3 arm(const BodyMotion& motion) const { return motion.rotation[node] * reference; }
  };
  /// Of one whose other body is not in the system nothing acts: it is not in place.
  struct OwnAnchor {
    int index;  ///< into Model::anchors
    EndOfAnchor own, other;
    AnchorState state;
  };

  const Model& model;
  const std::vector<int> bodies;
  const std::vector<ElementPair> candidate_pairs;
  const int index, first;  ///< of the first body: its number, its first node
  std::vector<int> node;   ///< per node of the system, index into the model
  int count;               ///< nodes
  std::vector<RigidInSystem> rigid;
  std::vector<double> node_mass;   ///< kg, per node; 0: a rigid body carries it
  std::vector<Mat3> node_inertia;  ///< kg m^2, likewise, material axes
  std::vector<NodePack> node_packs;
  double size;                      ///< m, greatest distance of a node from its body's centre of gravity
  double mass;                      ///< kg, of the bodies
  std::vector<unsigned> fixed;      ///< per node, bits as in Support; all where a rigid body carries it
  bool loads_grow = false;          ///< statics: time is the load factor, in which loads without history grow
  std::vector<Vec3> force, moment;  ///< N, N m
  Contacts contacts;
  BlockLu lu;
  std::vector<OwnElement> own_elements;
  std::vector<ElementState> elements;  ///< per own element; elastic until loaded
  std::vector<OwnLoad> loads;
  std::vector<OwnAnchor> anchors;  ///< as they were loaded
  bool yields;                     ///< some element can
  bool remembers;                  ///< forces depend on `elements`: some can yield, or one is torn
  bool ends_here = false;          ///< the latest evaluation was at the end of the step: energy() uses it

 private:
  int held_nodes() const {
    int held = count - static_cast<int>(rigid.size());
    for (const int b : bodies) held -= model.bodies[b].node_count;
    return held;
  }
  // f(body, index into the model, number within the system, count) of the nodes of each own body.
  template <class F>
  void each_run(F&& f) const {
    int i = 0;
    for (const int b : bodies) {
      f(b, model.bodies[b].first_node, i, model.bodies[b].node_count);
      i += model.bodies[b].node_count;
    }
  }
  void add_nodes(const std::vector<int>& rigid_bodies);
  void add_elements();
  void add_member_pairs();
  void add_node_packs();
  void add_point_packs();
  void add_what_bears_on_nodes();
  void add_own_anchors();
  void damp(const Parameters& parameters);
  void start_forces(const Parameters& parameters, const StepInputs& now);
  void take_forces();
  EndOfAnchor end_of_anchor(const AnchorEnd& end) const;
  std::array<Vec3, 2> ends(const OwnAnchor& own, const BodyMotion& motion) const;
  template <bool with_tangent>
  void add_anchors(const BodyMotion& motion);
  template <bool with_tangent>
  void add_contacts(const ContactLaw& law, const BodyMotion& motion, std::span<const Vec3> stick_start,
                    std::span<const Vec3> start, double velocity_factor);
  void add_slope(int i, int j, const Mat3& slope, const BodyMotion& motion);
  template <bool with_tangent>
  void carry_forces(const BodyMotion& motion);

  // Four contact points of one body.
  struct PointPack {
    std::array<int, 4> node;  // numbered within the system
    int first, count;         // of Model::contact_points
    int own_body;
    int reach;  // of `reaches_`, one per plane from here on
  };
  // Coordinate along a plane's normal at which each of four points begins to touch it, and L, m.
  struct PlaneReach {
    Four place, L;
  };
  std::vector<PointPack> point_packs_;
  std::vector<PlaneReach> reaches_;
  std::vector<int> moves_with_;           // per node: itself, or its rigid body's own
  std::vector<double> contact_mass_;      // kg, share of one contact point, per body of the system
  std::vector<MemberPair> member_pairs_;  // of `candidate_pairs`
  MemberSticks sticks_;
  BeamPacks beams_;
  std::vector<double> damping_;        // Parameters::damping of beams_
  std::vector<NodeForce> node_force_;  // gravity, floor, loads and beams
};

}  // namespace topple
