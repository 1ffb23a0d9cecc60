#include "app/window/export_dialog.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "app/panels/shell_words.h"
#include "app/picture/row.h"
#include "app/support/files.h"
#include "app/support/terms.h"
#include "app/window/message.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

constexpr int k_most_rate = 240;
constexpr int k_about_lines = 1, k_note_lines = 3;

/// The options of `topple render` that draw as the viewer does, all that it shows. aspect: width / height of
/// the picture.
std::vector<std::string> as_seen(const Player& player, const Viewer& viewer, float aspect) {
  const PictureSettings& s = viewer.settings();
  const Model& model = player.scene().setup.model;
  const render::Orbit& orbit = viewer.orbit();
  const std::optional<std::size_t> body = viewer.followed();
  Eigen::Vector3f target = orbit.target;  // at the first instant, of a camera that follows
  if (const auto row = player.row(); body && row)
    target -= centre_of(*row, *body) - centre_of(*player.way().front(), *body);
  std::vector<std::string> words{
      "--camera",
      fmt::format("{},{},{},{},{},{}{}", orbit.sight.azimuth * k_degrees, orbit.sight.elevation * k_degrees,
                  orbit.distance_for(aspect, viewer.aspect()), target.x(), target.y(), target.z(),
                  body ? ",follow:" + model.bodies[*body].name : ""),
      "--colour",
      traits(s.colour).word,
      "--map",
      s.map == render::ColourMap::cividis ? "cividis" : "viridis",
      "--range",
      s.range == RangePolicy::run       ? "run"
      : s.range == RangePolicy::instant ? "instant"
                                        : fmt::format("{}", s.maximum),
      "--exaggerate",
      fmt::format("{}", s.exaggeration)};
  if (s.contact_forces) words.push_back("--forces");
  if (!s.panels) words.push_back("--no-panels");
  if (s.bodies != Bodies::beams) {
    words.push_back("--bodies");
    words.push_back(traits(s.bodies).word);
  }
  if (!s.words) words.push_back("--no-words");
  if (s.trails != Trails::none) {
    words.push_back("--trails");
    words.push_back(s.trails == Trails::run ? "run" : "second");
  }
  if (const auto ghost = player.ghost_branch(); ghost && viewer.ghost_shown() && !viewer.shows_earlier()) {
    words.push_back("--ghost");
    words.push_back(std::to_string(*ghost));
  }
  if (viewer.appearance().language == Language::japanese) {
    words.push_back("--lang");
    words.push_back("ja");
  }
  const auto& picked = viewer.inspection().picked;
  if (s.words && picked && picked->kind != Subject::Kind::anchor) {
    words.push_back("--inspect");
    words.push_back(name_of(model, *picked));
  }
  return words;
}

/// Why the branch shown is not exported. Empty: it is the newest.
std::string older_branch(const Player& player) {
  const std::int32_t shown = player.shown_branch(), newest = player.status().branch;
  return shown == newest ? "" : say(ww::k_export_newest, shown, newest);
}

/// Begins a place for text that is as high whatever it holds; more than it holds scrolls.
void begin_lines(const char* name, int lines) {
  ImGui::BeginChild(name, {0, static_cast<float>(lines) * ImGui::GetTextLineHeightWithSpacing()}, false,
                    ImGuiWindowFlags_NoNav);
  ImGui::PushTextWrapPos(0);
}

void end_lines() {
  ImGui::PopTextWrapPos();
  ImGui::EndChild();
}

void label(const Phrase& phrase) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(say(phrase).c_str());
  ImGui::SameLine(10 * ImGui::GetFontSize());
}

}  // namespace

void ExportDialog::open(const Player& player) {
  close();
  open_ = true;
  from = player.way().empty() ? 0 : player.way().front()->time;
  to = player.way().empty() ? 0 : player.way().back()->time;
  last_ = to;
  suggest_path(player);
}

void ExportDialog::close() {
  open_ = false;
  refused_.clear();
}

void ExportDialog::suggest_path(const Player& player) {
  const char* const endings[] = {".png", ".mp4", ""};
  std::error_code ignored;
  fs::path free;
  int number = 1;
  do
    free = fs::current_path(ignored) /
           fmt::format("{}-{}{}", player.scene().name, number++, endings[static_cast<int>(what)]);
  while (fs::exists(free, ignored));
  const std::string text = free.string();
  path[text.copy(path, sizeof path - 1)] = '\0';
}

void ExportDialog::start(const Player& player, const Viewer& viewer, const std::string& recording) {
  refused_.clear();
  const std::string result = path;
  try {
    if (player.way().empty()) throw std::runtime_error(say(ww::k_export_too_early));
    if (recording.empty()) throw std::runtime_error(say(ww::k_export_recorded));
    if (player.shown_branch() != player.status().branch) throw std::runtime_error(older_branch(player));
    std::error_code ignored;
    if (fs::exists(result, ignored) || exports_.makes(result))
      throw std::runtime_error(say(ww::k_already_there, result));
    require_writable_file("export", result, host::FileKind::any, recording);
    std::vector<std::string> words;
    if (what == What::tables) {
      exports_.add({"export", recording, "--csv"}, result, ExportJob::Makes::folder);
      return close();
    }
    const bool video = what == What::video;
    require_drawable();
    const double first = player.way().front()->time, last = player.way().back()->time;
    if (video && !(from <= last && to >= first && (from < to || first == last)))
      throw std::runtime_error(say(ww::k_no_such_range, from, to, first, last));
    words = {"render", recording, video ? "--mp4" : "--still",
             result,   "--size",  fmt::format("{}x{}", size[0], size[1])};
    const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
    if (video)
      add({"--from", fmt::format("{}", from), "--to", fmt::format("{}", to), "--fps", fmt::format("{}", rate),
           "--speed", fmt::format("{}", speed)});
    else
      add({"--at", fmt::format("{}", std::min(player.time(), player.way().back()->time))});
    const float aspect = static_cast<float>(size[0]) / static_cast<float>(size[1]);
    for (const std::string& word : as_seen(player, viewer, aspect)) words.push_back(word);
    exports_.add(words, result, ExportJob::Makes::file);
    close();
  } catch (const std::runtime_error& error) {
    refused_ = error.what();
  }
}

