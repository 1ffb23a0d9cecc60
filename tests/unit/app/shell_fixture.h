// The complete window off screen: its content, with mouse and keyboard fed by hand, in a folder of its own.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/window/shell.h"
#include "live.h"
#include "mouse.h"
#include "unit/render/off_screen.h"
#include "unit/render/scratch.h"

namespace topple::app {

namespace fs = std::filesystem;

class ShellTest : public ::testing::Test {
 protected:
  ShellTest() : interface_(ImGui::CreateContext()), stage_(render::off_screen()) {
    setenv("XDG_STATE_HOME", (scratch_ / "state").c_str(), 1);
    setenv("XDG_CACHE_HOME", (scratch_ / "cache").c_str(), 1);
    hold_keys_by_hand();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {1280, 720};
    io.DeltaTime = 1.f / 60;
    io.MousePos = {2, 400};
    shell_.emplace(
        stage_, 1.f, [] {}, TOPPLE_PROGRAM);
  }
  ~ShellTest() override {
    shell_.reset();
    ImGui::DestroyContext(interface_);
    unsetenv("XDG_STATE_HOME");
    unsetenv("XDG_CACHE_HOME");
  }

  virtual void frame() {
    shell_->update(1. / 60);
    ImGui::NewFrame();
    shell_->build();
  }
  template <typename Done>
  ::testing::AssertionResult until(Done done) {
    return eventually([this] { frame(); }, done);
  }
  /// Maps keys as the window does; the keyboard then moves among controls, too.
  static void connect_keyboard() {
#if IMGUI_VERSION_NUM < 18700
    constexpr int keypad_enter = ImGuiKey_KeyPadEnter;
#else
    constexpr int keypad_enter = ImGuiKey_KeypadEnter;
#endif
    const std::pair<int, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                        {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                        {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                        {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                        {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                        {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                        {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                        {ImGuiKey_Home, GLFW_KEY_HOME},
                                        {ImGuiKey_End, GLFW_KEY_END},
                                        {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                        {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                        {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                        {ImGuiKey_Space, GLFW_KEY_SPACE},
                                        {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                        {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                        {keypad_enter, GLFW_KEY_KP_ENTER},
                                        {ImGuiKey_A, GLFW_KEY_A},
                                        {ImGuiKey_C, GLFW_KEY_C},
                                        {ImGuiKey_V, GLFW_KEY_V},
                                        {ImGuiKey_X, GLFW_KEY_X},
                                        {ImGuiKey_Y, GLFW_KEY_Y},
                                        {ImGuiKey_Z, GLFW_KEY_Z}};
    for (const auto& [key, code] : keys) ImGui::GetIO().KeyMap[key] = code;
    ImGui::GetIO().BackendPlatformName = "test";
  }
  /// Presses and releases a key as a person does: Dear ImGui, the program and the text under way see it.
  void tap(int code, bool control = false, bool shift = false) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = control;
    io.KeyShift = shift;
    io.KeysDown[code] = true;
    shell_->press({code, control, shift});
    if (code >= ' ' && code < 127 && !control)
      io.AddInputCharacter(static_cast<unsigned>(shift || !std::isalpha(code) ? code : std::tolower(code)));
    frame();
    io.KeysDown[code] = false;
    io.KeyCtrl = io.KeyShift = false;
    frame();
  }
  void press(int key, bool control = false) {
    shell_->press({key, control, false});
    frame();
    frame();
  }
  void type(const std::string& text) {
    frame();
    frame();  // the field has the keyboard now
    for (const char c : text) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
    frame();
    frame();
  }
  /// Clicks the button of that name in a panel: by default the one over the window.
  void click(const std::string& name, const std::string& panel = "/panel_") {
    ASSERT_TRUE(click_button(name, panel, [this] { frame(); })) << "there is no button " << name;
  }
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (scratch_ / name.c_str()).string();
    std::ofstream(path) << text;
    return path;
  }
  static std::string read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  Player& player() {
    return shell_->session()->player();
  }
  bool ready() {
    return shell_->session() && player().can_edit();
  }
  void open_rocking() {
    shell_->open(write("rocking.toml", k_rocking));
    ASSERT_TRUE(until([&] { return ready(); }));
  }
  /// Slowly: the run must not be over before a slow machine draws the next frame.
  void run_to(double time) {
    for (int i = 0; i < 3; ++i) player().slower();
    player().play();
    ASSERT_TRUE(until([&] { return player().time() >= time; }));
    player().pause();
    ASSERT_TRUE(until([&] { return player().status().kind == LiveStatus::Kind::halted; }));
    for (int i = 0; i < 3; ++i) player().faster();
  }
  void save_as(const std::string& path) {
    shell_->press({'S', true, false});
    path.copy(shell_->save_dialog().path, path.size());
    shell_->save_dialog().path[path.size()] = '\0';
    frame();  // the field has the keyboard now
    frame();
    press(render::key::enter);
  }
  int files_like(const std::string& part) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(scratch_ / ""))
      count += entry.path().filename().string().find(part) != std::string::npos;
    return count;
  }

  const render::Scratch scratch_;
  ImGuiContext* interface_;
  render::Stage stage_;
  std::optional<Shell> shell_;
};

}  // namespace topple::app
