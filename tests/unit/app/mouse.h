// The mouse of a person who looks for a button.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>

#include <string>

namespace topple::app {

/// Keys and modifiers are what is written into ImGuiIO; from 1.87 on Dear ImGui otherwise waits for events.
inline void hold_keys_by_hand() {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().BackendUsingLegacyKeyArrays = 1;
#endif
}

/// Presses and releases the left button at a place; `frame` draws one.
template <typename Frame>
void click_at(ImVec2 at, Frame frame) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = at;
  frame();
  frame();
  io.MouseDown[0] = true;
  frame();
  io.MouseDown[0] = false;
  frame();
  frame();
}

/// Clicks the button of that name in a window whose name has `panel` in it, which is scrolled to it. False:
/// there is none.
template <typename Frame>
bool click_button(const std::string& name, const std::string& panel, Frame frame) {
  frame();
  const auto windows = ImGui::GetCurrentContext()->Windows;  // a frame may add some
  for (ImGuiWindow* const window : windows) {
    if (!window->Active || std::string(window->Name).find(panel) == std::string::npos) continue;
    const ImGuiID id = ImHashStr(name.c_str(), 0, window->ID);
    for (float scroll = 0; scroll == 0 || scroll < window->ScrollMax.y + window->Size.y / 2;
         scroll += window->Size.y / 2) {
      ImGui::SetScrollY(window, scroll);
      frame();
      for (float y = window->Pos.y + 5; y < window->Pos.y + window->Size.y; y += 9)
        for (float x = window->Pos.x + 5; x < window->Pos.x + window->Size.x; x += 20) {
          ImGui::GetIO().MousePos = {x, y};
          frame();
          // GetHoveredID() may be that of the frame before
          if (ImGui::GetCurrentContext()->HoveredId != id) continue;
          click_at({x, y}, frame);
          return true;
        }
    }
  }
  return false;
}

}  // namespace topple::app
