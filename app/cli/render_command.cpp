#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "app/batch/recorded_run.h"
#include "app/cli/command.h"
#include "app/panels/appearance.h"
#include "app/panels/subject.h"
#include "app/picture/bridge.h"
#include "app/picture/drawing_processes.h"
#include "app/picture/image_files.h"
#include "app/picture/picture_settings.h"
#include "app/picture/replay.h"
#include "app/picture/row.h"
#include "app/picture/solid_bodies.h"
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
#include "render/scene/camera.h"
#include "render/scene/orbit.h"
#include "solver/io/recording/recording.h"
#include "solver/io/recording/rerun.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

constexpr double k_slowest = 0.001, k_fastest = 1000;  // times real time
constexpr float k_farthest = 1e4;                      // of the camera, m or degrees

struct RenderOptions {
  std::string source;                  ///< scene or recording
  std::vector<std::string> overrides;  ///< of a scene
  std::string png, mp4, still;         ///< one of them
  std::optional<double> at;            ///< s, of the still
  int width = 1280, height = 720;
  int fps = 30;
  double speed = 1;  ///< simulated seconds per second of a sequence
  render::NamedView view = render::NamedView::iso;
  std::optional<render::Orbit> orbit;  ///< instead of `view`; only target, distance and sight are set
  std::optional<std::string> follow;   ///< body the camera follows; empty: of `inspect`, or first
  std::optional<double> from, to;      ///< s
  bool ui = false;                     ///< with the panels of the window
  Language language = Language::english;
  PictureSettings picture;   ///< all but `diagram`
  std::string inspect;       ///< BODY or BODY/MEMBER; empty: none
  std::optional<int> ghost;  ///< branch of a recording drawn beside the newest
  render::Renderer renderer = render::Renderer::any;
  bool quiet = false;
  bool force = false;  ///< in place of files of any kind
};

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
    if (o.mp4.empty())
      require_writable_file("--still", {o.still, o.force}, host::FileKind::png, o.source);
    else
      require_writable_file("--mp4", {o.mp4, o.force}, host::FileKind::mp4, o.source);
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
  /// ghost: null: none.
  Drawing(const RenderOptions& o, const Replay& replay, const Replay* ghost, const io::Scene& scene,
          const std::optional<Subject>& inspected, const std::optional<std::size_t>& followed,
          render::Context& context)
      : options_(o),
        inspected_(inspected),
        followed_(followed),
        extent_(extent_of(replay, scene)),
        scene_(scene),
        bridge_(scene, extent_),
        replay_(replay),
        ghost_(ghost),
        picture_(context.get_proc(), o.width, o.height, window_letters(&scene)) {
    if (traits(o.picture.bodies).boards) solid_.emplace(scene, o.picture.bodies);
    if (followed_) start_ = centre_of(replay.frame(0), *followed_);
  }

  render::Image at(double time) {
    const io::FrameRow row = replay_.at(time);
    PictureSettings settings = options_.picture;
    if (inspected_ && inspected_->kind == Subject::Kind::member)
      settings.diagram = Diagram{inspected_->index, std::nullopt};
    render::SceneFrame frame =
        bridge_.frame(row, replay_.parameters(scene_, row), settings, replay_.changed(scene_, row));
    if (solid_ && is_finite(row)) solid_->dress(row, frame);
    if (inspected_) highlight(scene_.setup.model, *inspected_, frame);
    if (ghost_ && time <= ghost_->last()) bridge_.add_ghost(ghost_->at(time), row, settings, frame);
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
  std::optional<SolidBodies> solid_;
  const Replay& replay_;
  const Replay* const ghost_;
  render::Picture picture_;
};

using DrawAt = std::function<render::Image(double time)>;
/// Called once in each process that draws.
using OpenDrawing = std::function<DrawAt()>;

int draw_still(const RenderOptions& o, const OpenDrawing& open) {
  if (interrupted()) return k_interrupted;
  write_png({o.still, o.force}, open()(*o.at));
  return k_done;
}

std::string picture_name(int number) {
  return fmt::format("frame-{:06}.png", number);
}

