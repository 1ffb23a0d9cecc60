#include "app/panels/teaching_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <string>
#include <utility>

#include "app/chart/lane.h"
#include "app/panels/teaching_words.h"
#include "app/support/terms.h"
#include "render/scene/text_layout.h"

namespace topple::app {
namespace {

using namespace window_words;

void draw_presets(Player& player) {
  static constexpr std::pair<const Phrase&, std::size_t> k_buttons[] = {{k_long_period, 0},
                                                                        {k_short_period, 1}};
  const bool can = can_shake_as_sine(player);
  for (const auto& [name, k] : k_buttons) {
    const Demo& demo = demos()[k];
    ImGui::BeginDisabled(!can);
    if (ImGui::Button(say(name).c_str(), {-1, 0})) shake_as_sine(player, demo.frequency, demo.amplitude);
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
      ImGui::SetTooltip(
          "%s", (can ? say(k_preset_about, demo.frequency, demo.amplitude) : say(k_sine_only)).c_str());
  }
}

void draw_guide(TeachingState& state) {
  DemoGuide& guide = *state.guide;
  if (std::exchange(state.begins, false)) ImGui::SetScrollY(0);
  text_wrapped(
      say(k_demo_step, say(guide.demo().name), guide.step().value_or(0) + 1, guide.demo().steps.size()));
  ImGui::BeginDisabled(guide.under_way() || guide.step().value_or(0) == 0);
  if (ImGui::Button((say(k_previous) + "##previous").c_str())) guide.previous();
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(guide.under_way() || guide.last());
  if (ImGui::Button((say(k_next) + "##next").c_str())) guide.next();
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool quit = ImGui::Button((say(k_quit_demo) + "##quit").c_str());
  text_wrapped(say(guide.text()));  // below: the buttons stay where they are
  if (!quit) return;
  guide.leave();
  state.guide.reset();
}

void draw_demos(const Player& player, TeachingState& state) {
  state.wanted.reset();
  if (!state.guide) {
    ImGui::TextDisabled("%s", say(k_demos).c_str());
    for (std::size_t k = 0; k < demos().size(); ++k)
      if (ImGui::Button((say(demos()[k].name) + fmt::format("##demo{}", k)).c_str(), {-1, 0}))
        state.wanted = k;
  }
  if (player.scene().name != k_demo_scene) text_wrapped(say(k_demo_opens, k_demo_scene));
  state.back = false;
  if (state.came_from.empty()) return;
  const std::string whole = say(k_back_to, state.scene_before);
  const float room = ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().FramePadding.x;
  const std::string shown = render::shortened(*ImGui::GetFont(), whole, room);
  state.back = ImGui::Button((shown + "##back").c_str(), {-1, 0});
  if (shown != whole && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", whole.c_str());
}

void draw_accuracy(const Player& player, TeachingState& state) {
  if (is_static(player.scene().setup)) return;
  const auto result = state.accuracy ? state.accuracy->result() : nullptr;
  if (!state.accuracy || result) {
    ImGui::BeginDisabled(player.way().empty());
    const bool asked = ImGui::Button((say(k_how_accurate) + "##accurate").c_str(), {-1, 0});
    ImGui::EndDisabled();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(k_how_accurate_about).c_str());
    if (asked) {
      Setup setup = player.scene().setup;
      for (const Edit& edit : player.edits_from(setup.parameters))
        apply(edit, setup.model, 0, setup.parameters);
      state.accuracy = estimate_accuracy(setup);
      state.in_sight = false;
      return;
    }
  } else {
    const auto progress = static_cast<float>(state.accuracy->progress());
    ImGui::TextUnformatted(say(k_estimating, 100 * progress).c_str());
    ImGui::ProgressBar(progress, {-1, 0.5f * ImGui::GetTextLineHeight()}, "");
    if (ImGui::Button((say(k_cancel) + "##cancel").c_str())) state.accuracy.reset();
  }
  if (!result) return;
  for (const std::string& line : accuracy_in_words(player.scene().setup.model, *result)) text_wrapped(line);
  if (result->failure.empty()) text_wrapped(say(k_estimate_note));
  if (!std::exchange(state.in_sight, true)) ImGui::SetScrollHereY(1);
}

}  // namespace

void draw_teaching(Player& player, TeachingState& state, std::string& refused) {
  if (state.guide) {  // above all that changes its height
    draw_guide(state);
    ImGui::Separator();
  }
  draw_excitation(player, state, refused);
  draw_presets(player);
  ImGui::Separator();
  draw_demos(player, state);
  ImGui::Separator();
  draw_accuracy(player, state);
}

}  // namespace topple::app
