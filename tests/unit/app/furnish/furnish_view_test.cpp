// A person furnishes a room with mouse and keyboard.
#include "app/furnish/furnish_view.h"

#include "app/furnish/room_edits.h"
#include "app/picture/furnish_words.h"
#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;

class FurnishTest : public ShellTest {
 protected:
  void SetUp() override {
    shell_->furnish_new_room();
    frames(30);  // the palette draws a picture a frame
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) frame();
  }
  FurnishView& view() { return *shell_->room(); }
  Furnishing& room() { return view().room(); }
  ImVec2 pixel(const Vec2& at) {
    const auto found = view().pixel_of_floor(at);
    return found ? ImVec2(found->x(), found->y()) : ImVec2(-1, -1);
  }
  void move_to(ImVec2 at) {
    ImGui::GetIO().MousePos = at;
    frames(2);
  }
  void click_floor(const Vec2& at) {
    click_at(pixel(at), [this] { frame(); });
  }
  void place(const std::string& kind, const Vec2& at) {
    view().arm_kind(kind);
    click_floor(at);
    if (!room().refused().empty() || view().armed())
      throw std::runtime_error("not placed: " + room().refused());
  }
  void drag(ImVec2 from, ImVec2 to) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = from;
    frames(2);
    io.MouseDown[0] = true;
    frames(2);
    for (int i = 1; i <= 5; ++i) {
      const float u = static_cast<float>(i) / 5;
      io.MousePos = {from.x + u * (to.x - from.x), from.y + u * (to.y - from.y)};
      frame();
    }
    frames(2);
    io.MouseDown[0] = false;
    frames(3);
  }
  /// Where a place in the room is seen.
  ImVec2 pixel(const Vec3& place) {
    const Box& box = view().scene_box();
    const auto found =
        pixel_of(view().orbit().camera(box.width / box.height), box.width, box.height, place.cast<float>());
    return {found->x(), found->y()};
  }
  /// In place of what the field of the selected piece has.
  void type_into_field(const Phrase& words, const std::string& text) {
    ImGuiWindow* side = nullptr;
    for (ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows)
      if (std::string_view(window->Name).starts_with("side/content")) side = window;
    ASSERT_NE(side, nullptr);
    const ImGuiID id = ImHashStr("##value", 0, ImHashStr(std::string(words.english).c_str(), 0, side->ID));
    ImGuiIO& io = ImGui::GetIO();
    for (float y = side->Pos.y; y < side->Pos.y + side->Size.y && ImGui::GetHoveredID() != id; y += 8) {
      io.MousePos = {side->Pos.x + 0.6f * side->Size.x, y};
      frames(2);
    }
    ASSERT_EQ(ImGui::GetHoveredID(), id);
    click_at(io.MousePos, [this] { frame(); });
    tap(GLFW_KEY_A, true);
    type(text);
  }
  ImVec2 middle_of(const RoomPiece& piece) {
    return pixel(Vec3(piece.spot.at.x(), piece.spot.at.y(), piece.floor + piece.size.z() / 2));
  }
};

TEST_F(FurnishTest, a_click_in_the_palette_and_one_in_the_room_place_a_piece) {
  click_at({view().scene_box().width + 60, 90}, [this] { frame(); });
  ASSERT_TRUE(view().armed());
  move_to(pixel(Vec2(0.5, -0.5)));
  ASSERT_TRUE(view().ghost_spot());
  EXPECT_LT((view().ghost_spot()->at - Vec2(0.5, -0.5)).norm(), 0.02);
  click_floor({0.5, -0.5});
  ASSERT_EQ(room().pieces().size(), 2u) << room().refused();
  EXPECT_FALSE(view().armed());
  EXPECT_EQ(view().selected(), room().pieces().back().name);
  EXPECT_LT((room().pieces().back().spot.at - Vec2(0.5, -0.5)).norm(), 0.02);
}

