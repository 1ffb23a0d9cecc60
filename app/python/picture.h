// Pictures as bytes of PNG files.
#pragma once

#include <string>
#include <utility>

#include "app/picture/run_extent.h"
#include "solver/io/scene/scene.h"

namespace topple::python {

using PictureSize = std::pair<int, int>;  ///< px, width and height
inline constexpr PictureSize k_picture_size = {1280, 720};

/// What `topple render --still` draws of a row. One thread draws at a time. Throws app::BadInput for a size
/// that it does not have either.
std::string draw_png(const io::Scene& scene, const app::RunExtent& extent, const io::FrameRow& row,
                     const Parameters& parameters, PictureSize size);

}  // namespace topple::python
