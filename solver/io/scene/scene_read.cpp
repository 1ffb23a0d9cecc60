#include "solver/io/scene/scene_read.h"

#include <algorithm>
#include <cmath>

#include "solver/contact/contact_default.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/io/scene/scene_keys.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

// A section's walls against its sides: complete_section() asks for it.
void check_wall(const Entry& entry, const Section& section) {
  const double smaller = std::min(section.size_y, section.size_z);
  if (2 * section.thickness < smaller) return;
  entry.fail("thickness", short_number(1e3 * section.thickness) +
                              " mm is not less than half of the smaller size, " +
                              short_number(1e3 * smaller) + " mm");
}

// Of a cabinet or frame.
int bodies_of(const Entry& entry) {
  return std::max<int>(1, static_cast<int>(entry.vectors("copies").size()));
}

int cabinet_total(const Entry& root) {
  int count = 0;
  for (const Entry& cabinet : root.entries("cabinet")) count += bodies_of(cabinet);
  return count;
}

// Index into the model of `node` of the entry, which counts within its frame.
int find_node(const Entry& root, const Entry& entry, const Model& model, int body, const char* otherwise) {
  int nodes = 0;  // a copy has the nodes of its frame
  int first = cabinet_total(root);
  for (const Entry& frame : root.entries("frame")) {
    const int copies = bodies_of(frame);
    if (body >= first && body < first + copies) nodes = static_cast<int>(frame.vectors("nodes").size());
    first += copies;
  }
  const int node = entry.integer("node");
  if (nodes == 0)
    entry.fail("node", std::string("the nodes of a ") + (model.bodies[body].solid ? "block" : "cabinet") +
                           " have no numbers" + otherwise);
  if (node >= nodes) {
    entry.fail("node", std::to_string(node) + " is not a node of \"" + model.bodies[body].name +
                           "\", which has 0.." + std::to_string(nodes - 1));
  }
  return model.bodies[body].first_node + node;
}

// Poisson's ratio of the first member made of the section; that of common metals when none is.
double poisson_of_section(const Entry& root, const Setup& setup, const std::string& section) {
  std::vector<Entry> users = root.entries("cabinet");
  for (const Entry& frame : root.entries("frame")) {
    for (const Entry& member : frame.entries("members")) users.push_back(member);
  }
  for (const Entry& user : users) {
    if (user.text("section") != section) continue;
    for (const Material& material : setup.model.materials) {
      if (material.name == user.text("material")) return material.poisson;
    }
  }
  constexpr double k_unused = 0.3;
  return k_unused;
}

// RFC 6901: "/" before every part; "~" only as "~0" or "~1".
void check_pointer(const Entry& entry, const std::string& pointer) {
  bool sound = pointer.front() == '/';
  for (std::size_t i = 0; i < pointer.size(); ++i)
    if (pointer[i] == '~') sound = sound && i + 1 < pointer.size() && (pointer[i + 1] | 1) == '1';
  if (!sound)
    entry.fail("value",
               "\"" + pointer + "\" is not a JSON pointer into the summary, such as /bodies/0/impacts");
}

}  // namespace

void read_run(const Entry& root, Setup& setup) {
  const Entry run = root.entry("run");
  setup.model.scheme = run.chosen("elements", k_schemes);
  setup.run.duration = run.number("duration");
  setup.run.settle = run.flag("settle");
  setup.run.output_rate = run.number("output_rate");
  setup.run.stop_when = run.chosen("stop_when", k_stops);
  setup.parameters.want_stress = !run.has("want") || run.names("want", "stress");
  setup.parameters.accuracy = run.number("accuracy");
  setup.parameters.gravity = run.vector("gravity");
  setup.parameters.automatic_integrator = run.word("integrator") == "auto";
  if (!setup.parameters.automatic_integrator)
    setup.parameters.integrator = run.chosen("integrator", integrators());
  setup.parameters.spectral_radius = run.number("spectral_radius");
  setup.parameters.beta = run.number("beta");
  setup.parameters.gamma = run.number("gamma");
  // a step that was not chosen for the contact follows it
  const bool of_contact =
      !root.entry("contact").has("alpha") && (root.entry("floor").present() || !root.entries("wall").empty());
  setup.parameters.adaptive =
      run.has("time_step") ? run.text("time_step") == "auto" : run.has("tolerance") || of_contact;
  if (run.has("tolerance") && !setup.parameters.adaptive)
    run.fail("tolerance", "belongs to time_step = auto, but time_step is fixed");
  if (!setup.parameters.adaptive) setup.parameters.time_step = run.number("time_step");
  setup.parameters.tolerance = run.number("tolerance");
  setup.run.analysis = run.chosen("analysis", k_analyses);
  setup.run.statics.load_steps = run.integer("load_steps");
  setup.run.statics.stop_at_instability = run.has("stop_at");
  if (setup.run.analysis != Analysis::dynamic) {
    setup.run.duration = 1;
    setup.run.settle = setup.run.settle && !setup.parameters.gravity.isZero(0);
    return;
  }
  if (setup.run.settle && setup.parameters.gravity.isZero(0)) {
    run.fail("gravity", "nothing settles without gravity: write settle = false in [run]");
  }
}

