// Pictures as bytes of PNG files.
#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "app/picture/run_extent.h"
#include "solver/io/scene/scene.h"

namespace topple::python {

using PictureSize = std::pair<int, int>;  ///< px, width and height
inline constexpr PictureSize k_picture_size = {1280, 720};

/// One thread draws at a time. Without the GIL.
std::unique_lock<std::mutex> turn_at_drawing();

/// What `topple render --still` draws of a row. Throws app::BadInput for a size
/// that it does not have either.
std::string draw_png(const io::Scene& scene, const app::RunExtent& extent, const io::FrameRow& row,
                     const Parameters& parameters, PictureSize size);

}  // namespace topple::python
