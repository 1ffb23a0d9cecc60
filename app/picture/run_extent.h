// What pictures of one run share.
#pragma once

#include <array>
#include <vector>

#include "app/picture/beam_quantity.h"
#include "render/scene/scene_frame.h"
#include "solver/io/recording/observer.h"
#include "solver/model/parameters.h"
#include "solver/run/place_hits.h"
#include "solver/run/run.h"

namespace topple::app {

/// A body's centre of gravity and the middle of its top, m, in the picture's frame.
using BodyPoints = std::array<render::Float3, 2>;
BodyPoints body_points(const Model& model, const io::FrameRow& row, std::size_t body);

/// At one contact point, N.
double greatest_contact_force(const io::FrameRow& row);

/// The ranges of the colours, the space that bodies move through, their paths, and the traces of the floor
/// and of the load factor. Rows are added one after the other; add() throws io::InputError on a row of
/// another model, such as an older version may have built from the same scene.
class RunExtent {
 public:
  void add(const Setup& setup, const Parameters& parameters, const io::FrameRow& row);
  /// Leaves older instants out; the box stays.
  void thin();

  /// Top of a colour scale, SI: few instants of the run have a greater value anywhere, so that an impact of
  /// milliseconds does not darken all the rest.
  double top(BeamQuantity quantity) const;
  /// The same of the force at one contact point, N.
  double contact_force_top() const;

  /// Of a furniture body, at way[row].
  const BodyPoints& points(std::size_t row, std::size_t body) const { return points_[row * bodies_ + body]; }

  Vec3 low = Vec3::Constant(1e30), high = -low;  ///< m, box of the furniture's nodes, with the floor's way
  std::vector<float> time_s, acceleration_gal;   ///< along the first shake's direction
  std::vector<float> way, load_factor;           ///< per row: State::time of a static run, and its loads
  std::vector<PlaceOutcome> hits;                ///< one per place of the room

 private:
  std::vector<std::vector<double>> peak_;  ///< SI, of each quantity and row
  std::vector<double> peak_contact_;       ///< N, likewise
  std::vector<BodyPoints> points_;
  std::size_t bodies_ = 0;
};

}  // namespace topple::app
