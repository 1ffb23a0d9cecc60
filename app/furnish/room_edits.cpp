#include "app/furnish/room_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <set>
#include <vector>

#include "app/picture/furnish_words.h"
#include "solver/io/common/units.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/edit/scene_rewrite.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;
using io::KeyChange;
using io::Node;
using io::written_text;

constexpr double k_shortest_wall = 0.1;  // m
constexpr double k_same_turn = 1e-6;     // rad

/// Keys of an entry by which it has its place and its name.
constexpr std::string_view k_place_keys[] = {"name",   "at",     "yaw", "against",
                                             "offset", "beside", "gap", "copies"};

std::string metres_text(double x) {
  return fmt::format("{:g}", std::round(1e4 * x) / 1e4 + 0.);  // no -0
}

std::string degrees_text(double yaw) {
  const double degrees = std::round(1e3 * std::remainder(yaw, 2 * k_pi) * 180 / k_pi) / 1e3 + 0.;
  return fmt::format("\"{:g} deg\"", degrees == -180 ? 180 : degrees);
}

std::string place_text(const Vec2& at, double floor) {
  return floor == 0
             ? fmt::format("[{}, {}]", metres_text(at.x()), metres_text(at.y()))
             : fmt::format("[{}, {}, {}]", metres_text(at.x()), metres_text(at.y()), metres_text(floor));
}

bool same_turn(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * k_pi)) < k_same_turn;
}

/// Of an entry of `copies`, m.
Vec3 translation(const Node& copy) {
  Vec3 by;
  for (std::size_t k = 0; k < 3; ++k) {
    const Node& one = copy.items.at(k).value;
    by[static_cast<int>(k)] =
        one.is_number() ? one.real : io::parse_quantity(one.text, io::Dimension::length).si.value_or(0);
  }
  return by;
}

/// The changes of one action, made one after the other.
class Changes {
 public:
  explicit Changes(const io::Scene& scene) : scene_(scene), root_(io::parse_toml(scene.text, scene.name)) {}

  const Node& root() const { return root_; }
  std::size_t entries(std::string_view table) const {
    const Node* const list = root_.find(table);
    return list ? list->items.size() : 0;
  }
  const Node& entry(std::string_view table, std::size_t number) const {
    return root_.find(table)->items.at(number - 1).value;
  }
  void set(std::vector<std::string> path, const std::optional<std::string>& value) {
    all_.push_back({std::move(path), value});
  }
  void set(const std::string& table, std::size_t number, std::string_view key,
           const std::optional<std::string>& value) {
    if (value || entry(table, number).find(key))
      set({table, std::to_string(number), std::string(key)}, value);
  }
  void add_entry(const std::string& table, const std::string& value) {
    set({table, std::to_string(entries(table) + 1)}, value);
  }
  /// All entries for which `gone` holds, the last first: numbers of the others stay until then.
  template <class Gone>
  void remove_entries(const std::string& table, Gone gone) {
    for (std::size_t number = entries(table); number >= 1; --number)
      if (gone(entry(table, number))) set({table, std::to_string(number)}, std::nullopt);
  }
  /// As it stands now, without leaning on a wall or another piece. `piece`: the first copy, if any.
  void stay(const RoomPiece& piece) {
    Spot spot = piece.spot;
    if (const Node* const copies = entry(piece.table, piece.number).find("copies"))
      spot.at -= translation(copies->items.front().value).head<2>();
    stand(piece, spot);
  }
  /// Its entry at a place of its own.
  void stand(const RoomPiece& piece, const Spot& spot) {
    const Node& node = entry(piece.table, piece.number);
    for (const char* const key : {"against", "offset", "beside", "gap"})
      set(piece.table, piece.number, key, std::nullopt);
    set(piece.table, piece.number, "at", place_text(spot.at, piece.floor));
    const Node* const yaw = node.find("yaw");
    if (yaw || !same_turn(spot.yaw, 0)) set(piece.table, piece.number, "yaw", degrees_text(spot.yaw));
  }
  std::string text() const { return io::rewrite_toml(scene_.text, all_); }