TEST_F(FurnishTest, a_view_that_is_asked_for_before_the_room_is_laid_out_is_taken_then) {
  shell_->furnish_new_room();
  view().press({'3'});
  frames(3);
  EXPECT_TRUE(view().orbit().target.allFinite());
  EXPECT_NEAR(view().orbit().sight.elevation, k_pi / 2, 0.01);  // from above
}

TEST_F(FurnishTest, the_ghost_is_red_where_the_reader_refuses_the_piece) {
  view().arm_kind("refrigerator");
  move_to(pixel(Vec2(-1.75, 0.0)));  // in the bookshelf
  EXPECT_TRUE(until([&] { return view().ghost_is_red(); }));
  click_floor({-1.75, 0.0});
  EXPECT_EQ(room().pieces().size(), 1u);
  EXPECT_NE(room().refused().find("overlap"), std::string::npos) << room().refused();
  EXPECT_TRUE(view().armed());
  move_to(pixel(Vec2(0.5, -1)));
  EXPECT_TRUE(until([&] { return !view().ghost_is_red(); }));
}

TEST_F(FurnishTest, a_piece_is_dragged_and_every_step_can_be_taken_back) {
  place("chest", {0.6, -0.6});
  const std::string before = room().text();
  const RoomPiece chest = *room().piece("chest");
  const ImVec2 from = middle_of(chest);
  const ImVec2 was = pixel(chest.spot.at), wanted = pixel(Vec2(0.2, 0.4));
  drag(from, {from.x + wanted.x - was.x, from.y + wanted.y - was.y});
  EXPECT_GT((room().piece("chest")->spot.at - chest.spot.at).norm(), 0.3) << room().refused();
  EXPECT_EQ(view().selected(), "chest");
  press('Z', true);
  EXPECT_EQ(room().text(), before);
  press('Y', true);
  EXPECT_NE(room().text(), before);
}

TEST_F(FurnishTest, keys_move_turn_copy_and_remove_what_is_selected) {
  place("chest", {0.5, -0.5});
  press('1');  // from the front: y to the right, x towards the viewer
  const Spot spot = room().piece("chest")->spot;
  press(render::key::right);
  EXPECT_LT((room().piece("chest")->spot.at - spot.at - Vec2(0, 0.01)).norm(), 1e-9);
  shell_->press({render::key::down, false, true});
  frames(2);
  EXPECT_LT((room().piece("chest")->spot.at - spot.at - Vec2(0.1, 0.01)).norm(), 1e-9);
  press('Q');
  EXPECT_NEAR(room().piece("chest")->spot.yaw, spot.yaw + 15 * k_pi / 180, 1e-9);
  press('E');
  EXPECT_NEAR(room().piece("chest")->spot.yaw, spot.yaw, 1e-9);
  press('D', true);
  ASSERT_EQ(room().pieces().size(), 3u) << room().refused();
  EXPECT_EQ(view().selected(), "chest-2");
  press(render::key::del);
  EXPECT_EQ(room().pieces().size(), 2u);
  EXPECT_FALSE(room().piece("chest-2"));
}

TEST_F(FurnishTest, a_number_that_was_typed_is_taken_when_its_field_is_left_but_not_after_escape) {
  connect_keyboard();
  place("chest", {0.5, -0.5});
  click("Selected", "side");
  const double x = room().piece("chest")->spot.at.x();
  const ImVec2 bookshelf = middle_of(*room().piece("bookshelf"));
  type_into_field(fw::k_x, "0.8");
  tap(GLFW_KEY_ESCAPE);
  EXPECT_EQ(room().piece("chest")->spot.at.x(), x);
  type_into_field(fw::k_x, "0.8");
  EXPECT_EQ(room().piece("chest")->spot.at.x(), x) << "not while it is typed";
  const RoomPiece other = *room().piece("bookshelf");
  click_at(bookshelf, [this] { frame(); });
  EXPECT_EQ(view().selected(), "bookshelf");
  EXPECT_EQ(room().piece("chest")->spot.at.x(), 0.8) << room().refused();
  EXPECT_EQ(room().piece("bookshelf")->spot.at, other.spot.at);
  view().select("chest");
  frames(2);
  type_into_field(fw::k_x, "0.6");
  click("Room", "side");  // drawn before the field
  EXPECT_EQ(room().piece("chest")->spot.at.x(), 0.6) << room().refused();
}

