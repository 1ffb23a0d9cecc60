// A room in plan: its walls, its doors, and where people are.
#pragma once

#include <string>
#include <vector>

#include "solver/math/convex.h"

namespace topple {

/// m: a person lies or sits on what is no higher.
inline constexpr double k_lies_on = 0.6;

/// Where the walls leave a side open, it is open: nobody leaves there, but everybody may walk there.
struct Room {
  struct Wall {
    std::string name;
    Vec2 at;      ///< m, a point of its face
    Vec2 normal;  ///< unit, into the room
    /// Unit, to the left of who looks into the room: +y of a wall with its normal along +x.
    Vec2 along() const { return {-normal.y(), normal.x()}; }
  };
  struct Door {
    std::string name;
    int wall;
    double at;     ///< m, of its middle, along() the wall from Wall::at
    double width;  ///< m
  };
  /// Where a person is when the run begins.
  struct Place {
    std::string name;
    Vec2 at;         ///< m
    int on = -1;     ///< the body on which they lie or sit, and over which they walk; -1: they stand
    double top = 0;  ///< m, its height
  };
  std::vector<Wall> walls;
  std::vector<Door> doors;
  std::vector<Place> places;
  double person = 0.5;  ///< m, width of a person: the disc that walks

  /// m, the ends of the opening: the first is the right one of who looks into the room.
  Vec2 jamb(const Door& door, int end) const {
    const Wall& wall = walls[static_cast<std::size_t>(door.wall)];
    return wall.at + (door.at + (end - 0.5) * door.width) * wall.along();
  }
  /// Places from which there might be a way out.
  std::size_t ways() const { return doors.empty() ? 0 : places.size(); }
  /// m, how far a point stands before the face of a wall; negative: behind it.
  static double before(const Wall& wall, const Vec2& point) { return wall.normal.dot(point - wall.at); }
};

}  // namespace topple
