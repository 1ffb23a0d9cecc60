#include "render/output/picture.h"

#include <imgui.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "render/output/canvas.h"
#include "render/output/imgui_painter.h"
#include "render/scene/scene_painter.h"

namespace topple::render {
namespace {

constexpr int k_samples = 4;
constexpr int k_least_side = 16;
constexpr int k_greatest_side = 8192;

/// A Dear ImGui context of its own, current only while it is used: a window may have another one.
class Words {
 public:
  Words(int width, int height) : previous_(ImGui::GetCurrentContext()), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = 1.0f / 60;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImGui::SetCurrentContext(previous_);
  }
  ~Words() { ImGui::DestroyContext(context_); }
  Words(const Words&) = delete;
  Words& operator=(const Words&) = delete;

  /// Calls `use` with the context current.
  template <typename Use>
  void with(Use use) {
    ImGuiContext* other = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    use();
    ImGui::SetCurrentContext(other);
  }

 private:
  ImGuiContext* previous_;
  ImGuiContext* context_;
};

}  // namespace

struct Picture::Parts {
  Parts(GetProc get_proc, int w, int h, const Letters& letters)
      : gl(load_gl(get_proc)),
        width(w),
        height(h),
        scene(gl),
        painter(gl),
        canvas(gl, w, h, k_samples),
        words(w, h) {
    words.with([&] {
      // Narrow pictures take the letters of a lower one, so that lines keep their room.
      fonts = add_overlay_fonts(*ImGui::GetIO().Fonts, std::min(height, 3 * width / 4), letters);
      painter.upload_fonts(*ImGui::GetIO().Fonts);
    });
    check_gl(gl, "the set-up of a picture");
  }

  void draw_words(const SceneFrame& frame, const Camera& camera, ColourMap map) {
    words.with([&] {
      ImGui::NewFrame();
      boxes = draw_overlay(*ImGui::GetBackgroundDrawList(), fonts, frame, map, static_cast<float>(width),
                           static_cast<float>(height), left_out);
      if (finite(camera))
        draw_labels(*ImGui::GetBackgroundDrawList(), fonts, frame, camera,
                    {"", 0, 0, static_cast<float>(width), static_cast<float>(height)},
                    static_cast<float>(height), boxes);
      ImGui::Render();
      painter.draw(*ImGui::GetDrawData(), canvas.target());
    });
  }

  Gl gl;
  int width, height;
  ScenePainter scene;
  ImguiPainter painter;
  Canvas canvas;
  Words words;
  OverlayFonts fonts;
  LeftOut left_out;
  std::vector<OverlayBox> boxes;
};

Picture::Picture(GetProc get_proc, int width, int height, const Letters& letters) {
  if (std::min(width, height) < k_least_side || std::max(width, height) > k_greatest_side) {
    throw std::runtime_error("picture of " + std::to_string(width) + " x " + std::to_string(height) +
                             " px: sides must be " + std::to_string(k_least_side) + " to " +
                             std::to_string(k_greatest_side));
  }
  parts_ = std::make_unique<Parts>(get_proc, width, height, letters);
}

Picture::~Picture() = default;

float Picture::aspect() const {
  return static_cast<float>(parts_->width) / static_cast<float>(parts_->height);
}

Image Picture::draw(const SceneFrame& frame, const Camera& camera, const PictureOptions& options) {
  Parts& p = *parts_;
  p.left_out = {};
  p.boxes.clear();
  p.canvas.draw(p.scene, frame, camera, options.map, Quality::still, p.left_out);
  if (options.overlay) p.draw_words(frame, camera, colour_map_for(frame.legend, options.map, frame.dark));
  Image image = p.canvas.read();
  check_gl(p.gl, "drawing a picture");
  return image;
}

const LeftOut& Picture::left_out() const {
  return parts_->left_out;
}

const std::vector<OverlayBox>& Picture::overlay_boxes() const {
  return parts_->boxes;
}

}  // namespace topple::render
