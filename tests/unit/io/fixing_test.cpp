// [[fixing]], [[anchor]] to_body and the floor of a building, from the text of a scene to what happens.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/body/anchors.h"
#include "solver/io/scene/fixing_kinds.h"
#include "solver/io/scene/scene.h"
#include "solver/model/building.h"
#include "solver/model/excitation.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

/// Two blocks of 0.3 x 0.6 x 1.8 m side by side before a wall, 20 mm between their surfaces, on a floor.
std::string blocks(const std::string& rest) {
  return R"(topple = 1
[run]
duration = "17 s"
want = ["motion"]
[[shake]]
frequency = "0.01 Hz"
amplitude = "0.45 g"
[contact]
friction = 1.2
[floor]
[ceiling]
at = "2.5 m"
[[wall]]
name = "back"
at = [-0.22, 0]
normal = [1, 0, 0]
[[block]]
name = "left"
size = [0.3, 0.6, 1.8]
mass = 60
at = [0, 0]
[[block]]
name = "right"
size = [0.3, 0.6, 1.8]
mass = 60
at = [0.335, 0]
)" + rest;
}

Scene scene_of(const std::string& rest) {
  return parse_scene(blocks(rest), "s.toml");
}

std::string refusal(const std::string& rest) {
  try {
    scene_of(rest);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Vec3 held_point(const Anchor& anchor, const State& start) {
  return start.position[anchor.node] + start.rotation[anchor.node] * anchor.arm;
}

// Its feet are further than 100 mm from every node of the desk, but on its top.
TEST(Fixing, a_mat_sticks_a_television_to_the_top_of_a_desk) {
  const Scene scene = parse_scene(R"(topple = 1
floor = {}
furniture = [
  { name = "desk", kind = "desk", at = [0, 0] },
  { name = "screen", kind = "television", size = [0.2, 0.5, 0.4], at = [0, 0, 0.71] },
]
fixing = [{ kind = "mat", body = "screen", to = "desk" }]
)",
                                  "s.toml");
  const Model& model = scene.setup.model;
  ASSERT_EQ(model.anchors.size(), 4u);
  const State start = start_state(model, scene.setup.starts);
  for (const Anchor& anchor : model.anchors) {
    const Vec3 held = held_point(anchor, start);
    const Vec3 foot = Vec3(held.x(), held.y(), 0.7);
    EXPECT_LT((held - foot).norm(), 0.05);  // half of the top's and of the screen's thickness, and the gap
    EXPECT_LT(std::abs(held.x()), 0.11);
    EXPECT_LT(std::abs(held.y()), 0.26);
  }
}

// The plinth is twice as wide: no corner of it is within reach of one of the statue's.
TEST(Fixing, a_mat_sticks_a_statue_to_the_face_of_its_plinth) {
  const Scene scene = parse_scene(R"(topple = 1
run = { duration = 1 }
floor = {}
shake = [{ frequency = 1, amplitude = "200 gal" }]
block = [
  { name = "plinth", size = [0.4, 0.4, 1], mass = 120, at = [0, 0], yaw = "30 deg" },
  { name = "statue", size = [0.2, 0.2, 0.6], mass = 40, at = [0, 0, 1.02], yaw = "30 deg" },
]
fixing = [{ kind = "mat", body = "statue", to = "plinth" }]
)",
                                  "s.toml");
  const Model& model = scene.setup.model;
  ASSERT_EQ(model.anchors.size(), 4u);
  const State start = start_state(model, scene.setup.starts);
  for (const Anchor& anchor : model.anchors) {
    EXPECT_EQ(anchor.other.body, 0);
    const Vec3 held = held_point(anchor, start);
    const Vec3 there =
        start.position[anchor.other.node] + start.rotation[anchor.other.node] * anchor.other.arm;
    EXPECT_LT((held - there).norm(), 1e-12);  // a pin
    EXPECT_NEAR(held.z(), 1.02, 0.03);
    EXPECT_LT((held - start.position[anchor.node]).norm(), 0.03);
  }
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok());
  EXPECT_LT(run.outcome().bodies()[1].peak_tilt, 1e-3);
}

