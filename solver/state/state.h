// The state of a run: exactly what is needed to continue it bit for bit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/contact/anchor.h"
#include "solver/contact/member_contact.h"
#include "solver/element/element_state.h"
#include "solver/math/types.h"
#include "solver/model/body_state.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/planar/block.h"
#include "solver/state/energy.h"

namespace topple {

/// Energies since the start of the run, J. Signs: what is held or came in is positive in input, kinetic,
/// strain, gravity, contact, anchor and model_switch; what went out is positive in those that dissipated()
/// adds up.
struct EnergyLedger {
  double input = 0;  ///< work of floor acceleration, loads and edits on the bodies, in the floor's frame
  double kinetic = 0;
  double strain = 0;
  double gravity = 0;         ///< potential, relative to the start
  double contact = 0;         ///< stored in penalty and stick springs
  double friction = 0;        ///< dissipated by tangential contact forces
  double normal_damping = 0;  ///< dissipated by normal contact forces
  double numerical = 0;       ///< dissipated by the integrator, from its own kinematics
  double plastic = 0;         ///< dissipated by hinges and fracture
  double damping = 0;         ///< dissipated by viscous stresses (damping.h)
  double model_switch = 0;    ///< came in when bodies changed their level (model_level.h); may be negative
  double anchor = 0;          ///< stored in anchors
  double released = 0;        ///< what anchors held when they broke or were taken away: went out
  double start_total = 0;     ///< kinetic + strain + contact + anchor at the start
  double largest = 0;         ///< largest so far of input, kinetic, gravity and stored energy, each by itself

  double dissipated() const { return friction + normal_damping + numerical + plastic + damping + released; }
  /// Error of the energy balance.
  double unexplained() const {
    return kinetic + strain + gravity + contact + anchor - start_total - input - model_switch + dissipated();
  }
  /// |unexplained()|/largest; 0 while nothing was exchanged.
  double balance_error() const;
  /// At the start of a run, with what its bodies hold; at the end of a step.
  void open(const BodyEnergy& held);
  void close(const StepEnergy& exchanged, const BodyEnergy& held);
};

/// A body on the level planar.
struct BlockState {
  planar::State motion;         ///< at State::time
  Vec3 along = Vec3::UnitX();   ///< unit, of its plane: +x of the motion
  Vec3 floor = Vec3::Zero();    ///< m/s^2, acceleration of the floor at State::time,
  double static_friction = -1;  ///< and frictions before it: where an edit changes them the mode is anew
  double kinetic_friction = -1;
};

/// Motion of a run at one accepted step, in the floor's frame. Per-node arrays have Model::node_total()
/// entries; those of bodies on the levels rigid and elastic follow from `bodies` when place_nodes
/// (model_level.h) was called, as Run::state() does.
struct State {
  double time = 0;                                     ///< s
  std::int64_t step = 0;                               ///< accepted steps; settling does not count
  std::vector<Vec3> position;                          ///< m
  std::vector<Quat> rotation;                          ///< reference to current
  std::vector<Vec3> velocity;                          ///< m/s
  std::vector<Vec3> angular_velocity;                  ///< rad/s, in the node's material axes
  std::vector<Vec3> acceleration;                      ///< m/s^2, from the balance of forces
  std::vector<Vec3> angular_acceleration;              ///< rad/s^2, material axes
  std::vector<Vec3> algorithmic_acceleration;          ///< a of generalized-alpha (Chung and Hulbert), m/s^2
  std::vector<Vec3> algorithmic_angular_acceleration;  ///< likewise, rad/s^2, material axes
  std::vector<BodyState> bodies;                       ///< one per body
  std::vector<BlockState> blocks;                      ///< one per body; of those on the level planar
  /// Stick springs: tangential travel since sticking began, m; index point * planes + plane.
  std::vector<Vec3> stick;
  std::vector<MemberStick> member_sticks;  ///< in the order of elements, then places
  /// That may touch before `candidate_margin` is used up, in order.
  CandidatePairs candidate_pairs;
  double candidate_margin = 0;             ///< m, by which bodies may still approach each other
  std::vector<ElementState> elements;      ///< index as Model::elements
  std::vector<AnchorState> anchors;        ///< index as Model::anchors
  Vec3 floor_displacement = Vec3::Zero();  ///< m, high-passed (advance_floor)
  Vec3 floor_velocity = Vec3::Zero();      ///< m/s, high-passed
  /// Adaptive runs: step tried next, s. Displacement control: m or rad per load step. 0: not chosen yet.
  double step_size = 0;
  double load_factor = 0;                        ///< of loads without history in static runs
  ContactLawKind law = ContactLawKind::coulomb;  ///< with which the accelerations and energies were computed
  EnergyLedger energy;
};

/// The reference pose moved by `starts` (one per body), at rest or moving rigidly; accelerations zero.
State start_state(const Model& model, const std::vector<BodyStart>& starts);

/// State as numbers, in a fixed order: the content of a checkpoint. Integers keep their bits.
std::vector<double> pack(const State& state);

/// Inverse of pack. Throws std::invalid_argument when counts or choices do not fit the model or this version.
State unpack(const Model& model, std::span<const double> numbers);

/// 64-bit FNV-1a over the bytes of pack().
std::uint64_t hash(const State& state);
/// The same over numbers that pack() of this or an older version made.
std::uint64_t hash(std::span<const double> packed);

/// No NaN, no infinity, nothing above k_largest_number. `nodes` false: the per-node and per-element arrays
/// are left out.
bool is_finite(const State& state, bool nodes = true);
/// The same of what a step changes when no body is a frame. `stick` is left out: one that is not finite makes
/// a force that is not.
bool moves_finite(const State& state);

/// The first body whose motion is not finite by the rule of is_finite; -1: none.
int body_not_finite(const Model& model, const State& state);

/// Makes `to` equal to `from`. `nodes` false: but for the per-node and per-element arrays, which stay.
void copy(const State& from, State& to, bool nodes);
/// The same by exchanging both.
void take(State& from, State& to, bool nodes);

}  // namespace topple