/// Throws what is wrong with the numbers of a picture or video.
void ExportDialog::require_drawable() const {
  const auto [least, most] = std::minmax(size[0], size[1]);
  if (least < k_least_picture || most > k_most_picture)
    throw std::runtime_error(say(ww::k_no_such_size, k_least_picture, k_most_picture, size[0], size[1]));
  if (what != What::video) return;
  if (size[0] % 2 != 0 || size[1] % 2 != 0) throw std::runtime_error(say(ww::k_odd_size, size[0], size[1]));
  if (rate < 1 || rate > k_most_rate) throw std::runtime_error(say(ww::k_no_such_rate, k_most_rate, rate));
  if (!(speed >= k_least_speed && speed <= k_most_speed))
    throw std::runtime_error(say(ww::k_no_such_speed, k_least_speed, k_most_speed, speed));
}

void ExportDialog::draw(const Player& player, const Viewer& viewer, const std::string& recording,
                        const Box& window, const render::OverlayFonts& fonts) {
  begin_panel_over("export", window, 660, 0.46f, say(ww::k_export_title), fonts);
  draw_choices(player);
  draw_notes(player, viewer);
  ImGui::Dummy({0, 4});
  if (button_at_right(say(ww::k_export_now), 1, older_branch(player).empty()))
    start(player, viewer, recording);
  if (button_at_right(say(ww::k_close), 0)) close();
  end_panel_over();
}

void ExportDialog::draw_choices(const Player& player) {
  const std::pair<const Phrase*, const Phrase*> kinds[] = {{&ww::k_picture, &ww::k_picture_about},
                                                           {&ww::k_video, &ww::k_video_about},
                                                           {&ww::k_tables, &ww::k_tables_about}};
  for (int i = 0; i < 3; ++i) {
    if (i > 0) ImGui::SameLine(0, 2 * ImGui::GetFontSize());
    if (ImGui::RadioButton(say(*kinds[i].first).c_str(), static_cast<int>(what) == i)) {
      what = static_cast<What>(i);
      suggest_path(player);
      refused_.clear();
    }
  }
  begin_lines("about", k_about_lines);
  ImGui::TextDisabled("%s", say(*kinds[static_cast<int>(what)].second).c_str());
  end_lines();
  draw_path();
  const float number = 7 * ImGui::GetFontSize();
  ImGui::BeginDisabled(what == What::tables);
  label(ww::k_size);
  ImGui::SetNextItemWidth(2 * number);
  ImGui::InputInt2("px##size", size);
  for (const auto& [width, height] : {std::pair{1280, 720}, {1920, 1080}, {3840, 2160}}) {
    ImGui::SameLine();
    if (ImGui::SmallButton(fmt::format("{}×{}", width, height).c_str())) size[0] = width, size[1] = height;
  }
  ImGui::EndDisabled();
  ImGui::BeginDisabled(what != What::video);
  // what was asked for to the end of a run that goes on follows it
  const double last = player.way().empty() ? 0 : player.way().back()->time;
  if (to >= std::exchange(last_, last)) to = last;
  const char* const unit = is_static(player.scene().setup) ? "" : "s";
  label(ww::k_from);
  ImGui::SetNextItemWidth(number);
  ImGui::InputDouble(fmt::format("{}##from", unit).c_str(), &from, 0, 0, "%.2f");
  ImGui::SameLine(0, 2 * ImGui::GetFontSize());
  ImGui::TextUnformatted(say(ww::k_to).c_str());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(number);
  ImGui::InputDouble(fmt::format("{}##to", unit).c_str(), &to, 0, 0, "%.2f");
  label(ww::k_rate);
  ImGui::SetNextItemWidth(number);
  ImGui::InputInt("##rate", &rate, 0);
  ImGui::SameLine(0, 2 * ImGui::GetFontSize());
  ImGui::SetNextItemWidth(number);
  ImGui::InputDouble((say(ww::k_times_real_time) + "##speed").c_str(), &speed, 0, 0, "%g");
  ImGui::EndDisabled();
}

/// What is wrong, else what the export leaves out.
void ExportDialog::draw_notes(const Player& player, const Viewer& viewer) {
  begin_lines("notes", k_note_lines);
  const std::string older = older_branch(player);
  if (!refused_.empty()) {
    ImGui::TextUnformatted(say(ww::k_not_written, refused_).c_str());
  } else if (!older.empty()) {
    ImGui::TextUnformatted(older.c_str());
  } else {
    if (what != What::tables && viewer.shows_earlier())
      ImGui::TextDisabled("%s", say(ww::k_export_without_before).c_str());
    // what follows a run is drawn at its newest step, of which rows may not tell yet
    if (const double last = player.way().empty() ? player.time() : player.way().back()->time;
        what == What::picture && last < player.time())
      ImGui::TextDisabled("%s", say(ww::k_picture_of_row, last).c_str());
  }
  end_lines();
}

void ExportDialog::draw_path() {
  label(what == What::tables ? ww::k_folder : ww::k_file);
  if (draw_path_field(path, files_, {true, say(ww::k_export_title), path, {}})) refused_.clear();
}

}  // namespace topple::app