std::string fixing(const std::string& kind, const std::string& to, const std::string& rest = "") {
  return "[[fixing]]\nname = \"it\"\nkind = \"" + kind + "\"\nbody = \"left\"\nto = \"" + to + "\"\n" + rest;
}

/// What a kind may hold "left" to.
std::string target(const FixingTraits& kind) {
  return kind.place == FixingPlace::feet ? "floor"
         : kind.to_body                  ? "right"
         : kind.to_ceiling               ? "ceiling"
                                         : "floor";
}

TEST(Fixing, finds_its_points_and_has_the_numbers_of_its_kind) {
  for (const FixingTraits& kind : k_fixings) {
    if (kind.lift > 0) continue;
    const std::string to = target(kind);
    const Scene scene = scene_of(fixing(kind.word, to));
    const Model& model = scene.setup.model;
    ASSERT_FALSE(model.anchors.empty()) << kind.word;
    EXPECT_EQ(model.anchors.size(), kind.place == FixingPlace::feet ? 4u : 1u);
    for (const Anchor& anchor : model.anchors) {
      EXPECT_EQ(anchor.fixing, kind.word);
      EXPECT_EQ(anchor.fixing_number, 1);
      EXPECT_EQ(anchor.stiffness, kind.stiffness);
      EXPECT_EQ(anchor.strength, kind.strength);
      EXPECT_EQ(anchor.other.body, to == "right" ? 1 : -1);
      EXPECT_EQ(anchor.length == 0, kind.pin);
    }
  }
}

TEST(Fixing, takes_the_upper_corners_next_to_the_wall_and_the_keys_of_the_anchor) {
  const Scene scene =
      scene_of(fixing("L-bracket", "back", "strength = \"900 N\"\nstiffness = \"77 kN/m\"\n"));
  const Model& model = scene.setup.model;
  ASSERT_EQ(model.anchors.size(), 2u);
  double side = 0;
  for (const Anchor& anchor : model.anchors) {
    const Vec3& node = model.node_position[anchor.node];
    EXPECT_NEAR(node.x(), -0.15, 1e-9);
    EXPECT_NEAR(std::abs(node.y()), 0.3, 1e-9);
    EXPECT_NEAR(node.z(), 1.8, 0.1);
    EXPECT_NEAR(anchor.to.x(), -0.22, 1e-12);
    EXPECT_NEAR(anchor.to.z(), node.z(), 1e-12);
    EXPECT_EQ(anchor.strength, 900);
    EXPECT_EQ(anchor.stiffness, 77e3);
    EXPECT_EQ(anchor.arm.norm(), 0);
    side += node.y();
  }
  EXPECT_NEAR(side, 0, 1e-9);
}

