#include "app/window/chooser.h"

#include <imgui.h>
#include <utf8.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "app/panels/demo.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "app/picture/words.h"
#include "app/window/opening.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

constexpr float k_card = 200;    // px at scale 1: least width of a card
constexpr float k_recent = 270;  // of the column of files

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string title_of(const io::BuiltinScene& scene) {
  const io::Node root = io::parse_toml(scene.text, std::string(scene.name));
  const io::Node* const title = root.find("title");
  return title ? title->text : std::string();
}

/// Text on one line, with an ellipsis where it is longer than `width`.
void add_line(ImDrawList& list, ImFont* font, ImVec2 at, float width, ImU32 colour, const std::string& text) {
  const auto wide = [&](const std::string& t) {
    return font->CalcTextSizeA(font->FontSize, 1e6f, 0, t.c_str()).x;
  };
  const std::string whole = utf8::replace_invalid(text);
  std::string shown = whole;
  while (!shown.empty() && wide(shown == whole ? shown : shown + "…") > width) {
    auto last = shown.end();
    utf8::prior(last, shown.begin());
    shown.erase(last, shown.end());
  }
  list.AddText(font, font->FontSize, at, colour, (shown == whole ? shown : shown + "…").c_str());
}

}  // namespace

Chooser::Chooser(render::Stage& stage, std::function<void()> wake) : thumbnails_(stage, std::move(wake)) {
  for (const io::BuiltinScene& scene : io::builtin_scenes())
    scenes_.push_back({std::string(scene.name), title_of(scene)});
  if (const auto first = std::ranges::find(scenes_, k_demo_scene, &Entry::source); first != scenes_.end())
    std::rotate(scenes_.begin(), first, first + 1);
  filter();
}

void Chooser::open() {
  open_ = appeared_ = true;
  filter_[0] = '\0';
  recent_.clear();
  for (const std::string& path : recent_files()) {
    std::error_code ignored;
    recent_.push_back({path, fs::path(path).parent_path().string(), !fs::exists(path, ignored)});
  }
  filter();
  thumbnails_.want();
}

void Chooser::filter() {
  filtered_by_ = filter_;
  const std::string wanted = lower(filtered_by_);
  const auto only = [&](const std::vector<Entry>& all) {
    std::vector<Entry> some;
    for (const Entry& entry : all)
      if (lower(entry.source + " " + entry.title + " " + in_window_language(entry.title)).find(wanted) !=
          std::string::npos)
        some.push_back(entry);
    // names that begin so come first, then names that hold it, then titles
    std::ranges::stable_sort(some, {}, [&](const Entry& entry) { return lower(entry.source).find(wanted); });
    return some;
  };
  shown_scenes_ = only(scenes_);
  shown_recent_ = only(recent_);
  in_recent_ = shown_scenes_.empty() && !shown_recent_.empty();
  selected_ = 0;
  scroll_to_selected_ = true;
}

std::vector<std::string> Chooser::shown() const {
  std::vector<std::string> names;
  for (const auto* entries : {&shown_recent_, &shown_scenes_})
    for (const Entry& entry : *entries) names.push_back(entry.source);
  return names;
}

std::string Chooser::selected() const {
  const std::vector<Entry>& entries = in_recent_ ? shown_recent_ : shown_scenes_;
  return selected_ < static_cast<int>(entries.size()) ? entries[static_cast<std::size_t>(selected_)].source
                                                      : std::string();
}

void Chooser::choose(const Entry& entry) {
  if (!entry.missing) choice_ = entry.source;
}

std::optional<std::string> Chooser::take_choice() {
  return std::exchange(choice_, std::nullopt);
}

