#include "app/window/opening.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/picture/run_extent.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "solver/io/edit/scene_save.h"
#include "solver/io/recording/rerun.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

std::string user_folder(const char* variable, const char* below_home) {
  const char* const named = std::getenv(variable);
  const char* const home = std::getenv("HOME");
  fs::path folder = named && *named == '/' ? fs::path(named)
                    : home && *home == '/' ? fs::path(home) / below_home
                                           : fs::path();
  if (folder.empty()) return "";
  folder /= "topple";
  std::error_code error;
  fs::create_directories(folder, error);
  return error ? "" : folder.string();
}

/// "~/.local/state/topple/paper-a-2026-01-31-120000-4711.h5"; empty when there is no place for it.
std::string default_recording(const std::string& scene) {
  const std::string folder = state_folder();
  if (folder.empty()) return "";
  const std::time_t now = std::time(nullptr);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y-%m-%d-%H%M%S", std::localtime(&now));
  const std::string stem = fmt::format("{}-{}-{}", fs::path(scene).filename().string(), stamp, getpid());
  fs::path path = fs::path(folder) / (stem + ".h5");
  std::error_code ignored;
  for (int number = 2; fs::exists(path, ignored); ++number)  // the same scene twice in a second
    path = fs::path(folder) / fmt::format("{}-{}.h5", stem, number);
  return path.string();
}

}  // namespace

std::string state_folder() {
  return user_folder("XDG_STATE_HOME", ".local/state");
}

std::string cache_folder() {
  return user_folder("XDG_CACHE_HOME", ".cache");
}

LiveSource open_source(const ViewOptions& o, const std::string& program) {
  LiveSource source;
  if (io::is_recording(o.source)) {
    if (!o.overrides.empty())
      throw BadInput("--set: " + o.source + " is a recording; only a scene can be changed");
    source.recording = open_foreign_recording(o.source, program);
    source.scene = std::make_shared<const io::Scene>(io::recorded_scene(*source.recording));
    if (source.recording->frame_count() == 0) throw BadInput(o.source + ": holds no frames");
    const Setup& setup = source.scene->setup;
    io::check_edits(source.recording->history(), setup);
    RunExtent().add(setup, setup.parameters, source.recording->frame(0));  // is it of this model?
  } else {
    source.scene = std::make_shared<const io::Scene>(io::load_scene(o.source, o.overrides));
  }
  source.output = o.recording;
  source.force = o.force;
  if (o.recording.empty())
    source.output = default_recording(source.scene->name);
  else
    require_writable_file("--output", {o.recording, o.force}, host::FileKind::hdf5, o.source);
  return source;
}

LiveSource open_records(const io::Scene& present, const std::vector<std::string>& files) {
  LiveSource source;
  source.scene = std::make_shared<const io::Scene>(io::scene_with_record(present, files));
  source.output = default_recording(source.scene->name);
  return source;
}

LiveSource open_room(io::Scene scene) {
  LiveSource source;
  source.output = default_recording(scene.name);
  source.scene = std::make_shared<const io::Scene>(std::move(scene));
  return source;
}

std::vector<std::string> recent_files() {
  std::vector<std::string> paths;
  const std::string folder = state_folder();
  if (folder.empty()) return paths;
  std::ifstream file(fs::path(folder) / "recent");
  for (std::string line; paths.size() < k_most_recent && std::getline(file, line);)
    if (!line.empty()) paths.push_back(line);
  return paths;
}

void remember_recent(const std::string& path) {
  const std::string folder = state_folder();
  std::error_code error;
  const std::string full = fs::absolute(path, error).lexically_normal().string();
  if (folder.empty() || error || full.find('\n') != std::string::npos) return;
  std::vector<std::string> paths = recent_files();
  std::erase(paths, full);
  paths.insert(paths.begin(), full);
  if (paths.size() > k_most_recent) paths.resize(k_most_recent);
  std::string text;
  for (const std::string& line : paths) text += line + '\n';
  try {
    write_whole_file(fs::path(folder) / "recent", host::FileKind::any, text);
  } catch (const std::runtime_error&) {  // a full disk does not keep anybody from looking
  }
}

Opening::Opening(std::string what, std::function<LiveSource()> open, std::function<void()> wake)
    : what_(std::move(what)) {
  std::packaged_task<LiveSource()> task(std::move(open));
  source_ = task.get_future();
  std::thread([task = std::move(task), wake = std::move(wake)]() mutable {
    task();
    wake();
  }).detach();
}

}  // namespace topple::app
