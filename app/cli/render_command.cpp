#include "app/cli/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "app/batch/recorded_run.h"
#include "app/panels/appearance.h"
#include "app/panels/subject.h"
#include "app/picture/bridge.h"
#include "app/picture/drawing_processes.h"
#include "app/picture/replay.h"
#include "app/picture/row.h"
#include "app/picture/window_words.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "app/support/terms.h"
#include "app/window/window_picture.h"
#include "render/gl/off_screen.h"
#include "render/output/picture.h"
#include "render/output/video.h"
#include "solver/io/recording/recording.h"
#include "solver/io/recording/rerun.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

/// Refuses what can be refused before anything runs. `last`: time of the last instant, s; of a static run its
/// part of the way.
void check_times(const RenderOptions& o, bool loads, double first, double last, const std::string& what) {
  constexpr double k_slack = 1e-6;  // times are sums of rounded steps
  const char *const seconds = loads ? "" : " s", *const unit = loads ? " of the way through the loads" : " s";
  if (o.at && (*o.at < first - k_slack || *o.at > last + k_slack))
    throw BadInput(
        fmt::format("--at: {:g}{} is outside {}, {:g}..{:g}{}", *o.at, seconds, what, first, last, unit));
  const double from = std::max(o.from.value_or(first), first), to = std::min(o.to.value_or(last), last);
  if (from > to + k_slack)
    throw BadInput(fmt::format("--from, --to: nothing lies between {:g} and {:g}{}; {} has {:g}..{:g}{}",
                               o.from.value_or(first), o.to.value_or(last), seconds, what, first, last,
                               unit));
}

void check_outputs(const RenderOptions& o) {
  if (o.png.empty()) {
    require_writable_file(o.mp4.empty() ? "--still" : "--mp4", o.mp4.empty() ? o.still : o.mp4, o.source);
    return;
  }
  std::error_code error;
  fs::create_directories(o.png, error);
  if (error) throw BadInput(o.png + ": cannot be created: " + error.message());
  require_writable_folder(o.png, o.png);
}

Subject subject_of(const char* option, const std::string& name, const Model& model) {
  try {
    return subject_named(model, name);
  } catch (const io::InputError& error) {
    throw BadInput(std::string(option) + ": " + error.what());
  }
}

std::optional<Subject> inspected_by(const RenderOptions& o, const Model& model) {
  if (o.inspect.empty()) return std::nullopt;
  return subject_of("--inspect", o.inspect, model);
}

std::optional<std::size_t> followed_by(const RenderOptions& o, const Model& model,
                                       const std::optional<Subject>& inspected) {
  if (!o.follow) return std::nullopt;
  if (model.bodies.empty()) throw BadInput("--camera: there is no body to follow");
  if (!o.follow->empty()) return body_of(model, subject_of("--camera", *o.follow, model));
  return inspected ? body_of(model, *inspected) : 0;
}

/// Draws one instant after the other.
class Drawing {
 public:
  Drawing(const RenderOptions& o, const Replay& replay, const io::Scene& scene,
          const std::optional<Subject>& inspected, const std::optional<std::size_t>& followed,
          render::Context& context)
      : options_(o),
        inspected_(inspected),
        followed_(followed),
        extent_(extent_of(replay, scene)),
        scene_(scene),
        bridge_(scene, extent_),
        replay_(replay),
        picture_(context.get_proc(), o.width, o.height, window_letters(&scene)) {
    if (followed_) start_ = centre_of(replay.frame(0), *followed_);
  }

  render::Image at(double time) {
    const io::FrameRow row = replay_.at(time);
    PictureSettings settings = options_.picture;
    if (inspected_ && inspected_->kind == Subject::Kind::member)
      settings.diagram = Diagram{inspected_->index, std::nullopt};
    render::SceneFrame frame = bridge_.frame(row, replay_.parameters(scene_, row), settings);
    if (inspected_) highlight(scene_.setup.model, *inspected_, frame);
    return picture_.draw(frame, camera(frame, row), {.map = options_.picture.map});
  }

 private:
  render::Camera camera(const render::SceneFrame& frame, const io::FrameRow& row) const {
    Eigen::Vector3f moved{0, 0, 0};
    if (followed_ && is_finite(row)) moved = centre_of(row, *followed_) - start_;
    if (!options_.orbit)
      return render::carried(render::fit_camera(options_.view, frame, picture_.aspect()), moved);
    render::Orbit orbit = *options_.orbit;
    orbit.target += moved;
    orbit.set_bounds(frame);
    return orbit.camera(picture_.aspect());
  }

  const RenderOptions& options_;
  const std::optional<Subject> inspected_;
  const std::optional<std::size_t> followed_;  // body
  Eigen::Vector3f start_{0, 0, 0};             // where it was at first
  const RunExtent extent_;
  const io::Scene& scene_;
  const Bridge bridge_;
  const Replay& replay_;
  render::Picture picture_;
};

using DrawAt = std::function<render::Image(double time)>;
/// Called once in each process that draws.
using OpenDrawing = std::function<DrawAt()>;

