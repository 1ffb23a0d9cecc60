#include "app/window/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "app/chart/theme.h"
#include "app/panels/edit_marks.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "app/picture/row.h"
#include "app/support/terms.h"
#include "solver/io/edit/edit_text.h"

namespace topple::app {
namespace {

constexpr double k_flight = 0.25;        // s, of the camera
constexpr double k_quiet = 0.4;          // s without change after which the scene is drawn at its best
constexpr float k_least_free = 0.4f;     // of the scene, for bodies beside words
constexpr float k_least_beside = 0.3f;   // the same of its width, where there is little height
constexpr float k_click_travel = 4;      // px: a press that moves less is no drag
constexpr float k_falling_room = 0.25f;  // of the height, beside bodies that may still fall
constexpr float k_most_plots = 0.55f;    // of the height above the timeline
constexpr float k_side_panel = 320;      // px at 720 lines
constexpr float k_most_side = 0.45f;     // of the width
constexpr float k_path_lines = 22;       // lines of text, the load path
constexpr float k_most_path = 0.5f;      // of the height of the side panel
constexpr int k_keeping_steps = 20;      // of a camera that keeps bodies in the picture
constexpr float k_least_letters = 12;    // px

/// Where there is a keyboard: off screen there is none. What lies over the panels has its own keys.
void set_keyboard_navigation(bool on) {
  ImGuiIO& io = ImGui::GetIO();
  if (io.BackendPlatformName == nullptr) return;
  if (on)
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  else
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
}

bool same_instant(const std::optional<io::FrameRow>& a, const std::optional<io::FrameRow>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  // an edit of what does not go on puts anchors in place and takes them away
  return a->time == b->time && a->step == b->step && a->branch == b->branch && a->anchor == b->anchor;
}

/// What was changed after the start, as "shake.1.amplitude (3.60 s)".
std::string changes_on_the_way(const Player& player) {
  constexpr std::size_t k_most = 3;
  std::string words;
  std::size_t told = 0;
  for (const EditMark& mark :
       edit_marks(player.edits(), [&](const LoggedEdit& edit) { return player.goes_on(edit); })) {
    if (mark.last.step == 0) continue;
    if (++told > k_most) return words + ", …";
    words += (words.empty() ? "" : ", ") +
             fmt::format("{} ({:.2f} s)", io::scene_key(mark.last.edit, player.scene().setup.model),
                         mark.last.time);
  }
  return words;
}

std::string earlier_in_words(const Player& player) {
  const std::string changes = changes_on_the_way(player);
  return changes.empty() ? say(furnish_words::k_ghost_before)
                         : say(furnish_words::k_ghost_before_edited, changes);
}

}  // namespace

EarlierRun::EarlierRun(std::shared_ptr<const io::Scene> scene, const Player& player)
    : scene_(std::move(scene)),
      way_(player.way()),
      words_(earlier_in_words(player)),
      extent_(std::make_unique<const RunExtent>()),
      bridge_(std::make_unique<const Bridge>(*scene_, *extent_)) {}

void EarlierRun::add(const io::FrameRow& beside, const PictureSettings& settings,
                     render::SceneFrame& out) const {
  const double time = beside.time;
  if (way_.empty() || time > way_.back()->time) return;
  const auto later = std::ranges::lower_bound(way_, time, {}, [](const RowPtr& row) { return row->time; });
  const io::FrameRow& after = **later;
  const io::FrameRow row = later == way_.begin() ? after : blend(**(later - 1), after, time);
  render::SceneFrame ghost;
  bridge_->add_ghost(row, beside, settings, ghost);
  const auto profiles = static_cast<std::uint32_t>(out.profiles.size());
  out.profiles.insert(out.profiles.end(), bridge_->profiles().begin(), bridge_->profiles().end());
  out.ghost_stations = std::move(ghost.ghost_stations);
  out.ghost_tubes = std::move(ghost.ghost_tubes);
  for (render::Tube& tube : out.ghost_tubes) tube.profile += profiles;
}

GhostCurves EarlierRun::curves(const Model& model) const {
  GhostCurves curves{way_, {}};
  const std::vector<Body>& own = scene_->setup.model.bodies;
  for (int b = 0; b < model.furniture_total(); ++b) {
    const auto same = std::ranges::find(own, model.bodies[static_cast<std::size_t>(b)].name, &Body::name);
    curves.body.push_back(same == own.end() ? -1 : static_cast<int>(same - own.begin()));
  }
  return curves;
}

render::OverlayFonts set_up_interface(render::Stage& stage, float scale, const Appearance& appearance,
                                      const io::Scene* scene) {
  window_language() = appearance.language;
  window_is_dark() = appearance.dark;
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.Fonts->Clear();
  scale *= static_cast<float>(appearance.scale);
  render::Letters letters = window_letters(scene);
  letters.smallest = k_least_letters;
  const render::OverlayFonts fonts =
      render::add_overlay_fonts(*io.Fonts, static_cast<int>(std::lround(720 * scale)), letters);
  io.FontDefault = fonts.small;
  stage.upload_fonts(*io.Fonts);
  set_style(scale);
  return fonts;
}

void begin_panel(const char* name, const Box& box) {
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.width, box.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus |
                   ImGuiWindowFlags_NoBackground);
}

