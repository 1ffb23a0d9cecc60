#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "app/chart/theme.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "app/picture/image_files.h"
#include "app/picture/ways_words.h"
#include "app/picture/words.h"
#include "app/support/files.h"
#include "app/window/status_line.h"
#include "app/window/viewer.h"
#include "render/output/canvas.h"
#include "render/scene/legend.h"
#include "render/scene/overlay.h"
#include "render/scene/text_layout.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr float k_status_tip = 50;       // ems, the width of the whole status
constexpr float k_most_legend = 0.3f;    // of the width
constexpr float k_room_for_title = 16;   // lines
constexpr float k_narrow_words = 0.3f;   // of the width: bodies stand beside words no wider
constexpr float k_words_to_come = 1.6f;  // lines: bodies begin to rock
constexpr float k_flat_legend = 3.2f;    // lines

/// Words over the scene as they are written.
struct SceneWords {
  std::vector<std::pair<ImFont*, std::string>> lines;
  float width = 0, height = 0;
  bool whole = true;  ///< all have room
};
SceneWords lines_of(const std::vector<std::pair<ImFont*, std::string>>& said, float room, int most_lines,
                    float most_height) {
  SceneWords out;
  for (const auto& [font, text] : said)
    for (const std::string& line : render::wrapped(*font, text, room, most_lines)) {
      if (out.height + 1.3f * font->FontSize > most_height) {
        out.whole = false;
        break;
      }
      out.lines.emplace_back(font, line);
      out.width = std::max(out.width, render::text_width(*font, line));
      out.height += std::round(1.3f * font->FontSize);
    }
  return out;
}

}  // namespace

std::string Viewer::title() const {
  const std::string title =
      title_in_words(player_.scene(), player_.parameters_so_far(), player_.changed_so_far());
  const auto& [name, values] = saved_;
  return name.empty() || name == player_.scene().name || values != player_.parameters_so_far()
             ? title
             : say(k_title_saved, title, name);
}

