#include "render/gl/egl_context.h"

#include <dlfcn.h>

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "render/gl/llvmpipe.h"

namespace topple::render {
namespace {

// The few names of <EGL/egl.h> and <EGL/eglext.h> that are used, so that building needs no headers of a
// library that is loaded while the program runs.
using Display = void*;
using Config = void*;
using Surface = void*;
using EglContextHandle = void*;
using Boolean = unsigned;
using Enum = unsigned;
constexpr Enum k_platform_surfaceless = 0x31DD;
constexpr Enum k_opengl_api = 0x30A2;
constexpr int k_major_version = 0x3098;
constexpr int k_minor_version = 0x30FB;
constexpr int k_profile_mask = 0x30FD;
constexpr int k_core_profile = 1;
constexpr int k_none = 0x3038;

constexpr const char* k_library = "libEGL.so.1";
constexpr const char* k_install = "; install the Debian packages libegl1 and libegl-mesa0";

template <typename Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr)
    throw std::runtime_error(std::string(k_library) + " has no function " + name + k_install);
}

class EglContext final : public Context {
 public:
  EglContext() {
    keep_to_one_thread();
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);  // the same bytes whatever graphics card there is
    void* library = dlopen(k_library, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      const char* why = dlerror();
      throw std::runtime_error(std::string("cannot draw without a display: ") + (why ? why : k_library) +
                               k_install);
    }
    Display (*get_display)(Enum, void*, const std::intptr_t*);
    Boolean (*initialize)(Display, int*, int*);
    Boolean (*bind_api)(Enum);
    EglContextHandle (*create)(Display, Config, EglContextHandle, const int*);
    find(library, "eglGetPlatformDisplay", get_display);
    find(library, "eglInitialize", initialize);
    find(library, "eglBindAPI", bind_api);
    find(library, "eglCreateContext", create);
    find(library, "eglMakeCurrent", make_current_);
    find(library, "eglDestroyContext", destroy_);
    find(library, "eglTerminate", terminate_);
    find(library, "eglGetProcAddress", get_proc_);
    display_ = get_display(k_platform_surfaceless, nullptr, nullptr);
    if (display_ == nullptr || !initialize(display_, nullptr, nullptr))
      throw std::runtime_error(std::string("EGL: no surfaceless platform") + k_install);
    const int attributes[] = {k_major_version, 3, k_minor_version, 3, k_profile_mask, k_core_profile, k_none};
    if (bind_api(k_opengl_api)) context_ = create(display_, nullptr, nullptr, attributes);
    if (context_ == nullptr) {
      terminate_(display_);
      throw std::runtime_error("EGL: no OpenGL 3.3 core context could be created");
    }
    try {
      EglContext::make_current();
    } catch (...) {
      close();
      throw;
    }
  }

  ~EglContext() override { close(); }

  void make_current() override {
    if (!make_current_(display_, nullptr, nullptr, context_))
      throw std::runtime_error("EGL: the context could not be made current without a surface");
  }

  GetProc get_proc() const override { return get_proc_; }

 private:
  // The library stays loaded: Mesa's worker threads may outlive the context.
  void close() {
    make_current_(display_, nullptr, nullptr, nullptr);
    destroy_(display_, context_);
    terminate_(display_);
  }

  Display display_ = nullptr;
  EglContextHandle context_ = nullptr;
  Boolean (*make_current_)(Display, Surface, Surface, EglContextHandle) = nullptr;
  Boolean (*destroy_)(Display, EglContextHandle) = nullptr;
  Boolean (*terminate_)(Display) = nullptr;
  GetProc get_proc_ = nullptr;
};

}  // namespace

std::unique_ptr<Context> make_egl_context() {
  return std::make_unique<EglContext>();
}

}  // namespace topple::render
