// The exact text and place of every kind of error; those of keys of choices not made are in
// scene_choices_test.cpp.
#include <gtest/gtest.h>

#include "scene_samples.h"

namespace topple::io {
namespace {

TEST(SceneErrors, unknown_keys_list_the_known_ones) {
  EXPECT_EQ(
      after_beam("[contact]\n  foo = 1\n"),
      "s.toml:18:3: contact.foo: unknown key; known: alpha, friction, friction_static, law, member_share, "
      "normal_speed, q, restitution, slip_speed, surfaces");
  EXPECT_EQ(after_beam("[[probe]]\nbdy = 1\n"),
            "s.toml:18:1: probe.1.bdy: unknown key; known: body, name, node; the nearest is body");
  EXPECT_EQ(
      error_of("tople = 1\n" + k_scene),
      "s.toml:1:1: tople: unknown key; known: anchor, block, cabinet, ceiling, contact, door, expect, "
      "fixing, floor, frame, furniture, kind, material, place, probe, run, section, shake, title, topple, "
      "wall; the nearest is topple");
  EXPECT_EQ(error_of(replaced(k_scene, "supports = [{ node = 0,", "supports = [{ node = 0, fx = 1,")),
            "s.toml:16:25: frame.beam.supports.1.fx: unknown key; known: fix, node");
}

TEST(SceneErrors, static_friction_is_not_below_the_kinetic_and_damping_is_a_ratio) {
  EXPECT_EQ(after_beam("[contact]\nfriction_static = 1\n"), "no error");
  EXPECT_EQ(after_beam("[contact]\nfriction_static = 0.5\n"),
            "s.toml:18:19: contact.friction_static: 0.5 is below contact.friction, which is 0.6");
  EXPECT_EQ(after_beam("[contact]\nfriction_static = 2\n"),
            "s.toml:18:19: contact.friction_static: 2 is outside 0..1.5");
  EXPECT_EQ(after_beam("[contact]\nlaw = \"paper\"\nfriction_static = 1\n"),
            "s.toml:19:1: contact.friction_static: belongs to law = coulomb, but law is paper");
  EXPECT_EQ(in_cabinet("damping = 0.01\n"), "no error");
  EXPECT_EQ(in_cabinet("damping = 1.5\n"), "s.toml:16:11: cabinet.free.damping: 1.5 is outside 0..1");
  EXPECT_EQ(in_cabinet("damping = true\n"),
            "s.toml:16:11: cabinet.free.damping: expected a plain number, found true");
}

TEST(SceneErrors, restitution_of_a_base_is_for_planar_blocks_and_loses_energy) {
  const std::string motion = "[run]\nwant = [\"motion\"]\n[floor]\n", planar = "model = \"planar\"\n",
                    shake = "[[shake]]\nfrequency = 1\namplitude = 1\n";
  EXPECT_EQ(in_cabinet("restitution = 0.9\n" + motion), "no error");
  EXPECT_EQ(in_cabinet("restitution = 0.9\n" + planar + "[floor]\n"), "no error");
  const std::string at = "s.toml:16:15: cabinet.free.restitution: ";
  EXPECT_EQ(in_cabinet("restitution = 2.5\n" + motion), at + "2.5 is outside 0..2");
  // 1/(1 - 3/2 sin^2 a), a the critical angle of 380 mm by 1790 mm: 1.06916
  EXPECT_EQ(in_cabinet("restitution = 1.08\ninertia = \"solid\"\nshelves = 3\n" + motion + shake),
            at + "1.08 lets \"free\" gain energy at an impact; at most 1.0691");
  EXPECT_EQ(in_cabinet("restitution = 1.0691\ninertia = \"solid\"\nshelves = 3\n" + motion + shake),
            "no error");
  EXPECT_EQ(in_cabinet("restitution = 0.9\nmodel = \"rigid\"\n" + motion),
            "s.toml:16:1: cabinet.free.restitution: belongs to model = auto or planar, but model is rigid");
  EXPECT_EQ(in_cabinet("restitution = 0.9\n[floor]\n"),
            at + "\"free\" is no planar block: it is computed as \"elastic\" (stresses are wanted)");
  EXPECT_EQ(in_cabinet("restitution = 0.9\n[run]\nwant = [\"motion\"]\n"),
            at + "\"free\" is no planar block: it stands on no level plane under straight gravity");
  EXPECT_EQ(in_cabinet("restitution = 0.9\n" + motion + "[contact]\nrestitution = 0.5\n"),
            at + "\"free\" is no planar block: its contacts bounce");
  EXPECT_EQ(in_cabinet("restitution = 0.9\n" + motion + "[[wall]]\nat = [-0.5, 0]\nnormal = [1, 0, 0]\n"),
            at + "\"free\" is no planar block: a wall or body is within its fall");
}

TEST(SceneErrors, a_block_that_begins_beside_another_body_is_none) {
  const std::string two = "model = \"planar\"\ncopies = [[0, 0, 0], [GAP, 0, 0]]\n[floor]\n";
  EXPECT_EQ(in_cabinet(replaced(two, "GAP", "1")), "no error");
  EXPECT_EQ(in_cabinet(replaced(two, "GAP", "0.45")),
            "s.toml:16:9: cabinet.free.model: \"free\" is no planar block: another body is within 50 mm");
}

TEST(SceneErrors, floors_of_beams_and_of_planes_have_their_own_keys) {
  EXPECT_EQ(after_beam("[floor]\nspacing = 1\n"),
            "s.toml:18:1: floor.spacing: belongs to type = beams, but type is plane");
  EXPECT_EQ(after_beam("[floor]\ntype = \"beams\"\n"),
            "s.toml:17:1: floor.section: missing; type = \"beams\" needs it (a [[section]], of its members)");
}

TEST(SceneErrors, bodies_that_overlap_at_the_start_are_refused) {
  std::string error = in_cabinet(
      "\n[[cabinet]]\nname = \"other\"\nat = [0.1, 0.2]\nsection = \"post\"\nmaterial = \"steel\"\n");
  EXPECT_EQ(error.find("s.toml:17:1: cabinet.other: the bodies \"free\" ("), 0u) << error;
  EXPECT_NE(error.find(") overlap at the start"), std::string::npos) << error;
}

TEST(SceneErrors, bodies_that_start_within_a_floor_or_wall_are_refused) {
  const auto beside = [](const std::string& x) {
    return in_cabinet("\n[[wall]]\nname = \"back\"\nat = [" + x + ", 0]\nnormal = [1, 0, 0]\n");
  };
  EXPECT_EQ(beside("-0.205"), "no error");  // half a post before its centre line
  EXPECT_EQ(beside("-0.14"), "s.toml:12:1: cabinet.free: starts 65 mm within \"back\"");
  EXPECT_EQ(in_cabinet("at = [0, 0, -0.3]\n[floor]\n"),
            "s.toml:12:1: cabinet.free: starts 300 mm within \"floor\"");
}

TEST(SceneErrors, a_missing_quote_and_a_decimal_comma_are_told) {
  EXPECT_EQ(in_cabinet("mass = 85 kg # full\n"),
            "s.toml:16:11: Error while parsing key-value pair: expected a comment or whitespace, saw 'k'; a "
            "number with a unit, and text, stand in quotes: \"85 kg\"");
  EXPECT_EQ(in_cabinet("mass = \"85,5 kg\"\n"),
            "s.toml:16:8: cabinet.free.mass: \"85,5 kg\" has a comma: write a decimal point");
  EXPECT_EQ(in_cabinet("mass = 85\nmass = 86\n").find("quotes"), std::string::npos);
  EXPECT_EQ(in_cabinet("mass = 850000\n"),
            "s.toml:16:8: cabinet.free.mass: 850000 kg is outside 0.001..100000 kg");
}

TEST(SceneErrors, yield_and_fracture_have_their_ranges_and_need_each_other) {
  const auto with = [](const std::string& lines) {
    return error_of(replaced(k_scene, "poisson", lines + "poisson"));
  };
  EXPECT_EQ(with("yield = 0\n"), "s.toml:5:9: material.steel.yield: 0 Pa is outside 1e-06..1e+07 MPa");
  EXPECT_EQ(
      with("fracture_strain = 0.2\n"),
      "s.toml:5:19: material.steel.fracture_strain: a material breaks where it has yielded: give yield as "
      "well");
  EXPECT_EQ(with("yield = \"235 MPa\"\nfracture_strain = 0.2\n"), "no error");
  EXPECT_EQ(error_of(replaced(k_scene, "thickness", "zy = 1e-6\nthickness")),
            "s.toml:11:1: section.post.zy: belongs to shape = custom, but shape is box");
}

TEST(SceneErrors, custom_section_of_a_material_that_yields_needs_plastic_moduli) {
  const std::string moduli = "zy = \"1 cm^3\"\nzz = \"1 cm^3\"\nzt = \"1 cm^3\"\n";
  const auto scene = [](const std::string& yield, const std::string& more) {
    std::string text = replaced(k_scene, "poisson", yield + "poisson");
    text =
        replaced(text, "shape = \"box\"\nsize = [\"30 mm\", \"30 mm\"]\nthickness = \"1 mm\"\n",
                 "shape = \"custom\"\narea = 1e-4\niy = 1e-8\niz = 1e-8\nj = 1e-8\nky = 1\nkz = 1\nwidth = "
                 "\"30 mm\"\n" +
                     more);
    return error_of(text);
  };
  EXPECT_EQ(scene("", ""), "no error");
  EXPECT_EQ(scene("yield = \"235 MPa\"\n", moduli), "no error");
  EXPECT_NE(
      scene("yield = \"235 MPa\"\n", "")
          .find("\"post\" of material \"steel\", which yields, has no plastic moduli: give zy, zz and zt"),
      std::string::npos);
}

TEST(SceneErrors, missing_keys_are_named_at_their_entry) {
  EXPECT_EQ(error_of(replaced(k_cabinet_scene, "section = \"post\"\n", "")),
            "s.toml:12:1: cabinet.free.section: missing (a [[section]])");
  EXPECT_EQ(after_beam("\n[[shake]]\namplitude = 1\n"),
            "s.toml:18:1: shake.1.frequency: missing; type = \"sine\" needs it (frequency; of a sweep "
            "[first, last]: each "
            "octave takes as long)");
  EXPECT_EQ(error_of(replaced(k_scene, "size = [\"30 mm\", \"30 mm\"]\n", "")),
            "s.toml:7:1: section.post.size: missing (outer sizes along local y and z; pipe: the diameter)");
  EXPECT_EQ(error_of(replaced(k_scene, "section = \"post\", ", "")),
            "s.toml:15:12: frame.beam.members.1.section: missing (a [[section]])");
  EXPECT_EQ(error_of(""), "s.toml:1:1: topple: missing; a scene says topple = 1, the version of its schema");
  EXPECT_EQ(error_of(k_scene.substr(k_head.size())),
            "s.toml:1:1: topple: missing; a scene says topple = 1, the version of its schema");
}

TEST(SceneErrors, other_schema_versions_are_refused) {
  EXPECT_EQ(error_of("foo = 1\ntopple = 2\n"),
            "s.toml:2:10: topple: schema 2 is not supported by this version, which reads schema 1");
  EXPECT_EQ(error_of("topple = \"1\"\n"), "s.toml:1:10: topple: expected an integer, found \"1\"");
}

TEST(SceneErrors, wrong_types_say_what_was_found) {
  EXPECT_EQ(after_beam("[contact]\nfriction = true\n"),
            "s.toml:18:12: contact.friction: expected a plain number, found true");
  EXPECT_EQ(after_beam("[contact]\nalpha = [1]\n"),
            "s.toml:18:9: contact.alpha: expected a force (N, kN, MN, kgf), found a list");
  EXPECT_EQ(after_beam("[contact]\nlaw = 3\n"),
            "s.toml:18:7: contact.law: expected one of coulomb, paper, printed, found 3");
  EXPECT_EQ(
      after_beam("[contact]\nlaw = \"coulom\"\n"),
      "s.toml:18:7: contact.law: \"coulom\" is not one of coulomb, paper, printed; the nearest is coulomb");
  EXPECT_EQ(after_beam("[run]\nsettle = 1\n"), "s.toml:18:10: run.settle: expected true or false, found 1");
  EXPECT_EQ(after_beam("[run]\nwant = \"motion\"\n"),
            "s.toml:18:8: run.want: expected a list of some of motion, stress, found \"motion\"");
  EXPECT_EQ(after_beam("[run]\nwant = [\"motion\", \"noise\"]\n"),
            "s.toml:18:19: run.want.2: \"noise\" is not one of motion, stress");
  EXPECT_EQ(after_beam("[run]\ngravity = [0, 0]\n"),
            "s.toml:18:11: run.gravity: expected a list of 3 values, found 2");
  EXPECT_EQ(after_beam("[run]\ngravity = [0, 0, \"down\"]\n"),
            "s.toml:18:18: run.gravity.3: \"down\" is not a number with a unit, expected an acceleration "
            "(m/s^2, cm/s^2, gal, g)");
  EXPECT_EQ(in_cabinet("shelves = 2.5\n"),
            "s.toml:16:11: cabinet.free.shelves: expected an integer, found 2.5");
  EXPECT_EQ(in_cabinet("inertia = \"panel\"\n"),
            "s.toml:16:11: cabinet.free.inertia: \"panel\" is not one of panels, solid, nor a list of 3 "
            "values; the nearest is panels");
  EXPECT_EQ(after_beam("[[run]]\n"), "s.toml:17:1: run: expected a table [run], found a list");
  EXPECT_EQ(after_beam("[shake]\n"), "s.toml:17:1: shake: expected [[shake]], found a table");
  EXPECT_EQ(error_of("title = 3\n" + k_scene), "s.toml:1:9: title: expected text, found 3");
  EXPECT_EQ(error_of("title = 2020-01-01\n" + k_scene),
            "s.toml:1:9: title: expected text, found a date or time");
  EXPECT_EQ(error_of("title = \"a\\nb\"\n" + k_scene), "s.toml:1:9: title: contains a control character");
  EXPECT_EQ(in_cabinet("[[probe]]\nbody = \"\"\n"), "s.toml:17:8: probe.1.body: is empty");
}

TEST(SceneErrors, wrong_dimensions_say_which_was_found_and_which_expected) {
  EXPECT_EQ(after_beam("[contact]\nalpha = \"30 mm\"\n"),
            "s.toml:18:9: contact.alpha: \"30 mm\" is a length, expected a force (N, kN, MN, kgf)");
  EXPECT_EQ(
      after_beam("[contact]\nalpha = \"30 g\"\n"),
      "s.toml:18:9: contact.alpha: \"30 g\" is a mass or an acceleration, expected a force (N, kN, MN, kgf)");
  EXPECT_EQ(after_beam("[contact]\nfriction = \"3 mm\"\n"),
            "s.toml:18:12: contact.friction: \"3 mm\" is a length, expected a plain number");
  EXPECT_EQ(
      after_beam("[contact]\nfriction = \"0.3\"\n"),
      "s.toml:18:12: contact.friction: \"0.3\" is text, expected a plain number: write it without quotes");
  EXPECT_EQ(in_cabinet("mass = \"40\"\n"),
            "s.toml:16:8: cabinet.free.mass: \"40\" has no unit, expected a mass (kg, g, t), or a number in "
            "SI without quotes");
  EXPECT_EQ(in_cabinet("mass = \"40 stone\"\n"),
            "s.toml:16:8: cabinet.free.mass: \"40 stone\" has an unknown unit \"stone\", expected a mass "
            "(kg, g, t)");
}

TEST(SceneErrors, values_out_of_range_say_the_range) {
  EXPECT_EQ(after_beam("[contact]\nfriction = 2.4\n"),
            "s.toml:18:12: contact.friction: 2.4 is outside 0..1.5");
  EXPECT_EQ(after_beam("[contact]\nalpha = \"2e6 kgf\"\n"),
            "s.toml:18:9: contact.alpha: \"2e6 kgf\" is outside 0.001..1e+06 kgf");
  EXPECT_EQ(after_beam("[contact]\nalpha = \"1e6 kgf\"\n"), "no error");
  EXPECT_EQ(after_beam("[run]\ntime_step = \"0.0001 ms\"\n"), "no error");
  EXPECT_EQ(after_beam("[run]\nduration = \"61 min\"\n"),
            "s.toml:18:12: run.duration: \"61 min\" is outside 1e-06..3600 s");
  EXPECT_EQ(in_cabinet("shelves = -1\n"), "s.toml:16:11: cabinet.free.shelves: -1 is outside 0..20");
  EXPECT_EQ(in_cabinet("shelves = 9223372036854775807\n"),
            "s.toml:16:11: cabinet.free.shelves: 9223372036854775807 is outside 0..20");
  EXPECT_EQ(in_cabinet("size = [1, 1, \"1 mm\"]\n"),
            "s.toml:16:15: cabinet.free.size.3: \"1 mm\" is outside 10..10000 mm");
}

TEST(SceneErrors, infinities_are_refused) {
  EXPECT_EQ(after_beam("[contact]\nfriction = nan\n"),
            "s.toml:18:12: contact.friction: nan is not a finite number");
  EXPECT_EQ(after_beam("[contact]\nq = -inf\n"), "s.toml:18:5: contact.q: -inf is not a finite number");
  EXPECT_EQ(after_beam("[contact]\nalpha = \"inf N\"\n"),
            "s.toml:18:9: contact.alpha: \"inf N\" is not a finite number");
  EXPECT_EQ(after_beam("[contact]\nalpha = \"1e999 N\"\n"),
            "s.toml:18:9: contact.alpha: \"1e999 N\" is not a finite number");
}

TEST(SceneErrors, names_used_twice_are_refused_within_a_kind) {
  EXPECT_EQ(
      after_beam(k_cabinet.substr(0, 12) + "name = \"beam\"\nsection = \"post\"\nmaterial = \"steel\"\n"),
      "s.toml:13:8: frame.beam.name: \"beam\" is used twice, first in line 18");
  EXPECT_EQ(after_beam("[[material]]\nname = \"steel\"\nyoung = 1e9\npoisson = 0\ndensity = 1\n"),
            "s.toml:18:8: material.steel.name: \"steel\" is used twice, first in line 3");
  EXPECT_EQ(after_beam("[floor]\n[[wall]]\nname = \"floor\"\nat = [0, 0]\nnormal = [1, 0, 0]\n"),
            "s.toml:19:8: wall.floor.name: \"floor\" is used twice, first in line 17");
  EXPECT_EQ(after_beam("[[probe]]\nbody = \"beam\"\n[[probe]]\nbody = \"beam\"\nname = \"probe-1\"\n"),
            "s.toml:21:8: probe.probe-1.name: \"probe-1\" is used twice, first in line 17");
  EXPECT_EQ(error_of(replaced(k_scene, "supports", "copies = [[0, 0, 0], [0, 1, 0]]\nsupports") +
                     replaced(k_beam, "\"beam\"", "\"beam-2\"")),
            "s.toml:19:8: frame.beam-2.name: \"beam-2\" is also the name of a copy");
  EXPECT_EQ(in_cabinet("copies = [[0, 0, 0], [0, 5, 0]]\n" + replaced(k_beam, "\"beam\"", "\"free-2\"")),
            "s.toml:18:8: frame.free-2.name: \"free-2\" is also the name of a copy");
  EXPECT_NE(in_cabinet("copies = [[0, 0, 0], [0.1, 0.2, 0]]\n").find("\"free-2\""), std::string::npos);
}

TEST(SceneErrors, references_to_nothing_list_what_there_is) {
  EXPECT_EQ(
      error_of(replaced(k_cabinet_scene, "section = \"post\"", "section = \"pst\"")),
      "s.toml:14:11: cabinet.free.section: there is no [[section]] \"pst\"; known: post; built in: "
      "\"box 30x1\", \"box 40x20x1.2\", \"solid 30\", \"solid 40x20\", \"pipe 25x1.2\", \"sheet 700x25\"");
  EXPECT_EQ(error_of(replaced(k_scene, "material = \"steel\"", "material = \"oak\"")),
            "s.toml:15:59: frame.beam.members.1.material: there is no [[material]] \"oak\"; known: steel; "
            "built in: "
            "aluminium, plastic, stainless steel, steel, wood");
  EXPECT_EQ(
      error_of(k_head + k_cabinet),
      "s.toml:4:11: cabinet.free.section: there is no [[section]] \"post\" nor any other; built in: "
      "\"box 30x1\", \"box 40x20x1.2\", \"solid 30\", \"solid 40x20\", \"pipe 25x1.2\", \"sheet 700x25\"");
  EXPECT_EQ(after_beam("[[probe]]\nname = \"p\"\nbody = \"beem\"\n"),
            "s.toml:19:8: probe.p.body: there is no body \"beem\"; known: beam");
  EXPECT_EQ(after_beam("[[probe]]\nname = \"p\"\nbody = \"beam\"\nnode = 2\n"),
            "s.toml:20:8: probe.p.node: 2 is not a node of \"beam\", which has 0..1");
  EXPECT_EQ(
      in_cabinet("[[probe]]\nbody = \"free\"\nnode = 2\n"),
      "s.toml:18:8: probe.1.node: the nodes of a cabinet have no numbers; leave it out to follow the body");
  EXPECT_EQ(error_of(replaced(k_scene, "nodes = [0, 1]", "nodes = [0, 7]")),
            "s.toml:15:26: frame.beam.members.1.nodes.2: 7 is not a node of the frame, which has 0..1");
  EXPECT_EQ(error_of(replaced(k_scene, "{ node = 0,", "{ node = 5,")),
            "s.toml:16:22: frame.beam.supports.1.node: 5 is not a node of the frame, which has 0..1");
}

TEST(SceneErrors, settling_from_motion_or_without_gravity_is_refused) {
  EXPECT_EQ(in_cabinet("tilt = \"5 deg\"\n"),
            "s.toml:16:8: cabinet.free.tilt: a body that starts tilted cannot settle: write settle = false "
            "in [run]");
  EXPECT_EQ(in_cabinet("velocity = [0, 1, 0]\n"),
            "s.toml:16:12: cabinet.free.velocity: a body that starts in motion cannot settle: write settle = "
            "false in [run]");
  EXPECT_EQ(after_beam("angular_velocity = [0, 1, 0]\n"),
            "s.toml:17:20: frame.beam.angular_velocity: a body that starts in motion cannot settle: write "
            "settle = false in "
            "[run]");
  EXPECT_EQ(after_beam("[run]\ngravity = [0, 0, 0]\nsettle = true\n"),
            "s.toml:18:11: run.gravity: nothing settles without gravity: write settle = false in [run]");
  EXPECT_EQ(after_beam("[run]\ngravity = [0, 0, 0]\nsettle = false\n"), "no error");
  EXPECT_EQ(in_cabinet("tilt = 0\nvelocity = [0, 0, 0]\n"), "no error");
  EXPECT_EQ(in_cabinet("tilt = \"5 deg\"\nvelocity = [0, 1, 0]\n[run]\nsettle = false\n"), "no error");
}

TEST(SceneErrors, a_scene_without_bodies_is_refused) {
  EXPECT_EQ(
      error_of(k_head + k_library),
      "s.toml:1:1: there are no bodies; a scene has at least one [[furniture]], [[cabinet]], [[frame]] or "
      "[[block]]");
}

TEST(SceneErrors, bodies_that_cannot_be_built_blame_the_key) {
  EXPECT_EQ(in_cabinet("cg_height = \"1.7 m\"\n").substr(0, 35), "s.toml:16:13: cabinet.free.cg_heigh");
  EXPECT_EQ(in_cabinet("cg_height = \"3 m\"\n"),
            "s.toml:16:13: cabinet.free.cg_height: 3000 mm is not below the top, 1790 mm");
  EXPECT_EQ(in_cabinet("inertia = [1, 1, 9]\n").substr(0, 36), "s.toml:16:11: cabinet.free.inertia: ");
  EXPECT_EQ(error_of(replaced(k_scene, "[1, 0, 0]]", "[0, 0, 0]]")),
            "s.toml:14:9: frame.beam.nodes: nodes 0 and 1 are in one place");
  EXPECT_EQ(error_of(replaced(k_scene, "[1, 0, 0]]", "[1, 0, 0], [2, 0, 0]]")),
            "s.toml:14:9: frame.beam.nodes: node 2 belongs to no member");
  EXPECT_EQ(error_of(replaced(k_scene, "nodes = [0, 1]", "nodes = [1, 1]")),
            "s.toml:15:22: frame.beam.members.1.nodes: a member from a node to itself has no length");
  EXPECT_EQ(error_of(replaced(k_scene, "\"steel\" }", "\"steel\", up = [1, 0, 0] }")),
            "s.toml:15:73: frame.beam.members.1.up: is parallel to the member");
  EXPECT_EQ(error_of(replaced(k_scene, "\"steel\" }", "\"steel\", elements = 3 }")),
            "s.toml:15:79: frame.beam.members.1.elements: 3 is not even");
  EXPECT_EQ(error_of(replaced(k_scene, "xyzXYZ", "xyw")),
            "s.toml:16:31: frame.beam.supports.1.fix: expected letters of xyzXYZ, found \"xyw\"");
  EXPECT_EQ(error_of(replaced(k_scene, "\"1 mm\"", "\"15 mm\"")),
            "s.toml:11:13: section.post.thickness: 15 mm is not less than half of the smaller size, 30 mm");
  EXPECT_EQ(error_of(replaced(k_scene, "\"box\"", "\"pipe\"")),
            "s.toml:10:8: section.post.size: a pipe has one size, its outer diameter");
  EXPECT_EQ(error_of(replaced(k_scene, "size = [\"30 mm\", \"30 mm\"]", "size = \"30 mm\"")),
            "s.toml:10:8: section.post.size: expected [a, b], the sizes along local y and z");
}

TEST(SceneErrors, directions_and_histories_must_make_sense) {
  EXPECT_EQ(after_beam("[[wall]]\nat = [0, 0]\nnormal = [0, 0, 0]\n"),
            "s.toml:19:10: wall.1.normal: a zero vector has no direction");
  EXPECT_EQ(after_beam("[[shake]]\nfrequency = 1\namplitude = 1\ndirection = [0, 0, 0]\n"),
            "s.toml:20:13: shake.1.direction: a zero vector has no direction");
  EXPECT_EQ(after_beam("[[shake]]\nfrequency = 1\namplitude = 1\ncycles = 3\ntaper = 2\n"),
            "s.toml:21:9: shake.1.taper: rise and fall together are longer than the cycles");
  EXPECT_EQ(after_beam("loads = [{ node = 1, history = [[0, 1], [0, 2]] }]\n"),
            "s.toml:17:42: frame.beam.loads.1.history.2.1: times must increase, 0 does not");
  EXPECT_EQ(
      after_beam("loads = [{ node = 1, history = [[\"1 m\", 1]] }]\n"),
      "s.toml:17:34: frame.beam.loads.1.history.1.1: \"1 m\" is a length, expected a time (s, ms, us, min)");
}

TEST(SceneErrors, broken_toml_says_where) {
  EXPECT_EQ(error_of("topple = 1\ntitle = \"open\n").substr(0, 12), "s.toml:2:14:");
  EXPECT_EQ(error_of("topple = 1\ntopple = 1\n").substr(0, 9), "s.toml:2:");
  EXPECT_EQ(error_of("topple = 1\ntitle = \"\xff\"\n").substr(0, 9), "s.toml:2:");
  EXPECT_EQ(error_of("topple = 1\n[ =]\n").substr(0, 12), "s.toml:2:3: ");
  EXPECT_EQ(error_of(std::string("\xff\xfet\0o\0", 6)).substr(0, 9), "s.toml:1:");
}

TEST(SceneErrors, overrides_are_blamed_by_their_own_text) {
  const auto error = [](const std::string& text) {
    return error_of(k_cabinet_scene, {"run.duration=5", text});
  };
  EXPECT_EQ(error("contact.friction=9"), "--set contact.friction=9: contact.friction: 9 is outside 0..1.5");
  EXPECT_EQ(error("shake.1.type=sweep").find("--set shake.1.type=sweep: "), 0u);
  EXPECT_EQ(
      error("cabinet.1.mass=30 mm"),
      "--set cabinet.1.mass=30 mm: cabinet.free.mass: \"30 mm\" is a length, expected a mass (kg, g, t)");
  EXPECT_EQ(error("cabinet.walled.mass=30"),
            "--set cabinet.walled.mass=30: cabinet.walled: no such entry; known: free");
  EXPECT_EQ(error("contact.foo=30"),
            "--set contact.foo=30: contact.foo: unknown key; known: alpha, friction, friction_static, law, "
            "member_share, normal_speed, q, restitution, slip_speed, surfaces");
  EXPECT_EQ(error("shake.1.amplitude=3"),
            "--set shake.1.amplitude=3: shake: an override cannot add or replace a [[shake]]");
  EXPECT_EQ(error("cabinet=[]"),
            "--set cabinet=[]: cabinet: an override cannot add or replace a [[cabinet]]");
  EXPECT_EQ(error("cabinet.free=3"),
            "--set cabinet.free=3: cabinet.free: is a whole entry; set one of its keys, or all of them: "
            "cabinet.free={ KEY = VALUE, ... }");
  EXPECT_EQ(error("cabinet.free.cg_height=1.7").substr(0, 53),
            "--set cabinet.free.cg_height=1.7: cabinet.free.cg_hei");
  EXPECT_EQ(error("title=\x8d"), "--set title=\x8d: is not UTF-8");
  EXPECT_EQ(error("topple.x=3"), "--set topple.x=3: topple: is an integer and has no keys");
  EXPECT_EQ(error("nonsense"), "--set nonsense: expected KEY=VALUE, such as contact.friction=0.5");
  EXPECT_EQ(error_of(k_cabinet_scene + "[contact]\nrestitution = 0.5\n", {"contact.law=paper"}),
            "s.toml:17:1: contact.restitution: belongs to law = coulomb, but law is paper");
}

/// An anchor of the cabinet, lines 16 to 20 of the file; `rest` from line 21 on.
std::string of_anchor(const std::string& body, const std::string& point, const std::string& to,
                      const std::string& rest = "") {
  return in_cabinet("[[anchor]]\nbody = \"" + body + "\"\npoint = " + point + "\nto = " + to +
                    "\nstiffness = 1e4\n" + rest);
}

TEST(SceneErrors, anchors_that_hold_nothing_are_refused) {
  EXPECT_EQ(of_anchor("other", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]"),
            "s.toml:17:8: anchor.1.body: there is no body \"other\"; known: free");
  const std::string nowhere = of_anchor("free", "[-0.19, 0, 3]", "[-0.3, 0, 3]");
  EXPECT_EQ(
      nowhere.find("s.toml:18:9: anchor.1.point: an anchor to nowhere: the nearest member of \"free\", "), 0u)
      << nowhere;
  // the back is a sheet
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.1, 0.6]", "[-0.3, 0.1, 0.6]"), "no error");
  EXPECT_NE(of_anchor("free", "[0, 0.1, 0.6]", "[-0.3, 0.1, 0.6]"), "no error");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.19, 0.44, 1.7]"),
            "s.toml:19:6: anchor.1.to: is where `point` is: the anchor has no length");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]", "strength = 0\n"),
            "s.toml:21:12: anchor.1.strength: 0 N is outside 1e-06..1e+09 kN");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]", "type = \"rope\"\n"),
            "s.toml:21:8: anchor.1.type: \"rope\" is not one of strap, bracket, pole");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]",
                      "strength = 1e3\n[run]\nanalysis = \"static\"\n"),
            "s.toml:21:1: anchor.1.strength: belongs to analysis = dynamic, but analysis is static");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]", "[run]\nanalysis = \"modes\"\n"),
            "s.toml:16:3: anchor: belongs to analysis = dynamic or static, but analysis is modes");
  EXPECT_EQ(of_anchor("free", "[-0.19, 0.44, 1.7]", "[-0.3, 0.44, 1.7]"), "no error");
}

