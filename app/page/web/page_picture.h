// A run as a live page shows it: its rows by time, drawn by the program's painter on WebGL2.
#pragma once

#include <string>
#include <vector>

#include "app/picture/bridge.h"
#include "app/picture/run_extent.h"
#include "render/scene/orbit.h"
#include "render/scene/scene_painter.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

class PagePicture {
 public:
  /// The scene must outlive it. rows: finite, at least one. hits: one per place of the room.
  PagePicture(const io::Scene& scene, std::vector<io::FrameRow> rows, std::vector<PlaceOutcome> hits);
  /// The picture at `time`, s, which stays until the next call. colour: place in beam_quantities().
  const render::SceneFrame& at(double time, int colour);
  const render::SceneFrame& frame() const { return frame_; }

 private:
  const io::Scene& scene_;
  std::vector<io::FrameRow> rows_;
  RunExtent extent_;
  Bridge bridge_;
  render::SceneFrame frame_;
};

/// The camera, which stays when another run is shown.
render::Orbit& orbit();
/// view: a render::NamedView.
void look_from(const PagePicture& picture, int view, double aspect);

render::ColourMap map_of(bool is_signed, bool dark);

/// Draws the picture's frame(). Throws std::runtime_error where WebGL2 is missing or fails.
void draw_picture(const PagePicture& picture, const std::string& canvas, int width, int height, bool dark,
                  render::Quality quality);

}  // namespace topple::app
