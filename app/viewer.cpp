#include "app/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/words.h"
#include "render/overlay.h"
#include "render/pick.h"
#include "solver/io/edit_text.h"

namespace topple::app {
namespace {

constexpr double k_flight = 0.25;        // s, of the camera
constexpr double k_quiet = 0.4;          // s without change after which the scene is drawn at its best
constexpr float k_click = 4;             // px: a press that moves less is no drag
constexpr float k_falling_room = 0.25f;  // of the height, beside bodies that may still fall
constexpr ImU32 k_text = IM_COL32(40, 50, 60, 255), k_quiet_text = IM_COL32(80, 92, 104, 255);

void set_style(float scale) {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowPadding = {10, 6};
  style.FramePadding = {7, 4};
  style.ItemSpacing = {7, 5};
  style.Colors[ImGuiCol_WindowBg] = {0.955f, 0.96f, 0.965f, 1};
  style.Colors[ImGuiCol_PopupBg] = {1, 1, 1, 0.98f};
  style.Colors[ImGuiCol_Text] = {0.14f, 0.18f, 0.22f, 1};
  style.Colors[ImGuiCol_TextDisabled] = {0.38f, 0.43f, 0.48f, 1};
  style.Colors[ImGuiCol_FrameBg] = {1, 1, 1, 1};
  style.Colors[ImGuiCol_FrameBgHovered] = {0.90f, 0.94f, 0.98f, 1};
  style.Colors[ImGuiCol_FrameBgActive] = {0.84f, 0.91f, 0.98f, 1};
  style.Colors[ImGuiCol_Button] = {0.87f, 0.895f, 0.92f, 1};
  style.Colors[ImGuiCol_ButtonHovered] = {0.76f, 0.86f, 0.95f, 1};
  style.Colors[ImGuiCol_ButtonActive] = {0.62f, 0.78f, 0.92f, 1};
  style.Colors[ImGuiCol_SliderGrab] = {0.58f, 0.77f, 0.93f, 1};
  style.Colors[ImGuiCol_SliderGrabActive] = {0.40f, 0.65f, 0.88f, 1};
  style.ScaleAllSizes(scale);
}

bool same_instant(const std::optional<io::FrameRow>& a, const std::optional<io::FrameRow>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->time == b->time && a->step == b->step && a->branch == b->branch;
}

}  // namespace

void begin_panel(const char* name, const Box& box) {
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.width, box.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
}

Viewer::Viewer(Player& player, render::Stage& stage, float scale, render::NamedView view)
    : player_(player), stage_(stage), scale_(scale), bridge_(player.scene(), player.extent()), view_(view) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  fonts_ = render::add_overlay_fonts(*io.Fonts, static_cast<int>(std::lround(720 * scale)));
  io.FontDefault = fonts_.small;
  stage_.upload_fonts(*io.Fonts);
  set_style(scale);
}

bool Viewer::update(double wall_s) {
  const bool news = player_.update(wall_s);
  if (flight_ < 1) move_camera(wall_s);
  const bool moved = row_ && camera_changed_;
  quiet_ = news || moved ? 0 : quiet_ + wall_s;
  const bool refine = stage_.software() && !drawn_still_ && quiet_ > k_quiet && !player_.playing();
  return news || moved || refine;
}

void Viewer::lay_out() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float side = std::min(300 * scale_, 0.45f * size.x), status = 26 * scale_, bar = 38 * scale_;
  const float timeline = std::min(165 * scale_, 0.3f * size.y);
  const float scene = std::max(size.y - status - bar - timeline, 16.f);
  scene_ = {0, 0, std::max(size.x - side, 16.f), scene};
  side_ = {scene_.width, 0, side, scene + timeline};
  timeline_ = {0, scene, scene_.width, timeline};
  transport_ = {0, scene + timeline, size.x, bar};
  status_ = {0, scene + bar + timeline, size.x, status};
}

render::Surface Viewer::surface() const {
  const ImGuiIO& io = ImGui::GetIO();
  const auto pixels = [](float x, float scale) { return static_cast<int>(std::lround(x * scale)); };
  return {.width = pixels(io.DisplaySize.x, io.DisplayFramebufferScale.x),
          .height = pixels(io.DisplaySize.y, io.DisplayFramebufferScale.y),
          .scene_left = pixels(scene_.left, io.DisplayFramebufferScale.x),
          .scene_top = pixels(scene_.top, io.DisplayFramebufferScale.y)};
}

void Viewer::report_frame_time(double ms) {
  frame_ms_ = frame_ms_ == 0 ? ms : 0.9 * frame_ms_ + 0.1 * ms;
}

void Viewer::build() {
  const Box before = scene_;
  lay_out();
  if (before.width != scene_.width || before.height != scene_.height) camera_changed_ = true;
  handle_characters();
  for (int button = 0; button < 3; ++button)
    if (ImGui::IsMouseClicked(button)) refused_.clear();
  std::optional<io::FrameRow> row = player_.row();
  if (!same_instant(row, row_)) scene_changed_ = true;
  row_ = std::move(row);
  handle_mouse();
  if (row_) draw_words(*row_);
  draw_side_panel(row_);
  draw_transport_bar(player_, transport_);
  draw_timeline(player_, timeline_);
  draw_status();
  if (keys_shown_) draw_key_table();
  ImGui::Render();
  draw_scene();
}

