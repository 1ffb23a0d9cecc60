#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <tuple>

#include "app/panels.h"
#include "app/shell_words.h"
#include "app/words.h"

namespace topple::app {
namespace {

enum class Icon { to_start, back, play, pause, on, to_end, restart, loop };

/// Filled triangle that points right (1) or left (-1), in a square of side 2 about (x, y).
void add_arrow(ImDrawList& list, float x, float y, float half, float direction, ImU32 colour) {
  const float tip = x + direction * half, base = x - direction * half;
  ImVec2 corners[3] = {{base, y - half}, {tip, y}, {base, y + half}};
  if (direction < 0) std::swap(corners[0], corners[2]);
  list.AddTriangleFilled(corners[0], corners[1], corners[2], colour);
}

void add_icon(ImDrawList& list, Icon icon, ImVec2 at, float r, ImU32 colour) {
  const auto bar = [&](float x) {
    list.AddRectFilled({at.x + x - 0.16f * r, at.y - r}, {at.x + x + 0.16f * r, at.y + r}, colour);
  };
  switch (icon) {
    case Icon::to_start:
      bar(-0.75f * r);
      add_arrow(list, at.x + 0.25f * r, at.y, 0.8f * r, -1, colour);
      break;
    case Icon::back:
      add_arrow(list, at.x - 0.3f * r, at.y, 0.65f * r, -1, colour);
      bar(0.7f * r);
      break;
    case Icon::play:
      add_arrow(list, at.x + 0.1f * r, at.y, r, 1, colour);
      break;
    case Icon::pause:
      bar(-0.45f * r);
      bar(0.45f * r);
      break;
    case Icon::on:
      bar(-0.7f * r);
      add_arrow(list, at.x + 0.3f * r, at.y, 0.65f * r, 1, colour);
      break;
    case Icon::to_end:
      add_arrow(list, at.x - 0.25f * r, at.y, 0.8f * r, 1, colour);
      bar(0.75f * r);
      break;
    case Icon::restart:
      list.PathArcTo(at, 0.85f * r, -0.3f * static_cast<float>(k_pi), 1.45f * static_cast<float>(k_pi), 20);
      list.PathStroke(colour, 0, 0.28f * r);
      list.AddTriangleFilled({at.x + 0.1f * r, at.y - 1.35f * r}, {at.x + 0.95f * r, at.y - 0.75f * r},
                             {at.x + 0.1f * r, at.y - 0.15f * r}, colour);
      break;
    case Icon::loop:  // two arrows after each other
      for (const float s : {1.f, -1.f}) {
        list.AddLine({at.x - 0.9f * s * r, at.y + 0.35f * s * r}, {at.x - 0.9f * s * r, at.y - 0.5f * s * r},
                     colour, 0.26f * r);
        list.AddLine({at.x - 0.9f * s * r, at.y - 0.5f * s * r}, {at.x + 0.4f * s * r, at.y - 0.5f * s * r},
                     colour, 0.26f * r);
        add_arrow(list, at.x + 0.6f * s * r, at.y - 0.5f * s * r, 0.45f * r, s, colour);
      }
      break;
  }
}

void tooltip(const char* text) {
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", text);
}

bool icon_button(const char* id, Icon icon, const char* about, bool enabled = true) {
  const float side = ImGui::GetFrameHeight();
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(id, {1.35f * side, side});
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  add_icon(*ImGui::GetWindowDrawList(), icon, {(low.x + high.x) / 2, (low.y + high.y) / 2}, 0.27f * side,
           ImGui::GetColorU32(ImGuiCol_Text));
  ImGui::EndDisabled();
  tooltip(about);
  ImGui::SameLine();
  return pressed;
}

bool text_button(const char* label, const char* about, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  tooltip(about);
  ImGui::SameLine();
  return pressed;
}

std::string speed_text(double speed) {
  return speed < 1 ? fmt::format("1/{:g}x", 1 / speed) : fmt::format("{:g}x", speed);
}

void gap() {
  ImGui::Dummy({0.4f * ImGui::GetFrameHeight(), 0});
  ImGui::SameLine();
}

void choose_branch(Player& player) {
  const auto& branches = player.history().branches;
  if (branches.size() < 2) return;
  const auto name = [&](std::int32_t id) {
    return fmt::format("branch {}{}", id + 1,
                       !player.replay() && id == player.status().branch ? " (live)" : "");
  };
  ImGui::SetNextItemWidth(6.5f * ImGui::GetFrameHeight());
  if (ImGui::BeginCombo("##branch", name(player.shown_branch()).c_str())) {
    for (const Branch& branch : branches)
      if (ImGui::Selectable(name(branch.id).c_str(), branch.id == player.shown_branch()))
        player.show_branch(branch.id);
    ImGui::EndCombo();
  }
  tooltip("Which future to look at");
  ImGui::SameLine();
}

}  // namespace

ShellRequest draw_transport_bar(Player& player, const Box& box) {
  begin_panel("transport", box);
  const bool loads = is_static(player.scene().setup);
  if (icon_button("##start", Icon::to_start, "To the start (Home)")) player.to_start();
  if (icon_button("##back", Icon::back, "One instant back ( , )")) player.step(-1);
  if (icon_button("##play", player.playing() ? Icon::pause : Icon::play,
                  player.playing() ? "Pause (Space)" : "Play (Space)"))
    player.toggle();
  if (icon_button("##on", Icon::on, "One instant on ( . )")) player.step(1);
  if (icon_button("##end", Icon::to_end, "To the newest instant (End)")) player.to_end();
  if (icon_button(
          "##restart", Icon::restart,
          player.replay() ? "To the start (R)" : "Run again from the start with the sliders as they are (R)"))
    player.restart();
  const bool loop = player.loop();
  if (loop) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  if (icon_button("##loop", Icon::loop, say(window_words::k_loop_about).c_str())) player.set_loop(!loop);
  if (loop) ImGui::PopStyleColor();
  gap();
  if (text_button("-##slower", "Half the speed ( [ )", player.speed() > k_least_speed)) player.slower();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(speed_text(player.speed()).c_str());
  tooltip(loads ? "Load paths per second, asked for" : "Simulated seconds per second, asked for");
  ImGui::SameLine();
  if (text_button("+##faster", "Twice the speed ( ] )", player.speed() < k_most_speed)) player.faster();
  gap();
  if (text_button("Continue from here", "A new branch begins at the instant shown (C)",
                  player.can_continue()))
    player.continue_from_here();
  choose_branch(player);
  gap();
  if (text_button("Undo", "Takes the last change back, from now on (Ctrl+Z)", player.can_undo()))
    player.undo();
  if (text_button("Redo", "(Ctrl+Shift+Z)", player.can_redo())) player.redo();
  gap();
  ShellRequest asked = ShellRequest::none;
  const std::tuple<const Phrase*, const Phrase*, ShellRequest> shell[] = {
      {&window_words::k_scenes, &window_words::k_scenes_about, ShellRequest::scenes},
      {&window_words::k_save, &window_words::k_save_about, ShellRequest::save},
      {&window_words::k_export, &window_words::k_export_about, ShellRequest::export_view}};
  for (const auto& [label, about, request] : shell)
    if (text_button(say(*label).c_str(), say(*about).c_str(), true)) asked = request;
  const auto row = loads ? player.row() : std::nullopt;
  const std::string clock = row     ? instant_in_words(player.scene().setup, *row)
                            : loads ? ""
                                    : fmt::format("{:.2f} s of {:.6g} s", player.time(), player.length());
  const float width = ImGui::CalcTextSize(clock.c_str()).x;
  const float right = ImGui::GetWindowContentRegionMax().x - width;
  if (right > ImGui::GetCursorPosX()) {
    ImGui::SetCursorPosX(right);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock.c_str());
  } else {
    ImGui::NewLine();
  }
  ImGui::End();
  return asked;
}

}  // namespace topple::app
