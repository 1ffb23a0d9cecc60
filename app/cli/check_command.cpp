#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/batch/scene_warnings.h"
#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/support/errors.h"
#include "app/support/log.h"
#include "solver/io/check/scene_errors.h"

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
      const io::CheckedScene checked = io::check_whole_scene(io::find_scene(scene), options.overrides);
      for (const std::string& error : checked.errors) log_message(error);
      if (!checked.scene) {
        code = k_bad_input;
        continue;
      }
      for (const std::string& warning : scene_warnings(checked.scene->setup))
        log_message("warning: " + scene + ": " + warning);
      fmt::print("{}: ok\n", scene);
      const Model& model = checked.scene->setup.model;
      const std::vector<bool>& in_place = checked.scene->setup.parameters.anchors;
      for (std::size_t k = 0; k < model.anchors.size(); ++k)
        if (const Anchor& anchor = model.anchors[k]; !anchor.fixing.empty())
          fmt::print("{}{}\n", fixing_line(describe_anchor(model, anchor)),
                     k < in_place.size() && !in_place[k] ? ", not in place" : "");
      for (const Wedge& wedge : checked.scene->setup.wedges)
        fmt::print("{}\n", wedge_line(describe_wedge(model, wedge)));
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
      commands.add("check", "validate scenes without running them: all errors, and what will surprise",
                   "check my-office.toml --set shake.1.amplitude=\"0.2 g\"", check_command);
  command.add_option("SCENES", check.scenes, "paths or names")->required()->type_name("");
  add_set(command, check.overrides);
}

}  // namespace topple::app