/// Pictures from `from` to `to`, as files in a folder or as a video.
int draw_sequence(const RenderOptions& o, const OpenDrawing& open, double from, double to) {
  std::optional<VideoWriter> video;
  if (!o.mp4.empty()) video.emplace(host::Target(o.mp4, o.force), o.width, o.height, o.fps);
  const double interval = o.speed / o.fps;
  const int count = static_cast<int>(std::floor((to - from) / interval + 1e-6)) + 1;
  for (int i = 0; !video && i < count; ++i)
    host::expect_replaceable({fs::path(o.png) / picture_name(i), o.force}, host::FileKind::png);
  Progress progress("drawing", "pictures", count, o.quiet);
  draw_pictures(
      count,
      [&]() -> DrawPicture {
        return [&, draw_at = open()](int i) -> std::vector<std::uint8_t> {
          render::Image image = draw_at(std::min(from + i * interval, to));
          if (video) return std::move(image.rgba);
          write_png({fs::path(o.png) / picture_name(i), o.force}, image);
          return {};
        };
      },
      [&](int i, std::vector<std::uint8_t> answer) {
        if (video) video->write({o.width, o.height, std::move(answer)});
        progress.update(i + 1);
      });
  if (video && !interrupted()) video->finish();
  if (!video && fs::exists(fs::path(o.png) / picture_name(count)))
    log_message(fmt::format("warning: {} also holds pictures of an earlier, longer sequence, from {} on",
                            o.png, picture_name(count)));
  return interrupted() ? k_interrupted : k_done;
}

/// Null: none is asked for, or it has no frames.
std::unique_ptr<const Replay> ghost_of(const RenderOptions& o, const io::Recording& recording) {
  if (!o.ghost) return nullptr;
  const auto& branches = recording.history().branches;
  if (std::ranges::find(branches, *o.ghost, &Branch::id) == branches.end())
    throw BadInput(fmt::format("--ghost: {} has no branch {}; its branches are 0..{}", o.source, *o.ghost,
                               branches.size() - 1));
  auto ghost = std::make_unique<const Replay>(recording, *o.ghost);
  return ghost->frame_count() > 0 ? std::move(ghost) : nullptr;
}

int draw(const RenderOptions& o, const std::string& path, std::shared_ptr<const io::Scene> scene) {
  const io::Recording recording = scene ? io::Recording(path) : open_foreign_recording(path);
  if (!scene) scene = std::make_shared<const io::Scene>(io::recorded_scene(recording));
  io::check_edits(recording.history(), scene->setup);
  const Replay replay(recording);
  if (replay.frame_count() == 0) throw BadInput(o.source + ": holds no frames");
  const std::unique_ptr<const Replay> ghost = ghost_of(o, recording);
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
        easel->drawing.emplace(o, replay, ghost.get(), *scene, inspected, followed, *easel->context);
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
    log_message("interrupted; " + (o.png.empty() ? o.still + o.mp4 + " is not written"
                                                 : "the pictures drawn so far are in " + o.png));
  return code;
}

int render_command(const RenderOptions& options) {
  if (!options.mp4.empty() && (options.width % 2 != 0 || options.height % 2 != 0))
    throw BadInput("--size: a video needs an even width and height");
  if (options.ui && options.orbit)
    throw BadInput("--camera: with --ui, one of front, side, top, iso, follow");
  if (options.ui && options.ghost)
    throw BadInput("--ghost: with --ui the window itself shows the branch that was left");
  window_language() = options.language;
  if (io::is_recording(options.source)) {
    if (!options.overrides.empty())
      throw BadInput("--set: " + options.source + " is a recording; only a scene can be changed");
    return draw(options, options.source, nullptr);
  }
  if (options.ghost)
    throw BadInput("--ghost: " + options.source + " is a scene; only a recording has branches");
  const auto scene = std::make_shared<const io::Scene>(io::load_scene(options.source, options.overrides));
  check_times(options, is_static(scene->setup), 0, scene->setup.run.duration, "the scene");
  followed_by(options, scene->setup.model, inspected_by(options, scene->setup.model));
  defer_interrupts();
  if (options.png.empty())
    require_no_record(options.mp4.empty() ? "--still" : "--mp4",
                      options.mp4.empty() ? options.still : options.mp4, options.source, *scene);
  check_outputs(options);
  const TemporaryFile file;
  const RecordedRun run = record(*scene, file.path(), {.quiet = options.quiet});
  if (!run.trouble.empty())
    log_message(run.trouble + (run.exit_code == k_failed && run.recorded ? "; drawing up to there" : ""));
  if (run.exit_code == k_interrupted || !run.recorded) return run.exit_code;
  try {
    const int drawn = draw(options, file.path(), scene);
    return drawn == k_done ? run.exit_code : drawn;
  } catch (const BadInput& error) {  // an instant that a failed run never reached
    if (run.exit_code == k_done) throw;
    log_message(error.what());
    return run.exit_code;
  }
}

