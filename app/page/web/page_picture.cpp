#include "app/page/web/page_picture.h"

#include <GLES3/gl3.h>
#include <emscripten/html5.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace topple::app {
namespace {

RunExtent extent_of(const io::Scene& scene, const std::vector<io::FrameRow>& rows,
                    std::vector<PlaceOutcome> hits) {
  RunExtent extent;
  for (const io::FrameRow& row : rows) extent.add(scene.setup, scene.setup.parameters, row);
  extent.hits = std::move(hits);
  return extent;
}

/// Functions of WebGL2: all that the painter calls.
render::Gl web_gl() {
  render::Gl gl;
  gl.shader_head =
      "#version 300 es\n"
      "precision highp float;\nprecision highp int;\nprecision highp sampler2DShadow;\n";
  gl.ActiveTexture = glActiveTexture;
  gl.AttachShader = glAttachShader;
  gl.BindBuffer = glBindBuffer;
  gl.BindFramebuffer = glBindFramebuffer;
  gl.BindRenderbuffer = glBindRenderbuffer;
  gl.BindTexture = glBindTexture;
  gl.BindVertexArray = glBindVertexArray;
  gl.BlendEquation = glBlendEquation;
  gl.BlendFuncSeparate = glBlendFuncSeparate;
  gl.BufferData = glBufferData;
  gl.BlitFramebuffer = glBlitFramebuffer;
  gl.CheckFramebufferStatus = glCheckFramebufferStatus;
  gl.Clear = glClear;
  gl.ClearColor = glClearColor;
  gl.CompileShader = glCompileShader;
  gl.CreateProgram = glCreateProgram;
  gl.CreateShader = glCreateShader;
  gl.DeleteBuffers = glDeleteBuffers;
  gl.DeleteFramebuffers = glDeleteFramebuffers;
  gl.DeleteProgram = glDeleteProgram;
  gl.DeleteShader = glDeleteShader;
  gl.DeleteTextures = glDeleteTextures;
  gl.DeleteVertexArrays = glDeleteVertexArrays;
  gl.DepthFunc = glDepthFunc;
  gl.DepthMask = glDepthMask;
  gl.Disable = glDisable;
  gl.DrawArrays = glDrawArrays;
  gl.DrawBuffers = glDrawBuffers;
  gl.DrawElements = glDrawElements;
  gl.Enable = glEnable;
  gl.EnableVertexAttribArray = glEnableVertexAttribArray;
  gl.FramebufferTexture2D = glFramebufferTexture2D;
  gl.GenBuffers = glGenBuffers;
  gl.GenerateMipmap = glGenerateMipmap;
  gl.GenFramebuffers = glGenFramebuffers;
  gl.GenTextures = glGenTextures;
  gl.GenVertexArrays = glGenVertexArrays;
  gl.GetError = glGetError;
  gl.GetProgramInfoLog = glGetProgramInfoLog;
  gl.GetProgramiv = glGetProgramiv;
  gl.GetShaderInfoLog = glGetShaderInfoLog;
  gl.GetShaderiv = glGetShaderiv;
  gl.GetUniformLocation = glGetUniformLocation;
  gl.LinkProgram = glLinkProgram;
  gl.PixelStorei = glPixelStorei;
  gl.PolygonOffset = glPolygonOffset;
  gl.Scissor = glScissor;
  gl.ShaderSource = glShaderSource;
  gl.TexImage2D = glTexImage2D;
  gl.TexParameteri = glTexParameteri;
  gl.Uniform1f = glUniform1f;
  gl.Uniform1i = glUniform1i;
  gl.Uniform2f = glUniform2f;
  gl.Uniform3f = glUniform3f;
  gl.Uniform4f = glUniform4f;
  gl.UniformMatrix4fv = glUniformMatrix4fv;
  gl.UseProgram = glUseProgram;
  gl.VertexAttribPointer = glVertexAttribPointer;
  gl.Viewport = glViewport;
  return gl;
}

/// A context and its painter.
struct WebPainter {
  explicit WebPainter(const std::string& canvas) {
    EmscriptenWebGLContextAttributes wanted;
    emscripten_webgl_init_context_attributes(&wanted);
    wanted.majorVersion = 2;
    wanted.antialias = true;
    wanted.alpha = false;
    context = emscripten_webgl_create_context(canvas.c_str(), &wanted);
    if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS)
      throw std::runtime_error("this browser has no WebGL2");
    gl = web_gl();
    painter = std::make_unique<render::ScenePainter>(gl);
  }
  EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context = 0;
  render::Gl gl;
  std::unique_ptr<render::ScenePainter> painter;
};

}  // namespace

PagePicture::PagePicture(const io::Scene& scene, std::vector<io::FrameRow> rows,
                         std::vector<PlaceOutcome> hits)
    : scene_(scene),
      rows_(std::move(rows)),
      extent_(extent_of(scene, rows_, std::move(hits))),
      bridge_(scene, extent_) {
  at(rows_.front().time, 0);
}

const render::SceneFrame& PagePicture::at(double time, int colour) {
  const auto after = std::lower_bound(rows_.begin(), rows_.end(), time,
                                      [](const io::FrameRow& row, double t) { return row.time < t; });
  const io::FrameRow row = after == rows_.begin() ? rows_.front()
                           : after == rows_.end() ? rows_.back()
                                                  : blend(*(after - 1), *after, time);
  PictureSettings settings;
  const auto known = static_cast<int>(beam_quantities().size());
  settings.colour = beam_quantities()[static_cast<std::size_t>(std::clamp(colour, 0, known - 1))].kind;
  frame_ = bridge_.frame(row, scene_.setup.parameters, settings);
  return frame_;
}

render::Orbit& orbit() {
  static render::Orbit one;
  return one;
}

void look_from(const PagePicture& picture, int view, double aspect) {
  orbit() = render::Orbit::fit(static_cast<render::NamedView>(std::clamp(view, 0, 3)), picture.frame(),
                               static_cast<float>(aspect));
}

render::ColourMap map_of(bool is_signed, bool dark) {
  return is_signed ? render::ColourMap::diverging
         : dark    ? render::ColourMap::viridis_on_dark
                   : render::ColourMap::viridis;
}

void draw_picture(const PagePicture& picture, const std::string& canvas, int width, int height, bool dark,
                  render::Quality quality) {
  static std::unique_ptr<WebPainter> one;
  if (!one) one = std::make_unique<WebPainter>(canvas);
  if (width < 1 || height < 1) return;
  render::SceneFrame frame = picture.frame();
  frame.dark = dark;
  render::LeftOut left_out;
  one->painter->draw(frame, orbit().camera(static_cast<float>(width) / static_cast<float>(height)),
                     map_of(frame.legend.is_signed, dark), quality, {0, width, height}, left_out);
}

}  // namespace topple::app
