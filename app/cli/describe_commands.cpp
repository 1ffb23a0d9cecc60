#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "app/support/terms.h"
#include "solver/body/model_level.h"
#include "solver/io/recording/recording.h"
#include "solver/io/recording/rerun.h"
#include "solver/io/scene/edit_text.h"
#include "solver/io/scene/scene.h"
#include "solver/math/elementary.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const io::Scene& scene) {
  const Setup& setup = scene.setup;
  ordered_json out;
  out["kind"] = "scene";
  out["scene"] = scene.name;
  out["title"] = scene.title;
  static const char* const k_analyses[] = {"dynamic", "static", "modes"};
  out["analysis"] = k_analyses[static_cast<std::size_t>(setup.run.analysis)];
  const bool loads = is_static(setup);
  out["duration_s"] = loads ? ordered_json(nullptr) : ordered_json(setup.run.duration);
  const bool steps = !loads && !setup.parameters.adaptive;
  out["time_step_s"] = steps ? ordered_json(setup.parameters.time_step) : ordered_json(nullptr);
  out["contact_alpha_N"] = setup.parameters.contact.alpha;
  if (loads) out["load_steps"] = setup.run.statics.load_steps;
  out["nodes"] = setup.model.node_total();
  out["elements"] = setup.model.elements.size();
  out["contact_points"] = setup.model.contact_points.size();
  out["bodies"] = ordered_json::array();
  for (const Body& body : setup.model.bodies)
    out["bodies"].push_back({{"name", body.name},
                             {"mass_kg", body.mass},
                             {"centre_of_gravity_m", vector_json(body.centre_of_gravity)},
                             {"inertia_kg_m2", vector_json(body.inertia.diagonal())},
                             {"nodes", body.node_count},
                             {"elements", body.element_count}});
  out["anchors"] = ordered_json::array();
  for (std::size_t k = 0; k < setup.model.anchors.size(); ++k) {
    const Anchor& anchor = setup.model.anchors[k];
    out["anchors"].push_back(describe_anchor(setup.model, anchor));
    out["anchors"].back()["length_m"] = anchor.length;
    out["anchors"].back()["stiffness_N_m"] = anchor.stiffness;
    out["anchors"].back()["on"] = setup.parameters.anchors[k];
  }
  return out;
}

ordered_json describe(const io::RecordedEvent& e, const ordered_json& bodies, const ordered_json& anchors) {
  static const char* const k_kinds[] = {"uplift",   "impact", "overturn", "hinge",
                                        "fracture", "model",  "anchor"};
  const auto kind = static_cast<std::size_t>(e.event.kind), body = static_cast<std::size_t>(e.event.body);
  if (kind >= std::size(k_kinds) || body >= bodies.size())
    throw io::InputError("the recording has an event of a kind or a body that it does not describe");
  const auto anchor = static_cast<std::size_t>(e.event.anchor);
  if (e.event.kind == Event::Kind::anchor && anchor >= anchors.size())
    throw io::InputError("the recording has an event of an anchor that it does not describe");
  ordered_json out = {{"kind", k_kinds[kind]},
                      {"time_s", e.time},
                      {"step", e.step},
                      {"body", bodies[body]["name"]},
                      {"value", e.event.value}};
  if (e.event.kind == Event::Kind::anchor) out["anchor"] = anchors[anchor]["name"];
  if (e.event.kind == Event::Kind::model) {
    out["model"] = traits(static_cast<ModelLevel>(e.event.value)).word;
    out["reason"] = name(e.event.reason);
  }
  return out;
}

ordered_json describe(const LoggedEdit& logged) {
  const Edit& edit = logged.edit;
  return {
      {"branch", logged.branch},
      {"step", logged.step},
      {"time_s", logged.time},
      {"key", io::edit_key(edit)},
      {"value", edit.key == Edit::Key::direction ? vector_json(edit.value) : ordered_json(edit.value.x())}};
}

bool is_static(const ordered_json& description) {
  return description["analysis"] == "static";
}

