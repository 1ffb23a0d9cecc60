#include <imgui.h>

#include <span>

#include "app/viewer.h"

namespace topple::app {
namespace {

bool character(char c) {
  for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters)
    if (typed == static_cast<ImWchar>(c)) return true;
  return false;
}

}  // namespace

/// What is done with keyboard and mouse. key 0: a line of the table only.
struct Viewer::KeyAction {
  const char* shown;
  const char* does;
  int key = 0;
  bool control = false, shift = false;
  void (*act)(Viewer&) = nullptr;
};

// In one table, so that what F1 shows is what happens.
std::span<const Viewer::KeyAction> Viewer::key_actions() {
  static constexpr KeyAction k_actions[] = {
      {"Space", "play, pause", ' ', false, false, [](Viewer& v) { v.player_.toggle(); }},
      {", .", "one instant back, on"},
      {"[ ]", "half, twice the speed"},
      {"Home", "to the start", render::key::home, false, false, [](Viewer& v) { v.player_.to_start(); }},
      {"End", "to the newest instant", render::key::end, false, false, [](Viewer& v) { v.player_.to_end(); }},
      {"R", "run again from the start with the sliders as they are", 'R', false, false,
       [](Viewer& v) { v.player_.restart(); }},
      {"L", "at the end, begin again", 'L', false, false,
       [](Viewer& v) { v.player_.set_loop(!v.player_.loop()); }},
      {"C", "continue from here in a new branch", 'C', false, false,
       [](Viewer& v) { v.player_.continue_from_here(); }},
      {"Ctrl+Z", "take a change of a parameter back", 'Z', true, false, [](Viewer& v) { v.player_.undo(); }},
      {"Ctrl+Shift+Z", "make it again", 'Z', true, true, [](Viewer& v) { v.player_.redo(); }},
      {"Ctrl+click on a slider", "type a value"},
      {"1", "seen from the front", '1', false, false, [](Viewer& v) { v.look(render::NamedView::front); }},
      {"2", "from the side", '2', false, false, [](Viewer& v) { v.look(render::NamedView::side); }},
      {"3", "from the top", '3', false, false, [](Viewer& v) { v.look(render::NamedView::top); }},
      {"4", "from a corner", '4', false, false, [](Viewer& v) { v.look(render::NamedView::iso); }},
      {"F", "fit that view", 'F', false, false, [](Viewer& v) { v.look(v.view_); }},
      {"Q", "colour by the next quantity", 'Q', false, false, [](Viewer& v) { v.next_colour(); }},
      {"A", "arrows of contact forces", 'A', false, false,
       [](Viewer& v) { v.turn(v.settings_.contact_forces); }},
      {"P", "panels of cabinets", 'P', false, false, [](Viewer& v) { v.turn(v.settings_.panels); }},
      {"drag", "turn the view; with Shift or the right button: move it"},
      {"wheel", "nearer, farther"},
      {"click", "inspect a member; once more: its body"},
      {"Esc", "let go of it", render::key::escape, false, false, [](Viewer& v) { v.let_go(); }},
      {"Ctrl+O", "another scene or recording"},
      {"Ctrl+S", "save the scene as it is now"},
      {"Ctrl+E", "export a picture, a video or tables"},
      {"F1", "this table", render::key::f1, false, false, [](Viewer& v) { v.keys_shown_ = !v.keys_shown_; }},
      {"Ctrl+Q", "close the recording and the window"},
  };
  return k_actions;
}

void Viewer::press(const render::KeyPress& press) {
  if (ImGui::GetIO().WantTextInput) return;
  refused_.clear();
  for (const KeyAction& action : key_actions())
    if (action.act && action.key == press.key && action.control == press.control &&
        (action.shift == press.shift || !press.control))
      action.act(*this);
}

void Viewer::next_colour() {
  const auto next = static_cast<std::size_t>(settings_.colour) + 1;
  choose_colour(settings_, static_cast<BeamQuantity>(next % k_beam_quantities));
  scene_changed_ = true;
}

void Viewer::turn(bool& on) {
  on = !on;
  scene_changed_ = true;
}

void Viewer::let_go() {
  keys_shown_ = false;
  inspect(std::nullopt);
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
    for (const KeyAction& action : key_actions()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(action.shown);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(action.does);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace topple::app