render::Surface surface_with_scene(const Box& scene) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec4 panel = ImGui::GetStyle().Colors[ImGuiCol_WindowBg];
  const auto pixels = [](float x, float scale) { return static_cast<int>(std::lround(x * scale)); };
  return {.width = pixels(io.DisplaySize.x, io.DisplayFramebufferScale.x),
          .height = pixels(io.DisplaySize.y, io.DisplayFramebufferScale.y),
          .scene_left = pixels(scene.left, io.DisplayFramebufferScale.x),
          .scene_top = pixels(scene.top, io.DisplayFramebufferScale.y),
          .background = {panel.x, panel.y, panel.z}};
}

Viewer::Viewer(Player& player, render::Stage& stage, float scale, render::NamedView view,
               const PictureSettings& settings, const Appearance& appearance, Keep keep)
    : player_(player),
      stage_(stage),
      desktop_scale_(scale),
      appearance_(appearance),
      keep_(std::move(keep)),
      bridge_(player.scene(), player.extent(), false),
      settings_(settings),
      view_(view),
      hand_(player) {
  apply_appearance();
}

Appearance Viewer::fitting() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return app::fitting(appearance_, desktop_scale_, size.x, size.y);
}

void Viewer::apply_appearance() {
  applied_ = fitting();
  scale_ = desktop_scale_ * static_cast<float>(applied_.scale);
  fonts_ = set_up_interface(stage_, desktop_scale_, applied_, &player_.scene());
  scene_changed_ = true;
}

void Viewer::choose_appearance(const Appearance& appearance) {
  appearance_ = appearance;
  try {
    if (keep_) keep_(appearance_);
  } catch (const std::runtime_error& error) {
    message_ = say(window_words::k_not_written, error.what());
  }
  if (const double scale = fitting().scale; scale < appearance_.scale)
    message_ = say(window_words::k_letters_too_large, 100 * appearance_.scale, 100 * scale);
}

bool Viewer::update(double wall_s) {
  const bool reapply = applied_ != fitting();
  if (reapply) apply_appearance();
  bool news = player_.update(wall_s) || reapply;
  const bool words = std::exchange(words_due_, false);
  if (teaching_.guide && teaching_.guide->update()) news = true;
  const bool computes = (teaching_.accuracy && !teaching_.accuracy->over()) ||
                        (teaching_.map.search && !teaching_.map.search->over()) ||
                        (precision_.search && !precision_.search->over());
  if (std::exchange(computes_, computes) || computes) news = true;  // how far it is is shown
  if (flight_ < 1) move_camera(wall_s);
  const bool moved = row_ && camera_changed_;
  quiet_ = news || moved ? 0 : quiet_ + wall_s;
  const bool refine = stage_.software() && !drawn_still_ && quiet_ > k_quiet && !player_.playing();
  return news || words || moved || refine;
}