TEST(Fixing, a_pole_pushes_with_its_preload_from_the_start) {
  const Scene scene = scene_of(fixing("pole", "ceiling", "preload = \"150 N\"\n"));
  topple::Run run(scene.setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  ASSERT_TRUE(run.advance().ok());
  // the block settles by some micrometres more than without it
  EXPECT_NEAR(run.outcome().anchors()[0].tension, -150, 1);
  const Vec3 top = held_point(scene.setup.model.anchors[0], run.state());
  EXPECT_LT(top.head<2>().norm(), 1e-4) << "not in the middle of the top";
  EXPECT_NEAR(top.z(), 1.8, 0.01);
}

// Two wedges lift the front edge until the shelf's back leans on the wall, 10 mm off, 1.785 m above its feet:
// whatever its contacts and its model are, and without sliding.
TEST(Fixing, a_stopper_leans_a_heavy_shelf_on_the_wall_where_it_stands) {
  const std::string text = R"(topple = 1
[run]
want = ["motion"]
[floor]
[[wall]]
name = "back"
at = [0, 0]
normal = [1, 0, 0]
[[furniture]]
kind = "bookshelf"
against = "back"
gap = "10 mm"
[[fixing]]
name = "stop"
kind = "stopper"
body = "bookshelf"
to = "floor"
)";
  for (const std::vector<std::string>& set :
       std::vector<std::vector<std::string>>{{},
                                             {"wall.1.at=[-0.2, 0]"},
                                             {"contact.alpha=\"20000 kgf\""},
                                             {"furniture.1.model=elastic"},
                                             {"furniture.1.model=frame"}}) {
    SCOPED_TRACE(set.empty() ? "" : set.front());
    const Scene scene = parse_scene(text, "s.toml", set);
    topple::Run run(scene.setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
    // the wall gives by what half a per cent of the weight takes, a frame bends
    EXPECT_NEAR(run.outcome().bodies()[0].tilt, std::atan(10 / 1785.), 0.03 * std::atan(10 / 1785.));
    EXPECT_LT(run.outcome().bodies()[0].slide, 3e-4);
  }
}

// Bolted to it too: nothing strains the bolts as the run begins.
TEST(Fixing, what_stands_on_a_piece_leans_with_it_on_its_stopper) {
  const std::string text = R"(topple = 1
floor = {}
[[wall]]
name = "back"
at = [0, 0]
normal = [1, 0, 0]
[[furniture]]
kind = "chest"
against = "back"
gap = "30 mm"
[[furniture]]
kind = "television"
size = ["200 mm", "700 mm", "450 mm"]
at = [0.24, 0, 1.0]
[[fixing]]
kind = "stopper"
body = "chest"
to = "floor"
)";
  for (const char* gap : {"furniture.1.gap=30 mm", "furniture.1.gap=2 mm"}) {
    const topple::Setup setup = parse_scene(text, "s.toml", {gap}).setup;
    ASSERT_EQ(setup.starts.size(), 2u);
    EXPECT_FALSE(setup.starts[0].rotation.isZero(0)) << gap;
    EXPECT_EQ(setup.starts[1].rotation, setup.starts[0].rotation) << gap;
    EXPECT_EQ(setup.starts[1].pivot, setup.starts[0].pivot) << gap;
    const State start = start_state(setup.model, setup.starts);
    for (int p = 0; p < static_cast<int>(setup.model.contact_points.size()); ++p) {
      const ContactPoint& point = setup.model.contact_points[p];
      EXPECT_GT(start.position[point.node].x(), point.width / 2 - 1e-6) << gap;
    }
  }
}

TEST(Fixing, a_stopper_that_is_not_in_place_lifts_nothing_and_is_known) {
  const Scene scene = parse_scene(blocks(fixing("stopper", "back")), "s.toml", {"fixing.1.on=false"});
  ASSERT_EQ(scene.setup.wedges.size(), 1u);
  EXPECT_FALSE(scene.setup.wedges[0].in_place());
  EXPECT_TRUE(scene.setup.starts[scene.setup.wedges[0].body].rotation.isZero(0));
}