int draw_still(const RenderOptions& o, const OpenDrawing& open) {
  if (interrupted()) return k_interrupted;
  render::write_png(o.still, open()(*o.at));
  return k_done;
}

std::string picture_name(int number) {
  return fmt::format("frame-{:06}.png", number);
}

/// Pictures from `from` to `to`, as files in a folder or as a video.
int draw_sequence(const RenderOptions& o, const OpenDrawing& open, double from, double to) {
  std::optional<render::VideoWriter> video;
  if (!o.mp4.empty()) video.emplace(o.mp4, o.width, o.height, o.fps);
  const int count = static_cast<int>(std::floor((to - from) * o.fps + 1e-6)) + 1;
  Progress progress("drawing", "pictures", count, o.quiet);
  draw_pictures(
      count,
      [&]() -> DrawPicture {
        return [&, draw_at = open()](int i) -> std::vector<std::uint8_t> {
          render::Image image = draw_at(std::min(from + static_cast<double>(i) / o.fps, to));
          if (video) return std::move(image.rgba);
          render::write_png(fs::path(o.png) / picture_name(i), image);
          return {};
        };
      },
      [&](int i, std::vector<std::uint8_t> answer) {
        if (video) video->write({o.width, o.height, std::move(answer)});
        progress.update(i + 1);
      });
  if (video && !interrupted()) video->finish();
  if (!video && fs::exists(fs::path(o.png) / picture_name(count)))
    say(fmt::format("warning: {} also holds pictures of an earlier, longer sequence, from {} on", o.png,
                    picture_name(count)));
  return interrupted() ? k_interrupted : k_done;
}

int draw(const RenderOptions& o, const std::string& path, std::shared_ptr<const io::Scene> scene) {
  const io::Recording recording = scene ? io::Recording(path) : open_foreign_recording(path);
  if (!scene) scene = std::make_shared<const io::Scene>(io::recorded_scene(recording));
  io::check_edits(recording.history(), scene->setup);
  const Replay replay(recording);
  if (replay.frame_count() == 0) throw BadInput(o.source + ": holds no frames");
  const double first = replay.first(), last = replay.last();
  check_times(o, is_static(scene->setup), first, last, "the recording");
  defer_interrupts();
  check_outputs(o);
  const auto inspected = inspected_by(o, scene->setup.model);
  const auto followed = followed_by(o, scene->setup.model, inspected);
  int code = k_done;
  try {
    const OpenDrawing open = [&]() -> DrawAt {
      struct Easel {
        std::unique_ptr<render::Context> context;
        std::optional<Drawing> drawing;
        std::optional<WindowPicture> window;
      };
      const auto easel = std::make_shared<Easel>();
      easel->context = render::make_off_screen_context(o.renderer);
      if (o.ui)
        easel->window.emplace(*easel->context, scene, path, o.view, o.picture, inspected, followed, o.width,
                              o.height);
      else
        easel->drawing.emplace(o, replay, *scene, inspected, followed, *easel->context);
      return
          [easel](double time) { return easel->window ? easel->window->at(time) : easel->drawing->at(time); };
    };
    code = o.still.empty() ? draw_sequence(o, open, std::max(o.from.value_or(first), first),
                                           std::min(o.to.value_or(last), last))
                           : draw_still(o, open);
  } catch (const std::runtime_error&) {
    // Ctrl+C on a terminal reaches ffmpeg as well: that its pipe broke is then no error.
    if (!interrupted()) throw;
    code = k_interrupted;
  }
  if (code == k_interrupted)
    say("interrupted; " +
        (o.png.empty() ? o.still + o.mp4 + " is not written" : "the pictures drawn so far are in " + o.png));
  return code;
}

}  // namespace

int render_command(const RenderOptions& options) {
  window_language() = options.language;
  if (io::is_recording(options.source)) {
    if (!options.overrides.empty())
      throw BadInput("--set: " + options.source + " is a recording; only a scene can be changed");
    return draw(options, options.source, nullptr);
  }
  const auto scene = std::make_shared<const io::Scene>(io::load_scene(options.source, options.overrides));
  check_times(options, is_static(scene->setup), 0, scene->setup.run.duration, "the scene");
  followed_by(options, scene->setup.model, inspected_by(options, scene->setup.model));
  defer_interrupts();
  check_outputs(options);
  if (options.png.empty())
    require_no_record(options.mp4.empty() ? "--still" : "--mp4",
                      options.mp4.empty() ? options.still : options.mp4, options.source, *scene);
  const TemporaryFile file;
  const RecordedRun run = record(*scene, file.path(), {.quiet = options.quiet});
  if (!run.trouble.empty())
    say(run.trouble + (run.exit_code == k_failed && run.recorded ? "; drawing up to there" : ""));
  if (run.exit_code == k_interrupted || !run.recorded) return run.exit_code;
  try {
    const int drawn = draw(options, file.path(), scene);
    return drawn == k_done ? run.exit_code : drawn;
  } catch (const BadInput& error) {  // an instant that a failed run never reached
    if (run.exit_code == k_done) throw;
    say(error.what());
    return run.exit_code;
  }
}

}  // namespace topple::app
