#include "app/window/save_scene.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/panels/shell_words.h"
#include "app/support/files.h"
#include "app/window/message.h"
#include "solver/io/edit/scene_save.h"
#include "solver/io/scene/scene_file.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
namespace ww = window_words;

/// Puts a file that the scene names where a scene at `path` finds it. True when that wrote it.
bool put_beside(const io::SceneFile& file, const std::string& path) {
  const fs::path name(file.name), place = fs::path(path).parent_path() / name;
  std::error_code ignored;
  if (fs::exists(place, ignored)) {
    if (io::files_beside(path)(file.name) == file.bytes) return false;
    throw io::InputError(place.string() +
                         ": is another file than the one that the scene has under this name");
  }
  try {
    if (io::files_beside(path)(file.name) == file.bytes) return false;  // built in
  } catch (const io::InputError&) {
  }
  if (name.is_absolute() || *name.lexically_normal().begin() == "..")
    throw io::InputError(place.string() + ": is gone; the scene names it outside of the folder");
  fs::create_directories(place.parent_path(), ignored);
  write_whole_file(place, host::FileKind::any, file.bytes);
  return true;
}

/// `path` with a number behind its name, under which no file is yet.
std::string free_path(const fs::path& path) {
  std::string stem = path.stem().string();
  const std::size_t dash = stem.rfind('-');
  if (dash != std::string::npos && stem.find_first_not_of("0123456789", dash + 1) == std::string::npos)
    stem.resize(dash);
  std::error_code ignored;
  fs::path free;
  int number = 1;
  do free = path.parent_path() / (stem + "-" + std::to_string(number++) + ".toml");
  while (fs::exists(free, ignored));
  return free.string();
}

}  // namespace

std::vector<std::string> save_scene(const io::Scene& scene, const Parameters& now, const std::string& path,
                                    bool replace) {
  require_writable_file("save", path, host::FileKind::any, "");
  std::error_code ignored;
  if (!replace && fs::exists(path, ignored)) throw io::InputError(say(ww::k_exists, path));
  const io::SavedScene saved = io::edited_scene(scene, now);
  std::vector<fs::path> written;
  try {
    for (const io::SceneFile& file : scene.files)
      if (put_beside(file, path)) written.push_back(fs::path(path).parent_path() / file.name);
    write_whole_file(path, host::FileKind::any, saved.text);
  } catch (const std::runtime_error&) {
    for (const fs::path& file : written) fs::remove(file, ignored);
    throw;
  }
  return saved.given_up;
}

void SaveDialog::open(const io::Scene& scene) {
  open_ = appeared_ = true;
  ++opened_;
  exists_.clear();
  refused_.clear();
  std::error_code ignored;
  const std::string text = free_path(saved_name_ == scene.name && !saved_.empty()
                                         ? fs::path(saved_)
                                         : fs::current_path(ignored) / (scene.name + ".toml"));
  text.copy(path, sizeof path - 1);
  path[std::min(text.size(), sizeof path - 1)] = '\0';
}

void SaveDialog::press(const render::KeyPress& press) {
  enter_ = enter_ || press.key == render::key::enter || press.key == render::key::enter_of_pad;
}

std::string SaveDialog::draw(const io::Scene& scene, const Parameters& now, const Box& window,
                             const render::OverlayFonts& fonts) {
  begin_panel_over("save", window, 640, 0.46f, say(ww::k_save_scene), fonts);
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", say(ww::k_save_scene_about).c_str());
  ImGui::PopTextWrapPos();
  if (std::exchange(appeared_, false)) ImGui::SetKeyboardFocusHere();
  if (draw_path_field(path, files_, {true, say(ww::k_save_scene), path, {".toml"}}, opened_)) {
    exists_.clear();
    refused_.clear();
  }
  if (exists_ != path) exists_.clear();
  if (!exists_.empty() || !refused_.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(
        (exists_.empty() ? say(ww::k_not_written, refused_) : say(ww::k_exists, exists_)).c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::Dummy({0, 4});
  const bool ask = !exists_.empty();
  const bool save = button_at_right(say(ask ? ww::k_replace : ww::k_save_now), 1);
  const bool enter = std::exchange(enter_, false);
  const bool cancel = button_at_right(say(ww::k_cancel), 0);
  end_panel_over();
  if (cancel) open_ = false;
  if (!save && (!enter || ask)) return "";  // replacing takes the button
  std::error_code ignored;
  if (!ask && fs::exists(path, ignored) && !fs::is_directory(path, ignored)) {
    exists_ = path;
    return "";
  }
  try {
    const std::vector<std::string> given_up = save_scene(scene, now, path, ask);
    open_ = false;
    const std::string full = fs::absolute(path, ignored).string();
    saved_ = full;
    saved_name_ = scene.name;
    if (given_up.empty()) return say(ww::k_written, full);
    std::string keys;
    for (const std::string& key : given_up) keys += (keys.empty() ? "" : ", ") + key;
    return say(ww::k_given_up, full, keys);
  } catch (const std::exception& error) {
    refused_ = error.what();
    exists_.clear();
  }
  return "";
}

}  // namespace topple::app