TEST_F(FurnishTest, two_clicks_make_a_wall_and_two_a_fixing) {
  view().arm_wall();
  click_floor({-1, -1.2});
  click_floor({1, -1.2});
  EXPECT_EQ(room().scene().setup.model.planes.size(), 4u) << room().refused();
  view().arm_fixing("L-bracket");
  click_at(middle_of(*room().piece("bookshelf")), [this] { frame(); });
  EXPECT_TRUE(view().armed());
  click_at(pixel(Vec3(-2, 1.2, 0.8)), [this] { frame(); });  // on the wall behind it
  EXPECT_FALSE(view().armed()) << room().refused();
  EXPECT_EQ(room().scene().setup.model.anchors.size(), 2u);
  view().arm_wall();
  click_floor({1, 1});
  click_floor({1, 1});
  EXPECT_NE(room().refused().find("no length"), std::string::npos) << room().refused();
}

TEST_F(FurnishTest, a_door_stands_in_the_wall_that_is_clicked_and_a_person_on_the_floor) {
  view().arm_person();
  click_floor({-1.8, 0});  // behind the bookshelf
  EXPECT_NE(room().refused().find("wall \"back\""), std::string::npos) << room().refused();
  click_floor({0.5, -0.5});
  EXPECT_FALSE(view().armed()) << room().refused();
  view().arm_door();
  click_at(pixel(Vec3(-2, -1, 0.8)), [this] { frame(); });
  EXPECT_FALSE(view().armed()) << room().refused();
  const Room& plan = room().scene().setup.room;
  ASSERT_EQ(plan.places.size(), 1u);
  ASSERT_EQ(plan.doors.size(), 1u);
  EXPECT_LT((plan.places[0].at - Vec2(0.5, -0.5)).norm(), 0.02);
  EXPECT_EQ(plan.walls[static_cast<std::size_t>(plan.doors[0].wall)].name, "back");
  EXPECT_NEAR(((plan.jamb(plan.doors[0], 0) + plan.jamb(plan.doors[0], 1)) / 2).y(), -1, 0.02);
  click("Room", "side");
  frames(2);
  click("x##place 0", "side");
  frames(2);
  EXPECT_TRUE(room().scene().setup.room.places.empty());
  press('Z', true);
  EXPECT_EQ(room().scene().setup.room.places.size(), 1u);
}

TEST_F(FurnishTest, a_room_is_shaken_and_the_run_before_it_stays_as_a_ghost) {
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  EXPECT_EQ(shell_->session()->scene().text, new_room());
  player().play();
  ASSERT_TRUE(until([&] { return player().time() > 0.1; }));
  press(render::key::f2);
  ASSERT_TRUE(shell_->furnishing());
  place("desk", {0.6, -0.4});
  const std::string text = room().text();
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  EXPECT_EQ(shell_->session()->scene().text, text);
  EXPECT_TRUE(shell_->session()->viewer().ghost_shown());
  press(render::key::f2);
  press('Z', true);
  EXPECT_EQ(room().text(), new_room()) << "undo reaches behind the run";
}

