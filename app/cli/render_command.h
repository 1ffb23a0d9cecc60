// `topple render`: pictures and videos.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/picture/picture_settings.h"
#include "app/support/language.h"
#include "render/gl/off_screen.h"
#include "render/scene/camera.h"
#include "render/scene/orbit.h"

namespace topple::app {

struct RenderOptions {
  std::string source;                  ///< scene or recording
  std::vector<std::string> overrides;  ///< of a scene
  std::string png, mp4, still;         ///< one of them
  std::optional<double> at;            ///< s, of the still
  int width = 1280, height = 720;
  int fps = 30;
  render::NamedView view = render::NamedView::iso;
  std::optional<render::Orbit> orbit;  ///< instead of `view`; only target, distance and sight are set
  std::optional<std::string> follow;   ///< body the camera goes along with; empty: of `inspect`, or first
  std::optional<double> from, to;      ///< s
  bool ui = false;                     ///< with the panels of the window
  Language language = Language::english;
  PictureSettings picture;  ///< all but `diagram`
  std::string inspect;      ///< BODY or BODY/MEMBER, looked at closely; empty: none
  render::Renderer renderer = render::Renderer::any;
  bool quiet = false;
};
int render_command(const RenderOptions& options);

}  // namespace topple::app
