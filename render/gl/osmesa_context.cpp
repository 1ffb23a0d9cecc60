#include "render/gl/osmesa_context.h"

#include <dlfcn.h>

#include <array>
#include <stdexcept>
#include <string>

#include "render/gl/llvmpipe.h"

namespace topple::render {
namespace {

// The few names of <GL/osmesa.h> that are used: that header includes <GL/gl.h>, which clashes with
// the core profile's header.
constexpr int k_osmesa_format = 0x22;
constexpr int k_osmesa_depth_bits = 0x30;
constexpr int k_osmesa_profile = 0x33;
constexpr int k_osmesa_core_profile = 0x34;
constexpr int k_osmesa_major_version = 0x36;
constexpr int k_osmesa_minor_version = 0x37;

constexpr const char* k_library = "libOSMesa.so.8";

/// Everything is drawn to framebuffer objects, so the context's own buffer is as small as can be.
constexpr int k_own_buffer_side = 4;

class OsmesaContext final : public Context {
 public:
  OsmesaContext() {
    keep_to_one_thread();
    // Its 1292 gl* symbols must stay local: they would replace those of a GL library.
    void* library = dlopen(k_library, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      const char* why = dlerror();
      throw std::runtime_error(std::string("cannot draw without a display: ") + (why ? why : k_library) +
                               "; install the Debian package libosmesa6");
    }
    const auto create = load<void* (*)(const int*, void*)>(library, "OSMesaCreateContextAttribs");
    destroy_ = load<void (*)(void*)>(library, "OSMesaDestroyContext");
    make_current_ = load<GLboolean (*)(void*, void*, GLenum, GLsizei, GLsizei)>(library, "OSMesaMakeCurrent");
    get_proc_ = load<GetProc>(library, "OSMesaGetProcAddress");
    const int attributes[] = {k_osmesa_format,
                              GL_RGBA,
                              k_osmesa_depth_bits,
                              0,
                              k_osmesa_profile,
                              k_osmesa_core_profile,
                              k_osmesa_major_version,
                              3,
                              k_osmesa_minor_version,
                              3,
                              0};
    context_ = create(attributes, nullptr);
    if (context_ == nullptr) throw std::runtime_error("OSMesa: no OpenGL 3.3 core context could be created");
    try {
      OsmesaContext::make_current();
    } catch (...) {
      destroy_(context_);
      throw;
    }
  }

  // The library stays loaded: Mesa's worker threads may outlive the context.
  ~OsmesaContext() override { destroy_(context_); }

  void make_current() override {
    if (!make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, k_own_buffer_side, k_own_buffer_side)) {
      throw std::runtime_error("OSMesa: the context could not be made current");
    }
  }

  GetProc get_proc() const override { return get_proc_; }

 private:
  template <typename Function>
  static Function load(void* library, const char* name) {
    void* symbol = dlsym(library, name);
    if (symbol == nullptr) {
      throw std::runtime_error(std::string(k_library) + " has no function " + name +
                               "; install libosmesa6 of Debian 12 or newer");
    }
    return reinterpret_cast<Function>(symbol);
  }

  std::array<unsigned char, 4 * k_own_buffer_side * k_own_buffer_side> buffer_{};
  void* context_ = nullptr;
  void (*destroy_)(void*) = nullptr;
  GLboolean (*make_current_)(void*, void*, GLenum, GLsizei, GLsizei) = nullptr;
  GetProc get_proc_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace topple::render
