#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "solver/io/recording.h"
#include "solver/io/scene.h"

namespace topple::app {
namespace {

// Subcommands of the contract that this version does not have yet.
constexpr const char* k_later[] = {"view", "study", "verify", "modes", "compare", "report", "recover"};

void add_set(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "override a key of the scene: --set contact.alpha=\"5 kgf\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

void read_size(const std::string& text, RenderOptions& options) {
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &options.width, &options.height, &end) != 2 ||
      options.width < 64 || options.height < 64 || options.width > 8192 || options.height > 8192)
    throw BadInput("--size: " + text + " is not WIDTHxHEIGHT with 64..8192 each");
}

int dispatch(int argc, char** argv) {
  CLI::App app("Shows how furniture tips over when the floor shakes.", "topple");
  app.set_version_flag("--version", std::string("topple ") + TOPPLE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  topple scenes\n  topple run paper-a -o paper-a.h5\n  topple render paper-a --mp4 "
      "paper-a.mp4\n"
      "Exit codes: 0 done, 1 the run failed, 2 bad usage or bad input, 130 interrupted.");
  std::function<int()> action;

  RunOptions run;
  CLI::App& run_app = *app.add_subcommand("run", "step a scene to its end, record it, print a summary");
  run_app.add_option("scene", run.scene, "path or name of a built-in scene")->required();
  run_app.add_option("-o,--output", run.recording, "recording to write (HDF5)")->type_name("REC.h5");
  add_set(run_app, run.overrides);
  run_app.add_option("--json", run.json, "write the summary as JSON; - for standard output")
      ->type_name("FILE|-");
  run_app.add_flag("--quiet", run.quiet, "no progress");
  run_app.footer("Example:\n  topple run paper-a --set shake.1.amplitude=\"150 gal\" --json -");
  run_app.callback([&] { action = [&] { return run_command(run); }; });

  RenderOptions render;
  std::string size, camera = "iso";
  double at = 0, from = 0, to = 0;
  CLI::App& render_app = *app.add_subcommand("render", "draw pictures or a video of a scene or recording");
  render_app.add_option("source", render.source, "scene or recording")->required();
  auto* what = render_app.add_option_group("output", "what to write");
  what->add_option("--png", render.png, "folder for a sequence of PNG files")->type_name("DIR");
  what->add_option("--mp4", render.mp4, "video (needs ffmpeg)")->type_name("FILE");
  auto* still = what->add_option("--still", render.still, "one picture")->type_name("FILE.png");
  what->require_option(1);
  auto* at_option = render_app.add_option("--at", at, "time of the still, s")->needs(still);
  still->needs(at_option);
  render_app.add_option("--size", size, "pixels, default 1280x720")->type_name("WxH");
  render_app.add_option("--fps", render.fps, "pictures per second, default 30")->check(CLI::Range(1, 1000));
  render_app.add_option("--camera", camera, "front, side, top or iso (default)");
  auto* from_option = render_app.add_option("--from", from, "first instant, s");
  auto* to_option = render_app.add_option("--to", to, "last instant, s");
  add_set(render_app, render.overrides);
  render_app.add_flag("--quiet", render.quiet, "no progress");
  render_app.add_flag_callback(
      "--ui", [] { throw BadInput("--ui: not supported by this version"); }, "");
  render_app.footer("Example:\n  topple render paper-a --still tipping.png --at 2.3 --size 1920x1080");
  render_app.callback([&] {
    action = [&] {
      if (!size.empty()) read_size(size, render);
      const auto view = render::view_named(camera);
      if (!view) throw BadInput("--camera: " + camera + " is not one of front, side, top, iso");
      render.view = *view;
      if (*at_option) render.at = at;
      if (*from_option) render.from = from;
      if (*to_option) render.to = to;
      if (!render.mp4.empty() && (render.width % 2 || render.height % 2))
        throw BadInput("--size: a video needs an even width and height");
      return render_command(render);
    };
  });

  ExportOptions out;
  CLI::App& export_app = *app.add_subcommand("export", "data of a recording for spreadsheets");
  export_app.add_option("recording", out.recording, "recording")->required();
  export_app.add_option("--csv", out.csv, "folder for bodies.csv, nodes.csv, elements.csv and floor.csv")
      ->type_name("DIR");
  for (const char* later : {"--xdmf", "--vtk"})
    export_app.add_option_function<std::string>(
        later,
        [later](const std::string&) {
          throw BadInput(std::string(later) + ": not supported by this version");
        },
        "");
  export_app.footer("Example:\n  topple export paper-a.h5 --csv paper-a-data");
  export_app.callback([&] {
    action = [&] {
      if (out.csv.empty()) throw BadInput("export: --csv DIR is required");
      return export_command(out);
    };
  });

  std::vector<std::string> scenes, check_overrides;
  CLI::App& check_app = *app.add_subcommand("check", "validate scenes without running them");
  check_app.add_option("scenes", scenes, "paths or names")->required();
  add_set(check_app, check_overrides);
  check_app.callback([&] { action = [&] { return check_command(scenes, check_overrides); }; });

  std::string info_file, info_json;
  CLI::App& info_app = *app.add_subcommand("info", "describe a scene or a recording");
  info_app.add_option("file", info_file, "scene or recording")->required();
  info_app.add_option("--json", info_json, "write JSON; - for standard output")->type_name("FILE|-");
  info_app.add_flag_callback(
      "--verify", [] { throw BadInput("--verify: not supported by this version"); }, "");
  info_app.callback([&] { action = [&] { return info_command(info_file, info_json); }; });

  app.add_subcommand("scenes", "list the built-in scenes")->callback([&] {
    action = [] { return scenes_command(); };
  });

  if (argc > 1 &&
      std::find(std::begin(k_later), std::end(k_later), std::string(argv[1])) != std::end(k_later))
    throw BadInput(std::string(argv[1]) + ": not supported by this version");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw BadInput(std::string(error.what()) + " (topple --help)");
  }
  return action();
}

}  // namespace

int run_command_line(int argc, char** argv) {
  catch_interrupts();
  try {
    return dispatch(argc, argv);
  } catch (const BadInput& error) {
    fmt::print(stderr, "topple: {}\n", error.what());
    return k_bad_input;
  } catch (const io::InputError& error) {
    fmt::print(stderr, "topple: {}\n", error.what());
    return k_bad_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "topple: {}\n", error.what());
    return k_failed;
  }
}

}  // namespace topple::app
