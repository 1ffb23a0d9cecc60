// topple furniture: the kinds that [[furniture]] knows by name.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "solver/io/scene/furniture_kind.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct FurnitureOptions {
  std::string json;
  bool force = false;
};

ordered_json kinds() {
  ordered_json list = ordered_json::array();
  for (const io::FurnitureKind& kind : io::furniture_kinds()) {
    const Vec3 size(kind.size), cg(kind.contents_cg);
    list.push_back({{"kind", kind.name},
                    {"title", kind.title},
                    {"size_m", {size.x(), size.y(), size.z()}},
                    {"mass_kg", kind.mass},
                    {"contents_kg", kind.contents_mass},
                    {"contents_cg_m", {cg.x(), cg.y(), cg.z()}},
                    {"becomes", kind.table},
                    {"source", kind.source}});
  }
  return {{"topple", TOPPLE_VERSION}, {"schema", 1}, {"kinds", list}};
}

void print_table() {
  fmt::print("{:<17} {:>18} {:>8} {:>8}  {:<8} {}\n", "kind", "size, mm", "mass, kg", "contents", "becomes",
             "what it is; source");
  for (const io::FurnitureKind& kind : io::furniture_kinds()) {
    const auto mm = [&](int axis) { return std::round(1e4 * kind.size[axis]) / 10; };
    fmt::print("{:<17} {:>18} {:>8g} {:>8g}  {:<8} {}; {}\n", kind.name,
               fmt::format("{:g} x {:g} x {:g}", mm(0), mm(1), mm(2)), kind.mass, kind.contents_mass,
               kind.table, kind.title, kind.source);
  }
}

int furniture_command(const FurnitureOptions& options) {
  if (options.json == "-") {
    fmt::print("{}\n", json_text(kinds(), 2));
    return k_done;
  }
  if (!options.json.empty())
    require_writable_text("--json", {options.json, options.force}, host::FileKind::json, "");
  print_table();
  if (!options.json.empty())
    write_whole_file({options.json, options.force}, host::FileKind::json, json_text(kinds(), 2) + "\n");
  return k_done;
}

}  // namespace

void add_furniture(Commands& commands) {
  const auto [command, furniture] =
      commands.add("furniture", "list the kinds of furniture that scenes can name, with sizes and sources",
                   "furniture --json kinds.json", furniture_command);
  add_force(command, furniture.force);
  add_json(command, furniture.json, "write the list as JSON");
}

}  // namespace topple::app
