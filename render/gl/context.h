// An off-screen OpenGL context. What draws knows only its get-proc function.
#pragma once

#include "render/gl/gl.h"

namespace topple::render {

/// A 3.3 core context without a window. Everything drawn goes to framebuffer objects. It must
/// outlive whatever was made with its functions, and must stay on the thread that made it current.
class Context {
 public:
  virtual ~Context() = default;
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes the context current on the calling thread. Throws std::runtime_error.
  virtual void make_current() = 0;
  virtual GetProc get_proc() const = 0;
};

}  // namespace topple::render
