// The window's content off screen, with mouse and keyboard fed by hand.
#include "app/window/viewer.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>

#include "app/picture/body_colour.h"
#include "solver/io/edit/scene_save.h"
#include "unit/app/live.h"
#include "unit/app/mouse.h"
#include "unit/render/off_screen.h"
#include "unit/render/read_png.h"
#include "unit/render/scratch.h"

namespace topple::app {
namespace {

constexpr float k_width = 1280, k_height = 720;
constexpr int k_space = ' ';

class ViewerTest : public ::testing::Test {
 protected:
  ViewerTest() : interface_(ImGui::CreateContext()) { hold_keys_by_hand(); }
  ~ViewerTest() override {
    viewer_.reset();
    player_.reset();
    run_.reset();
    ImGui::DestroyContext(interface_);
  }

  void start(LiveRun::Advance advance = &topple::Run::advance, const std::string& text = k_rocking) {
    const auto scene = live_scene(text);
    run_.emplace(
        LiveSource{.scene = scene, .recording = {}, .output = (scratch_ / "view.h5").string()}, [] {},
        std::move(advance));
    player_.emplace(scene, *run_);
    stage_.emplace(render::off_screen());
    viewer_.emplace(*player_, *stage_, 1.f);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {k_width, k_height};
    io.DeltaTime = 1.f / 60;
    io.MousePos = {2, 400};
    ASSERT_TRUE(until([this] { return player_->can_edit(); }));
  }
  void frame() {
    viewer_->update(1. / 60);
    ImGui::NewFrame();
    viewer_->build();
    ++frames_;
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually([this] { frame(); }, done);
  }
  render::Image shot() { return stage_->shot(viewer_->surface(), *ImGui::GetDrawData()); }

  void press(int key, bool control = false, bool shift = false) {
    viewer_->press({key, control, shift});
    frame();
  }
  void type(char c) {
    ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
    frame();
    frame();
  }
  void hover(ImVec2 at) {
    ImGui::GetIO().MousePos = at;
    frame();
    frame();
  }
  void drag(ImVec2 from, ImVec2 to, int button = 0) {
    ImGuiIO& io = ImGui::GetIO();
    hover(from);
    io.MouseDown[button] = true;
    frame();
    for (int i = 1; i <= 5; ++i) {
      const float u = static_cast<float>(i) / 5;
      io.MousePos = {from.x + u * (to.x - from.x), from.y + u * (to.y - from.y)};
      frame();
    }
    io.MouseDown[button] = false;
    frame();
    frame();
  }
  void click(ImVec2 at) { drag(at, at); }

