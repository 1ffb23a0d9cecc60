#include "render/off_screen.h"

#include <stdexcept>

#include "render/egl_context.h"
#include "render/osmesa_context.h"

namespace topple::render {

std::unique_ptr<Context> make_off_screen_context(Renderer renderer, std::string& note) {
  note.clear();
  if (renderer == Renderer::osmesa) return make_osmesa_context();
  if (renderer == Renderer::egl) return make_egl_context();
  std::string missing;
  try {
    return make_osmesa_context();
  } catch (const std::runtime_error& error) {
    missing = error.what();
  }
  try {
    std::unique_ptr<Context> context = make_egl_context();
    note = "drawing with EGL instead of OSMesa: " + missing;
    return context;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(missing + "; nor with EGL: " + error.what());
  }
}

}  // namespace topple::render
