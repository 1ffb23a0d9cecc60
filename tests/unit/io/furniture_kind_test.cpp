// [[furniture]]: kinds of the library become bodies of the size, mass and place that a scene asks for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/io/builtin/builtin.h"
#include "solver/io/edit/scene_save.h"
#include "solver/io/scene/furniture.h"
#include "solver/io/scene/furniture_kind.h"
#include "solver/io/scene/scene.h"
#include "solver/run/edit.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

using OuterBox = Eigen::AlignedBox3d;

const std::string k_empty_room = R"(topple = 1
[run]
duration = "1 s"
[contact]
alpha = "300 kgf"
[floor]
[[wall]]
name = "back"
at = [-2, 0.5]
normal = [1, 0, 0]
[[wall]]
name = "side"
at = [0.25, 3]
normal = [0, -1, 0]
)";

/// Surface of what a body's members reach: half of a contact width around their ends.
OuterBox outer_box(const Model& model, int body) {
  OuterBox box;
  const Body& b = model.bodies[static_cast<std::size_t>(body)];
  for (int m = b.first_member; m < b.first_member + b.member_count; ++m) {
    const Member& member = model.members[m];
    const Vec3 half = Vec3::Constant(model.sections[member.section].width / 2);
    for (int e = member.first_element; e < member.first_element + member.element_count; ++e)
      for (const int node : model.elements[e].node)
        if (model.sections[member.section].name.find(".brace") == std::string::npos)
          box.extend(OuterBox(model.node_position[node] - half, model.node_position[node] + half));
  }
  return box;
}

Scene furnished(const std::string& furniture) {
  return parse_scene(k_empty_room + furniture, "s.toml");
}

std::string vector_text(const Vec3& v) {
  char out[120];
  std::snprintf(out, sizeof out, "[%.17g, %.17g, %.17g]", v.x(), v.y(), v.z());
  return out;
}

void expect_box(const Model& model, int body, const Vec3& least, const Vec3& most) {
  const OuterBox box = outer_box(model, body);
  // coordinates of metres are rounded to 1e-16, and yaw turns them
  EXPECT_LT((box.min() - least).cwiseAbs().maxCoeff(), 1e-9)
      << vector_text(box.min()) << " for " << vector_text(least);
  EXPECT_LT((box.max() - most).cwiseAbs().maxCoeff(), 1e-9)
      << vector_text(box.max()) << " for " << vector_text(most);
}

TEST(FurnitureKind, there_are_sixteen_and_more_each_with_a_source) {
  EXPECT_GE(furniture_kinds().size(), 16u);
  EXPECT_EQ(furniture_kinds().size(), builtin_furniture().size());
  for (const FurnitureKind& kind : furniture_kinds()) {
    EXPECT_NE(kind.title, kind.name);
    EXPECT_FALSE(kind.source.empty()) << kind.name;
  }
}

TEST(FurnitureKind, has_the_outer_size_and_the_mass_that_are_asked_for_empty_and_full) {
  for (const FurnitureKind& kind : furniture_kinds())
    for (const double scale : {1., 2.})
      for (const double share : {0., 0.5, 1.}) {
        SCOPED_TRACE(kind.name + ", " + std::to_string(scale) + ", " + std::to_string(share));
        const Vec3 size = scale * kind.size;
        const double mass = 1.5 * kind.mass, contents = share * std::max(kind.contents_mass, kind.mass / 2);
        const Vec3 cg(0.02 * size.x(), -0.03 * size.y(), 0.45 * size.z());
        const auto of = [&](double inside) {
          const std::string scene = "[[furniture]]\nkind = \"" + kind.name +
                                    "\"\nsize = " + vector_text(size) + "\nmass = " + std::to_string(mass) +
                                    "\ncontents = { mass = " + std::to_string(inside) +
                                    ", cg = " + vector_text(cg) + " }\nat = [0.3, -0.2]\n";
          return furnished(scene).setup.model;
        };
        const Model model = of(contents);
        ASSERT_EQ(model.bodies.size(), 1u);
        const Vec3 at(0.3, -0.2, 0), half(size.x() / 2, size.y() / 2, 0);
        expect_box(model, 0, at - half, at + half + Vec3(0, 0, size.z()));
        const Body &body = model.bodies[0], empty = of(0).bodies[0];
        // std::to_string() writes 1e-6 kg; masses are fitted to rounding
        EXPECT_NEAR(body.mass, mass + contents, 2e-6);
        EXPECT_NEAR(empty.mass, mass, 2e-6);
        const Vec3 expected = (empty.mass * empty.centre_of_gravity + contents * (at + cg)) / body.mass;
        EXPECT_LT((body.centre_of_gravity - expected).norm(), 1e-6)
            << vector_text(body.centre_of_gravity) << " for " << vector_text(expected);
      }
}