// Where the wall is out of reach the front edge stands 10 mm higher than the back edge, 0.3 m behind it: what
// tips the block over the front is the tangent of a greater angle, and it slides at mu g, as without wedges.
TEST(Fixing, a_stopper_lifts_the_front_edge_and_rubs_as_feet_do) {
  const double lift = traits(FixingKind::stopper).lift, back = std::asin(lift / 0.3);
  const auto after = [](double share_of_g) { return std::asin(share_of_g / 0.45) / (2 * k_pi * 0.01); };
  const auto made = [](const char* friction) {
    return parse_scene(blocks(fixing("stopper", "back")), "s.toml",
                       {"shake.1.direction=[-1, 0, 0]", std::string("contact.friction=") + friction});
  };
  const Scene scene = made("1.2");
  ASSERT_EQ(scene.setup.wedges.size(), 1u);
  EXPECT_NEAR(scene.setup.wedges[0].lift, lift, 1e-9);
  EXPECT_EQ(scene.setup.wedges[0].nodes.size(), 2u);
  EXPECT_TRUE(scene.setup.model.anchors.empty());
  topple::Run rocking(scene.setup);
  ASSERT_TRUE(rocking.status().ok()) << rocking.status().message(scene.setup.model);
  const BodyOutcome& tipped = rocking.outcome().bodies()[0];
  EXPECT_NEAR(tipped.tilt, back, 0.1 * back);  // the feet give, under the front corners less
  while (!tipped.first_uplift && !rocking.over()) ASSERT_TRUE(rocking.advance().ok());
  ASSERT_TRUE(tipped.first_uplift);
  EXPECT_NEAR(*tipped.first_uplift, after(std::tan(std::atan(0.3 / 1.8) + back)), 0.3);  // 2 % of g b/h

  const Scene smooth = made("0.1");
  topple::Run sliding(smooth.setup);
  const BodyOutcome& slid = sliding.outcome().bodies()[0];
  while (sliding.state().time < after(0.1) - 0.2) ASSERT_TRUE(sliding.advance().ok());
  EXPECT_LT(slid.slide, 1e-4);
  while (sliding.state().time < after(0.1) + 1) ASSERT_TRUE(sliding.advance().ok());
  // what the floor accelerates by beyond mu g grows evenly
  const double grows = 0.45 * k_standard_gravity * 2 * k_pi * 0.01 * std::cos(2 * k_pi * 0.01 * after(0.1));
  EXPECT_NEAR(slid.slide, grows / 6, 0.2 * grows / 6);
}

std::string shelf_at_wall(const std::string& kind, const std::string& run) {
  return "topple = 1\nfloor = {}\nwall = [{ name = \"back\", at = [0, 0], normal = [1, 0, 0] }]\n"
         "furniture = [{ kind = \"bookshelf\", name = \"shelf\", against = \"back\" }]\n"
         "fixing = [{ name = \"it\", kind = \"" +
         kind + "\", body = \"shelf\", to = \"back\" }]\n" + run;
}

// Before the shelf lifts its brackets share the moment with the floor, as it bends: an elastic one knows how
// it bends between them. Without that they bore 1.7 times as much. The two are mirror images.
TEST(Fixing, brackets_of_an_elastic_shelf_bear_what_those_of_a_frame_do) {
  const auto greatest = [](const char* model) {
    const Scene scene = parse_scene(
        shelf_at_wall("L-bracket",
                      "shake = [{ frequency = 0.5, amplitude = \"150 gal\" }]\nrun = { duration = 0.7 }\n"),
        "s.toml", {std::string("furniture.1.model=") + model});
    topple::Run run(scene.setup);
    while (!run.over())
      if (!run.advance().ok()) ADD_FAILURE() << run.status().message(scene.setup.model);
    const std::vector<AnchorOutcome>& both = run.outcome().anchors();
    EXPECT_EQ(both.size(), 2u);
    EXPECT_NEAR(both[0].peak_force, both[1].peak_force, 1e-3 * both[0].peak_force) << model;
    return both[0].peak_force;
  };
  const double frame = greatest("frame");
  EXPECT_GT(frame, 10);
  EXPECT_NEAR(greatest("elastic"), frame, 0.01 * frame);  // 12 shapes of a body that bends
}

// The stopper drives the shelf back until its feet lean on the wall, where friction holds them above the
// floor: what bears them again after a hop is that, and a hop a second is counted, forth and back.
TEST(Fixing, hops_of_feet_that_a_wall_holds_up_are_counted) {
  const Scene scene =
      parse_scene(shelf_at_wall("stopper",
                                "shake = [{ frequency = 1, amplitude = \"300 gal\", taper = 1 }]\n"
                                "run = { duration = 10, want = [\"motion\"] }\n"),
                  "s.toml");
  topple::Run run(scene.setup);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
  EXPECT_GE(run.outcome().bodies()[0].impacts, 8);
}

