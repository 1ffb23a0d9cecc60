#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/bridge.h"
#include "app/commands.h"
#include "app/files.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/recorded_run.h"
#include "render/osmesa_context.h"
#include "render/picture.h"
#include "render/video.h"
#include "solver/io/recording.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

/// A file that goes when its owner goes.
class TemporaryFile {
 public:
  TemporaryFile() : path_((fs::temp_directory_path() / "topple-XXXXXX").string()) {
    const int file = mkstemp(path_.data());
    if (file < 0) throw std::runtime_error(path_ + ": no temporary file can be created");
    close(file);
  }
  ~TemporaryFile() { unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Rows of a recording by time.
class Replay {
 public:
  explicit Replay(const io::Recording& recording) : recording_(recording) {}
  io::FrameRow at(double time) const {
    const std::vector<double>& times = recording_.times();
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const std::int64_t next = std::min<std::int64_t>(after - times.begin(), recording_.frame_count() - 1);
    const std::int64_t here = std::max<std::int64_t>(next - 1, 0);
    if (times[here] == time || here == next) return recording_.frame(here);
    return blend(recording_.frame(here), recording_.frame(next), time);
  }

 private:
  const io::Recording& recording_;
};

void check_outputs(const RenderOptions& o) {
  if (!o.png.empty()) {
    std::error_code error;
    fs::create_directories(o.png, error);
    if (error) throw BadInput(o.png + ": cannot be created: " + error.message());
    require_writable_folder(o.png, o.png);
  } else {
    const std::string& file = o.mp4.empty() ? o.still : o.mp4;
    require_writable_folder(fs::absolute(file).parent_path().string(), file);
  }
}

// Pictures of one recording, one after the other.
int draw(const RenderOptions& o, const io::Recording& recording, const io::Scene& scene) {
  if (recording.frame_count() == 0) throw BadInput(o.source + ": holds no frames");
  const double first = recording.times().front(), last = recording.times().back();
  RunExtent extent(scene.setup.model);
  for (std::int64_t i = 0; i < recording.frame_count(); ++i)
    extent.add(scene.setup.model, scene.setup.parameters, recording.frame(i));
  const Bridge bridge(scene, extent);
  const Replay replay(recording);
  const double at = o.at.value_or(first);
  const double from = std::max(o.from.value_or(first), first), to = std::min(o.to.value_or(last), last);
  const auto outside = [&](double t) { return t < first - 1e-9 || t > last + 1e-9; };
  if (!o.still.empty() && outside(at))
    throw BadInput(fmt::format("--at: {:g} s is outside the recording, {:g}..{:g} s", at, first, last));
  if (from > to)
    throw BadInput(fmt::format("--from, --to: nothing between; the recording has {:g}..{:g} s", first, last));

  const std::unique_ptr<render::Context> context = render::make_osmesa_context();
  render::Picture picture(context->get_proc(), o.width, o.height);
  const auto draw_at = [&](double time) {
    const render::SceneFrame frame = bridge.frame(replay.at(time));
    return picture.draw(frame, render::fit_camera(o.view, frame, picture.aspect()));
  };
  if (!o.still.empty()) {
    render::write_png(o.still, draw_at(at));
    return k_done;
  }
  std::optional<render::VideoWriter> video;
  if (!o.mp4.empty()) video.emplace(o.mp4, o.width, o.height, o.fps);
  const int count = static_cast<int>(std::floor((to - from) * o.fps + 1e-6)) + 1;
  Progress progress("drawing", "pictures", count, o.quiet);
  for (int i = 0; i < count; ++i) {
    if (interrupted()) {
      fmt::print(stderr, "topple: interrupted; {}\n",
                 video ? o.mp4 + " is not written" : fmt::format("{} pictures are in {}", i, o.png));
      return k_interrupted;
    }
    const render::Image image = draw_at(std::min(from + static_cast<double>(i) / o.fps, to));
    if (video)
      video->write(image);
    else
      render::write_png(fs::path(o.png) / fmt::format("frame-{:06}.png", i), image);
    progress.update(i + 1);
  }
  if (video) video->finish();
  return k_done;
}

}  // namespace

int render_command(const RenderOptions& options) {
  check_outputs(options);
  if (io::is_recording(options.source)) {
    if (!options.overrides.empty())
      throw BadInput("--set: " + options.source + " is a recording; only a scene can be changed");
    const io::Recording recording(options.source);
    return draw(options, recording, io::parse_scene(recording.scene_text(), recording.scene_name()));
  }
  const io::Scene scene = io::load_scene(options.source, options.overrides);
  const TemporaryFile file;
  const RecordedRun run = record(scene, file.path(), options.quiet);
  if (run.exit_code == k_interrupted) return k_interrupted;
  const int drawn = draw(options, io::Recording(file.path()), scene);
  return drawn == k_done ? run.exit_code : drawn;
}

int export_command(const ExportOptions& options) {
  const io::Recording recording(options.recording);
  io::export_csv(recording, options.csv);
  return k_done;
}

}  // namespace topple::app
