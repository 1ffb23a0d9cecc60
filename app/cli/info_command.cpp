#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/batch/ways_summary.h"
#include "app/cli/command.h"
#include "app/cli/describe.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

bool is_static(const ordered_json& description) {
  return description["analysis"] == "static";
}

std::string counted(std::int64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
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

/// What happened; that it overturned for good is in the summary.
std::string event_words(const ordered_json& e) {
  return e["kind"] == "overturn" ? "passes its critical angle" : e["kind"].get<std::string>();
}

/// What an event was of, beside its kind.
std::string event_detail(const ordered_json& e) {
  if (e.contains("anchor")) return " " + e["anchor"].get<std::string>() + " broke";
  if (!e.contains("model")) return "";
  return fmt::format(" {} ({})", e["model"].get<std::string>(), e["reason"].get<std::string>());
}

std::string info_table(const ordered_json& d) {
  std::string out = fmt::format("{} {}: {}\n", d["kind"].get<std::string>(), d["scene"].get<std::string>(),
                                d["title"].get<std::string>());
  out += is_static(d) ? fmt::format("{} load steps", d["load_steps"].get<int>())
         : d["analysis"] == "modes"
             ? "natural modes"
             : fmt::format("duration {:g} s, ", d["duration_s"].get<double>()) +
                   (d["time_step_s"].is_null()
                        ? "adaptive step"
                        : fmt::format("time step {:g} s", d["time_step_s"].get<double>()));
  out += fmt::format("; {} nodes, {} elements, {} contact points\n", d["nodes"].get<int>(),
                     d["elements"].get<int>(), d["contact_points"].get<int>());
  for (const auto& b : d["bodies"]) {
    const auto &c = b["centre_of_gravity_m"], &i = b["inertia_kg_m2"];
    out += fmt::format(
        "body {}: {:.6g} kg, centre of gravity ({:.4f}, {:.4f}, {:.4f}) m{}, inertia ({:.4g}, {:.4g}, "
        "{:.4g}) "
        "kg m^2\n",
        b["name"].get<std::string>(), b["mass_kg"].get<double>(), c[0].get<double>(), c[1].get<double>(),
        c[2].get<double>(),
        b["above_base_m"].is_null()
            ? ""
            : fmt::format(", {:.4g} m above its base", b["above_base_m"].get<double>()),
        i[0].get<double>(), i[1].get<double>(), i[2].get<double>());
  }
  for (const auto& a : d["anchors"])
    out += fmt::format("anchor {}: {} of {:.4g} kN/m on {}, {}{}\n", a["name"].get<std::string>(),
                       a[a["fixing"].is_null() ? "type" : "fixing"].get<std::string>(),
                       1e-3 * a["stiffness_N_m"].get<double>(), a["body"].get<std::string>(),
                       a["strength_N"].is_null()
                           ? "never breaks"
                           : fmt::format("breaks above {:.4g} kN", 1e-3 * a["strength_N"].get<double>()),
                       a["on"].get<bool>() ? "" : ", away at the start");
  if (d.contains("ways")) out += ways_in_words(d["ways"], d["person_m"].get<double>());
  if (d["kind"] != "recording") return out;
  const auto status = d["status"].get<std::string>();
  out +=
      fmt::format("{}: {} frames to {}, {} checkpoints, last state {}\n",
                  status == "interrupted" ? "interrupted, or still written" : status, d["frames"].get<long>(),
                  is_static(d) ? fmt::format("load step {}", d["recorded_steps"].get<long>())
                               : fmt::format("{:g} s", d["recorded_s"].get<double>()),
                  d["checkpoints"].get<long>(), d.value("last_state_hash", "-"));
  out +=
      fmt::format("format {}; arithmetic: {}\n", d["format"].get<int>(), d["arithmetic"].get<std::string>());
  if (!is_static(d) && d.contains("energy")) out += energy_in_words(d["energy"]);
  if (d["branches"].size() > 1 || !d["edits"].empty())
    out += fmt::format("{}, {}\n", counted(d["branches"].size(), "branch", "branches"),
                       counted(d["edits"].size(), "edit", "edits"));
  for (const auto& e : d["edits"])
    out += fmt::format("{:>10.4f} s  branch {}: {} = {}\n", e["time_s"].get<double>(), e["branch"].get<int>(),
                       e["key"].get<std::string>(), e["shown"].get<std::string>());
  for (const auto& e : d["events"])
    out += (is_static(d) ? fmt::format("load step {:>4}", e["step"].get<long>())
                         : fmt::format("{:>10.4f} s", e["time_s"].get<double>())) +
           fmt::format("  {} {}{}\n", e["body"].get<std::string>(), event_words(e), event_detail(e));
  return out;
}

struct InfoOptions {
  std::string file;                    ///< scene or recording
  std::string json;                    ///< file, "-" or empty
  std::vector<std::string> overrides;  ///< KEY=VALUE
  bool verify = false;                 ///< run a recording again
  bool force = false;                  ///< in place of files of any kind
};
int info_command(const InfoOptions& options) {
  const auto& [file, json, overrides, verified, force] = options;
  if (!json.empty() && json != "-")
    require_writable_text("--json", {json, force}, host::FileKind::json, file);
  ordered_json description;
  if (io::is_recording(file)) {
    if (!overrides.empty()) throw BadInput("--set: " + file + " is a recording; only a scene can be changed");
    const io::Recording recording = open_foreign_recording(file);
    description = recording_description(recording);
    if (verified) description["verify"] = verify(recording);
  } else {
    description = scene_description(io::load_scene(file, overrides));
    if (verified) throw BadInput("--verify: " + file + " is a scene; only a recording can be run again");
  }
  // Another arithmetic is no fault of the file: what can be verified of it is.
  const bool damaged = verified && description["verify"]["damaged"].get<bool>();
  if (json == "-")
    fmt::print("{}\n", json_text(description, 2));
  else if (!json.empty())
    write_whole_file({json, force}, host::FileKind::json, json_text(description, 2) + "\n");
  else
    fmt::print("{}{}", info_table(description), verified ? verdict(description) : "");
  return damaged ? k_failed : k_done;
}

}  // namespace

void add_info(Commands& commands) {
  const auto [command, info] = commands.add("info", "describe a scene or a recording",
                                            "info paper-a.h5 --verify --json -", info_command);
  add_path(command, "FILE", info.file, "", "scene or recording").required();
  add_json(command, info.json, "write JSON");
  add_set(command, info.overrides);
  add_force(command, info.force);
  command.add_flag("--verify", info.verify,
                   "run the recording again; name the first step and element that differ, and tell damage "
                   "from another arithmetic");
}

}  // namespace topple::app