/// The ledger at one instant, named as in the summary.
ordered_json describe_energy(const io::FrameRow& row, bool is_static) {
  const std::vector<double>& e = row.energy;
  const bool anchors = e.size() > io::k_released;
  const double released = anchors ? e[io::k_released] : 0;
  return {{"input_J", e[io::k_input]},
          {"kinetic_J", e[io::k_kinetic]},
          {"strain_J", e[io::k_strain]},
          {"gravity_J", e[io::k_gravity]},
          {"contact_J", e[io::k_contact]},
          {"dissipated_J", e[io::k_friction] + e[io::k_normal_damping] + e[io::k_numerical] +
                               e[io::k_plastic] + e[io::k_damping] + released},
          {"friction_J", e[io::k_friction]},
          {"normal_damping_J", e[io::k_normal_damping]},
          {"numerical_J", e[io::k_numerical]},
          {"plastic_J", e[io::k_plastic]},
          {"damping_J", e[io::k_damping]},
          {"model_switch_J", e[io::k_model_switch]},
          {"anchor_J", anchors ? ordered_json(e[io::k_anchor]) : ordered_json(0)},
          {"released_J", anchors ? ordered_json(released) : ordered_json(0)},
          {"balance_error", is_static ? ordered_json(nullptr) : ordered_json(e[io::k_balance_error])}};
}

ordered_json describe(const io::Recording& recording) {
  ordered_json out = describe(io::recorded_scene(recording));
  const std::int32_t newest = recording.newest_branch();
  const std::vector<std::int64_t> shown = recording.frames_on_way_to(newest);
  out["kind"] = "recording";
  out["format"] = recording.format();
  out["arithmetic"] = recording.arithmetic();
  out["status"] = recording.status();
  out["frames"] = recording.frame_count();
  out["recorded_s"] = shown.empty() ? 0 : recording.index()[shown.back()].time;
  out["recorded_steps"] = shown.empty() ? 0 : recording.index()[shown.back()].step;
  out["checkpoints"] = recording.checkpoint_count();
  if (recording.checkpoint_count() > 0)
    out["last_state_hash"] =
        fmt::format("{:016x}", recording.checkpoint(recording.checkpoint_count() - 1).hash);
  if (!shown.empty()) out["energy"] = describe_energy(recording.frame(shown.back()), is_static(out));
  out["branches"] = ordered_json::array();
  for (const Branch& b : recording.history().branches)
    out["branches"].push_back({{"id", b.id}, {"parent", b.parent}, {"fork_step", b.fork_step}});
  out["edits"] = ordered_json::array();
  for (const LoggedEdit& e : recording.history().edits) out["edits"].push_back(describe(e));
  out["events"] = ordered_json::array();
  for (const io::RecordedEvent& e : recording.events_on_way_to(newest))
    out["events"].push_back(describe(e, out["bodies"], out["anchors"]));
  if (!recording.summary_json().empty()) out["summary"] = ordered_json::parse(recording.summary_json());
  return out;
}

std::string counted(std::int64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

ordered_json describe(const io::Difference& found, const Model& model) {
  const auto& [at, what, element] = found;
  ordered_json out{
      {"branch", at.branch}, {"step", at.step}, {"time_s", at.time}, {"what", what}, {"element", nullptr}};
  if (element >= 0) {
    const Member& member = model.members[model.elements[element].member];
    out["element"] = element;
    out["member"] = member.name;
    out["body"] = model.bodies[member.body].name;
  }
  return out;
}

ordered_json verify(const io::Recording& recording) {
  const auto total = static_cast<double>(recording.checkpoint_count());
  Progress progress("re-run", "checkpoints", std::max(total, 1.), false);
  const io::Rerun rerun =
      io::rerun(recording, [&](std::int64_t seen) { progress.update(static_cast<double>(seen)); });
  const bool same = rerun.differences.empty(), own = recording.arithmetic() == arithmetic();
  ordered_json out{{"checkpoints", rerun.checkpoints},
                   {"branches", recording.history().branches.size()},
                   {"damaged", !rerun.damage.empty() || (!same && own)},
                   {"same", rerun.damage.empty() && same},
                   {"differences", ordered_json::array()}};
  const Model model = io::recorded_scene(recording).setup.model;
  for (const auto* list : {&rerun.damage, &rerun.differences})
    for (const io::Difference& difference : *list) out["differences"].push_back(describe(difference, model));
  return out;
}

double first_difference(const ordered_json& verify) {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& d : verify["differences"]) first = std::min(first, d["time_s"].get<double>());
  return first;
}

