// The live page of a run, for notebooks.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>

#include "app/page/export_page.h"

namespace topple::python {

/// A notebook keeps the page of every result that it shows; of larger ones it shows the picture.
inline constexpr std::size_t k_most_notebook_page = std::size_t{10} << 20;
inline constexpr int k_page_height = 900;  ///< px

/// HTML of a frame with the page that `topple export --page` writes. None: there is nothing to show, the page
/// is larger than k_most_notebook_page, or this module was built without emscripten. With the GIL.
pybind11::object page_in_frame(const io::Scene& scene, const app::PageRun& run);

}  // namespace topple::python
