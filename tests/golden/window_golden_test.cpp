// Every panel of the window, as it is drawn off screen.
#include "app/panels/teaching_words.h"
#include "tests/golden/golden.h"
#include "tests/unit/app/shell_fixture.h"

namespace topple::app {
namespace {

class GoldenWindow : public ShellTest {
 protected:
  void SetUp() override { ImGui::GetIO().DisplaySize = {960, 540}; }

  /// paper-a, run for so long.
  void show_run(const Appearance& appearance = {}, const char* duration = "1.2") {
    shell_.reset();
    shell_.emplace(
        stage_, 1.f, [] {}, TOPPLE_PROGRAM, appearance);
    const auto scene = std::make_shared<const io::Scene>(
        io::load_scene("paper-a", {std::string("run.duration=") + duration}));
    shell_->show({.scene = scene, .recording = {}, .output = (scratch_ / "a.h5").string()}, "");
    ASSERT_TRUE(until([&] { return ready(); }));
    run_on();
  }
  void run_on() {
    for (int i = 0; i < 3; ++i) player().faster();
    player().play();
    ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::over; }));
    for (int i = 0; i < 3; ++i) player().slower();
    press('4');  // framed beside the words that stand there now, whenever the run came to its end
  }
  /// When nothing moves any more.
  render::Image shot() {
    for (int i = 0; i < 60; ++i) frame();
    return stage_.shot(shell_->surface(), *ImGui::GetDrawData());
  }
  static render::Image part(const render::Image& whole, int left, int top, int right, int bottom) {
    render::Image image{right - left, bottom - top, {}};
    for (int y = top; y < bottom; ++y) {
      const auto* const row =
          &whole.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(whole.width))];
      image.rgba.insert(image.rgba.end(), row + 4 * left, row + 4 * right);
    }
    return image;
  }
  render::Image part(const Box& box) {
    return part(shot(), static_cast<int>(box.left), static_cast<int>(box.top),
                static_cast<int>(box.left + box.width), static_cast<int>(box.top + box.height));
  }
  render::Image side() {
    const Box& scene = viewer().scene_box();
    const Box& timeline = viewer().timeline_box();
    return part({scene.width, 0, 960 - scene.width, timeline.top + timeline.height});
  }
  Viewer& viewer() { return shell_->session()->viewer(); }
};

TEST_F(GoldenWindow, chooser) {
  shell_->choose_scene();
  type("paper");
  const auto has_body = [](const render::Image& card) {
    return std::ranges::any_of(card.rgba, [](std::uint8_t byte) { return byte < 90; });
  };
  const auto both_drawn = [&] {
    const render::Image all = stage_.shot(shell_->surface(), *ImGui::GetDrawData());
    return has_body(part(all, 330, 100, 600, 260)) && has_body(part(all, 650, 100, 920, 260));
  };
  bool drawn = false;  // after the pictures of all scenes before them
  for (int round = 0; round < 10 && !drawn; ++round) drawn = static_cast<bool>(until(both_drawn));
  ASSERT_TRUE(drawn);
  render::expect_golden(shot(), "window-chooser.png");
}

TEST_F(GoldenWindow, run_with_parameters) {
  show_run();
  render::expect_golden(shot(), "window-parameters.png");
}

TEST_F(GoldenWindow, inspector) {
  show_run();
  viewer().inspect(Subject{Subject::Kind::member, 0});
  render::expect_golden(side(), "window-inspector.png");
}

TEST_F(GoldenWindow, comparison_with_the_branch_that_was_left) {
  show_run();
  player().scrub(0.2);
  player().continue_from_here();
  ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && player().can_edit(); }));
  player().begin_edit();
  player().edit({Edit::Key::amplitude, 0, Vec3(20 * k_gal, 0, 0)});
  run_on();
  render::expect_golden(part(viewer().scene_box()), "window-comparison.png");
}

TEST_F(GoldenWindow, timeline_with_events) {
  show_run({}, "2.5");
  player().scrub(1);
  render::expect_golden(part(viewer().timeline_box()), "window-timeline.png");
}

TEST_F(GoldenWindow, learn) {
  show_run();
  viewer().show(Viewer::Tab::teach);
  render::expect_golden(side(), "window-learn.png");
}

TEST_F(GoldenWindow, overturning_map) {
  shell_->open(write("rocking.toml", k_rocking));
  ASSERT_TRUE(until([&] { return ready(); }));
  run_on();
  viewer().show(Viewer::Tab::teach);
  click(say(window_words::k_overturning_map) + "##map", "side/content");
  const MapState& map = viewer().teaching().map;
  bool computed = false;  // 576 runs
  for (int round = 0; round < 40 && !computed; ++round)
    computed = static_cast<bool>(until([&] { return map.search && map.search->over(); }));
  ASSERT_TRUE(computed);
  ImGui::GetIO().MousePos = {viewer().scene_box().width + 20, 300};  // the click scrolled to its button
  for (int notch = 0; notch < 20; ++notch) {
    ImGui::GetIO().MouseWheel = 1;
    frame();
  }
  ImGui::GetIO().MouseWheel = 0;
  ImGui::GetIO().MousePos = {2, 400};
  render::expect_golden(side(), "window-map.png");
}

TEST_F(GoldenWindow, picture_settings) {
  show_run();
  viewer().show(Viewer::Tab::picture);
  render::expect_golden(side(), "window-picture.png");
}

TEST_F(GoldenWindow, export_dialog) {
  show_run();
  press('E', true);
  std::string("paper-a-1.png").copy(shell_->export_dialog().path, 14);
  shell_->export_dialog().path[13] = '\0';
  render::expect_golden(part(shot(), 140, 80, 820, 460), "window-export.png");
}

TEST_F(GoldenWindow, japanese_and_dark) {
  show_run({.dark = true, .language = Language::japanese});
  render::expect_golden(shot(), "window-dark-japanese.png");
}

TEST_F(GoldenWindow, twice_the_size) {
  ImGui::GetIO().DisplaySize = {1280, 720};
  show_run({.scale = 2});
  render::expect_golden(shot(), "window-large.png");
}

}  // namespace
}  // namespace topple::app
