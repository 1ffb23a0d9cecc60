// Cabinets, frames and blocks of a scene.
#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "solver/body/model_level.h"
#include "solver/frame/integrator.h"
#include "solver/io/builtin/stock.h"
#include "solver/io/common/units.h"
#include "solver/io/scene/scene_read.h"
#include "solver/model/block.h"
#include "solver/model/cabinet.h"
#include "solver/reduced/elastic_basis.h"

namespace topple::io {
namespace {

// What two cores step in reasonable time is far below; this keeps a slip of the pen from filling the memory.
using Box = Eigen::AlignedBox3d;

constexpr std::size_t k_most_elements = 100000;
// As BodyBuilder: an `up` nearer to the member's axis gives no local z.
constexpr double k_parallel = 1e-6;

/// Materials and sections by name. Sections that builders add are not among them.
class Library {
 public:
  explicit Library(const Model& model) : model_(model) {
    for (const Material& material : model.materials) materials_.push_back(material.name);
    for (const Section& section : model.sections) sections_.push_back(section.name);
  }
  /// Also checks that it can yield when the entry's material does.
  int section(const Entry& entry) const {
    const int found = index(entry, "section", sections_);
    const Section& section = model_.sections[found];
    const Material& stuff = model_.materials[material(entry)];
    if (stuff.yield > 0 && !(section.zy > 0 && section.zz > 0 && section.zt > 0))
      entry.fail("section", "\"" + section.name + "\" of material \"" + stuff.name +
                                "\", which yields, has no plastic moduli: give zy, zz and zt");
    return found;
  }
  int material(const Entry& entry) const { return index(entry, "material", materials_); }

 private:
  static int index(const Entry& entry, const std::string& key, const std::vector<std::string>& names) {
    const std::string name = entry.text(key);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    entry.fail(key, no_such_stuff(key, name, names));
  }

