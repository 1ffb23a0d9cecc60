#include "app/furnish/room_edits.h"

#include <gtest/gtest.h>

#include "app/furnish/furnishing.h"
#include "solver/io/scene/scene_file.h"

namespace topple::app {
namespace {

const std::string k_room = R"(# My room
topple = 1
[floor]
[[wall]]   # behind
name = "back"
at = [-2, 0]
normal = [1, 0, 0]

[[furniture]]
kind = "bookshelf"        # from my grandmother
against = "back"

[[furniture]]
kind = "refrigerator"
beside = "bookshelf"

# twins
[[furniture]]
name = "chest"
kind = "chest"
copies = [[1, -1, 0], [1, 1, 0]]
)";

io::Scene scene_of(const std::string& text) {
  return io::parse_scene(text, "room.toml");
}

RoomPiece piece_in(const io::Scene& scene, const std::string& name) {
  for (const RoomPiece& piece : pieces_of(scene))
    if (piece.name == name) return piece;
  throw std::runtime_error("no " + name);
}

/// Every line of `before` but these stands in `after`, in this order.
void expect_kept(const std::string& before, const std::string& after,
                 const std::vector<std::string>& but = {}) {
  std::istringstream lines(before);
  std::size_t at = 0;
  for (std::string line; std::getline(lines, line);) {
    if (std::ranges::find(but, line) != but.end()) continue;
    const std::size_t found = after.find(line + "\n", at);
    ASSERT_NE(found, std::string::npos) << "lost: " << line << "\n" << after;
    at = found + line.size();
  }
}

TEST(RoomPieces, stand_where_the_model_has_them) {
  const io::Scene scene = scene_of(k_room);
  const std::vector<RoomPiece> pieces = pieces_of(scene);
  ASSERT_EQ(pieces.size(), 4u);
  for (const RoomPiece& piece : pieces) {
    const Body& body = scene.setup.model.bodies[piece.body];
    EXPECT_EQ(piece.name, body.name);
    EXPECT_LT((body.base_centre.head<2>() - piece.spot.at).norm(), 1e-9) << piece.name;
    EXPECT_NEAR(2 * piece.half.x(), piece.size.x(), 1e-9) << piece.name;
    EXPECT_NEAR(2 * piece.half.y(), piece.size.y(), 1e-9) << piece.name;
  }
  EXPECT_EQ(piece_in(scene, "chest-2").copy, 1u);
}

TEST(RoomEdits, a_new_room_loads_and_has_somewhere_to_stand) {
  const io::Scene scene = scene_of(new_room());
  EXPECT_EQ(scene.setup.model.planes.size(), 3u);
  EXPECT_EQ(pieces_of(scene).size(), 1u);
  EXPECT_FALSE(scene.setup.parameters.shakes.empty());
}

TEST(RoomEdits, a_piece_is_placed_with_kind_name_and_place_alone) {
  const std::string text = with_piece(scene_of(k_room), "bookshelf", {{1.25, -0.3}, k_pi / 2});
  expect_kept(k_room, text);
  EXPECT_NE(text.find("[[furniture]]\nkind = \"bookshelf\"\nname = \"bookshelf-2\"\nat = [1.25, -0.3]\nyaw = "
                      "\"90 deg\"\n"),
            std::string::npos)
      << text;
}

TEST(RoomEdits, a_moved_piece_stands_at_a_place_of_its_own) {
  const io::Scene scene = scene_of(k_room);
  const Spot spot{{-0.6, 2.2}, -k_pi / 4};
  const std::string text = with_moved(scene, piece_in(scene, "bookshelf"), spot);
  expect_kept(k_room, text, {"against = \"back\""});
  const io::Scene after = scene_of(text);
  EXPECT_LT((piece_in(after, "bookshelf").spot.at - spot.at).norm(), 1e-9);
  EXPECT_NEAR(piece_in(after, "bookshelf").spot.yaw, spot.yaw, 1e-9);
}

TEST(RoomEdits, one_of_several_copies_moves_alone_and_turns_into_an_entry_of_its_own) {
  const io::Scene scene = scene_of(k_room);
  const std::string moved = with_moved(scene, piece_in(scene, "chest-2"), {{0.5, 1.5}, 0});
  expect_kept(k_room, moved, {"copies = [[1, -1, 0], [1, 1, 0]]"});
  EXPECT_NE(moved.find("copies = [[1, -1, 0], [0.5, 1.5, 0]]"), std::string::npos) << moved;
  const std::string turned = with_moved(scene, piece_in(scene, "chest-2"), {{1, 1}, k_pi / 2});
  const io::Scene after = scene_of(turned);
  EXPECT_EQ(pieces_of(after).size(), 4u);
  EXPECT_LT((piece_in(after, "chest").spot.at - Vec2(1, -1)).norm(), 1e-9);
  EXPECT_NEAR(piece_in(after, "chest-3").spot.yaw, k_pi / 2, 1e-9);
  EXPECT_LT((piece_in(after, "chest-3").spot.at - Vec2(1, 1)).norm(), 1e-9);
}

TEST(RoomEdits, what_stood_beside_a_removed_piece_stays_where_it_is) {
  const io::Scene scene = scene_of(with_fixing(scene_of(k_room), "L-bracket", "bookshelf", "back"));
  const RoomPiece before = piece_in(scene, "refrigerator");
  const std::string text = without_piece(scene, piece_in(scene, "bookshelf"));
  const io::Scene after = scene_of(text);
  EXPECT_EQ(pieces_of(after).size(), 3u);
  EXPECT_TRUE(after.setup.model.anchors.empty());
  EXPECT_LT((piece_in(after, "refrigerator").spot.at - before.spot.at).norm(), 1e-4);
  expect_kept(k_room, text,
              {"[[furniture]]", "kind = \"bookshelf\"        # from my grandmother", "against = \"back\"",
               "beside = \"bookshelf\""});
}

TEST(RoomEdits, names_of_others_outlive_a_removed_piece_of_their_kind) {
  std::string text = "topple = 1\n[floor]\n";
  for (const char* const y : {"-2", "0", "2"})
    text += "[[furniture]]\nkind = \"chest\"\nat = [0, " + std::string(y) + "]\n";
  const io::Scene scene = scene_of(text);
  const io::Scene after = scene_of(without_piece(scene, piece_in(scene, "chest")));
  EXPECT_LT((piece_in(after, "chest-2").spot.at - Vec2(0, 0)).norm(), 1e-9);
  EXPECT_LT((piece_in(after, "chest-3").spot.at - Vec2(0, 2)).norm(), 1e-9);
}

TEST(RoomEdits, one_of_several_copies_is_removed_alone) {
  const io::Scene scene = scene_of(k_room);
  const io::Scene after = scene_of(without_piece(scene, piece_in(scene, "chest")));
  EXPECT_EQ(pieces_of(after).size(), 3u);
  EXPECT_LT((piece_in(after, "chest").spot.at - Vec2(1, 1)).norm(), 1e-9);
}

TEST(RoomEdits, a_copy_has_all_but_place_and_name) {
  const io::Scene sized =
      scene_of(with_value(scene_of(k_room), piece_in(scene_of(k_room), "bookshelf"), "mass", "\"35 kg\""));
  const io::Scene after = scene_of(with_copy(sized, piece_in(sized, "bookshelf"), {{1, 0}, 0}));
  EXPECT_EQ(piece_in(after, "bookshelf-2").mass, 35);
  EXPECT_LT((piece_in(after, "bookshelf-2").spot.at - Vec2(1, 0)).norm(), 1e-9);
}

TEST(RoomEdits, values_are_set_and_taken_back_to_the_kind) {
  const io::Scene scene = scene_of(k_room);
  const RoomPiece piece = piece_in(scene, "bookshelf");
  const std::string text = with_value(scene, piece, "contents.mass", "\"60 kg\"");
  expect_kept(k_room, text);
  EXPECT_EQ(piece_in(scene_of(text), "bookshelf").contents, 60);
  EXPECT_EQ(with_value(scene_of(text), piece, "contents.mass", std::nullopt), k_room);
}

TEST(RoomEdits, a_renamed_piece_is_known_to_all_by_its_new_name) {
  const io::Scene scene = scene_of(with_fixing(scene_of(k_room), "L-bracket", "bookshelf", "back"));
  const io::Scene after = scene_of(with_name(scene, piece_in(scene, "bookshelf"), "books"));
  EXPECT_EQ(after.setup.model.bodies[static_cast<std::size_t>(after.setup.model.anchors.at(0).body)].name,
            "books");
  EXPECT_NO_THROW(piece_in(after, "refrigerator"));
}

TEST(RoomEdits, a_wall_looks_at_the_furniture_and_goes_with_what_it_holds) {
  const io::Scene scene = scene_of(k_room);
  const io::Scene walled = scene_of(with_wall(scene, {-2, 2.5}, {3, 2.5}));
  const Plane& wall = walled.setup.model.planes.back();
  EXPECT_EQ(wall.name, "wall");
  EXPECT_LT((wall.normal - Vec3(0, -1, 0)).norm(), 1e-9);
  EXPECT_NEAR(wall.point.y(), 2.5, 1e-9);
  EXPECT_THROW(with_wall(scene, {1, 1}, {1, 1.05}), io::InputError);
  const io::Scene held = scene_of(with_fixing(walled, "strap", "bookshelf", "back"));
  const io::Scene open = scene_of(without_wall(held, "back"));
  EXPECT_EQ(open.setup.model.planes.size(), 2u);
  EXPECT_TRUE(open.setup.model.anchors.empty());
  EXPECT_LT((piece_in(open, "bookshelf").spot.at - piece_in(scene, "bookshelf").spot.at).norm(), 1e-4);
}

TEST(RoomEdits, a_pole_brings_its_ceiling_and_goes_with_it) {
  const io::Scene scene = scene_of(k_room);
  const std::string text = with_fixing(scene, "pole", "refrigerator", "ceiling");
  EXPECT_EQ(scene_of(text).setup.model.anchors.size(), 1u);
  EXPECT_TRUE(scene_of(with_ceiling(scene_of(text), std::nullopt)).setup.model.anchors.empty());
}

TEST(RoomEdits, an_anchored_piece_stays) {
  const io::Scene scene =
      scene_of(k_room +
               "[[anchor]]\nname = \"strap\"\nbody = \"chest\"\npoint = [0.78, -1, 0.99]\nto = [0.7, -1, "
               "0.99]\nstiffness = \"50 kN/m\"\n");
  EXPECT_THROW(with_moved(scene, piece_in(scene, "chest"), {{0, 0}, 0}), io::InputError);
}

TEST(Furnishing, what_the_reader_refuses_leaves_the_room_as_it_was) {
  Furnishing room(scene_of(k_room), "room.toml");
  const RoomPiece fridge = *room.piece("refrigerator");
  EXPECT_FALSE(room.change([&](const io::Scene& s) { return with_moved(s, fridge, {{1, 1}, 0}); }));
  EXPECT_NE(room.refused().find("overlap at the start"), std::string::npos) << room.refused();
  EXPECT_EQ(room.text(), k_room);
  EXPECT_FALSE(room.change([&](const io::Scene& s) { return with_moved(s, fridge, {{-3, 0}, 0}); }));
  EXPECT_NE(room.refused().find("within \"back\""), std::string::npos) << room.refused();
  EXPECT_FALSE(room.change([&](const io::Scene& s) { return with_value(s, fridge, "mass", "-1"); }));
  EXPECT_NE(room.refused().find("mass"), std::string::npos) << room.refused();
  EXPECT_FALSE(room.can_undo());
}

TEST(Furnishing, undo_and_redo_go_through_all_that_was) {
  Furnishing room(scene_of(k_room), "room.toml");
  std::vector<std::string> texts{room.text()};
  const auto act = [&](const RoomEdit& edit) {
    ASSERT_TRUE(room.change(edit)) << room.refused();
    texts.push_back(room.text());
  };
  act([](const io::Scene& s) { return with_piece(s, "desk", {{1, 2.5}, 0}); });
  act([](const io::Scene& s) { return with_wall(s, {-1, 4}, {1, 4}); });
  act([](const io::Scene& s) { return without_piece(s, piece_in(s, "desk")); });
  for (std::size_t k = texts.size() - 1; k-- > 0;) {
    room.undo();
    EXPECT_EQ(room.text(), texts[k]);
  }
  EXPECT_FALSE(room.can_undo());
  for (std::size_t k = 1; k < texts.size(); ++k) {
    room.redo();
    EXPECT_EQ(room.text(), texts[k]);
  }
  EXPECT_FALSE(room.can_redo());
}

TEST(Furnishing, what_is_loaded_for_a_run_is_the_text_itself) {
  Furnishing room(scene_of(k_room), "room.toml");
  const io::Scene scene = room.loader()();
  EXPECT_EQ(scene.text, k_room);
  EXPECT_EQ(scene.setup.parameters.models, scene_of(k_room).setup.parameters.models);
}

TEST(RoomEdits, a_door_goes_into_the_nearest_wall_at_its_foot) {
  const io::Scene scene =
      scene_of(k_room + "[[wall]]\nname = \"side\"\nat = [0.5, 2]\nnormal = [0, -1, 0]\n");
  const auto back = door_near(scene.setup.model, {-1.9, 1.203});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->wall, "back");
  EXPECT_NEAR(back->at, 1.2, 1e-12);  // in steps of 10 mm
  EXPECT_LT((back->middle - Vec2(-2, 1.2)).norm(), 1e-12);
  const auto side = door_near(scene.setup.model, {1.5, 1.9});
  ASSERT_TRUE(side);
  const std::string text = with_door(scene, *side);
  expect_kept(k_room, text);
  const Room room = scene_of(text).setup.room;
  ASSERT_EQ(room.doors.size(), 1u);
  EXPECT_LT(((room.jamb(room.doors[0], 0) + room.jamb(room.doors[0], 1)) / 2 - Vec2(1.5, 2)).norm(), 1e-9);
  EXPECT_NEAR(room.doors[0].width, k_usual_door, 1e-12);
  EXPECT_NEAR(scene_of(with_door_width(scene_of(text), 1, 0.9)).setup.room.doors[0].width, 0.9, 1e-12);
  EXPECT_FALSE(door_near(scene_of("topple = 1\n[floor]\n[[furniture]]\nkind = \"chest\"\n").setup.model,
                         Vec2::Zero()));
}