TEST_F(FurnishTest, a_room_that_was_changed_stays_so_beside_its_run) {
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  run_to(0.1);
  const Viewer& viewer = shell_->session()->viewer();
  press(render::key::f2);
  press(render::key::f2);
  EXPECT_EQ(viewer.note(), "");
  press(render::key::f2);
  place("desk", {0.6, -0.4});
  const std::string text = room().text();
  place("chair", {0.6, 0.6});
  press('Z', true);
  press(render::key::f2);
  ASSERT_FALSE(shell_->furnishing());
  EXPECT_EQ(shell_->session()->scene().text, new_room());
  EXPECT_EQ(viewer.note(),
            "the run of the room before it was changed; F2, then Space, runs the changed room");
  press(render::key::f2);
  EXPECT_EQ(room().text(), text);
  EXPECT_TRUE(room().can_redo());
  press(render::key::f2);
  player().edit({Edit::Key::friction, 0, Vec3(0.45, 0, 0)});
  press(render::key::f2);
  EXPECT_TRUE(room().piece("desk"));
  EXPECT_NE(room().text().find("friction = 0.45"), std::string::npos) << room().text();
  press('Z', true);
  EXPECT_EQ(room().text(), text);
  press('Y', true);
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  EXPECT_EQ(shell_->session()->scene().setup.parameters.contact.friction, 0.45);
  EXPECT_EQ(shell_->session()->scene().setup.model.furniture_total(), 2);
  press(render::key::f2);
  press(render::key::f2);
  EXPECT_EQ(shell_->session()->viewer().note(), "");
}

TEST_F(FurnishTest, the_room_of_a_file_stays_changed_beside_its_run) {
  shell_->open(write("own.toml", new_room()));
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  press(render::key::f2);
  ASSERT_TRUE(view().change([](const io::Scene& s) { return with_piece(s, "desk", {{0.6, -0.4}, 0}); }));
  const std::string text = room().text();
  for (int i = 0; i < 2; ++i) press(render::key::f2);
  EXPECT_EQ(room().text(), text);
  press('Z', true);
  for (int i = 0; i < 2; ++i) press(render::key::f2);
  EXPECT_EQ(room().text(), new_room());
  EXPECT_TRUE(room().can_redo());
  shell_->furnish_new_room();
  ASSERT_TRUE(view().change([](const io::Scene& s) { return with_piece(s, "chair", {{0.6, -0.4}, 0}); }));
  for (int i = 0; i < 2; ++i) press(render::key::f2);
  EXPECT_TRUE(room().piece("chair")) << "a new room beside a run stays, too";
}

TEST_F(FurnishTest, a_pale_run_tells_what_was_changed_on_its_way) {
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  const auto words = [&] { return EarlierRun(shell_->session()->scene_ptr(), player()).in_words(); };
  const std::string plain = "pale: the run before the room was changed";
  run_to(0.1);
  EXPECT_EQ(words(), plain);
  player().edit({Edit::Key::friction, 0, Vec3(0.45, 0, 0)});
  run_to(player().time() + 0.05);
  EXPECT_TRUE(words().starts_with(plain + "; on its way it was given other values: contact.friction (0."))
      << words();
}

TEST_F(FurnishTest, a_new_room_has_no_run_before_it) {
  const auto shake = [&] {
    press(' ');
    ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
    run_to(0.1);
  };
  shell_->open(write("rocking.toml", k_rocking));
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  run_to(0.1);
  shell_->furnish_new_room();
  frames(30);
  shake();
  EXPECT_FALSE(shell_->session()->viewer().shows_earlier());
  press(render::key::f2);
  place("desk", {0.6, -0.4});
  shake();
  EXPECT_TRUE(shell_->session()->viewer().shows_earlier());
  press(render::key::f2);
  shake();  // the same once more
  EXPECT_TRUE(shell_->session()->viewer().shows_earlier());
  press(render::key::f2);
  view().begin_new_room();
  frames(2);
  shake();
  EXPECT_FALSE(shell_->session()->viewer().shows_earlier());
}

TEST_F(FurnishTest, a_room_that_is_in_no_file_comes_back_from_a_demo_with_its_run) {
  place("desk", {0.6, -0.4});
  press(' ');
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  run_to(0.1);
  const std::string run = shell_->session()->recording(), text = shell_->session()->scene().text;
  ASSERT_FALSE(run.empty());
  shell_->session()->viewer().show(Viewer::Tab::teach);
  click(std::string(demos()[0].name.english) + "##demo0", "side/content");
  ASSERT_TRUE(until([&] { return shell_->session()->viewer().teaching().guide.has_value(); }));
  ASSERT_TRUE(until([&] { return shell_->session()->viewer().teaching().guide->step() == 0; }));
  click("Back to my-room##back", "side/content");
  ASSERT_TRUE(until([&] { return shell_->session()->scene().text == text; }));
  EXPECT_FALSE(shell_->message().has_value());
  EXPECT_TRUE(until([&] { return player().can_continue() || player().end() > 0.05; }));
}

