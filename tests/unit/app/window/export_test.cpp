// Exporting beside the window, off screen, with mouse and keyboard fed by hand.
#include <cmath>

#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

class ExportDialogTest : public ShellTest {
 protected:
  void set_path(const std::string& name) {
    const std::string path = (scratch_ / name.c_str()).string();
    path.copy(dialog().path, path.size());
    dialog().path[path.size()] = '\0';
  }
  ExportDialog& dialog() { return shell_->export_dialog(); }
  Exports& exports() { return shell_->exports(); }
  const ExportJob* job() { return exports().empty() ? nullptr : exports().all().back().job.get(); }
  void start() { dialog().start(player(), shell_->session()->viewer(), shell_->session()->recording()); }
  void open_export(ExportDialog::What what) {
    press('E', true);
    ASSERT_TRUE(dialog().is_open());
    dialog().what = what;
    dialog().size[0] = 320;
    dialog().size[1] = 180;
  }
  std::string export_failure() {
    if (!dialog().refused().empty()) return dialog().refused();
    if (!until([&] { return !exports().busy(); })) return "it did not end";
    return exports().empty() ? "" : exports().all().back().failure;
  }
};

TEST_F(ExportDialogTest, a_picture_has_the_size_that_was_asked_for) {
  open_rocking();
  run_to(0.2);
  open_export(ExportDialog::What::picture);
  set_path("view.png");
  dialog().size[0] = 400;
  dialog().size[1] = 300;
  start();
  EXPECT_EQ(export_failure(), "");
  EXPECT_FALSE(dialog().is_open());
  const auto image = render::load_png(scratch_ / "view.png");
  ASSERT_TRUE(image.has_value());
  EXPECT_EQ(std::pair(image->width, image->height), std::pair(400, 300));
  open_export(ExportDialog::What::picture);
  set_path("view.png");
  start();
  EXPECT_NE(dialog().refused().find("view.png"), std::string::npos);  // it is there already
}

TEST_F(ExportDialogTest, numbers_that_cannot_be_drawn_are_refused_with_what_is_allowed) {
  open_rocking();
  run_to(0.2);
  open_export(ExportDialog::What::video);
  set_path("view.mp4");
  ExportDialog& d = dialog();
  const auto refused = [&] {
    start();
    return d.refused();
  };
  d.size[0] = 63;
  EXPECT_EQ(refused(), "Sides of a picture are 64 to 8192 px, not 63 × 180.");
  d.size[0] = 321;
  EXPECT_EQ(refused(), "Sides of a video are even numbers, not 321 × 180 px.");
  d.size[0] = 320;
  d.rate = 0;
  EXPECT_EQ(refused(), "A video has 1 to 240 pictures a second, not 0.");
  d.rate = 30;
  d.speed = std::nan("");
  EXPECT_EQ(refused(), "A video runs at 0.01562 to 8 times real time, not nan.");
  d.speed = 1;
  d.to = std::nan("");
  EXPECT_EQ(refused().find("Nothing lies between 0.00 and nan"), 0u) << d.refused();
  EXPECT_TRUE(exports().empty());
}

TEST_F(ExportDialogTest, its_buttons_stand_still_whatever_is_chosen_or_said) {
  open_rocking();
  run_to(0.2);
  open_export(ExportDialog::What::picture);
  const auto panel = [] {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
      if (window->WasActive && std::string(window->Name).find("export/panel_") == 0 &&
          std::string(window->Name).find("/", 13) == std::string::npos)
        return std::pair(window->Pos.y, window->ContentSize.y);
    return std::pair(0.f, 0.f);
  };
  for (int i = 0; i < 3; ++i) frame();
  const auto before = panel();
  ASSERT_GT(before.second, 100);
  const auto expect_still = [&](const char* where) {
    for (int i = 0; i < 3; ++i) {
      frame();
      EXPECT_EQ(panel(), before) << where;
    }
  };
  for (const auto what : {ExportDialog::What::video, ExportDialog::What::tables}) {
    dialog().what = what;
    expect_still("chosen");
  }
  set_path("no/such/folder");
  start();
  ASSERT_NE(dialog().refused(), "");
  expect_still("refused");
}

// The branch shown may be an older one; the program writes the newest of a recording.
TEST_F(ExportDialogTest, an_older_branch_is_refused_by_its_number_and_that_of_the_newest) {
  open_rocking();
  run_to(0.2);
  player().scrub(0.1);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  player().show_branch(0);
  frame();
  for (const auto what :
       {ExportDialog::What::picture, ExportDialog::What::video, ExportDialog::What::tables}) {
    open_export(what);
    set_path("older");
    click("Export");
    EXPECT_EQ(dialog().refused(), "") << "the button is not off";
    start();
    EXPECT_NE(dialog().refused().find("newest branch, 1, is exported; branch 0 is shown"), std::string::npos)
        << dialog().refused();
    press(render::key::escape);
  }
  EXPECT_TRUE(exports().empty());
}

