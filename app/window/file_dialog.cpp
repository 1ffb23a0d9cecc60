#include "app/window/file_dialog.h"

#include <imgui.h>
#include <utf8.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "app/panels/shell_words.h"
#include "app/window/message.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

constexpr float k_lines = 14;  // of the list

void set_text(char (&field)[4096], const std::string& text) {
  field[text.copy(field, sizeof field - 1)] = '\0';
}

}  // namespace

void FileDialog::ask(FileQuestion question, std::function<void(const std::string&)> then) {
  question_ = std::move(question);
  then_ = std::move(then);
  desktop_ = DesktopDialog::begin(question_);
  open_ = !desktop_;
  if (!open_) return;
  std::error_code ignored;
  const fs::path start = fs::absolute(question_.start, ignored);
  set_text(name, question_.saves ? start.filename().string() : "");
  enter_folder((fs::is_directory(start, ignored) ? start : start.parent_path()).string());
}

bool FileDialog::update() {
  if (!desktop_ || !desktop_->update()) return false;
  const std::string path = std::exchange(desktop_, nullptr)->answer();
  if (!path.empty()) then_(path);
  return true;
}

void FileDialog::enter_folder(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> folders, files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string found = entry->path().filename().string();
    std::error_code ignored;
    if (found.starts_with('.')) continue;
    if (entry->is_directory(ignored))
      folders.push_back(found + '/');
    else if (question_.endings.empty() ||
             std::ranges::any_of(question_.endings, [&](const std::string& e) { return found.ends_with(e); }))
      files.push_back(found);
  }
  problem_ = error ? folder + ": " + error.message() : "";
  if (error) return;
  folder_ = folder;
  std::ranges::sort(folders);
  std::ranges::sort(files);
  entries_ = std::move(folders);
  entries_.insert(entries_.end(), files.begin(), files.end());
}

void FileDialog::accept() {
  const fs::path path = (fs::path(folder_) / name).lexically_normal();
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    set_text(name, "");
    return enter_folder(path.string());
  }
  if (!question_.saves && !fs::exists(path, ignored)) {
    problem_ = say(ww::k_no_such_file, path.string());
    return;
  }
  open_ = false;
  then_(path.string());
}

void FileDialog::press(const render::KeyPress& press) {
  if (press.key == render::key::escape) close();
  enter_ = enter_ || press.key == render::key::enter || press.key == render::key::enter_of_pad;
}

void FileDialog::draw(const Box& window, const render::OverlayFonts& fonts) {
  begin_panel_over("files", window, 640, 0.4f, question_.title, fonts);
  if (ImGui::Button(say(ww::k_folder_above).c_str())) enter_folder(fs::path(folder_).parent_path().string());
  ImGui::SameLine();
  ImGui::TextUnformatted(utf8::replace_invalid(folder_).c_str());
  draw_entries(std::min(k_lines * ImGui::GetTextLineHeightWithSpacing(), 0.5f * window.height));
  ImGui::SetNextItemWidth(-1);
  ImGui::InputText("##name", name, sizeof name);
  if (!problem_.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(utf8::replace_invalid(problem_).c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::Dummy({0, 4});
  const bool chosen = button_at_right(say(ww::k_choose_file), 1, *name != '\0');
  const bool cancel = button_at_right(say(ww::k_cancel), 0);
  end_panel_over();
  if (cancel) return close();
  if ((std::exchange(enter_, false) && *name != '\0') || chosen) accept();
}

void FileDialog::draw_entries(float height) {
  ImGui::BeginChild("entries", {0, height}, true);
  std::string entered;
  for (const std::string& entry : entries_) {
    ImGui::PushID(entry.c_str());
    if (ImGui::Selectable("##entry", entry == name, ImGuiSelectableFlags_AllowDoubleClick)) {
      const bool twice = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
      if (entry.ends_with('/'))
        entered = entry;
      else
        set_text(name, entry);
      enter_ = enter_ || (twice && entered.empty());
    }
    ImGui::SameLine(0, 0);
    ImGui::TextUnformatted(utf8::replace_invalid(entry).c_str());
    ImGui::PopID();
  }
  ImGui::EndChild();
  if (entered.empty()) return;
  enter_folder((fs::path(folder_) / entered).lexically_normal().parent_path().string());
  if (!question_.saves) set_text(name, "");
}

bool draw_path_field(char (&path)[4096], FileDialog& files, const FileQuestion& question, int opened) {
  const std::string browse = say(ww::k_browse);
  const ImGuiStyle& style = ImGui::GetStyle();
  const float button = ImGui::CalcTextSize(browse.c_str()).x + 2 * style.FramePadding.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - style.ItemSpacing.x);
  const bool changed = ImGui::InputText(("##path" + std::to_string(opened)).c_str(), path, sizeof path);
  ImGui::SameLine();
  if (ImGui::Button(browse.c_str()))
    files.ask(question, [&path](const std::string& p) { set_text(path, p); });
  return changed;
}

}  // namespace topple::app