// "law = paper or printed"
std::string laws_that_slide() {
  std::string words;
  for (const ContactLawTraits& law : contact_laws())
    if (!law.sticks) words += (words.empty() ? "law = " : " or ") + std::string(law.word);
  return words;
}

void read_contact(const Entry& root, Setup& setup) {
  const Entry contact = root.entry("contact");
  ContactLaw& law = setup.parameters.contact;
  law.kind = contact.chosen("law", contact_laws());
  law.alpha = contact.number("alpha");
  law.q = contact.number("q");
  law.friction = contact.number("friction");
  if (contact.has("friction_static")) {
    law.friction_static = contact.number("friction_static");
    if (law.friction_static < law.friction)
      contact.fail("friction_static", short_number(law.friction_static) +
                                          " is below contact.friction, which is " +
                                          short_number(law.friction));
  }
  if (contact.has("slip_speed") && traits(law).sticks && !contact.has("friction_static"))
    contact.fail("slip_speed", "belongs to " + laws_that_slide() + ", or to a friction_static");
  law.restitution = contact.number("restitution");
  law.normal_speed = contact.number("normal_speed");
  law.slip_speed = contact.number("slip_speed");
  law.member_share = contact.number("member_share");
  setup.model.surfaces = contact.flag("surfaces");
}

void choose_alpha(const Entry& root, Setup& setup) {
  if (root.entry("contact").has("alpha") || setup.run.analysis == Analysis::modes) return;
  ContactLaw& law = setup.parameters.contact;
  const auto choose = [&](const char* name, double value) {
    const Key& key = *find_key("contact", name);
    return std::clamp(value, key.least, key.most);
  };
  const Vec3& gravity = setup.parameters.gravity;
  const auto alpha = rigid_alpha(setup.model, law, gravity);
  if (!alpha) return;
  law.alpha = choose("alpha", *alpha);
  if (!root.entry("contact").has("member_share"))
    law.member_share = choose("member_share", *member_alpha(setup.model, law, gravity) / law.alpha);
}

bool is_beams(const Entry& entry) {
  return entry.word("type") == "beams";
}

void read_planes(const Entry& root, Setup& setup) {
  if (const Entry floor = root.entry("floor"); floor.present() && !is_beams(floor)) {
    setup.model.planes.push_back({"floor", Vec3::Zero(), Vec3::UnitZ(), floor.number("width")});
  }
  for (const Entry& wall : root.entries("wall")) {
    if (is_beams(wall)) continue;
    const std::vector<double> at = wall.numbers("at");
    setup.model.planes.push_back(
        {wall.name(), Vec3(at[0], at[1], 0), wall.direction("normal"), wall.number("width")});
  }
}

Section read_section(const Entry& entry) {
  Section section;
  section.name = entry.name();
  section.shape = entry.chosen("shape", section_shapes());
  const SectionTraits& shape = traits(section.shape);
  if (entry.has("size")) {
    const std::vector<double> size = entry.numbers("size");
    if (shape.is_round && size.size() != 1)
      entry.fail("size", "a " + std::string(shape.word) + " has one size, its outer diameter");
    if (!shape.is_round && size.size() != 2)
      entry.fail("size", "expected [a, b], the sizes along local y and z");
    section.size_y = size.front();
    section.size_z = size.back();
  } else if (shape.complete) {
    entry.fail("size", "missing (outer sizes along local y and z; pipe: the diameter)");
  }
  if (shape.has_wall) {
    section.thickness = entry.number("thickness");
    check_wall(entry, section);
  }
  if (!shape.complete) {
    section.area = entry.number("area");
    section.iy = entry.number("iy");
    section.iz = entry.number("iz");
    section.j = entry.number("j");
    section.ky = entry.number("ky");
    section.kz = entry.number("kz");
    section.width = entry.number("width");
    if (entry.has("zy")) section.zy = entry.number("zy");
    if (entry.has("zz")) section.zz = entry.number("zz");
    if (entry.has("zt")) section.zt = entry.number("zt");
    if (!entry.has("size")) section.size_y = section.size_z = section.width;
  }
  return section;
}

