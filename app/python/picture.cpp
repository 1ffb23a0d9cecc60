#include "app/python/picture.h"

#include <fmt/format.h>

#include "app/panels/appearance.h"
#include "app/picture/bridge.h"
#include "app/picture/picture_settings.h"
#include "app/support/errors.h"
#include "render/gl/off_screen.h"
#include "render/output/picture.h"
#include "render/scene/camera.h"

namespace topple::python {

std::unique_lock<std::mutex> turn_at_drawing() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

std::string draw_png(const io::Scene& scene, const app::RunExtent& extent, const io::FrameRow& row,
                     const Parameters& parameters, PictureSize size) {
  const auto [width, height] = size;
  if (std::min(width, height) < app::k_least_picture || std::max(width, height) > app::k_most_picture)
    throw app::BadInput(fmt::format("size: {}x{} is not WIDTHxHEIGHT with {}..{} each", width, height,
                                    app::k_least_picture, app::k_most_picture));
  const std::unique_lock turn = turn_at_drawing();
  const auto context = render::make_off_screen_context(render::Renderer::any);
  render::Picture picture(context->get_proc(), width, height, app::window_letters(&scene));
  const app::PictureSettings settings{.alone = true};
  const render::SceneFrame frame = app::Bridge(scene, extent).frame(row, parameters, settings);
  const render::Camera camera = render::fit_camera(render::NamedView::iso, frame, picture.aspect());
  const auto png = render::encode_png(picture.draw(frame, camera, {.map = settings.map}));
  return {png.begin(), png.end()};
}

}  // namespace topple::python
