// A stage with a scene in a region and an interface beside and over it: the same off screen and in a
// window.
#pragma once

#include <imgui.h>

#include "render/output/stage.h"
#include "render/scene/font.h"
#include "tests/unit/render/synthetic_cabinet.h"

namespace topple::render {

inline constexpr int k_staged_width = 640;
inline constexpr int k_staged_height = 400;
inline constexpr int k_scene_width = 420;
inline constexpr int k_scene_height = 300;
inline constexpr Surface k_surface{k_staged_width, k_staged_height, 30, 20};

/// A Dear ImGui context of its own, fed by hand, and a stage that shows it.
class Staged {
 public:
  explicit Staged(GetProc get_proc) : stage(get_proc), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {k_staged_width, k_staged_height};
    io.DeltaTime = 1.0f / 60;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    add_overlay_fonts(*io.Fonts, 720);
    stage.upload_fonts(*io.Fonts);
  }
  ~Staged() { ImGui::DestroyContext(context_); }
  Staged(const Staged&) = delete;
  Staged& operator=(const Staged&) = delete;

  void draw_scene(const SceneFrame& frame, Quality quality) {
    constexpr float k_aspect = static_cast<float>(k_scene_width) / k_scene_height;
    stage.draw_scene(frame, fit_camera(NamedView::iso, frame, k_aspect), ColourMap::viridis, k_scene_width,
                     k_scene_height, quality);
  }

  /// A panel at the right, its edge over the scene.
  const ImDrawData& panel() {
    for (int frame = 0; frame < 3; ++frame) {  // until a new panel has settled
      ImGui::NewFrame();
      ImGui::SetNextWindowPos({400, 50});
      ImGui::SetNextWindowSize({200, 200});
      ImGui::Begin("Panel", nullptr, ImGuiWindowFlags_NoCollapse);
      ImGui::TextUnformatted("t = 12.48 s");
      ImGui::End();
      ImGui::Render();
    }
    return *ImGui::GetDrawData();
  }
  const ImDrawData& no_interface() {
    ImGui::NewFrame();
    ImGui::Render();
    return *ImGui::GetDrawData();
  }

  Stage stage;

 private:
  ImGuiContext* context_;
};

}  // namespace topple::render
