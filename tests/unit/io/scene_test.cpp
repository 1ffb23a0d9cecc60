// What a scene file means: defaults, units, overrides, anchors.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>

#include "scene_samples.h"
#include "solver/body/anchors.h"
#include "solver/contact/contact_default.h"
#include "solver/io/document/scene_document.h"
#include "solver/io/scene/scene_check.h"
#include "solver/io/scene/scene_entry.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/io/scene/scene_words.h"
#include "solver/model/cabinet.h"

namespace topple::io {
namespace {

TEST(Scene, absent_keys_have_the_defaults_of_the_structs) {
  const topple::Setup setup = parse_scene(k_scene, "s.toml").setup;
  const RunSettings run;
  EXPECT_EQ(setup.run.duration, run.duration);
  EXPECT_EQ(setup.run.settle, run.settle);
  EXPECT_EQ(setup.run.output_rate, run.output_rate);
  EXPECT_EQ(setup.run.stop_when, run.stop_when);
  const Parameters parameters;
  EXPECT_EQ(setup.parameters.gravity, parameters.gravity);
  EXPECT_EQ(setup.parameters.integrator, parameters.integrator);
  EXPECT_EQ(setup.parameters.spectral_radius, parameters.spectral_radius);
  EXPECT_EQ(setup.parameters.time_step, parameters.time_step);
  const ContactLaw &law = setup.parameters.contact, expected;
  EXPECT_EQ(law.kind, expected.kind);
  EXPECT_EQ(law.alpha, expected.alpha);
  EXPECT_EQ(law.q, expected.q);
  EXPECT_EQ(law.friction, expected.friction);
  EXPECT_EQ(law.restitution, expected.restitution);
  EXPECT_EQ(law.normal_speed, expected.normal_speed);
  EXPECT_EQ(law.slip_speed, expected.slip_speed);
  EXPECT_TRUE(setup.parameters.shakes.empty());
  EXPECT_TRUE(setup.model.planes.empty());
  EXPECT_TRUE(setup.probes.empty());
}

TEST(Scene, absent_keys_of_a_shake_have_the_defaults_of_the_struct) {
  const Shake expected;
  const topple::Setup sine =
      parse_scene(k_scene + "[[shake]]\nfrequency = 2\namplitude = 1\n", "s.toml").setup;
  const Shake& shake = sine.parameters.shakes.at(0);
  EXPECT_EQ(shake.kind, expected.kind);
  EXPECT_EQ(shake.direction, expected.direction);
  EXPECT_EQ(shake.start, expected.start);
  EXPECT_EQ(shake.cycles, expected.cycles);
  EXPECT_EQ(shake.taper, expected.taper);
  EXPECT_EQ(shake.initial_velocity, expected.initial_velocity);
  const topple::Setup pulse =
      parse_scene(k_scene + "[[shake]]\ntype = \"pulse\"\nduration = 2\namplitude = 1\n", "s.toml").setup;
  EXPECT_EQ(pulse.parameters.shakes.at(0).kind, Shake::Kind::pulse);
  EXPECT_EQ(pulse.parameters.shakes.at(0).shape, expected.shape);
}

// Keys whose default shows only in the body that is built, read as the reader reads them.
TEST(Scene, absent_keys_of_bodies_have_the_defaults_of_the_structs) {
  const Node root = parse_toml(k_cabinet_scene, "s.toml");
  const Entry entry = Entry("s.toml", "", "", &root, root.place).entries("cabinet").at(0);
  const CabinetSpec spec;
  EXPECT_EQ(entry.vector("size"), spec.size);
  EXPECT_EQ(entry.number("mass"), spec.mass);
  EXPECT_DOUBLE_EQ(spec.size.z() / 2, spec.cg_height) << "the documented default of cg_height";
  EXPECT_TRUE(entry.is_word("inertia"));
  EXPECT_EQ(entry.chosen("inertia", k_inertias), spec.inertia);
  EXPECT_EQ(entry.numbers("at"), (std::vector<double>{spec.at.x(), spec.at.y()}));
  EXPECT_EQ(entry.number("yaw"), spec.yaw);
  EXPECT_EQ(entry.chosen("pose", k_poses), spec.pose);
  EXPECT_EQ(entry.number("tilt"), spec.tilt);
  EXPECT_EQ(entry.vector("velocity"), spec.velocity);
  EXPECT_EQ(entry.vector("angular_velocity"), spec.angular_velocity);
  EXPECT_EQ(entry.integer("shelves"), spec.shelves);
  EXPECT_EQ(entry.chosen("bracing", k_bracings), spec.bracing);
  EXPECT_EQ(entry.number("panel_thickness"), spec.panel_thickness);
  EXPECT_EQ(entry.integer("divisions"), spec.divisions);
  EXPECT_EQ(find_key("cabinet", "model")->choices.at(0), "auto");

  const Node beam = parse_toml(k_scene, "s.toml");
  const Entry frame = Entry("s.toml", "", "", &beam, beam.place).entries("frame").at(0);
  EXPECT_EQ(frame.entries("members").at(0).integer("elements"), FrameMember{}.elements);
  EXPECT_EQ(frame.vector("velocity"), FrameSpec{}.velocity);
  EXPECT_EQ(frame.vector("angular_velocity"), FrameSpec{}.angular_velocity);
}

TEST(Scene, every_default_lies_in_its_range_and_every_unit_has_its_dimension) {
  for (const Key& key : scene_keys()) {
    SCOPED_TRACE(std::string(key.table) + "." + std::string(key.name));
    EXPECT_FALSE(key.about.empty());
    EXPECT_TRUE(key.unit.empty() || unit_list(key.dimension).find(key.unit) != std::string::npos);
    EXPECT_LE(key.least, key.most);
    if (!key.of.empty()) {
      const Key* of = find_key(key.table, key.of);
      ASSERT_TRUE(of);
      EXPECT_FALSE(of->choices.empty());
    }
    if (!key.choices.empty() && key.fallback.size() == 1 && key.type != KeyType::number) {
      EXPECT_LT(key.fallback[0], key.choices.size());
      continue;
    }
    for (const double value : key.fallback) {
      EXPECT_GE(value, key.least);
      EXPECT_LE(value, key.most);
    }
  }
}

TEST(Scene, every_key_is_in_the_table_once) {
  std::set<std::string> seen;
  for (const Key& key : scene_keys()) {
    EXPECT_TRUE(seen.insert(std::string(key.table) + "." + std::string(key.name)).second) << key.name;
  }
}

TEST(Scene, time_step_is_a_time_or_auto_with_a_tolerance) {
  const Parameters fixed = parse_scene(k_scene + "[run]\ntime_step = \"2 ms\"\n", "s.toml").setup.parameters;
  EXPECT_FALSE(fixed.adaptive);
  EXPECT_EQ(fixed.time_step, 2e-3);
  const Parameters automatic =
      parse_scene(k_scene + "[run]\ntime_step = \"auto\"\ntolerance = 1e-4\n", "s.toml").setup.parameters;
  EXPECT_TRUE(automatic.adaptive);
  EXPECT_EQ(automatic.tolerance, 1e-4);
  EXPECT_TRUE(parse_scene(k_scene + "[run]\ntolerance = 1e-4\n", "s.toml").setup.parameters.adaptive);
}

TEST(Scene, alpha_and_time_step_follow_the_bodies_when_alpha_is_left_out) {
  const std::string floor = "[floor]\n";
  const topple::Setup chosen = parse_scene(k_cabinet_scene + floor, "s.toml").setup;
  const ContactLaw law;
  EXPECT_EQ(chosen.parameters.contact.alpha,
            rigid_alpha(chosen.model, law, chosen.parameters.gravity).value());
  EXPECT_EQ(
      chosen.parameters.contact.member_share,
      member_alpha(chosen.model, law, chosen.parameters.gravity).value() / chosen.parameters.contact.alpha);
  EXPECT_TRUE(chosen.parameters.adaptive);
  const topple::Setup named =
      parse_scene(k_cabinet_scene + floor + "[contact]\nalpha = \"50 kgf\"\n", "s.toml").setup;
  EXPECT_EQ(named.parameters.contact.alpha, 50 * k_standard_gravity);
  EXPECT_EQ(named.parameters.contact.member_share, 1);
  EXPECT_FALSE(named.parameters.adaptive);
  EXPECT_EQ(named.parameters.time_step, Parameters{}.time_step);
  const topple::Setup fixed = parse_scene(k_cabinet_scene + floor, "s.toml", {"run.time_step=0.002"}).setup;
  EXPECT_FALSE(fixed.parameters.adaptive);
  EXPECT_EQ(fixed.parameters.contact.alpha, chosen.parameters.contact.alpha);
}

TEST(Scene, displacement_control_names_a_node_of_a_frame_and_how_far_it_goes) {
  const std::string loaded =
      k_scene + "loads = [{ node = 1, force = [0, 0, 1] }]\ncopies = [[0, 0, 0], [0, 1, 0]]\n";
  const auto control = [&](const std::string& lines) {
    return *parse_scene(loaded + "[run]\nanalysis = \"static\"\ncontrol = { " + lines + " }\n", "s.toml")
                .setup.run.statics.control;
  };
  const PathControl first = control("node = 1, dof = \"z\"");
  EXPECT_EQ(first.node, 1);
  EXPECT_EQ(first.direction, 2);
  EXPECT_FALSE(first.to);
  const PathControl second = control("body = \"beam-2\", node = 1, dof = \"Y\", to_angle = \"180 deg\"");
  EXPECT_EQ(second.node, 4);  // a member of two elements has a node of its own
  EXPECT_EQ(second.direction, 4);
  EXPECT_NEAR(second.to.value(), k_pi, 1e-15);
}

TEST(Scene, choices_are_in_the_order_of_the_enumerations) {
  const auto law = [](const char* word) {
    return parse_scene(k_scene + "[contact]\nlaw = \"" + word + "\"\n", "s.toml")
        .setup.parameters.contact.kind;
  };
  EXPECT_EQ(law("coulomb"), ContactLawKind::coulomb);
  EXPECT_EQ(law("paper"), ContactLawKind::paper);
  EXPECT_EQ(law("printed"), ContactLawKind::printed);
  const auto integrator = [](const char* word) {
    return parse_scene(k_scene + "[run]\nintegrator = \"" + word + "\"\n", "s.toml")
        .setup.parameters.integrator;
  };
  EXPECT_EQ(integrator("auto"), Integrator::generalized_alpha);
  EXPECT_EQ(integrator("generalized-alpha"), Integrator::generalized_alpha);
  EXPECT_EQ(integrator("central-difference"), Integrator::central_difference);
  EXPECT_EQ(integrator("newmark"), Integrator::newmark);
  const auto analysis = [](const char* word) {
    return parse_scene(k_scene + "[run]\nanalysis = \"" + word + "\"\n", "s.toml").setup.run.analysis;
  };
  EXPECT_EQ(analysis("dynamic"), Analysis::dynamic);
  EXPECT_EQ(analysis("static"), Analysis::statics);
  EXPECT_EQ(analysis("modes"), Analysis::modes);
  const auto stop = [](const char* word) {
    return parse_scene(k_scene + "[run]\nstop_when = \"" + word + "\"\n", "s.toml").setup.run.stop_when;
  };
  EXPECT_EQ(stop("all-overturned"), StopWhen::all_overturned);
  EXPECT_EQ(stop("at-rest"), StopWhen::at_rest);
  const auto pulse = [](const char* word) {
    const std::string text =
        k_scene + "[[shake]]\ntype = \"pulse\"\nduration = 1\namplitude = 1\nshape = \"" + word + "\"\n";
    return parse_scene(text, "s.toml").setup.parameters.shakes.at(0).shape;
  };
  EXPECT_EQ(pulse("half-sine"), Shake::Shape::half_sine);
  EXPECT_EQ(pulse("full-sine"), Shake::Shape::full_sine);
  EXPECT_EQ(pulse("rectangle"), Shake::Shape::rectangle);
}

TEST(Scene, choices_of_a_cabinet_shape_the_body) {
  const auto height = [](const char* pose) {
    const Model model = parse_scene(k_cabinet_scene + "pose = \"" + pose + "\"\n", "s.toml").setup.model;
    double least = 1e9, most = -1e9;
    for (const Vec3& x : model.node_position) {
      least = std::min(least, x.z());
      most = std::max(most, x.z());
    }
    return most - least;
  };
  EXPECT_NEAR(height("upright"), 1.79, 1e-12);
  EXPECT_NEAR(height("on-back"), 0.38, 1e-12);
  EXPECT_NEAR(height("on-front"), 0.38, 1e-12);
  EXPECT_NEAR(height("on-side"), 0.88, 1e-12);
  const std::string inertia = "inertia = [22.6, 18.9, 6.5]\n";
  const Model braced = parse_scene(k_cabinet_scene + inertia, "s.toml").setup.model;
  const Model bare = parse_scene(k_cabinet_scene + inertia + "bracing = \"none\"\n", "s.toml").setup.model;
  EXPECT_NEAR(bare.bodies.at(0).inertia(1, 1), 18.9, 1e-6);
  EXPECT_GT(braced.members.size(), bare.members.size());
}

TEST(Scene, units_convert_to_si) {
  const std::vector<std::tuple<const char*, Dimension, double>> cases{
      {"1.5 m", Dimension::length, 1.5},
      {"70 cm", Dimension::length, 0.7},
      {"30mm", Dimension::length, 0.03},
      {"-2 km", Dimension::length, -2000},
      {"20 s", Dimension::time, 20},
      {"1 ms", Dimension::time, 1e-3},
      {"2 min", Dimension::time, 120},
      {"40 kg", Dimension::mass, 40},
      {"500 g", Dimension::mass, 0.5},
      {"2 t", Dimension::mass, 2000},
      {"3 N", Dimension::force, 3},
      {"2 kN", Dimension::force, 2000},
      {"1 MN", Dimension::force, 1e6},
      {"50 kgf", Dimension::force, 50 * 9.80665},
      {"7 Pa", Dimension::stress, 7},
      {"7 kPa", Dimension::stress, 7e3},
      {"235 MPa", Dimension::stress, 235e6},
      {"205 GPa", Dimension::stress, 205e9},
      {"235 N/mm^2", Dimension::stress, 235e6},
      {"1 m/s^2", Dimension::acceleration, 1},
      {"190 gal", Dimension::acceleration, 1.9},
      {"190 cm/s^2", Dimension::acceleration, 1.9},
      {"0.2 g", Dimension::acceleration, 0.2 * 9.80665},
      {"1 m/s", Dimension::velocity, 1},
      {"1 cm/s", Dimension::velocity, 0.01},
      {"1 mm/s", Dimension::velocity, 0.001},
      {"0.5 Hz", Dimension::frequency, 0.5},
      {"1 rad", Dimension::angle, 1},
      {"180 deg", Dimension::angle, k_pi},
      {"7850 kg/m^3", Dimension::density, 7850},
      {"7.85 t/m^3", Dimension::density, 7850},
      {"2 m^2", Dimension::area, 2},
      {"2 cm^2", Dimension::area, 2e-4},
      {"116 mm^2", Dimension::area, 116e-6},
      {"2 m^4", Dimension::second_moment, 2},
      {"2 cm^4", Dimension::second_moment, 2e-8},
      {"16300 mm^4", Dimension::second_moment, 1.63e-8},
      {"2 rad/s", Dimension::angular_velocity, 2},
      {"180 deg/s", Dimension::angular_velocity, k_pi},
      {"3 kg m^2", Dimension::inertia, 3},
      {"3 N m", Dimension::moment, 3},
      {"3 kN m", Dimension::moment, 3000},
      {" +1e3  mm ", Dimension::length, 1},
  };
  for (const auto& [text, dimension, expected] : cases) {
    const Quantity quantity = parse_quantity(text, dimension);
    ASSERT_TRUE(quantity.si) << text << ": " << quantity.problem;
    EXPECT_DOUBLE_EQ(*quantity.si, expected) << text;
  }
  for (const Unit& unit : units()) {
    EXPECT_DOUBLE_EQ(*parse_quantity("1 " + std::string(unit.symbol), unit.dimension).si, unit.si)
        << unit.symbol;
  }
}

TEST(Scene, decimal_units_round_like_the_decimal_number) {
  EXPECT_EQ(*parse_quantity("70 cm", Dimension::length).si, 0.7);
  EXPECT_EQ(*parse_quantity("380 mm", Dimension::length).si, 0.38);
  EXPECT_EQ(*parse_quantity("1790 mm", Dimension::length).si, 1.79);
  EXPECT_EQ(*parse_quantity("190 gal", Dimension::acceleration).si, 1.9);
}

TEST(Scene, a_number_without_unit_is_in_si) {
  const topple::Setup text = parse_scene(k_scene + "[contact]\nalpha = \"50 kgf\"\n", "s.toml").setup;
  const topple::Setup number = parse_scene(k_scene + "[contact]\nalpha = 490.3325\n", "s.toml").setup;
  EXPECT_DOUBLE_EQ(text.parameters.contact.alpha, number.parameters.contact.alpha);
}

TEST(Scene, directions_are_made_unit_vectors) {
  const std::string text = k_scene +
                           "[floor]\n[[wall]]\nat = [1, 2]\nnormal = [-3, 0, 4]\nwidth = \"90 mm\"\n"
                           "[[shake]]\nfrequency = 1\namplitude = 1\ndirection = [0, 2, 0]\n";
  const topple::Setup setup = parse_scene(text, "s.toml").setup;
  EXPECT_EQ(setup.parameters.shakes.at(0).direction, Vec3::UnitY());
  ASSERT_EQ(setup.model.planes.size(), 2u);
  EXPECT_EQ(setup.model.planes[0].name, "floor");
  EXPECT_EQ(setup.model.planes[0].normal, Vec3::UnitZ());
  EXPECT_EQ(setup.model.planes[0].width, 0);
  EXPECT_EQ(setup.model.planes[1].name, "wall-1");
  EXPECT_TRUE(setup.model.planes[1].normal.isApprox(Vec3(-0.6, 0, 0.8)));
  EXPECT_EQ(setup.model.planes[1].point, Vec3(1, 2, 0));
  EXPECT_EQ(setup.model.planes[1].width, 0.09);
}

TEST(Scene, sections_are_completed_and_custom_ones_taken_as_they_are) {
  const std::string text =
      k_scene +
      "[[section]]\nname = \"rod\"\nshape = \"pipe\"\nsize = \"30 mm\"\nthickness = \"1 mm\"\n"
      "[[section]]\nname = \"rod2\"\nshape = \"pipe\"\nsize = [\"30 mm\"]\nthickness = \"1 mm\"\n"
      "[[section]]\nname = \"mine\"\nshape = \"custom\"\narea = 1\niy = 2\niz = 3\nj = 4\nky = 5\nkz = "
      "6\nwidth = 7\n"
      "[[section]]\nname = \"bar\"\nshape = \"solid\"\nsize = [0.02, 0.04]\n";
  const std::vector<Section> sections = parse_scene(text, "s.toml").setup.model.sections;
  ASSERT_EQ(sections.size(), 5u);
  EXPECT_NEAR(sections[0].area, 116e-6, 1e-12);
  EXPECT_NEAR(sections[1].area, k_pi * 29e-6, 1e-12);
  EXPECT_EQ(sections[1].area, sections[2].area);
  EXPECT_EQ(sections[1].size_y, 0.03);
  EXPECT_EQ(sections[1].size_z, 0.03);
  EXPECT_EQ(sections[3].area, 1);
  EXPECT_EQ(sections[3].iy, 2);
  EXPECT_EQ(sections[3].iz, 3);
  EXPECT_EQ(sections[3].j, 4);
  EXPECT_EQ(sections[3].ky, 5);
  EXPECT_EQ(sections[3].kz, 6);
  EXPECT_EQ(sections[3].width, 7);
  EXPECT_EQ(sections[3].fibre_y(), 3.5);
  EXPECT_NEAR(sections[4].area, 8e-4, 1e-15);
  EXPECT_EQ(sections[4].size_y, 0.02);
  EXPECT_EQ(sections[4].size_z, 0.04);
}

TEST(Scene, frames_carry_supports_loads_masses_and_copies) {
  const std::string text =
      k_head + k_library +
      "[run]\nsettle = false\n"
      "[[frame]]\nname = \"beam\"\nnodes = [[0, 0, 0], [1, 0, 0]]\n"
      "members = [{ nodes = [0, 1], section = \"post\", material = \"steel\", elements = 4 }]\n"
      "supports = [{ node = 0, fix = \"xyz\" }, { node = 0, fix = \"X\" }]\n"
      "loads = [{ node = 1, force = [0, 0, \"-1 kN\"], moment = [1, 2, 3], history = [[0, 1], [\"500 ms\", "
      "0]] }]\n"
      "masses = [{ node = 1, mass = \"2 kg\", inertia = [1, 2, 3] }]\n"
      "copies = [[0, 0, 0], [0, \"2 m\", 0]]\nvelocity = [1, 0, 0]\n"
      "[[probe]]\nname = \"tip\"\nbody = \"beam-2\"\nnode = 1\n[[probe]]\nbody = \"beam\"\n";
  const topple::Setup setup = parse_scene(text, "s.toml").setup;
  ASSERT_EQ(setup.model.bodies.size(), 2u);
  EXPECT_EQ(setup.model.bodies[0].name, "beam");
  EXPECT_EQ(setup.model.bodies[1].name, "beam-2");
  EXPECT_EQ(setup.starts.size(), 2u);
  EXPECT_EQ(setup.starts[1].velocity, Vec3::UnitX());
  EXPECT_EQ(setup.model.elements.size(), 8u);
  ASSERT_EQ(setup.model.supports.size(), 2u);
  EXPECT_EQ(setup.model.supports[0].fixed, 0b001111u);
  ASSERT_EQ(setup.model.loads.size(), 2u);
  EXPECT_EQ(setup.model.loads[0].force, Vec3(0, 0, -1000));
  EXPECT_EQ(setup.model.loads[0].moment, Vec3(1, 2, 3));
  EXPECT_EQ(setup.model.loads[0].history, (std::vector<std::pair<double, double>>{{0, 1}, {0.5, 0}}));
  EXPECT_NEAR(setup.model.bodies[0].mass, 2 + 7850 * 116e-6, 1e-9);
  const Mat3 added = setup.model.node_inertia[1] - setup.model.node_inertia[0];
  EXPECT_LT((added - Mat3(Vec3(1, 2, 3).asDiagonal())).norm(), 1e-14);
  ASSERT_EQ(setup.probes.size(), 2u);
  EXPECT_EQ(setup.probes[0].body, 1);
  EXPECT_EQ(setup.model.node_position[setup.probes[0].node], Vec3(1, 2, 0));
  EXPECT_EQ(setup.probes[1].name, "probe-2");
  EXPECT_EQ(setup.probes[1].node, -1);
}

TEST(Scene, cabinets_have_copies_that_probes_find_and_that_do_not_shift_the_nodes_of_frames) {
  std::string beam = k_beam;
  beam.replace(beam.find("[[0, 0, 0], [1, 0, 0]]"), 22, "[[5, 0, 0], [6, 0, 0]]");
  const std::string text = k_cabinet_scene + "copies = [[0, 0, 0], [2, \"1 m\", 0.5]]\nyaw = 1\n" + beam +
                           "[[probe]]\nbody = \"free-2\"\n[[probe]]\nbody = \"beam\"\nnode = 1\n";
  const topple::Setup setup = parse_scene(text, "s.toml").setup;
  const Model& model = setup.model;
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.bodies[0].name, "free");
  EXPECT_EQ(model.bodies[1].name, "free-2");
  EXPECT_EQ(setup.starts.size(), 3u);
  EXPECT_EQ(setup.parameters.models.size(), 3u);
  ASSERT_EQ(model.bodies[1].node_count, model.bodies[0].node_count);
  for (int i = 0; i < model.bodies[0].node_count; ++i) {
    const int a = model.bodies[0].first_node + i, b = model.bodies[1].first_node + i;
    EXPECT_LT((model.node_position[b] - model.node_position[a] - Vec3(2, 1, 0.5)).norm(), 1e-12);
    EXPECT_NEAR(model.node_mass[b], model.node_mass[a], 1e-9);
  }
  ASSERT_EQ(setup.probes.size(), 2u);
  EXPECT_EQ(setup.probes[0].body, 1);
  EXPECT_EQ(setup.probes[1].node, model.bodies[2].first_node + 1);
}

TEST(Scene, overrides_set_what_the_file_says_and_what_it_does_not) {
  const std::string text =
      k_cabinet_scene + "mass = 40\n[[shake]]\nfrequency = 1\namplitude = 1\n[run]\ngravity = [0, 0, -9]\n";
  const Scene scene = parse_scene(text, "s.toml",
                                  {"cabinet.free.mass=30", "contact.alpha=100 kgf", "contact.friction = 0.25",
                                   "shake.1.amplitude=\"250 gal\"", "run.duration=5 s",
                                   "cabinet.1.model=frame", "title=A title", "run.gravity.3 = -5"});
  const topple::Setup& setup = scene.setup;
  EXPECT_NEAR(setup.model.bodies.at(0).mass, 30, 1e-9);
  EXPECT_DOUBLE_EQ(setup.parameters.contact.alpha, 100 * k_standard_gravity);
  EXPECT_EQ(setup.parameters.contact.friction, 0.25);
  EXPECT_EQ(setup.parameters.shakes.at(0).amplitude, 2.5);
  EXPECT_EQ(setup.run.duration, 5);
  EXPECT_EQ(setup.parameters.gravity, Vec3(0, 0, -5));
  EXPECT_EQ(scene.title, "A title");
}

TEST(Scene, the_last_override_of_a_key_counts) {
  const Scene scene = parse_scene(k_scene, "s.toml", {"contact.q=2", "contact.q=3"});
  EXPECT_EQ(scene.setup.parameters.contact.q, 3);
}

TEST(Scene, names_with_dots_are_found_by_overrides) {
  std::string text = k_cabinet_scene;
  text.replace(text.find("\"free\""), 6, "\"a.b\"");
  EXPECT_NEAR(parse_scene(text, "s.toml", {"cabinet.a.b.mass=12"}).setup.model.bodies.at(0).mass, 12, 1e-9);
}

TEST(Scene, an_override_replaces_a_whole_entry) {
  const std::string text = k_cabinet_scene + "[[shake]]\nname = \"floor\"\nfrequency = 1\namplitude = 1\n";
  const Scene scene =
      parse_scene(text, "s.toml", {"shake.floor={ type = \"record\", files = [\"near-fault.csv\"] }"});
  ASSERT_EQ(scene.setup.parameters.shakes.size(), 1u);
  EXPECT_TRUE(scene.setup.parameters.shakes[0].record);
  EXPECT_NE(error_of(text, {"shake.floor.type=record"}).find("shake.floor.frequency"), std::string::npos);
}

TEST(Scene, an_override_finds_an_entry_by_what_results_call_it) {
  std::string text = k_cabinet_scene;
  text.erase(text.find("name = \"free\"\n"), 14);
  const Scene scene = parse_scene(text, "s.toml", {"cabinet.cabinet-1.mass=12"});
  EXPECT_EQ(scene.setup.model.bodies.at(0).name, "cabinet-1");
  EXPECT_NEAR(scene.setup.model.bodies.at(0).mass, 12, 1e-9);
}

TEST(Scene, text_is_verbatim_without_overrides_and_repeats_the_scene_with_them) {
  const std::string text = "# a comment\n" + k_scene + "[contact]\nfriction = 0.125 # so\n";
  EXPECT_EQ(parse_scene(text, "s.toml").text, text);
  for (const BuiltinScene& builtin : builtin_scenes()) {
    const std::vector<std::string> overrides{"contact.q=3", "contact.friction=0.1",
                                             "title=\"a \\\"b\\\" \\\\\""};
    const Scene changed = parse_scene(builtin.text, "s.toml", overrides);
    const Scene again = parse_scene(changed.text, "s.toml");
    EXPECT_EQ(again.title, "a \"b\" \\");
    EXPECT_EQ(again.setup.parameters.contact.q, 3);
    EXPECT_EQ(again.setup.parameters.contact.friction, 0.1);
    EXPECT_EQ(again.setup.model.node_position, changed.setup.model.node_position) << builtin.name;
    EXPECT_EQ(again.setup.model.node_mass, changed.setup.model.node_mass) << builtin.name;
    EXPECT_EQ(write_toml(parse_toml(changed.text, "s.toml")), changed.text);
  }
}

TEST(Scene, is_named_after_its_file) {
  EXPECT_EQ(parse_scene(k_scene, "some/where/desk.toml").name, "desk");
  EXPECT_EQ(parse_scene(k_scene, "some/where/desk.toml").title, "desk");
  EXPECT_EQ(load_scene("paper-a").name, "paper-a");
}

TEST(Scene, a_file_wins_over_a_built_in_scene) {
  const auto folder = std::filesystem::temp_directory_path() / "topple-scene-test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "desk.toml";
  std::ofstream(file) << k_scene;
  const Scene scene = load_scene(file.string());
  EXPECT_EQ(scene.name, "desk");
  EXPECT_EQ(scene.text, k_scene);
  std::filesystem::remove_all(folder);
}

TEST(Scene, anchors_hold_the_nearest_node_at_the_end_of_an_arm) {
  const std::string cabinet =
      k_cabinet_scene +
      "tilt = \"2 deg\"\n[run]\nsettle = false\n[[anchor]]\n"
      "body = \"free\"\npoint = [-0.18, 0.4, 1.7]\nto = [-0.4, 0.4, \"170 cm\"]\n"
      "stiffness = \"50 kN/m\"\n[[anchor]]\nname = \"strut\"\nbody = \"free\"\n"
      "point = [0.2, -0.4, 1.7]\nto = [1, -0.4, 0]\ntype = \"pole\"\nstiffness = 1e4\n"
      "strength = \"2 kN\"\non = false\n";
  const Scene scene = parse_scene(cabinet, "s.toml", {"anchor.strut.strength=3 kN"});
  const Model& model = scene.setup.model;
  ASSERT_EQ(model.anchors.size(), 2u);
  const State start = start_state(model, scene.setup.starts);
  const Vec3 points[] = {{-0.18, 0.4, 1.7}, {0.2, -0.4, 1.7}};
  for (int k = 0; k < 2; ++k) {
    const Anchor& a = model.anchors[k];
    EXPECT_LT((anchor_point(model, start, k).at - points[k]).norm(), 1e-12);
    for (const Vec3& x : start.position)
      EXPECT_GE((x - points[k]).norm(), (start.position[a.node] - points[k]).norm());
    EXPECT_NEAR(a.length, (points[k] - a.to).norm(), 1e-12);
  }
  EXPECT_EQ(model.anchors[0].name, "anchor-1");
  EXPECT_EQ(model.anchors[0].type, Anchor::Type::strap);
  EXPECT_EQ(model.anchors[0].stiffness, 5e4);
  EXPECT_FALSE(std::isfinite(model.anchors[0].strength));
  EXPECT_EQ(model.anchors[0].to, Vec3(-0.4, 0.4, 1.7));
  EXPECT_EQ(model.anchors[1].type, Anchor::Type::pole);
  EXPECT_EQ(model.anchors[1].strength, 3e3);
  EXPECT_EQ(scene.setup.parameters.anchors, (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace topple::io