TEST_F(ExportDialogTest, tab_goes_from_number_to_number) {
  connect_keyboard();
  open_rocking();
  run_to(0.2);
  open_export(ExportDialog::What::picture);
  for (int i = 0; i < 5; ++i) frame();
  tap(GLFW_KEY_TAB);  // the path
  tap(GLFW_KEY_TAB);
  type("640");
  tap(GLFW_KEY_TAB);
  type("360");
  tap(GLFW_KEY_TAB);
  EXPECT_EQ(std::pair(dialog().size[0], dialog().size[1]), std::pair(640, 360));
}

TEST_F(ExportDialogTest, before_there_is_an_instant_nothing_is_exported) {
  shell_->show({.scene = live_scene(), .recording = {}, .output = (scratch_ / "a.h5").string()}, "");
  ASSERT_TRUE(player().way().empty());
  for (const auto what :
       {ExportDialog::What::picture, ExportDialog::What::video, ExportDialog::What::tables}) {
    dialog().what = what;
    set_path("early");
    start();
    EXPECT_NE(dialog().refused().find("no instant yet"), std::string::npos) << dialog().refused();
    EXPECT_TRUE(exports().empty());
  }
}

TEST_F(ExportDialogTest, a_picture_is_seen_from_where_the_window_sees_it) {
  open_rocking();
  run_to(0.2);
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const auto& [key, name] : {std::pair{'1', "front.png"}, {'3', "top.png"}, {'1', "again.png"}}) {
    press(key);
    for (int i = 0; i < 30; ++i) frame();  // the camera has arrived
    open_export(ExportDialog::What::picture);
    set_path(name);
    dialog().size[0] = 200;
    dialog().size[1] = 150;
    start();
    EXPECT_EQ(export_failure(), "");
    const auto image = render::load_png(scratch_ / name);
    ASSERT_TRUE(image.has_value());
    pictures.push_back(image->rgba);
  }
  EXPECT_NE(pictures[0], pictures[1]);
  EXPECT_EQ(pictures[0], pictures[2]);
}

TEST_F(ExportDialogTest, a_picture_that_is_narrower_than_the_view_shows_all_that_the_view_shows) {
  open_rocking();
  run_to(0.1);
  open_export(ExportDialog::What::picture);
  set_path("tall.png");
  dialog().size[0] = 160;
  dialog().size[1] = 320;
  start();
  EXPECT_EQ(export_failure(), "");
  const std::vector<std::string>& words = exports().all().back().words;
  const std::string camera = *std::next(std::ranges::find(words, "--camera"));
  const Viewer& viewer = shell_->session()->viewer();
  render::Orbit picture = viewer.orbit();
  ASSERT_EQ(std::sscanf(camera.c_str(), "%*f,%*f,%f", &picture.distance), 1) << camera;
  const auto is_seen = [](const render::Orbit& orbit, float aspect, const Eigen::Vector3f& point) {
    const render::Camera from = orbit.camera(aspect);
    const Eigen::Vector4f at = from.projection * from.view * point.homogeneous();
    return std::abs(at.x()) <= at.w() && std::abs(at.y()) <= at.w();
  };
  int seen = 0;
  for (int k = 0; k < 11 * 11 * 11; ++k) {
    const Eigen::Vector3f way = Eigen::Vector3f(k % 11, k / 11 % 11, k / 121).array() / 5 - 1;
    const Eigen::Vector3f point = picture.middle + picture.size / 2 * way;
    if (way.norm() > 1 || !is_seen(viewer.orbit(), viewer.aspect(), point)) continue;
    ++seen;
    EXPECT_TRUE(is_seen(picture, 0.5f, point)) << way.transpose();
  }
  EXPECT_GT(seen, 100);
}

TEST_F(ExportDialogTest, a_camera_that_follows_is_where_the_window_has_it) {
  open_rocking();
  press('T');
  run_to(0.3);
  player().scrub(0.25);  // a recorded instant
  frame();
  std::vector<std::vector<std::uint8_t>> pictures;
  for (const char* name : {"follows.png", "stays.png"}) {
    open_export(ExportDialog::What::picture);
    set_path(name);
    start();
    EXPECT_EQ(export_failure(), "");
    pictures.push_back(render::load_png(scratch_ / name).value().rgba);
    press('T');  // lets go
  }
  ASSERT_EQ(pictures[0].size(), pictures[1].size());
  int different = 0;  // a byte here and there, by rounding, on edges; most of the body, had it moved
  for (std::size_t i = 0; i < pictures[0].size(); ++i)
    different += std::abs(pictures[0][i] - pictures[1][i]) > 30;
  EXPECT_LT(different, 100);
}

