#include <imgui.h>

#include "app/viewer.h"

namespace topple::app {
namespace {

bool character(char c) {
  for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters)
    if (typed == static_cast<ImWchar>(c)) return true;
  return false;
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
    {"Ctrl+Q", "close the recording and the window"},
};

}  // namespace

void Viewer::press(const render::KeyPress& press) {
  if (press.key == render::key::f1) keys_shown_ = !keys_shown_;
  if (ImGui::GetIO().WantTextInput) return;
  if (press.control) {
    if (press.key == 'Z') press.shift ? player_.redo() : player_.undo();
    if (press.key == 'Y') player_.redo();
    if (press.key == 'Q') wants_to_close_ = true;
    return;
  }
  switch (press.key) {
    case ' ':
      return player_.toggle();
    case render::key::home:
      return player_.to_start();
    case render::key::end:
      return player_.to_end();
    case 'R':
      return player_.restart();
    case 'C':
      return player_.continue_from_here();
    case 'F':
      return look(view_);
    case '1':
      return look(render::NamedView::front);
    case '2':
      return look(render::NamedView::side);
    case '3':
      return look(render::NamedView::top);
    case '4':
      return look(render::NamedView::iso);
    case render::key::escape:
      keys_shown_ = false;
      picked_.reset();
      scene_changed_ = true;
      return;
    default:
      return;
  }
}

// These repeat while they are held down, and stand on different keys of different keyboards.
void Viewer::handle_characters() {
  if (ImGui::GetIO().WantTextInput) return;
  if (character(',')) player_.step(-1);
  if (character('.')) player_.step(1);
  if (character('[')) player_.slower();
  if (character(']')) player_.faster();
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