TEST(RoomEdits, who_lies_on_a_bed_goes_along) {
  const io::Scene scene = scene_of(
      "topple = 1\n[floor]\n[[furniture]]\nkind = \"bed\"\nat = [0, 0]\n[[place]]\nname = \"sleeper\"\nat = "
      "[0.3, 0]\n"
      "[[place]]\nname = \"other\"\nat = [0, 3]\n");
  const io::Scene after = scene_of(with_moved(scene, piece_in(scene, "bed"), {{1, 0.5}, k_pi / 2}));
  ASSERT_EQ(after.setup.room.places.size(), 2u);
  EXPECT_LT((after.setup.room.places[0].at - Vec2(1, 0.8)).norm(), 1e-6);
  EXPECT_GE(after.setup.room.places[0].on, 0);
  EXPECT_EQ(after.setup.room.places[1].at, Vec2(0, 3));
}

TEST(RoomEdits, people_have_names_of_their_own_and_can_be_taken_away) {
  const std::string one = with_person(scene_of(k_room), {0.5, -0.25});
  expect_kept(k_room, one);
  const std::string two = with_person(scene_of(one), {1.5, 0.25});
  const Room room = scene_of(two).setup.room;
  ASSERT_EQ(room.places.size(), 2u);
  EXPECT_EQ(room.places[0].name, "person");
  EXPECT_EQ(room.places[1].name, "person-2");
  EXPECT_LT((room.places[1].at - Vec2(1.5, 0.25)).norm(), 1e-12);
  EXPECT_EQ(scene_of(without_entry(scene_of(two), "place", 1)).setup.room.places[0].name, "person-2");
}

}  // namespace
}  // namespace topple::app
