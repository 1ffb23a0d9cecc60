// "Export…": a picture, a video or tables of what the window shows.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "app/window/export_job.h"
#include "app/window/viewer.h"

namespace topple::app {

class ExportDialog {
 public:
  /// `program`: the one that draws; tests are not.
  explicit ExportDialog(std::string program = "/proc/self/exe") : program_(std::move(program)) {}

  void open(const Player& player);
  void close() { open_ = false; }  ///< a job goes on
  bool is_open() const { return open_; }
  /// Takes in how far a job is. True when anything changed.
  bool update();
  /// `recording`: of what is shown; empty: none.
  void draw(const Player& player, const Viewer& viewer, const std::string& recording, const Box& window,
            const render::OverlayFonts& fonts);
  /// Progress of a job while the dialog is closed, over the lower right corner of `scene`.
  void draw_progress(const Box& scene, const render::OverlayFonts& fonts);
  /// What became of a job since the last call; empty: nothing.
  std::string take_news();

  enum class What { picture, video, tables };
  What what = What::picture;
  char path[4096] = {};
  int size[2] = {1920, 1080};
  double from = 0, to = 0;  ///< s; of a static run parts of its way
  int rate = 30;            ///< pictures a second
  double speed = 1;         ///< simulated seconds per second of a video

  /// Begins; what is wrong is in refused().
  void start(const Player& player, const Viewer& viewer, const std::string& recording);
  const std::string& refused() const { return refused_; }
  bool busy() const { return request_ || job_; }
  ExportJob* job() { return job_ ? &*job_ : nullptr; }

 private:
  void suggest_path(const Player& player);
  void begin_job();
  void draw_choices(const Player& player);
  void draw_job();

  const std::string program_;
  bool open_ = false;
  /// What becomes a job as soon as all that is shown has been recorded.
  struct Request {
    std::vector<std::string> words;
    std::string result;
    ExportJob::Makes makes;
    std::chrono::steady_clock::time_point due;
  };
  std::optional<Request> request_;
  std::optional<ExportJob> job_;
  std::string refused_, news_;
};

}  // namespace topple::app
