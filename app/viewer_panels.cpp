#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "app/files.h"
#include "app/shell_words.h"
#include "app/viewer.h"
#include "app/words.h"
#include "render/canvas.h"
#include "render/overlay.h"

namespace topple::app {
namespace {

constexpr ImU32 k_text = IM_COL32(40, 50, 60, 255), k_quiet_text = IM_COL32(80, 92, 104, 255);

}  // namespace

void Viewer::draw_words(const io::FrameRow& row) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({scene_.left, scene_.top}, {scene_.left + scene_.width, scene_.top + scene_.height});
  const float margin = 14 * scale_;
  float y = scene_.top + margin;
  const auto line = [&](ImFont* font, ImU32 colour, const std::string& text) {
    list.AddText(font, font->FontSize, {scene_.left + margin, y}, colour, text.c_str());
    y += std::round(1.3f * font->FontSize);
  };
  line(fonts_.text, k_text, player_.scene().title);
  line(fonts_.small, k_quiet_text,
       instant_in_words(player_.scene().setup, row) + "   " + shake_in_words(player_.parameters()));
  const Model& model = player_.scene().setup.model;
  for (std::size_t b = 0; b < static_cast<std::size_t>(model.furniture_total()); ++b)
    line(fonts_.small, k_quiet_text, body_in_words(model, row, b));
  for (const std::string& words : anchors_in_words(model, row)) line(fonts_.small, k_quiet_text, words);
  render::LeftOut left_out;
  const float legend = 190 * scale_;
  // Here the scene may lie behind it.
  const ImU32 clear = IM_COL32(244, 246, 248, 0), veil = IM_COL32(244, 246, 248, 215);
  list.AddRectFilledMultiColor({scene_.left + scene_.width - legend, scene_.top},
                               {scene_.left + scene_.width, scene_.top + scene_.height}, clear, veil, veil,
                               clear);
  render::draw_legend_in(list, fonts_, frame_.legend, render::colour_map_for(frame_.legend, settings_.map),
                         {"", scene_.left + scene_.width - legend, scene_.top + margin,
                          scene_.left + scene_.width - margin, scene_.top + scene_.height - margin},
                         left_out);
  render::draw_labels(list, fonts_, frame_, orbit_.camera(aspect()),
                      {"", scene_.left, scene_.top, scene_.left + scene_.width, scene_.top + scene_.height});
  list.PopClipRect();
}

void Viewer::draw_tabs() {
  constexpr std::pair<const char*, Tab> k_tabs[] = {
      {"Parameters", Tab::parameters}, {"Picture", Tab::picture}, {"Inspect", Tab::inspect}};
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
  for (const auto& [name, tab] : k_tabs) {
    const bool chosen = tab == tab_;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
    if (ImGui::Button(name, {width, 0})) tab_ = tab;
    if (chosen) ImGui::PopStyleColor();
    if (tab != Tab::inspect) ImGui::SameLine();
  }
  ImGui::Separator();
}

void Viewer::draw_side_panel(const std::optional<io::FrameRow>& row) {
  begin_panel("side", side_);
  draw_tabs();
  if (tab_ == Tab::parameters) {
    draw_parameters(player_, refused_);
  } else if (tab_ == Tab::picture) {
    if (row && draw_picture_settings(settings_, bridge_.colour_maximum(*row, settings_)))
      scene_changed_ = true;
    if (!player_.ghost_way().empty() && ImGui::Checkbox("ghost of the branch left", &ghost_shown_))
      scene_changed_ = true;
    ImGui::Separator();
    const std::pair<const char*, render::NamedView> views[] = {{"Front", render::NamedView::front},
                                                               {"Side", render::NamedView::side},
                                                               {"Top", render::NamedView::top},
                                                               {"Iso", render::NamedView::iso}};
    const float width = (ImGui::GetContentRegionAvail().x - 3 * ImGui::GetStyle().ItemSpacing.x) /
                        static_cast<float>(std::size(views));
    for (const auto& [name, view] : views) {
      if (ImGui::Button(name, {width, 0})) look(view);
      if (view != render::NamedView::iso) ImGui::SameLine();
    }
  } else if (row && draw_inspector(player_, *row, histories_, inspection_)) {
    scene_changed_ = true;
  }
  ImGui::End();
}

void Viewer::draw_plots_strip() {
  const PlotRequest request = draw_plots(player_, histories_, inspection_, plots_);
  if (request != PlotRequest::none) write_plots(request);
}

void Viewer::write_plots(PlotRequest request) {
  // Beside the recording; of what is not recorded, in the working folder.
  const std::string& recording = player_.status().recording;
  const std::filesystem::path folder = std::filesystem::path(recording).parent_path();
  const std::string stem =
      recording.empty() ? player_.scene().name : std::filesystem::path(recording).stem().string();
  const char* const ending = request == PlotRequest::csv ? "csv" : "png";
  std::filesystem::path path;
  std::error_code ignored;
  int number = 1;
  do path = folder / fmt::format("{}-plots-{}.{}", stem, number++, ending);
  while (std::filesystem::exists(path, ignored));
  try {
    if (request == PlotRequest::csv)
      write_whole_file(path.string(), plots_csv(player_, histories_, inspection_));
    else
      render::write_png(path, picture_of_plots());
    told_ = "Written: " + std::filesystem::absolute(path, ignored).string();
  } catch (const std::runtime_error& error) {
    told_ = fmt::format("Not written: {}", error.what());
  }
}

render::Image Viewer::picture_of_plots() {
  constexpr float k_width = 1280;
  const float line = fonts_.small->FontSize, height = std::ceil(line * (plots_height(inspection_) + 3.5f));
  ImGuiContext* const window = ImGui::GetCurrentContext();
  ImGuiContext* const sheet = ImGui::CreateContext(ImGui::GetIO().Fonts);
  ImGui::SetCurrentContext(sheet);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = io.LogFilename = nullptr;
  io.FontDefault = fonts_.small;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.DisplaySize = {std::ceil(k_width * scale_), height};
  io.DeltaTime = 1.f / 60;
  ImGui::NewFrame();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddText({10, std::round(0.5f * line)}, k_text, player_.scene().title.c_str());
  draw_plot_lanes(list, player_, histories_, inspection_, {0, 2 * line, io.DisplaySize.x, height});
  ImGui::Render();
  const render::Image image =
      stage_.sheet(static_cast<int>(io.DisplaySize.x), static_cast<int>(height), *ImGui::GetDrawData());
  ImGui::DestroyContext(sheet);
  ImGui::SetCurrentContext(window);
  return image;
}

void Viewer::draw_status() {
  begin_panel("status", status_);
  const LiveStatus& status = player_.status();
  std::string words = status_in_words(player_);
  if (!told_.empty()) words = told_;
  if (!refused_.empty()) words = "Refused: " + refused_;
  if (!status.record_failure.empty()) words += "  No longer recorded: " + status.record_failure;
  if (player_.can_halve_step()) {
    if (ImGui::SmallButton(say(window_words::k_halve).c_str())) player_.halve_step_and_retry();
    ImGui::SameLine();
  }
  ImGui::TextUnformatted(words.c_str());
  const std::string pace =
      frame_ms_ > 0 ? fmt::format("{:.0f} ms a frame   F1: keys", frame_ms_) : "F1: keys";
  const float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(pace.c_str()).x;
  ImGui::SameLine();
  if (right > ImGui::GetCursorPosX()) {
    ImGui::SetCursorPosX(right);
    ImGui::TextDisabled("%s", pace.c_str());
  }
  ImGui::End();
}

}  // namespace topple::app
