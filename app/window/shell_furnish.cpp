// Furnishing the room of what is open, and running it.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <optional>

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

/// The place of a name in one list, in another; nothing: it has none there.
template <class Named>
std::optional<int> same_name(const std::vector<Named>& from, int index, const std::vector<Named>& to) {
  const auto same = std::ranges::find(to, from[static_cast<std::size_t>(index)].name, &Named::name);
  return same == to.end() ? std::nullopt : std::optional(static_cast<int>(same - to.begin()));
}

/// `room` with edits of a run of `ran`, as far as it has what they are of.
std::string with_edits(const io::Scene& room, const Model& ran, const std::vector<Edit>& edits) {
  const Model& model = room.setup.model;
  Parameters now = room.setup.parameters;
  for (Edit edit : edits) {
    std::optional<int> index = edit.index;
    const Edit::Of of = traits(edit.key).of;
    if (of == Edit::Of::node) continue;
    if (of == Edit::Of::body) index = same_name(ran.bodies, edit.index, model.bodies);
    if (of == Edit::Of::anchor) index = same_name(ran.anchors, edit.index, model.anchors);
    if (!index) continue;
    edit.index = *index;
    apply(edit, model, 0, now);
  }
  return io::edited_scene(room, now).text;
}

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
    const bool changed = before_ && room_->room().text() != ran_;
    session_->viewer().show_note(changed ? say(fw::k_run_before_changes) : "");
    return session_->viewer().redraw();
  }
  if (!room_ && session_->scene().setup.run.analysis != Analysis::dynamic) {
    session_->viewer().show_message(say(fw::k_only_shaken));
    return;
  }
  session_->player().pause();
  try {
    if (room_) {
      if (before_) take_sliders();
      room_->redraw();
    } else {
      io::Scene scene = session_->scene();
      scene.text = text_of_session();
      const std::string& source = session_->source();
      room_ = std::make_unique<FurnishView>(stage_, scene,
                                            source.ends_with(".toml") ? source : scene.name + ".toml",
                                            session_->viewer().orbit());
      before_ = &session_->scene();
      ran_ = room_->room().text();
      sliders_ = session_->player().parameters();
    }
    furnishing_ = true;
  } catch (const io::InputError& error) {
    session_->viewer().show_message(say(window_words::k_refused, error.what()));
  }
}

/// Sliders that were moved since the room was left belong to it.
void Shell::take_sliders() {
  const Player& player = session_->player();
  const std::vector<Edit> edits = player.edits_from(sliders_);
  if (edits.empty()) return;
  const bool as_it_ran = room_->room().text() == ran_;
  const auto with_sliders = [&](const io::Scene&) {
    return with_edits(room_->room().loader()(), session_->scene().setup.model, edits);
  };
  if (!room_->change(with_sliders)) return;
  sliders_ = player.parameters();
  if (as_it_ran) ran_ = room_->room().text();
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
