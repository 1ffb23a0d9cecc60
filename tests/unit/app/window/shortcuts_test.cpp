// Every line of the key table does what it says, in the complete window. Who adds a key adds its line here.
#include <map>
#include <set>

#include "app/picture/row.h"
#include "unit/app/shell_fixture.h"

namespace topple::app {
namespace {

using Line = Viewer::KeyAction;

class Shortcut : public ShellTest {
 protected:
  void SetUp() override {
    setenv("XDG_CONFIG_HOME", (scratch_ / "config").c_str(), 1);
    connect_keyboard();
    open_rocking();
    frame();
  }
  Viewer& viewer() { return shell_->session()->viewer(); }
  void halted() {
    ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::halted; }));
  }
  void change_amplitude() {
    player().begin_edit();
    player().edit({Edit::Key::amplitude, 0, Vec3(100 * k_gal, 0, 0)});
  }
  double amplitude_gal() { return player().parameters().shakes[0].amplitude / k_gal; }
  /// Azimuth and elevation when the camera has arrived, degrees.
  std::pair<double, double> sight() {
    for (int i = 0; i < 30; ++i) frame();
    const auto degrees = [](double angle) { return std::remainder(angle * 180 / k_pi, 360.); };
    return {degrees(viewer().orbit().sight.azimuth), degrees(viewer().orbit().sight.elevation)};
  }
  void expect_named_view(int key, render::NamedView view) {
    tap(key);
    sight();
    render::SceneFrame any;
    const render::Orbit wanted = render::Orbit::fit(view, any, 1.5f);
    EXPECT_NEAR(viewer().orbit().sight.azimuth, wanted.sight.azimuth, 1e-4);
    EXPECT_NEAR(viewer().orbit().sight.elevation, wanted.sight.elevation, 1e-4);
  }
  ImVec2 middle() {
    const Box& box = viewer().scene_box();
    return {box.left + box.width / 2, box.top + 0.6f * box.height};
  }
  void drag(ImVec2 by, int button, bool shift = false) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = middle();
    io.KeyShift = shift;
    frame();
    frame();
    io.MouseDown[button] = true;
    frame();
    for (int i = 1; i <= 4; ++i) {
      io.MousePos = {middle().x + by.x * static_cast<float>(i) / 4,
                     middle().y + by.y * static_cast<float>(i) / 4};
      frame();
    }
    io.MouseDown[button] = false;
    io.KeyShift = false;
    frame();
    frame();
  }
  static std::string focused() {
    const ImGuiWindow* const window = ImGui::GetCurrentContext()->NavWindow;
    return window ? window->RootWindow->Name : "";
  }
  static bool seen(const char* window) {
    const ImGuiWindow* const found = ImGui::FindWindowByName(window);
    return found && found->WasActive;
  }

  // One for each line, by what stands on its left.
  void space() {
    tap(' ');
    EXPECT_TRUE(player().playing());
    tap(' ');
    EXPECT_FALSE(player().playing());
  }
  void step() {
    run_to(0.1);
    const double time = player().time();
    tap(',');
    const double before = player().time();
    EXPECT_LT(before, time);
    tap(',');
    EXPECT_NEAR(player().time(), before - 0.01, 1e-6);  // an output interval
    tap('.');
    EXPECT_EQ(player().time(), before);
  }
  void speed() {
    tap('[');
    EXPECT_EQ(player().speed(), 0.5);
    tap(']');
    tap(']');
    EXPECT_EQ(player().speed(), 2);
  }
  void start_and_end() {
    run_to(0.1);
    tap(GLFW_KEY_HOME);
    EXPECT_EQ(player().time(), 0);
    tap(GLFW_KEY_END);
    EXPECT_TRUE(player().at_head());
    EXPECT_GE(player().time(), 0.1);
  }
  void restart() {
    run_to(0.1);
    change_amplitude();
    tap('R');
    ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && ready(); }));
    EXPECT_EQ(player().time(), 0);
    EXPECT_NEAR(amplitude_gal(), 100, 1e-9);
  }
  void loop() {
    tap('L');
    EXPECT_TRUE(player().loop());
    tap('L');
    EXPECT_FALSE(player().loop());
  }
  void continue_here() {
    run_to(0.2);
    player().scrub(0.1);
    tap('C');
    ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && ready(); }));
    EXPECT_NEAR(player().time(), 0.1, 0.011);
  }
  void undo_and_redo() {
    change_amplitude();
    tap('Z', true);
    EXPECT_NEAR(amplitude_gal(), 300, 1e-9);
    tap('Z', true, true);
    EXPECT_NEAR(amplitude_gal(), 100, 1e-9);
  }
  void type_a_value() {
    ImGuiIO& io = ImGui::GetIO();
    const ImGuiWindow* side = nullptr;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
      if (std::string_view(window->Name).starts_with("side/content")) side = window;
    ASSERT_NE(side, nullptr);
    const ImGuiID id =
        ImHashStr("##value", 0, ImHashStr("shake.1.amplitude", 0, ImHashStr("amplitude", 0, side->ID)));
    for (float y = side->Pos.y; y < side->Pos.y + side->Size.y && ImGui::GetHoveredID() != id; y += 8) {
      io.MousePos = {side->Pos.x + side->Size.x / 2, y};
      frame();
    }
    ASSERT_EQ(ImGui::GetHoveredID(), id);
    io.KeyCtrl = io.MouseDown[0] = true;
    frame();
    io.KeyCtrl = io.MouseDown[0] = false;
    frame();
    type("123.4");
    tap(GLFW_KEY_ENTER);
    EXPECT_NEAR(amplitude_gal(), 123.4, 1e-12);  // a decimal number, not the single-precision one beside it
  }
  void fit() {
    const render::Orbit first = (sight(), viewer().orbit());
    ImGui::GetIO().MousePos = middle();
    frame();
    ImGui::GetIO().MouseWheel = 4;
    frame();
    EXPECT_LT(viewer().orbit().distance, 0.8 * first.distance);
    tap('F');
    sight();
    EXPECT_NEAR(viewer().orbit().distance, first.distance, 1e-3 * first.distance);
  }
  void keep() {
    sight();
    const auto nearer = [&] {
      ImGui::GetIO().MousePos = middle();
      frame();
      ImGui::GetIO().MouseWheel = 12;
      frame();
      frame();
      return viewer().orbit().distance;
    };
    const float whole = viewer().orbit().distance, near = nearer();
    ASSERT_LT(near, 0.3f * whole);
    tap('K');  // the body is not all there
    EXPECT_GT(viewer().orbit().distance, 2 * near);
    EXPECT_LT(viewer().orbit().distance, 1.5f * whole);
    tap('K');
    EXPECT_FALSE(viewer().keeps_in_picture());
    const float left = nearer();
    frame();
    EXPECT_EQ(viewer().orbit().distance, left);
  }
  void follow() {
    sight();
    const auto seen_from = [&] { return viewer().orbit().target; };
    const auto centre = [&] { return centre_of(*player().row(), 0); };
    tap('T');
    frame();
    const Eigen::Vector3f target = seen_from(), before = centre();
    run_to(0.3);
    for (int i = 0; i < 5; ++i) frame();
    EXPECT_GT((centre() - before).norm(), 1e-3f);
    EXPECT_LT((seen_from() - target - (centre() - before)).norm(), 1e-5f);
    tap('T');
    const Eigen::Vector3f left = seen_from();
    run_to(0.5);
    EXPECT_EQ(seen_from(), left);
  }
  void colour() {
    tap('Q');
    EXPECT_EQ(viewer().settings().colour, BeamQuantity::yield_ratio);
  }
  void forces() {
    const bool before = viewer().settings().contact_forces;
    tap('A');
    EXPECT_NE(viewer().settings().contact_forces, before);
  }
  void panels() {
    const bool before = viewer().settings().panels;
    tap('P');
    EXPECT_NE(viewer().settings().panels, before);
  }
  void solid() {
    for (const Bodies next : {Bodies::solid, Bodies::both, Bodies::beams}) {
      tap('S');
      EXPECT_EQ(viewer().settings().bodies, next);
    }
  }
  void hide() {
    const float before = viewer().scene_box().width;
    tap('H');
    frame();
    EXPECT_GT(viewer().scene_box().width, before + 100);
    tap('H');
    frame();
    EXPECT_EQ(viewer().scene_box().width, before);
  }
  void full_screen() {
    EXPECT_FALSE(shell_->take_full_screen());
    tap(GLFW_KEY_F11);
    EXPECT_TRUE(shell_->take_full_screen());
    EXPECT_FALSE(shell_->take_full_screen());
  }
  void furnish() {
    tap(GLFW_KEY_F2);
    EXPECT_TRUE(shell_->furnishing());
    tap(GLFW_KEY_F2);
    EXPECT_FALSE(shell_->furnishing());
  }
  void turn_and_move() {
    const auto before = sight();
    const Eigen::Vector3f target = viewer().orbit().target;
    drag({80, 0}, 0);
    EXPECT_NE(sight(), before);
    EXPECT_EQ(viewer().orbit().target, target);
    for (const bool with_shift : {true, false}) {
      const auto turned = sight();
      const Eigen::Vector3f there = viewer().orbit().target;
      drag({80, 0}, with_shift ? 0 : 1, with_shift);
      EXPECT_EQ(sight(), turned);
      EXPECT_NE(viewer().orbit().target, there);
    }
  }
  /// The mouse lies on a body that a click picks.
  void point_at_a_body() {
    sight();
    const Box& box = viewer().scene_box();
    ImGuiIO& io = ImGui::GetIO();
    for (float x = 0.3f; x < 0.7f && !viewer().inspection().picked; x += 0.005f) {
      io.MousePos = {box.left + x * box.width, box.top + 0.6f * box.height};
      frame();
      io.MouseDown[0] = true;
      frame();
      io.MouseDown[0] = false;
      frame();
    }
    ASSERT_TRUE(viewer().inspection().picked.has_value());
  }
  const std::vector<Pull>& pulls() { return player().parameters().pulls; }
  void pull() {
    point_at_a_body();
    ImGuiIO& io = ImGui::GetIO();
    const auto take_hold = [&] {
      io.KeyCtrl = io.MouseDown[0] = true;
      frame();
    };
    const auto let_go = [&] {
      io.KeyCtrl = io.MouseDown[0] = false;
      frame();
    };
    halted();
    take_hold();
    EXPECT_NE(viewer().message(), "");  // nothing runs
    EXPECT_TRUE(pulls().empty());
    let_go();
    const auto before = sight();
    for (int i = 0; i < 3; ++i) player().slower();  // as run_to
    tap(' ');
    take_hold();
    const ImVec2 from = io.MousePos;
    for (int i = 1; i <= 6; ++i) {
      io.MousePos.x = from.x + 15 * static_cast<float>(i);
      frame();
    }
    ASSERT_EQ(pulls().size(), 1u);
    EXPECT_GT(pulls()[0].force.norm(), 1);
    EXPECT_EQ(std::pair(before.first, before.second), sight());  // the view stays
    EXPECT_LE(pulls()[0].force.norm(),
              1.0001 * k_standard_gravity * player().scene().setup.model.bodies[0].mass);
    let_go();
    EXPECT_TRUE(pulls().empty() || pulls()[0].force.isZero(0));
    EXPECT_FALSE(player().can_undo());
  }
  /// Back to an instant at which it was pulled: it is not any more.
  void pull_is_not_taken_up() {
    tap(' ');
    for (int i = 0; i < 3; ++i) player().faster();
    ASSERT_TRUE(until([&] { return player().edits().size() > 2; }));
    const double pulled = player().edits().front().time + 0.02;
    run_to(pulled + 0.1);
    player().scrub(pulled);
    tap('C');
    ASSERT_TRUE(until([&] { return player().history().branches.size() == 2 && ready(); }));
    frame();
    for (const Pull& one : pulls()) EXPECT_TRUE(one.force.isZero(0));
  }
  void nearer() {
    sight();
    const auto distance = viewer().orbit().distance;
    ImGui::GetIO().MousePos = middle();
    frame();
    ImGui::GetIO().MouseWheel = 2;
    frame();
    EXPECT_LT(viewer().orbit().distance, distance);
    ImGui::GetIO().MouseWheel = -4;
    frame();
    EXPECT_GT(viewer().orbit().distance, distance);
  }
  void inspect_and_let_go() {
    point_at_a_body();
    EXPECT_EQ(viewer().inspection().picked->kind, Subject::Kind::member);
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    EXPECT_EQ(viewer().inspection().picked->kind, Subject::Kind::body);
    tap(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(viewer().inspection().picked.has_value());
  }
  void scenes() {
    tap('O', true);
    EXPECT_TRUE(shell_->chooser().is_open());
    tap(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(shell_->chooser().is_open());
  }
  void save() {
    tap('S', true);
    EXPECT_TRUE(shell_->save_dialog().is_open());
    tap(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(shell_->save_dialog().is_open());
  }
  void export_view() {
    tap('E', true);
    EXPECT_TRUE(shell_->export_dialog().is_open());
    tap(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(shell_->export_dialog().is_open());
  }
  void next_panel() {
    std::vector<std::string> order;
    for (int i = 0; i < 4; ++i) {
      tap(GLFW_KEY_F6);
      order.push_back(focused());
    }
    EXPECT_EQ(order, (std::vector<std::string>{"side", "transport", "timeline", "status"}));
  }
  void tab_and_arrows(int key) {
    tap(GLFW_KEY_F6);
    std::set<ImGuiID> been;
    for (int i = 0; i < 4; ++i) {
      tap(key);
      EXPECT_EQ(focused(), "side");
      been.insert(ImGui::GetCurrentContext()->NavId);
    }
    EXPECT_GE(been.size(), 3u);
  }
  void space_uses_a_control() {
    for (int i = 0; i < 5 && focused() != "transport"; ++i) tap(GLFW_KEY_F6);
    tap(GLFW_KEY_RIGHT);
    tap(GLFW_KEY_RIGHT);
    tap(' ');
    EXPECT_TRUE(player().playing());  // the third button
    tap(' ');
    EXPECT_FALSE(player().playing());
  }
  void enter_types_a_value() {
    halted();
    for (int i = 0; i < 5 && focused() != "side"; ++i) tap(GLFW_KEY_F6);
    const std::vector<double> before = values();
    for (int i = 0; i < 12 && values() == before; ++i) {
      tap(GLFW_KEY_DOWN);
      tap(GLFW_KEY_ENTER);
      if (!ImGui::GetIO().WantTextInput) continue;
      type("1.5");
      tap(GLFW_KEY_ENTER);
    }
    EXPECT_NE(values(), before);
  }
  /// Of all that sliders change.
  std::vector<double> values() {
    std::vector<double> all;
    const Parameters& now = player().parameters();
    for (const auto& [key, shake] : editable(player().scene().setup.model, now))
      all.push_back(edited_value(now, key, shake).x());
    return all;
  }
  void size() {
    for (const Line& line : Viewer::key_actions()) {
      if (!line.shown.english.empty()) continue;
      tap('0', true);
      const double before = viewer().appearance().scale;
      EXPECT_EQ(before, 1);
      tap(line.key, line.control, line.shift);
      const double now = viewer().appearance().scale;
      const bool plus = line.key == '+' || line.key == '=' || line.key == GLFW_KEY_KP_ADD;
      const bool minus = line.key == '-' || line.key == GLFW_KEY_KP_SUBTRACT;
      EXPECT_TRUE(plus ? now > before : minus ? now < before : line.key == '0' && now == before) << line.key;
    }
    tap('+', true);
    tap('0', true);
    EXPECT_EQ(viewer().appearance().scale, 1);
  }
  void theme() {
    tap('D', true);
    EXPECT_TRUE(viewer().appearance().dark);
    tap('D', true);
    EXPECT_FALSE(viewer().appearance().dark);
  }
  void key_table() {
    tap(GLFW_KEY_F1);
    frame();
    EXPECT_TRUE(seen("###keys"));
    tap(GLFW_KEY_F1);
    frame();
    EXPECT_FALSE(seen("###keys"));
  }
  void quit() {
    EXPECT_FALSE(shell_->wants_to_close());
    tap('Q', true);
    EXPECT_TRUE(shell_->wants_to_close());
  }

 public:
  using Check = void (*)(Shortcut&);
  static const std::map<std::string_view, Check>& checks() {
    using T = Shortcut;
    static const std::map<std::string_view, Check> all = {
        {"Space", [](T& t) { t.space(); }},
        {", .", [](T& t) { t.step(); }},
        {"[ ]", [](T& t) { t.speed(); }},
        {"Home", [](T& t) { t.start_and_end(); }},
        {"End", [](T& t) { t.start_and_end(); }},
        {"R", [](T& t) { t.restart(); }},
        {"L", [](T& t) { t.loop(); }},
        {"C", [](T& t) { t.continue_here(); }},
        {"Ctrl+Z", [](T& t) { t.undo_and_redo(); }},
        {"Ctrl+Shift+Z", [](T& t) { t.undo_and_redo(); }},
        {"Ctrl+click on a slider", [](T& t) { t.type_a_value(); }},
        {"1", [](T& t) { t.expect_named_view('1', render::NamedView::front); }},
        {"2", [](T& t) { t.expect_named_view('2', render::NamedView::side); }},
        {"3", [](T& t) { t.expect_named_view('3', render::NamedView::top); }},
        {"4", [](T& t) { t.expect_named_view('4', render::NamedView::iso); }},
        {"F", [](T& t) { t.fit(); }},
        {"K", [](T& t) { t.keep(); }},
        {"T", [](T& t) { t.follow(); }},
        {"Q", [](T& t) { t.colour(); }},
        {"A", [](T& t) { t.forces(); }},
        {"P", [](T& t) { t.panels(); }},
        {"S", [](T& t) { t.solid(); }},
        {"H", [](T& t) { t.hide(); }},
        {"F11", [](T& t) { t.full_screen(); }},
        {"F2", [](T& t) { t.furnish(); }},
        {"drag", [](T& t) { t.turn_and_move(); }},
        {"wheel", [](T& t) { t.nearer(); }},
        {"click", [](T& t) { t.inspect_and_let_go(); }},
        {"Ctrl+drag",
         [](T& t) {
           t.pull();
           t.pull_is_not_taken_up();
         }},
        {"Esc", [](T& t) { t.inspect_and_let_go(); }},
        {"Ctrl+O", [](T& t) { t.scenes(); }},
        {"Ctrl+S", [](T& t) { t.save(); }},
        {"Ctrl+E", [](T& t) { t.export_view(); }},
        {"F6", [](T& t) { t.next_panel(); }},
        {"Tab", [](T& t) { t.tab_and_arrows(GLFW_KEY_TAB); }},
        {"arrows",
         [](T& t) {
           t.tab_and_arrows(GLFW_KEY_DOWN);
           t.space_uses_a_control();
           t.enter_types_a_value();
         }},
        {"Ctrl +, Ctrl -, Ctrl+0", [](T& t) { t.size(); }},
        {"Ctrl+D", [](T& t) { t.theme(); }},
        {"F1", [](T& t) { t.key_table(); }},
        {"Ctrl+Q", [](T& t) { t.quit(); }},
    };
    return all;
  }
};

class KeyTable : public Shortcut, public ::testing::WithParamInterface<std::size_t> {};

TEST_P(KeyTable, line_does_what_it_says) {
  const std::string_view keys = Viewer::key_actions()[GetParam()].shown.english;
  SCOPED_TRACE(keys);
  const auto check = checks().find(keys);
  ASSERT_NE(check, checks().end()) << "no test of this line";
  check->second(*this);
}

std::vector<std::size_t> lines() {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < Viewer::key_actions().size(); ++i)
    if (!Viewer::key_actions()[i].shown.english.empty()) shown.push_back(i);
  return shown;
}
INSTANTIATE_TEST_SUITE_P(Every, KeyTable, ::testing::ValuesIn(lines()));

}  // namespace
}  // namespace topple::app
