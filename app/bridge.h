// From what a run holds to what a picture needs: the one translation, for live frames and for recordings.
#pragma once

#include <string>
#include <vector>

#include "render/scene_frame.h"
#include "solver/io/recording.h"
#include "solver/io/scene.h"

namespace topple::app {

/// What pictures of one run share: the range of the colours, the space that bodies move through and the
/// traces of the floor and of the load factor. Rows are added one after the other; add() throws
/// io::InputError on a row of another model, such as an older version may have built from the same scene.
class RunExtent {
 public:
  void add(const Model& model, const Parameters& parameters, const io::FrameRow& row);

  /// Top of the colour scale, Pa: few instants of the run have a greater stress anywhere, so that an impact
  /// of milliseconds does not darken all the rest.
  double colour_top() const;

  Vec3 low = Vec3::Constant(1e30), high = -low;  ///< m, box of the furniture's nodes, with the floor's way
  std::vector<float> time_s, acceleration_gal;   ///< along the first shake's direction
  std::vector<float> way, load_factor;           ///< per row: State::time of a static run, and its loads

 private:
  std::vector<double> peak_stress_;  ///< Pa, of each row
};

/// Section forces of element `e` at xi in -1..1 along it.
SectionForces forces_at(const Model& model, const io::FrameRow& row, std::size_t e, double xi);

/// The row at `time` between two neighbours: positions and numbers linear, rotations by the shorter arc.
io::FrameRow blend(const io::FrameRow& a, const io::FrameRow& b, double time);

struct Curve;

/// Translates rows of one scene.
class Bridge {
 public:
  Bridge(const io::Scene& scene, const RunExtent& extent);
  /// `parameters`: those that held at the row.
  render::SceneFrame frame(const io::FrameRow& row, const Parameters& parameters) const;
  /// The bodies of another row as a ghost in `out`.
  void add_ghost(const io::FrameRow& row, render::SceneFrame& out) const;

 private:
  void add_tubes(const io::FrameRow& row, std::vector<render::Station>& stations,
                 std::vector<render::Tube>& tubes) const;
  float closing(const Member& member, int node) const;
  Curve curve_of(const io::FrameRow& row, std::size_t e, const Vec3& shift) const;
  void add_hinges(const io::FrameRow& row, render::SceneFrame& out) const;
  void add_grounds(const Vec3& shift, render::SceneFrame& out) const;
  void add_captions(const io::FrameRow& row, const Parameters& parameters, render::SceneFrame& out) const;

  const io::Scene& scene_;
  const RunExtent& extent_;
  std::vector<render::Profile> profiles_;  ///< one per section
  std::vector<bool> joint_;  ///< per node: ends of several members, whose sections are drawn through it
};

}  // namespace topple::app
