// From what a run holds to what a picture needs: the one translation, for live frames and for recordings.
#pragma once

#include <functional>
#include <vector>

#include "app/picture/picture_settings.h"
#include "app/picture/run_extent.h"
#include "render/scene/scene_frame.h"
#include "solver/io/recording/recording.h"
#include "solver/io/scene/scene.h"

namespace topple::app {

/// Of an element, its ends among them: its bends look smooth at any size on screen.
inline constexpr int k_stations = 6;

/// Of members of the floor, and of those without stresses.
inline constexpr render::Float4 k_ground_colour = {0.80f, 0.79f, 0.76f, 1},
                                k_rigid_colour = {0.55f, 0.60f, 0.65f, 1};

/// The row at `time` between two neighbours: positions and numbers linear, rotations by the shorter arc.
io::FrameRow blend(const io::FrameRow& a, const io::FrameRow& b, double time);

/// Translates rows of one scene.
class Bridge {
 public:
  /// `tells_ways`: captions tell of people who are hit or have no way out, which takes a millisecond to find.
  Bridge(const io::Scene& scene, const RunExtent& extent, bool tells_ways = true);
  /// `parameters`: those that held at the row; `changed`: as of title_in_words(). Of a row that is not finite
  /// only the floor and words that say so.
  render::SceneFrame frame(const io::FrameRow& row, const Parameters& parameters,
                           const PictureSettings& settings = {}, bool changed = false) const;
  /// The bodies of another row as a ghost in `out`, on the floor of the row beside it.
  void add_ghost(const io::FrameRow& row, const io::FrameRow& beside, const PictureSettings& settings,
                 render::SceneFrame& out) const;
  /// Of its tubes.
  const std::vector<render::Profile>& profiles() const { return profiles_; }
  /// Where the colours of a row end, in the quantity's unit.
  double colour_maximum(const io::FrameRow& row, const PictureSettings& settings) const;

 private:
  using ColourAt = std::function<float(std::size_t element, double t)>;
  ColourAt colours(const io::FrameRow& row, const RigidFit& fit, BeamQuantity quantity) const;
  void add_tubes(const io::FrameRow& row, const ColourAt& colour, std::vector<render::Station>& stations,
                 std::vector<render::Tube>& tubes) const;
  void add_block(const io::FrameRow& row, int body, std::vector<render::Station>& stations,
                 std::vector<render::Tube>& tubes) const;
  float closing(const Member& member, int node) const;
  render::Legend legend(const io::FrameRow& row, const PictureSettings& settings) const;
  void add_grounds(const Vec3& shift, render::SceneFrame& out) const;
  void add_captions(const io::FrameRow& row, const Parameters& parameters, const PictureSettings& settings,
                    bool changed, render::SceneFrame& out) const;

  const io::Scene& scene_;
  const RunExtent& extent_;
  const bool tells_ways_;
  std::vector<render::Profile> profiles_;  ///< one per section, then one per block
  std::vector<std::uint32_t> of_block_;    ///< per body: index of its profile, if it is a block
  std::vector<bool> joint_;  ///< per node: ends of several members, whose sections are drawn through it
};

}  // namespace topple::app
