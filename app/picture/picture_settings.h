// What of a run a picture shows, and how.
#pragma once

#include <cstddef>
#include <optional>

#include "app/picture/beam_quantity.h"
#include "render/scene/colour_map.h"

namespace topple::app {

/// Where colours end: at the greatest value of this instant, at what few instants of the whole run exceed, or
/// at a number.
enum class RangePolicy { instant, run, fixed };

/// Paths behind bodies. second: of the last second; run: since the start.
enum class Trails { none, second, run };

/// How bodies are drawn.
enum class Bodies { beams, solid, both };
struct BodiesTraits {
  Bodies kind;
  const char* word;    ///< of `topple render --bodies`
  bool beams, boards;  ///< as computed, with their colours; as it looks in a room (solid_bodies.h)
};
inline constexpr BodiesTraits k_bodies_traits[] = {{Bodies::beams, "beams", true, false},
                                                   {Bodies::solid, "solid", false, true},
                                                   {Bodies::both, "both", true, true}};
constexpr const BodiesTraits& traits(Bodies bodies) {
  return k_bodies_traits[static_cast<int>(bodies)];
}

/// A section force drawn along a member.
struct Diagram {
  std::size_t member;
  std::optional<std::size_t> component;  ///< N, Vy, Vz, T, My, Mz; absent: the moment that is greatest now
};

inline constexpr int k_least_picture = 64, k_most_picture = 8192;  ///< px, of its sides
inline constexpr double k_most_exaggeration = 200;
inline constexpr double k_least_maximum = 1e-6, k_most_maximum = 1e12;  ///< of a fixed range

struct PictureSettings {
  BeamQuantity colour = BeamQuantity::stress;
  render::ColourMap map = render::ColourMap::viridis;  ///< of unsigned quantities
  RangePolicy range = RangePolicy::run;
  double maximum = 1;       ///< fixed: in the quantity's unit
  double exaggeration = 1;  ///< of deformation, 1..k_most_exaggeration
  bool contact_forces = false;
  bool alone = false;  ///< one picture of the run: an impact's arrows get a scale of their own
  bool panels = true;
  Bodies bodies = Bodies::beams;
  bool words = true;  ///< title, captions, labels, legend and the floor's curve
  Trails trails = Trails::none;
  std::optional<Diagram> diagram = {};
};

}  // namespace topple::app