TEST(FurnitureKind, mass_and_contents_grow_with_the_volume) {
  const Scene scene = furnished(
      "[[furniture]]\nkind = \"bookshelf\"\nsize = [0.3, 1.8, 1.8]\n[[furniture]]\nkind = "
      "\"bookshelf\"\nat = [1, 0]\n");
  const std::vector<FurniturePiece> pieces = furniture_of(scene);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(pieces[0].mass, 2 * pieces[1].mass, 1e-9);
  EXPECT_NEAR(pieces[0].contents_mass, 2 * pieces[1].contents_mass, 1e-9);
  EXPECT_EQ(pieces[1].name, "bookshelf-2");
  EXPECT_NEAR(scene.setup.model.bodies[0].mass, 2 * scene.setup.model.bodies[1].mass, 1e-6);
}

TEST(FurnitureKind, stands) {
  for (const FurnitureKind& kind : furniture_kinds()) {
    const Scene scene = parse_scene(
        "topple = 1\n[run]\nduration = \"1 s\"\n[floor]\n[[furniture]]\nkind = \"" + kind.name + "\"\n",
        "s.toml");
    topple::Run run(scene.setup);
    while (run.status().ok() && !run.over()) run.advance();
    EXPECT_TRUE(run.status().ok()) << kind.name << ": " << run.status().message(scene.setup.model);
    // of a piece at rest the elastic give of its feet is left: below a thousandth of a radian
    EXPECT_LT(run.outcome().bodies()[0].peak_tilt, 1e-3) << kind.name;
  }
}

TEST(FurniturePlace, against_a_wall_the_back_is_10_mm_off_and_the_front_looks_away) {
  const Scene scene = furnished(R"(
[[furniture]]
kind = "chest"
against = "back"
offset = 0.75
[[furniture]]
name = "other"
kind = "chest"
against = "side"
gap = "35 mm"
)");
  const Vec3 size = scene.setup.model.bodies.empty() ? Vec3::Zero() : Vec3(0.45, 0.9, 1.0);
  expect_box(scene.setup.model, 0, Vec3(-1.99, 0.5 + 0.75 - 0.45, 0), Vec3(-1.99 + size.x(), 1.7, 1));
  // the side wall's right hand, as one faces it from y < 3, is +x
  expect_box(scene.setup.model, 1, Vec3(0.25 - 0.45, 3 - 0.035 - 0.45, 0), Vec3(0.25 + 0.45, 3 - 0.035, 1));
}

TEST(FurniturePlace, beside_a_piece_backs_are_in_line_and_the_gap_is_60_mm) {
  const Scene scene = furnished(R"(
[[furniture]]
kind = "refrigerator"
beside = "cupboard"
[[furniture]]
kind = "cupboard"
against = "back"
[[furniture]]
kind = "chair"
beside = "refrigerator"
gap = 0.2
)");
  const std::vector<Body>& bodies = scene.setup.model.bodies;
  const auto box = [&](const char* name) {
    const auto found = std::ranges::find(bodies, name, &Body::name);
    return outer_box(scene.setup.model, static_cast<int>(found - bodies.begin()));
  };
  const OuterBox cupboard = box("cupboard"), fridge = box("refrigerator"), chair = box("chair");
  EXPECT_NEAR(fridge.min().y(), cupboard.max().y() + 0.06, 1e-9);
  EXPECT_NEAR(fridge.min().x(), -1.99, 1e-9);
  EXPECT_NEAR(chair.min().y(), fridge.max().y() + 0.2, 1e-9);
  EXPECT_NEAR(chair.min().x(), -1.99, 1e-9);
  EXPECT_NEAR(cupboard.min().x(), -1.99, 1e-9);
}

