// What a person waits for in the window, drawn by two cores of the processor at 1280x720: the first frame,
// frames while a run goes on, runs in real time, and any instant of a recording of 60 s.
//   window_bench PROGRAM
#include <imgui.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include "app/window/shell.h"
#include "unit/render/off_screen.h"

namespace topple::app {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

double ms_since(Clock::time_point from) {
  return std::chrono::duration<double, std::milli>(Clock::now() - from).count();
}

/// Of all threads, ms: what a frame costs where other programs take their share of the time.
double processor_ms() {
  rusage used;
  getrusage(RUSAGE_SELF, &used);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(used.ru_utime) + ms(used.ru_stime);
}

void print(const char* what, std::vector<double> ms) {
  std::ranges::sort(ms);
  const auto at = [&](double share) { return ms[static_cast<std::size_t>(share * double(ms.size() - 1))]; };
  std::printf("%-44s %6.1f ms median, %6.1f ms 99 %%, %6.1f ms most, of %zu\n", what, at(0.5), at(0.99),
              ms.back(), ms.size());
}

class Screen {
 public:
  explicit Screen(const std::string& program)
      : stage_(render::off_screen()),
        shell_(
            stage_, 1.f, [] {}, program),
        program_(program) {
    ImGui::GetIO().DisplaySize = {1280, 720};
    ImGui::GetIO().DeltaTime = 1.f / 60;
  }
  /// From taking in what is new to pixels, ms.
  double frame() {
    const Clock::time_point from = Clock::now();
    shell_.update(1. / 60);
    ImGui::NewFrame();
    shell_.build();
    stage_.shot(shell_.surface(), *ImGui::GetDrawData());
    return ms_since(from);
  }
  void show(const std::string& source) {
    const ViewOptions options{.source = source, .overrides = {}, .recording = {}, .language = {}};
    shell_.show(open_source(options, program_), "");
  }
  Player& player() { return shell_.session()->player(); }
  Viewer& viewer() { return shell_.session()->viewer(); }

 private:
  render::Stage stage_;
  Shell shell_;
  const std::string program_;
};

void measure_frames(const std::string& program, const char* scene) {
  Screen screen(program);
  screen.show(scene);
  while (!screen.player().can_edit()) screen.frame();
  screen.player().play();
  std::vector<double> ms;
  for (int i = 0; i < 300; ++i) ms.push_back(screen.frame());
  print((std::string(scene) + " while it runs, a frame").c_str(), ms);
}

/// While a person turns it, at rest.
void measure_turning(const std::string& program, const char* scene) {
  Screen screen(program);
  screen.show(scene);
  while (!screen.player().can_edit()) screen.frame();
  std::vector<double> ms;
  for (int i = 0; i < 300; ++i) {
    render::Orbit orbit = screen.viewer().orbit();
    orbit.rotate(4, 0);
    screen.viewer().look(orbit);
    ms.push_back(screen.frame());
  }
  print((std::string(scene) + " turned, a frame").c_str(), ms);
}

/// A whole run, drawn as the window draws it: 60 times a second as far as that is kept. Frames of more than a
/// thirtieth of a second are late.
void measure_real_time(const std::string& program, const char* scene) {
  constexpr std::chrono::microseconds k_frame{16667};
  Screen screen(program);
  screen.show(scene);
  while (!screen.player().can_edit()) screen.frame();
  screen.player().play();
  std::vector<double> ms;
  const Clock::time_point start = Clock::now();
  Clock::time_point due = start;
  int late = 0;
  while (screen.player().status().kind != LiveStatus::Kind::over) {
    ms.push_back(screen.frame());
    due += k_frame;
    late += ms.back() > 1e3 / 30;
    due = std::max(due, Clock::now());
    std::this_thread::sleep_until(due);
  }
  const double seconds = ms_since(start) / 1e3;
  print((std::string(scene) + " in real time, a frame").c_str(), ms);
  std::printf("%-44s %6.2f times real time, %.1f frames a second, %d late\n", "",
              screen.player().time() / seconds, double(ms.size()) / seconds, late);
}

void measure_seek(const std::string& program, const std::string& recording, const char* what) {
  Screen screen(program);
  screen.show(recording);
  while (screen.player().status().kind != LiveStatus::Kind::replay) screen.frame();
  std::mt19937 rng(1);
  std::vector<double> ms;
  const double before = processor_ms();
  for (int i = 0; i < 1000; ++i) {
    const double time = screen.player().length() * (rng() / 4294967296.);
    const Clock::time_point from = Clock::now();
    screen.player().scrub(time);
    screen.frame();
    ms.push_back(ms_since(from));
  }
  print(what, ms);
  std::printf("%-44s %6.1f ms of processor time\n", "", (processor_ms() - before) / double(ms.size()));
}

int bench(const std::string& program, Clock::time_point start) {
  const fs::path folder = fs::temp_directory_path() / "topple-window-bench";
  fs::create_directories(folder);
  setenv("XDG_STATE_HOME", (folder / "state").c_str(), 1);
  setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
  {
    Screen screen(program);
    screen.show("paper-a");
    screen.frame();
    std::printf("%-44s %6.1f ms\n", "paper-a, from the start of the program", ms_since(start));
    while (!screen.player().row()) screen.frame();
    screen.frame();
    std::printf("%-44s %6.1f ms\n", "paper-a, until its bodies are seen", ms_since(start));
  }
  for (const char* scene : {"paper-a", "classroom"}) measure_frames(program, scene);
  measure_turning(program, "classroom");
  for (const char* scene : {"dominoes", "classroom", "office"}) measure_real_time(program, scene);
  const std::string recording = (folder / "paper-a.h5").string();
  fs::remove(recording);
  const std::string run =
      program + " run paper-a --set run.duration=60 --quiet -o " + recording + " > /dev/null 2>&1";
  if (std::system(run.c_str()) != 0) return 1;
  measure_seek(program, recording, "paper-a, another instant of 60 s");
  fs::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace topple::app

int main(int count, char** words) {
  const auto start = std::chrono::steady_clock::now();
  if (count != 2) {
    std::fprintf(stderr, "usage: window_bench PROGRAM\n");
    return 2;
  }
  setenv("LP_NUM_THREADS", "2", 0);  // as Mesa draws for a window on two cores
  ImGuiContext* const interface = ImGui::CreateContext();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const int code = topple::app::bench(std::filesystem::absolute(words[1]).string(), start);
  ImGui::DestroyContext(interface);
  return code;
}
