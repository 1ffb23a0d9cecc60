// `topple validate`: the comparisons of the table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/command.h"
#include "app/study/ranks.h"
#include "app/support/errors.h"
#include "app/validate/validation.h"

namespace topple::app {
namespace {

/// The comparison that is called; throws BadInput on options that are not its own.
const Validation& validation_of(const ValidationOptions& options) {
  const auto found = std::ranges::find(k_validations, options.kind,
                                       [](const Validation* one) { return std::string_view(one->name); });
  if (found == std::end(k_validations)) {
    std::vector<std::string_view> names;
    for (const Validation* one : k_validations) names.emplace_back(one->name);
    throw BadInput(fmt::format("\"{}\" is not validated; known: {}", options.kind, fmt::join(names, ", ")));
  }
  const Validation& validation = **found;
  if (validation.needs_data && options.data.empty())
    throw BadInput(
        fmt::format("validate {}: DATA is required, a folder with {}", validation.name, validation.source));
  if (!options.fit.empty() && !validation.takes_fit)
    throw BadInput(fmt::format("--fit: not of validate {}, which fits nothing", validation.name));
  if (options.folder.empty()) throw BadInput("--output is required (topple validate --help)");
  if (started_ranks() > 1)
    throw BadInput("mpirun: validate does not share its work among ranks; start it without");
  return validation;
}

int validate_command(const ValidationOptions& options) {
  return carry_out(validation_of(options), options);
}

}  // namespace

void add_validate(Commands& commands) {
  const auto [command, options] =
      commands.add("validate", "compares with what others measured",
                   "validate granite DATA -o granite-validation", validate_command);
  std::vector<std::string> kinds;
  for (const Validation* one : k_validations) kinds.push_back(std::string(one->name) + ": " + one->about);
  command.add_option("KIND", options.kind, fmt::format("{}", fmt::join(kinds, "; ")))
      ->required()
      ->type_name("");
  command
      .add_option("DATA", options.data,
                  "folder with the measured data, of the form in assets/guide/validation.md")
      ->type_name("");
  add_path(command, "-o,--output", options.folder, "DIR",
           "folder for KIND.csv, .json, .svg, .png and .html, and fit.json where it fits (required)");
  add_path(command, "--fit", options.fit, "FILE",
           "fit.json of an earlier call: predicts by it and fits nothing");
  command.add_flag("--keep-going", options.keep_going,
                   "names bad files and leaves them out, instead of ending");
  command.add_flag("--resume", options.resume, "go on with the runs of one that was interrupted");
  add_jobs(command, options.jobs, "runs at a time, default one per core");
  add_quiet(command, options.quiet);
  add_force(command, options.force);
}

}  // namespace topple::app