void read_materials_and_sections(const Entry& root, Setup& setup) {
  for (const Entry& entry : root.entries("material")) {
    Material material{entry.name(), entry.number("young"), entry.number("poisson"), entry.number("density")};
    if (entry.has("yield")) material.yield = entry.number("yield");
    if (entry.has("fracture_strain")) material.fracture_strain = entry.number("fracture_strain");
    if (material.fracture_strain > 0 && !(material.yield > 0))
      entry.fail("fracture_strain", "a material breaks where it has yielded: give yield as well");
    setup.model.materials.push_back(material);
  }
  for (const Entry& entry : root.entries("section")) {
    Section section = read_section(entry);
    complete_section(section, poisson_of_section(root, setup, section.name));
    setup.model.sections.push_back(section);
  }
}

int find_body(const Entry& entry, const char* key, const Model& model) {
  const std::string name = entry.text(key);
  const auto& bodies = model.bodies;
  const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == name; });
  if (body != bodies.end()) return static_cast<int>(body - bodies.begin());
  std::string known;
  for (const Body& b : bodies) known += (known.empty() ? "" : ", ") + b.name;
  entry.fail(key, "there is no body \"" + name + "\"; known: " + known);
}

int find_body(const Entry& entry, const Model& model) {
  return find_body(entry, "body", model);
}

void read_probes(const Entry& root, Setup& setup) {
  for (const Entry& entry : root.entries("probe")) {
    Probe probe{entry.name(), find_body(entry, setup.model), -1};
    if (entry.has("node")) {
      probe.node = find_node(root, entry, setup.model, probe.body, "; leave it out to follow the body");
    }
    setup.probes.push_back(probe);
  }
}

/// "y, X", or "none".
std::string free_directions(unsigned fixed) {
  std::string out;
  for (std::size_t k = 0; k < k_directions.size(); ++k)
    if (!(fixed >> k & 1)) out += (out.empty() ? "" : ", ") + std::string(1, k_directions[k]);
  return out.empty() ? "none" : out;
}

void read_control(const Entry& root, Setup& setup) {
  const Entry entry = root.entry("run").entry("control");
  if (!entry.present()) return;
  const Model& model = setup.model;
  const int body = entry.has("body") ? find_body(entry, model) : cabinet_total(root);
  if (body >= static_cast<int>(model.bodies.size())) entry.fail("body", "there is no frame to control");
  PathControl control;
  control.arc_length = entry.has("arc");
  for (const char* const key : {"node", "dof"}) {
    if (entry.has(key) && control.arc_length)
      entry.fail(key, "belongs to control of a node, but arc is given");
    if (!entry.has(key) && !control.arc_length) entry.fail(key, "missing; give node and dof, or arc");
  }
  if (control.arc_length) {
    control.node = model.bodies[body].first_node;
    if (entry.number("arc") > 0) control.to = entry.number("arc");
  } else {
    control.node = find_node(root, entry, model, body, "; control takes a frame");
    control.direction = static_cast<int>(k_directions.find(entry.word("dof")));
  }
  for (const Support& support : model.supports)
    if (!control.arc_length && support.node == control.node && support.fixed >> control.direction & 1)
      entry.fail("dof", "\"" + std::string(entry.word("dof")) +
                            "\" is supported at the node; free are: " + free_directions(support.fixed));
  bool loaded = false;
  for (const Load& load : model.loads) {
    if (!load.history.empty()) entry.fail("with control loads have no history: the factor is sought");
    loaded = loaded || model.node_body[load.node] == body;
  }
  if (!loaded) entry.fail("there is no load on \"" + model.bodies[body].name + "\"");
  for (const std::string_view key : {"to", "to_angle"}) {
    if (!entry.has(key)) continue;
    control.to = entry.number(key);
    if (*control.to == 0) entry.fail(key, "is no travel");
  }
  setup.run.statics.control = control;
}

void read_expectations(const Entry& root, Scene& scene) {
  for (const Entry& entry : root.entries("expect")) {
    Expectation expected;
    expected.name = entry.name();
    expected.value = entry.text("value");
    check_pointer(entry, expected.value);
    expected.reference = entry.number("reference");
    expected.tolerance = entry.number("tolerance");
    if (!entry.has("scale") && expected.reference == 0)
      entry.fail("scale", "missing; nothing is relative to a reference of 0");
    expected.scale = entry.has("scale") ? entry.number("scale") : std::abs(expected.reference);
    expected.source = entry.text("source");
    expected.reason = entry.text("reason");
    expected.place = entry.where("value");
    scene.expectations.push_back(std::move(expected));
  }
}

}  // namespace topple::io
