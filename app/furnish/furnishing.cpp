#include "app/furnish/furnishing.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_file.h"

namespace topple::app {
namespace {

/// Bodies that bend cost tenths of a second to read, and stand where rigid ones do.
std::vector<std::string> as_rigid(const std::string& text, const std::string& origin) {
  std::vector<std::string> overrides;
  const io::Node root = io::parse_toml(text, origin);
  if (const io::Node* const run = root.find("run"); run && run->find("integrator")) return overrides;
  for (const char* const table : {"furniture", "cabinet"}) {
    const io::Node* const list = root.find(table);
    if (!list || list->kind != io::Node::Kind::list) continue;
    for (std::size_t k = 0; k < list->items.size(); ++k) {
      const io::Node& entry = list->items[k].value;
      if (entry.kind == io::Node::Kind::table && !entry.find("model") && !entry.find("restitution") &&
          !entry.find("damping"))
        overrides.push_back(std::string(table) + "." + std::to_string(k + 1) + ".model=\"rigid\"");
    }
  }
  return overrides;
}

}  // namespace

Furnishing::Furnishing(const io::Scene& scene, std::string origin)
    : origin_(std::move(origin)), files_(scene.files) {
  show(read(scene.text));
  texts_.push_back(scene.text);
}

std::string Furnishing::words_of(const io::InputError& error) const {
  const auto* const placed = dynamic_cast<const io::SceneError*>(&error);
  if (!placed || !std::string(error.what()).starts_with(origin_ + ":")) return error.what();
  return placed->path.empty() ? placed->message : placed->path + ": " + placed->message;
}

Furnishing::ScenePtr Furnishing::read(const std::string& text) const {
  const io::ReadSceneFile files = [kept = files_,
                                   beside = io::files_beside(origin_)](const std::string& name) {
    const auto file = std::ranges::find(kept, name, &io::SceneFile::name);
    return file != kept.end() ? file->bytes : beside(name);
  };
  const auto parse = [&](const std::vector<std::string>& overrides) {
    io::Scene scene = io::parse_scene(text, origin_, overrides, files);
    scene.text = text;
    return std::make_shared<const io::Scene>(std::move(scene));
  };
  const std::vector<std::string> rigid = as_rigid(text, origin_);
  try {
    return parse(rigid);
  } catch (const io::InputError&) {
    return parse({});  // whatever is wrong is told of the room itself
  }
}

std::function<io::Scene()> Furnishing::loader() const {
  return [text = text(), origin = origin_, files = scene_->files] {
    return io::parse_scene(text, origin, {}, [&files](const std::string& name) {
      const auto file = std::ranges::find(files, name, &io::SceneFile::name);
      return file != files.end() ? file->bytes : io::builtin_files()(name);
    });
  };
}

void Furnishing::show(ScenePtr scene) {
  pieces_ = pieces_of(*scene);
  scene_ = std::move(scene);
}

const RoomPiece* Furnishing::piece(const std::string& name) const {
  const auto found = std::ranges::find(pieces_, name, &RoomPiece::name);
  return found == pieces_.end() ? nullptr : &*found;
}

bool Furnishing::change(const RoomEdit& edit) {
  try {
    std::string text = edit(*scene_);
    if (text != scene_->text) {
      show(read(text));
      texts_.resize(at_ + 1);
      texts_.push_back(std::move(text));
      ++at_;
    }
    refused_.clear();
    return true;
  } catch (const io::InputError& error) {
    refused_ = words_of(error);
  }
  return false;
}

std::string Furnishing::objection(const RoomEdit& edit) const {
  try {
    read(edit(*scene_));
  } catch (const io::InputError& error) {
    return words_of(error);
  }
  return "";
}

void Furnishing::ask(RoomEdit edit) {
  next_ = std::move(edit);
  update();
}

void Furnishing::forget_question() {
  next_.reset();
  answer_.reset();
  wanted_ = false;
}

bool Furnishing::update() {
  bool news = false;
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    std::string words = running_.get();
    if (wanted_) {
      answer_ = std::move(words);
      news = true;
    }
  }
  if (next_) {
    wanted_ = true;
    running_ = std::async(std::launch::async, [this, scene = scene_, edit = *std::exchange(next_, {})] {
      try {
        read(edit(*scene));
      } catch (const io::InputError& error) {
        return words_of(error);
      }
      return std::string();
    });
  }
  return news;
}

void Furnishing::go_to(std::size_t at) {
  try {
    show(read(texts_[at]));
    at_ = at;
    refused_.clear();
  } catch (const io::InputError& error) {  // a file that it names is gone
    refused_ = words_of(error);
  }
}

void Furnishing::undo() {
  if (can_undo()) go_to(at_ - 1);
}

void Furnishing::redo() {
  if (can_redo()) go_to(at_ + 1);
}

}  // namespace topple::app
