// What is open in the window: a run or a recording, its player and its viewer.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/live/live_run.h"
#include "app/live/player.h"
#include "app/window/viewer.h"

namespace topple::app {

class Session {
 public:
  /// `opened`: the file that it came from; empty: a built-in scene. `wake` as of LiveRun.
  Session(LiveSource source, std::string opened, render::Stage& stage, float scale,
          const PictureSettings& settings, const Appearance& appearance, Viewer::Keep keep,
          std::function<void()> wake)
      : scene_(source.scene),
        source_(opened.empty() ? scene_->name : opened),
        replayed_(source.recording ? std::move(opened) : std::string()),
        run_(std::make_unique<LiveRun>(std::move(source), std::move(wake))),
        player_(scene_, *run_),
        viewer_(player_, stage, scale, render::NamedView::iso, settings, appearance, std::move(keep)) {}

  Player& player() { return player_; }
  Viewer& viewer() { return viewer_; }
  const io::Scene& scene() const { return *scene_; }
  const std::shared_ptr<const io::Scene>& scene_ptr() const { return scene_; }
  /// What opens it anew: a file or the name of a built-in scene.
  const std::string& source() const { return source_; }
  /// The file that holds what is shown; empty: none.
  std::string recording() const {
    const std::string& written = player_.status().recording;
    return written.empty() ? replayed_ : written;
  }
  /// Ends the session: only the run is left, to be closed.
  static std::unique_ptr<LiveRun> leave(std::unique_ptr<Session> session) { return std::move(session->run_); }

 private:
  const std::shared_ptr<const io::Scene> scene_;
  const std::string source_, replayed_;
  std::unique_ptr<LiveRun> run_;
  Player player_;
  Viewer viewer_;
};

}  // namespace topple::app