TEST(Fixing, a_point_and_another_fixing_have_two_names) {
  EXPECT_EQ(refusal(fixing("L-bracket", "back") +
                    "[[fixing]]\nname = \"it-2\"\nkind = \"strap\"\nbody = \"left\"\nto = \"back\"\n"
                    "at = [-0.15, 0, 1.7]\n"),
            "s.toml:33:8: fixing.it-2.name: \"it-2\" is that of a point of another fixing too");
}

// On a floor that gives way by 4 mm under the block's feet the mats bear none of its weight, nor what its
// lower edge presses with while it leans; the corners that lift pull.
TEST(Fixing, a_mat_bears_no_push) {
  const Scene scene = parse_scene(blocks(fixing("mat", "floor")), "s.toml",
                                  {"contact.alpha=\"100 kgf\"", "run.duration=\"8 s\""});
  topple::Run run(scene.setup);
  ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  for (const AnchorOutcome& mat : run.outcome().anchors()) EXPECT_LT(std::abs(mat.tension), 1e-6);
  while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
  const Model& model = scene.setup.model;
  const std::vector<AnchorForce> forces = anchor_forces(model, run.state());
  int lifted = 0;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    Vec3 away = anchor_point(model, run.state(), static_cast<int>(k)).at - model.anchors[k].to;
    lifted += away.z() > 0;
    away.z() = std::max(away.z(), 0.);
    EXPECT_NEAR(forces[k].tension, model.anchors[k].stiffness * away.norm(), 1e-6);
  }
  EXPECT_GT(run.outcome().bodies()[0].peak_tilt, 1e-3);
  EXPECT_LT(lifted, 4);
}

TEST(Fixing, every_kind_is_run_through) {
  for (const FixingTraits& kind : k_fixings) {
    SCOPED_TRACE(kind.word);
    Scene scene = scene_of(fixing(kind.word, target(kind)));
    scene.setup.run.duration = 1;
    topple::Run run(scene.setup);
    ASSERT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
    while (!run.over()) ASSERT_TRUE(run.advance().ok()) << run.status().message(scene.setup.model);
    EXPECT_LT(run.state().energy.balance_error(), 1e-2);
    for (const AnchorOutcome& anchor : run.outcome().anchors()) EXPECT_FALSE(anchor.broke);
  }
}