 private:
  const io::Scene& scene_;
  const Node root_;
  std::vector<KeyChange> all_;
};

/// `stem`, or the first of "stem-2", "stem-3" ... that no entry of these tables is called, and that is not
/// `taken`.
std::string free_name(const Changes& changes, std::initializer_list<const char*> tables,
                      const std::string& stem, std::set<std::string> taken = {}) {
  for (const char* const table : tables)
    for (std::size_t k = 1; k <= changes.entries(table); ++k) {
      const Node* const written = changes.entry(table, k).find("name");
      taken.insert(written ? written->text : fmt::format("{}-{}", table, k));
    }
  std::string name = stem;
  for (int number = 2; taken.contains(name); ++number) name = fmt::format("{}-{}", stem, number);
  return name;
}

bool says(const Node& entry, std::string_view key, const std::string& word) {
  const Node* const found = entry.find(key);
  return found && found->kind == Node::Kind::text && found->text == word;
}

bool holds(const Node& fixing, const std::string& name) {
  return says(fixing, "body", name) || says(fixing, "to", name) || says(fixing, "to_body", name);
}

/// Its name counts for other entries: names of further copies change with their number.
bool is_named_elsewhere(const Changes& changes, const std::string& name) {
  for (const char* const table : {"fixing", "anchor", "probe"})
    for (std::size_t k = 1; k <= changes.entries(table); ++k)
      if (holds(changes.entry(table, k), name)) return true;
  return false;
}

void refuse_held(const Changes& changes, const RoomPiece& piece) {
  for (std::size_t k = 1; k <= changes.entries("anchor"); ++k)
    if (holds(changes.entry("anchor", k), piece.name))
      throw io::InputError(
          say(fw::k_is_anchored, piece.name, io::entry_label(*changes.root().find("anchor"), k - 1)));
}

/// All keys of an entry but those of its place, as an inline table with these before and behind them.
std::string entry_like(const Node& entry, const std::string& name, const std::string& behind) {
  std::string text;
  for (const io::Item& item : entry.items)
    if (std::ranges::find(k_place_keys, item.key) == std::end(k_place_keys))
      text += (text.empty() ? "" : ", ") + item.key + " = " + written_value(item.value);
  // a piece is told by its kind first
  const auto first = entry.find("kind") ? text.find(", ") : std::string::npos;
  const std::string named = "name = " + written_text(name);
  if (first == std::string::npos || !text.starts_with("kind"))
    text = named + (text.empty() ? "" : ", ") + text;
  else
    text.insert(first, ", " + named);
  return "{ " + text + ", " + behind + " }";
}

std::string stand_text(const RoomPiece& piece, const Spot& spot) {
  return "at = " + place_text(spot.at, piece.floor) +
         (same_turn(spot.yaw, 0) ? "" : ", yaw = " + degrees_text(spot.yaw));
}

/// Unnamed pieces are called by their number among those of their kind: they get the names that they have
/// now.
void keep_names(const io::Scene& scene, Changes& changes, const RoomPiece& gone) {
  for (const RoomPiece& piece : pieces_of(scene))
    if (piece.table == gone.table && piece.number > gone.number && piece.kind == gone.kind &&
        piece.copy.value_or(0) == 0 && !changes.entry(piece.table, piece.number).find("name"))
      changes.set(piece.table, piece.number, "name", written_text(piece.name));
}

void take_out_copy(Changes& changes, const RoomPiece& piece) {
  changes.set({piece.table, std::to_string(piece.number), "copies", std::to_string(*piece.copy + 1)},
              std::nullopt);
}

std::size_t copies_of(const Changes& changes, const RoomPiece& piece) {
  return piece.copy ? changes.entry(piece.table, piece.number).find("copies")->items.size() : 1;
}

/// Copies behind it would be called by other names.
void refuse_renaming(const io::Scene& scene, const Changes& changes, const RoomPiece& piece) {
  for (const RoomPiece& other : pieces_of(scene))
    if (other.table == piece.table && other.number == piece.number && *other.copy >= *piece.copy &&
        is_named_elsewhere(changes, other.name))
      throw io::InputError(say(fw::k_copy_is_held, piece.name, other.name));
}

}  // namespace

