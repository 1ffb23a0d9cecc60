// Furnishing the room of what is open, and running it.
#include <fmt/format.h>
#include <imgui.h>

#include <filesystem>

#include "app/furnish/room_edits.h"
#include "app/panels/shell_words.h"
#include "app/picture/furnish_words.h"
#include "app/window/shell.h"
#include "solver/io/edit/scene_save.h"

namespace topple::app {
namespace {

namespace fw = furnish_words;
namespace fs = std::filesystem;

constexpr const char* k_room_file = "my-room.toml";

}  // namespace

/// The scene that is open with the sliders as they are.
std::string Shell::text_of_session() const {
  try {
    return io::edited_scene(session_->scene(), session_->player().parameters()).text;
  } catch (const io::InputError&) {  // no scene can state them
    return session_->scene().text;
  }
}

void Shell::furnish() {
  if (!session_) return chooser_.open();
  if (furnishing_) {
    furnishing_ = false;
    return session_->viewer().redraw();
  }
  if (session_->scene().setup.run.analysis != Analysis::dynamic) {
    session_->viewer().show_message(say(fw::k_only_shaken));
    return;
  }
  session_->player().pause();
  try {
    const std::string text = text_of_session();
    if (room_ && shaken_ == &session_->scene()) {
      room_->change([text](const io::Scene&) { return text; });
      room_->redraw();
    } else {
      io::Scene scene = session_->scene();
      scene.text = text;
      const std::string& source = session_->source();
      room_ = std::make_unique<FurnishView>(stage_, scene,
                                            source.ends_with(".toml") ? source : scene.name + ".toml",
                                            session_->viewer().orbit());
    }
    before_ = &session_->scene();
    furnishing_ = true;
  } catch (const io::InputError& error) {
    session_->viewer().show_message(say(window_words::k_refused, error.what()));
  }
}

/// What was furnished and not saved is not lost: it stands among the recent files.
void Shell::keep_room() {
  if (!room_ || !room_->room().can_undo() || room_->room().text() == kept_room_) return;
  const std::string folder = state_folder();
  if (folder.empty()) return;
  std::error_code ignored;
  fs::path path;
  int number = 1;
  do path = fs::path(folder) / fmt::format("{}-unsaved-{}.toml", room_->room().scene().name, number++);
  while (fs::exists(path, ignored));
  try {
    const io::Scene scene = room_->room().loader()();
    save_scene(scene, scene.setup.parameters, path.string(), false);
    remember_recent(path.string());
    kept_room_ = room_->room().text();
  } catch (const std::runtime_error&) {  // a full disk does not keep anybody from leaving
  }
}

void Shell::furnish_new_room() {
  keep_room();
  chooser_.close();
  if (session_) session_->player().pause();
  const io::Scene scene = io::parse_scene(new_room(), k_room_file);
  room_ = std::make_unique<FurnishView>(stage_, scene, k_room_file);
  before_ = shaken_ = nullptr;
  furnishing_ = true;
}

void Shell::shake_room() {
  if (!furnishing_ || opening_) return;
  open_in_background(room_->room().scene().name, "",
                     [load = room_->room().loader()] { return open_room(load()); });
  shaking_ = true;
}

float Shell::interface_scale() const {
  if (session_) return session_->viewer().scale();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return scale_ * static_cast<float>(fitting(appearance_, scale_, size.x, size.y).scale);
}

void Shell::press_in_room(const render::KeyPress& press) {
  if (room_->press(press)) return;
  if (press.control) {
    if (session_) session_->viewer().press(press);  // letters and theme
  } else if (press.key == ' ') {
    ask(ShellRequest::shake);
  } else if (press.key == render::key::f2) {
    ask(ShellRequest::furnish);
  }
}

void Shell::build_room() {
  if (covered() || !exports_.empty())
    room_->build(
        fonts(), interface_scale(), [this] { build_over(); }, covered());
  else
    room_->build(fonts(), interface_scale());
  if (!covered()) ask(room_->asked());
}

}  // namespace topple::app
