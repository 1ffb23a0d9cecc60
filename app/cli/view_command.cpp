#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/cli/command.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/window/opening.h"
#include "app/window/shell.h"
#include "render/gl/window.h"

namespace topple::app {
namespace {

constexpr double k_frame = 1. / 60;   // s, least time between two pictures
constexpr double k_idle_wait = 0.1;   // s, how often an idle window looks for Ctrl+C
constexpr int k_frames_of_input = 3;  // Dear ImGui shows the effect of input one or two frames later
constexpr int k_frames_of_news = 2;   // it knows how long a text is once it was drawn

/// A Dear ImGui context that lasts as long as the window.
struct Interface {
  Interface() { ImGui::CreateContext(); }
  ~Interface() { ImGui::DestroyContext(); }
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
};

Appearance window_appearance(const std::filesystem::path& settings, const std::optional<Language>& asked) {
  std::string warning;
  Appearance appearance = read_appearance(settings, warning);
  if (!warning.empty()) log_message("warning: " + warning);
  if (asked) {
    appearance.language = *asked;
  } else if (appearance.language == Language::japanese && !render::has_japanese_font()) {
    log_message("warning: Japanese needs the Debian package fonts-vlgothic; the window is in English");
    appearance.language = Language::english;
  }
  return appearance;
}

/// Draws while there is something to draw, until the window closes or Ctrl+C.
void show(render::Window& window, render::Stage& stage, Shell& shell) {
  int frames_due = k_frames_of_input;
  Clock::time_point last = Clock::now(), next_frame = last;
  std::string title = shell.title();
  while (!window.should_close() && !shell.wants_to_close() && !interrupted()) {
    const double wait = window.iconified() ? k_idle_wait
                        : frames_due > 0   ? Seconds(next_frame - Clock::now()).count()
                        : shell.playing()  ? k_frame
                                           : k_idle_wait;
    if (wait > 0)
      window.wait_events(wait);
    else
      window.poll_events();
    const Clock::time_point now = Clock::now();
    if (const std::vector<std::string> dropped = window.take_drops(); !dropped.empty()) shell.drop(dropped);
    if (shell.update(Seconds(now - last).count())) frames_due = std::max(frames_due, k_frames_of_news);
    last = now;
    for (const render::KeyPress& press : window.take_keys()) shell.press(press);
    if (shell.take_full_screen()) window.toggle_full_screen();
    if (window.take_input()) frames_due = k_frames_of_input;
    if (ImGui::GetIO().WantTextInput) frames_due = std::max(frames_due, 1);  // the caret blinks
    if (shell.title() != title) window.set_title(title = shell.title());
    if (frames_due == 0 || now < next_frame || window.iconified()) continue;
    --frames_due;
    next_frame = now + std::chrono::duration_cast<Clock::duration>(Seconds(k_frame));
    window.new_imgui_frame();
    ImGui::NewFrame();
    shell.build();
    stage.present(shell.surface(), *ImGui::GetDrawData());
    shell.report_frame_time(1e3 * Seconds(Clock::now() - now).count());
    window.swap();
  }
}

/// Says what was recorded, and what went wrong.
int say_end(const std::string& scene, const std::vector<LiveStatus>& ends) {
  bool good = true;
  for (const LiveStatus& status : ends) {
    if (!status.record_failure.empty()) log_message(status.record_failure);
    if (!status.recording.empty() && status.record_failure.empty())
      fmt::print("recording: {}\n", status.recording);
    good = good && status.record_failure.empty();
  }
  if (interrupted()) return k_interrupted;
  if (ends.empty()) return k_done;
  const LiveStatus& last = ends.back();
  const bool failed = last.kind == LiveStatus::Kind::failed || last.kind == LiveStatus::Kind::ended;
  if (failed) log_message(scene + ": " + last.message);
  return good && !failed ? k_done : k_failed;
}

int view_command(const ViewOptions& options) {
  std::optional<LiveSource> source;
  if (!options.source.empty())
    source = open_source(options);
  else if (!options.overrides.empty() || !options.recording.empty())
    throw BadInput("SOURCE: --set and --output are for a scene that is named");
  const std::filesystem::path settings = settings_file();
  const Appearance appearance = window_appearance(settings, options.language);
  const Viewer::Keep keep = [settings, asked = options.language](const Appearance& chosen) {
    if (settings.empty()) return;
    Appearance kept = chosen;
    std::string told;
    if (asked == chosen.language)
      kept.language = read_appearance(settings, told).language;  // for this window
    keep_appearance(settings, kept);
  };
  defer_interrupts();
  const Interface interface;
  render::Window window(source ? "topple: " + source->scene->name : "topple");
  window.connect_imgui();
  render::Stage stage(window.get_proc());
  // Where a point of the desktop is several pixels, Dear ImGui's coordinates are scaled already.
  const float pixels =
      static_cast<float>(window.framebuffer_size().width) / static_cast<float>(window.size().width);
  Shell shell(stage, window.content_scale() / pixels, &render::Window::wake, "/proc/self/exe", appearance,
              keep);
  const bool is_file = std::filesystem::exists(options.source);
  if (source)
    shell.show(*std::move(source), is_file ? options.source : "");
  else
    shell.choose_scene();
  show(window, stage, shell);
  const std::string scene = shell.session() ? shell.session()->scene().name : "";
  return say_end(scene, shell.close(interrupted() ? "interrupted" : "stopped"));
}

}  // namespace

void add_view(Commands& commands) {
  const auto [command, view] =
      commands.add("view", "watch a scene in a window, shake it, rewind it; or a recording",
                   "view paper-a --set contact.alpha=\"500 kgf\"", view_command);
  add_path(command, "SOURCE", view.source, "", "scene or recording; without: choose");
  add_path(command, "-o,--output", view.recording, "REC.h5",
           "recording to write, in place of an older one; default a new one in the state folder");
  add_set(command, view.overrides);
  add_force(command, view.force);
  add_language(command, view.language, "en or ja, default as last chosen, or that of the locale");
}

}  // namespace topple::app