std::string length_text(double metres) {
  return fmt::format("\"{:g} mm\"", std::round(1e4 * metres) / 10 + 0.);
}

std::string new_room() {
  return R"(# A room of your own. `topple check FILE` says what is wrong in it; keys are in the scene reference.
topple = 1
title = "My room"
shake = [{ name = "ground", type = "record", files = ["near-fault.csv"] }]

[run]
duration = "10 s"
want = ["motion"]

[floor]

[[wall]]
name = "back"
at = [-2, 0]
normal = [1, 0, 0]

[[wall]]
name = "side"
at = [0, 2]
normal = [0, -1, 0]

[[furniture]]
kind = "bookshelf"
name = "bookshelf"
against = "back"
)";
}

std::string fresh_name(const io::Scene& scene, const std::string& kind) {
  std::set<std::string> taken;
  for (const Body& body : scene.setup.model.bodies) taken.insert(body.name);
  const std::string stem = io::kind_stem(kind);
  std::string name = stem;
  for (int number = 2; taken.contains(name); ++number) name = fmt::format("{}-{}", stem, number);
  return name;
}

std::string with_piece(const io::Scene& scene, const std::string& kind, const Spot& spot) {
  Changes changes(scene);
  changes.add_entry("furniture", fmt::format("{{ kind = {}, name = {}, {} }}", written_text(kind),
                                             written_text(fresh_name(scene, kind)), stand_text({}, spot)));
  return changes.text();
}

std::string with_moved(const io::Scene& scene, const RoomPiece& piece, const Spot& spot) {
  Changes changes(scene);
  refuse_held(changes, piece);
  const bool turned = !same_turn(spot.yaw, piece.spot.yaw);
  if (turned && piece.table == "frame") throw io::InputError(say(fw::k_frame_turns_not, piece.name));
  const std::vector<Room::Place>& places = scene.setup.room.places;
  for (std::size_t p = 0; p < places.size(); ++p)  // who lies on it goes along
    if (places[p].on == static_cast<int>(piece.body)) {
      const Vec2 arm = Eigen::Rotation2Dd(spot.yaw - piece.spot.yaw) * (places[p].at - piece.spot.at);
      changes.set("place", p + 1, "at", place_text(spot.at + arm, 0));
    }
  const std::string number = std::to_string(piece.number);
  const Node& entry = changes.entry(piece.table, piece.number);
  if (piece.copy && (!turned || copies_of(changes, piece) > 1)) {
    if (turned) {
      refuse_renaming(scene, changes, piece);
      take_out_copy(changes, piece);
      changes.add_entry(piece.table,
                        entry_like(entry, fresh_name(scene, piece.kind.empty() ? piece.table : piece.kind),
                                   stand_text(piece, spot)));
      return changes.text();
    }
    Vec3 by = translation(entry.find("copies")->items.at(*piece.copy).value);
    by.head<2>() += spot.at - piece.spot.at;
    changes.set({piece.table, number, "copies", std::to_string(*piece.copy + 1)},
                fmt::format("[{}, {}, {}]", metres_text(by.x()), metres_text(by.y()), metres_text(by.z())));
    return changes.text();
  }
  if (piece.table == "frame") {
    const Vec2 by = spot.at - piece.spot.at;
    changes.set(piece.table, piece.number, "copies",
                fmt::format("[[{}, {}, 0]]", metres_text(by.x()), metres_text(by.y())));
    return changes.text();
  }
  if (piece.copy) changes.set(piece.table, piece.number, "copies", std::nullopt);
  changes.stand(piece, spot);
  return changes.text();
}

