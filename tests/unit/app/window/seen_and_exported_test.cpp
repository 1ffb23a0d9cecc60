// What one sees, exports and takes along into another scene agrees.
#include "app/window/status_line.h"
#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

class SeenTest : public ShellTest {
 protected:
  std::string exported(const char* name) {
    press('E', true);
    ExportDialog& dialog = shell_->export_dialog();
    dialog.what = ExportDialog::What::picture;
    const std::string path = (scratch_ / name).string();
    path.copy(dialog.path, path.size());
    dialog.path[path.size()] = '\0';
    dialog.start(player(), shell_->session()->viewer(), shell_->session()->recording());
    EXPECT_EQ(dialog.refused(), "");
    EXPECT_TRUE(until([&] { return !shell_->exports().busy(); }));
    return read(path);
  }
};

TEST_F(SeenTest, the_ghost_of_the_branch_that_was_left_is_exported) {
  open_rocking();
  run_to(0.4);
  player().scrub(0.1);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  player().edit({Edit::Key::amplitude, 0, Vec3(900 * k_gal, 0, 0)});  // it goes elsewhere
  run_to(0.35);
  player().scrub(0.35);
  frame();
  ASSERT_TRUE(player().ghost().has_value());
  const std::string with = exported("with.png");
  shell_->session()->viewer().show_ghost(false);
  frame();
  EXPECT_NE(exported("without.png"), with);
  shell_->session()->viewer().show_ghost(true);
  frame();
  EXPECT_EQ(exported("again.png"), with);
}

TEST_F(SeenTest, another_scene_is_not_drawn_with_the_settings_of_the_last) {
  open_rocking();
  PictureSettings settings;
  settings.exaggeration = 4;
  shell_->session()->viewer().choose_settings(settings);
  shell_->open(write("other.toml", k_rocking));
  ASSERT_TRUE(until([&] { return ready() && shell_->title() == "topple: other"; }));
  EXPECT_EQ(shell_->session()->viewer().settings().exaggeration, 1);
}

TEST_F(SeenTest, back_to_the_start_goes_on_if_it_was_running) {
  open_rocking();
  for (int i = 0; i < 4; ++i) player().slower();
  player().play();
  ASSERT_TRUE(until([&] { return player().time() > 0.02; }));
  press('R');
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && !player().way().empty(); }));
  EXPECT_TRUE(player().playing());
  ASSERT_TRUE(until([&] { return player().time() > 0.02; }));
  player().pause();
  ASSERT_TRUE(until([&] { return ready(); }));
  press('R');
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 3 && ready(); }));
  EXPECT_FALSE(player().playing());
  EXPECT_EQ(player().time(), 0);
}

TEST_F(SeenTest, back_at_the_start_the_status_names_the_branch_that_runs_and_the_one_that_was_left) {
  open_rocking();
  const std::string paused = status_in_words(player());
  run_to(0.1);
  player().edit({Edit::Key::amplitude, 0, Vec3(900 * k_gal, 0, 0)});
  press('R');
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && ready(); }));
  EXPECT_EQ(status_in_words(player()),
            "Back at the start, with the sliders as they are. Space runs branch 1; the run so far is kept as "
            "branch 0.");
  run_to(0.1);
  EXPECT_EQ(status_in_words(player()), paused);
}

// As with a finger that stays where *Next* was: it takes every step, whatever is written of it.
TEST_F(SeenTest, next_stays_under_the_finger_and_space_after_end_is_the_run_s) {
  connect_keyboard();
  shell_->open("paper-a");
  ASSERT_TRUE(until([&] { return ready(); }));
  shell_->session()->viewer().show(Viewer::Tab::teach);
  click(std::string(demos()[0].name.english) + "##demo0", "side/content");
  const auto guide = [&]() -> const std::optional<DemoGuide>& {
    return shell_->session()->viewer().teaching().guide;
  };
  const auto stops_at = [&](std::size_t step) {
    return until([&] { return guide() && guide()->step() == step && !guide()->under_way(); });
  };
  ASSERT_TRUE(stops_at(0));
  click("Next##next", "side/content");
  ASSERT_TRUE(stops_at(1));
  EXPECT_EQ(player().speed(), 1);  // as it was before
  click_at(ImGui::GetIO().MousePos, [this] { frame(); });
  ASSERT_TRUE(stops_at(2));
  tap(GLFW_KEY_END);
  ASSERT_FALSE(player().playing());
  tap(GLFW_KEY_SPACE);
  EXPECT_TRUE(player().playing());
  EXPECT_TRUE(guide().has_value());
}

}  // namespace
}  // namespace topple::app