  /// Where the item of that name is in a panel, found by moving the mouse over it; of a slider, that for the
  /// edits called `of`.
  ImVec2 find(const char* panel, const char* name, const char* of = nullptr) {
    const auto windows = ImGui::GetCurrentContext()->Windows;  // a frame may add some
    for (const ImGuiWindow* window : windows) {
      const std::string_view called(window->Name);
      if (called != panel && !called.starts_with(std::string(panel) + "/")) continue;
      const ImVec2 at = find_in(window, name, of);
      if (at.x >= 0) return at;
    }
    return {-1, -1};
  }
  ImVec2 find_in(const ImGuiWindow* window, const char* name, const char* of) {
    ImGuiID id = ImHashStr(name, 0, window->ID);
    if (of) id = ImHashStr("##value", 0, ImHashStr(of, 0, id));
    const float across = of ? 60.f : 9.f;
    hover({2, 400});  // what was hovered in the frame before still counts
    for (float y = window->Pos.y + 5; y < window->Pos.y + window->Size.y; y += 9)
      for (float x = window->Pos.x + 5; x < window->Pos.x + window->Size.x; x += across) {
        ImGui::GetIO().MousePos = {x, y};
        frame();
        if (ImGui::GetHoveredID() == id) return {x, y};
      }
    return {-1, -1};
  }
  /// What of a panel scrolls.
  /// Where the box of a parameter is, by the label beside it and its key; x < 0: nowhere.
  ImVec2 box_of(const char* label, const char* key) {
    const ImGuiWindow* const side = content("side");
    const ImGuiID box = ImHashStr(label, 0, ImHashStr(key, 0, ImHashStr(label, 0, side->ID)));
    hover({2, 400});
    for (float y = side->Pos.y + 5; y < side->Pos.y + side->Size.y; y += 9) {
      hover({side->Pos.x + 20, y});
      if (ImGui::GetHoveredID() == box) return ImGui::GetIO().MousePos;
    }
    return {-1, -1};
  }
  static const ImGuiWindow* content(const std::string& panel) {
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
      if (std::string_view(window->Name).starts_with(panel + "/content")) return window;
    return nullptr;
  }
  void press_button(const char* panel, const char* name) {
    const ImVec2 at = find(panel, name);
    ASSERT_GE(at.x, 0) << name;
    click(at);
  }
  double amplitude_gal() const { return player_->parameters().shakes[0].amplitude / k_gal; }
  ImVec2 on_timeline(double time) const {
    const Box& box = viewer_->timeline_box();
    // The axis begins after the labels and ends before the margin; both are found from two scrubs.
    return {box.left + axis_left_ + static_cast<float>(time / player_->length()) * axis_width_,
            box.top + box.height / 2};
  }
  /// Learns where the time axis lies by scrubbing.
  void learn_axis() {
    const Box& box = viewer_->timeline_box();
    const float x1 = 0.3f * box.width, x2 = 0.8f * box.width, y = box.top + box.height / 2;
    click({box.left + x1, y});
    const double t1 = player_->time();
    click({box.left + x2, y});
    const double t2 = player_->time();
    ASSERT_GT(t2, t1);
    axis_width_ = static_cast<float>((x2 - x1) / (t2 - t1) * player_->length());
    axis_left_ = x1 - static_cast<float>(t1 / player_->length()) * axis_width_;
  }

  const render::Scratch scratch_;
  ImGuiContext* interface_;
  std::optional<LiveRun> run_;
  std::optional<Player> player_;
  std::optional<render::Stage> stage_;
  std::optional<Viewer> viewer_;
  float axis_left_ = 0, axis_width_ = 1;
  int frames_ = 0;
};

TEST_F(ViewerTest, a_box_takes_an_anchor_away) {
  start(&topple::Run::advance, k_rocking + k_straps);
  const ImVec2 at = box_of("strong", "anchor.2.on");
  ASSERT_GE(at.x, 0);
  const auto red = [&](bool on) {
    EXPECT_TRUE(until([&] { return (player_->row()->anchor[1].state != io::k_anchor_away) == on; }));
    for (int i = 0; i < 5; ++i) frame();
    const render::Image image = shot();
    const Box& box = viewer_->scene_box();
    int count = 0;
    for (int y = static_cast<int>(box.top); y < static_cast<int>(box.top + box.height); ++y)
      for (int x = static_cast<int>(box.left); x < static_cast<int>(box.left + box.width); ++x) {
        const auto [r, g, b] = render::colour_at(image, {x, y});
        count += r > 140 && r > 3 * g / 2 && r > 3 * b / 2;
      }
    return count;
  };
  const int both = red(true);
  click(at);
  EXPECT_FALSE(player_->parameters().anchors[1]);
  EXPECT_TRUE(player_->parameters().anchors[0]);
  const int one = red(false);
  EXPECT_LT(one, both);  // seen at once, though nothing runs
  EXPECT_EQ(player_->row()->anchor[0].state, io::k_anchor_broken);
  click(at);
  EXPECT_TRUE(player_->parameters().anchors[1]);
  EXPECT_GT(red(true), one);
}

TEST_F(ViewerTest, a_box_takes_a_fixing_with_all_its_points_away_and_the_scene_can_be_saved) {
  start(&topple::Run::advance, k_rocking + k_brackets);
  ASSERT_EQ(player_->parameters().anchors.size(), 2u);
  EXPECT_LT(box_of("held-2", "anchor.2.on").x, 0);
  const ImVec2 at = box_of("held", "anchor.1.on");
  ASSERT_GE(at.x, 0);
  click(at);
  EXPECT_EQ(player_->parameters().anchors, (std::vector<bool>{false, false}));
  const io::SavedScene saved = io::edited_scene(player_->scene(), player_->parameters());
  EXPECT_NE(saved.text.find("on = false"), std::string::npos);
  press('Z', true);
  EXPECT_EQ(player_->parameters().anchors, (std::vector<bool>{true, true}));
}

TEST_F(ViewerTest, nothing_is_shaken_once_after_the_end_of_the_run) {
  start();
  const ImGuiWindow* const side = content("side");
  const ImGuiID button = ImHashStr("Shake once", 0, ImHashStr("shake.1.type", 0, side->ID));
  ImVec2 at{-1, -1};
  for (float y = side->Pos.y + 5; y < side->Pos.y + side->Size.y && at.x < 0; y += 9) {
    hover({side->Pos.x + 20, y});
    if (ImGui::GetHoveredID() == button) at = ImGui::GetIO().MousePos;
  }
  ASSERT_GE(at.x, 0);
  click(at);
  ASSERT_TRUE(until([&] { return player_->edits().size() == 1; }));
  press('Z', true);
  ASSERT_TRUE(until([&] { return player_->edits().size() == 2; }));
  player_->set_speed(k_most_speed);
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  click(at);
  for (int i = 0; i < 5; ++i) frame();
  EXPECT_EQ(player_->parameters().shakes[0].kind, Shake::Kind::sine);
  EXPECT_EQ(player_->edits().size(), 2u);
}

TEST_F(ViewerTest, space_plays_and_pauses) {
  start();
  for (int i = 0; i < 3; ++i) type('[');  // it does not end before the second press
  EXPECT_FALSE(player_->playing());
  press(k_space);
  EXPECT_TRUE(player_->playing());
  ASSERT_TRUE(until([&] { return player_->time() > 0.1; }));
  press(k_space);
  EXPECT_FALSE(player_->playing());
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::halted; }));
  const double time = player_->time();
  for (int i = 0; i < 20; ++i) frame();
  EXPECT_EQ(player_->time(), time);
}

