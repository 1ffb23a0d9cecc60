// What a person does to a room, as changes of its scene's text: comments and lines that are not concerned
// stay as they were written.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/picture/room_piece.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

// Each returns the text of the changed scene, which may be one that does not load: io::parse_scene tells.
// They throw io::InputError, in the language of the window, where the text has no place for what is wanted.

/// A floor, two walls that meet, a bookshelf against one of them, shaken by a built-in record.
std::string new_room();

/// The name that a new piece of this kind gets: "bookshelf-2" beside a "bookshelf".
std::string fresh_name(const io::Scene& scene, const std::string& kind);

/// A new [[furniture]] called fresh_name().
std::string with_piece(const io::Scene& scene, const std::string& kind, const Spot& spot);

/// The piece at `spot`. One that stood against a wall or beside another piece stands `at` a place from then
/// on; one of several copies that is turned becomes an entry of its own. Only furniture, cabinets and blocks
/// can turn; a piece that an [[anchor]] holds stays.
std::string with_moved(const io::Scene& scene, const RoomPiece& piece, const Spot& spot);

/// Without the piece, and without what held it; what stood beside it stays where it is.
std::string without_piece(const io::Scene& scene, const RoomPiece& piece);

/// A second one like it at `spot`, called fresh_name().
std::string with_copy(const io::Scene& scene, const RoomPiece& piece, const Spot& spot);

/// The key of the piece's entry, and of its copies, becomes `value`, TOML; absent: the key is taken out.
/// `key` may be "contents.mass".
std::string with_value(const io::Scene& scene, const RoomPiece& piece, std::string_view key,
                       const std::optional<std::string>& value);

/// The piece under another name, by which all others know it too.
std::string with_name(const io::Scene& scene, const RoomPiece& piece, const std::string& name);

/// A wall through two places, its face towards where most pieces stand. Places nearer than 100 mm are
/// refused.
std::string with_wall(const io::Scene& scene, const Vec2& from, const Vec2& to);
/// Without the wall, its doors and what is fixed to it; what stood against it stays where it is.
std::string without_wall(const io::Scene& scene, const std::string& name);

inline constexpr double k_usual_ceiling = 2.5;  // m
/// The ceiling at this height, m; absent: none, and no poles.
std::string with_ceiling(const io::Scene& scene, const std::optional<double>& height);

/// A [[fixing]] of this kind from a body to a wall, the floor, the ceiling or another body; a ceiling where
/// there is none is k_usual_ceiling high.
std::string with_fixing(const io::Scene& scene, const std::string& kind, const std::string& body,
                        const std::string& to);

/// Where a door stands that is put near a place.
struct DoorSpot {
  std::string wall;
  double at;           ///< m, as of Room::Door, in steps of k_grid
  Vec2 middle, along;  ///< m, of the opening; unit, along the wall
};
inline constexpr double k_usual_door = 0.8;  // m, the opening
/// In the nearest wall; nothing: there is none.
std::optional<DoorSpot> door_near(const Model& model, const Vec2& place);
/// A [[door]] there, k_usual_door wide.
std::string with_door(const io::Scene& scene, const DoorSpot& spot);
/// Door `number`, from 1, so wide, m.
std::string with_door_width(const io::Scene& scene, std::size_t number, double width);
/// A [[place]] where a person stands.
std::string with_person(const io::Scene& scene, const Vec2& at);

/// Without entry `number`, from 1, of `table`: a fixing, door or place.
std::string without_entry(const io::Scene& scene, const std::string& table, std::size_t number);

/// "380 mm": a length in m as scenes write it.
std::string length_text(double metres);

}  // namespace topple::app
