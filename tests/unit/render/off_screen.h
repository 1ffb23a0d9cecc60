// One off-screen context for all tests of a process, and probes of its pictures.
#pragma once

#include <array>
#include <memory>

#include <Eigen/Geometry>

#include "render/gl/off_screen.h"
#include "render/output/picture.h"

namespace topple::render {

inline GetProc off_screen() {
  static const std::unique_ptr<Context> context = make_off_screen_context(Renderer::any);
  return context->get_proc();
}

struct Pixel {
  int x, y;  // from the upper left corner
};

/// Where a point of the picture's frame is seen.
inline Pixel seen_at(const Camera& camera, const Eigen::Vector3f& point, int width, int height) {
  const Eigen::Vector4f clip = camera.projection * (camera.view * point.homogeneous());
  return {static_cast<int>((0.5f + 0.5f * clip.x() / clip.w()) * static_cast<float>(width)),
          static_cast<int>((0.5f - 0.5f * clip.y() / clip.w()) * static_cast<float>(height))};
}

inline std::array<int, 3> colour_at(const Image& image, Pixel p) {
  const std::size_t i = 4 * (static_cast<std::size_t>(p.y) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(p.x));
  return {image.rgba.at(i), image.rgba.at(i + 1), image.rgba.at(i + 2)};
}

/// Brightness of the pixels within `reach` of p, 0..255.
inline double brightness(const Image& image, Pixel p, int reach) {
  double sum = 0;
  int count = 0;
  for (int y = p.y - reach; y <= p.y + reach; ++y) {
    for (int x = p.x - reach; x <= p.x + reach; ++x) {
      const auto c = colour_at(image, {x, y});
      sum += 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
      ++count;
    }
  }
  return sum / count;
}

}  // namespace topple::render
