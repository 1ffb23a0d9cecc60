// Draws Dear ImGui's lists with the own function table: the same for a window and off screen.
#pragma once

#include <vector>

#include "render/gl/gl.h"
#include "render/gl/gl_objects.h"
#include "render/output/image.h"
#include "render/scene/scene_painter.h"

struct ImDrawData;
struct ImFontAtlas;

namespace topple::render {

/// Any call needs the context current that it was made in; `gl` must outlive it.
class ImguiPainter {
 public:
  explicit ImguiPainter(const Gl& gl);

  /// Bakes and uploads the atlas; call again when its fonts change.
  void upload_fonts(ImFontAtlas& atlas);

  /// Keeps a picture as a texture; returns its ImTextureID.
  void* keep(const Image& image);

  /// Draws over what the target shows. An ImTextureID is the texture's GL name.
  void draw(const ImDrawData& data, const Target& target);

 private:
  const Gl& gl_;
  Program program_;
  GlObject array_, vertices_, indices_, font_texture_;
  std::vector<GlObject> pictures_;
};

}  // namespace topple::render