void Viewer::draw_words(const io::FrameRow& row) {
  if (!settings_.words) {
    words_top_ = words_bottom_ = words_left_ = words_right_ = 0;
    return;
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float right = scene_.left + scene_.width, bottom = scene_.top + scene_.height;
  list.PushClipRect({scene_.left, scene_.top}, {right, bottom});
  const float margin = 14 * scale_, legend = std::min(190 * scale_, k_most_legend * scene_.width);
  const float inner = right - legend, pad = 0.5f * margin;
  render::LeftOut left_out;
  const std::optional<render::OverlayBox> drawn = render::draw_legend_in(
      list, fonts_, frame_.legend, render::colour_map_for(frame_.legend, settings_.map, frame_.dark),
      {"", inner, scene_.top + margin, right - margin, bottom - margin}, frame_.dark, left_out);
  const float room = scene_.width - legend - 2 * margin;
  std::vector<std::pair<ImFont*, std::string>> said;
  const bool low = scene_.height < k_room_for_title * fonts_.small->FontSize;
  const auto add = [&](ImFont* font, const std::string& text) { said.emplace_back(font, text); };
  if (!low) add(fonts_.text, title());
  add(fonts_.small, instant_in_words(player_.scene().setup, row) + "   " +
                        shake_in_words(player_.parameters_so_far(), row.time));
  const Model& model = player_.scene().setup.model;
  for (const std::string& words : bodies_in_words(model, player_.parameters().gravity, row))
    add(fonts_.small, words);
  const std::vector<std::string>& harms = inspection_.ways.harms(player_, row);
  for (std::size_t k = 0; k < std::min(harms.size(), k_most_harms); ++k) add(fonts_.small, harms[k]);
  if (harms.size() > k_most_harms) add(fonts_.small, say(k_more_harms, harms.size() - k_most_harms));
  for (const std::string& words : anchors_in_words(model, row)) add(fonts_.small, words);
  if (frame_.legend.quantity.empty() && !frame_.tubes.empty() && traits(settings_.bodies).beams)
    add(fonts_.small, say(k_all_rigid));
  if (!note_.empty()) add(fonts_.small, note_);
  if (shows_earlier())
    add(fonts_.small, earlier_->in_words());
  else if (const auto ghost = player_.ghost_branch(); ghost && ghost_shown_ && !frame_.ghost_tubes.empty())
    add(fonts_.small, say(k_ghost_is, *ghost));
  const bool flat_legend = !drawn && !frame_.legend.quantity.empty();
  const float most = bottom - scene_.top - margin, most_above = most - k_flat_legend * fonts_.small->FontSize;
  SceneWords words = lines_of(said, room, 2, low && flat_legend ? most_above : most);
  // Bodies stand beside words of that width. Where these have too little room in it, they take that of
  // bodies; above a flat legend, where nothing would be left of bodies, they are cut.
  if (low && !words.whole)
    words = flat_legend ? lines_of(said, room, 1, most)
                        : lines_of(said, scene_.width - (drawn ? legend : 0) - 2 * margin, 2, most);
  const auto& [lines, width, height, whole] = words;
  float x = scene_.left + margin, y = scene_.top + margin;
  const float more = k_words_to_come * fonts_.small->FontSize;
  words_top_ = margin + width > k_narrow_words * scene_.width ? margin + height + more : 0;
  words_left_ = margin + width + pad;
  for (const auto& [font, line] : lines) {
    render::add_text(list, *font, {x, y}, font == fonts_.text ? theme().text : theme().quiet, theme().halo,
                     line);
    y += std::round(1.3f * font->FontSize);
  }
  std::optional<render::OverlayBox> flat;
  if (!drawn)
    flat = render::draw_flat_legend_in(
        list, fonts_, frame_.legend, render::colour_map_for(frame_.legend, settings_.map, frame_.dark),
        {"", scene_.left + margin, y + pad, right - margin, bottom - pad}, frame_.dark);
  words_bottom_ = flat ? bottom - flat->top + pad : 0;
  words_right_ = drawn ? right - inner : 0;
  std::vector<render::OverlayBox> taken{{"words", scene_.left, scene_.top, words_left_ + scene_.left, y}};
  if (drawn) taken.push_back(*drawn);
  render::draw_labels(list, fonts_, frame_, orbit_.camera(aspect()),
                      {"", scene_.left, scene_.top, right, bottom}, flat ? flat->top - pad : bottom, taken);
  list.PopClipRect();
}

void Viewer::draw_tabs() {
  static constexpr std::pair<Phrase, Tab> k_tabs[] = {{k_parameters, Tab::parameters},
                                                      {k_picture_tab, Tab::picture},
                                                      {k_inspect, Tab::inspect},
                                                      {k_teach, Tab::teach}};
  constexpr auto k_count = static_cast<float>(std::size(k_tabs));
  const ImGuiStyle& style = ImGui::GetStyle();
  const auto natural = [&](const Phrase& name) {
    return ImGui::CalcTextSize(say(name).c_str()).x + 2 * style.FramePadding.x;
  };
  float room = ImGui::GetContentRegionAvail().x - (k_count - 1) * style.ItemSpacing.x;
  for (const auto& [name, tab] : k_tabs) room -= natural(name);
  for (const auto& [name, tab] : k_tabs) {
    const bool chosen = tab == tab_;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, style.Colors[ImGuiCol_ButtonActive]);
    if (ImGui::Button(say(name).c_str(), {natural(name) + std::max(room, 0.f) / k_count, 0})) tab_ = tab;
    if (chosen) ImGui::PopStyleColor();
    const std::size_t next = static_cast<std::size_t>(tab) + 1;
    if (next == std::size(k_tabs)) break;
    ImGui::SameLine();
    if (natural(k_tabs[next].first) > ImGui::GetContentRegionAvail().x) ImGui::NewLine();
  }
  ImGui::Separator();
}

