// Pictures of the window's content, without a window.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/window/viewer.h"
#include "render/gl/context.h"
#include "render/output/image.h"

struct ImGuiContext;

namespace topple::app {

/// Shows a recording as `topple view` does, in the language of the window.
class WindowPicture {
 public:
  /// followed: body that the camera follows from the first frame on. Throws io::InputError, and
  /// std::runtime_error when it cannot draw. `context` is current and outlives it.
  WindowPicture(render::Context& context, const std::shared_ptr<const io::Scene>& scene,
                const std::string& recording, render::NamedView view, const PictureSettings& settings,
                const std::optional<Subject>& inspected, const std::optional<std::size_t>& followed,
                int width, int height);
  ~WindowPicture();
  WindowPicture(const WindowPicture&) = delete;
  WindowPicture& operator=(const WindowPicture&) = delete;

  /// The recorded frame nearest to `time`, s.
  render::Image at(double time);

 private:
  void build();

  ImGuiContext* const interface_;
  render::Stage stage_;
  LiveRun run_;
  Player player_;
  std::optional<Viewer> viewer_;
};

}  // namespace topple::app
