#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/support/errors.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

int scenes_command() {
  for (const io::BuiltinScene& builtin : io::builtin_scenes()) {
    const std::string name(builtin.name);
    fmt::print("{:<18} {}\n", name, io::load_scene(name).title);
  }
  return k_done;
}

}  // namespace

void add_scenes(Commands& commands) {
  commands.add("scenes", "list the built-in scenes", "scenes", scenes_command);
}

}  // namespace topple::app