std::string verdict(const ordered_json& recording) {
  const ordered_json& v = recording["verify"];
  const auto checkpoints = v["checkpoints"].get<std::int64_t>();
  std::string out = fmt::format("re-run: {} of {} {} the same state {}\n",
                                counted(checkpoints, "checkpoint", "checkpoints"),
                                counted(v["branches"].get<std::int64_t>(), "branch", "branches"),
                                checkpoints == 1 ? "has" : "have", checkpoints == 1 ? "hash" : "hashes");
  if (!v["same"].get<bool>() && !v["damaged"].get<bool>())
    out += fmt::format(
        "undamaged; written by another arithmetic ({}, format {}): the re-run parts at {:.6g} s\n",
        recording["arithmetic"].get<std::string>(), recording["format"].get<int>(), first_difference(v));
  for (const auto& d : v["differences"])
    out += fmt::format("branch {} differs first at {:.6g} s (step {}): {}{}\n", d["branch"].get<int>(),
                       d["time_s"].get<double>(), d["step"].get<std::int64_t>(), d["what"].get<std::string>(),
                       d["element"].is_null()
                           ? ""
                           : fmt::format(", body {}, member {} (element {})", d["body"].get<std::string>(),
                                         d["member"].get<std::string>(), d["element"].get<int>()));
  return out;
}

std::string table(const ordered_json& d) {
  std::string out = fmt::format("{} {}: {}\n", d["kind"].get<std::string>(), d["scene"].get<std::string>(),
                                d["title"].get<std::string>());
  out += is_static(d) ? fmt::format("{} load steps", d["load_steps"].get<int>())
                      : fmt::format("duration {:g} s, ", d["duration_s"].get<double>()) +
                            (d["time_step_s"].is_null()
                                 ? "adaptive step"
                                 : fmt::format("time step {:g} s", d["time_step_s"].get<double>()));
  out += fmt::format("; {} nodes, {} elements, {} contact points\n", d["nodes"].get<int>(),
                     d["elements"].get<int>(), d["contact_points"].get<int>());
  for (const auto& b : d["bodies"]) {
    const auto &c = b["centre_of_gravity_m"], &i = b["inertia_kg_m2"];
    out += fmt::format(
        "body {}: {:.6g} kg, centre of gravity ({:.4f}, {:.4f}, {:.4f}) m, inertia ({:.4g}, {:.4g}, {:.4g}) "
        "kg m^2\n",
        b["name"].get<std::string>(), b["mass_kg"].get<double>(), c[0].get<double>(), c[1].get<double>(),
        c[2].get<double>(), i[0].get<double>(), i[1].get<double>(), i[2].get<double>());
  }
  for (const auto& a : d["anchors"])
    out += fmt::format("anchor {}: {} of {:.4g} kN/m on {}, {}{}\n", a["name"].get<std::string>(),
                       a["type"].get<std::string>(), 1e-3 * a["stiffness_N_m"].get<double>(),
                       a["body"].get<std::string>(),
                       a["strength_N"].is_null()
                           ? "never breaks"
                           : fmt::format("breaks above {:.4g} kN", 1e-3 * a["strength_N"].get<double>()),
                       a["on"].get<bool>() ? "" : ", away at the start");
  if (d["kind"] != "recording") return out;
  out += fmt::format("{}: {} frames to {}, {} checkpoints, last state {}\n", d["status"].get<std::string>(),
                     d["frames"].get<long>(),
                     is_static(d) ? fmt::format("load step {}", d["recorded_steps"].get<long>())
                                  : fmt::format("{:g} s", d["recorded_s"].get<double>()),
                     d["checkpoints"].get<long>(), d.value("last_state_hash", "-"));
  out +=
      fmt::format("format {}; arithmetic: {}\n", d["format"].get<int>(), d["arithmetic"].get<std::string>());
  if (!is_static(d) && d.contains("energy")) out += energy_in_words(d["energy"]);
  if (d["branches"].size() > 1 || !d["edits"].empty())
    out += fmt::format("{}, {}\n", counted(d["branches"].size(), "branch", "branches"),
                       counted(d["edits"].size(), "edit", "edits"));
  for (const auto& e : d["events"])
    out += (is_static(d) ? fmt::format("load step {:>4}", e["step"].get<long>())
                         : fmt::format("{:>10.4f} s", e["time_s"].get<double>())) +
           fmt::format("  {} {}{}\n", e["body"].get<std::string>(), e["kind"].get<std::string>(),
                       e.contains("anchor") ? " " + e["anchor"].get<std::string>() + " broke" : "");
  return out;
}