std::string without_piece(const io::Scene& scene, const RoomPiece& piece) {
  Changes changes(scene);
  const bool one_of_many = copies_of(changes, piece) > 1;
  if (one_of_many) refuse_renaming(scene, changes, piece);
  for (const RoomPiece& other : pieces_of(scene))
    if (other.table == "furniture" && other.copy.value_or(0) == 0 &&
        says(changes.entry(other.table, other.number), "beside", piece.name))
      changes.stay(other);
  for (const char* const table : {"fixing", "anchor", "probe"})
    changes.remove_entries(table, [&](const Node& entry) { return holds(entry, piece.name); });
  if (one_of_many) {
    take_out_copy(changes, piece);
  } else {
    keep_names(scene, changes, piece);
    changes.set({piece.table, std::to_string(piece.number)}, std::nullopt);
  }
  return changes.text();
}

std::string with_copy(const io::Scene& scene, const RoomPiece& piece, const Spot& spot) {
  Changes changes(scene);
  const Node& entry = changes.entry(piece.table, piece.number);
  if (piece.table == "frame") {
    const Vec2 by = spot.at - piece.spot.at;
    const std::string copy = fmt::format("[{}, {}, 0]", metres_text(by.x()), metres_text(by.y()));
    if (!piece.copy)
      changes.set(piece.table, piece.number, "copies", "[[0, 0, 0], " + copy + "]");
    else
      throw io::InputError(say(fw::k_frame_copied, piece.name));
    return changes.text();
  }
  changes.add_entry(piece.table,
                    entry_like(entry, fresh_name(scene, piece.kind.empty() ? piece.table : piece.kind),
                               stand_text(piece, spot)));
  return changes.text();
}

std::string with_value(const io::Scene& scene, const RoomPiece& piece, std::string_view key,
                       const std::optional<std::string>& value) {
  Changes changes(scene);
  const std::string number = std::to_string(piece.number);
  const auto dot = key.find('.');
  if (dot == std::string_view::npos) {
    changes.set(piece.table, piece.number, key, value);
    return changes.text();
  }
  const std::string outer(key.substr(0, dot)), inner(key.substr(dot + 1));
  const Node* const table = changes.entry(piece.table, piece.number).find(outer);
  if (table && !value && table->items.size() == 1)
    changes.set(piece.table, piece.number, outer, std::nullopt);
  else if (table && (value || table->find(inner)))
    changes.set({piece.table, number, outer, inner}, value);
  else if (value)
    changes.set(piece.table, piece.number, outer, "{ " + inner + " = " + *value + " }");
  return changes.text();
}

std::string with_name(const io::Scene& scene, const RoomPiece& piece, const std::string& name) {
  Changes changes(scene);
  if (copies_of(changes, piece) > 1) throw io::InputError(say(fw::k_copies_share_name, piece.name));
  keep_names(scene, changes, piece);
  changes.set(piece.table, piece.number, "name", written_text(name));
  for (const char* const table : {"fixing", "anchor", "probe", "furniture"})
    for (std::size_t k = 1; k <= changes.entries(table); ++k)
      for (const char* const key : {"body", "to", "to_body", "beside"})
        if (says(changes.entry(table, k), key, piece.name)) changes.set(table, k, key, written_text(name));
  return changes.text();
}

std::string with_wall(const io::Scene& scene, const Vec2& from, const Vec2& to) {
  Changes changes(scene);
  const double length = (to - from).norm();
  if (!(length >= k_shortest_wall)) throw io::InputError(say(fw::k_wall_too_short, 1e3 * length));
  const Vec2 along = (to - from) / length;
  Vec2 normal(-along.y(), along.x());
  double side = 0;
  for (const RoomPiece& piece : pieces_of(scene)) side += std::copysign(1., normal.dot(piece.spot.at - from));
  if (side < 0) normal = -normal;
  for (double& x : normal) x = std::round(1e6 * x) / 1e6 + 0.;
  const Vec2 at = (from + to) / 2;
  std::set<std::string> taken{"floor", "ceiling"};
  for (const Plane& plane : scene.setup.model.planes) taken.insert(plane.name);
  for (const Body& body : scene.setup.model.bodies) taken.insert(body.name);
  std::string name = "wall";
  for (int number = 2; taken.contains(name); ++number) name = fmt::format("wall-{}", number);
  changes.add_entry("wall", fmt::format("{{ name = {}, at = {}, normal = [{:g}, {:g}, 0] }}",
                                        written_text(name), place_text(at, 0), normal.x(), normal.y()));
  return changes.text();
}