TEST_F(ViewerTest, a_long_status_leaves_everything_where_it_is_and_is_whole_in_its_tooltip) {
  start();
  for (int i = 0; i < 5; ++i) frame();
  const float height = viewer_->scene_box().height;
  const render::Orbit before = viewer_->orbit();
  std::string words;
  for (int i = 0; i < 60; ++i) words += "warning ";
  viewer_->show_message(words);
  for (int i = 0; i < 5; ++i) frame();
  EXPECT_EQ(viewer_->scene_box().height, height);
  const ImGuiWindow* const status = ImGui::FindWindowByName("status");
  ASSERT_NE(status, nullptr);
  EXPECT_LE(status->ContentSize.x, status->Size.x);
  ImGui::GetIO().MousePos = {status->Pos.x + 60, status->Pos.y + status->Size.y / 2};
  for (int i = 0; i < 3; ++i) frame();
  const ImGuiWindow* const tip = ImGui::FindWindowByName("##Tooltip_00");
  ASSERT_TRUE(tip && tip->Active);
  EXPECT_GT(tip->Size.y, 2 * ImGui::GetTextLineHeight());
  EXPECT_EQ(viewer_->orbit().distance, before.distance);
  EXPECT_EQ(viewer_->orbit().target, before.target);
}

TEST_F(ViewerTest, buttons_do_what_keys_do) {
  start();
  type('[');  // time enough to find the button
  type('[');
  press_button("transport", "##play");
  EXPECT_TRUE(player_->playing());
  ASSERT_TRUE(until([&] { return player_->time() > 0.1; }));
  press_button("transport", "##play");
  EXPECT_FALSE(player_->playing());
  press_button("transport", "##start");
  EXPECT_EQ(player_->time(), 0);
  press_button("transport", "+##faster");
  EXPECT_EQ(player_->speed(), 0.5);
  type(']');
  EXPECT_EQ(player_->speed(), 1);
  press(render::key::end);
  EXPECT_TRUE(player_->at_head());
  press(render::key::home);
  EXPECT_EQ(player_->time(), 0);
  type('.');
  EXPECT_NEAR(player_->time(), 0.01, 1e-9);
}

