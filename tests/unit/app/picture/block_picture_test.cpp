#include <gtest/gtest.h>

#include <cmath>

#include "app/picture/bridge.h"
#include "solver/io/recording/observer.h"
#include "solver/run/run.h"

namespace topple::app {
namespace {

// Its outline less half of a width is where its edges are; positions of rows are floats.
TEST(BlockPicture, is_one_solid_with_its_surface_half_a_width_outside) {
  const io::Scene scene = io::parse_scene(
      "topple = 1\n[run]\nsettle = false\n[floor]\n[[block]]\nsize = [0.2, 0.3, 0.5]\nmass = 12\nyaw = 0.5\n"
      "tilt = 0.1\nwidth = 0.02\n",
      "s.toml");
  const topple::Run run(scene.setup);
  const io::FrameRow row = io::frame_row(run);
  RunExtent extent;
  const Model& model = scene.setup.model;
  extent.add(scene.setup, scene.setup.parameters, row);
  PictureSettings settings;
  settings.panels = true;
  const Bridge bridge(scene, extent);
  render::SceneFrame frame = bridge.frame(row, scene.setup.parameters, settings);
  bridge.add_ghost(row, row, settings, frame);
  ASSERT_EQ(frame.tubes.size(), 1u);
  EXPECT_EQ(frame.ghost_tubes.size(), 1u);
  EXPECT_TRUE(frame.panels.empty());
  const render::Tube& tube = frame.tubes[0];
  ASSERT_EQ(tube.station_count, 2u);
  EXPECT_FLOAT_EQ(tube.lead, 0.01f);
  EXPECT_FLOAT_EQ(tube.trail, 0.01f);
  const auto& outline = frame.profiles[tube.profile].outline;
  ASSERT_EQ(outline.size(), 4u);
  for (std::uint32_t end = 0; end < 2; ++end) {
    const render::Station& at = frame.stations[tube.first_station + end];
    const Quat q(at.rotation[0], at.rotation[1], at.rotation[2], at.rotation[3]);
    for (int k = 0; k < 4; ++k) {
      const double y = outline[k][0], z = outline[k][1];
      const Vec3 edge = Vec3(at.position[0], at.position[1], at.position[2]) +
                        q * Vec3(0, y - std::copysign(0.01, y), z - std::copysign(0.01, z));
      const int node = model.panels[end].node[k];
      EXPECT_LT((edge - Vec3(row.position[3 * node], row.position[3 * node + 1], row.position[3 * node + 2]))
                    .norm(),
                1e-6);
    }
  }
}

}  // namespace
}  // namespace topple::app