TEST(SceneErrors, no_anchor_pulls_a_body_through_a_wall_or_the_floor) {
  const std::string wall = "[floor]\n[[wall]]\nname = \"back\"\nat = [-0.3, 0]\nnormal = [1, 0, 0]\n";
  const auto with = [&](const std::string& to, const std::string& rest = "") {
    return of_anchor("free", "[-0.19, 0.44, 0.1]", to, rest + wall);
  };
  EXPECT_EQ(
      with("[-0.55, 0.44, 0.1]"),
      "s.toml:19:6: anchor.1.to: lies 250 mm behind the face of wall \"back\", into which it would pull the "
      "body");
  EXPECT_EQ(
      with("[-0.19, 0.5, -0.2]"),
      "s.toml:19:6: anchor.1.to: lies 200 mm behind the face of the floor, into which it would pull the "
      "body");
  EXPECT_EQ(with("[-0.32, 0.44, 0.1]"), "no error");  // less than a contact width
  EXPECT_EQ(with("[-0.3, 0.44, 0]"), "no error");
  EXPECT_EQ(with("[-0.55, 0.44, 0.1]", "type = \"pole\"\n"), "no error");  // pushes away from it
}

TEST(SceneErrors, a_missing_file_lists_the_built_in_scenes) {
  try {
    load_scene("no-such-scene");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "no-such-scene: no such file or built-in scene; built-in: anchored, beam-floor, bookshelf, breaking, "
        "brittle-connector, "
        "cabinet, cantilever, chair, classroom, collide, desk, dominoes, floor-long-period, "
        "folding-leg, free-rocking, moving-in, near-fault, office, paper-a, paper-b, "
        "portal-pushover, refrigerator, sixth-floor, stack, tumble, wardrobe, weak-storey, wedged, yielding");
  }
  try {
    load_scene(TOPPLE_SOURCE_DIR "/assets");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), TOPPLE_SOURCE_DIR "/assets: is a folder");
  }
}

TEST(SceneErrors, a_huge_text_is_refused) {
  EXPECT_EQ(error_of(k_scene + std::string(5u << 20, '#')), "s.toml: larger than 4 MiB, which no scene is");
}

}  // namespace
}  // namespace topple::io
