#include <imgui.h>
#include <imgui_internal.h>

#include <span>

#include "app/picture/furnish_words.h"
#include "app/picture/row.h"
#include "app/picture/window_words.h"
#include "app/window/viewer.h"

namespace topple::app {
namespace {

using namespace window_words;
namespace fw = furnish_words;

bool character(char c) {
  for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters)
    if (typed == static_cast<ImWchar>(c)) return true;
  return false;
}

}  // namespace

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
      {{"L", "L"}, k_key_loop, 'L', false, false, [](Viewer& v) { v.player_.set_loop(!v.player_.loop()); }},
      {{"C", "C"}, k_key_continue, 'C', false, false, [](Viewer& v) { v.go_on_from_here(); }},
      {{"Ctrl+Z", "Ctrl+Z"}, k_key_undo, 'Z', true, false, [](Viewer& v) { v.player_.undo(); }},
      {{"Ctrl+Shift+Z", "Ctrl+Shift+Z"}, k_key_redo, 'Z', true, true, [](Viewer& v) { v.player_.redo(); }},
      {k_ctrl_click, k_key_type},
      {{"1", "1"}, k_key_front, '1', false, false, [](Viewer& v) { v.fit_view(render::NamedView::front); }},
      {{"2", "2"}, k_key_side, '2', false, false, [](Viewer& v) { v.fit_view(render::NamedView::side); }},
      {{"3", "3"}, k_key_top, '3', false, false, [](Viewer& v) { v.fit_view(render::NamedView::top); }},
      {{"4", "4"}, k_key_corner, '4', false, false, [](Viewer& v) { v.fit_view(render::NamedView::iso); }},
      {{"F", "F"}, k_key_fit, 'F', false, false, [](Viewer& v) { v.fit_view(v.view_); }},
      {{"K", "K"}, fw::k_key_keep, 'K', false, false, [](Viewer& v) { v.turn(v.keeps_in_picture_); }},
      {{"T", "T"}, k_key_follow, 'T', false, false, [](Viewer& v) { v.toggle_following(); }},
      {{"Q", "Q"}, k_key_quantity, 'Q', false, false, [](Viewer& v) { v.next_colour(); }},
      {{"A", "A"}, k_key_forces, 'A', false, false, [](Viewer& v) { v.turn(v.settings_.contact_forces); }},
      {{"P", "P"}, k_key_panels, 'P', false, false, [](Viewer& v) { v.turn(v.settings_.panels); }},
      {{"S", "S"}, fw::k_key_solid, 'S', false, false, [](Viewer& v) { v.next_bodies(); }},
      {k_drag, k_key_turn},
      {k_wheel, k_key_wheel},
      {k_click, k_key_click},
      {k_ctrl_drag, k_key_pull},
      {{"Esc", "Esc"}, k_key_let_go, render::key::escape, false, false, [](Viewer& v) { v.let_go(); }},
      {{"H", "H"}, fw::k_key_hide, 'H', false, false, [](Viewer& v) { v.turn(v.panels_hidden_); }},
      {{"F11", "F11"}, fw::k_key_full_screen},
      {{"F2", "F2"}, fw::k_key_furnish},
      {{"Ctrl+O", "Ctrl+O"}, k_key_scenes},
      {{"Ctrl+S", "Ctrl+S"}, k_key_save},
      {{"Ctrl+E", "Ctrl+E"}, k_key_export},
      {{"F6", "F6"}, k_key_panel, render::key::f6, false, false, [](Viewer& v) { v.to_next_panel_ = true; }},
      {{"Tab", "Tab"},
       k_key_tab,
       render::key::tab,
       false,
       false,
       [](Viewer& v) { v.to_next_panel_ = !ImGui::GetIO().NavActive; }},
      {k_arrows, k_key_arrows},
      {{"Ctrl +, Ctrl -, Ctrl+0", "Ctrl +、Ctrl -、Ctrl+0"}, k_key_size},
      {{}, {}, '+', true, false, [](Viewer& v) { v.resize(1); }},
      {{}, {}, '+', true, true, [](Viewer& v) { v.resize(1); }},
      {{}, {}, '=', true, false, [](Viewer& v) { v.resize(1); }},
      {{}, {}, '=', true, true, [](Viewer& v) { v.resize(1); }},
      {{}, {}, render::key::keypad_plus, true, false, [](Viewer& v) { v.resize(1); }},
      {{}, {}, '-', true, false, [](Viewer& v) { v.resize(-1); }},
      {{}, {}, render::key::keypad_minus, true, false, [](Viewer& v) { v.resize(-1); }},
      {{}, {}, '0', true, false, [](Viewer& v) { v.resize(0); }},
      {{"Ctrl+D", "Ctrl+D"},
       k_key_theme,
       'D',
       true,
       false,
       [](Viewer& v) {
         Appearance other = v.appearance_;
         other.dark = !other.dark;
         v.choose_appearance(other);
       }},
      {{"F1", "F1"},
       k_key_table,
       render::key::f1,
       false,
       false,
       [](Viewer& v) { v.keys_shown_ = !v.keys_shown_; }},
      {{"Ctrl+Q", "Ctrl+Q"}, k_key_quit},
  };
  return k_actions;
}

