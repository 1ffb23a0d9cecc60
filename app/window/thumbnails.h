// Small pictures of the built-in scenes, drawn when they are wanted first and kept in the user's cache.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render/output/stage.h"

namespace topple::app {

inline constexpr int k_thumbnail_width = 320, k_thumbnail_height = 200;  // px

/// A thread steps the scenes until something happens in them; pictures are drawn between two frames.
class Thumbnails {
 public:
  /// `wake` is called from the thread when there is something to draw. The stage must outlive this.
  Thumbnails(render::Stage& stage, std::function<void()> wake);
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// Starts the thread, the first time.
  void want();
  /// Takes in one picture at most. True when there is a new one.
  bool update();
  /// An ImTextureID; null: not there yet.
  void* of(const std::string& scene) const;

 private:
  struct Shared;
  static void work(const std::shared_ptr<Shared>& shared);

  render::Stage& stage_;
  std::shared_ptr<Shared> shared_;  ///< with the thread, which may outlive this by a step
  std::map<std::string, void*> textures_;
  bool started_ = false;
};

}  // namespace topple::app