  const Model& model_;
  std::vector<std::string> materials_, sections_;
};

void check_start(const Entry& entry, const Setup& setup) {
  if (!setup.run.settle) return;
  const auto moves = [&](std::string_view key) { return entry.has(key) && !entry.vector(key).isZero(0); };
  for (const std::string_view key : {"velocity", "angular_velocity"}) {
    if (moves(key))
      entry.fail(key, "a body that starts in motion cannot settle: write settle = false in [run]");
  }
}

void check_tilt(const Entry& entry, const Setup& setup, double tilt) {
  if (setup.run.settle && tilt != 0)
    entry.fail("tilt", "a body that starts tilted cannot settle: write settle = false in [run]");
}

void read_placement(const Entry& entry, Placement& spec) {
  const std::vector<double> at = entry.numbers("at");
  spec.at = Vec3(at[0], at[1], at.size() > 2 ? at[2] : 0);
  spec.yaw = entry.number("yaw");
  spec.pose = entry.chosen("pose", k_poses);
  spec.tilt = entry.number("tilt");
  spec.velocity = entry.vector("velocity");
  spec.angular_velocity = entry.vector("angular_velocity");
  spec.base = entry.chosen("base", k_bases);
}

CabinetSpec read_cabinet(const Entry& entry, const Library& library) {
  CabinetSpec spec;
  spec.name = entry.name();
  spec.size = entry.vector("size");
  spec.mass = entry.number("mass");
  spec.cg_height = entry.has("cg_height") ? entry.number("cg_height") : spec.size.z() / 2;
  if (!(spec.cg_height < spec.size.z()))
    entry.fail("cg_height", short_number(1e3 * spec.cg_height) + " mm is not below the top, " +
                                short_number(1e3 * spec.size.z()) + " mm");
  if (entry.has("cg_offset")) {
    const std::vector<double> offset = entry.numbers("cg_offset");
    spec.cg_offset = Eigen::Vector2d(offset[0], offset[1]);
  }
  if (entry.is_word("inertia")) {
    spec.inertia = entry.chosen("inertia", k_inertias);
  } else {
    spec.inertia = CabinetSpec::Inertia::given;
    spec.inertia_given = entry.vector("inertia");
  }
  read_placement(entry, spec);
  spec.section = library.section(entry);
  spec.material = library.material(entry);
  spec.shelves = entry.integer("shelves");
  spec.bracing = entry.chosen("bracing", k_bracings);
  spec.panel_thickness = entry.number("panel_thickness");
  spec.front = entry.chosen("front", k_fronts);
  spec.divisions = entry.integer("divisions");
  return spec;
}

BlockSpec read_block(const Entry& entry) {
  BlockSpec spec;
  spec.name = entry.name();
  spec.size = entry.vector("size");
  spec.mass = entry.number("mass");
  spec.cg = entry.has("cg") ? entry.vector("cg") : Vec3(0, 0, spec.size.z() / 2);
  if (!entry.is_word("inertia")) spec.inertia = entry.vector("inertia");
  read_placement(entry, spec);
  if (entry.has("width")) spec.width = entry.number("width");
  return spec;
}

int read_node(const Entry& entry, std::string_view key, int node, const FrameSpec& spec, int part = -1) {
  const int count = static_cast<int>(spec.nodes.size());
  if (node < count) return node;
  entry.fail(key,
             std::to_string(node) + " is not a node of the frame, which has 0.." + std::to_string(count - 1),
             part);
}

FrameMember read_member(const Entry& entry, const FrameSpec& spec, const Library& library) {
  FrameMember member{};
  const std::vector<int> ends = entry.integers("nodes");
  for (int k = 0; k < 2; ++k) member.node[k] = read_node(entry, "nodes", ends[k], spec, k);
  if (ends[0] == ends[1]) entry.fail("nodes", "a member from a node to itself has no length");
  member.section = library.section(entry);
  member.material = library.material(entry);
  member.elements = entry.integer("elements");
  if (member.elements % 2 != 0) entry.fail("elements", std::to_string(member.elements) + " is not even");
  if (entry.has("up")) {
    member.up = entry.direction("up");
    const Vec3 axis = spec.nodes[member.node[1]] - spec.nodes[member.node[0]];
    if (axis.norm() > 0 && axis.normalized().cross(member.up).norm() < k_parallel) {
      entry.fail("up", "is parallel to the member");
    }
  }
  return member;
}

unsigned read_fix(const Entry& entry) {
  unsigned fixed = 0;
  for (const char c : entry.text("fix")) {
    const auto bit = k_directions.find(c);
    if (bit == k_directions.npos) {
      entry.fail("fix", "expected letters of " + std::string(k_directions) + ", found \"" +
                            entry.text("fix") + "\"");
    }
    fixed |= 1u << bit;
  }
  return fixed;
}

FrameSpec read_frame(const Entry& entry, const Library& library) {
  FrameSpec spec;
  spec.name = entry.name();
  spec.nodes = entry.vectors("nodes");
  for (const Entry& member : entry.entries("members"))
    spec.members.push_back(read_member(member, spec, library));
  if (spec.members.empty()) entry.fail("members", "there are none");
  for (const Entry& support : entry.entries("supports")) {
    const int node = read_node(support, "node", support.integer("node"), spec);
    const auto same = [&](const Support& other) { return other.node == node; };
    const auto found = std::find_if(spec.supports.begin(), spec.supports.end(), same);
    if (found == spec.supports.end()) {
      spec.supports.push_back({node, read_fix(support)});
    } else {
      found->fixed |= read_fix(support);
    }
  }
  for (const Entry& load : entry.entries("loads")) {
    const int node = read_node(load, "node", load.integer("node"), spec);
    spec.loads.push_back({node, load.vector("force"), load.vector("moment"), load.history("history")});
    if (spec.loads.back().force.isZero(0) && spec.loads.back().moment.isZero(0))
      load.fail("has no direction: force and moment are zero; one of them is needed");
  }
  for (const Entry& mass : entry.entries("masses")) {
    const int node = read_node(mass, "node", mass.integer("node"), spec);
    spec.masses.push_back({node, mass.number("mass"), mass.vector("inertia")});
  }
  for (const Entry& panel : entry.entries("panels")) {
    const std::vector<int> nodes = panel.integers("nodes");
    std::array<int, 4>& corners = spec.panels.emplace_back();
    for (int k = 0; k < 4; ++k) corners[k] = read_node(panel, "nodes", nodes[k], spec, k);
  }
  if (entry.has("mass")) spec.mass = entry.number("mass");
  spec.copies = entry.vectors("copies");
  spec.tilt = entry.number("tilt");
  spec.velocity = entry.vector("velocity");
  spec.angular_velocity = entry.vector("angular_velocity");
  return spec;
}

void check_size(const Entry& entry, std::size_t elements) {
  if (elements <= k_most_elements) return;
  entry.fail("brings the scene to " + std::to_string(elements) + " elements, more than " +
             std::to_string(k_most_elements));
}

void check_size(const Entry& entry, const Model& model, const FrameSpec& spec) {
  std::size_t elements = 0;
  for (const FrameMember& member : spec.members) elements += static_cast<std::size_t>(member.elements);
  check_size(entry, model.elements.size() + elements * std::max<std::size_t>(1, spec.copies.size()));
}

// Copies are named by the builder, so that they may meet a name of the file.
void check_copies(const Entry& entry, const Model& model, std::size_t first) {
  std::set<std::string> names;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::string& name = model.bodies[b].name;
    if (names.insert(name).second) continue;
    if (b == first) entry.fail("name", "\"" + name + "\" is also the name of a copy");
    entry.fail("copies", "the copy \"" + name + "\" has the name of another body");
  }
}

// Blames the key that a builder names, or the whole entry where the key is absent.
template <typename F>
void build(const Entry& entry, F&& builder) {
  try {
    builder();
  } catch (const BuildError& error) {
    if (error.key.empty()) entry.fail(error.what());
    entry.fail(error.key, error.what());
  }
}

// One, or its copies.
template <class Spec>
void add_copies(const Entry& entry, const Spec& spec, BodyStart (*add)(Model&, const Spec&), Setup& setup) {
  std::vector<Vec3> copies = entry.vectors("copies");
  if (copies.empty()) copies.push_back(Vec3::Zero());
  for (std::size_t c = 0; c < copies.size(); ++c) {
    Spec copy = spec;
    copy.name = copy_name(spec.name, c);
    copy.at += copies[c];
    build(entry, [&] { setup.starts.push_back(add(setup.model, copy)); });
    check_size(entry, setup.model.elements.size());
  }
}

Box starting_box(const Setup& setup) {
  Box box;
  for (const Vec3& x : start_state(setup.model, setup.starts).position) box.extend(x);
  return box;
}

void read_grid(const Entry& entry, const Library& library, GridSpec spec, const Box& furniture,
               Setup& setup) {
  spec.section = library.section(entry);
  spec.material = library.material(entry);
  spec.spacing = entry.number("spacing");
  const double extent = entry.number("extent");
  const bool is_floor = spec.normal == Vec3::UnitZ();
  Box reach;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x = furniture.corner(static_cast<Box::CornerType>(corner)) - spec.origin;
    reach.extend(Vec3(x.dot(spec.along), x.dot(spec.up), 0));
  }
  for (int k = 0; k < 2; ++k) {
    spec.from[k] = reach.min()[k] - extent;
    spec.to[k] = reach.max()[k] + extent;
  }
  if (!is_floor) spec.from[1] = 0;  // walls stand on z = 0
  build(entry, [&] { setup.starts.push_back(add_grid(setup.model, spec)); });
  check_size(entry, setup.model.elements.size());
}