void Viewer::draw_scene() {
  if (!row_) return;
  const bool changed = scene_changed_ || camera_changed_;
  if (!changed && (drawn_still_ || quiet_ <= k_quiet || player_.playing())) return;
  if (scene_changed_) {
    frame_ = bridge_.frame(*row_, player_.parameters());
    const LiveStatus& status = player_.status();
    if (picked_)
      frame_.highlighted_member = static_cast<std::int64_t>(*picked_);
    else if (status.kind == LiveStatus::Kind::failed && status.element >= 0)
      frame_.highlighted_member =
          player_.scene().setup.model.elements[static_cast<std::size_t>(status.element)].member;
    if (const auto ghost = ghost_shown_ ? player_.ghost() : std::nullopt) bridge_.add_ghost(*ghost, frame_);
  }
  if (!fitted_) {
    look(view_);
    flight_ = 1;
    orbit_ = to_;
    fitted_ = true;
  }
  orbit_.set_bounds(frame_);
  drawn_still_ = !changed;
  const render::Surface surface = this->surface();
  const ImVec2 pixel = ImGui::GetIO().DisplayFramebufferScale;
  stage_.draw_scene(frame_, orbit_.camera(aspect()), render::ColourMap::viridis,
                    std::min(static_cast<int>(std::lround(scene_.width * pixel.x)), surface.width),
                    std::min(static_cast<int>(std::lround(scene_.height * pixel.y)), surface.height),
                    drawn_still_ ? render::Quality::still : render::Quality::interactive);
  scene_changed_ = camera_changed_ = false;
}

// What may still fall needs room beside it.
void Viewer::look(render::NamedView view) {
  render::SceneFrame frame = frame_;
  if (!player_.replay()) {
    const float room = k_falling_room * (frame.bounds_max[2] - frame.bounds_min[2]);
    for (int k = 0; k < 2; ++k) {
      frame.bounds_min[k] -= room;
      frame.bounds_max[k] += room;
    }
  }
  view_ = view;
  from_ = orbit_;
  to_ = render::Orbit::fit(view, frame, aspect());
  flight_ = 0;
  camera_changed_ = true;
}

void Viewer::move_camera(double wall_s) {
  flight_ = std::min(1., flight_ + wall_s / k_flight);
  orbit_ = render::Orbit::between(from_, to_, static_cast<float>(flight_));
  camera_changed_ = true;
}

void Viewer::handle_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  const float x = io.MousePos.x - scene_.left, y = io.MousePos.y - scene_.top;
  const bool inside = scene_.contains(io.MousePos.x, io.MousePos.y) && !io.WantCaptureMouse;
  if (inside && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2))) {
    dragging_ = true;
    dragged_ = false;
  }
  const bool turn = io.MouseDown[0] && !io.KeyShift;
  const bool pan = io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
  if (dragging_ && (turn || pan)) {
    for (int button = 0; button < 3; ++button)
      dragged_ = dragged_ || io.MouseDragMaxDistanceSqr[button] > k_click * k_click * scale_ * scale_;
    if (dragged_ && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
      flight_ = 1;
      if (pan)
        orbit_.pan(io.MouseDelta.x, io.MouseDelta.y, scene_.height);
      else
        orbit_.rotate(io.MouseDelta.x, io.MouseDelta.y);
      camera_changed_ = true;
    }
  }
  if (dragging_ && !dragged_ && ImGui::IsMouseReleased(0)) {
    const auto found = render::pick(frame_, orbit_.camera(aspect()), static_cast<int>(scene_.width),
                                    static_cast<int>(scene_.height), x, y);
    picked_ = found ? std::optional<std::size_t>(found->member) : std::nullopt;
    scene_changed_ = true;
  }
  if (!ImGui::IsAnyMouseDown()) dragging_ = false;
  if (inside && io.MouseWheel != 0) {
    flight_ = 1;
    orbit_.zoom(std::pow(1.15f, io.MouseWheel), x, y, scene_.width, scene_.height);
    camera_changed_ = true;
  }
}

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
  render::draw_legend_in(list, fonts_, frame_.legend, render::ColourMap::viridis,
                         {"", scene_.left + scene_.width - legend, scene_.top + margin,
                          scene_.left + scene_.width - margin, scene_.top + scene_.height - margin},
                         left_out);
  list.PopClipRect();
}

void Viewer::draw_side_panel(const std::optional<io::FrameRow>& row) {
  begin_panel("side", side_);
  ImGui::TextUnformatted("Parameters");
  draw_parameters(player_, refused_);
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
  if (!player_.ghost_way().empty() && ImGui::Checkbox("ghost of the branch left", &ghost_shown_))
    scene_changed_ = true;
  ImGui::Separator();
  if (picked_ && row)
    draw_inspector(player_.scene().setup.model, *row, *picked_);
  else
    ImGui::TextDisabled("Click a member or an anchor to inspect it.");
  ImGui::End();
}

void Viewer::draw_status() {
  begin_panel("status", status_);
  const LiveStatus& status = player_.status();
  std::string words = status_in_words(player_);
  const bool failed = status.kind == LiveStatus::Kind::failed && player_.at_head();
  if (!refused_.empty()) words = "Refused: " + refused_;
  if (!status.record_failure.empty()) words += "  No longer recorded: " + status.record_failure;
  const double least_step = io::key_of(Edit::Key::time_step).least;
  if (failed && player_.can_edit() && !is_static(player_.scene().setup) &&
      player_.parameters().time_step >= 2 * least_step) {
    if (ImGui::SmallButton("Halve the step and retry")) {
      player_.begin_edit();
      player_.edit({Edit::Key::time_step, 0, Vec3(player_.parameters().time_step / 2, 0, 0)});
      player_.play();
    }
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
