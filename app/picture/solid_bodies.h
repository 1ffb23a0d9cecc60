// Furniture as it looks in a room: boards, doors, drawers, books, in place of the beams that are computed.
#pragma once

#include <vector>

#include "render/scene/scene_frame.h"
#include "solver/io/recording/observer.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Boards and blocks of one scene.
class SolidBodies {
 public:
  /// Throws io::InputError as pieces_of() does.
  explicit SolidBodies(const io::Scene& scene);

  /// What the bridge drew of `row` as solid furniture: cabinets and blocks become boards with what a kind
  /// shows at its front, members of frames get the colour of their material. Bodies that are broken or of no
  /// kind that looks like something stay as they are.
  void dress(const io::FrameRow& row, render::SceneFrame& frame) const;

 private:
  /// A box, or with `round` a disc whose axis is x, of a body in its reference pose.
  struct Part {
    Vec3 centre, half;  ///< m
    Quat turn;
    render::Float4 colour;
    bool round;
  };
  void add(const Part& part, int body, const io::FrameRow& row, render::SceneFrame& frame) const;

  const Model& model_;
  std::vector<std::vector<Part>> parts_;     ///< of each body
  std::vector<render::Float4> of_material_;  ///< of members of frames
};

}  // namespace topple::app
