// Doors and places of a scene.
#include "scene_samples.h"

namespace topple::io {
namespace {

// A block of 400 by 500 mm, its surface 10 mm outside; lines 1 to 12, what is appended begins in line 13.
const std::string k_room =
    "topple = 1\n"
    "[floor]\n"
    "[[wall]]\n"
    "name = \"back\"\n"
    "at = [-2, 0]\n"
    "normal = [1, 0, 0]\n"
    "[[wall]]\n"
    "name = \"side\"\n"
    "at = [0, 2]\n"
    "normal = [0, -1, 0]\n"
    "[[block]]\n"
    "name = \"safe\"\n"
    "size = [0.4, 0.5, 0.6]\nmass = 100\nwidth = 0.02\n";

std::string room_error(const std::string& lines) {
  return error_of(k_room + lines);
}

std::string door(const std::string& wall, const std::string& at, const std::string& width) {
  return "[[door]]\nname = \"door\"\nwall = \"" + wall + "\"\nat = " + at + "\nwidth = " + width + "\n";
}

std::string place(const std::string& at) {
  return "[[place]]\nname = \"desk\"\nat = " + at + "\n";
}

TEST(SceneRoom, doors_and_places_stand_where_they_are_written) {
  const Room room =
      parse_scene(k_room + door("side", "-1.2", "0.9") + place("[-1, 0.5]"), "s.toml").setup.room;
  ASSERT_EQ(room.doors.size(), 1u);
  EXPECT_EQ(room.doors[0].wall, 1);
  EXPECT_EQ(room.person, 0.5);
  // to the left of who looks along -y lies +x
  EXPECT_LT((room.jamb(room.doors[0], 0) - Vec2(-1.65, 2)).norm(), 1e-12);
  EXPECT_LT((room.jamb(room.doors[0], 1) - Vec2(-0.75, 2)).norm(), 1e-12);
  EXPECT_EQ(room.places[0].at, Vec2(-1, 0.5));
}

TEST(SceneRoom, a_door_is_in_a_wall) {
  EXPECT_EQ(room_error(door("front", "0", "0.9")),
            "s.toml:18:8: door.door.wall: there is no wall \"front\"; known: back, side");
  EXPECT_EQ(room_error(door("back", "1.7", "0.9")),
            "s.toml:20:9: door.door.width: reaches 150 mm beyond wall \"side\", where \"back\" ends");
  EXPECT_EQ(room_error(door("back", "0", "\"20 m\"")),
            "s.toml:20:9: door.door.width: \"20 m\" is outside 100..10000 mm");
  EXPECT_EQ(room_error(door("back", "0", "0.9") + "[[door]]\nwall = \"back\"\nat = 0.8\nwidth = 1\n"),
            "s.toml:23:6: door.2.at: is in the way of door \"door\"");
  EXPECT_EQ(room_error("[[door]]\nat = 0\nwidth = 1\n"), "s.toml:16:1: door.1.wall: missing (a [[wall]])");
}

TEST(SceneRoom, a_person_stands_in_the_room_with_space_around) {
  EXPECT_EQ(room_error(place("[-2.3, 0]")),
            "s.toml:18:6: place.desk.at: lies outside the room, 300 mm behind wall \"back\"");
  EXPECT_EQ(room_error(place("[-1.8, 0]")),
            "s.toml:18:6: place.desk.at: is 200 mm from wall \"back\"; a person is 500 mm wide");
  EXPECT_EQ(
      room_error(place("[0.1, 0.1]")),
      "s.toml:18:6: place.desk.at: lies inside \"safe\", which is 620 mm high; up to 600 mm one lies on it");
  EXPECT_EQ(room_error(place("[0.41, 0]")),
            "s.toml:18:6: place.desk.at: is 200 mm from \"safe\"; a person is 500 mm wide");
  EXPECT_EQ(room_error(place("[0.47, 0]")), "no error");
  EXPECT_EQ(room_error(place("[0.47, 0]") + "[run]\nperson = \"0.6 m\"\n"),
            "s.toml:18:6: place.desk.at: is 260 mm from \"safe\"; a person is 600 mm wide");
}

TEST(SceneRoom, a_person_lies_on_what_is_low) {
  const Scene scene = parse_scene(k_room + place("[0.1, 0.1]"), "s.toml", {"block.1.size=[0.4, 0.5, 0.4]"});
  EXPECT_EQ(scene.setup.room.places[0].on, 0);
  EXPECT_NEAR(scene.setup.room.places[0].top, 0.42, 1e-12);
  const Scene beside = parse_scene(k_room + place("[0.47, 0]"), "s.toml", {"block.1.size=[0.4, 0.5, 0.4]"});
  EXPECT_EQ(beside.setup.room.places[0].on, -1);
}

TEST(SceneRoom, names_are_used_once) {
  EXPECT_NE(room_error(place("[1, 0]") + place("[1, 1]")).find("\"desk\" is used twice"), std::string::npos);
}

}  // namespace
}  // namespace topple::io
