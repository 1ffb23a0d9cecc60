// "Save scene as…".
#pragma once

#include <string>
#include <vector>

#include "app/panels/panels.h"
#include "app/window/file_dialog.h"
#include "render/gl/key_press.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Writes `scene`, with the values that `now` has where they can be edited, as a scene file that loads, and
/// beside it the files that it names, unless they are there. An existing scene is replaced only if `replace`;
/// any other existing file never. Returns the edit keys whose values no scene can state together with the
/// others. Throws std::runtime_error with one line; then `path` is as it was.
std::vector<std::string> save_scene(const io::Scene& scene, const Parameters& now, const std::string& path,
                                    bool replace);

/// Asks where to.
class SaveDialog {
 public:
  explicit SaveDialog(FileDialog& files) : files_(files) {}

  /// Proposes a path where no file is, beside where the scene was saved last.
  void open(const io::Scene& scene);
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// Enter saves.
  void press(const render::KeyPress& press);
  /// Returns a message when it has saved; then it is closed.
  std::string draw(const io::Scene& scene, const Parameters& now, const Box& window,
                   const render::OverlayFonts& fonts);

  char path[4096] = {};

  /// Why it was not written; empty: nothing was refused.
  const std::string& refused() const { return refused_; }

 private:
  FileDialog& files_;
  bool open_ = false, appeared_ = false, enter_ = false;
  int opened_ = 0;                  ///< times
  std::string exists_;              ///< the path that is there already, about which it asks
  std::string refused_;             ///< why it is not written
  std::string saved_, saved_name_;  ///< where it saved last, and the name of that scene
};

}  // namespace topple::app