void Viewer::press(const render::KeyPress& press) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput) return;
  const bool to_an_end = press.key == render::key::home || press.key == render::key::end;
  if (io.NavVisible && (to_an_end || press.key == ' ')) return;  // the control that has the focus takes it
  if (to_an_end) ImGui::SetWindowFocus(nullptr);  // of a panel it would move the focus, and show it
  refused_.clear();
  for (const KeyAction& action : key_actions())
    if (action.act && action.key == press.key && action.control == press.control &&
        (action.shift == press.shift || !press.control))
      action.act(*this);
}

void Viewer::toggle_following() {
  const Model& model = player_.scene().setup.model;
  message_.clear();
  if (follows_ || !row_ || model.furniture_total() == 0) {
    follow(std::nullopt);
    return;
  }
  const std::size_t body = body_of(model, inspection_.picked.value_or(Subject{Subject::Kind::body, 0}));
  follow(body);
  message_ = say(k_follows, model.bodies[body].name);
}

void Viewer::go_on_from_here() {
  if (player_.at_head()) message_ = say(k_at_newest);
  player_.continue_from_here();
}

void Viewer::next_colour() {
  const std::size_t next = (place_of(settings_.colour) + 1) % beam_quantities().size();
  choose_colour(settings_, beam_quantities()[next].kind);
  scene_changed_ = true;
}

void Viewer::next_bodies() {
  settings_.bodies =
      static_cast<Bodies>((static_cast<std::size_t>(settings_.bodies) + 1) % std::size(k_bodies_traits));
  scene_changed_ = true;
}

void Viewer::turn(bool& on) {
  on = !on;
  scene_changed_ = true;
}

void Viewer::resize(int direction) {
  Appearance other = appearance_;
  other.scale = next_scale(other.scale, direction);
  choose_appearance(other);
}

// Dear ImGui's own way, Ctrl+Tab, shows its names of panels.
void Viewer::focus_next_panel() {
  static constexpr const char* k_panels[] = {"side",  "load path", "transport",   "timeline",
                                             "plots", "status",    "###precision"};
  const ImGuiWindow* const now = ImGui::GetCurrentContext()->NavWindow;
  std::size_t next = 0;
  for (std::size_t i = 0; i < std::size(k_panels); ++i)
    if (now && now->RootWindow == ImGui::FindWindowByName(k_panels[i])) next = i + 1;
  for (std::size_t i = 0; i < std::size(k_panels); ++i) {
    ImGuiWindow* const window = ImGui::FindWindowByName(k_panels[(next + i) % std::size(k_panels)]);
    if (!window || !window->WasActive) continue;
    ImGui::FocusWindow(window);
    ImGui::NavInitWindow(window, true);
    ImGuiContext& context = *ImGui::GetCurrentContext();
    context.NavDisableHighlight = false;
    context.NavDisableMouseHover = true;
    return;
  }
}

void Viewer::let_go() {
  keys_shown_ = precision_.open = false;
  if (precision_.search) precision_.search->stop();
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
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.98f * size.x, 0.95f * size.y});
  ImGui::Begin(
      (say(k_keys) + "###keys").c_str(), &keys_shown_,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyAction& action : key_actions()) {
      if (action.shown.english.empty()) continue;
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