TEST(FurniturePlace, a_frame_turns_with_its_yaw) {
  const auto of = [](const char* yaw) {
    return outer_box(
        furnished("[[furniture]]\nkind = \"desk\"\nat = [1, 2, 0.5]\nyaw = \"" + std::string(yaw) + "\"\n")
            .setup.model,
        0);
  };
  EXPECT_TRUE(of("90 deg").isApprox(OuterBox(Vec3(0.5, 1.65, 0.5), Vec3(1.5, 2.35, 1.2)), 1e-12));
  EXPECT_TRUE(of("180 deg").isApprox(OuterBox(Vec3(0.65, 1.5, 0.5), Vec3(1.35, 2.5, 1.2)), 1e-12));
}

TEST(Furniture, keys_of_the_body_and_overrides_reach_it) {
  const std::string piece =
      "[[furniture]]\nkind = \"cabinet\"\nbase = \"edges\"\nshelves = 2\ndamping = 0.02\n";
  const Scene scene = parse_scene(k_empty_room + piece, "s.toml",
                                  {"furniture.1.mass=70 kg", "furniture.1.tilt=1 deg", "run.settle=false",
                                   "furniture.cabinet.contents.mass=5"});
  EXPECT_NEAR(scene.setup.model.bodies[0].mass, 75, 1e-9);
  EXPECT_EQ(scene.setup.parameters.damping[0], 0.02);
  EXPECT_NEAR(scene.setup.starts[0].rotation.norm(), k_pi / 180, 1e-12);
  // and the text that a recording keeps says the same
  const Scene again = parse_scene(scene.text, "s.toml");
  EXPECT_EQ(again.setup.model.node_mass, scene.setup.model.node_mass);
}

TEST(Furniture, names_materials_and_sections_that_the_scene_does_not_define) {
  const Scene scene = furnished(R"(
[[section]]
name = "solid 30"
shape = "box"
size = ["40 mm", "40 mm"]
thickness = "2 mm"
[[cabinet]]
section = "solid 30"
material = "stainless steel"
[[cabinet]]
at = [1, 0]
section = "pipe 30x1.5"
material = "wood"
)");
  const Model& model = scene.setup.model;
  const auto section = [&](const char* name) {
    return *std::ranges::find(model.sections, name, &Section::name);
  };
  EXPECT_EQ(section("solid 30").width, 0.04) << "the scene's own comes first";
  EXPECT_NEAR(section("pipe 30x1.5").area, k_pi / 4 * (0.03 * 0.03 - 0.027 * 0.027), 1e-12);
  EXPECT_EQ(std::ranges::find(model.materials, "wood", &Material::name)->density, 650);
  EXPECT_EQ(std::ranges::find(model.materials, "steel", &Material::name), model.materials.end());
}

TEST(Furniture, a_file_beside_the_scene_is_a_kind_and_is_kept) {
  const std::string kind = R"(topple = 1
title = "My shelf"
[kind]
source = "measured"
[[material]]
name = "oak"
young = "11 GPa"
poisson = 0.3
density = 700
[[cabinet]]
size = [0.28, 0.88, 1.78]
mass = "30 kg"
section = "solid 20"
material = "oak"
)";
  const ReadSceneFile read = [&](const std::string& name) {
    EXPECT_EQ(name, "kinds/my-shelf.toml");
    return kind;
  };
  const Scene scene =
      parse_scene(k_empty_room + "[[furniture]]\nkind = \"kinds/my-shelf.toml\"\nagainst = \"back\"\n",
                  "s.toml", {}, read);
  ASSERT_EQ(scene.files.size(), 1u);
  EXPECT_EQ(scene.files[0].bytes, kind);
  EXPECT_EQ(scene.setup.model.bodies[0].name, "my-shelf");
  EXPECT_EQ(scene.setup.model.materials[0].name, "my-shelf/oak");
  expect_box(scene.setup.model, 0, Vec3(-1.99, 0.05, 0), Vec3(-1.69, 0.95, 1.8));
}

