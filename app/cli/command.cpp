#include "app/cli/command.h"

#include <cctype>
#include <cmath>

namespace topple::app {
namespace {

constexpr int k_most_jobs = 256;
constexpr std::string_view k_endings[] = {".png",  ".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff",
                                          ".webp", ".svg", ".ppm",  ".mp4", ".avi", ".mov", ".mkv",
                                          ".webm", ".wmv", ".mpeg", ".mpg", ".pdf", ".ps",  ".eps",
                                          ".html", ".glb", ".gltf", ".obj"};

std::string not_empty(const std::string& text) {
  return text.empty() ? "is empty" : "";
}

/// ".png" of "FILE.png"; empty: it has none.
std::string_view ending_of(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == name.npos ? "" : name.substr(dot);
}

/// Refuses names that end as another kind than `ending`, which is written.
std::function<std::string(const std::string&)> not_of_another_kind(std::string_view ending) {
  return [ending](const std::string& name) {
    std::string own(ending_of(name));
    std::ranges::transform(own, own.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool other = own != ending && std::ranges::find(k_endings, own) != std::end(k_endings);
    return other ? fmt::format("\"{}\" ends in {}, but what is written is {}", name, own, ending) : "";
  };
}

}  // namespace

CLI::App& Commands::add(const char* name, const char* about, const char* example,
                        std::function<int()> carry_out) {
  CLI::App& command = *app.add_subcommand(name, about);
  command.footer(std::string("Example:\n  topple ") + example);
  command.callback([this, carry_out = std::move(carry_out)] { action = carry_out; });
  return command;
}

CLI::Option& add_path(CLI::App& command, const char* names, std::string& value, const char* type,
                      const std::string& about) {
  CLI::Option& option =
      *command.add_option(names, value, about)->type_name(type)->check(not_empty, "", "not empty");
  if (const std::string_view ending = ending_of(type); !ending.empty())
    option.check(not_of_another_kind(ending), "", "ending");
  return option;
}

CLI::Option& add_scene(CLI::App& command, std::string& value) {
  return *add_path(command, "SCENE", value, "", "path or name of a built-in scene").required();
}

void add_set(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "override a key of the scene, --set contact.alpha=\"5 kgf\", or a whole entry, "
                  "--set shake.1='{ type = \"record\", files = [\"my.csv\"] }'")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

void add_json(CLI::App& command, std::string& value, const std::string& about) {
  add_path(command, "--json", value, "FILE|-", about + "; - for standard output");
}

void add_force(CLI::App& command, bool& value) {
  command.add_flag("--force", value, "write in place of files of another kind, too");
}

void add_quiet(CLI::App& command, bool& value) {
  command.add_flag("--quiet", value, "no progress");
}

CLI::Option& add_read(CLI::App& command, const char* name, const char* type, Reader read,
                      const std::string& about) {
  return *command
              .add_option_function<std::string>(
                  name, [](const std::string&) {}, about)
              ->type_name(type)
              ->check(std::move(read), "", "read");
}

Reader share(std::optional<double>& value) {
  return [&value](const std::string& text) -> std::string {
    const bool percent = text.ends_with('%');
    const auto number = number_in<double>(std::string_view(text).substr(0, text.size() - (percent ? 1 : 0)));
    const double found = number.value_or(0) / (percent ? 100 : 1);
    if (!(found > 0 && found < 1)) return "\"" + text + "\" is not between 0% and 100%";
    value = found;
    return "";
  };
}

Reader seconds(std::optional<double>& value) {
  return [&value](const std::string& text) -> std::string {
    value = number_in<double>(text);
    return value && std::isfinite(*value) ? "" : "\"" + text + "\" is not a number of seconds";
  };
}

CLI::Option& add_jobs(CLI::App& command, std::optional<int>& value, const std::string& about) {
  return add_read(command, "--jobs", "N", whole_number(value, 1, k_most_jobs), about);
}

}  // namespace topple::app
