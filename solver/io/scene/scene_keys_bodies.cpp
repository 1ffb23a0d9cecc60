#include "solver/body/model_level.h"
#include "solver/io/scene/scene_key_rows.h"
#include "solver/io/scene/scene_words.h"
#include "solver/model/cabinet.h"
#include "solver/model/parameters.h"

namespace topple::io {
namespace {

using T = KeyType;
using D = Dimension;

constexpr double k_far = 1e3;   // m
constexpr double k_fast = 1e3;  // m/s and rad/s
constexpr double k_large = 10;  // m
constexpr double k_degree = k_pi / 180;

void add_model(Rows& rows, BodyModel absent) {
  rows.word("model", body_models(), absent,
            "what the body is computed as; auto: the least that answers `run.want` within `run.accuracy`, "
            "frame with an integrator that is named. A body is a frame while one is within 50 mm")
      .only_in({"dynamic"});
}

void add_damping(Rows& rows) {
  rows.number("damping", 0, 1, "ratio to critical at the first elastic mode, proportional to stiffness")
      .absent(0)
      .only_in({"dynamic"});
}

void add_restitution(Rows& rows) {
  rows.number("restitution", 0, 2,
              "of its base while it is a planar block: factor on the angular rate that an impact leaves by "
              "Housner's condition (with `edges` by its contact springs); once it is a rigid body "
              "`contact.restitution` holds")
      .absent(1)
      .only("model", {"auto", "planar"})
      .only_in({"dynamic"});
}

void add_friction(Rows& rows) {
  rows.number(
          "friction", 0, 1.5,
          "coefficient of friction on floors and walls that are planes; where contact.friction is changed "
          "while it runs, or in a study, it changes in proportion")
      .absent_means("contact.friction");
}

void add_copies(Rows& rows) {
  rows.vectors("copies", D::length, "m", -k_far, k_far, "translations, one per copy")
      .absent_means("one, where it is");
}

void add_placement(Rows& rows) {
  const Placement of{};
  rows.numbers("at", 3, D::length, "m", -k_far, k_far,
               "centre of the footprint in its pose, and the height that it stands on")
      .at_least(2)
      .absent(std::vector{0., 0.});
  rows.number("yaw", D::angle, "deg", -360 * k_degree, 360 * k_degree, "about the vertical").absent(of.yaw);
  rows.word("pose", k_poses, of.pose, "how it stands or lies");
  rows.number("tilt", D::angle, "deg", -90 * k_degree, 90 * k_degree,
              "about the bottom edge on the +x side before yaw; negative: on the -x side")
      .absent(of.tilt);
  rows.numbers("velocity", 3, D::velocity, "m/s", -k_fast, k_fast, "of the centre of gravity, at the start")
      .absent(of.velocity)
      .only_in({"dynamic"});
  rows.numbers("angular_velocity", 3, D::angular_velocity, "rad/s", -k_fast, k_fast, "at the start")
      .absent(of.angular_velocity)
      .only_in({"dynamic"});
}

void add_base(Rows& rows) {
  rows.word("base", k_bases, Placement{}.base,
            "where it touches planes: its eight corners, or the middles of edges and faces too");
}

void add_cabinet(std::vector<Key>& keys) {
  Rows rows(keys, "cabinet");
  const CabinetSpec cabinet{};
  rows.plain("name", T::text, "name of the body; copies add -2, -3, ...").absent_means("cabinet-1, ...");
  rows.numbers("size", 3, D::length, "mm", 0.01, k_large,
               "depth, width and height between the centre lines of its edges")
      .absent(cabinet.size);
  rows.number("mass", D::mass, "kg", 1e-3, 1e5, "mass; densities are adjusted to it").absent(cabinet.mass);
  rows.number("cg_height", D::length, "mm", 1e-3, k_large, "centre of gravity above the bottom centre lines")
      .absent_means("half of the height");
  rows.numbers("cg_offset", 2, D::length, "mm", -k_large, k_large,
               "centre of gravity off the middle, along depth and width")
      .absent_means("[0, 0]; of an open front what its members give");
  rows.numbers("inertia", 3, D::inertia, "kg m^2", 1e-9, 1e7,
               "thin sheets or a uniform block about the middle, less m d^2 where the centre of gravity is d "
               "from it, or [Ixx, Iyy, Izz] about that")
      .or_word(words_of(k_inertias))
      .absent(place_of(k_inertias, cabinet.inertia));
  add_placement(rows);
  rows.plain("section", T::text, "a [[section]]").required();
  rows.plain("material", T::text, "a [[material]]").required();
  rows.integer("shelves", 0, 20, "shelves").absent(cabinet.shelves);
  add_base(rows);
  rows.word("bracing", k_bracings, cabinet.bracing, "panels: diagonals as stiff as thin sheets");
  rows.number("panel_thickness", D::length, "mm", 1e-5, 0.1, "of the sheets that the diagonals replace")
      .absent(cabinet.panel_thickness)
      .only("bracing", {"panels"});
  rows.word("front", k_fronts, cabinet.front, "open: no sheet and no diagonals on its +x side")
      .only("bracing", {"panels"});
  rows.integer("divisions", 1, 20, "members per edge").absent(cabinet.divisions);
  add_damping(rows);
  add_restitution(rows);
  add_friction(rows);
  add_copies(rows);
  add_model(rows, BodyModel::automatic);
}

void add_block(std::vector<Key>& keys) {
  Rows rows(keys, "block");
  rows.plain("name", T::text, "name of the body; copies add -2, -3, ...").absent_means("block-1, ...");
  rows.numbers("size", 3, D::length, "mm", 1e-3, k_large,
               "depth, width and height between the centre lines of its edges, about which it rocks; its "
               "surface lies half of `width` outside")
      .required();
  rows.number("mass", D::mass, "kg", 1e-6, 1e6, "mass").required();
  rows.numbers("cg", 3, D::length, "mm", -k_large, k_large,
               "centre of gravity from the middle of the base along depth, width and height")
      .absent_means("the middle of the block");
  rows.numbers("inertia", 3, D::inertia, "kg m^2", 1e-15, 1e8,
               "about the centre of gravity: of a uniform block of this size about its middle, or [Ixx, Iyy, "
               "Izz]")
      .or_word({"solid"})
      .absent(0);
  add_placement(rows);
  rows.number("width", D::length, "mm", 1e-6, k_large,
              "contact width of edges and faces, at most the smallest side")
      .absent_means("a twentieth of the smallest side, at most 20 mm");
  add_base(rows);
  add_restitution(rows);
  add_friction(rows);
  add_copies(rows);
  rows.word("model", {"auto", "planar", "rigid"},
            "what the block is computed as; auto: planar while it is a planar block, else rigid")
      .absent(0)
      .only_in({"dynamic"});
}

void add_frame(std::vector<Key>& keys) {
  Rows rows(keys, "frame");
  const FrameSpec frame{};
  rows.plain("name", T::text, "name of the body; copies add -2, -3, ...").absent_means("frame-1, ...");
  rows.vectors("nodes", D::length, "m", -k_far, k_far, "places, numbered from 0").required();
  rows.plain("members", T::tables, "straight members between nodes").required();
  rows.plain("supports", T::tables, "fixed directions").absent_means("free");
  rows.plain("loads", T::tables, "dead loads on nodes").absent_means("none");
  rows.plain("masses", T::tables, "masses on nodes").absent_means("none");
  rows.plain("panels", T::tables, "flat sheets between members: tops and seats").absent_means("none");
  rows.number("mass", D::mass, "kg", 1e-6, 1e7, "mass; densities are adjusted to it")
      .absent_means("from the densities");
  add_copies(rows);
  rows.number("tilt", D::angle, "deg", -90 * k_degree, 90 * k_degree,
              "about the +x side of its lowest nodes, along y; negative: the -x side")
      .absent(frame.tilt)
      .only_in({"dynamic"});
  rows.numbers("velocity", 3, D::velocity, "m/s", -k_fast, k_fast, "of the centre of gravity, at the start")
      .absent(frame.velocity)
      .only_in({"dynamic"});
  rows.numbers("angular_velocity", 3, D::angular_velocity, "rad/s", -k_fast, k_fast, "at the start")
      .absent(frame.angular_velocity)
      .only_in({"dynamic"});
  add_damping(rows);
  add_restitution(rows);
  add_friction(rows);
  add_model(rows, BodyModel::frame);
}

void add_frame_members(std::vector<Key>& keys) {
  Rows rows(keys, "frame.members");
  const FrameMember member{};
  rows.integers("nodes", 2, 0, 1e6, "its ends").required();
  rows.plain("section", T::text, "a [[section]]").required();
  rows.plain("material", T::text, "a [[material]]").required();
  rows.integer("elements", 2, 1000, "even").absent(member.elements);
  rows.numbers("up", 3, -1e6, 1e6, "its part normal to the member is local z")
      .absent_means("z; x for a vertical member");
}

void add_frame_supports(std::vector<Key>& keys) {
  Rows rows(keys, "frame.supports");
  rows.integer("node", 0, 1e6, "node").required();
  rows.plain("fix", T::text, "letters of xyzXYZ: lower case translations, upper case rotations").required();
}

void add_frame_loads(std::vector<Key>& keys) {
  Rows rows(keys, "frame.loads");
  rows.integer("node", 0, 1e6, "node").required();
  rows.numbers("force", 3, D::force, "N", -1e9, 1e9, "force").absent(Vec3::Zero());
  rows.numbers("moment", 3, D::moment, "N m", -1e9, 1e9, "moment").absent(Vec3::Zero());
  rows.history("history", -1e6, 1e6,
               "[time, factor], times increasing, linear in between; static: over the load factor")
      .absent_means("1 at all times; static: the load factor");
}

void add_frame_masses(std::vector<Key>& keys) {
  Rows rows(keys, "frame.masses");
  rows.integer("node", 0, 1e6, "node").required();
  rows.number("mass", D::mass, "kg", 0, 1e7, "added to the node").required();
  rows.numbers("inertia", 3, D::inertia, "kg m^2", 0, 1e7,
               "[Ixx, Iyy, Izz] about the node along the axes of the world, at the start; added to the node")
      .absent(Vec3(Vec3::Zero()));
}

void add_frame_panels(std::vector<Key>& keys) {
  Rows rows(keys, "frame.panels");
  rows.integers("nodes", 4, 0, 1e6, "its corners, in order around it; members lie all along its sides")
      .required();
}

// Of what is in a piece of furniture.
void add_contents(std::vector<Key>& keys, std::string_view table, std::string_view mass_absent,
                  std::string_view cg_absent) {
  Rows rows(keys, table);
  rows.number("mass", D::mass, "kg", 0, 1e5, "of all that is inside; 0: empty").absent_means(mass_absent);
  rows.numbers("cg", 3, D::length, "mm", -k_large, k_large,
               "its centre of gravity from the middle of the base along depth, width and height; it fills a "
               "box about it that reaches the nearer sides")
      .absent_means(cg_absent);
}

void add_kind(std::vector<Key>& keys) {
  Rows rows(keys, "kind");
  rows.plain("source", T::text, "of its sizes, masses and sections, or \"assumed\"").required();
  rows.plain("contents", T::table, "what it holds where a [[furniture]] does not say")
      .absent_means("nothing");
  add_contents(keys, "kind.contents", "", "the middle of the piece");
  keys[keys.size() - 2].required = true;
}

void add_furniture(std::vector<Key>& keys) {
  Rows rows(keys, "furniture");
  rows.plain("name", T::text, "name of the body; copies add -2, -3, ...")
      .absent_means("that of its kind; -2, -3, ... where another has it");
  rows.plain("kind", T::text,
             "a kind of the library (`topple furniture`), or a TOML file from the folder of the scene with "
             "one body and `[kind]`")
      .required();
  rows.numbers("size", 3, D::length, "mm", 0.01, k_large,
               "outer depth, width and height; lengths of the kind are stretched, sections stay")
      .absent_means("of the kind");
  rows.number("mass", D::mass, "kg", 1e-3, 1e5, "empty").absent_means("of the kind, as its volume");
  rows.plain("contents", T::table, "what is inside").absent_means("of the kind, as its volume");
  rows.numbers("at", 3, D::length, "m", -k_far, k_far,
               "centre of the footprint, and the height that it stands on; or against, or beside")
      .at_least(2)
      .absent_means("[0, 0]");
  rows.number("yaw", D::angle, "deg", -360 * k_degree, 360 * k_degree, "about the vertical; only with `at`")
      .absent_means("0 deg");
  rows.plain("against", T::text, "a [[wall]], to which it turns its back").absent_means("`at`");
  rows.number("offset", D::length, "m", -k_far, k_far,
              "of its middle from the wall's `at`, to the right as one faces the wall; only with `against`")
      .absent_means("0 m");
  rows.plain("beside", T::text,
             "another [[furniture]], to the right of it as one faces it, its back in line with that one's")
      .absent_means("`at`");
  rows.number("gap", D::length, "mm", 0, k_far, "to the wall or the other piece")
      .absent_means("10 mm to a wall; 60 mm to a piece: within 50 mm each is computed as touching");
  add_contents(keys, "furniture.contents", "of the kind, as its volume", "as in the kind");
}

}  // namespace

void add_body_keys(std::vector<Key>& keys) {
  add_cabinet(keys);
  add_frame(keys);
  add_frame_members(keys);
  add_frame_supports(keys);
  add_frame_loads(keys);
  add_frame_masses(keys);
  add_frame_panels(keys);
  add_block(keys);
  add_furniture(keys);
  add_kind(keys);
}

}  // namespace topple::io
