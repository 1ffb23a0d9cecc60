// Choosing a file: in a dialog of the desktop where it has one, else in a list of the window's own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/panels/panels.h"
#include "app/window/desktop.h"
#include "render/gl/key_press.h"
#include "render/scene/font.h"

namespace topple::app {

class FileDialog {
 public:
  /// Asks; `then` takes the path, unless the person chooses none or something else is asked before.
  void ask(FileQuestion question, std::function<void(const std::string&)> then);
  /// Takes in what was answered. True when anything changed.
  bool update();
  /// A dialog of the desktop has not been answered yet.
  bool asks_desktop() const { return desktop_ != nullptr; }
  /// The own list is over the window.
  bool is_open() const { return open_; }
  void close() { open_ = false; }
  /// Of the own list: Enter takes what is named, Escape nothing.
  void press(const render::KeyPress& press);
  void draw(const Box& window, const render::OverlayFonts& fonts);

  char name[4096] = {};  ///< of the file within folder(), or a path
  const std::string& folder() const { return folder_; }
  /// What the list shows: folders, which end with a slash, then files.
  const std::vector<std::string>& entries() const { return entries_; }

 private:
  void enter_folder(const std::string& folder);
  void accept();
  void draw_entries(float height);

  FileQuestion question_;
  std::function<void(const std::string&)> then_;
  std::unique_ptr<DesktopDialog> desktop_;
  bool open_ = false, enter_ = false;
  std::string folder_, problem_;
  std::vector<std::string> entries_;
};

/// A field for a path with a button that chooses it. True when it was changed. A field that is known already
/// comes back without its text selected: `opened` counts how often.
bool draw_path_field(char (&path)[4096], FileDialog& files, const FileQuestion& question, int opened = 0);

}  // namespace topple::app
