// [[block]]: what a scene makes of it, and one line for each thing that is wrong with it.
#include "scene_samples.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/edit/scene_save.h"

namespace topple::io {
namespace {

const std::string k_block =
    "[[block]]\n"
    "name = \"box\"\n"
    "size = [\"200 mm\", \"300 mm\", \"500 mm\"]\n"
    "mass = 12\n";

/// 5 lines; what is appended belongs to the block and begins in line 6.
std::string scene(const std::string& lines) {
  return k_head + k_block + lines;
}
std::string in_block(const std::string& lines) {
  return error_of(scene(lines));
}

TEST(SceneBlock, needs_no_more_than_size_and_mass) {
  const topple::Setup setup = parse_scene(scene(""), "s.toml").setup;
  ASSERT_EQ(setup.model.bodies.size(), 1u);
  const Body& body = setup.model.bodies[0];
  EXPECT_EQ(body.name, "box");
  EXPECT_TRUE(body.solid);
  EXPECT_EQ(body.mass, 12);
  EXPECT_LT((body.centre_of_gravity - Vec3(0, 0, 0.25 + 0.005)).norm(), 1e-15);
  EXPECT_LT((body.inertia.diagonal() - Vec3(0.34, 0.29, 0.13)).norm(), 1e-14);
  EXPECT_EQ(setup.model.contact_points.front().width, 0.01);
  EXPECT_EQ(setup.parameters.models, std::vector{BodyModel::automatic});
}

TEST(SceneBlock, reads_every_key) {
  const topple::Setup setup =
      parse_scene(scene("cg = [\"10 mm\", \"-20 mm\", \"200 mm\"]\ninertia = [0.3, 0.2, 0.15]\n"
                        "at = [1, 2, 0.3]\nyaw = \"90 deg\"\npose = \"on-back\"\ntilt = \"3 deg\"\n"
                        "velocity = [1, 0, 0]\nangular_velocity = [0, 0, 2]\nwidth = \"8 mm\"\n"
                        "base = \"edges\"\ncopies = [[0, 0, 0], [2, 0, 0]]\nmodel = \"rigid\"\n"
                        "[run]\nsettle = false\n"),
                  "s.toml")
          .setup;
  ASSERT_EQ(setup.model.bodies.size(), 2u);
  EXPECT_EQ(setup.model.bodies[1].name, "box-2");
  const Body& body = setup.model.bodies[0];
  // on its back its height lies along -x, its depth is up; then a quarter turn
  EXPECT_LT((body.centre_of_gravity - Vec3(1 + 0.02, 2 + 0.05, 0.3 + 0.004 + 0.1 + 0.01)).norm(), 1e-14);
  EXPECT_LT((body.inertia.diagonal() - Vec3(0.2, 0.15, 0.3)).norm(), 1e-14);
  EXPECT_EQ(body.contact_point_count, 26);
  EXPECT_EQ(setup.starts[1].velocity, Vec3(1, 0, 0));
  EXPECT_EQ(setup.starts[1].angular_velocity, Vec3(0, 0, 2));
  EXPECT_NEAR(setup.starts[0].rotation.norm(), 3 * k_pi / 180, 1e-15);
  EXPECT_EQ(setup.parameters.models, std::vector(2, BodyModel::rigid));
}

TEST(SceneBlock, stands_after_cabinets_and_frames) {
  const topple::Setup setup =
      parse_scene(replaced(k_cabinet_scene, "[[cabinet]]", k_block + "at = [3, 0]\n[[cabinet]]"), "s.toml")
          .setup;
  ASSERT_EQ(setup.model.bodies.size(), 2u);
  EXPECT_EQ(setup.model.bodies[0].name, "free");
  EXPECT_EQ(setup.model.bodies[1].name, "box");
  EXPECT_EQ(setup.parameters.models[1], BodyModel::automatic);
}

TEST(SceneBlock, what_is_wrong_with_it_is_one_line) {
  EXPECT_EQ(error_of(replaced(scene(""), "\"200 mm\"", "0")),
            "s.toml:4:9: block.box.size.1: 0 m is outside 1..10000 mm");
  EXPECT_EQ(error_of(replaced(scene(""), "mass = 12", "mass = -1")),
            "s.toml:5:8: block.box.mass: -1 kg is outside 1e-06..1e+06 kg");
  EXPECT_EQ(error_of(replaced(scene(""), "mass = 12\n", "")), "s.toml:2:1: block.box.mass: missing (mass)");
  EXPECT_EQ(
      in_block("cg = [0, 0, \"500 mm\"]\n"),
      "s.toml:6:6: block.box.cg: z = 500 mm is not inside the block, which reaches from 0 mm to 500 mm");
  EXPECT_EQ(in_block("inertia = [1, 1, 9]\n"),
            "s.toml:6:11: block.box.inertia: no mass distribution has this inertia: each value must be less "
            "than the other two together");
  EXPECT_EQ(in_block("inertia = \"panels\"\n"),
            "s.toml:6:11: block.box.inertia: \"panels\" is not one of solid, nor a list of 3 values");
  EXPECT_EQ(in_block("width = \"210 mm\"\n"),
            "s.toml:6:9: block.box.width: 210 mm is more than the smallest side, 200 mm");
  EXPECT_EQ(in_block("model = \"frame\"\n"),
            "s.toml:6:9: block.box.model: \"frame\" is not one of auto, planar, rigid");
  EXPECT_EQ(in_block("section = \"post\"\n").substr(0, 46), "s.toml:6:1: block.box.section: unknown key; kn");
  EXPECT_EQ(in_block("[[block]]\nname = \"box\"\nsize = [1, 1, 1]\nmass = 1\n"),
            "s.toml:7:8: block.box.name: \"box\" is used twice, first in line 3");
  EXPECT_EQ(
      in_block("[run]\nintegrator = \"central-difference\"\n"),
      "s.toml:2:1: block.box: a block is rigid: integrator = \"central-difference\" makes a frame of each "
      "body that is near another");
  EXPECT_EQ(in_block("[run]\nanalysis = \"static\"\n"),
            "s.toml:2:1: block.box: a block is rigid: analysis = \"static\" is for frames");
  EXPECT_EQ(in_block("[[block]]\nsize = [0.1, 0.1, 0.1]\nmass = 1\nat = [0, 0, 0.2]\n").substr(0, 42),
            "s.toml:6:1: block.2: the bodies \"block-2\" ");
}

TEST(SceneBlock, overrides_and_edits_reach_it) {
  const Scene read = parse_scene(scene(""), "s.toml", {"block.1.mass=24 kg", "block.box.yaw=0.1"});
  EXPECT_EQ(read.setup.model.bodies[0].mass, 24);
  Parameters now = read.setup.parameters;
  now.models[0] = BodyModel::rigid;
  const std::string saved = edited_scene(read, now).text;
  EXPECT_NE(saved.find("model = \"rigid\""), std::string::npos) << saved;
  EXPECT_EQ(parse_scene(saved, "s.toml").setup.parameters.models[0], BodyModel::rigid);
}

TEST(SceneBlock, edits_that_make_frames_are_refused) {
  const topple::Setup setup = parse_scene(scene(""), "s.toml").setup;
  const auto refusal = [&](Edit::Key key, int value) -> std::string {
    try {
      check_edit({.key = key, .index = 0, .value = Vec3(value, 0, 0)}, setup.parameters, setup.model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto model = [&](BodyModel of) { return refusal(Edit::Key::model, static_cast<int>(of)); };
  EXPECT_EQ(model(BodyModel::rigid), "");
  EXPECT_EQ(model(BodyModel::automatic), "");
  EXPECT_EQ(model(BodyModel::frame), "body.1.model: \"box\" cannot be frame; a block is rigid");
  EXPECT_EQ(model(BodyModel::elastic), "body.1.model: \"box\" cannot be elastic; a block is rigid");
  const auto integrator = [&](Integrator of) { return refusal(Edit::Key::integrator, static_cast<int>(of)); };
  EXPECT_EQ(integrator(Integrator::newmark), "");
  EXPECT_EQ(
      integrator(Integrator::central_difference),
      "run.integrator: \"box\" is a block, which is rigid: \"central-difference\" makes a frame of each body "
      "that is near another");
}

TEST(SceneBlock, begins_as_a_planar_block_where_it_is_one) {
  EXPECT_EQ(in_block("restitution = 0.9\n[floor]\n"), "no error");
  EXPECT_EQ(in_block("model = \"planar\"\n[floor]\n"), "no error");
  EXPECT_EQ(
      in_block("restitution = 0.9\n"),
      "s.toml:6:15: block.box.restitution: \"box\" is no planar block: it stands on no level plane under "
      "straight gravity");
}

TEST(SceneBlock, a_cabinet_that_cannot_be_solid_names_it) {
  const std::string error = in_cabinet("inertia = \"solid\"\n");
  EXPECT_EQ(error.substr(0, 36), "s.toml:16:11: cabinet.free.inertia: ");
  EXPECT_TRUE(error.ends_with(" times that; add shelves, or use [[block]]")) << error;
}

// A planar block takes steps of some 40 ms; a trapezoidal rule that long is off by 1 %.
TEST(SceneBlock, the_floor_moves_alike_whatever_the_steps_are) {
  const auto floor = [](const std::vector<std::string>& set) {
    const Scene scene = parse_scene(R"(topple = 1
[run]
duration = "3 s"
[floor]
[contact]
friction = 0.2
[[shake]]
frequency = "1 Hz"
amplitude = "400 gal"
cycles = 2
[[block]]
name = "b"
size = [0.5, 0.5, 0.2]
mass = 50
)",
                                    "s.toml", set);
    topple::Run run(scene.setup);
    while (!run.over()) EXPECT_TRUE(run.advance().ok());
    return std::pair(run.state().floor_displacement.x(), run.step());
  };
  const auto [coarse, few] = floor({});
  const auto [fine, many] = floor({"run.time_step=\"1 ms\""});
  EXPECT_LT(10 * few, many);
  EXPECT_NEAR(coarse, fine, 1e-3 * std::abs(fine));
}

}  // namespace
}  // namespace topple::io
