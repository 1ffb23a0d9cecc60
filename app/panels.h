// The parts of the window around the scene. Each draws into the Dear ImGui frame under way.
#pragma once

#include <optional>
#include <string>

#include "app/player.h"
#include "render/scene_frame.h"

namespace topple::app {

/// A rectangle of the window, in Dear ImGui's coordinates.
struct Box {
  float left = 0, top = 0, width = 0, height = 0;
  bool contains(float x, float y) const {
    return x >= left && x < left + width && y >= top && y < top + height;
  }
};

/// Begins a window that fills `box` and does nothing else; ImGui::End() ends it.
void begin_panel(const char* name, const Box& box);

/// Buttons for play, pause, steps, speed, restart, branches, undo and redo.
void draw_transport_bar(Player& player, const Box& box);

/// Floor acceleration (statics: load factor) and tilt over time (statics: over the load path), with marks for
/// events, edits and forks; dragging scrubs.
void draw_timeline(Player& player, const Box& box);

/// Sliders of what may be edited. What was refused, and why, is left in `refused`.
void draw_parameters(Player& player, std::string& refused);

/// Stress and section forces of `member` in `row`; beyond the last member those of an anchor (Tube::member).
void draw_inspector(const Model& model, const io::FrameRow& row, std::size_t member);

}  // namespace topple::app