TEST_F(FurnishTest, a_room_is_saved_as_it_is_written) {
  place("desk", {0.6, -0.4});
  const std::string path = (scratch_ / "mine.toml").string();
  save_as(path);
  EXPECT_EQ(read(path), room().text());
}

TEST_F(FurnishTest, what_was_not_saved_stands_among_the_recent_files) {
  place("desk", {0.6, -0.4});
  const std::string text = room().text();
  shell_->open(write("rocking.toml", k_rocking));
  ASSERT_TRUE(until([&] { return !shell_->furnishing() && ready(); }));
  const std::vector<std::string> recent = recent_files();
  ASSERT_EQ(recent.size(), 2u);
  EXPECT_EQ(read(recent.at(1)), text);
}

TEST_F(FurnishTest, a_scene_is_furnished_with_its_comments_and_its_sliders) {
  shell_->open(write("own.toml", "# mine\n" + new_room()));
  ASSERT_TRUE(until([&] { return ready(); }));
  player().edit({Edit::Key::friction, 0, Vec3(0.45, 0, 0)});
  ASSERT_TRUE(until([&] { return player().parameters_so_far().contact.friction == 0.45; }));
  press(render::key::f2);
  ASSERT_TRUE(shell_->furnishing());
  EXPECT_TRUE(room().text().starts_with("# mine\n# A room of your own."));
  EXPECT_NE(room().text().find("friction = 0.45"), std::string::npos) << room().text();
}

TEST_F(FurnishTest, the_last_piece_and_a_bad_file_are_refused_in_the_words_of_the_reader) {
  view().select("bookshelf");
  press(render::key::del);
  EXPECT_NE(room().refused().find("there are no bodies"), std::string::npos) << room().refused();
  EXPECT_EQ(room().text(), new_room());
  const std::string file =
      write("bad-shelf.toml", "topple = 1\n[kind]\nsource = \"x\"\n[[block]]\nsize = [1, 1]\n");
  EXPECT_FALSE(room().change([&](const io::Scene& s) { return with_piece(s, file, {{1, 0}, 0}); }));
  EXPECT_NE(room().refused().find("bad-shelf.toml:5:8"), std::string::npos) << room().refused();
}

TEST_F(FurnishTest, an_export_beside_it_takes_no_clicks) {
  shell_->exports().add({"render", "nonsense"}, (scratch_ / "x.png").string(), ExportJob::Makes::file);
  ASSERT_TRUE(until([&] { return !shell_->exports().busy(); }));
  ASSERT_FALSE(shell_->exports().empty());  // it stands there with what became of it
  place("chest", {0.5, 0});
  EXPECT_EQ(view().selected(), "chest");
}

TEST_F(FurnishTest, a_wall_that_goes_with_its_fixings_and_doors_says_so) {
  ASSERT_TRUE(view().change([](const io::Scene& scene) {
    return scene.text +
           "\n[[fixing]]\nkind = \"L-bracket\"\nbody = \"bookshelf\"\nto = \"back\"\n"
           "\n[[door]]\nwall = \"back\"\nat = 0\nwidth = \"800 mm\"\n";
  })) << room().refused();
  frames(2);
  const std::size_t held = room().scene().setup.model.anchors.size();
  ASSERT_GT(held, 0u);
  click("Room", "side");
  frames(2);
  click("x##back", "side");
  frames(2);
  EXPECT_LT(room().scene().setup.model.anchors.size(), held);
  EXPECT_TRUE(room().scene().setup.room.doors.empty());
  EXPECT_TRUE(view().message().starts_with("What was fixed to back")) << view().message();
}

}  // namespace
}  // namespace topple::app
