// "Export…": a picture, a video or tables of what the window shows.
#pragma once

#include <string>

#include "app/window/exports.h"
#include "app/window/file_dialog.h"
#include "app/window/viewer.h"

namespace topple::app {

class ExportDialog {
 public:
  ExportDialog(Exports& exports, FileDialog& files) : exports_(exports), files_(files) {}

  void open(const Player& player);
  void close();
  bool is_open() const { return open_; }
  /// `recording`: of what is shown; empty: none.
  void draw(const Player& player, const Viewer& viewer, const std::string& recording, const Box& window,
            const render::OverlayFonts& fonts);

  enum class What { picture, video, tables };
  What what = What::picture;
  char path[4096] = {};
  int size[2] = {1920, 1080};
  double from = 0, to = 0;  ///< s; of a static run parts of its way
  int rate = 30;            ///< pictures a second
  double speed = 1;         ///< simulated seconds per second of a video

  /// Begins it and closes; what is wrong is in refused().
  void start(const Player& player, const Viewer& viewer, const std::string& recording);
  const std::string& refused() const { return refused_; }

 private:
  void suggest_path(const Player& player);
  void draw_choices(const Player& player);
  void draw_path();
  void draw_notes(const Player& player, const Viewer& viewer);
  void require_drawable() const;

  Exports& exports_;
  FileDialog& files_;
  bool open_ = false;
  double last_ = 0;  ///< s, to which there was something to export
  std::string refused_;
};

}  // namespace topple::app