TEST_F(ViewerTest, dragging_the_amplitude_slider_shakes_harder_while_it_runs_and_undo_takes_it_back) {
  start();
  const ImVec2 slider = find("side", "amplitude", "shake.1.amplitude");
  ASSERT_GE(slider.x, 0);
  for (int i = 0; i < 3; ++i) type('[');  // it does not end before the drag does
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->time() > 0; }));
  drag(slider, {slider.x + 60, slider.y});
  const double harder = amplitude_gal();
  EXPECT_NE(harder, 300);
  EXPECT_TRUE(player_->playing());
  ASSERT_TRUE(until([&] { return !player_->edits().empty(); }));
  EXPECT_GT(player_->edits().back().step, 0);
  press('Z', true);
  EXPECT_NEAR(amplitude_gal(), 300, 1e-9);
  press('Z', true, true);
  EXPECT_NEAR(amplitude_gal(), harder, 1e-9);
}

TEST_F(ViewerTest, parameters_of_contact_are_shown_where_something_can_touch) {
  start(&topple::Run::advance, k_beam);
  EXPECT_LT(find("side", "α", "contact.alpha").x, 0);
  EXPECT_GE(find("side", "time step", "run.time_step").x, 0);
}

TEST_F(ViewerTest, the_timeline_scrubs_and_a_branch_continues_from_there) {
  start();
  for (int i = 0; i < 3; ++i) type(']');
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  learn_axis();
  click(on_timeline(0.5));
  EXPECT_NEAR(player_->time(), 0.5, 0.011);  // a pixel and a recorded instant
  EXPECT_FALSE(player_->at_head());
  const ImVec2 slider = find("side", "amplitude", "shake.1.amplitude");
  drag(slider, {slider.x + 40, slider.y});
  EXPECT_EQ(amplitude_gal(), 300);  // the past is not edited
  press('C');
  ASSERT_TRUE(until([&] { return player_->at_head() && player_->history().branches.size() == 2; }));
  EXPECT_NEAR(player_->time(), 0.5, 0.011);
  drag(slider, {slider.x + 40, slider.y});
  EXPECT_NE(amplitude_gal(), 300);
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->time() > 0.7; }));
  EXPECT_EQ(player_->shown_branch(), 1);
  EXPECT_TRUE(player_->ghost().has_value());
}

// Before the fork two branches share their rows: only the pale one is another.
TEST_F(ViewerTest, a_branch_shown_at_the_same_instant_is_drawn_with_its_own_pale_one) {
  start();
  const auto run_to_end = [&] {
    press(k_space);
    return until([&] { return player_->status().kind == LiveStatus::Kind::over; });
  };
  for (int i = 0; i < 3; ++i) type(']');
  ASSERT_TRUE(run_to_end());
  for (const double fork : {0.1, 0.6}) {
    player_->scrub(fork);
    press('C');
    ASSERT_TRUE(until([&] { return player_->can_edit(); }));
    player_->edit({Edit::Key::amplitude, 0, Vec3(6, 0, 0)});
    ASSERT_TRUE(run_to_end());
  }
  player_->scrub(0.5);
  const auto scene = [&] {
    for (int i = 0; i < 60; ++i) frame();  // at its best, as nothing moves
    const Box& box = viewer_->scene_box();
    const render::Image whole = shot();
    std::vector<std::uint8_t> part;
    for (int y = static_cast<int>(0.4f * box.height); y < static_cast<int>(box.height); ++y) {
      const auto* const row = whole.rgba.data() + static_cast<std::ptrdiff_t>(y) * whole.width * 4;
      part.insert(part.end(), row, row + static_cast<std::ptrdiff_t>(box.width) * 4);
    }
    return part;
  };
  ASSERT_EQ(player_->ghost_branch(), 1);
  const auto beside_its_like = scene();
  player_->show_branch(0);
  frame();
  player_->show_branch(1);
  player_->scrub(0.5);
  ASSERT_EQ(player_->ghost_branch(), 0);
  EXPECT_NE(scene(), beside_its_like);
  player_->show_branch(2);
  player_->scrub(0.5);
  ASSERT_EQ(player_->ghost_branch(), 1);
  EXPECT_EQ(scene(), beside_its_like);
}

