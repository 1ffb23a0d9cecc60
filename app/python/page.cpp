#include "app/python/page.h"

#include <string>

#include "app/python/picture.h"
#include "app/python/signals.h"

namespace topple::python {

namespace py = pybind11;

py::object page_in_frame(const io::Scene& scene, const app::PageRun& run) {
  if (run.rows == 0 || !app::can_make_pages()) return py::none();
  Signals signals;
  std::string page;
  {
    const py::gil_scoped_release released;
    const auto turn = turn_at_drawing();
    page = app::page_of(scene, run, app::Language::english, [&] { return !signals.raised(); });
  }
  signals.rethrow();
  if (page.size() > k_most_notebook_page) return py::none();
  return py::str(app::in_frame(page, scene.name, k_page_height));
}

}  // namespace topple::python
