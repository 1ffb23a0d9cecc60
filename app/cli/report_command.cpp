#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/batch/recorded_run.h"
#include "app/cli/command.h"
#include "app/page/export_page.h"
#include "app/picture/replay.h"
#include "app/picture/row.h"
#include "app/picture/solid_bodies.h"
#include "app/report/report.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "app/support/terms.h"
#include "render/gl/off_screen.h"
#include "render/output/picture.h"
#include "solver/study/common/anchors.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/parallel.h"

namespace topple::app {
namespace {

struct ReportOptions {
  std::string scene;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string file;                    ///< HTML; empty: NAME-report.html in the working folder
  Language language = Language::english;
  std::optional<int> jobs;  ///< runs at a time; absent: one per core
  bool with_page = false;
  bool quiet = false;
  bool force = false;  ///< in place of files of any kind
};

constexpr int k_trials = 21;
constexpr double k_spread = 0.05;             // of the input
constexpr double k_falling = 45;              // degrees, of the picture of a fall
constexpr int k_width = 960, k_height = 600;  // px
constexpr std::size_t k_labels = 8;           // more would hide the picture
constexpr render::Float4 k_plain = {0.30f, 0.42f, 0.55f, 1};

/// Of one body in a row (FrameRow::body), degrees.
double tilt_of(const io::FrameRow& row, std::size_t body) {
  return row.body[body].tilt * k_degrees;
}

std::vector<TiltCurve> tilt_curves(const Replay& replay, const nlohmann::ordered_json& bodies) {
  std::vector<TiltCurve> curves(bodies.size());
  for (std::int64_t i = 0; i < replay.frame_count(); ++i) {
    const io::FrameRow row = replay.frame(i);
    for (std::size_t b = 0; b < curves.size(); ++b) {
      curves[b].time.push_back(row.time);
      curves[b].tilt.push_back(tilt_of(row, b));
    }
  }
  for (std::size_t b = 0; b < curves.size(); ++b)
    if (const auto& angle = bodies[b]["critical_tilt_deg"]; !angle.is_null()) curves[b].critical = angle;
  return curves;
}

/// The key frames of the run, without their pictures.
std::vector<KeyPicture> key_instants(const Replay& replay, const std::vector<TiltCurve>& curves,
                                     const nlohmann::ordered_json& bodies) {
  std::vector<KeyPicture> list;
  const auto add = [&](KeyPicture::Kind kind, std::size_t body, std::size_t row) {
    list.push_back(
        {.kind = kind, .time = curves[body].time[row], .body = body, .tilt = curves[body].tilt[row]});
  };
  std::optional<std::size_t> first;
  std::size_t most = 0, most_row = 0;
  for (std::size_t b = 0; b < curves.size(); ++b) {
    if (bodies[b]["overturned"].get<bool>() &&
        (!first || bodies[b]["overturn_time_s"] < bodies[*first]["overturn_time_s"]))
      first = b;
    const auto greatest = std::ranges::max_element(curves[b].tilt);
    if (*greatest <= curves[most].tilt[most_row]) continue;
    most = b;
    most_row = static_cast<std::size_t>(greatest - curves[b].tilt.begin());
  }
  const std::size_t last = static_cast<std::size_t>(replay.frame_count()) - 1;
  add(KeyPicture::Kind::start, 0, 0);
  if (first) {
    const TiltCurve& curve = curves[*first];
    const double since = bodies[*first]["overturn_time_s"];
    for (std::size_t i = 0; i <= last; ++i)
      if (curve.time[i] >= since && (curve.tilt[i] >= k_falling || i == last)) {
        if (i < last) add(KeyPicture::Kind::falling, *first, i);
        break;
      }
  }
  if (most_row > 0 && most_row < last) add(KeyPicture::Kind::most_tilted, most, most_row);
  add(KeyPicture::Kind::end, 0, last);
  std::ranges::stable_sort(list, {}, &KeyPicture::time);
  return list;
}

/// Where bodies stand in a picture.
std::vector<KeyPicture::Label> labels_of(const io::FrameRow& row, const render::Camera& camera,
                                         std::size_t bodies) {
  std::vector<KeyPicture::Label> labels;
  for (std::size_t b = 0; b < bodies && bodies <= k_labels; ++b) {
    const Eigen::Vector4f clip = camera.projection * camera.view * centre_of(row, b).homogeneous();
    labels.push_back({b, 50 * (1 + clip.x() / clip.w()), 50 * (1 - clip.y() / clip.w())});
  }
  return labels;
}

/// Draws them without words, which the page has in its own language: furniture as it looks, beams in one
/// colour, as without a legend none says anything.
void draw(const io::Scene& scene, const Replay& replay, std::vector<KeyPicture>& pictures) {
  const RunExtent extent = extent_of(replay, scene);
  const Bridge bridge(scene, extent);
  PictureSettings settings;
  settings.bodies = usual_bodies(scene);
  std::optional<SolidBodies> solid;
  if (traits(settings.bodies).boards) solid.emplace(scene, settings.bodies);
  const std::unique_ptr<render::Context> context = render::make_off_screen_context(render::Renderer::any);
  render::Picture picture(context->get_proc(), k_width, k_height);
  for (KeyPicture& key : pictures) {
    const io::FrameRow row = replay.at(key.time);
    render::SceneFrame frame = bridge.frame(row, replay.parameters(scene, row), settings);
    if (solid && is_finite(row)) solid->dress(row, frame);
    for (render::Tube& tube : frame.tubes)
      if (tube.colour[3] == 0) tube.colour = k_plain;
    const render::Camera camera =
        render::fit_box(render::sight_axes(render::sight_of(render::NamedView::iso)),
                        Eigen::Vector3f(frame.bounds_min.data()), Eigen::Vector3f(frame.bounds_max.data()),
                        {-0.94f, 0.94f, -0.94f, 0.94f}, picture.aspect());
    const std::vector<std::uint8_t> bytes =
        render::encode_png(picture.draw(frame, camera, {.map = {}, .overlay = false}));
    key.labels = labels_of(row, camera, static_cast<std::size_t>(scene.setup.model.furniture_total()));
    key.png.assign(bytes.begin(), bytes.end());
  }
}

std::string command_text(const ReportOptions& options) {
  std::string text = "topple report " + options.scene;
  for (const std::string& change : options.overrides) text += " --set '" + change + "'";
  return text + " --lang " + (options.language == Language::japanese ? "ja" : "en");
}

/// Levels and runs of a fragility that planar blocks do in a second or two.
void add_fragility(Report& report, const ReportOptions& options) {
  const io::Scene& scene = *report.scene;
  constexpr const char* k_levels = "pga=50 gal..1500 gal:20";
  constexpr double k_slide = 0.05;  // m
  if (scene.setup.parameters.shakes.empty()) return;
  const auto plan = std::make_shared<study::FragilityPlan>(study::plan_fragility(
      scene, k_levels, {.runs = 128, .spread = k_spread, .vary = {"friction=normal:20%"}}, k_slide));
  if (!study::is_planar(*plan)) return;
  const int jobs = options.jobs.value_or(study::core_count());
  std::vector<study::FragilityRunner> runners(static_cast<std::size_t>(jobs), study::FragilityRunner(*plan));
  std::vector<std::string> rows(static_cast<std::size_t>(plan->cases()));
  Progress progress(scene.name + ", fragility", "parts", plan->cases(), options.quiet);
  study::for_each_case(
      plan->cases(), jobs,
      [&](int k, int worker) {
        rows[static_cast<std::size_t>(k)] =
            runners[static_cast<std::size_t>(worker)].run(k, [] { return interrupted(); });
      },
      [&](int done) {
        progress.update(done);
        return !interrupted();
      });
  report.fragility = gather(*plan, rows);
  report.fragility_plan = plan;
}

std::vector<Vec3> nodes_of(const io::FrameRow& row) {
  std::vector<Vec3> nodes;
  for (int n = 0; 3 * static_cast<std::size_t>(n) < row.position.size(); ++n)
    nodes.push_back(position(row, n));
  return nodes;
}

int interrupted_report(const std::string& file) {
  log_message("interrupted; " + file + " is not written");
  return k_interrupted;
}

/// "paper-a-page.html" of "paper-a.html".
std::string page_beside(const std::string& report) {
  std::filesystem::path path(report);
  path.replace_filename(path.stem().string() + "-page.html");
  return path.string();
}

int report_command(const ReportOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  if (scene.setup.run.analysis != Analysis::dynamic)
    throw BadInput(options.scene + ": a report needs a scene with run.analysis = \"dynamic\"");
  if (scene.setup.model.furniture_total() == 0)
    throw BadInput(options.scene + ": has no furniture to report on");
  const std::string file = !options.file.empty()
                               ? options.file
                               : std::filesystem::path(scene.name).filename().string() + "-report.html";
  require_no_record("--output", file, options.scene, scene);
  require_writable_text("--output", {file, options.force}, host::FileKind::html, options.scene);
  const std::string page = options.with_page ? page_beside(file) : "";
  if (options.with_page) {
    require_pages("--with-page");
    require_no_record("--with-page", page, options.scene, scene);
    require_writable_file("--with-page", {page, options.force}, host::FileKind::html, options.scene);
  }
  defer_interrupts();

  const TemporaryFile temporary;
  RecordedRun run = record(scene, temporary.path(), {.quiet = options.quiet, .estimate = true});
  if (run.exit_code == k_interrupted) return interrupted_report(file);
  if (run.exit_code != k_done) {
    log_message(run.trouble + "; " + file + " is not written");
    return run.exit_code;
  }
  Report report{.scene = &scene,
                .command = command_text(options),
                .overrides = options.overrides,
                .summary = std::move(run.summary),
                .motion = {},
                .tilts = {},
                .pictures = {},
                .nodes_at_start = {},
                .nodes_at_end = {},
                .spread = k_spread,
                .trials = {},
                .without_anchors = {}};
  report.motion = study::floor_motion(scene.setup.parameters.shakes, report.summary["simulated_s"]);
  const io::Recording recording(temporary.path());
  const Replay replay(recording);
  report.tilts = tilt_curves(replay, report.summary["bodies"]);
  report.pictures = key_instants(replay, report.tilts, report.summary["bodies"]);
  draw(scene, replay, report.pictures);
  report.nodes_at_start = nodes_of(replay.frame(0));
  report.nodes_at_end = nodes_of(replay.frame(replay.frame_count() - 1));

  if (!scene.setup.parameters.shakes.empty()) {
    Progress progress(scene.name + ", input varied", "runs", k_trials, options.quiet);
    report.trials = study::try_factors(scene.setup, study::even_factors(k_trials, k_spread),
                                       options.jobs.value_or(study::core_count()), [&](int done) {
                                         progress.update(done);
                                         return !interrupted();
                                       });
  }
  add_fragility(report, options);
  if (const auto bare = study::without_anchors(scene)) {
    RecordedRun without = record(*bare, "", {.quiet = options.quiet});
    report.without_anchors = std::move(without.summary);
  }
  if (!page.empty()) {
    const PageRun replayed = page_run(scene, recording);
    const std::string html = page_of(scene, replayed, options.language, [] { return !interrupted(); });
    if (!html.empty()) write_whole_file({page, options.force}, host::FileKind::html, html);
    report.page = std::filesystem::path(page).filename().string();
    report.page_is_live = why_replay_only(scene, replayed).word.empty();
  }
  if (interrupted()) return interrupted_report(file);
  write_whole_file({file, options.force}, host::FileKind::html, report_page(report, options.language));
  fmt::print("report: {}\n", file);
  if (!page.empty()) fmt::print("live page: {}\n", page);
  return k_done;
}

}  // namespace

void add_report(Commands& commands) {
  const auto [command, report] =
      commands.add("report", "one page for an engineer: what falls, when, how certain that is",
                   "report paper-a -o paper-a.html --lang ja", report_command);
  add_scene(command, report.scene);
  add_path(command, "-o,--output", report.file, "FILE.html", "page to write, default SCENE-report.html");
  add_language(command, report.language, "en (default) or ja");
  command.add_flag("--with-page", report.with_page,
                   "a live page beside it, NAME-page.html, which it links to");
  add_set(command, report.overrides);
  add_force(command, report.force);
  add_jobs(command, report.jobs, "runs at a time, default one per core");
  add_quiet(command, report.quiet);
}

}  // namespace topple::app
