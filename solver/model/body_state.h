// Model levels: how much of a body's motion is computed. And the motion of a body that is not computed node
// by node.
#pragma once

#include <cstdint>

#include "solver/math/types.h"
#include "solver/model/table.h"

namespace topple {

/// planar: a block in a vertical plane on a hard floor, exact between its events (solver/planar). rigid: six
/// unknowns. elastic: rigid motion and the lowest modes of small deformations in the body's frame.
/// frame: every node, with large rotations, hinges and fracture. Recordings hold these numbers.
enum class ModelLevel : std::uint8_t { rigid = 0, elastic = 1, frame = 2, planar = 3 };

struct LevelTraits {
  ModelLevel kind;
  const char* word;
  bool has_modes, has_stresses;
  bool moves_nodes;   ///< the nodes are the unknowns
  bool joins_frames;  ///< is stepped with frames that it may touch, in implicit methods
  bool has_block;     ///< moves as State::blocks say, for itself alone
};
inline constexpr LevelTraits k_model_levels[] = {
    {ModelLevel::planar, "planar", false, false, false, true, true},
    {ModelLevel::rigid, "rigid", false, false, false, true, false},
    {ModelLevel::elastic, "elastic", true, true, false, false, false},
    {ModelLevel::frame, "frame", false, true, true, true, false}};
constexpr const LevelTraits& traits(ModelLevel level) {
  return row_of(k_model_levels, level);
}

/// Why a body is on its level (rules: model_level.h). Recordings hold these numbers.
enum class LevelReason : std::uint8_t {
  asked = 0,        ///< the scene or an edit names it
  motion = 1,       ///< nothing but motion is asked for
  stress = 2,       ///< stresses are asked for
  blow = 3,         ///< it strikes on contacts too stiff for its modes, by Parameters::accuracy; until
                    ///< topple-16: its contacts were nearly as stiff as it was
  yield = 4,        ///< a section comes near its yield surface
  deformation = 5,  ///< it deforms too much for linear elasticity, by Parameters::accuracy
  near = 6,         ///< a frame may touch it, or a body that touches it (State::candidate_pairs)
  calm = 7,         ///< no reason for a higher level is left, and no hinge has formed
  bending = 8,      ///< it bends too much for a rigid body, by Parameters::accuracy
  // a planar block became a rigid body:
  neighbour = 9,  ///< a wall or another body may touch it
  fall = 10,      ///< another part of it is about to meet the floor
  plane = 11,     ///< something moves it out of its plane
  held = 12,      ///< an anchor
  contact = 13,   ///< an edit of its contacts
  jammed = 14,    ///< its events come without progress
  solid = 15      ///< it is a block of one piece, which has neither stresses nor deformation
};

inline constexpr int k_modes = 12;  ///< most modes of a body on the level elastic
using Amplitudes = Eigen::Array<double, k_modes, 1>;

/// Part of State, one per body. On the level frame the nodes hold the motion and only the first three members
/// mean something; on the others the nodes follow from this (place_nodes). Modes are those of ElasticBasis,
/// with amplitudes of zero on the levels planar and rigid.
struct BodyState {
  ModelLevel level = ModelLevel::frame;
  LevelReason reason = LevelReason::asked;
  double error_estimate = 0;  ///< as Parameters::accuracy; infinite: unknown; not in checkpoints
  double calm_since = -1;  ///< s, since when a frame meets the conditions of a lower level; -1: it does not
  double peak_stress = 0;  ///< Pa, greatest at ends of steps so far, of one that may be elastic, in a Run
  Vec3 position = Vec3::Zero();               ///< m, centre of gravity, floor's frame
  Quat rotation = Quat::Identity();           ///< reference to current
  Vec3 velocity = Vec3::Zero();               ///< m/s
  Vec3 angular_velocity = Vec3::Zero();       ///< rad/s, material axes
  Amplitudes amplitude = Amplitudes::Zero();  ///< m sqrt(kg)
  Amplitudes rate = Amplitudes::Zero();       ///< m sqrt(kg)/s
  double substep = 0;  ///< s, implicit substep that the level rigid tries next; 0: none was taken yet
  // What acts at this instant: gravity, floor, contacts and anchors.
  Vec3 force = Vec3::Zero();             ///< N
  Vec3 moment = Vec3::Zero();            ///< N m about the centre of gravity, floor's axes
  Amplitudes load = Amplitudes::Zero();  ///< on the modes, N/sqrt(kg)
};

}  // namespace topple