void Viewer::lay_out() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (panels_hidden_) {
    scene_ = {0, 0, std::max(size.x, 16.f), std::max(size.y, 16.f)};
    plots_ = timeline_ = transport_ = side_ = path_ = status_ = {};
    asked_ = ShellRequest::none;
    return;
  }
  const float line = fonts_.small->FontSize;
  const float side = std::min(k_side_panel * scale_, k_most_side * size.x);
  const float status = static_cast<float>(k_status_lines) * ImGui::GetTextLineHeightWithSpacing() +
                       2 * ImGui::GetStyle().WindowPadding.y;
  const float bar = transport_height_ > 0 ? transport_height_ : 38 * scale_;
  const float timeline =
      std::min({182 * scale_, 0.3f * size.y, 0.45f * std::max(size.y - status - bar, 0.f)});
  const float upper = std::max(size.y - status - bar - timeline, 16.f);
  const float heading = ImGui::GetFrameHeightWithSpacing() + 2 * ImGui::GetStyle().WindowPadding.y;
  const float plots = inspection_.plots.empty()
                          ? 0
                          : std::min(heading + line * plots_height(inspection_), k_most_plots * upper);
  const float scene = std::max(upper - plots, 16.f);
  scene_ = {0, 0, std::max(size.x - side, 16.f), scene};
  plots_ = {0, scene, scene_.width, plots};
  const float path =
      is_static(player_.scene().setup) ? std::min(k_path_lines * line, k_most_path * (upper + timeline)) : 0;
  side_ = {scene_.width, 0, side, upper + timeline - path};
  path_ = {scene_.width, side_.height, side, path};
  timeline_ = {0, upper, scene_.width, timeline};
  transport_ = {0, upper + timeline, size.x, bar};
  status_ = {0, upper + bar + timeline, size.x, status};
}

render::Surface Viewer::surface() const {
  return surface_with_scene(scene_);
}

void Viewer::report_frame_time(double ms) {
  frame_ms_ = frame_ms_ == 0 ? ms : 0.9 * frame_ms_ + 0.1 * ms;
}

void Viewer::build(const std::function<void()>& over, bool covered) {
  const Box before = scene_;
  write_status();
  lay_out();
  if (before.width != scene_.width || before.height != scene_.height) {
    camera_changed_ = true;
    fitted_ = fitted_ && moved_;
  }
  if (!covered) handle_characters();
  set_keyboard_navigation(!covered);
  if (std::exchange(to_next_panel_, false)) focus_next_panel();
  for (int button = 0; button < 3; ++button)
    if (ImGui::IsMouseClicked(button)) {
      refused_.clear();
      message_.clear();
    }
  std::optional<io::FrameRow> row = player_.row();
  const LiveStatus& status = player_.status();
  const int failed = status.kind == LiveStatus::Kind::failed ? status.element : -1;
  const std::optional<std::int32_t> pale = player_.ghost_branch();
  const std::size_t rows = player_.extent().way.size();  // scales go by them: a recording is read in pieces
  if (!same_instant(row, row_) || failed != failed_element_ || pale != pale_branch_ || rows != rows_)
    scene_changed_ = true;
  rows_ = rows;
  pale_branch_ = pale;
  failed_element_ = failed;
  row_ = std::move(row);
  handle_mouse();
  if (row_) draw_words(*row_);
  if (!panels_hidden_) draw_panels();
  if (precision_.open) draw_precision(player_, precision_, refused_);
  if (keys_shown_) draw_key_table();
  if (over) over();
  ImGui::Render();
  draw_scene();
}

bool Viewer::shows_earlier() const {
  if (!earlier_ || !ghost_shown_) return false;
  const auto& branches = player_.history().branches;
  const auto shown = std::ranges::find(branches, player_.shown_branch(), &Branch::id);
  return !player_.ghost_branch() || shown == branches.end() || shown->fork_step == 0;
}

GhostCurves Viewer::ghost_curves() const {
  const Model& model = player_.scene().setup.model;
  if (shows_earlier()) return earlier_->curves(model);
  GhostCurves curves;
  if (!ghost_shown_) return curves;
  curves.way = player_.ghost_way();
  for (int b = 0; b < model.furniture_total(); ++b) curves.body.push_back(b);
  return curves;
}

void Viewer::draw_panels() {
  draw_side_panel(row_);
  asked_ = draw_transport_bar(player_, transport_, transport_height_);
  draw_timeline(player_, timeline_, tilts_, ghost_curves());
  if (is_static(player_.scene().setup)) draw_load_path(player_, path_);
  if (!inspection_.plots.empty()) draw_plots_strip();
  draw_status();
}

