#include "app/window/window_picture.h"

#include <imgui.h>

#include <chrono>
#include <thread>

#include "app/picture/window_words.h"

namespace topple::app {

WindowPicture::WindowPicture(render::Context& context, const std::shared_ptr<const io::Scene>& scene,
                             const std::string& recording, render::NamedView view,
                             const PictureSettings& settings, const std::optional<Subject>& inspected,
                             const std::optional<std::size_t>& followed, int width, int height)
    : interface_(ImGui::CreateContext()),
      stage_(context.get_proc()),
      run_({.scene = scene, .recording = io::Recording(recording), .output = {}}),
      player_(scene, run_) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1.f / 60;
  viewer_.emplace(player_, stage_, static_cast<float>(height) / 720, view, settings,
                  Appearance{.language = window_language()});
  if (inspected) viewer_->inspect(inspected);
  const auto waiting = [this] {
    player_.update(0);
    const LiveStatus::Kind kind = player_.status().kind;
    return kind == LiveStatus::Kind::starting || kind == LiveStatus::Kind::reading;
  };
  while (waiting()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  build();  // the first one shows how much room words take
  if (!followed) return;
  build();  // as it is seen at the first instant
  viewer_->follow(followed);
}

WindowPicture::~WindowPicture() {
  viewer_.reset();
  ImGui::DestroyContext(interface_);
}

render::Image WindowPicture::at(double time) {
  player_.scrub(time);
  build();
  build();  // what is at rest is drawn at its best
  return stage_.shot(viewer_->surface(), *ImGui::GetDrawData());
}

void WindowPicture::build() {
  viewer_->update(1);
  ImGui::NewFrame();
  viewer_->build();
}

}  // namespace topple::app
