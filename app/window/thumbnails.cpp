#include "app/window/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <filesystem>
#include <future>
#include <mutex>
#include <optional>
#include <thread>

#include "app/picture/bridge.h"
#include "app/picture/image_files.h"
#include "app/support/terms.h"
#include "app/window/opening.h"
#include "render/scene/orbit.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

namespace fs = std::filesystem;

constexpr double k_longest = 3;                       // s, simulated
constexpr double k_tilt = 0.2;                        // rad, of a body: something happens
constexpr double k_statics = 0.7;                     // of the way through the loads
constexpr int k_steps_at_once = 20;                   // between two tests for it
constexpr float k_room_above = 0.1f;                  // of the height, for what tilts
constexpr std::chrono::milliseconds k_patience{300};  // with a step under way when nobody wants them any more

float tilt(const BodyPoints& now, const BodyPoints& start) {
  const auto up = [](const BodyPoints& p) {
    return Eigen::Vector3f(p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]).normalized();
  };
  return std::acos(std::clamp(up(now).dot(up(start)), -1.f, 1.f));
}

bool something_tilts(const Model& model, const io::FrameRow& row, const io::FrameRow& start) {
  for (std::size_t b = 0; b < static_cast<std::size_t>(model.furniture_total()); ++b)
    if (tilt(body_points(model, row, b), body_points(model, start, b)) > k_tilt) return true;
  return false;
}

/// The first instant at which something happens.
std::optional<render::SceneFrame> eventful_frame(const io::Scene& scene, const std::atomic<bool>& stop) {
  const Setup& setup = scene.setup;
  Run run(setup);
  if (!run.status().ok()) return std::nullopt;
  const io::FrameRow start = io::frame_row(run);
  io::FrameRow row = start;
  const bool loads = is_static(setup);
  while (!stop && !run.over() && run.state().time < (loads ? k_statics : k_longest) &&
         (loads || !something_tilts(setup.model, row, start))) {
    for (int i = 0; i < (loads ? 1 : k_steps_at_once) && !run.over(); ++i)
      if (!run.advance().ok()) break;
    row = io::frame_row(run);
  }
  if (stop) return std::nullopt;
  RunExtent extent;
  extent.add(setup, setup.parameters, row);
  return Bridge(scene, extent).frame(row, run.parameters());
}

/// Another version draws its own.
fs::path cache_file(const io::BuiltinScene& scene) {
  const std::string folder = cache_folder();
  if (folder.empty()) return {};
  const std::size_t hash = std::hash<std::string>()(std::string(TOPPLE_VERSION) + std::string(scene.text));
  return fs::path(folder) / fmt::format("{}-{:016x}.png", scene.name, hash);
}

struct Ready {
  std::string scene;
  fs::path file;                            ///< where the picture is kept; empty: nowhere
  std::optional<render::Image> image = {};  ///< or
  std::optional<render::SceneFrame> frame = {};
};

}  // namespace

struct Thumbnails::Shared {
  std::atomic<bool> stop = false;
  std::function<void()> wake;
  std::mutex mutex;
  std::deque<Ready> ready;
  std::promise<void> ended;

  void publish(Ready one) {
    {
      const std::lock_guard lock(mutex);
      ready.push_back(std::move(one));
    }
    if (!stop) wake();
  }
};

Thumbnails::Thumbnails(render::Stage& stage, std::function<void()> wake)
    : stage_(stage), shared_(std::make_shared<Shared>()) {
  shared_->wake = std::move(wake);
}

Thumbnails::~Thumbnails() {
  shared_->stop = true;
  if (started_) shared_->ended.get_future().wait_for(k_patience);
}

void Thumbnails::want() {
  if (started_) return;
  started_ = true;
  std::thread(&Thumbnails::work, shared_).detach();
}

void Thumbnails::work(const std::shared_ptr<Shared>& shared) {
  std::vector<io::BuiltinScene> missing;
  for (const io::BuiltinScene& scene : io::builtin_scenes()) {
    const fs::path file = cache_file(scene);
    std::optional<render::Image> image = render::load_png(file);
    if (image)
      shared->publish({std::string(scene.name), {}, std::move(image)});
    else
      missing.push_back(scene);
  }
  for (const io::BuiltinScene& builtin : missing) {
    if (shared->stop) break;
    try {
      const io::Scene scene = io::load_scene(std::string(builtin.name));
      if (auto frame = eventful_frame(scene, shared->stop))
        shared->publish({std::string(builtin.name), cache_file(builtin), std::nullopt, std::move(frame)});
    } catch (const std::exception&) {  // a card without a picture
    }
  }
  shared->ended.set_value();
}

bool Thumbnails::update() {
  Ready one;
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->ready.empty()) return false;
    one = std::move(shared_->ready.front());
    shared_->ready.pop_front();
  }
  if (one.frame) {
    render::SceneFrame& frame = *one.frame;
    frame.bounds_max[2] += k_room_above * (frame.bounds_max[2] - frame.bounds_min[2]);
    constexpr float aspect = static_cast<float>(k_thumbnail_width) / k_thumbnail_height;
    const render::Orbit orbit = render::Orbit::fit(render::NamedView::iso, frame, aspect);
    one.image = stage_.portrait(frame, orbit.camera(aspect), render::ColourMap::viridis, k_thumbnail_width,
                                k_thumbnail_height);
    try {
      if (!one.file.empty()) write_png({one.file, true}, *one.image);
    } catch (const std::runtime_error&) {  // it is drawn again the next time
    }
  }
  textures_[one.scene] = stage_.keep(*one.image);
  return true;
}

void* Thumbnails::of(const std::string& scene) const {
  const auto found = textures_.find(scene);
  return found == textures_.end() ? nullptr : found->second;
}

}  // namespace topple::app
