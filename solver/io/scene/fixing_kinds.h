// Kinds of [[fixing]], a row each. Their numbers are assumed: of the size that such hardware has, from no
// product and no standard; a scene says its own.
#pragma once

#include <limits>
#include <span>

#include "solver/model/model.h"
#include "solver/model/table.h"

namespace topple::io {

enum class FixingKind { l_bracket, strap, pole, mat, stopper, connector };

/// Where on its body a fixing holds, unless the scene says `at`.
enum class FixingPlace {
  near,  ///< both upper corners next to a wall; else the node nearest to what it leads to
  top,   ///< the middle of a block's top, else the node nearest to it
  feet,  ///< every corner of the base
};

struct FixingTraits {
  FixingKind kind;
  const char* word;
  Anchor::Type type;
  FixingPlace place;
  double stiffness;  ///< N/m, of each point
  double strength;   ///< N, of each point
  double preload;    ///< N, what it holds at the start; of a pole a push
  double lift;       ///< m, by which it lifts the corners of the base that are farthest from the wall; less
                     ///< where the body leans on the wall before; what bears is the contact. 0: an anchor
  double reach;      ///< m, greatest distance that it bridges
  bool pin;          ///< holds in all directions at one point (anchor.h), else along its line
  bool to_wall, to_floor, to_ceiling, to_body;
  const char* about;  ///< a line for the reference
};
/// A new one is a FixingKind and a row here.
inline constexpr FixingTraits k_fixings[] = {
    {.kind = FixingKind::l_bracket,
     .word = "L-bracket",
     .type = Anchor::Type::bracket,
     .place = FixingPlace::near,
     .stiffness = 300e3,
     .strength = 1.5e3,
     .preload = 0,
     .lift = 0,
     .reach = 0.1,
     .pin = false,
     .to_wall = true,
     .to_floor = true,
     .to_ceiling = false,
     .to_body = true,
     .about = "holds both ways across the gap"},
    {.kind = FixingKind::strap,
     .word = "strap",
     .type = Anchor::Type::strap,
     .place = FixingPlace::near,
     .stiffness = 50e3,
     .strength = 1e3,
     .preload = 0,
     .lift = 0,
     .reach = 0.1,
     .pin = false,
     .to_wall = true,
     .to_floor = true,
     .to_ceiling = false,
     .to_body = true,
     .about = "pulls only"},
    {.kind = FixingKind::pole,
     .word = "pole",
     .type = Anchor::Type::pole,
     .place = FixingPlace::top,
     .stiffness = 20e3,
     .strength = 2e3,
     .preload = 200,
     .lift = 0,
     .reach = 1.5,
     .pin = false,
     .to_wall = false,
     .to_floor = false,
     .to_ceiling = true,
     .to_body = false,
     .about = "pushes only, between the top and the ceiling"},
    {.kind = FixingKind::mat,
     .word = "mat",
     .type = Anchor::Type::strap,
     .place = FixingPlace::feet,
     .stiffness = 200e3,
     .strength = 300,
     .preload = 0,
     .lift = 0,
     .reach = 0.1,
     .pin = true,
     .to_wall = false,
     .to_floor = true,
     .to_ceiling = false,
     .to_body = true,
     .about = "sticks every corner of the base to the floor or the body below"},
    {.kind = FixingKind::stopper,
     .word = "stopper",
     .type = Anchor::Type::pole,
     .place = FixingPlace::feet,
     .stiffness = 0,
     .strength = 0,
     .preload = 0,
     .lift = 10e-3,
     .reach = 0.5,
     .pin = false,
     .to_wall = true,
     .to_floor = true,
     .to_ceiling = false,
     .to_body = false,
     .about = "wedges under the side away from its wall, or the nearest, and leans the body towards it"},
    {.kind = FixingKind::connector,
     .word = "connector",
     .type = Anchor::Type::bracket,
     .place = FixingPlace::near,
     .stiffness = 1e6,
     .strength = 2e3,
     .preload = 0,
     .lift = 0,
     .reach = 0.1,
     .pin = true,
     .to_wall = false,
     .to_floor = false,
     .to_ceiling = false,
     .to_body = true,
     .about = "bolts two bodies to each other: holds in all directions"},
};
inline const FixingTraits& traits(FixingKind kind) {
  return row_of(k_fixings, kind);
}

}  // namespace topple::io
