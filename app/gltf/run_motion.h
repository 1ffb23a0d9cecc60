// A run as tracks of numbers over time: what an animated model is made of.
#pragma once

#include <optional>
#include <vector>

#include "app/gltf/key_frames.h"
#include "app/picture/replay.h"
#include "app/picture/run_extent.h"
#include "render/scene/scene_frame.h"
#include "solver/io/export/exported_values.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Place, m, and rotation from the reference pose.
struct PoseTrack {
  Track place{3}, turn{4, true};
};

inline constexpr float k_own_colour = -1;  ///< in place of a position on the colour map

struct RunMotion {
  RunExtent extent;
  std::vector<float> times;       ///< s, rising; a static run: its part of the way
  std::vector<bool> deforms;      ///< of each body: whether it ever does
  std::vector<bool> breaks;       ///< of each element, likewise
  Track floor{3};                 ///< m, in the picture's frame
  std::vector<PoseTrack> bodies;  ///< of their centres of gravity, in the picture's frame
  std::vector<PoseTrack> nodes;   ///< in the body's frame, where the body deforms; else empty
  /// Of each member, at its colour places: where stress lies on the colour map, 0..1, or k_own_colour.
  std::vector<Track> colours;
  render::Legend legend;         ///< of the colours; without a quantity when none is on the map
  render::SceneFrame reference;  ///< all bodies in their reference pose, with elements that break in halves
};

/// The station of a member, counted from 0 as in a picture of it that is not rigid, whose colour is its
/// `k`-th: all of them, of a member with many those at every so many ends of elements.
int colour_place(const Member& member, std::size_t k);

/// Of all rows of `replay` that are finite, or of every so many as export_gltf.h says. None when `proceed`
/// gave it up. Throws InputError when there is no such row, or one of another model.
std::optional<RunMotion> run_motion(const io::Scene& scene, const Replay& replay, const io::Proceed& proceed);

}  // namespace topple::app
