#include <imgui.h>

#include <span>

#include "app/viewer.h"
#include "app/window_words.h"

namespace topple::app {
namespace {

using namespace window_words;

bool character(char c) {
  for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters)
    if (typed == static_cast<ImWchar>(c)) return true;
  return false;
}

}  // namespace

/// What is done with keyboard and mouse. key 0: a line of the table only.
struct Viewer::KeyAction {
  Phrase shown, does;
  int key = 0;
  bool control = false, shift = false;
  void (*act)(Viewer&) = nullptr;
};

// In one table, so that what F1 shows is what happens.
std::span<const Viewer::KeyAction> Viewer::key_actions() {
  static constexpr KeyAction k_actions[] = {
      {{"Space", "Space"}, k_key_play, ' ', false, false, [](Viewer& v) { v.player_.toggle(); }},
      {{", .", ", ."}, k_key_step},
      {{"[ ]", "[ ]"}, k_key_speed},
      {{"Home", "Home"},
       k_key_start,
       render::key::home,
       false,
       false,
       [](Viewer& v) { v.player_.to_start(); }},
      {{"End", "End"}, k_key_end, render::key::end, false, false, [](Viewer& v) { v.player_.to_end(); }},
      {{"R", "R"}, k_key_restart, 'R', false, false, [](Viewer& v) { v.player_.restart(); }},
      {{"C", "C"}, k_key_continue, 'C', false, false, [](Viewer& v) { v.player_.continue_from_here(); }},
      {{"Ctrl+Z", "Ctrl+Z"}, k_key_undo, 'Z', true, false, [](Viewer& v) { v.player_.undo(); }},
      {{"Ctrl+Shift+Z", "Ctrl+Shift+Z"}, k_key_redo, 'Z', true, true, [](Viewer& v) { v.player_.redo(); }},
      {k_ctrl_click, k_key_type},
      {{"1", "1"}, k_key_front, '1', false, false, [](Viewer& v) { v.look(render::NamedView::front); }},
      {{"2", "2"}, k_key_side, '2', false, false, [](Viewer& v) { v.look(render::NamedView::side); }},
      {{"3", "3"}, k_key_top, '3', false, false, [](Viewer& v) { v.look(render::NamedView::top); }},
      {{"4", "4"}, k_key_corner, '4', false, false, [](Viewer& v) { v.look(render::NamedView::iso); }},
      {{"F", "F"}, k_key_fit, 'F', false, false, [](Viewer& v) { v.look(v.view_); }},
      {{"Q", "Q"}, k_key_quantity, 'Q', false, false, [](Viewer& v) { v.next_colour(); }},
      {{"A", "A"}, k_key_forces, 'A', false, false, [](Viewer& v) { v.turn(v.settings_.contact_forces); }},
      {{"P", "P"}, k_key_panels, 'P', false, false, [](Viewer& v) { v.turn(v.settings_.panels); }},
      {k_drag, k_key_turn},
      {k_wheel, k_key_wheel},
      {k_click, k_key_click},
      {{"Esc", "Esc"}, k_key_let_go, render::key::escape, false, false, [](Viewer& v) { v.let_go(); }},
      {{"F1", "F1"},
       k_key_table,
       render::key::f1,
       false,
       false,
       [](Viewer& v) { v.keys_shown_ = !v.keys_shown_; }},
      {{"Ctrl+Q", "Ctrl+Q"}, k_key_quit, 'Q', true, false, [](Viewer& v) { v.wants_to_close_ = true; }},
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
      (say(k_keys) + "###keys").c_str(), &keys_shown_,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyAction& action : key_actions()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(say(action.shown).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(say(action.does).c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace topple::app