void Chooser::press(const render::KeyPress& press) {
  namespace key = render::key;
  const auto count = [](const std::vector<Entry>& entries) { return static_cast<int>(entries.size()); };
  const std::vector<Entry>& entries = in_recent_ ? shown_recent_ : shown_scenes_;
  const int row = in_recent_ ? 1 : columns_;
  if (press.key == key::enter || press.key == key::enter_of_pad) {
    if (selected_ < count(entries)) choose(entries[static_cast<std::size_t>(selected_)]);
    return;
  }
  int wanted = selected_;
  if (press.key == key::up) wanted -= row;
  if (press.key == key::down) wanted += row;
  if (press.key == key::left && !in_recent_) {
    if (selected_ % columns_ == 0 && !shown_recent_.empty()) {
      in_recent_ = true;
      selected_ = 0;
      return;
    }
    --wanted;
  }
  if (press.key == key::right) {
    if (in_recent_ && !shown_scenes_.empty()) {
      in_recent_ = false;
      selected_ = 0;
      scroll_to_selected_ = true;
      return;
    }
    ++wanted;
  }
  if (wanted == selected_) return;
  if (wanted >= 0 && wanted < count(entries)) selected_ = wanted;
  scroll_to_selected_ = true;
}

void Chooser::draw(const Box& box, const render::OverlayFonts& fonts) {
  if (filtered_by_ != filter_) filter();
  const float unit = fonts.small->FontSize / 14;
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.width, box.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {24 * unit, 18 * unit});
  ImGui::Begin("chooser", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
  ImGui::PushFont(fonts.title);
  ImGui::TextUnformatted(say(ww::k_choose).c_str());
  ImGui::PopFont();
  const float filter_width = 240 * unit, gap = 18 * unit;
  const std::string about = say(ww::k_choose_about);
  ImGui::SameLine(0, gap);
  const float room = ImGui::GetWindowContentRegionMax().x - filter_width - gap - ImGui::GetCursorPosX();
  const bool beside = ImGui::CalcTextSize(about.c_str()).x <= room;
  if (beside) {
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + fonts.title->FontSize - fonts.small->FontSize * 1.25f);
    ImGui::TextDisabled("%s", about.c_str());
  }
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - filter_width);
  ImGui::SetCursorPosY(18 * unit);
  ImGui::SetNextItemWidth(filter_width);
  if (std::exchange(appeared_, false)) ImGui::SetKeyboardFocusHere();
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1);
  ImGui::InputTextWithHint("##filter", say(ww::k_filter).c_str(), filter_, sizeof filter_);
  ImGui::PopStyleVar();
  if (!beside) ImGui::TextDisabled("%s", about.c_str());
  ImGui::Dummy({0, 6 * unit});
  const float foot = ImGui::GetFrameHeightWithSpacing();
  const ImGuiWindowFlags plain = ImGuiWindowFlags_NoNav;
  ImGui::BeginChild("recent", {k_recent * unit, -foot}, false, plain);
  draw_recent(fonts);
  ImGui::EndChild();
  ImGui::SameLine(0, 20 * unit);
  ImGui::BeginChild("built-in", {0, -foot}, false, plain);
  ImGui::TextUnformatted(say(ww::k_built_in).c_str());
  ImGui::Separator();
  ImGui::BeginChild("scenes", {0, 0}, false, plain);
  draw_scenes(fonts);
  ImGui::EndChild();
  ImGui::EndChild();
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", say(ww::k_choose_keys).c_str());
  const std::string new_room = say(furnish_words::k_new_room) + "…", browse = say(ww::k_browse);
  const ImGuiStyle& style = ImGui::GetStyle();
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize((new_room + browse).c_str()).x -
                  4 * style.FramePadding.x - style.ItemSpacing.x);
  if (ImGui::Button(browse.c_str())) browse_ = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(ww::k_browse_about).c_str());
  ImGui::SameLine();
  if (ImGui::Button(new_room.c_str())) new_room_ = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", say(furnish_words::k_new_room_about).c_str());
  ImGui::End();
}

