#include "app/cli/modes_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "solver/frame/modes.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

// Scaled so that the greatest displacement of a node is 1 m.
ordered_json shape(const Body& body, const Mode& mode) {
  double greatest = 0;
  for (const Vec3& u : mode.displacement) greatest = std::max(greatest, u.norm());
  const double scale = greatest > 0 ? 1 / greatest : 1;
  ordered_json nodes = ordered_json::array();
  for (int i = 0; i < body.node_count; ++i)
    nodes.push_back({{"node", i},
                     {"displacement_m", vector_json(scale * mode.displacement[i])},
                     {"rotation_rad", vector_json(scale * mode.rotation[i])}});
  return nodes;
}

// A block has none: it is rigid.
std::vector<Mode> modes_of(const Model& model, int body, int count) {
  if (model.bodies[body].solid) return {};
  return natural_modes(model, body, count);
}

ordered_json describe(const Model& model, int body, int count) {
  const Body& b = model.bodies[body];
  ordered_json modes = ordered_json::array();
  for (const Mode& mode : modes_of(model, body, count))
    modes.push_back({{"mode", modes.size() + 1},
                     {"frequency_Hz", mode.frequency},
                     {"rigid", mode.rigid},
                     {"effective_mass_kg", vector_json(mode.effective_mass)},
                     {"shape", shape(b, mode)}});
  return {{"name", b.name}, {"mass_kg", b.mass}, {"modes", modes}};
}

std::string table(const ordered_json& out) {
  std::string text;
  for (const auto& body : out["bodies"]) {
    text +=
        fmt::format("{}: {:.6g} kg\n{:>6} {:>14}  {:>32}\n", body["name"].get<std::string>(),
                    body["mass_kg"].get<double>(), "mode", "frequency, Hz", "effective mass in x, y, z, kg");
    for (const auto& mode : body["modes"]) {
      const auto& mass = mode["effective_mass_kg"];
      text += fmt::format("{:>6} {:>14.6g}  {:>10.4f} {:>10.4f} {:>10.4f}{}\n", mode["mode"].get<int>(),
                          mode["frequency_Hz"].get<double>(), mass[0].get<double>(), mass[1].get<double>(),
                          mass[2].get<double>(), mode["rigid"].get<bool>() ? "  rigid" : "");
    }
  }
  return text;
}

}  // namespace

ordered_json modes_summary(const io::Scene& scene, int count) {
  ordered_json out{{"topple", TOPPLE_VERSION}, {"schema", 1}, {"scene", scene.name}};
  out["bodies"] = ordered_json::array();
  const Model& model = scene.setup.model;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    out["bodies"].push_back(describe(model, b, count));
  return out;
}

int modes_command(const ModesOptions& options) {
  const io::Scene scene = io::load_scene(options.scene, options.overrides);
  const bool to_output = options.json == "-";
  if (!options.json.empty() && !to_output)
    require_writable_text("--json", {options.json, options.force}, host::FileKind::json, options.scene);
  const ordered_json out = modes_summary(scene, options.count);
  if (to_output) {
    fmt::print("{}\n", json_text(out, 2));
    return k_done;
  }
  fmt::print("{}", table(out));
  if (!options.json.empty())
    write_whole_file({options.json, options.force}, host::FileKind::json, json_text(out, 2) + "\n");
  return k_done;
}

void add_modes(Commands& commands) {
  const auto [command, modes] = commands.add("modes", "natural frequencies and mode shapes of each body",
                                             "modes cantilever --count 5 --json modes.json", modes_command);
  add_scene(command, modes.scene);
  add_read(command, "--count", "N", whole_number(modes.count, 1, 1000),
           "modes of each body, rigid ones among them; default 10");
  add_set(command, modes.overrides);
  add_force(command, modes.force);
  add_json(command, modes.json, "write the modes as JSON");
}

}  // namespace topple::app