void Viewer::draw_scene() {
  if (!row_) return;
  const bool changed = scene_changed_ || camera_changed_;
  if (!changed && (drawn_still_ || quiet_ <= k_quiet || player_.playing())) return;
  if (scene_changed_) {
    const auto& picked = inspection_.picked;
    settings_.diagram.reset();
    if (picked && picked->kind == Subject::Kind::member)
      settings_.diagram = Diagram{picked->index, inspection_.component};
    frame_ = bridge_.frame(*row_, player_.parameters_so_far(), settings_);
    frame_.dark = appearance_.dark;
    if (traits(settings_.bodies).boards && is_finite(*row_)) {
      if (!solid_ || solid_->bodies() != settings_.bodies) solid_.emplace(player_.scene(), settings_.bodies);
      solid_->dress(*row_, frame_);
    }
    if (picked)
      highlight(player_.scene().setup.model, *picked, frame_);
    else if (failed_element_ >= 0)
      frame_.highlighted_member =
          player_.scene().setup.model.elements[static_cast<std::size_t>(failed_element_)].member;
    if (shows_earlier())
      earlier_->add(*row_, settings_, frame_);
    else if (const auto ghost = ghost_shown_ ? player_.ghost() : std::nullopt)
      bridge_.add_ghost(*ghost, *row_, settings_, frame_);
  }
  if (follows_ && scene_changed_) move_with_followed();
  if (keeps_in_picture_ && scene_changed_ && fitted_) keep_in_picture();
  if (!fitted_) {
    fit_view(view_);
    flight_ = 1;
    orbit_ = to_;
    fitted_ = true;
  }
  orbit_.set_bounds(frame_);
  drawn_still_ = !changed;
  stage_.set_budget(player_.playing() || camera_changed_ ? std::optional(render::k_scene_budget)
                                                         : std::nullopt);
  const render::Surface surface = this->surface();
  const ImVec2 pixel = ImGui::GetIO().DisplayFramebufferScale;
  stage_.draw_scene(frame_, orbit_.camera(aspect()), settings_.map,
                    std::min(static_cast<int>(std::lround(scene_.width * pixel.x)), surface.width),
                    std::min(static_cast<int>(std::lround(scene_.height * pixel.y)), surface.height),
                    drawn_still_ ? render::Quality::still : render::Quality::interactive);
  words_due_ = words_due_ || changed;  // legend and labels were written for what was drawn before
  scene_changed_ = camera_changed_ = false;
}

void Viewer::look(const render::Orbit& orbit) {
  orbit_ = from_ = to_ = orbit;
  flight_ = 1;
  fitted_ = moved_ = camera_changed_ = true;
}

void Viewer::follow(const std::optional<std::size_t>& body) {
  follows_.reset();
  if (body && row_) follows_ = Followed{*body, centre_of(*row_, *body)};
}

void Viewer::move_with_followed() {
  if (!is_finite(*row_)) return;
  const Eigen::Vector3f centre = centre_of(*row_, follows_->body), moved = centre - follows_->centre;
  for (render::Orbit* const orbit : {&orbit_, &from_, &to_}) orbit->target += moved;
  follows_->centre = centre;
}

// Smoothly while it plays; at once where a person goes to an instant.
void Viewer::keep_in_picture() {
  std::vector<Eigen::Vector3f> ends;
  for (const render::Tube& tube : frame_.tubes)
    if (tube.body < static_cast<std::uint32_t>(player_.scene().setup.model.furniture_total()))
      for (const std::uint32_t end : {tube.first_station, tube.first_station + tube.station_count - 1})
        ends.emplace_back(frame_.stations[end].position.data());
  const bool plays = player_.playing();
  for (int i = 0; i < (plays ? 1 : k_keeping_steps); ++i) orbit_.keep(ends, aspect(), plays ? 0.15f : 1);
  flight_ = 1;
}

