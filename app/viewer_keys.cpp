#include <imgui.h>

#include "app/viewer.h"

namespace topple::app {
namespace {

// Numbers of keys as GLFW gives them; letters and digits are their capitals in ASCII.
constexpr int k_space = 32, k_escape = 256, k_end = 269, k_home = 268, k_f1 = 290;

bool character(char c) {
  for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters)
    if (typed == static_cast<ImWchar>(c)) return true;
  return false;
}

bool pressed(int key) {
  return ImGui::IsKeyPressed(key, false);
}

struct KeyLine {
  const char* keys;
  const char* does;
};

constexpr KeyLine k_lines[] = {
    {"Space", "play, pause"},
    {", .", "one instant back, on"},
    {"[ ]", "half, twice the speed"},
    {"Home End", "to the start, to the newest instant"},
    {"R", "run again from the start with the sliders as they are"},
    {"C", "continue from here in a new branch"},
    {"Ctrl+Z Ctrl+Shift+Z", "undo, redo a change of a parameter"},
    {"F", "fit the view"},
    {"1 2 3 4", "front, side, top, iso"},
    {"left drag", "turn the view; with Shift, or the right button: move it"},
    {"wheel", "nearer, farther"},
    {"click", "inspect a member; Esc lets go"},
    {"Ctrl+click on a slider", "type a value"},
    {"F1", "this table"},
};

}  // namespace

void Viewer::handle_keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (pressed(k_f1)) keys_shown_ = !keys_shown_;
  if (io.WantTextInput) return;
  if (io.KeyCtrl) {
    if (pressed('Z')) io.KeyShift ? player_.redo() : player_.undo();
    if (pressed('Y')) player_.redo();
    return;
  }
  if (pressed(k_space)) player_.toggle();
  if (character(',')) player_.step(-1);
  if (character('.')) player_.step(1);
  if (character('[')) player_.slower();
  if (character(']')) player_.faster();
  if (pressed(k_home)) player_.to_start();
  if (pressed(k_end)) player_.to_end();
  if (pressed('R')) player_.restart();
  if (pressed('C')) player_.continue_from_here();
  if (pressed('F') || pressed('4')) look(render::NamedView::iso);
  if (pressed('1')) look(render::NamedView::front);
  if (pressed('2')) look(render::NamedView::side);
  if (pressed('3')) look(render::NamedView::top);
  if (pressed(k_escape)) {
    keys_shown_ = false;
    picked_.reset();
    scene_changed_ = true;
  }
}

void Viewer::draw_key_table() {
  ImGui::SetNextWindowPos({scene_.left + scene_.width / 2, scene_.top + scene_.height / 2}, ImGuiCond_Always,
                          {0.5f, 0.5f});
  ImGui::Begin(
      "Keys", &keys_shown_,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyLine& line : k_lines) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line.does);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace topple::app
