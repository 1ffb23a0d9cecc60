#include "app/picture/ghost_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/picture/bridge.h"
#include "app/picture/drawing_processes.h"
#include "app/picture/image_files.h"
#include "app/picture/words.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "render/gl/off_screen.h"
#include "render/output/picture.h"

namespace topple::app {
namespace {

constexpr int k_width = 1280, k_height = 720, k_frame_rate = 30;
constexpr std::size_t k_lines = 4;  // bodies that are spoken of
/// Right of the words and above the trace.
constexpr render::Room k_room{-0.36f, 0.95f, -0.8f, 0.9f};
constexpr render::Float4 k_run_blue = {0.13f, 0.36f, 0.65f, 1};

/// One motion as frames that stand still where the floor is.
class Actor {
 public:
  explicit Actor(const NamedReplay& replay)
      : replay_(replay), extent_(extent_of_all()), bridge_(replay_.scene, extent_) {}

  double first() const { return replay_.replay.first(); }
  double last() const { return replay_.replay.last(); }
  io::FrameRow row(double time) const {
    return from_floor(replay_.replay.at(std::clamp(time, first(), last())));
  }
  render::SceneFrame frame(const io::FrameRow& row) const {
    return bridge_.frame(row, replay_.replay.parameters(replay_.scene, row));
  }
  const NamedReplay& replay() const { return replay_; }

 private:
  static io::FrameRow from_floor(io::FrameRow row) {
    std::ranges::fill(row.floor_displacement, 0.);
    return row;
  }
  RunExtent extent_of_all() const {
    RunExtent extent;
    for (std::int64_t i = 0; i < replay_.replay.frame_count() && !interrupted(); ++i)
      extent.add(replay_.scene.setup, replay_.scene.setup.parameters, from_floor(replay_.replay.frame(i)));
    return extent;
  }

  const NamedReplay& replay_;
  const RunExtent extent_;
  const Bridge bridge_;
};

bool is_furniture(const Actor& of, const render::Tube& tube) {
  const Model& model = of.replay().scene.setup.model;
  return tube.member < model.members.size() &&  // else of an anchor
         !model.bodies[static_cast<std::size_t>(model.members[tube.member].body)].ground;
}

void add_ghost(const Actor& of, const render::SceneFrame& ghost, render::SceneFrame& out) {
  const auto profiles = static_cast<std::uint32_t>(out.profiles.size());
  out.profiles.insert(out.profiles.end(), ghost.profiles.begin(), ghost.profiles.end());
  out.ghost_stations = ghost.stations;
  for (render::Tube tube : ghost.tubes) {
    if (!is_furniture(of, tube)) continue;
    tube.profile += profiles;
    tube.colour = {};
    out.ghost_tubes.push_back(tube);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    out.bounds_min[k] = std::min(out.bounds_min[k], ghost.bounds_min[k]);
    out.bounds_max[k] = std::max(out.bounds_max[k], ghost.bounds_max[k]);
  }
}

std::vector<std::string> words(const char* letter, const Actor& actor, const io::FrameRow& row, double time) {
  const Setup& setup = actor.replay().scene.setup;
  const std::string ended = time > actor.last() ? fmt::format(" (ended at {:.2f} s)", actor.last()) : "";
  std::vector<std::string> lines;
  for (std::size_t b = 0; b < std::min(static_cast<std::size_t>(setup.model.furniture_total()), k_lines); ++b)
    lines.push_back(
        fmt::format("{}  {}{}", letter, body_in_words(setup.model, setup.parameters.gravity, row, b), ended));
  return lines;
}

render::SceneFrame frame_of_both(const Actor& a, const Actor& b, double time) {
  const io::FrameRow row_a = a.row(time), row_b = b.row(time);
  render::SceneFrame frame = a.frame(row_a);
  for (render::Tube& tube : frame.tubes)
    if (is_furniture(a, tube)) tube.colour = k_run_blue;
  frame.rings.clear();                          // of A alone
  frame.legend.maximum = frame.legend.minimum;  // no colour stands for a stress here
  add_ghost(b, b.frame(row_b), frame);
  frame.trace.label = "floor acceleration of A, gal";
  frame.trace.cursor = static_cast<float>(time);
  frame.caption.title = fmt::format("t = {:.2f} s, seen from the floor", time);
  frame.caption.lines = {"A, solid and blue: " + a.replay().name,
                         "B, translucent and grey: " + b.replay().name};
  const auto of_a = words("A", a, row_a, time), of_b = words("B", b, row_b, time);
  for (std::size_t i = 0; i < std::max(of_a.size(), of_b.size()); ++i)
    for (const auto* lines : {&of_a, &of_b})
      if (i < lines->size()) frame.caption.lines.push_back((*lines)[i]);
  frame.caption.note = fmt::format("topple {} · deformation ×1", TOPPLE_VERSION);
  return frame;
}

}  // namespace

int draw_ghost_video(const host::Target& target, const NamedReplay& of_a, const NamedReplay& of_b,
                     std::optional<double> from, std::optional<double> to, bool quiet) {
  const Actor a(of_a), b(of_b);
  const double begin = std::min(a.first(), b.first()), end = std::max(a.last(), b.last());
  const double first = std::max(from.value_or(begin), begin), last = std::min(to.value_or(end), end);
  if (first > last)
    throw BadInput(
        fmt::format("--from, --to: nothing lies between {:g} and {:g} s; the motions have {:g}..{:g} s",
                    from.value_or(begin), to.value_or(end), begin, end));
  try {
    VideoWriter video(target, k_width, k_height, k_frame_rate);
    const int count = static_cast<int>(std::floor((last - first) * k_frame_rate + 1e-6)) + 1;
    Progress progress("drawing", "pictures", count, quiet);
    const auto draw = [&](render::Picture& picture, int i) {
      const render::SceneFrame frame = frame_of_both(a, b, first + static_cast<double>(i) / k_frame_rate);
      const auto corner = [](const render::Float3& x) { return Eigen::Vector3f(x.data()); };
      return picture.draw(frame, render::fit_box(render::sight_axes(render::sight_of(render::NamedView::iso)),
                                                 corner(frame.bounds_min), corner(frame.bounds_max), k_room,
                                                 picture.aspect()));
    };
    draw_pictures(
        count,
        [&]() -> DrawPicture {
          struct Easel {
            std::unique_ptr<render::Context> context;
            render::Picture picture;
            explicit Easel(std::unique_ptr<render::Context> of)
                : context(std::move(of)), picture(context->get_proc(), k_width, k_height) {}
          };
          const auto easel = std::make_shared<Easel>(render::make_off_screen_context(render::Renderer::any));
          return [&draw, easel](int i) { return draw(easel->picture, i).rgba; };
        },
        [&](int i, std::vector<std::uint8_t> answer) {
          video.write({k_width, k_height, std::move(answer)});
          progress.update(i + 1);
        });
    if (!interrupted()) {
      video.finish();
      return k_done;
    }
  } catch (const std::runtime_error&) {
    // Ctrl+C on a terminal reaches ffmpeg as well: that its pipe broke is then no error.
    if (!interrupted()) throw;
  }
  log_message("interrupted; " + target.path.string() + " is not written");
  return k_interrupted;
}

}  // namespace topple::app
