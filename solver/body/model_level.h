// Model levels: what each body is computed as, and how it changes in the middle of a run.
//
// A body stands on the level that Parameters::models names. automatic: rigid when nothing but motion is asked
// for and its error is allowed, and then it does not yield; else elastic. One that would be rigid begins as a
// planar block where it is one (PlanarBody::begin), alone, and that error too is allowed. An elastic body is
// a frame while one is near (State::candidate_pairs, also over bodies between them); a rigid one is stepped
// with the frames that are near, but for explicit methods, which know frames alone. An automatic one becomes
// a frame too once
//   - a section has sqrt(f + 1) > k_near_yield (f: plasticity.h),
//   - its error is no longer allowed.
// A planar block becomes a rigid body, and stays one, once
//   - another body comes within the margin of the candidate pairs, or a wall within what it may travel,
//   - another part of it is about to meet the floor, or its slip jams again and again,
//   - an edit moves it out of its plane, puts an anchor on it or changes its contacts but for friction.
//
// Errors are allowed up to Parameters::accuracy. They are estimates of what a level leaves out, as a share of
// the critical angle when motion is asked for, of the stress when that is:
//   - rigid: rigid_error()
//   - planar: that and hard_floor_error() (planar_body.h)
//   - elastic, theta being the rotation of a node relative to the body (sum over the modes): what theta^2/2
//     shortens a body by, over its critical angle; for stresses theta/2, the mean angle by which forces turn,
//     and before and while it strikes something what a blow that may make a new peak raises beyond its modes,
//     if that is more (ReducedBody::blow_error)
// A trajectory that comes near the critical angle, or bounces often, can enlarge them.
// It comes down to its base level when no such frame is near, no hinge ever formed in it, it does not fall,
// and for k_calm_for sqrt(f + 1) < k_calm_yield, its strain energy but for that of modes and local springs
// is below k_negligible of m g reach and of the largest energy, and its error would be half of what is
// allowed.
//
// Up from a planar block: it sinks into the springs of its contacts so far that they bear what the floor
// bore. Up: nodes are placed where the modes, and what loads add to them statically, put them, and moved
// rigidly to where contacts bear what they bore; friction bears that too. Down: the rigid motion that has the
// nodes' momentum, at their best fit, and the amplitudes of the modes in what is left. Linear momentum stays
// to rounding, angular momentum to the square of the deformation over the body's size; the change of energy
// is booked as EnergyLedger::model_switch.
#pragma once

#include <span>
#include <string_view>

#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/model/table.h"
#include "solver/state/state.h"

namespace topple {

inline constexpr double k_near_yield = 0.9;   ///< sqrt(f + 1)
inline constexpr double k_calm_yield = 0.45;  ///< sqrt(f + 1)
inline constexpr double k_calm_for = 0.08;    ///< s
inline constexpr double k_negligible = 1e-3;  ///< strain energy over m g reach

/// A few words: "a section is near yield".
const char* name(LevelReason reason);

/// The level that has this word.
const LevelTraits& level_called(std::string_view word);

/// The level on which a body begins, and to which it comes back.
struct LevelChoice {
  ModelLevel level;
  LevelReason reason;
};

/// Estimated error of the level elastic while nodes are turned by up to `rotation`, rad, relative to the
/// body.
double elastic_error(const Body& body, const Parameters& parameters, double rotation);

/// What a scene asks a body to be computed as.
struct BodyModelTraits {
  BodyModel kind;
  const char* word;          ///< in scenes
  bool bends;                ///< needs Body::elastic
  bool takes_supports;       ///< and loads on nodes
  bool may_be_frame;         ///< where the scene needs one
  bool of_solid = false;     ///< a block (Body::solid) may have it
  bool by_edit = true;       ///< may be asked for while it runs
  bool lists_start = false;  ///< outcomes say what it begins as
  /// Of a body that bears neither supports nor loads and has, if it bends, Body::elastic.
  LevelChoice (*choose)(const Model&, const Parameters&, int body);
};
std::span<const BodyModelTraits> body_models();
inline const BodyModelTraits& traits(BodyModel model) {
  return row_of(body_models(), model);
}

/// Whether a body can be computed as `asked`: rigid and frame always, but for one that stands on supports or
/// bears loads, which is a frame; elastic and automatic when its scene's `model` was one of them. A block:
/// BodyModelTraits::of_solid.
bool can_be(const Model& model, int body, BodyModel asked);

/// The level that Parameters::models leads to (BodyModelTraits::choose); frame where can_be() forbids it and
/// for floors and walls made of members. A block is then rigid.
LevelChoice base_level(const Model& model, const Parameters& parameters, int body);

/// Positions, rotations and velocities of the nodes of all bodies that are not frames, from State::bodies.
void place_nodes(const Model& model, State& state);

/// BodyState of a frame for `level`, rigid or elastic: rigid motion by best fit and momentum, the rest
/// projected on the modes.
BodyState reduce(const Model& model, const State& state, int body, ModelLevel level);

}  // namespace topple