// Seven, of which the first and the last would have one colour; the second tilts least.
TEST_F(ViewerTest, a_body_has_one_colour_in_the_timeline_whichever_others_tilt_more) {
  std::string text = "topple = 1\n[run]\nduration = 1\nsettle = false\nwant = [\"motion\"]\n[floor]\n";
  const double tilts[] = {3, 0, 1, 1, 1, 1, 5};
  for (int b = 0; b < 7; ++b)
    text += fmt::format(
        "[[block]]\nname = \"{}\"\nsize = [0.4, 0.4, 0.8]\nmass = 50\nat = [0, {}]\ntilt = \"{} deg\"\n", b,
        2 * b, tilts[b]);
  start(&topple::Run::advance, text);
  player_->play();
  ASSERT_TRUE(until([&] { return player_->way().size() > 1; }));
  const auto is_drawn = [](std::size_t body) {
    const auto& [red, green, blue] = body_colour(body);
    const auto& vertices = ImGui::FindWindowByName("timeline")->DrawList->VtxBuffer;
    return std::any_of(
        vertices.begin(), vertices.end(),
        [colour = IM_COL32(red, green, blue, 255)](const ImDrawVert& v) { return v.col == colour; });
  };
  for (const std::size_t body : {2, 3, 4, 5, 6}) EXPECT_TRUE(is_drawn(body)) << body;
  EXPECT_FALSE(is_drawn(1));
}

// The beginning is the nearest to the lower left corner, the end to the right of the upper edge, and the knee
// at load step 24, where the first hinges form, to its middle: that is known to 9 px, 1.5 load steps.
TEST_F(ViewerTest, a_click_on_the_path_of_a_static_run_goes_to_the_load_step_there) {
  std::ifstream file(TOPPLE_SOURCE_DIR "/assets/scenes/portal-pushover.toml");
  start(&topple::Run::advance, std::string(std::istreambuf_iterator<char>(file), {}));
  for (int i = 0; i < 3; ++i) type(']');
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  ASSERT_EQ(player_->way().size(), 41u);
  const ImVec2 corner = find("load path", "path");
  ASSERT_GE(corner.x, 0);
  const Box& box = viewer_->path_box();
  const float right = box.left + box.width - 20;
  // below the chart are its numbers, its title and its key
  click({corner.x + 3, box.top + box.height - 4.9f * ImGui::GetTextLineHeight() - 3});
  EXPECT_EQ(player_->time(), 0);
  EXPECT_FALSE(player_->at_head());
  click({corner.x + (right - corner.x) / 2, corner.y + 15});
  EXPECT_NEAR(player_->time() * 40, 24, 2);
  click({right, corner.y + 15});
  EXPECT_EQ(player_->time(), 1);
  const Stability* const told = player_->stability(*player_->way().back());
  ASSERT_TRUE(told);
  EXPECT_TRUE(told->stable());
}

TEST_F(ViewerTest, frames_are_drawn_while_one_step_takes_its_time) {
  Gate gate;
  start(gate.advance());
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->time() > 0.05; }));
  gate.shut();
  ASSERT_TRUE(until([&] { return gate.held(); }));
  frame();
  const double time = player_->time();
  const int before = frames_;
  const render::Image first = shot();
  const Box& box = viewer_->scene_box();
  drag({box.left + 300, box.top + 200}, {box.left + 420, box.top + 230});
  const render::Image second = shot();
  EXPECT_GT(frames_, before + 5);
  EXPECT_NE(first.rgba, second.rgba);
  EXPECT_TRUE(gate.held());
  EXPECT_EQ(player_->time(), time);
  gate.open();
  ASSERT_TRUE(until([&] { return player_->time() > time; }));
}

TEST_F(ViewerTest, a_window_is_drawn_before_there_is_anything_to_show) {
  const auto scene = live_scene();
  std::promise<void> go;
  const std::shared_future<void> gone = go.get_future().share();
  // The first report waits until the window has been drawn.
  run_.emplace(LiveSource{.scene = scene, .recording = {}, .output = {}}, [gone] { gone.wait(); });
  player_.emplace(scene, *run_);
  stage_.emplace(render::off_screen());
  viewer_.emplace(*player_, *stage_, 1.f);
  ImGui::GetIO().DisplaySize = {k_width, k_height};
  ImGui::GetIO().DeltaTime = 1.f / 60;
  for (int i = 0; i < 5; ++i) frame();
  press('R');
  press('C');
  press(k_space);
  EXPECT_EQ(shot().width, static_cast<int>(k_width));
  go.set_value();
  EXPECT_TRUE(until([&] { return player_->row().has_value(); }));
}