void Chooser::draw_recent(const render::OverlayFonts& fonts) {
  ImGui::TextUnformatted(say(ww::k_recent).c_str());
  ImGui::Separator();
  if (recent_.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", say(ww::k_no_recent).c_str());
    ImGui::PopTextWrapPos();
  }
  const float line = fonts.small->FontSize, height = 2.9f * line;
  for (std::size_t i = 0; i < shown_recent_.size(); ++i) {
    const Entry& entry = shown_recent_[i];
    const bool selected = in_recent_ && static_cast<int>(i) == selected_;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::PushID(entry.source.c_str());
    if (ImGui::Selectable("##file", selected, 0, {width, height}) && !entry.missing) {
      in_recent_ = true;
      selected_ = static_cast<int>(i);
      choose(entry);
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", entry.source.c_str());
    ImGui::PopID();
    if (selected && std::exchange(scroll_to_selected_, false)) ImGui::SetScrollHereY();
    const ImU32 quiet = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 first{at.x + 6, at.y + 0.25f * line}, second{at.x + 6, at.y + 1.5f * line};
    add_line(list, fonts.small, first, width - 12, entry.missing ? quiet : ImGui::GetColorU32(ImGuiCol_Text),
             fs::path(entry.source).filename().string());
    add_line(list, fonts.small, second, width - 12, quiet, entry.missing ? say(ww::k_missing) : entry.title);
  }
}

void Chooser::draw_scenes(const render::OverlayFonts& fonts) {
  if (shown_scenes_.empty()) ImGui::TextDisabled("%s", say(ww::k_nothing_found, filtered_by_).c_str());
  const float unit = fonts.small->FontSize / 14, gap = 12 * unit;
  const float room = ImGui::GetContentRegionAvail().x;
  columns_ = std::max(1, static_cast<int>((room + gap) / (k_card * unit + gap)));
  const float width =
      std::floor((room - gap * static_cast<float>(columns_ - 1)) / static_cast<float>(columns_));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, gap});
  for (std::size_t i = 0; i < shown_scenes_.size(); ++i) {
    if (i % static_cast<std::size_t>(columns_) != 0) ImGui::SameLine();
    const bool selected = !in_recent_ && static_cast<int>(i) == selected_;
    ImGui::PushID(shown_scenes_[i].source.c_str());
    draw_card(shown_scenes_[i], selected, width, fonts);
    ImGui::PopID();
    if (selected && std::exchange(scroll_to_selected_, false)) ImGui::SetScrollHereY();
  }
  ImGui::PopStyleVar();
}

void Chooser::draw_card(const Entry& entry, bool selected, float width, const render::OverlayFonts& fonts) {
  const float line = fonts.small->FontSize, pad = 0.6f * line;
  const float picture = std::round(width * k_thumbnail_height / k_thumbnail_width);
  const float height = picture + 4.6f * line;
  const ImVec2 at = ImGui::GetCursorScreenPos(), end{at.x + width, at.y + height};
  if (ImGui::InvisibleButton("card", {width, height})) choose(entry);
  const bool hovered = ImGui::IsItemHovered();
  if (hovered) ImGui::SetTooltip("%s", in_window_language(entry.title).c_str());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float round = 5;
  list.AddRectFilled(at, end, ImGui::GetColorU32(hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg),
                     round);
  const ImVec2 corner{end.x, at.y + picture};
  if (void* const texture = thumbnails_.of(entry.source))
    list.AddImageRounded(texture, at, corner, {0, 0}, {1, 1}, IM_COL32_WHITE, round,
                         ImDrawFlags_RoundCornersTop);
  else
    list.AddRectFilled(at, corner, ImGui::GetColorU32(ImGuiCol_Button), round, ImDrawFlags_RoundCornersTop);
  const bool first = entry.source == k_demo_scene;
  add_line(list, fonts.small, {at.x + pad, corner.y + 0.45f * line}, width - 2 * pad,
           ImGui::GetColorU32(ImGuiCol_Text), entry.source + (first ? "  " + say(ww::k_begin_here) : ""));
  const std::string words = in_window_language(entry.title);
  const char* const title = words.c_str();
  const char* rest = fonts.small->CalcWordWrapPositionA(1, title, title + words.size(), width - 2 * pad);
  const ImU32 quiet = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const float about = corner.y + 1.75f * line;
  list.AddText(fonts.small, line, {at.x + pad, about}, quiet, title, rest);
  while (*rest == ' ') ++rest;
  add_line(list, fonts.small, {at.x + pad, about + 1.2f * line}, width - 2 * pad, quiet, rest);
  const ImU32 edge = selected ? IM_COL32(28, 112, 190, 255) : ImGui::GetColorU32(ImGuiCol_Border);
  const float inset = selected ? 1 : 0;
  list.AddRect({at.x + inset, at.y + inset}, {end.x - inset, end.y - inset}, edge, round, 0,
               selected ? 2.5f : 1);
}

}  // namespace topple::app
