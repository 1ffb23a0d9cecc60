// Where a person chooses what to open.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/panels/panels.h"
#include "app/window/thumbnails.h"
#include "render/gl/key_press.h"
#include "render/scene/font.h"

namespace topple::app {

/// Built-in scenes with a picture and a line each, and files that were opened last; arrows, Enter, the mouse
/// and typing choose.
class Chooser {
 public:
  Chooser(render::Stage& stage, std::function<void()> wake);

  /// Shows itself from the next frame on.
  void open();
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// True when there is something new to draw.
  bool update() { return thumbnails_.update(); }
  /// Arrows and Enter.
  void press(const render::KeyPress& press);
  /// Draws it, filling `box`.
  void draw(const Box& box, const render::OverlayFonts& fonts);
  /// What was chosen since the last call: the name of a scene or a path.
  std::optional<std::string> take_choice();
  /// A new room was asked for since the last call.
  bool take_new_room() { return std::exchange(new_room_, false); }

  /// A file from elsewhere was asked for since the last call.
  bool take_browse() { return std::exchange(browse_, false); }

  /// Names that the filter lets through: files first, then built-in scenes.
  std::vector<std::string> shown() const;
  /// The one that Enter opens; empty: none.
  std::string selected() const;

 private:
  struct Entry {
    std::string source, title;
    bool missing = false;
  };
  void filter();
  void choose(const Entry& entry);
  void draw_recent(const render::OverlayFonts& fonts);
  void draw_scenes(const render::OverlayFonts& fonts);
  void draw_card(const Entry& entry, bool selected, float width, const render::OverlayFonts& fonts);

  Thumbnails thumbnails_;
  std::vector<Entry> scenes_, recent_;              ///< all
  std::vector<Entry> shown_scenes_, shown_recent_;  ///< what the filter lets through
  char filter_[64] = {};
  std::string filtered_by_;
  bool open_ = false, appeared_ = false, scroll_to_selected_ = false;
  bool in_recent_ = false;  ///< where the selection is
  int selected_ = 0, columns_ = 1;
  std::optional<std::string> choice_;
  bool new_room_ = false, browse_ = false;
};

}  // namespace topple::app
