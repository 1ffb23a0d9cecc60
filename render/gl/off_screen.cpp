#include "render/gl/off_screen.h"

#include <stdexcept>
#include <string>

#include "render/gl/egl_context.h"
#include "render/gl/osmesa_context.h"

namespace topple::render {

std::unique_ptr<Context> make_off_screen_context(Renderer renderer) {
  if (renderer == Renderer::osmesa) return make_osmesa_context();
  if (renderer == Renderer::egl) return make_egl_context();
  std::string missing;
  try {
    return make_osmesa_context();
  } catch (const std::runtime_error& error) {
    missing = error.what();
  }
  try {
    return make_egl_context();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(missing + "; nor with EGL: " + error.what());
  }
}

}  // namespace topple::render