/// Floors and walls of members, after the furniture.
void read_grids(const Entry& root, const Library& library, Setup& setup) {
  const Box furniture = starting_box(setup);
  if (const Entry floor = root.entry("floor"); floor.present() && is_beams(floor)) {
    GridSpec spec;
    spec.name = "floor";
    read_grid(floor, library, spec, furniture, setup);
  }
  for (const Entry& wall : root.entries("wall")) {
    if (!is_beams(wall)) continue;
    GridSpec spec;
    spec.name = wall.name();
    const std::vector<double> at = wall.numbers("at");
    spec.origin = Vec3(at[0], at[1], 0);
    spec.normal = wall.direction("normal");
    if (std::abs(spec.normal.z()) > 1e-9) wall.fail("normal", "of a wall of beams is horizontal");
    spec.along = Vec3::UnitZ().cross(spec.normal).normalized();
    spec.up = Vec3::UnitZ();
    read_grid(wall, library, spec, furniture, setup);
  }
}

// Of the last `count` bodies.
void read_friction(const Entry& entry, int count, Setup& setup) {
  if (!entry.has("friction")) return;
  const double of_all = setup.parameters.contact.friction;
  if (of_all == 0)
    entry.fail("friction", "contact.friction is 0, of which it is a share; write a small one there");
  for (Body& body : std::span(setup.model.bodies).last(count)) body.grip = entry.number("friction") / of_all;
}

