#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/log.h"
#include "solver/io/scene/scene.h"

namespace topple::app {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes;     ///< paths or names
  std::vector<std::string> overrides;  ///< KEY=VALUE
};
int check_command(const CheckOptions& options) {
  int code = k_done;
  for (const std::string& scene : options.scenes) {
    try {
      const io::Scene read = io::load_scene(scene, options.overrides);
      fmt::print("{}: ok\n", scene);
      for (const Anchor& anchor : read.setup.model.anchors)
        if (!anchor.fixing.empty())
          fmt::print("{}\n", fixing_line(describe_anchor(read.setup.model, anchor)));
    } catch (const io::InputError& error) {
      log_message(error.what());
      code = k_bad_input;
    }
  }
  return code;
}

}  // namespace

void add_check(Commands& commands) {
  const auto [command, check] =
      commands.add("check", "validate scenes without running them",
                   "check my-office.toml --set shake.1.amplitude=\"0.2 g\"", check_command);
  command.add_option("SCENES", check.scenes, "paths or names")->required()->type_name("");
  add_set(command, check.overrides);
}

}  // namespace topple::app
