#include "solver/io/scene/scene_keys.h"

#include <functional>

#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/io/accelerogram/accelerogram_file.h"
#include "solver/io/scene/scene_key_rows.h"
#include "solver/io/scene/scene_words.h"
#include "solver/model/cabinet.h"
#include "solver/model/excitation.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/run/run.h"

namespace topple::io {
namespace {

using T = KeyType;
using D = Dimension;

constexpr double k_far = 1e3;   // m
constexpr double k_large = 10;  // m

// The words of the rows for which `holds`.
template <class Table, class Holds>
Words words_where(const Table& table, Holds holds) {
  Words words;
  for (const auto& row : table)
    if (std::invoke(holds, row)) words.emplace_back(row.word);
  return words;
}

Words letters(std::string_view text) {
  Words words;
  for (std::size_t k = 0; k < text.size(); ++k) words.push_back(text.substr(k, 1));
  return words;
}

void add_top(std::vector<Key>& keys) {
  Rows rows(keys, "");
  rows.integer("topple", 1, 1, "schema version").required();
  rows.plain("title", T::text, "one line on what it shows").absent_means("the scene's name");
  rows.plain("run", T::table, "how it is stepped");
  rows.plain("shake", T::tables, "acceleration of the floor; several add up").only_in({"dynamic"});
  rows.plain("contact", T::table, "contact law");
  rows.plain("floor", T::table, "the floor, its face at z = 0").absent_means("no floor");
  rows.plain("wall", T::tables, "a plane wall");
  rows.plain("material", T::tables, "elastic, or elastic and perfectly plastic, material");
  rows.plain("section", T::tables, "cross-section of members");
  rows.plain("cabinet", T::tables, "a steel cabinet, built from members");
  rows.plain("frame", T::tables, "anything made of straight members");
  rows.plain("block", T::tables, "a rigid solid piece without members");
  rows.plain("furniture", T::tables,
             "a piece of the library; any key of the [[cabinet]], [[frame]] or [[block]] that it becomes may "
             "be given beside its own");
  rows.plain("kind", T::table, "makes a file of one body a kind of [[furniture]]");
  rows.plain("anchor", T::tables, "ties a body to a wall or floor").only_in({"dynamic", "static"});
  rows.plain("ceiling", T::table, "a plane above, to which poles reach; nothing touches it")
      .absent_means("none");
  rows.plain("fixing", T::tables, "holds a body by a named piece of hardware, which finds its points")
      .only_in({"dynamic"});
  rows.plain("probe", T::tables, "motion reported in the summary");
  rows.plain("door", T::tables, "an opening in a wall by which people leave").only_in({"dynamic"});
  rows.plain("place", T::tables, "where a person is when the run begins").only_in({"dynamic"});
  rows.plain("expect", T::tables, "number of the summary that is known, for `topple verify`");
}

void add_run(std::vector<Key>& keys) {
  Rows rows(keys, "run");
  const Parameters parameters{};
  const RunSettings run{};
  rows.word("analysis", k_analyses, run.analysis, "what is computed");
  rows.number("duration", D::time, "s", 1e-6, 3600, "simulated time")
      .absent(run.duration)
      .only_in({"dynamic"});
  Words named{"auto"};
  std::vector<int> numbers{k_automatic_integrator};
  for (const IntegratorTraits& one : integrators()) {
    named.push_back(one.word);
    numbers.push_back(static_cast<int>(one.kind));
  }
  rows.word("integrator", named,
            "of frames; auto is generalized-alpha and, in steps of the program's own choice, central "
            "differences "
            "where these cost less. The others are moved as the summary says")
      .absent(0)
      .only_in({"dynamic"});
  keys.back().numbers = numbers;
  rows.words("want", {"motion", "stress"}, "what the scene is for; `model = \"auto\"` goes by it")
      .absent_means("both");
  rows.number("accuracy", 1e-6, 1,
              "error that `model = \"auto\"` allows, of the critical angle (motion) or of the stress")
      .absent(parameters.accuracy)
      .only_in({"dynamic"});
  rows.number("beta", 0.01, 1, "of the Newmark method")
      .absent(parameters.beta)
      .only("integrator", {"newmark"})
      .only_in({"dynamic"});
  rows.number("gamma", 0.5, 1, "of the Newmark method; 1/2 is of second order, more damps, less would grow")
      .absent(parameters.gamma)
      .only("integrator", {"newmark"})
      .only_in({"dynamic"});
  rows.number("spectral_radius", 0, 1, "at infinite frequency")
      .absent(parameters.spectral_radius)
      .only("integrator", {"auto", "generalized-alpha"})
      .only_in({"dynamic"});
  rows.number("time_step", D::time, "s", 1e-7, 0.1,
              "fixed step, or one that follows the motion (central-difference: 0.9 of its limit)")
      .or_word({"auto"})
      .absent(parameters.time_step)
      .absent_means("1 ms; auto with a `tolerance`, or with a floor or wall when `contact.alpha` is left out")
      .only_in({"dynamic"});
  rows.number("tolerance", 1e-9, 0.1,
              "local error of the adaptive step over the travel of the body; `time_step` is auto or absent")
      .absent(parameters.tolerance)
      .only_in({"dynamic"});
  rows.integer("load_steps", 1, 1e5, "equal parts in which the loads grow")
      .absent(run.statics.load_steps)
      .only("analysis", {"static"});
  rows.plain("control", T::table,
             "a node that moves, or a path that goes on, in equal parts while the loads follow")
      .absent_means("the loads grow by themselves")
      .only("analysis", {"static"});
  rows.word("stop_at", {"instability"}, "ends the path at the first equilibrium that is not stable")
      .absent_means("the path goes on; each load step tells whether it is stable")
      .only("analysis", {"static"});
  rows.word("elements", k_schemes, Scheme::asi_gauss,
            "where the integration points stand; asi: in the middle while elastic; midpoint: always");
  rows.plain("settle", T::boolean,
             "start from rest under gravity and the loads at t = 0 (static: load factor 0)")
      .absent(run.settle);
  rows.number("output_rate", D::frequency, "Hz", 1, 1e4,
              "recorded rows, at multiples of its inverse whatever the steps are")
      .absent(run.output_rate)
      .only_in({"dynamic"});
  rows.numbers("gravity", 3, D::acceleration, "m/s^2", -1e3, 1e3, "gravity").absent(parameters.gravity);
  rows.word("stop_when", k_stops, run.stop_when,
            "ends the run early; all-overturned: tilt over 60 deg for 0.5 s")
      .only_in({"dynamic"});
  rows.number("person", D::length, "m", 0.1, 2, "width of the disc that a person is on the way to a [[door]]")
      .absent(Room{}.person)
      .only_in({"dynamic"});
}

void add_control(std::vector<Key>& keys) {
  Rows rows(keys, "run.control");
  rows.plain("body", T::text, "a frame, or a copy").absent_means("the first frame");
  rows.integer("node", 0, 1e6, "node of the frame's list")
      .absent_means("with `arc` none, else it is required");
  rows.word("dof", letters(k_directions), "its direction: lower case translations, upper case rotations")
      .absent_means("as `node`");
  rows.number("arc", D::length, "m", 0, k_far,
              "arc length: way of the whole frame over all load steps, as root mean square of its nodes' "
              "displacements in each; 0: each load step as far as its share of the loads moves it at first")
      .absent_means("a node is controlled");
  rows.number("to", D::length, "m", -k_far, k_far, "travel over all load steps")
      .absent_means("each load step as far as its share of the loads moves it at first")
      .only("dof", letters(k_directions.substr(0, 3)));
  rows.number("to_angle", D::angle, "deg", -1e3, 1e3, "turn over all load steps")
      .absent_means("as `to`")
      .only("dof", letters(k_directions.substr(3)));
}

void add_shake(std::vector<Key>& keys) {
  Rows rows(keys, "shake");
  const Shake shake{};
  const auto kinds_with = [](bool ShakeTraits::*has) { return words_where(shake_kinds(), has); };
  const Words pushing = kinds_with(&ShakeTraits::has_amplitude),
              recorded = kinds_with(&ShakeTraits::has_record), steady = kinds_with(&ShakeTraits::steady);
  rows.plain("name", T::text, "for messages and `--set`").absent_means("shake-1, ...");
  rows.word("type", shake_kinds(), shake.kind, "form of the acceleration");
  rows.plain("building", T::table,
             "the shake moves the ground of a uniform shear building, in which the floor is")
      .absent_means("the floor is the ground");
  rows.plain("modes", T::tables, "likewise, of a building that these modes describe")
      .absent_means("those of `building`");
  rows.numbers("frequency", 2, D::frequency, "Hz", 1e-3, 1e3,
               "frequency; of a sweep [first, last]: each octave takes as long")
      .or_one()
      .required()
      .only("type", kinds_with(&ShakeTraits::has_frequency));
  rows.number("amplitude", D::acceleration, "gal", 0, 1e3, "largest acceleration")
      .required()
      .only("type", pushing);
  rows.numbers("direction", 3, -1e6, 1e6, "of the acceleration; made a unit vector")
      .absent(shake.direction)
      .only("type", pushing);
  rows.number("start", D::time, "s", 0, 3600, "begin").absent(shake.start);
  rows.plain("on", T::boolean, "false: it does not shake the floor until switched on").absent(1);
  rows.number("cycles", 1e-3, 1e6, "length in periods").absent_means("until the end").only("type", steady);
  rows.number("taper", 0, 1e6, "periods of smooth rise and fall")
      .absent(shake.taper)
      .only("type", kinds_with(&ShakeTraits::has_frequency));
  rows.word("initial_velocity", k_shake_starts, shake.initial_velocity,
            "jump: the floor starts with the velocity of a pure sine")
      .only("type", steady);
  rows.word("shape", pulse_shapes(), shake.shape, "form of the pulse")
      .only("type", kinds_with(&ShakeTraits::has_shape));
  rows.number("duration", D::time, "s", 1e-6, 3600, "length of the pulse or sweep")
      .required()
      .only("type", kinds_with(&ShakeTraits::has_duration));
  rows.texts("files", 3,
             "accelerograms: PEER AT2, K-NET or KiK-net ASCII, CSV, one to three "
             "components together, equally long; paths from the folder of the scene, or a built-in record")
      .required()
      .only("type", recorded);
  rows.vectors("directions", D::none, {}, -1e6, 1e6, "of the components; made unit vectors")
      .absent_means("x, y, z, in the order of the components")
      .only("type", recorded);
  rows.number("scale", -100, 100, "factor on the record").absent(shake.scale).only("type", recorded);
  rows.word("unit", Words(std::begin(k_sample_units), std::end(k_sample_units)),
            "of the samples, where a file does not state it")
      .absent_means("as the files state")
      .only("type", recorded);
  rows.number("dt", D::time, "s", k_shortest_interval, k_longest_interval,
              "time between the samples of a CSV without a column of times")
      .absent_means("as the files state")
      .only("type", recorded);
  rows.word("mean", {"kept", "removed"}, "mean of each component; of a K-NET file always removed")
      .absent(0)
      .only("type", recorded);
  rows.word("baseline", {"none", "parabola"},
            "correction of each component: parabola subtracts the one that leaves the least mean square "
            "velocity (Berg and Housner 1961)")
      .absent(0)
      .only("type", recorded);
}

// What the shake's ground carries.
void add_building(std::vector<Key>& keys) {
  constexpr double k_least_period = 0.01, k_most_period = 30;     // s
  constexpr double k_least_damping = 1e-3, k_most_damping = 0.9;  // ratio
  Rows building(keys, "shake.building");
  building.integer("storey", 1, 200, "the floor so many storeys above the ground, up to `of`, the roof")
      .required();
  building.integer("of", 1, 200, "storeys of the building").required();
  building.number("period", D::time, "s", k_least_period, k_most_period, "of its first mode").required();
  building.number("damping", k_least_damping, k_most_damping, "ratio to critical, of every mode").required();
  Rows modes(keys, "shake.modes");
  modes.number("period", D::time, "s", k_least_period, k_most_period, "of the mode").required();
  modes.number("damping", k_least_damping, k_most_damping, "ratio to critical").required();
  modes.number("factor", -100, 100, "participation factor times the shape at the floor").required();
}

void add_contact(std::vector<Key>& keys) {
  Rows rows(keys, "contact");
  const ContactLaw law{};
  const Words with_restitution = words_where(contact_laws(), &ContactLawTraits::has_restitution);
  rows.word("law", contact_laws(), law.kind, "coulomb damps and sticks; paper, printed: as in the paper")
      .only_in({"dynamic"});
  rows.number("alpha", D::force, "kgf", 1e-3 * k_standard_gravity, 1e6 * k_standard_gravity,
              "stiffness of contacts: penalty coefficient of Eq. 2")
      .absent(law.alpha)
      .absent_means(
          "what lets every body stand, lift and land on its edges as a rigid one; 50 kgf when none stands on "
          "a floor");
  rows.number("q", 0.5, 4, "penalty index of Eq. 2").absent(law.q);
  rows.number("friction", 0, 1.5, "coefficient of friction").absent(law.friction);
  rows.number("friction_static", 0, 1.5,
              "coefficient of static friction, not below `friction`; falls to it with the slip speed")
      .absent_means("`friction`")
      .only("law", with_restitution)
      .only_in({"dynamic"});
  rows.number("restitution", 0, 1, "coefficient of restitution")
      .absent(law.restitution)
      .only("law", with_restitution)
      .only_in({"dynamic"});
  rows.number(
          "normal_speed", D::velocity, "m/s", 1e-6, 10,
          "closing speed below which contact damping fades and bodies bounce more, whatever restitution is")
      .absent(law.normal_speed)
      .only("law", with_restitution)
      .only_in({"dynamic"});
  rows.number("slip_speed", D::velocity, "m/s", 1e-6, 10,
              "smooths the direction of slip; of a law that sticks: half of the way from static to kinetic "
              "friction")
      .absent(law.slip_speed)
      .only_in({"dynamic"});
  rows.number("member_share", 1e-3, 1, "share of alpha that members of two bodies have between them")
      .absent(law.member_share)
      .absent_means(
          "1; where `alpha` is chosen, what lets bodies knock and lean on each other as rigid ones");
  rows.plain("surfaces", T::boolean, "panels touch what meets them; false: members alone, as in the paper")
      .absent(Model{}.surfaces);
}

// Of a floor or wall, a plane or made of members; `extent`: how far it goes by default, m.
void add_beams(Rows& rows, double extent) {
  const GridSpec grid{};
  rows.word("type", {"plane", "beams"}, "plane, or a two-way grid of members").absent(0);
  rows.number("width", D::length, "mm", 0, k_large, "contact width; 0: that of the touching member")
      .absent(0)
      .only("type", {"plane"});
  rows.plain("section", T::text, "a [[section]], of its members").required().only("type", {"beams"});
  rows.plain("material", T::text, "a [[material]]").required().only("type", {"beams"});
  rows.number("spacing", D::length, "mm", 0.01, k_large, "of its members in both directions")
      .absent(grid.spacing)
      .only("type", {"beams"});
  rows.number("extent", D::length, "m", 0, 100, "beyond where the bodies start")
      .absent(extent)
      .only("type", {"beams"});
}

void add_floor(std::vector<Key>& keys) {
  Rows rows(keys, "floor");
  add_beams(rows, 2.5);
}

void add_wall(std::vector<Key>& keys) {
  Rows rows(keys, "wall");
  rows.plain("name", T::text, "not \"floor\"").absent_means("wall-1, ...");
  rows.numbers("at", 2, D::length, "m", -k_far, k_far, "x and y of a point on its face, at z = 0").required();
  rows.numbers("normal", 3, -1e6, 1e6, "towards the bodies; made a unit vector").required();
  add_beams(rows, 0.5);
}

void add_material(std::vector<Key>& keys) {
  Rows rows(keys, "material");
  rows.plain("name", T::text, "what cabinets and members call it").required();
  rows.number("young", D::stress, "Pa", 1e3, 1e13, "Young's modulus").required();
  rows.number("poisson", 0, 0.5, "Poisson's ratio").required();
  rows.number("density", D::density, "kg/m^3", 1e-3, 1e5, "density").required();
  rows.number("yield", D::stress, "MPa", 1, 1e13, "yield stress").absent_means("elastic");
  rows.number("fracture_strain", 1e-6, 10, "strain of the extreme fibre or of the axis at fracture")
      .absent_means("never breaks");
}

void add_section(std::vector<Key>& keys) {
  Rows rows(keys, "section");
  rows.plain("name", T::text, "what cabinets and members call it").required();
  const Words walled = words_where(section_shapes(), &SectionTraits::has_wall),
              custom = words_where(section_shapes(), std::not_fn(&SectionTraits::complete));
  rows.word("shape", words_of(section_shapes()), "form").required();
  rows.numbers("size", 2, D::length, "mm", 1e-3, k_large,
               "[a, b] along local y and z, outside; pipe: the outer diameter alone, `\"30 mm\"` or `[\"30 "
               "mm\"]`; custom: twice the distances of the extreme fibres")
      .or_one()
      .absent_means("required; custom: width by width");
  rows.number("thickness", D::length, "mm", 1e-5, k_large, "of the wall; less than half of the smaller size")
      .required()
      .only("shape", walled);
  rows.number("area", D::area, "m^2", 1e-12, 100, "area").required().only("shape", custom);
  rows.number("iy", D::second_moment, "m^4", 1e-18, 100, "resists bending in the local x-z plane")
      .required()
      .only("shape", custom);
  rows.number("iz", D::second_moment, "m^4", 1e-18, 100, "resists bending in the local x-y plane")
      .required()
      .only("shape", custom);
  rows.number("j", D::second_moment, "m^4", 1e-18, 100, "torsion constant").required().only("shape", custom);
  rows.number("ky", 1e-3, 1e3, "shear coefficient in y").required().only("shape", custom);
  rows.number("kz", 1e-3, 1e3, "shear coefficient in z").required().only("shape", custom);
  rows.number("width", D::length, "mm", 1e-3, k_large, "contact width").required().only("shape", custom);
  rows.number("zy", D::section_modulus, "m^3", 1e-15, 100,
              "plastic modulus of bending in the local x-z plane")
      .absent_means("needed where the material yields")
      .only("shape", custom);
  rows.number("zz", D::section_modulus, "m^3", 1e-15, 100,
              "plastic modulus of bending in the local x-y plane")
      .absent_means("needed where the material yields")
      .only("shape", custom);
  rows.number("zt", D::section_modulus, "m^3", 1e-15, 100,
              "plastic modulus of torsion: full torque over yield / sqrt(3)")
      .absent_means("needed where the material yields")
      .only("shape", custom);
}

void add_probe(std::vector<Key>& keys) {
  Rows rows(keys, "probe");
  rows.plain("name", T::text, "name in the summary").absent_means("probe-1, ...");
  rows.plain("body", T::text, "a cabinet, a frame, a block, or a copy").required();
  rows.integer("node", 0, 1e6, "node of a frame's list").absent_means("the body itself");
}

void add_expect(std::vector<Key>& keys) {
  Rows rows(keys, "expect");
  rows.plain("name", T::text, "what it is").absent_means("expect-1, ...");
  rows.plain("value", T::text, "JSON pointer into the summary: `/bodies/0/impacts`; true counts as 1")
      .required();
  rows.number("reference", -1e300, 1e300, "what it should be, in the unit of the summary").required();
  rows.number("tolerance", 0, 1e3, "largest error over the scale").required();
  rows.number("scale", 1e-300, 1e300, "what error and tolerance are relative to")
      .absent_means("size of the reference");
  rows.plain("source", T::text, "where the reference is from").required();
  rows.plain("reason", T::text, "why this tolerance").required();
}

std::vector<Key> build_table() {
  std::vector<Key> keys;
  add_top(keys);
  add_run(keys);
  add_control(keys);
  add_shake(keys);
  add_building(keys);
  add_contact(keys);
  add_floor(keys);
  add_wall(keys);
  add_material(keys);
  add_section(keys);
  add_body_keys(keys);
  add_fitting_keys(keys);
  add_probe(keys);
  add_room_keys(keys);
  add_expect(keys);
  return keys;
}

}  // namespace

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> table = build_table();
  return table;
}

const Key* find_key(std::string_view table, std::string_view name) {
  for (const Key& key : scene_keys()) {
    if (key.table == table && key.name == name) return &key;
  }
  if (table != "furniture") return nullptr;
  for (const std::string_view body : k_furniture_bodies)
    if (const Key* const key = find_key(body, name)) return key;
  return nullptr;
}

}  // namespace topple::io
