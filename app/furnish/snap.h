// Where a piece comes to stand that is put near a wall or another piece.
#pragma once

#include <optional>
#include <span>

#include "app/picture/room_piece.h"

namespace topple::app {

inline constexpr double k_grid = 0.010;          // m
inline constexpr double k_gap_at_wall = 0.010;   // m, as that of `against`
inline constexpr double k_gap_at_piece = 0.060;  // m, as that of `beside`: within 50 mm bodies are in contact
inline constexpr double k_snap_reach = 0.12;     // m, of walls and pieces

/// A rectangle in plan.
struct Footprint {
  Spot spot;
  Vec2 half = Vec2::Zero();  ///< m, half of depth (along the front) and width
};

/// Half of its extent along a unit direction, m.
double half_along(const Footprint& of, const Vec2& direction);

/// A wall in plan; `normal` is a unit vector into the room.
struct WallLine {
  Vec2 at, normal;
};
/// Of the upright planes of a model.
std::vector<WallLine> wall_lines(const Model& model);

/// Its back is at a wall.
bool backs_wall(const Footprint& piece, std::span<const WallLine> walls);

/// Where a piece comes to stand that would reach into walls, or nearer than k_gap_at_wall: off them.
Vec2 off_walls(const Footprint& piece, std::span<const WallLine> walls);

/// Moves a piece out of walls, else at most k_snap_reach in each direction: to k_gap_at_wall from a wall, to
/// k_gap_at_piece from another piece with backs, fronts or middles in line, else to the grid. `turns`: one
/// whose back can come to a wall that near turns its back to it.
Spot snapped(const Footprint& piece, std::span<const Footprint> others, std::span<const WallLine> walls,
             bool turns);

}  // namespace topple::app
