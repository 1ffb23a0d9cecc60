// The hand that pulls a body with the mouse while it runs.
#pragma once

#include <optional>
#include <string>

#include "app/live/player.h"
#include "render/scene/pick.h"

namespace topple::app {

/// A damped spring from a node of a body to the mouse (add_pulls: length and strength), which the run knows
/// as the edits of a dead force.
class Hand {
 public:
  explicit Hand(Player& player) : player_(player) {}

  /// Takes hold of the node that is nearest to what was picked in `frame`. Empty, or why not, in words.
  std::string grab(const render::SceneFrame& frame, const render::Pick& pick);
  /// Pulls towards the mouse, which is at x, y in a picture of width x height px; as far away from the camera
  /// as the node.
  void pull(const render::Camera& camera, float width, float height, float x, float y);
  /// What pulls and is not held any more, as after a return to an instant in which it was, pulls no more.
  void let_go();
  bool holds() const { return held_.has_value(); }
  /// What it does, for the status line.
  std::string words() const;

 private:
  struct Held {
    int node;
    Vec3 force;  // N, as last asked for
    Vec3 at;     // m, of the node in the floor's frame, at `time`, s
    double time;
    Vec3 velocity;  // m/s
  };

  Player& player_;
  std::optional<Held> held_;
};

}  // namespace topple::app
