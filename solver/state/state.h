// Exactly what is needed to continue bit for bit.
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
#include "solver/state/energy.h"

namespace topple {

/// Energies since the start of the run, J. Signs: input, kinetic, strain, gravity, contact and anchor are
/// what is there or came in; dissipated is what went out.
struct EnergyLedger {
  double input =
      0;  ///< work of the floor's acceleration, loads and edits on the bodies, in the floor's frame
  double kinetic = 0;
  double strain = 0;
  double gravity = 0;         ///< relative to the start
  double contact = 0;         ///< stored in penalty and stick springs
  double friction = 0;        ///< dissipated by tangential contact forces
  double normal_damping = 0;  ///< dissipated by normal contact forces
  double numerical = 0;       ///< dissipated by the integrator, from its own kinematics
  double plastic = 0;         ///< dissipated by hinges; moves of stress points and fracture are in it
  double damping = 0;         ///< dissipated by viscous stresses (damping.h)
  double model_switch = 0;    ///< came in when bodies changed their level (model_level.h)
  double anchor = 0;          ///< stored in anchors
  double released = 0;        ///< what anchors held when they broke or were taken away: went out
  double start_total = 0;     ///< kinetic + strain + contact + anchor at the start
  double largest = 0;         ///< largest energy exchanged so far

  double dissipated() const { return friction + normal_damping + numerical + plastic + damping + released; }
  /// Energy that nothing explains.
  double unexplained() const {
    return kinetic + strain + gravity + contact + anchor - start_total - input - model_switch + dissipated();
  }
  /// |unexplained| over the largest energy exchanged so far (input, kinetic, potential).
  double balance_error() const;
  /// A run begins with what its bodies hold; a step ends.
  void open(const BodyEnergy& held);
  void close(const StepEnergy& exchanged, const BodyEnergy& held);
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
  std::vector<Vec3> algorithmic_acceleration;          ///< a of generalized-alpha
  std::vector<Vec3> algorithmic_angular_acceleration;  ///< likewise, material axes
  std::vector<BodyState> bodies;                       ///< one per body
  /// Stick springs: tangential travel since sticking began, m; index point * planes + plane.
  std::vector<Vec3> stick;
  std::vector<MemberStick> member_sticks;  ///< in the order of elements, then places
  std::vector<ElementPair>
      candidate_pairs;                     ///< that may touch before `candidate_margin` is used up, in order
  double candidate_margin = 0;             ///< m, that bodies may still approach each other
  std::vector<ElementState> elements;      ///< index as Model::elements
  std::vector<AnchorState> anchors;        ///< index as Model::anchors
  Vec3 floor_displacement = Vec3::Zero();  ///< m, high-passed (method: excitation.h)
  Vec3 floor_velocity = Vec3::Zero();      ///< m/s, high-passed
  /// Step size in use, 0: not chosen yet. Adaptive runs: s, tried next; displacement control: m or rad per
  /// load step.
  double step_size = 0;
  double load_factor = 0;                        ///< static runs
  ContactLawKind law = ContactLawKind::coulomb;  ///< with which accelerations and energies were found
  EnergyLedger energy;
};

/// The reference pose moved by `starts` (one per body), at rest or moving rigidly; accelerations zero.
State start_state(const Model& model, const std::vector<BodyStart>& starts);

/// State as numbers, in a fixed order: the content of a checkpoint.
std::vector<double> pack(const State& state);

/// Inverse of pack. Throws std::invalid_argument when the count does not fit the model.
State unpack(const Model& model, std::span<const double> numbers);

/// 64-bit FNV-1a over the bytes of pack().
std::uint64_t hash(const State& state);
/// The same of a state that is packed, also as an older version packed it.
std::uint64_t hash(std::span<const double> packed);

/// No NaN, no infinity, nothing above k_largest_number anywhere; without `nodes` in all but the per-node and
/// per-element arrays.
bool is_finite(const State& state, bool nodes = true);
/// The same of what a step changes where no node moves, but for stick springs: one that is not finite makes a
/// force that is not.
bool moves_finite(const State& state);

/// The first body whose motion is not finite, as is_finite has it, -1: none.
int body_not_finite(const Model& model, const State& state);

/// Makes `to` equal to `from`; without `nodes` but for the per-node and per-element arrays, which must have
/// their sizes.
void copy(const State& from, State& to, bool nodes);
/// The same for a `from` that is no longer needed: its arrays are exchanged.
void take(State& from, State& to, bool nodes);

}  // namespace topple
