#include "render/gl/gl.h"

#include <stdexcept>
#include <string>

namespace topple::render {

Gl load_gl(GetProc get_proc) {
  Gl gl;
#define TOPPLE_GL_LOAD(type, name)                        \
  gl.name = reinterpret_cast<type>(get_proc("gl" #name)); \
  if (gl.name == nullptr)                                 \
    throw std::runtime_error("OpenGL: function gl" #name " is missing; 3.3 core is needed");
  TOPPLE_GL_FUNCTIONS(TOPPLE_GL_LOAD)
#undef TOPPLE_GL_LOAD
  GLint major = 0;
  GLint minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < 3 || (major == 3 && minor < 3)) {
    throw std::runtime_error("OpenGL: the context has version " + std::to_string(major) + "." +
                             std::to_string(minor) + ", 3.3 core is needed");
  }
  return gl;
}

void check_gl(const Gl& gl, const char* where) {
  if (const GLenum code = gl.GetError(); code != GL_NO_ERROR) {
    throw std::runtime_error(std::string("OpenGL: error ") + std::to_string(code) + " in " + where);
  }
}

}  // namespace topple::render
