// What static runs ask of a scene, and the exact text where it does not give it.
#include <gtest/gtest.h>

#include "scene_samples.h"

namespace topple::io {
namespace {

const std::string k_load = "loads = [{ node = 1, force = [0, 0, 1] }]\n";
const std::string k_static = "[run]\nanalysis = \"static\"\n";

/// Of a beam with these lines and a static run with that control; line 20 when it has a load.
std::string with_control(const std::string& control, const std::string& beam = k_load) {
  return after_beam(beam + k_static + "control = { " + control + " }\n");
}

TEST(SceneStatic, control_of_a_node_needs_one_that_can_move_and_its_direction) {
  EXPECT_EQ(with_control("node = 1, dof = \"z\""), "no error");
  EXPECT_EQ(with_control("node = 1"), "s.toml:20:11: run.control.dof: missing; give node and dof, or arc");
  EXPECT_EQ(with_control("dof = \"z\""),
            "s.toml:20:11: run.control.node: missing; give node and dof, or arc");
  EXPECT_EQ(with_control("to = 1"),
            "s.toml:20:13: run.control.to: belongs to dof = x or y or z, but dof is missing");
  EXPECT_EQ(with_control("node = 2, dof = \"z\""),
            "s.toml:20:20: run.control.node: 2 is not a node of \"beam\", which has 0..1");
  EXPECT_EQ(with_control("node = 0, dof = \"z\""),
            "s.toml:20:29: run.control.dof: \"z\" is supported at the node; free are: none");
  EXPECT_EQ(error_of(replaced(k_scene, "node = 0, fix = \"xyzXYZ\"", "node = 0, fix = \"xyzXZ\"") + k_load +
                     k_static + "control = { node = 0, dof = \"z\" }\n"),
            "s.toml:20:29: run.control.dof: \"z\" is supported at the node; free are: Y");
  EXPECT_EQ(with_control("node = 1, dof = \"w\""),
            "s.toml:20:29: run.control.dof: \"w\" is not one of x, y, z, X, Y, Z");
  EXPECT_EQ(with_control("node = 1, dof = \"z\", to = 0"), "s.toml:20:39: run.control.to: is no travel");
  EXPECT_EQ(with_control("node = 1, dof = \"Z\", to = 1"),
            "s.toml:20:34: run.control.to: belongs to dof = x or y or z, but dof is Z");
}

TEST(SceneStatic, control_needs_a_load_whose_factor_it_can_seek) {
  EXPECT_EQ(with_control("node = 1, dof = \"z\"", ""),
            "s.toml:19:11: run.control: there is no load on \"beam\"");
  EXPECT_EQ(with_control("arc = 0", ""), "s.toml:19:11: run.control: there is no load on \"beam\"");
  EXPECT_EQ(with_control("node = 1, dof = \"z\"",
                         "loads = [{ node = 1, force = [0, 0, 1], history = [[0, 0], [1, 1]] }]\n"),
            "s.toml:20:11: run.control: with control loads have no history: the factor is sought");
}

TEST(SceneStatic, arc_length_names_no_node_and_has_no_sign) {
  EXPECT_EQ(with_control("arc = 0"), "no error");
  EXPECT_EQ(with_control("arc = \"60 mm\""), "no error");
  EXPECT_EQ(with_control("arc = 1, node = 1"),
            "s.toml:20:29: run.control.node: belongs to control of a node, but arc is given");
  EXPECT_EQ(with_control("arc = 1, dof = \"z\""),
            "s.toml:20:28: run.control.dof: belongs to control of a node, but arc is given");
  EXPECT_EQ(with_control("arc = 1, to = 1"),
            "s.toml:20:22: run.control.to: belongs to dof = x or y or z, but dof is missing");
  EXPECT_EQ(with_control("arc = -1"), "s.toml:20:19: run.control.arc: -1 m is outside 0..1000 m");
  EXPECT_EQ(with_control("arc = \"1 kg\""),
            "s.toml:20:19: run.control.arc: \"1 kg\" is a mass, expected a length (m, cm, mm, km)");
}

TEST(SceneStatic, what_belongs_to_static_runs_is_refused_in_others) {
  EXPECT_EQ(after_beam(k_load + k_static + "stop_at = \"instability\"\n"), "no error");
  EXPECT_EQ(after_beam(k_load + k_static + "stop_at = \"buckling\"\n"),
            "s.toml:20:11: run.stop_at: \"buckling\" is not one of instability");
  EXPECT_EQ(after_beam("[run]\nstop_at = \"instability\"\n"),
            "s.toml:18:1: run.stop_at: belongs to analysis = static, but analysis is dynamic");
  EXPECT_EQ(after_beam("[run]\ncontrol = { arc = 1 }\n"),
            "s.toml:18:1: run.control: belongs to analysis = static, but analysis is dynamic");
}

TEST(SceneStatic, a_load_has_a_direction) {
  EXPECT_EQ(
      after_beam("loads = [{ node = 1 }]\n"),
      "s.toml:17:10: frame.beam.loads.1: has no direction: force and moment are zero; one of them is needed");
  EXPECT_EQ(
      after_beam("loads = [{ node = 1, force = [0, 0, 0] }]\n"),
      "s.toml:17:10: frame.beam.loads.1: has no direction: force and moment are zero; one of them is needed");
  EXPECT_EQ(after_beam("loads = [{ node = 1, moment = [0, 1, 0] }]\n"), "no error");
}

TEST(SceneStatic, a_section_resists_bending) {
  const auto custom = [](const std::string& iy) {
    return error_of(replaced(k_scene,
                             "shape = \"box\"\nsize = [\"30 mm\", \"30 mm\"]\nthickness = \"1 mm\"\n",
                             "shape = \"custom\"\narea = 1e-4\niy = " + iy +
                                 "\niz = 1e-8\nj = 1e-8\nky = 1\nkz = 1\nwidth = \"30 mm\"\n"));
  };
  EXPECT_EQ(custom("1e-8"), "no error");
  EXPECT_EQ(custom("0"), "s.toml:11:6: section.post.iy: 0 m^4 is outside 1e-18..100 m^4");
}

}  // namespace
}  // namespace topple::io
