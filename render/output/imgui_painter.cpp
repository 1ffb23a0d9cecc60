#include "render/output/imgui_painter.h"

#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace topple::render {
namespace {

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

ImTextureID texture_id(const GlObject& texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.id()));
}

constexpr GLenum k_index_type = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;

}  // namespace

ImguiPainter::ImguiPainter(const Gl& gl)
    : gl_(gl),
      program_(gl, "imgui.vert", {"imgui.frag"}),
      array_(make_vertex_array(gl)),
      vertices_(make_buffer(gl)),
      indices_(make_buffer(gl)) {
  gl.BindVertexArray(array_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(ImDrawVert), offset(offsetof(ImDrawVert, pos)));
  gl.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(ImDrawVert), offset(offsetof(ImDrawVert, uv)));
  gl.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ImDrawVert),
                         offset(offsetof(ImDrawVert, col)));
  for (GLuint i = 0; i < 3; ++i) gl.EnableVertexAttribArray(i);
  gl.BindVertexArray(0);
}

void ImguiPainter::upload_fonts(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0;
  int height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  gl_.ActiveTexture(GL_TEXTURE0);
  font_texture_ = make_texture(gl_, {}, width, height, pixels);
  atlas.SetTexID(texture_id(font_texture_));
}

void* ImguiPainter::keep(const Image& image) {
  gl_.ActiveTexture(GL_TEXTURE0);
  pictures_.push_back(make_texture(gl_, {}, image.width, image.height, image.rgba.data()));
  return texture_id(pictures_.back());
}

void ImguiPainter::draw(const ImDrawData& data, const Target& target) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.width, target.height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  program_.use();
  program_.set("u_origin", Eigen::Vector2f(data.DisplayPos.x, data.DisplayPos.y));
  program_.set("u_size", Eigen::Vector2f(data.DisplaySize.x, data.DisplaySize.y));
  program_.set("u_texture", 0);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindVertexArray(array_.id());
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                   GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
        continue;
      }
      const ImVec2 scale = data.FramebufferScale;
      const auto clip_x = static_cast<GLint>((command.ClipRect.x - data.DisplayPos.x) * scale.x);
      const auto clip_y = static_cast<GLint>((command.ClipRect.y - data.DisplayPos.y) * scale.y);
      const auto clip_right = static_cast<GLint>((command.ClipRect.z - data.DisplayPos.x) * scale.x);
      const auto clip_bottom = static_cast<GLint>((command.ClipRect.w - data.DisplayPos.y) * scale.y);
      if (clip_right <= clip_x || clip_bottom <= clip_y) continue;
      gl_.Scissor(clip_x, target.height - clip_bottom, clip_right - clip_x, clip_bottom - clip_y);
      gl_.BindTexture(GL_TEXTURE_2D,
                      static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())));
      gl_.DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), k_index_type,
                                 offset(command.IdxOffset * sizeof(ImDrawIdx)),
                                 static_cast<GLint>(command.VtxOffset));
    }
  }
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Disable(GL_BLEND);
  gl_.BindVertexArray(0);
}

}  // namespace topple::render
