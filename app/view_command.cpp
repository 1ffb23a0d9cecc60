#include <fmt/format.h>
#include <imgui.h>

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "app/commands.h"
#include "app/files.h"
#include "app/interrupt.h"
#include "app/log.h"
#include "app/viewer.h"
#include "render/window.h"
#include "solver/io/rerun.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double k_frame = 1. / 60;   // s, least time between two pictures
constexpr double k_look = 0.1;        // s, how often an idle window looks for Ctrl+C
constexpr int k_frames_of_input = 3;  // Dear ImGui shows the effect of input one or two frames later

/// A Dear ImGui context that lasts as long as the window.
struct Interface {
  Interface() { ImGui::CreateContext(); }
  ~Interface() { ImGui::DestroyContext(); }
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
};

/// "~/.local/state/topple/paper-a-2026-01-31-120000-4711.h5", as the XDG directories say; empty when there is
/// no place for it.
std::string default_recording(const std::string& scene) {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  fs::path folder = state && *state == '/' ? fs::path(state)
                    : home && *home == '/' ? fs::path(home) / ".local/state"
                                           : fs::path();
  if (folder.empty()) return "";
  folder /= "topple";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return "";
  const std::time_t now = std::time(nullptr);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y-%m-%d-%H%M%S", std::localtime(&now));
  return (folder / fmt::format("{}-{}-{}.h5", fs::path(scene).filename().string(), stamp, getpid())).string();
}

LiveSource open_source(const ViewOptions& o) {
  LiveSource source;
  if (io::is_recording(o.source)) {
    if (!o.overrides.empty())
      throw BadInput("--set: " + o.source + " is a recording; only a scene can be changed");
    source.recording.emplace(o.source);
    source.scene = std::make_shared<const io::Scene>(io::recorded_scene(*source.recording));
    if (source.recording->frame_count() == 0) throw BadInput(o.source + ": holds no frames");
    const Setup& setup = source.scene->setup;
    io::check_edits(source.recording->history(), setup);
    RunExtent().add(setup.model, setup.parameters, source.recording->frame(0));  // is it of this model?
  } else {
    source.scene = std::make_shared<const io::Scene>(io::load_scene(o.source, o.overrides));
  }
  source.output = o.recording;
  if (!o.recording.empty())
    require_writable_file("--output", o.recording, o.source);
  else if ((source.output = default_recording(source.scene->name)).empty())
    say("warning: there is no folder for recordings (XDG_STATE_HOME, HOME), so this is not recorded; -o "
        "names a file");
  return source;
}

Appearance window_appearance(const fs::path& settings, const std::optional<Language>& asked) {
  std::string warning;
  Appearance appearance = read_appearance(settings, warning);
  if (!warning.empty()) say("warning: " + warning);
  if (asked) {
    appearance.language = *asked;
  } else if (appearance.language == Language::japanese && !render::has_japanese_font()) {
    say("warning: Japanese needs the Debian package fonts-vlgothic; the window is in English");
    appearance.language = Language::english;
  }
  return appearance;
}

/// Draws while there is something to draw, until the window closes or Ctrl+C.
void show(render::Window& window, render::Stage& stage, Viewer& viewer, Player& player) {
  int frames_due = k_frames_of_input;
  Clock::time_point last = Clock::now(), next_frame = last;
  while (!window.should_close() && !viewer.wants_to_close() && !interrupted()) {
    const double wait = window.iconified() ? k_look
                        : frames_due > 0   ? Seconds(next_frame - Clock::now()).count()
                        : player.playing() ? k_frame
                                           : k_look;
    if (wait > 0)
      window.wait_events(wait);
    else
      window.poll_events();
    const Clock::time_point now = Clock::now();
    if (viewer.update(Seconds(now - last).count())) frames_due = std::max(frames_due, 1);
    last = now;
    for (const render::KeyPress& press : window.take_keys()) viewer.press(press);
    if (window.take_input()) frames_due = k_frames_of_input;
    if (ImGui::GetIO().WantTextInput) frames_due = std::max(frames_due, 1);  // the caret blinks
    if (frames_due == 0 || now < next_frame || window.iconified()) continue;
    --frames_due;
    next_frame = now + std::chrono::duration_cast<Clock::duration>(Seconds(k_frame));
    window.new_imgui_frame();
    ImGui::NewFrame();
    viewer.build();
    stage.present(viewer.surface(), *ImGui::GetDrawData());
    viewer.report_frame_time(1e3 * Seconds(Clock::now() - now).count());
    window.swap();
  }
}

}  // namespace

int view_command(const ViewOptions& options) {
  LiveSource source = open_source(options);
  const std::shared_ptr<const io::Scene> scene = source.scene;
  const std::filesystem::path settings = settings_file();
  const Appearance appearance = window_appearance(settings, options.language);
  const Viewer::Keep keep = [settings](const Appearance& chosen) {
    if (!settings.empty()) keep_appearance(settings, chosen);
  };
  defer_interrupts();
  const Interface interface;
  render::Window window("topple: " + scene->name);
  window.connect_imgui();
  render::Stage stage(window.get_proc());
  LiveRun run(std::move(source), &render::Window::wake);
  Player player(scene, run);
  // Where a point of the desktop is several pixels, Dear ImGui's coordinates are scaled already.
  const float pixels =
      static_cast<float>(window.framebuffer_size().width) / static_cast<float>(window.size().width);
  Viewer viewer(player, stage, window.content_scale() / pixels, render::NamedView::iso, {}, appearance, keep);
  show(window, stage, viewer, player);
  const LiveStatus status = run.close(interrupted() ? "interrupted" : "stopped");
  if (!status.record_failure.empty()) say(status.record_failure);
  if (!status.recording.empty() && status.record_failure.empty())
    fmt::print("recording: {}\n", status.recording);
  if (interrupted()) return k_interrupted;
  const bool failed = status.kind == LiveStatus::Kind::failed || status.kind == LiveStatus::Kind::ended;
  if (failed) say(scene->name + ": " + status.message);
  return failed || !status.record_failure.empty() ? k_failed : k_done;
}

}  // namespace topple::app