std::string without_wall(const io::Scene& scene, const std::string& name) {
  Changes changes(scene);
  for (const RoomPiece& piece : pieces_of(scene))
    if (piece.table == "furniture" && piece.copy.value_or(0) == 0 &&
        says(changes.entry(piece.table, piece.number), "against", name))
      changes.stay(piece);
  changes.remove_entries("fixing", [&](const Node& entry) { return says(entry, "to", name); });
  changes.remove_entries("door", [&](const Node& entry) { return says(entry, "wall", name); });
  const Node* const walls = changes.root().find("wall");
  for (std::size_t k = changes.entries("wall"); k >= 1; --k) {
    const Node* const written = walls->items[k - 1].value.find("name");
    if ((written ? written->text : fmt::format("wall-{}", k)) == name)
      changes.set({"wall", std::to_string(k)}, std::nullopt);
  }
  return changes.text();
}

std::string with_ceiling(const io::Scene& scene, const std::optional<double>& height) {
  Changes changes(scene);
  if (height) {
    changes.set({"ceiling", "at"}, length_text(*height));
  } else {
    changes.remove_entries("fixing", [](const Node& entry) { return says(entry, "to", "ceiling"); });
    changes.set({"ceiling"}, std::nullopt);
  }
  return changes.text();
}

std::string with_fixing(const io::Scene& scene, const std::string& kind, const std::string& body,
                        const std::string& to) {
  Changes changes(scene);
  std::set<std::string> points;  // of fixings, "wardrobe-L-bracket-1"
  for (const Anchor& anchor : scene.setup.model.anchors) points.insert(anchor.name);
  const std::string name = free_name(changes, {"fixing", "anchor"}, body + "-" + kind, std::move(points));
  changes.add_entry("fixing",
                    fmt::format("{{ name = {}, kind = {}, body = {}, to = {} }}", written_text(name),
                                written_text(kind), written_text(body), written_text(to)));
  if (to == "ceiling" && !changes.root().find("ceiling"))
    changes.set({"ceiling", "at"}, length_text(k_usual_ceiling));
  return changes.text();
}

std::optional<DoorSpot> door_near(const Model& model, const Vec2& place) {
  std::optional<DoorSpot> found;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Plane& plane : model.planes) {
    const Vec2 level = plane.normal.head<2>();
    if (level.norm() < 0.5) continue;
    const Room::Wall wall{plane.name, plane.point.head<2>(), level.normalized()};
    const double away = std::abs(Room::before(wall, place));
    if (away >= nearest) continue;
    nearest = away;
    const double at = std::round(wall.along().dot(place - wall.at) / k_grid) * k_grid;
    found = {wall.name, at, wall.at + at * wall.along(), wall.along()};
  }
  return found;
}

std::string with_door(const io::Scene& scene, const DoorSpot& spot) {
  Changes changes(scene);
  changes.add_entry("door",
                    fmt::format("{{ name = {}, wall = {}, at = {}, width = {} }}",
                                written_text(free_name(changes, {"door"}, "door")), written_text(spot.wall),
                                metres_text(spot.at), length_text(k_usual_door)));
  return changes.text();
}

std::string with_door_width(const io::Scene& scene, std::size_t number, double width) {
  Changes changes(scene);
  changes.set("door", number, "width", length_text(width));
  return changes.text();
}

std::string with_person(const io::Scene& scene, const Vec2& at) {
  Changes changes(scene);
  changes.add_entry(
      "place", fmt::format("{{ name = {}, at = {} }}", written_text(free_name(changes, {"place"}, "person")),
                           place_text(at, 0)));
  return changes.text();
}

std::string without_entry(const io::Scene& scene, const std::string& table, std::size_t number) {
  Changes changes(scene);
  changes.set({table, std::to_string(number)}, std::nullopt);
  return changes.text();
}

}  // namespace topple::app