// What the last `count` bodies are computed as.
void read_model(const Entry& root, const Entry& entry, int count, Setup& setup) {
  Model& model = setup.model;
  BodyModel asked = entry.chosen("model", body_models());
  const Entry run = root.entry("run");
  const bool named = run.word("integrator") != "auto";
  if (asked == BodyModel::automatic && (named || setup.run.analysis != Analysis::dynamic))
    asked = BodyModel::frame;
  const BodyModelTraits& how = traits(asked);
  if (!how.may_be_frame) {
    if (named && !traits(setup.parameters.integrator).is_explicit)
      entry.fail("model", "\"" + entry.text("model") +
                              "\" bodies take central differences: run.integrator = \"" +
                              run.text("integrator") + "\" is for frames");
    const int first = static_cast<int>(model.bodies.size()) - count;
    const auto its = [&](const auto& at) { return model.node_body[at.node] >= first; };
    if (std::any_of(model.supports.begin(), model.supports.end(), its) ||
        std::any_of(model.loads.begin(), model.loads.end(), its))
      entry.fail("model", "a body with supports or loads is computed as \"frame\"");
  }
  const double damping = entry.number("damping"), restitution = entry.number("restitution");
  for (int b = static_cast<int>(model.bodies.size()) - count; b < static_cast<int>(model.bodies.size());
       ++b) {
    setup.parameters.models.push_back(asked);
    setup.parameters.damping.push_back(damping);
    Body& body = model.bodies[b];
    body.restitution = restitution;
    if (how.bends) {
      body.elastic = elastic_basis(model, b);
      if (!how.may_be_frame && !body.elastic)
        entry.fail("model", "no elastic body: a part of it moves without strain or has no mass");
    }
    if (body.elastic || damping > 0) body.first_frequency = first_frequency(model, b);
    if (damping > 0 && body.first_frequency == 0)
      entry.fail("damping", "the body has no elastic mode: a part of it has no mass");
  }
}

// Of blocks, as above.
void read_block_model(const Entry& root, const Entry& entry, int count, Setup& setup) {
  const std::string_view analysis = root.entry("run").word("analysis");
  if (setup.run.analysis != Analysis::dynamic)
    entry.fail("a block is rigid: analysis = \"" + std::string(analysis) + "\" is for frames");
  if (traits(setup.parameters.integrator).is_explicit)
    entry.fail("a block is rigid: integrator = \"" + root.entry("run").text("integrator") +
               "\" makes a frame of each body that is near another");
  setup.parameters.models.insert(setup.parameters.models.end(), count, entry.chosen("model", body_models()));
  setup.parameters.damping.insert(setup.parameters.damping.end(), count, 0);
  for (Body& body : std::span(setup.model.bodies).last(count)) body.restitution = entry.number("restitution");
}

}  // namespace

std::vector<Entry> read_bodies(const Entry& root, Setup& setup) {
  Model& model = setup.model;
  const Library library(model);
  std::vector<Entry> of_body;
  for (const Entry& entry : root.entries("cabinet")) {
    const CabinetSpec spec = read_cabinet(entry, library);
    check_start(entry, setup);
    check_tilt(entry, setup, spec.tilt);
    const std::size_t first = model.bodies.size();
    add_copies(entry, spec, add_cabinet, setup);
    check_copies(entry, model, first);
    read_model(root, entry, static_cast<int>(model.bodies.size() - first), setup);
    read_friction(entry, static_cast<int>(model.bodies.size() - first), setup);
    of_body.resize(model.bodies.size(), entry);
  }
  for (const Entry& entry : root.entries("frame")) {
    const FrameSpec spec = read_frame(entry, library);
    check_start(entry, setup);
    check_tilt(entry, setup, spec.tilt);
    check_size(entry, model, spec);
    const std::size_t first = model.bodies.size();
    build(entry, [&] {
      const std::vector<BodyStart> starts = add_frame(model, spec);
      setup.starts.insert(setup.starts.end(), starts.begin(), starts.end());
    });
    check_copies(entry, model, first);
    read_model(root, entry, static_cast<int>(model.bodies.size() - first), setup);
    read_friction(entry, static_cast<int>(model.bodies.size() - first), setup);
    of_body.resize(model.bodies.size(), entry);
  }
  for (const Entry& entry : root.entries("block")) {
    const BlockSpec spec = read_block(entry);
    check_start(entry, setup);
    check_tilt(entry, setup, spec.tilt);
    const std::size_t first = model.bodies.size();
    add_copies(entry, spec, add_block, setup);
    check_copies(entry, model, first);
    read_block_model(root, entry, static_cast<int>(model.bodies.size() - first), setup);
    read_friction(entry, static_cast<int>(model.bodies.size() - first), setup);
    of_body.resize(model.bodies.size(), entry);
  }
  if (model.bodies.empty()) {
    root.fail(
        "there are no bodies; a scene has at least one [[furniture]], [[cabinet]], [[frame]] or [[block]]");
  }
  read_grids(root, library, setup);
  setup.parameters.models.resize(model.bodies.size(), BodyModel::frame);
  setup.parameters.damping.resize(model.bodies.size(), 0);
  check_planes(of_body, setup);
  return of_body;
}

}  // namespace topple::io