TEST_F(ExportDialogTest, a_range_in_which_nothing_lies_is_refused_and_stays_as_it_was_typed) {
  open_rocking();
  run_to(0.5);
  open_export(ExportDialog::What::video);
  set_path("view.mp4");
  dialog().from = 36;
  frame();
  EXPECT_EQ(dialog().from, 36);
  start();
  EXPECT_EQ(dialog().refused().find("Nothing lies between 36.00 and 0.5"), 0u) << dialog().refused();
  EXPECT_TRUE(exports().empty());
}

TEST_F(ExportDialogTest, tables_appear_as_a_whole_folder) {
  open_rocking();
  run_to(0.2);
  open_export(ExportDialog::What::tables);
  set_path("tables");
  start();
  EXPECT_EQ(export_failure(), "");
  EXPECT_TRUE(fs::exists(scratch_ / "tables/bodies.csv"));
  EXPECT_EQ(files_like(".part"), 0);
}

TEST_F(ExportDialogTest, a_job_tells_how_far_it_is_and_leaves_nothing_when_it_is_cancelled) {
  open_rocking();
  run_to(0.5);
  open_export(ExportDialog::What::video);
  set_path("view.mp4");
  dialog().rate = 240;
  start();
  ASSERT_EQ(dialog().refused(), "");
  ASSERT_TRUE(until([&] { return !exports().busy() || (job() && job()->part() > 0); }));
  ASSERT_NE(job(), nullptr) << dialog().refused();
  EXPECT_LE(job()->part(), 1);
  EXPECT_NE(job()->progress().find(" pictures, "), std::string::npos) << job()->progress();
  click("Cancel##0", "exports");
  EXPECT_EQ(export_failure(), "");
  EXPECT_EQ(files_like("view.mp4"), 0);
  EXPECT_EQ(files_like(".part"), 0);
}

TEST_F(ExportDialogTest, a_target_that_cannot_be_written_is_told_and_the_run_goes_on) {
  open_rocking();
  run_to(0.1);
  for (const auto what :
       {ExportDialog::What::picture, ExportDialog::What::video, ExportDialog::What::tables}) {
    open_export(what);
    std::string("/proc/out.png").copy(dialog().path, 14);
    dialog().path[13] = '\0';
    start();
    EXPECT_NE(export_failure().find("/proc/out.png"), std::string::npos) << dialog().refused();
    EXPECT_TRUE(dialog().is_open());
    press(render::key::escape);
  }
  run_to(player().time() + 0.05);
}

TEST_F(ExportDialogTest, a_failure_is_told_with_its_reason) {
  open_rocking();
  run_to(0.1);
  open_export(ExportDialog::What::picture);
  set_path("no/such/folder.png");
  start();
  EXPECT_NE(dialog().refused().find("no folder"), std::string::npos) << dialog().refused();
  ExportJob job(TOPPLE_PROGRAM, {"render", "nonsense", "--at", "0", "--still", (scratch_ / "x.png").string()},
                (scratch_ / "x.png").string());
  ASSERT_TRUE(eventually([&] { job.update(); }, [&] { return job.done(); }));
  EXPECT_NE(job.failure().find("no such file or built-in scene"), std::string::npos) << job.failure();
}

TEST_F(ExportDialogTest, several_are_at_work_at_once) {
  open_rocking();
  run_to(0.3);
  const auto begin = [&](ExportDialog::What what, const char* name) {
    open_export(what);
    set_path(name);
    start();
    EXPECT_EQ(dialog().refused(), "");
  };
  begin(ExportDialog::What::video, "view.mp4");
  begin(ExportDialog::What::tables, "tables");
  EXPECT_EQ(exports().all().size(), 2u);
  EXPECT_TRUE(exports().in_words().starts_with("exports at work: 2, ")) << exports().in_words();
  open_export(ExportDialog::What::picture);
  set_path("tables");
  start();
  EXPECT_NE(dialog().refused().find("tables exists already"), std::string::npos) << dialog().refused();
  press(render::key::escape);
  const double before = player().time();
  player().play();  // the window goes on
  ASSERT_TRUE(until([&] { return player().time() > before + 0.05; }));
  player().pause();
  EXPECT_EQ(export_failure(), "");
  EXPECT_TRUE(fs::exists(scratch_ / "view.mp4"));
  EXPECT_TRUE(fs::exists(scratch_ / "tables/bodies.csv"));
  EXPECT_EQ(exports().in_words(), "");
  EXPECT_EQ(exports().all().size(), 2u);  // what became of them stands there until it is closed
  click("Close##1", "exports");
  click("Close##0", "exports");
  EXPECT_TRUE(exports().empty());
}

