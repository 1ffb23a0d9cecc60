#include "app/window/message.h"

#include <imgui.h>

#include <algorithm>

#include "app/panels/shell_words.h"

namespace topple::app {
namespace {

namespace ww = window_words;

constexpr int k_most_lines = 12;

/// Broken into lines that fit; the field that shows it does not break them.
std::string in_lines(const std::string& text, float width) {
  const ImFont& font = *ImGui::GetFont();
  const float scale = ImGui::GetFontSize() / font.FontSize;
  std::string lines;
  const char* at = text.c_str();
  const char* const end = at + text.size();
  while (at < end) {
    const char* stop = std::min(font.CalcWordWrapPositionA(scale, at, end, width), end);
    if (stop == at) stop = at + 1;
    const char* const paragraph = std::find(at, stop, '\n');
    stop = std::min(stop, paragraph);
    lines.append(at, stop);
    at = stop;
    while (at < end && *at == ' ') ++at;
    if (at < end) lines += '\n';
    if (at < end && *at == '\n') ++at;
  }
  return lines;
}

}  // namespace

void begin_panel_over(const char* name, const Box& window, float width, float height,
                      const std::string& title, const render::OverlayFonts& fonts) {
  constexpr ImGuiWindowFlags k_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavFocus;
  const float unit = fonts.small->FontSize / 14;
  ImGui::SetNextWindowPos({window.left, window.top});
  ImGui::SetNextWindowSize({window.width, window.height});
  ImGui::SetNextWindowBgAlpha(0.4f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.35f, 0.38f, 0.42f, 1});
  ImGui::Begin(name, nullptr, k_flags);
  ImGui::PopStyleColor();
  // Its height is that of what it held in the frame before.
  const float tall = ImGui::GetStateStorage()->GetFloat(ImGui::GetID("height"), 8 * fonts.text->FontSize);
  const float wide = std::min(width * unit, window.width);
  ImGui::SetCursorPos({(window.width - wide) / 2, std::max(height * (window.height - tall), 0.f)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {20 * unit, 16 * unit});
  ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, 6 * unit);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, ImGui::GetStyle().Colors[ImGuiCol_WindowBg]);
  ImGui::BeginChild("panel", {wide, tall}, true, k_flags | ImGuiWindowFlags_AlwaysUseWindowPadding);
  if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();  // Tab goes among its fields
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  ImGui::PushFont(fonts.text);
  ImGui::TextUnformatted(title.c_str());
  ImGui::PopFont();
  ImGui::Separator();
  ImGui::Dummy({0, 2 * unit});
}

void end_panel_over() {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float height = ImGui::GetCursorPosY() - style.ItemSpacing.y + 16 * ImGui::GetFontSize() / 14;
  ImGui::EndChild();
  ImGui::GetStateStorage()->SetFloat(ImGui::GetID("height"), height);
  ImGui::End();
}

bool button_at_right(const std::string& label, int place, bool enabled) {
  const float width = 9 * ImGui::GetFontSize(), gap = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width * static_cast<float>(place + 1) -
                  gap * static_cast<float>(place));
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label.c_str(), {width, 0});
  ImGui::EndDisabled();
  return pressed;
}

Answer draw_message(const Message& message, const Box& window, const render::OverlayFonts& fonts) {
  begin_panel_over("message", window, 640, 0.85f, message.title, fonts);
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::GetContentRegionAvail().x;
  std::string lines = in_lines(message.text, width - 2 * style.FramePadding.x - style.ScrollbarSize);
  const auto count =
      static_cast<int>(std::min<std::ptrdiff_t>(std::ranges::count(lines, '\n') + 1, k_most_lines));
  const float height = static_cast<float>(count) * ImGui::GetFontSize() + 2 * style.FramePadding.y + 4;
  ImGui::InputTextMultiline("##text", lines.data(), lines.size() + 1, {width, height},
                            ImGuiInputTextFlags_ReadOnly);
  if (!message.advice.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", message.advice.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::Dummy({0, 4});
  Answer answer = Answer::none;
  if (ImGui::Button(say(ww::k_copy).c_str(), {7 * ImGui::GetFontSize(), 0}))
    ImGui::SetClipboardText(message.text.c_str());
  if (message.may_halve_step) {
    ImGui::SameLine();
    if (ImGui::Button(say(ww::k_halve).c_str())) answer = Answer::halve_step;
  }
  if (button_at_right(say(ww::k_close), 0)) answer = Answer::close;
  end_panel_over();
  return answer;
}

}  // namespace topple::app
