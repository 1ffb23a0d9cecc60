#include "app/chart/theme.h"

namespace topple::app {
namespace {

constexpr Theme k_light_theme = {
    .text = IM_COL32(44, 54, 64, 255),
    .quiet = IM_COL32(84, 96, 108, 255),
    .sheet = IM_COL32(255, 255, 255, 255),
    .halo = IM_COL32(246, 248, 250, 255),
    .frame = IM_COL32(60, 74, 88, 70),
    .axis = IM_COL32(60, 74, 88, 110),
    .faint = IM_COL32(60, 74, 88, 45),
    .cursor = IM_COL32(200, 40, 40, 255),
    .line = IM_COL32(0, 114, 178, 255),
    .chosen = IM_COL32(219, 13, 115, 255),
    .positive = IM_COL32(199, 33, 41, 255),
    .negative = IM_COL32(41, 84, 191, 255),
    .hinge = IM_COL32(230, 84, 10, 255),
    .edit = IM_COL32(150, 60, 140, 255),
    .ghost = IM_COL32(120, 128, 136, 150),
    .other = IM_COL32(140, 148, 156, 255),
    .floor = {IM_COL32(70, 82, 94, 255), IM_COL32(140, 90, 60, 255), IM_COL32(110, 110, 170, 255)},
    .verdict = {{IM_COL32(255, 255, 255, 255), IM_COL32(84, 96, 108, 255)},
                {IM_COL32(245, 230, 99, 255), IM_COL32(0, 0, 0, 255)},
                {IM_COL32(163, 32, 58, 255), IM_COL32(255, 255, 255, 255)},
                {IM_COL32(242, 171, 94, 255), IM_COL32(90, 45, 0, 255)},
                {IM_COL32(169, 203, 228, 255), IM_COL32(43, 92, 134, 255)},
                {IM_COL32(226, 233, 240, 255), IM_COL32(226, 233, 240, 255)}},
};
constexpr Theme k_dark_theme = {
    .text = IM_COL32(226, 231, 236, 255),
    .quiet = IM_COL32(178, 187, 196, 255),
    .sheet = IM_COL32(24, 28, 33, 255),
    .halo = IM_COL32(24, 28, 33, 255),
    .frame = IM_COL32(190, 200, 210, 70),
    .axis = IM_COL32(190, 200, 210, 130),
    .faint = IM_COL32(190, 200, 210, 55),
    .cursor = IM_COL32(255, 112, 100, 255),
    .line = IM_COL32(86, 180, 233, 255),
    .chosen = IM_COL32(255, 96, 172, 255),
    .positive = IM_COL32(255, 112, 112, 255),
    .negative = IM_COL32(128, 164, 255, 255),
    .hinge = IM_COL32(255, 140, 64, 255),
    .edit = IM_COL32(214, 134, 208, 255),
    .ghost = IM_COL32(160, 168, 176, 150),
    .other = IM_COL32(130, 138, 146, 255),
    .floor = {IM_COL32(196, 205, 214, 255), IM_COL32(226, 170, 130, 255), IM_COL32(172, 172, 244, 255)},
    .verdict = {{IM_COL32(24, 28, 33, 255), IM_COL32(178, 187, 196, 255)},
                {IM_COL32(214, 198, 70, 255), IM_COL32(0, 0, 0, 255)},
                {IM_COL32(186, 52, 80, 255), IM_COL32(255, 255, 255, 255)},
                {IM_COL32(214, 136, 58, 255), IM_COL32(40, 18, 0, 255)},
                {IM_COL32(52, 96, 134, 255), IM_COL32(190, 220, 244, 255)},
                {IM_COL32(46, 54, 62, 255), IM_COL32(46, 54, 62, 255)}},
};

void set_light_colours(ImVec4* colours) {
  ImGui::StyleColorsLight();
  colours[ImGuiCol_WindowBg] = {0.955f, 0.96f, 0.965f, 1};
  colours[ImGuiCol_PopupBg] = {1, 1, 1, 0.98f};
  colours[ImGuiCol_Text] = {0.14f, 0.18f, 0.22f, 1};
  colours[ImGuiCol_TextDisabled] = {0.34f, 0.39f, 0.44f, 1};
  colours[ImGuiCol_FrameBg] = {1, 1, 1, 1};
  colours[ImGuiCol_FrameBgHovered] = {0.90f, 0.94f, 0.98f, 1};
  colours[ImGuiCol_FrameBgActive] = {0.84f, 0.91f, 0.98f, 1};
  colours[ImGuiCol_Button] = {0.87f, 0.895f, 0.92f, 1};
  colours[ImGuiCol_ButtonHovered] = {0.76f, 0.86f, 0.95f, 1};
  colours[ImGuiCol_ButtonActive] = {0.62f, 0.78f, 0.92f, 1};
  colours[ImGuiCol_SliderGrab] = {0.58f, 0.77f, 0.93f, 1};
  colours[ImGuiCol_SliderGrabActive] = {0.40f, 0.65f, 0.88f, 1};
  colours[ImGuiCol_NavHighlight] = {0.75f, 0.25f, 0.02f, 1};
}

void set_dark_colours(ImVec4* colours) {
  ImGui::StyleColorsDark();
  colours[ImGuiCol_WindowBg] = {0.125f, 0.14f, 0.16f, 1};
  colours[ImGuiCol_PopupBg] = {0.09f, 0.10f, 0.115f, 0.98f};
  colours[ImGuiCol_Text] = {0.90f, 0.92f, 0.94f, 1};
  colours[ImGuiCol_TextDisabled] = {0.70f, 0.735f, 0.77f, 1};
  colours[ImGuiCol_FrameBg] = {0.075f, 0.085f, 0.10f, 1};
  colours[ImGuiCol_FrameBgHovered] = {0.12f, 0.18f, 0.25f, 1};
  colours[ImGuiCol_FrameBgActive] = {0.14f, 0.23f, 0.33f, 1};
  colours[ImGuiCol_Button] = {0.21f, 0.235f, 0.265f, 1};
  colours[ImGuiCol_ButtonHovered] = {0.20f, 0.32f, 0.43f, 1};
  colours[ImGuiCol_ButtonActive] = {0.16f, 0.38f, 0.56f, 1};
  colours[ImGuiCol_SliderGrab] = {0.17f, 0.36f, 0.52f, 1};
  colours[ImGuiCol_SliderGrabActive] = {0.20f, 0.44f, 0.64f, 1};
  colours[ImGuiCol_CheckMark] = {0.45f, 0.75f, 0.98f, 1};
  colours[ImGuiCol_NavHighlight] = {1.0f, 0.72f, 0.30f, 1};
}

}  // namespace

const Theme& theme() {
  return window_is_dark() ? k_dark_theme : k_light_theme;
}

void set_style(float scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowPadding = {10, 6};
  style.FramePadding = {7, 4};
  style.ItemSpacing = {7, 5};
  style.DisabledAlpha = 0.75f;
  if (window_is_dark())
    set_dark_colours(style.Colors);
  else
    set_light_colours(style.Colors);
  style.ScaleAllSizes(scale);
}

}  // namespace topple::app
