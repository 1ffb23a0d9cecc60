#include "solver/model/block.h"

#include "unit/solver/fixtures.h"

namespace topple::test {
namespace {

BlockSpec brick() {
  BlockSpec spec;
  spec.name = "brick";
  spec.size = Vec3(0.2, 0.3, 0.5);
  spec.mass = 12;
  spec.cg = Vec3(0.03, -0.05, 0.2);
  return spec;
}

// One node carries them, so that only the turn to the world's axes rounds.
TEST(Block, has_its_mass_centre_and_inertia) {
  for (const PoseTraits& pose : k_poses)
    for (const bool given : {false, true}) {
      BlockSpec spec = brick();
      spec.pose = pose.kind;
      spec.yaw = 0.7;
      spec.at = Vec3(1, -2, 0.4);
      if (given) spec.inertia = Vec3(0.3, 0.2, 0.15);
      const Vec3 own = given ? *spec.inertia : Vec3(0.09 + 0.25, 0.04 + 0.25, 0.04 + 0.09);  // 12 kg / 12
      Model model;
      add_block(model, spec);
      const Body& body = model.bodies[0];
      const Placing to_world = place(spec, spec.size, contact_width_of(spec.size));
      const Mat3 inertia = to_world.rotation * own.asDiagonal() * to_world.rotation.transpose();
      EXPECT_EQ(body.mass, 12) << pose.word;
      EXPECT_LT((body.centre_of_gravity - to_world(spec.cg)).norm(), 1e-12) << pose.word;
      EXPECT_LT((body.inertia - inertia).norm(), 1e-12) << pose.word;
      EXPECT_TRUE(body.solid);
      EXPECT_EQ(body.element_count, 24);
      EXPECT_EQ(body.panel_count, 6);
    }
}

TEST(Block, stands_on_its_surface_and_touches_with_its_width) {
  for (const double width : {0., 0.008}) {
    BlockSpec spec = brick();
    spec.at.z() = 0.4;
    spec.width = width;
    const double own = width > 0 ? width : 0.01;  // a twentieth of 0.2 m
    Model model;
    add_block(model, spec);
    const Body& body = model.bodies[0];
    EXPECT_EQ(body.contact_point_count, 8);
    ASSERT_EQ(body.base_points.size(), 4u);
    for (const int p : body.base_points) {
      EXPECT_DOUBLE_EQ(model.contact_points[p].width, own);
      EXPECT_NEAR(model.node_position[model.contact_points[p].node].z(), 0.4 + own / 2, 1e-15);
    }
    for (const Panel& panel : model.panels) EXPECT_DOUBLE_EQ(panel.width, own);
  }
  EXPECT_EQ(contact_width_of(Vec3(3, 2, 1)), 0.02);
}

TEST(Block, base_of_edges_adds_the_middles_of_edges_and_faces) {
  BlockSpec spec = brick();
  spec.base = BlockSpec::Base::edges;
  spec.cg = Vec3(0, 0, 0.25);
  Model model;
  add_block(model, spec);
  EXPECT_EQ(model.bodies[0].contact_point_count, 8 + 12 + 6);
  EXPECT_EQ(model.bodies[0].base_points.size(), 4u + 4 + 1);
}

TEST(Block, what_cannot_be_built_blames_its_key) {
  struct Case {
    const char* key;
    const char* says;
    void (*spoil)(BlockSpec&);
  };
  const Case cases[] = {
      {"cg", "x = 100 mm is not inside the block, which reaches from -100 mm to 100 mm",
       [](BlockSpec& spec) { spec.cg.x() = 0.1; }},
      {"cg", "y = -151 mm is not inside the block, which reaches from -150 mm to 150 mm",
       [](BlockSpec& spec) { spec.cg.y() = -0.151; }},
      {"cg", "z = 0 mm is not inside the block, which reaches from 0 mm to 500 mm",
       [](BlockSpec& spec) { spec.cg.z() = 0; }},
      {"inertia",
       "no mass distribution has this inertia: each value must be less than the other two together",
       [](BlockSpec& spec) { spec.inertia = Vec3(1, 1, 2.01); }},
      {"width", "201 mm is more than the smallest side, 200 mm", [](BlockSpec& spec) { spec.width = 0.201; }},
  };
  for (const Case& one : cases) {
    BlockSpec spec = brick();
    one.spoil(spec);
    Model model;
    try {
      add_block(model, spec);
      ADD_FAILURE() << one.says;
    } catch (const BuildError& error) {
      EXPECT_EQ(error.key, one.key);
      EXPECT_STREQ(error.what(), one.says);
    }
  }
}

}  // namespace
}  // namespace topple::test