Reader size_of(RenderOptions& options) {
  return [&options](const std::string& text) {
    const std::size_t cross = std::min(text.find('x'), text.size());
    const auto side = [](std::string_view digits) {
      const int value = number_in<int>(digits).value_or(0);
      return value >= k_least_picture && value <= k_most_picture ? value : 0;
    };
    options.width = side(std::string_view(text).substr(0, cross));
    options.height = side(std::string_view(text).substr(std::min(cross + 1, text.size())));
    if (options.width > 0 && options.height > 0) return std::string();
    return fmt::format("\"{}\" is not WIDTHxHEIGHT with {}..{} each", text, k_least_picture, k_most_picture);
  };
}

/// Into view, orbit and follow.
Reader camera_of(RenderOptions& options) {
  return [&options](const std::string& text) -> std::string {
    std::string camera = text;
    if (const std::size_t at = camera.find("follow");
        at == 0 || (at < camera.size() && camera[at - 1] == ',')) {
      const std::string body = camera.substr(at + std::strlen("follow"));
      if (body.empty() || (body.front() == ':' && body.size() > 1)) {
        options.follow = body.empty() ? "" : body.substr(1);
        camera = at == 0 ? "iso" : camera.substr(0, at - 1);
      }
    }
    if (const auto view = render::view_named(camera)) {
      options.view = *view;
      return "";
    }
    std::vector<float> numbers;
    for (std::size_t at = 0; at <= camera.size();) {
      const std::size_t end = std::min(camera.find(',', at), camera.size());
      const auto number = number_in<float>(std::string_view(camera).substr(at, end - at));
      numbers.push_back(number.value_or(std::numeric_limits<float>::quiet_NaN()));
      at = end + 1;
    }
    const bool good = numbers.size() == 6 &&
                      std::ranges::all_of(numbers, [](float x) { return std::abs(x) <= k_farthest; }) &&
                      std::abs(numbers[1]) <= 90 && numbers[2] > 0;
    if (!good)
      return "\"" + text +
             "\" is not one of front, side, top, iso, follow, nor AZIMUTH,ELEVATION,DISTANCE,X,Y,Z with an "
             "elevation of -90..90 and a distance above 0";
    constexpr float radians = std::numbers::pi_v<float> / 180;
    options.orbit = render::Orbit{.target = {numbers[3], numbers[4], numbers[5]},
                                  .distance = numbers[2],
                                  .sight = {numbers[0] * radians, numbers[1] * radians}};
    return "";
  };
}

Reader range_of(PictureSettings& picture) {
  return [&picture](const std::string& text) -> std::string {
    const auto number = number_in<double>(text);
    picture.range = text == "run"       ? RangePolicy::run
                    : text == "instant" ? RangePolicy::instant
                                        : RangePolicy::fixed;
    picture.maximum = number.value_or(1);
    const bool good = number && *number >= k_least_maximum && *number <= k_most_maximum;
    if (picture.range != RangePolicy::fixed || good) return "";
    return "\"" + text + "\" is not run, instant or a number from 1e-6 to 1e12";
  };
}

Reader number_from(double& value, double least, double most) {
  return [&value, least, most](const std::string& text) {
    value = number_in<double>(text).value_or(std::numeric_limits<double>::quiet_NaN());
    if (value >= least && value <= most) return std::string();
    return fmt::format("\"{}\" is not a number from {:g} to {:g}", text, least, most);
  };
}