TEST_F(ViewerTest, typing_applies_the_whole_number_once) {
  start();
  const ImVec2 slider = find("side", "amplitude", "shake.1.amplitude");
  hover(slider);
  ImGuiIO& io = ImGui::GetIO();
  io.KeyCtrl = true;
  io.MouseDown[0] = true;
  frame();
  io.MouseDown[0] = false;
  io.KeyCtrl = false;
  frame();
  frame();
  for (const char c : {'4', '5', '0'}) {
    io.AddInputCharacter(static_cast<unsigned>(c));
    frame();
    EXPECT_EQ(amplitude_gal(), 300);
  }
  press(k_space);  // goes into the number, not to the player
  EXPECT_FALSE(player_->playing());
  click({2, 300});
  EXPECT_NEAR(amplitude_gal(), 450, 1e-9);
  ASSERT_TRUE(until([&] { return !player_->edits().empty(); }));
  EXPECT_EQ(player_->edits().size(), 1u);
}

/// Where a member is seen, found by clicking across the scene until one is picked.
class InspectorTest : public ViewerTest {
 protected:
  void pick_some_member() {
    start();
    for (int i = 0; i < 30; ++i) frame();
    const Box& box = viewer_->scene_box();
    for (float x = 0.3f; x < 0.7f && !viewer_->inspection().picked; x += 0.005f) {
      member_at_ = {box.left + x * box.width, box.top + 0.5f * box.height};
      click(member_at_);
    }
    ASSERT_TRUE(viewer_->inspection().picked.has_value());
  }
  /// Buttons at the right edge of the inspector, from above: the pin, then those that plot.
  std::vector<ImVec2> right_buttons() {
    const ImGuiWindow* inspector = nullptr;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
      if (std::string_view(window->Name).find("/inspector") != std::string_view::npos) inspector = window;
    std::vector<ImVec2> found;
    if (!inspector) return found;
    ImGuiID last = 0;
    hover({2, 400});
    for (float y = inspector->Pos.y + 2; y < inspector->Pos.y + inspector->Size.y; y += 5) {
      ImGui::GetIO().MousePos = {inspector->Pos.x + inspector->Size.x - 8, y};
      frame();
      const ImGuiID now = ImGui::GetHoveredID();
      if (now != 0 && now != last) found.push_back(ImGui::GetIO().MousePos);
      last = now;
    }
    return found;
  }
  ImVec2 member_at_{};
};

TEST_F(InspectorTest, a_member_picked_again_gives_way_to_its_body_and_escape_lets_go) {
  pick_some_member();
  EXPECT_EQ(viewer_->inspection().picked->kind, Subject::Kind::member);
  EXPECT_LT(viewer_->inspection().picked->index, player_->scene().setup.model.members.size());
  click(member_at_);
  EXPECT_EQ(viewer_->inspection().picked, (Subject{Subject::Kind::body, 0}));
  press(render::key::escape);
  EXPECT_FALSE(viewer_->inspection().picked.has_value());
}

TEST_F(InspectorTest, pins_stay_while_another_is_looked_at) {
  pick_some_member();
  const Subject member = *viewer_->inspection().picked;
  const std::vector<ImVec2> buttons = right_buttons();
  ASSERT_GE(buttons.size(), 3u);
  click(buttons[0]);
  click(member_at_);
  EXPECT_EQ(viewer_->inspection().picked->kind, Subject::Kind::body);
  EXPECT_EQ(viewer_->inspection().pinned, std::vector<Subject>{member});
  press(render::key::escape);
  EXPECT_EQ(viewer_->inspection().pinned, std::vector<Subject>{member});
}