struct CheckOptions {
  std::vector<std::string> scenes;     ///< paths or names
  std::vector<std::string> overrides;  ///< KEY=VALUE
};
int check_command(const CheckOptions& options) {
  int code = k_done;
  for (const std::string& scene : options.scenes) {
    try {
      io::load_scene(scene, options.overrides);
      fmt::print("{}: ok\n", scene);
    } catch (const io::InputError& error) {
      say(error.what());
      code = k_bad_input;
    }
  }
  return code;
}

struct InfoOptions {
  std::string file;     ///< scene or recording
  std::string json;     ///< file, "-" or empty
  bool verify = false;  ///< run a recording again
  bool force = false;   ///< in place of files of any kind
};
int info_command(const InfoOptions& options) {
  const auto& [file, json, verified, force] = options;
  if (!json.empty() && json != "-")
    require_writable_text("--json", {json, force}, host::FileKind::json, file);
  ordered_json description;
  if (io::is_recording(file)) {
    const io::Recording recording = open_foreign_recording(file);
    description = describe(recording);
    if (verified) description["verify"] = verify(recording);
  } else {
    description = describe(io::load_scene(file));
    if (verified) throw BadInput("--verify: " + file + " is a scene; only a recording can be run again");
  }
  // Another arithmetic is no fault of the file: what can be verified of it is.
  const bool damaged = verified && description["verify"]["damaged"].get<bool>();
  if (json == "-")
    fmt::print("{}\n", json_text(description, 2));
  else if (!json.empty())
    write_whole_file({json, force}, host::FileKind::json, json_text(description, 2) + "\n");
  else
    fmt::print("{}{}", table(description), verified ? verdict(description) : "");
  return damaged ? k_failed : k_done;
}

int scenes_command() {
  for (const io::BuiltinScene& builtin : io::builtin_scenes()) {
    const std::string name(builtin.name);
    fmt::print("{:<18} {}\n", name, io::load_scene(name).title);
  }
  return k_done;
}

}  // namespace

void add_check(Commands& commands) {
  const auto [command, check] =
      commands.add("check", "validate scenes without running them",
                   "check my-office.toml --set shake.1.amplitude=\"0.2 g\"", check_command);
  command.add_option("SCENES", check.scenes, "paths or names")->required()->type_name("");
  add_set(command, check.overrides);
}

void add_info(Commands& commands) {
  const auto [command, info] = commands.add("info", "describe a scene or a recording",
                                            "info paper-a.h5 --verify --json -", info_command);
  add_path(command, "FILE", info.file, "", "scene or recording").required();
  add_json(command, info.json, "write JSON");
  add_force(command, info.force);
  command.add_flag("--verify", info.verify,
                   "run the recording again; name the first step and element that differ, and tell damage "
                   "from another arithmetic");
}

void add_scenes(Commands& commands) {
  commands.add("scenes", "list the built-in scenes", "scenes", scenes_command);
}

}  // namespace topple::app
