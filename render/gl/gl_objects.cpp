#include "render/gl/gl_objects.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace topple::render {
namespace {

GlObject compile(const Gl& gl, GLenum stage, const std::vector<std::string_view>& names) {
  GlObject shader(gl, gl.CreateShader(stage), [](const Gl& g, GLuint id) { g.DeleteShader(id); });
  std::vector<const char*> texts{gl.shader_head.data()};
  std::vector<GLint> lengths{static_cast<GLint>(gl.shader_head.size())};
  std::string all_names;
  for (const std::string_view name : names) {
    const std::string_view source = shader_source(name);
    texts.push_back(source.data());
    lengths.push_back(static_cast<GLint>(source.size()));
    all_names.append(name).append(" ");
  }
  gl.ShaderSource(shader.id(), static_cast<GLsizei>(texts.size()), texts.data(), lengths.data());
  gl.CompileShader(shader.id());
  GLint compiled = 0;
  gl.GetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader " + all_names + "does not compile:\n" + log);
  }
  return shader;
}

}  // namespace

GlObject make_buffer(const Gl& gl) {
  GLuint id = 0;
  gl.GenBuffers(1, &id);
  return {gl, id, [](const Gl& g, GLuint name) { g.DeleteBuffers(1, &name); }};
}

GlObject make_vertex_array(const Gl& gl) {
  GLuint id = 0;
  gl.GenVertexArrays(1, &id);
  return {gl, id, [](const Gl& g, GLuint name) { g.DeleteVertexArrays(1, &name); }};
}

GlObject make_texture(const Gl& gl, const TextureFormat& format, int width, int height, const void* pixels) {
  GLuint id = 0;
  gl.GenTextures(1, &id);
  GlObject texture{gl, id, [](const Gl& g, GLuint name) { g.DeleteTextures(1, &name); }};
  gl.BindTexture(GL_TEXTURE_2D, id);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, format.internal, width, height, 0, format.layout, format.type, pixels);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                   format.mipmapped ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

GlObject make_renderbuffer(const Gl& gl, GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  gl.GenRenderbuffers(1, &id);
  GlObject buffer{gl, id, [](const Gl& g, GLuint name) { g.DeleteRenderbuffers(1, &name); }};
  gl.BindRenderbuffer(GL_RENDERBUFFER, id);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
  return buffer;
}

GlObject make_framebuffer(const Gl& gl) {
  GLuint id = 0;
  gl.GenFramebuffers(1, &id);
  return {gl, id, [](const Gl& g, GLuint name) { g.DeleteFramebuffers(1, &name); }};
}

void check_framebuffer(const Gl& gl, const char* what) {
  if (const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER); status != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(std::string("OpenGL: cannot draw to the ") + what + " (framebuffer status " +
                             std::to_string(status) + ")");
  }
}

Program::Program(const Gl& gl, std::string_view vertex,
                 std::initializer_list<std::string_view> fragment_parts)
    : gl_(&gl), program_(gl, gl.CreateProgram(), [](const Gl& g, GLuint id) { g.DeleteProgram(id); }) {
  const GlObject vertex_shader = compile(gl, GL_VERTEX_SHADER, {vertex});
  const GlObject fragment_shader = compile(gl, GL_FRAGMENT_SHADER, fragment_parts);
  gl.AttachShader(program_.id(), vertex_shader.id());
  gl.AttachShader(program_.id(), fragment_shader.id());
  gl.LinkProgram(program_.id());
  GLint linked = 0;
  gl.GetProgramiv(program_.id(), GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program_.id(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader program of " + std::string(vertex) + " does not link:\n" + log);
  }
}

}  // namespace topple::render
