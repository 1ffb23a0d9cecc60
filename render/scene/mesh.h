// Triangles of a SceneFrame's beams, arrows, lines and panels.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "render/scene/scene_frame.h"

namespace topple::render {

/// What a picture lacks because its numbers were not finite, too large, or pointed outside the
/// frame's arrays.
struct LeftOut {
  int tubes = 0;
  int panels = 0;
  int grounds = 0;
  int arrows = 0;
  int rings = 0;
  int trails = 0;
  int bands = 0;
  int trace_points = 0;
  int legends = 0;
  int total() const {
    return tubes + panels + grounds + arrows + rings + trails + bands + trace_points + legends;
  }
};

struct Vertex {
  Eigen::Vector3f position;  ///< m
  Eigen::Vector3f normal;    ///< unit
  float at = 0;              ///< position on the colour map, 0..1
  std::uint32_t rgba = 0;    ///< own colour (bytes red, green, blue, alpha); alpha 0: from the map
};

/// Consecutive indices of a mesh.
struct IndexRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from outside
  std::vector<IndexRange> tubes;       ///< of each of the frame's tubes; empty where it is left out
};

/// Beams as swept sections with end caps, and rings. Counts what it leaves out in `left_out`.
Mesh solid_mesh(const SceneFrame& frame, LeftOut& left_out);

/// The frame's arrows as shafts with heads.
Mesh arrow_mesh(const SceneFrame& frame, LeftOut& left_out);

/// The frame's trails as ribbons that face `eye`. thickness: m for each metre from it.
Mesh trail_mesh(const SceneFrame& frame, const Eigen::Vector3f& eye, float thickness, LeftOut& left_out);

/// The frame's bands, translucent, with outlines as trails have them. Seen from both sides.
Mesh band_mesh(const SceneFrame& frame, const Eigen::Vector3f& eye, float thickness, LeftOut& left_out);

/// The frame's ghosts, as solid_mesh sweeps its tubes.
Mesh ghost_mesh(const SceneFrame& frame, LeftOut& left_out);

/// The insides of shells about the highlighted member, or about all members of the highlighted body, for an
/// outline: what of them the members do not cover is seen around them. thickness: m for each metre from
/// `eye`.
Mesh shell_mesh(const SceneFrame& frame, const Eigen::Vector3f& eye, float thickness, const Float4& colour);

/// Corner of a panel: `normal` is the panel's, `uv` runs over 0..1 along its edges.
struct PanelVertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  Eigen::Vector2f uv;
};

/// Two triangles (six vertices) a panel, the farthest from `eye` first.
std::vector<PanelVertex> panel_mesh(const SceneFrame& frame, const Eigen::Vector3f& eye, LeftOut& left_out);

/// Triangles of a simple closed outline, counter-clockwise, as indices into it; empty when it has
/// fewer than three corners.
std::vector<std::uint32_t> triangulated(const std::vector<std::array<float, 2>>& outline);

}  // namespace topple::render