/// PATH holds the given programs alone, as shell scripts.
class DesktopTest : public ExportDialogTest {
 protected:
  DesktopTest() : path_(std::getenv("PATH")) {
    fs::create_directory(scratch_ / "programs");
    for (const char* tool : {"sh", "setsid", "cat"}) fs::create_symlink(tool_path(tool), programs() / tool);
    setenv("PATH", programs().c_str(), 1);
  }
  ~DesktopTest() override { setenv("PATH", path_.c_str(), 1); }
  fs::path programs() const { return scratch_ / "programs"; }
  void install(const char* name, const std::string& script) const {
    std::ofstream(programs() / name) << "#!/bin/sh\n" << script << '\n';
    fs::permissions(programs() / name, fs::perms::owner_all);
  }
  static fs::path tool_path(const char* tool) { return fs::path("/usr/bin") / tool; }

 private:
  const std::string path_;
};

TEST_F(DesktopTest, the_folder_of_an_export_opens) {
  open_rocking();
  run_to(0.1);
  open_export(ExportDialog::What::tables);
  set_path("tables");
  start();
  EXPECT_EQ(export_failure(), "");
  click("Open folder##0", "exports");
  frame();
  EXPECT_TRUE(shell_->session()->viewer().message().starts_with("No program that shows folders"));
  const std::string said = (scratch_ / "said").string();
  install("xdg-open", "echo \"$1\" >" + said + ".part; exec /usr/bin/mv " + said + ".part " + said);
  click("Open folder##0", "exports");
  ASSERT_TRUE(until([&] { return fs::exists(said); }));
  EXPECT_EQ(read(said), fs::path(scratch_ / "").parent_path().string() + "\n");
}

TEST_F(DesktopTest, a_dialog_of_the_desktop_chooses) {
  const std::string scene = write("rocking.toml", k_rocking), said = (scratch_ / "said").string();
  install("zenity", "echo \"$@\" >" + said + "; echo " + scene);
  frame();
  shell_->choose_scene();
  click("Browse…", "chooser");
  EXPECT_FALSE(shell_->file_dialog().is_open());
  ASSERT_TRUE(until([&] { return ready(); }));
  EXPECT_EQ(shell_->session()->source(), scene);
  EXPECT_EQ(read(said).substr(0, 53), "--file-selection --title=Open a scene or a recording ");
  install("zenity", "exit 1");  // the person chooses nothing
  press('S', true);
  const std::string proposed = shell_->save_dialog().path;
  click("Browse…");
  ASSERT_TRUE(until([&] { return !shell_->file_dialog().asks_desktop(); }));
  EXPECT_EQ(shell_->save_dialog().path, proposed);
}

TEST_F(DesktopTest, without_one_a_list_chooses) {
  fs::create_directory(scratch_ / "room");
  const std::string scene = write("room/rocking.toml", k_rocking);
  write("room/notes.txt", "");
  write("room/.hidden.toml", "");
  press('S', true);
  shell_->choose_scene();
  frame();
  FileDialog& list = shell_->file_dialog();
  list.ask({false, "Open", scene, {".toml"}}, [&](const std::string& path) { shell_->open(path); });
  ASSERT_TRUE(list.is_open());
  frame();
  EXPECT_EQ(list.folder(), (scratch_ / "room").string());
  EXPECT_EQ(list.entries(), std::vector<std::string>{"rocking.toml"});
  click("Up");
  EXPECT_EQ(std::ranges::count(list.entries(), "room/"), 1);
  std::snprintf(list.name, sizeof list.name, "room");
  press(render::key::enter);  // goes into it
  EXPECT_EQ(list.folder(), (scratch_ / "room").string());
  std::snprintf(list.name, sizeof list.name, "nothing.toml");
  press(render::key::enter);
  ASSERT_TRUE(list.is_open());
  std::snprintf(list.name, sizeof list.name, "rocking.toml");
  press(render::key::enter);
  EXPECT_FALSE(list.is_open());
  ASSERT_TRUE(until([&] { return ready(); }));
  EXPECT_EQ(shell_->session()->source(), scene);
  press('S', true);
  click("Browse…");
  ASSERT_TRUE(list.is_open());
  std::snprintf(list.name, sizeof list.name, "new.toml");
  click("Choose");
  EXPECT_TRUE(std::string(shell_->save_dialog().path).ends_with("/new.toml"));
  press(render::key::escape);
}

}  // namespace
}  // namespace topple::app
