// Owners of GL objects, and the embedded shaders.
#pragma once

#include <initializer_list>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include "render/gl/gl.h"

namespace topple::render {

/// Text of the shader file of that name (shaders/), embedded at build time; empty when there is none.
std::string_view shader_source(std::string_view name);

/// Owns one GL object; deletes it on destruction, with the context current.
class GlObject {
 public:
  using Delete = void (*)(const Gl&, GLuint);

  GlObject() = default;
  GlObject(const Gl& gl, GLuint id, Delete remove) : gl_(&gl), id_(id), remove_(remove) {}
  GlObject(GlObject&& other) noexcept
      : gl_(other.gl_), id_(std::exchange(other.id_, 0)), remove_(other.remove_) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    std::swap(remove_, other.remove_);
    return *this;
  }
  ~GlObject() {
    if (id_ != 0) remove_(*gl_, id_);
  }
  GLuint id() const { return id_; }

 private:
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
  Delete remove_ = nullptr;
};

GlObject make_buffer(const Gl& gl);
GlObject make_vertex_array(const Gl& gl);

/// A texture in linear filtering, clamped to its edge; `mipmapped` filters between levels too.
struct TextureFormat {
  GLint internal = GL_RGBA8;
  GLenum layout = GL_RGBA;
  GLenum type = GL_UNSIGNED_BYTE;
  bool mipmapped = false;
};
GlObject make_texture(const Gl& gl, const TextureFormat& format, int width, int height, const void* pixels);

/// A renderbuffer; `samples` 0 is a plain one.
GlObject make_renderbuffer(const Gl& gl, GLenum format, int width, int height, int samples);
GlObject make_framebuffer(const Gl& gl);

/// Throws std::runtime_error that names `what` when the bound framebuffer cannot be drawn to.
void check_framebuffer(const Gl& gl, const char* what);

/// A linked shader program.
class Program {
 public:
  /// `fragment_parts` are joined in order (shared functions first). Throws std::runtime_error with
  /// the compiler's log.
  Program(const Gl& gl, std::string_view vertex, std::initializer_list<std::string_view> fragment_parts);

  void use() const { gl_->UseProgram(program_.id()); }

  /// Sets a uniform of the program in use; a name that the program does not have is ignored.
  void set(const char* name, int value) const { gl_->Uniform1i(location(name), value); }
  void set(const char* name, float value) const { gl_->Uniform1f(location(name), value); }
  void set(const char* name, const Eigen::Vector2f& v) const { gl_->Uniform2f(location(name), v.x(), v.y()); }
  void set(const char* name, const Eigen::Vector3f& v) const {
    gl_->Uniform3f(location(name), v.x(), v.y(), v.z());
  }
  void set(const char* name, const Eigen::Vector4f& v) const {
    gl_->Uniform4f(location(name), v.x(), v.y(), v.z(), v.w());
  }
  void set(const char* name, const Eigen::Matrix4f& m) const {
    gl_->UniformMatrix4fv(location(name), 1, GL_FALSE, m.data());
  }

 private:
  GLint location(const char* name) const { return gl_->GetUniformLocation(program_.id(), name); }

  const Gl* gl_;
  GlObject program_;
};

}  // namespace topple::render