TEST(Fixing, what_cannot_be_is_told_in_a_line_with_its_place) {
  EXPECT_EQ(
      refusal(fixing("strap", "front")),
      "s.toml:31:6: fixing.it.to: there is no wall, body, floor or ceiling \"front\"; known: floor, ceiling, "
      "back, left, right");
  EXPECT_EQ(refusal(fixing("pole", "back")),
            "s.toml:31:6: fixing.it.to: a pole pushes only, between the top and the ceiling; it leads to the "
            "ceiling, not to \"back\"");
  const std::string low = blocks(fixing("pole", "ceiling"));
  const auto refused = [&](const std::string& set, const std::string& scene = {}) {
    try {
      parse_scene(scene.empty() ? low : scene, "s.toml", {set});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      refusal(fixing("stopper", "back", "strength = \"1 kN\"\n")),
      "s.toml:32:12: fixing.it.strength: a stopper has none: it bears and rubs as the feet of its body do");
  EXPECT_EQ(
      refusal(fixing("stopper", "far") + "[[wall]]\nname = \"far\"\nat = [3, 0]\nnormal = [-1, 0, 0]\n"),
      "s.toml:31:6: fixing.it.to: is 2850 mm from \"left\": a stopper leans it towards a wall within 500 mm");
  EXPECT_EQ(
      refusal(fixing("stopper", "near") + "[[wall]]\nname = \"near\"\nat = [-0.15, 0]\nnormal = [1, 0, 0]\n"),
      "s.toml:30:8: fixing.it.body: \"left\" touches \"near\": a stopper leans it back, which takes a gap");
  EXPECT_EQ(
      refused("block.1.at=[0, 0, 0.4]", blocks(fixing("stopper", "back"))),
      "s.toml:30:8: fixing.it.body: \"left\" stands 407.5 mm above the floor: a stopper lifts the front "
      "edge of "
      "what stands on it");
  EXPECT_EQ(
      refused("ceiling.at=1.5"),
      "s.toml:31:6: fixing.it.to: is 307.5 mm below the point of \"left\" from which a pole leads there");
  EXPECT_EQ(refusal(fixing("strap", "back", "at = [0, 0, 2.5]\n")),
            "s.toml:32:6: fixing.it.at: finds no point of \"left\" within 100 mm: the nearest member, "
            "\"top-front\", is "
            "708.6 mm away");
  EXPECT_EQ(
      refusal("[[wall]]\nname = \"far\"\nat = [3, 0]\nnormal = [-1, 0, 0]\n" + fixing("strap", "far")),
      "s.toml:35:6: fixing.it.to: finds no point within 100 mm: from \"left\" to \"far\" it is 2850 mm");
  EXPECT_NE(
      refusal("[[shake]]\nfrequency = 1\namplitude = 1\nbuilding = { storey = 3, of = 5, damping = 0.05 }\n"),
      "");
  EXPECT_EQ(
      refusal(
          "[[anchor]]\nbody = \"left\"\npoint = [0.15, 0, 1.8]\nto = [0.185, 0, 1.8]\nto_body = \"lift\"\n"
          "stiffness = 1e5\n"),
      "s.toml:31:11: anchor.1.to_body: there is no body \"lift\"; known: left, right");
}

/// Acceleration of the floor over g when a body begins to rock, as it grows slowly; 0: never.
double rocks_at(const Scene& scene, std::size_t body) {
  constexpr double k_rocks = 2e-4;  // rad
  topple::Run run(scene.setup);
  EXPECT_TRUE(run.status().ok()) << run.status().message(scene.setup.model);
  while (!run.over()) {
    if (!run.advance().ok()) {
      ADD_FAILURE() << run.status().message(scene.setup.model);
      return 0;
    }
    if (run.outcome().bodies()[body].peak_tilt > k_rocks)
      return floor_acceleration(scene.setup.parameters.shakes, run.time()).norm() / k_standard_gravity;
  }
  return 0;
}

// Housner: a block of half breadth b and half height h rocks from b/h g on. Bolted at top and bottom two of
// them rock as one of both breadths does; each alone at half of that. The floor's acceleration has grown by
// some hundredths of it when the tilt is what is looked for.
TEST(Fixing, two_blocks_bolted_side_by_side_rock_as_one_of_both_widths) {
  const double narrow = 0.3 / 1.8, wide = (0.3 + 0.335) / 1.8;
  EXPECT_NEAR(rocks_at(scene_of(""), 1), narrow, 0.05 * narrow);
  const std::string one =
      blocks("[[block]]\nname = \"wide\"\nsize = [0.635, 0.6, 1.8]\nmass = 120\nat = [0.1675, 4]\n");
  const double of_one = rocks_at(parse_scene(one, "s.toml"), 2);
  EXPECT_NEAR(of_one, wide, 0.05 * wide);
  const auto bolt = [](const std::string& name, const std::string& at) {
    return "[[fixing]]\nname = \"" + name +
           "\"\nkind = \"connector\"\nbody = \"left\"\nto = \"right\"\nat = " + at +
           "\nstrength = \"20 kN\"\nstiffness = \"10 MN/m\"\n";
  };
  const Scene bolted = scene_of(bolt("high", "[0.1675, 0, 1.8]") + bolt("low", "[0.1675, 0, 0]"));
  EXPECT_NEAR(rocks_at(bolted, 0), of_one, 0.02 * of_one);
}

}  // namespace
}  // namespace topple::io