void Viewer::draw_side_panel(const std::optional<io::FrameRow>& row) {
  begin_panel("side", side_);
  draw_tabs();
  ImGui::BeginChild("content", {0, 0}, false, ImGuiWindowFlags_NavFlattened);
  if (tab_ == Tab::parameters) {
    if (draw_parameters(player_, refused_)) precision_.open = true;
  } else if (tab_ == Tab::picture) {
    if (row && draw_picture_settings(settings_, bridge_.colour_maximum(*row, settings_)))
      scene_changed_ = true;
    if ((earlier_ || !player_.ghost_way().empty()) && ImGui::Checkbox(say(k_ghost).c_str(), &ghost_shown_))
      scene_changed_ = true;
    if (ImGui::Checkbox(say(furnish_words::k_keep).c_str(), &keeps_in_picture_)) scene_changed_ = true;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(furnish_words::k_keep_about).c_str());
    ImGui::Separator();
    static constexpr std::pair<Phrase, render::NamedView> views[] = {{k_front, render::NamedView::front},
                                                                     {k_side, render::NamedView::side},
                                                                     {k_top, render::NamedView::top},
                                                                     {k_iso, render::NamedView::iso}};
    const float width = (ImGui::GetContentRegionAvail().x - 3 * ImGui::GetStyle().ItemSpacing.x) /
                        static_cast<float>(std::size(views));
    for (const auto& [name, view] : views) {
      if (ImGui::Button(say(name).c_str(), {width, 0})) fit_view(view);
      if (view != render::NamedView::iso) ImGui::SameLine();
    }
    ImGui::Separator();
    Appearance appearance = appearance_;
    if (draw_appearance(appearance)) choose_appearance(appearance);
  } else if (tab_ == Tab::teach) {
    draw_teaching(player_, teaching_, refused_);
  } else if (row && draw_inspector(player_, *row, histories_, inspection_)) {
    scene_changed_ = true;
  }
  ImGui::EndChild();
  ImGui::End();
}

void Viewer::draw_plots_strip() {
  const PlotRequest request = draw_plots(player_, histories_, inspection_, plots_);
  if (request != PlotRequest::none) write_plots(request);
}

void Viewer::write_plots(PlotRequest request) {
  const char* const ending = request == PlotRequest::csv ? "csv" : "png";
  std::filesystem::path path;
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::current_path(ignored);
  int number = 1;
  do path = folder / fmt::format("{}-plots-{}.{}", player_.scene().name, number++, ending);
  while (std::filesystem::exists(path, ignored));
  try {
    if (request == PlotRequest::csv)
      write_whole_file(path, host::FileKind::csv, plots_csv(player_, histories_, inspection_));
    else
      write_png(path, picture_of_plots());
    message_ = say(k_written, path.string());
  } catch (const std::runtime_error& error) {
    message_ = say(k_not_written, error.what());
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
  const bool dark = std::exchange(window_is_dark(), false);  // it is written on white
  list.AddText({10, std::round(0.5f * line)}, theme().text,
               in_window_language(player_.scene().title).c_str());
  draw_plot_lanes(list, player_, histories_, inspection_, {0, 2 * line, io.DisplaySize.x, height});
  window_is_dark() = dark;
  ImGui::Render();
  render::Image image =
      stage_.sheet(static_cast<int>(io.DisplaySize.x), static_cast<int>(height), *ImGui::GetDrawData());
  ImGui::DestroyContext(sheet);
  ImGui::SetCurrentContext(window);
  return image;
}

void Viewer::write_status() {
  const LiveStatus& status = player_.status();
  std::string words = status_in_words(player_);
  if (!message_.empty()) words = message_;
  if (!refused_.empty()) words = say(k_refused, refused_);
  if (!status.record_failure.empty()) words += say(k_no_longer_recorded, status.record_failure);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const auto width = [&](const std::string& text) { return render::text_width(*fonts_.small, text) + gap; };
  float room = ImGui::GetIO().DisplaySize.x - 2 * ImGui::GetStyle().WindowPadding.x - width(pace());
  if (player_.can_halve_step()) room -= width(say(k_halve)) + 2 * ImGui::GetStyle().FramePadding.x;
  status_line_.clear();
  for (const std::string& line : render::wrapped(*fonts_.small, words, room, k_status_lines))
    status_line_ += (status_line_.empty() ? "" : "\n") + line;
  status_words_ = words;
}

std::string Viewer::pace() const {
  return work_ + (frame_ms_ > 0 ? say(k_frame_time, frame_ms_) : "") + say(k_f1);
}

void Viewer::draw_status() {
  begin_panel("status", status_);
  if (player_.can_halve_step()) {
    if (ImGui::SmallButton((say(k_halve) + "##halve").c_str())) player_.halve_step_and_retry();
    ImGui::SameLine();
  }
  ImGui::TextUnformatted(status_line_.c_str());
  if (status_line_.ends_with("…") && ImGui::IsItemHovered()) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(k_status_tip * ImGui::GetFontSize());
    ImGui::TextUnformatted(status_words_.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  const std::string right = pace();
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(right.c_str()).x);
  ImGui::TextDisabled("%s", right.c_str());
  ImGui::End();
}

}  // namespace topple::app