TEST(Furniture, a_live_edit_is_saved_in_its_entry) {
  const Scene scene = furnished(
      "[[furniture]]\nkind = \"desk\"   # ours\ncopies = [[0, 0, 0], [0, -1.5, 0]]\n[[furniture]]\nkind = "
      "\"locker\"\nat = [1.5, 1.5]\n[[cabinet]]\nat = [1.5, 0]\nsection = \"box 30x1\"\nmaterial = "
      "\"steel\"\n");
  const std::vector<BodyEntry> entries = body_entries(scene);
  ASSERT_EQ(entries.size(), 3u);  // cabinets first: the scene's own, the locker; then the desk and its copy
  EXPECT_EQ(entries[0].table + std::to_string(entries[0].number), "cabinet1");
  EXPECT_EQ(entries[1].table + std::to_string(entries[1].number), "furniture2");
  EXPECT_EQ(entries[2].table + std::to_string(entries[2].number), "furniture1");
  Parameters now = scene.setup.parameters;
  apply({.key = Edit::Key::model, .index = 1, .value = Vec3(static_cast<int>(BodyModel::rigid), 0, 0)},
        scene.setup.model, 0.4, now);
  for (const int copy : {2, 3})
    apply({.key = Edit::Key::damping, .index = copy, .value = Vec3(0.03, 0, 0)}, scene.setup.model, 0.4, now);
  const SavedScene saved = edited_scene(scene, now);
  EXPECT_TRUE(saved.given_up.empty());
  EXPECT_NE(saved.text.find("copies = [[0, 0, 0], [0, -1.5, 0]]\ndamping = 0.03\n"), std::string::npos)
      << saved.text;
  EXPECT_NE(saved.text.find("at = [1.5, 1.5]\nmodel = \"rigid\"\n"), std::string::npos) << saved.text;
  EXPECT_NE(saved.text.find("# ours"), std::string::npos);
  EXPECT_EQ(parse_scene(saved.text, "s.toml").setup.parameters.models, now.models);
}

/// What the error of a scene with this furniture says behind "s.toml:".
std::string refused_piece(const std::string& furniture, const std::string& kind = "") {
  try {
    parse_scene(
        "topple = 1\n[floor]\n[[wall]]\nname = \"back\"\nat = [0, 0]\nnormal = [1, 0, 0]\n" + furniture,
        "s.toml", {}, [&](const std::string&) { return kind; });
  } catch (const InputError& wrong) {
    return wrong.what();
  }
  return "";
}

TEST(FurnitureErrors, name_file_line_and_key) {
  const std::string shelf = "[[furniture]]\nkind = \"bookshelf\"\n";
  const auto begins = [](const std::string& text, const std::string& with) {
    EXPECT_EQ(text.substr(0, with.size()), with);
    EXPECT_EQ(text.find('\n'), std::string::npos);
  };
  begins(
      refused_piece("[[furniture]]\nkind = \"bokshelf\"\n"),
      "s.toml:8:8: furniture.bokshelf.kind: there is no kind \"bokshelf\"; the nearest is bookshelf; known: "
      "bed, bookshelf, cabinet, ");
  begins(refused_piece(shelf + "against = \"bakc\"\n"),
         "s.toml:9:11: furniture.bookshelf.against: there is no [[wall]] \"bakc\"; the nearest is back; "
         "known: back");
  begins(refused_piece(shelf + "beside = \"fridge\"\n"),
         "s.toml:9:10: furniture.bookshelf.beside: there is no [[furniture]] \"fridge\" nor any other");
  begins(refused_piece(shelf + "beside = \"bookshelf\"\n"),
         "s.toml:9:10: furniture.bookshelf.beside: \"bookshelf\" stands beside itself, in a circle");
  begins(refused_piece(
             "[[furniture]]\nkind = \"desk\"\nbeside = \"chair\"\n[[furniture]]\nkind = \"chair\"\nbeside = "
             "\"desk\"\n"),
         "s.toml:9:10: furniture.desk.beside: \"desk\" stands beside itself, in a circle");
  begins(refused_piece(shelf + "size = [0.3, -0.9, 1.8]\n"),
         "s.toml:9:14: furniture.bookshelf.size.2: -0.9 m is outside 10..10000 mm");
  begins(refused_piece(shelf + "contents = { mass = \"-1 kg\" }\n"),
         "s.toml:9:21: furniture.bookshelf.contents.mass: \"-1 kg\" is outside 0..100000 kg");
  begins(refused_piece(shelf + "contents = { mass = 5, cg = [0, 0, 2] }\n"),
         "s.toml:9:29: furniture.bookshelf.contents.cg: along the height, 2000 mm is not inside the piece, "
         "which "
         "reaches "
         "from 0 mm to 1800 mm");
  begins(refused_piece(shelf + "contents = { mass = 120, cg = [0.145, 0, 0.9] }\n"),
         "s.toml:9:12: furniture.bookshelf.cg_offset: 116 mm, 0 mm cannot be reached with positive "
         "densities, only 0.");
  begins(refused_piece(shelf + "size = [0.02, 0.9, 1.8]\n"),
         "s.toml:9:8: furniture.bookshelf.size: the depth, 20 mm, is not more than the 30 mm of its members");
  begins(refused_piece(shelf + "at = [0, 0]\nagainst = \"back\"\n"),
         "s.toml:10:11: furniture.bookshelf.against: stands beside `at`; a piece has one of them");
  begins(refused_piece(shelf + "against = \"back\"\nyaw = \"90 deg\"\n"),
         "s.toml:10:7: furniture.bookshelf.yaw: belongs to `at`");
  begins(refused_piece(shelf + "nodes = [[0, 0, 0]]\n"),
         "s.toml:9:9: furniture.bookshelf.nodes: is no key of a [[cabinet]], which a bookshelf becomes");
  begins(refused_piece(shelf + "shelfs = 3\n"),
         "s.toml:9:1: furniture.bookshelf.shelfs: unknown key; known: against, at, beside, ");
  const std::string mistyped = refused_piece(shelf + "shelfs = 3\n");
  EXPECT_TRUE(mistyped.ends_with(", and keys of the body that it becomes; the nearest is shelves"))
      << mistyped;
  begins(refused_piece(shelf + "section = \"box 30\"\n"),
         "s.toml:9:11: furniture.bookshelf.section: there is no [[section]] \"box 30\"");
  begins(refused_piece("[[furniture]]\nname = \"a\"\nkind = \"desk\"\n[[furniture]]\nname = \"a\"\nkind = "
                       "\"desk\"\nat = [2, "
                       "0]\n"),
         "s.toml:11:8: furniture.a.name: \"a\" is used twice, first in line 8");
}