// What may still fall needs room beside it; words lie above, below and at the right. Where they leave little
// height, bodies stand beside them.
void Viewer::fit_view(render::NamedView view) {
  render::SceneFrame frame = frame_;
  if (!player_.replay()) {
    const float room = k_falling_room * (frame.bounds_max[2] - frame.bounds_min[2]);
    for (int k = 0; k < 2; ++k) {
      frame.bounds_min[k] -= room;
      frame.bounds_max[k] += room;
    }
  }
  const bool low = scene_.height - words_top_ - words_bottom_ < k_least_free * scene_.height;
  const bool beside = low && scene_.width - words_left_ - words_right_ > k_least_beside * scene_.width;
  const float left = beside ? words_left_ : 0, top = beside ? 0 : words_top_;
  const float width = std::max(scene_.width - left - words_right_, k_least_beside * scene_.width);
  const float height = std::max(scene_.height - top - words_bottom_, k_least_free * scene_.height);
  view_ = view;
  moved_ = false;
  from_ = orbit_;
  to_ = render::Orbit::fit(view, frame, width / height);
  to_.distance *= scene_.height / height;
  to_.pan(left + (width - scene_.width) / 2, (top - words_bottom_) / 2, scene_.height);
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
  handle_hand(inside, x, y);
  const bool takes_hold = io.KeyCtrl && ImGui::IsMouseClicked(0);
  if (inside && !takes_hold &&
      (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2))) {
    dragging_ = true;
    dragged_ = false;
  }
  const bool turn = io.MouseDown[0] && !io.KeyShift;
  const bool pan = io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
  if (dragging_ && (turn || pan)) {
    for (int button = 0; button < 3; ++button)
      dragged_ =
          dragged_ || io.MouseDragMaxDistanceSqr[button] > k_click_travel * k_click_travel * scale_ * scale_;
    if (dragged_ && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
      flight_ = 1;
      moved_ = true;
      if (pan)
        orbit_.pan(io.MouseDelta.x, io.MouseDelta.y, scene_.height);
      else
        orbit_.rotate(io.MouseDelta.x, io.MouseDelta.y);
      camera_changed_ = true;
    }
  }
  if (dragging_ && !dragged_ && ImGui::IsMouseReleased(0)) pick(picked_at(x, y));
  if (!ImGui::IsAnyMouseDown()) dragging_ = false;
  if (inside && io.MouseWheel != 0) {
    flight_ = 1;
    moved_ = true;
    orbit_.zoom(std::pow(1.15f, io.MouseWheel), x, y, scene_.width, scene_.height);
    camera_changed_ = true;
  }
}

std::optional<render::Pick> Viewer::picked_at(float x, float y) const {
  return render::pick(frame_, orbit_.camera(aspect()), static_cast<int>(scene_.width),
                      static_cast<int>(scene_.height), x, y);
}

void Viewer::handle_hand(bool inside, float x, float y) {
  const bool held = hand_.holds();
  if (inside && ImGui::GetIO().KeyCtrl && ImGui::IsMouseClicked(0))
    if (const auto found = picked_at(x, y)) message_ = hand_.grab(frame_, *found);
  if (hand_.holds() && ImGui::IsMouseDown(0) && player_.can_edit()) {
    hand_.pull(orbit_.camera(aspect()), scene_.width, scene_.height, x, y);
    message_ = hand_.words();
  } else {
    hand_.let_go();
    if (held) message_.clear();
  }
}

// A member that is picked again gives way to its body.
void Viewer::pick(const std::optional<render::Pick>& found) {
  const std::size_t members = player_.scene().setup.model.members.size();
  if (!found) {
    inspect(std::nullopt);
  } else if (found->member >= members) {
    inspect(Subject{Subject::Kind::anchor, found->member - members});
  } else {
    const bool solid = player_.scene().setup.model.bodies[found->body].solid;
    if (solid || !traits(settings_.bodies).beams) return inspect(Subject{Subject::Kind::body, found->body});
    const Subject member{Subject::Kind::member, found->member};
    inspect(inspection_.picked == member ? Subject{Subject::Kind::body, found->body} : member);
  }
}

void Viewer::guide(std::size_t demo, const std::string& came_from, const std::string& scene) {
  tab_ = Tab::teach;
  teaching_.came_from = came_from;
  teaching_.scene_before = scene;
  teaching_.guide.emplace(demos()[demo], player_);
  teaching_.begins = true;
}

void Viewer::inspect(const std::optional<Subject>& subject) {
  inspection_.picked = subject;
  if (subject) tab_ = Tab::inspect;
  scene_changed_ = true;
}

}  // namespace topple::app
