#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/panels/panels.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "app/picture/words.h"
#include "app/support/terms.h"

namespace topple::app {
namespace {

using namespace window_words;

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

/// What comes next begins a new row unless it has room on this one.
void flow(float width) {
  if (ImGui::GetCursorPosX() + width > ImGui::GetWindowContentRegionMax().x) ImGui::NewLine();
}

float button_width(const std::string& label) {
  return ImGui::CalcTextSize(label.c_str(), nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x;
}

void tooltip(const Phrase& text) {
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", say(text).c_str());
}

bool icon_button(const char* id, Icon icon, const Phrase& about, bool enabled = true) {
  const float side = ImGui::GetFrameHeight();
  flow(1.35f * side);
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

bool text_button(const std::string& label, const Phrase& about, bool enabled) {
  flow(button_width(label));
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label.c_str());
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
  const auto name = [&](std::int32_t id) { return say(player.is_live(id) ? k_branch_live : k_branch, id); };
  const float width = 6.5f * ImGui::GetFrameHeight();
  flow(width);
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##branch", name(player.shown_branch()).c_str())) {
    for (const Branch& branch : branches) {
      const std::string entry = branch.fork_step == 0 ? say(k_branch_from_start, name(branch.id))
                                                      : say(k_branch_out_of, name(branch.id), branch.parent);
      if (list_entry(entry, branch.id == player.shown_branch())) player.show_branch(branch.id);
    }
    ImGui::EndCombo();
  }
  tooltip(k_branch_about);
  ImGui::SameLine();
}

}  // namespace

ShellRequest draw_transport_bar(Player& player, const Box& box, float& height) {
  begin_panel("transport", box);
  const bool loads = is_static(player.scene().setup);
  if (icon_button("##start", Icon::to_start, k_to_start)) player.to_start();
  if (icon_button("##back", Icon::back, k_one_back)) player.step(-1);
  if (icon_button("##play", player.playing() ? Icon::pause : Icon::play, player.playing() ? k_pause : k_play))
    player.toggle();
  if (icon_button("##on", Icon::on, k_one_on)) player.step(1);
  if (icon_button("##end", Icon::to_end, k_to_end)) player.to_end();
  if (icon_button("##restart", Icon::restart, player.replay() ? k_replay_restart : k_restart))
    player.restart();
  const bool loop = player.loop();
  if (loop) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  if (icon_button("##loop", Icon::loop, k_loop_about)) player.set_loop(!loop);
  if (loop) ImGui::PopStyleColor();
  gap();
  if (text_button("-##slower", k_slower, player.speed() > k_least_speed)) player.slower();
  flow(ImGui::CalcTextSize(speed_text(player.speed()).c_str()).x);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(speed_text(player.speed()).c_str());
  tooltip(loads ? k_load_speed : k_speed);
  ImGui::SameLine();
  if (text_button("+##faster", k_faster, player.speed() < k_most_speed)) player.faster();
  gap();
  if (text_button(say(k_continue) + "##continue", k_continue_about, player.can_continue()))
    player.continue_from_here();
  choose_branch(player);
  gap();
  if (text_button(say(k_undo) + "##undo", k_undo_about, player.can_undo())) player.undo();
  if (text_button(say(k_redo) + "##redo", k_redo_about, player.can_redo())) player.redo();
  gap();
  ShellRequest asked = ShellRequest::none;
  const std::tuple<const Phrase&, const Phrase&, ShellRequest> shell[] = {
      {k_scenes, k_scenes_about, ShellRequest::scenes},
      {k_save, k_save_about, ShellRequest::save},
      {k_export, k_export_about, ShellRequest::export_view},
      {furnish_words::k_furnish, furnish_words::k_furnish_about, ShellRequest::furnish}};
  for (const auto& [label, about, request] : shell)
    if (text_button(say(label), about, true)) asked = request;
  const auto row = loads ? player.row() : std::nullopt;
  const std::string clock = row     ? instant_in_words(player.scene().setup, *row)
                            : loads ? ""
                                    : say(k_clock, player.time(), player.length());
  const float width = ImGui::CalcTextSize(clock.c_str()).x;
  flow(width);
  ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(clock.c_str());
  height = ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + ImGui::GetStyle().WindowPadding.y;
  ImGui::End();
  return asked;
}

}  // namespace topple::app