TEST(FurnitureErrors, in_a_kind_of_ones_own_name_its_file_and_line) {
  const std::string use = "[[furniture]]\nkind = \"my.toml\"\n";
  const std::string head = "topple = 1\n[kind]\nsource = \"assumed\"\n";
  const std::string block = "[[block]]\nsize = [0.3, 0.3, 0.3]\nmass = 5\n";
  EXPECT_EQ(refused_piece(use, "topple = 1\n" + block),
            "my.toml:1:1: kind: missing; a kind of furniture has [kind] with its source");
  EXPECT_EQ(refused_piece(use, head + block + "mas = 5\n").substr(0, 35),
            "my.toml:7:1: block.1.mas: unknown k");
  EXPECT_EQ(refused_piece(use, head + block + block), "my.toml:4:1: block: a kind of furniture has one body");
  EXPECT_EQ(refused_piece(use, head),
            "my.toml:1:1: a kind of furniture has one [[cabinet]], [[frame]] or [[block]]");
  EXPECT_EQ(refused_piece(use, head + block + "at = [0, 0]\n"),
            "my.toml:7:1: block.1.at: a kind of furniture stands nowhere: leave it out");
  EXPECT_EQ(refused_piece(use, head + block + "[floor]\n").substr(0, 57),
            "my.toml:7:2: floor: has no place in a kind of furniture, ");
  EXPECT_EQ(refused_piece(use, head + "[[cabinet]]\nmass = 5\nsection = \"box 30x1\"\nmaterial = \"oak\"\n")
                .substr(0, 66),
            "my.toml:7:12: cabinet.1.material: there is no [[material]] \"oak\" n");
  EXPECT_EQ(refused_piece(use, head + block + "cg = [0, 0, 1]\n").substr(0, 44),
            "my.toml:7:6: furniture.my.cg: z = 1000 mm is");
  EXPECT_EQ(refused_piece(use, head + "contents = { cg = [0, 0, 0.1] }\n" + block).substr(0, 43),
            "my.toml:4:12: kind.contents.mass: missing (");
  EXPECT_EQ(refused_piece(use, head + "contents = { mass = 1, cg = [0, 0, 0.4] }\n" + block).substr(0, 60),
            "my.toml:4:29: kind.contents.cg: along the height, 400 mm is ");
  EXPECT_EQ(refused_piece(use, "what"),
            "my.toml:1:5: Error while parsing key-value pair: encountered end-of-file");
}

}  // namespace
}  // namespace topple::io
