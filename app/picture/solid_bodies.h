// Furniture as it looks in a room: boards, doors, drawers, books, in place of the beams that are computed or
// between them.
#pragma once

#include <vector>

#include "app/picture/picture_settings.h"
#include "render/scene/scene_frame.h"
#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// How a person who opens the scene sees it at first: furniture by name as it looks where motion alone is
/// wanted, else beams. Throws io::InputError as pieces_of() does.
Bodies usual_bodies(const io::Scene& scene);

/// Boards and blocks of one scene.
class SolidBodies {
 public:
  /// `bodies`: drawn with boards. Throws io::InputError as pieces_of() does.
  SolidBodies(const io::Scene& scene, Bodies bodies);
  Bodies bodies() const { return bodies_; }

  /// What the bridge drew of `row` as solid furniture: cabinets and blocks become boards with what a kind
  /// shows at its front, members of frames get the colour of their material. Bodies that are broken or of no
  /// kind that looks like something stay as they are. Where beams are drawn, too, they stand out of the
  /// boards by half of what they are thick, and keep their colours; else there is no legend.
  void dress(const io::FrameRow& row, render::SceneFrame& frame) const;

 private:
  /// A box, or with `round` a disc whose axis is x, of a body in its reference pose.
  struct Part {
    Vec3 centre, half;  ///< m
    Quat turn;
    render::Float4 colour;
    bool round;
  };
  void take_beams_away(const std::vector<bool>& solid, render::SceneFrame& frame) const;
  void add(const Part& part, int body, const io::FrameRow& row, render::SceneFrame& frame) const;

  const Model& model_;
  const Bodies bodies_;
  std::vector<std::vector<Part>> parts_;     ///< of each body
  std::vector<render::Float4> of_material_;  ///< of members of frames
};

}  // namespace topple::app
