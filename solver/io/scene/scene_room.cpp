// Doors and places of a scene: keys and meaning.
#include <algorithm>
#include <cmath>
#include <span>

#include "solver/io/common/units.h"
#include "solver/io/scene/scene_key_rows.h"
#include "solver/io/scene/scene_read.h"
#include "solver/math/ranges.h"
#include "solver/run/ways.h"

namespace topple::io {
namespace {

constexpr double k_far = 1e3, k_widest_door = 10;  // m

std::string in_mm(double metres) {
  return short_number(std::round(1e4 * metres) / 10) + " mm";
}

void read_walls(const Entry& root, Room& room) {
  for (const Entry& entry : root.entries("wall")) {
    const std::vector<double> at = entry.numbers("at");
    const Vec3 normal = entry.direction("normal");
    const Vec2 level = normal.head<2>();
    if (level.norm() < 0.5) continue;  // a ramp
    room.walls.push_back({entry.name(), Vec2(at[0], at[1]), level.normalized()});
  }
}

int find_wall(const Entry& root, const Entry& entry, const Room& room) {
  const std::string name = entry.text("wall");
  const auto wall = ranges::find(room.walls, name, &Room::Wall::name);
  if (wall != room.walls.end()) return static_cast<int>(wall - room.walls.begin());
  for (const Entry& ramp : root.entries("wall"))
    if (ramp.name() == name)
      entry.fail("wall", "\"" + name + "\" does not stand upright: its normal leads up");
  std::string known;
  for (const Room::Wall& one : room.walls) known += (known.empty() ? "" : ", ") + one.name;
  entry.fail("wall", "there is no wall \"" + name + "\"; " +
                         (known.empty() ? "the scene has none" : "known: " + known));
}

/// The opening lies in the wall, and not in another door.
void check_opening(const Entry& entry, const Room& room, const Room::Door& door) {
  for (const Room::Wall& wall : room.walls) {
    if (&wall == &room.walls[static_cast<std::size_t>(door.wall)]) continue;
    const double reach =
        std::min(Room::before(wall, room.jamb(door, 0)), Room::before(wall, room.jamb(door, 1)));
    if (reach < -1e-9)
      entry.fail("width", "reaches " + in_mm(-reach) + " beyond wall \"" + wall.name + "\", where \"" +
                              room.walls[static_cast<std::size_t>(door.wall)].name + "\" ends");
  }
  for (const Room::Door& other : room.doors)
    if (other.wall == door.wall && 2 * std::abs(other.at - door.at) < other.width + door.width)
      entry.fail("at", "is in the way of door \"" + other.name + "\"");
}

double top_of(const Body& body, std::span<const Vec3> position) {
  double top = 0;
  for (const Vec3& x :
       position.subspan(static_cast<std::size_t>(body.first_node), static_cast<std::size_t>(body.node_count)))
    top = std::max(top, x.z());
  return top;
}

Room::Place read_place(const Entry& entry, const Room& room, const Model& model, const RoomPlan& plan,
                       std::span<const Vec3> position) {
  const std::vector<double> numbers = entry.numbers("at");
  const Vec2 at(numbers[0], numbers[1]);
  Room::Place place{entry.name(), at};
  const std::string person = "; a person is " + in_mm(room.person) + " wide";
  for (const Room::Wall& wall : room.walls) {
    const double before = Room::before(wall, at);
    if (before < 0)
      entry.fail("at", "lies outside the room, " + in_mm(-before) + " behind wall \"" + wall.name + "\"");
    if (2 * before < room.person)
      entry.fail("at", "is " + in_mm(before) + " from wall \"" + wall.name + "\"" + person);
  }
  for (std::size_t k = 0; k < plan.lying.size(); ++k) {
    const double space = plan.lying[k].distance(at);
    const Body& body = model.bodies[static_cast<std::size_t>(plan.body[k])];
    if (2 * space >= room.person) continue;
    const double top = top_of(body, position) + plan.lying[k].radius;
    if (space > 0) entry.fail("at", "is " + in_mm(space) + " from \"" + body.name + "\"" + person);
    if (top > k_lies_on || place.on >= 0)
      entry.fail("at", "lies inside \"" + body.name + "\", which is " + in_mm(top) + " high; up to " +
                           in_mm(k_lies_on) + " one lies on it");
    place.on = plan.body[k];
    place.top = top;
  }
  return place;
}

}  // namespace

void add_room_keys(std::vector<Key>& keys) {
  Rows doors(keys, "door");
  doors.plain("name", KeyType::text, "name in the summary").absent_means("door-1, ...");
  doors.plain("wall", KeyType::text, "a [[wall]]").required();
  doors
      .number("at", Dimension::length, "m", -k_far, k_far,
              "its middle, along the wall from the wall's `at`; positive to the left of who looks along the "
              "wall's normal, into the room: +y of a wall with its normal along +x")
      .required();
  doors.number("width", Dimension::length, "mm", 0.1, k_widest_door, "of the opening").required();
  Rows places(keys, "place");
  places.plain("name", KeyType::text, "name in the summary").absent_means("place-1, ...");
  places
      .numbers("at", 2, Dimension::length, "m", -k_far, k_far,
               "x and y of where a person is when the run begins: half of `run.person` from all that stands "
               "there, or on a piece no higher than 600 mm, as on a bed")
      .required();
}

void read_room(const Entry& root, Setup& setup) {
  Room& room = setup.room;
  room.person = root.entry("run").number("person");
  const std::vector<Entry> doors = root.entries("door"), places = root.entries("place");
  if (doors.empty() && places.empty()) return;
  read_walls(root, room);
  for (const Entry& entry : doors) {
    const Room::Door door{entry.name(), find_wall(root, entry, room), entry.number("at"),
                          entry.number("width")};
    check_opening(entry, room, door);
    room.doors.push_back(door);
  }
  const State start = start_state(setup.model, setup.starts);
  const RoomPlan plan = room_plan(room, setup.model, start.position);
  for (const Entry& entry : places)
    room.places.push_back(read_place(entry, room, setup.model, plan, start.position));
}

}  // namespace topple::io