TEST_F(InspectorTest, values_are_plotted_scrubbed_and_written) {
  pick_some_member();
  for (int i = 0; i < 3; ++i) type(']');
  press(k_space);
  ASSERT_TRUE(until([&] { return player_->status().kind == LiveStatus::Kind::over; }));
  const std::vector<ImVec2> buttons = right_buttons();
  ASSERT_GE(buttons.size(), 3u);
  const float before = viewer_->scene_box().height;
  click(buttons[1]);
  click(buttons[2]);
  const Subject member = *viewer_->inspection().picked;
  EXPECT_EQ(viewer_->inspection().plots, (std::vector<PlottedValue>{{member, 0}, {member, 1}}));
  EXPECT_LT(viewer_->scene_box().height, before);
  click(buttons[2]);
  EXPECT_EQ(viewer_->inspection().plots.size(), 1u);

  const Box& scene = viewer_->scene_box();
  click({scene.left + 0.5f * scene.width, scene.top + scene.height + 60});
  EXPECT_FALSE(player_->at_head());
  EXPECT_GT(player_->time(), 0.2);

  const std::filesystem::path started_in = std::filesystem::current_path();
  std::filesystem::create_directory(scratch_ / "work");
  std::filesystem::current_path(scratch_ / "work");
  press_button("plots", "CSV");
  press_button("plots", "PNG");
  std::filesystem::current_path(started_in);
  const std::string stem = (scratch_ / "work").string() + "/" + player_->scene().name + "-plots-1";
  EXPECT_NE(viewer_->message().find(stem + ".png"), std::string::npos) << viewer_->message();
  const std::filesystem::path csv = stem + ".csv";
  std::ifstream file(csv);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "time_s,\"" + name_of(player_->scene().setup.model, member) + " stress, MPa\"");
  std::size_t lines = 0;
  while (std::getline(file, line)) ++lines;
  EXPECT_EQ(lines, player_->way().size());
  const render::Image png = render::read_png(stem + ".png");
  EXPECT_EQ(png.width, 1280);
  EXPECT_EQ(png.rgba[0], 255);  // white paper, and something on it
  EXPECT_TRUE(std::ranges::any_of(png.rgba, [](std::uint8_t byte) { return byte < 60; }));
  press_button("plots", "Close all##close");
  EXPECT_TRUE(viewer_->inspection().plots.empty());
  EXPECT_EQ(viewer_->scene_box().height, before);
}

TEST_F(ViewerTest, keys_and_sliders_change_the_picture) {
  start();
  for (int i = 0; i < 30; ++i) frame();
  frame();
  render::Image last = shot();
  const auto expect_change = [&] {
    frame();
    const render::Image now = shot();
    EXPECT_NE(now.rgba, last.rgba);
    last = now;
  };
  press('Q');
  EXPECT_EQ(viewer_->settings().colour, BeamQuantity::yield_ratio);
  expect_change();
  press('P');
  EXPECT_FALSE(viewer_->settings().panels);
  expect_change();
  press('A');
  EXPECT_TRUE(viewer_->settings().contact_forces);
  expect_change();
  press_button("side", "Picture");
  const ImVec2 slider = find("side", "##exaggeration");
  ASSERT_GE(slider.x, 0);
  drag(slider, {slider.x + 80, slider.y});
  EXPECT_GT(viewer_->settings().exaggeration, 1);
  EXPECT_LE(viewer_->settings().exaggeration, k_most_exaggeration);
  expect_change();
  for (std::size_t i = 1; i < beam_quantities().size(); ++i) press('Q');
  EXPECT_EQ(viewer_->settings().colour, BeamQuantity::stress);
}

TEST_F(ViewerTest, nothing_is_drawn_again_when_nothing_changed) {
  start();
  for (int i = 0; i < 90; ++i) frame();  // until the still picture is drawn
  EXPECT_FALSE(viewer_->update(1. / 60));
  const render::Image first = shot();
  frame();
  EXPECT_EQ(first.rgba, shot().rgba);
  press('2');
  EXPECT_TRUE(viewer_->update(1. / 60));
}

TEST_F(ViewerTest, small_windows_and_high_resolution_do_no_harm) {
  start();
  ImGuiIO& io = ImGui::GetIO();
  for (const auto& [width, height, pixels] :
       {std::tuple{1920, 1080, 1.f}, {640, 360, 2.f}, {200, 120, 1.f}}) {
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DisplayFramebufferScale = {pixels, pixels};
    frame();
    frame();
    const render::Image image = shot();
    EXPECT_EQ(image.width, static_cast<int>(static_cast<float>(width) * pixels));
    EXPECT_EQ(image.height, static_cast<int>(static_cast<float>(height) * pixels));
  }
}

}  // namespace
}  // namespace topple::app