void add_picture(CLI::App& command, RenderOptions& options) {
  PictureSettings& picture = options.picture;
  std::vector<std::pair<std::string, BeamQuantity>> quantities;
  std::vector<std::string_view> words;
  for (const BeamQuantityTraits& row : beam_quantities()) {
    quantities.emplace_back(row.word, row.kind);
    words.emplace_back(row.word);
  }
  add_choice(command, "--colour", "QUANTITY", picture.colour, quantities,
             fmt::format("what beams are coloured by, one of {}; default stress", fmt::join(words, ", ")));
  add_choice<render::ColourMap>(
      command, "--map", "NAME", picture.map,
      {{"viridis", render::ColourMap::viridis}, {"cividis", render::ColourMap::cividis}},
      "viridis (default) or cividis: colours of what has no sign");
  add_read(command, "--range", "RANGE", range_of(picture),
           "run (default), instant, or the greatest value in the legend's unit: where colours end");
  add_read(command, "--exaggerate", "FACTOR", number_from(picture.exaggeration, 1, k_most_exaggeration),
           "deformation drawn so many times as large, 1 to 200");
  command.add_flag("--forces", picture.contact_forces,
                   "arrows of what floors, walls and other bodies do to bodies");
  std::vector<std::pair<std::string, Bodies>> bodies;
  for (const BodiesTraits& row : k_bodies_traits) bodies.emplace_back(row.word, row.kind);
  add_choice(command, "--bodies", "HOW", picture.bodies, bodies,
             "beams (default), solid: furniture as it looks in a room, without stresses, or both");
  command.add_flag_callback(
      "--no-panels", [&picture] { picture.panels = false; }, "without the sheets of cabinets");
  command.add_flag_callback(
      "--no-words", [&picture] { picture.words = false; }, "without title, captions, legend and floor curve");
  add_choice<Trails>(command, "--trails", "SPAN", picture.trails,
                     {{"second", Trails::second}, {"run", Trails::run}},
                     "second or run: paths of centres of gravity and tops of bodies since then");
  add_read(command, "--ghost", "BRANCH", whole_number(options.ghost, 0, 1000000),
           "another branch of a recording as a ghost; 0 is the first");
  add_path(command, "--inspect", options.inspect, "BODY[/MEMBER]",
           "look closely at a body or member: forces along the member; all values with --ui");
}

}  // namespace

void add_render(Commands& commands) {
  const auto [command, options] =
      commands.add("render", "draw pictures or a video of a scene or recording",
                   "render paper-a --still tipping.png --at 2.3 --size 1920x1080", render_command);
  add_path(command, "SOURCE", options.source, "", "scene or recording").required();
  CLI::Option_group& what = *command.add_option_group("output", "what to write");
  add_path(what, "--png", options.png, "DIR", "folder for a sequence of PNG files");
  add_path(what, "--mp4", options.mp4, "FILE.mp4", "video (needs ffmpeg)");
  CLI::Option& still = add_path(what, "--still", options.still, "FILE.png", "one picture");
  still.each([&picture = options.picture](const std::string&) { picture.alone = true; });
  what.require_option(1);
  CLI::Option& at = add_read(command, "--at", "SECONDS", seconds(options.at),
                             "time of the still; statics: part of the way, 0..1");
  at.needs(&still);
  still.needs(&at);
  add_read(command, "--from", "SECONDS", seconds(options.from), "first instant");
  add_read(command, "--to", "SECONDS", seconds(options.to), "last instant");
  add_read(command, "--size", "WxH", size_of(options), "pixels, default 1280x720");
  add_read(command, "--fps", "RATE", whole_number(options.fps, 1, 1000), "pictures per second, default 30");
  add_read(command, "--speed", "FACTOR", number_from(options.speed, k_slowest, k_fastest),
           "simulated seconds per second, default 1: 0.25 is slow motion");
  add_read(command, "--camera", "NAME", camera_of(options),
           "front, side, top, iso (default) or follow: iso, going along with the body of --inspect "
           "or the first; "
           "or AZIMUTH,ELEVATION,DISTANCE,X,Y,Z: of the eye from the point looked at, in degrees "
           "and m; each "
           "may end in ,follow or ,follow:BODY");
  add_set(command, options.overrides);
  add_quiet(command, options.quiet);
  add_force(command, options.force);
  command.add_flag("--ui", options.ui, "with the panels of the window around the scene");
  add_language(command, options.language, "en (default) or ja");
  add_choice<render::Renderer>(command, "--renderer", "NAME", options.renderer,
                               {{"osmesa", render::Renderer::osmesa}, {"egl", render::Renderer::egl}},
                               "osmesa or egl, default osmesa, or egl where that is missing");
  add_picture(command, options);
}

}  // namespace topple::app
