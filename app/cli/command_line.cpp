#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <new>
#include <string_view>

#include "app/cli/compare_command.h"
#include "app/cli/describe_commands.h"
#include "app/cli/export_command.h"
#include "app/cli/misuse.h"
#include "app/cli/modes_command.h"
#include "app/cli/option_values.h"
#include "app/cli/recover_command.h"
#include "app/cli/render_command.h"
#include "app/cli/report_command.h"
#include "app/cli/run_command.h"
#include "app/cli/study_commands.h"
#include "app/cli/verify_command.h"
#include "app/cli/view_command.h"
#include "app/study/ranks.h"
#include "app/support/errors.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "solver/io/scene/scene.h"
#include "solver/math/processor.h"

namespace topple::app {
namespace {

struct Study {
  std::string_view kind;
  int (*run)(const StudyOptions&);
  bool takes_scene = true;
  bool sweeps = false;    ///< --resume, ranks
  bool has_axes = false;  ///< --x, --y
  bool varies = false;    ///< --ensemble
};
constexpr Study k_studies[] = {{"elements", elements_command, false},
                               {"overturn", overturn_command, true, true, true, true},
                               {"penalty", penalty_command},
                               {"precision", precision_command, true, true},
                               {"stability", stability_command, true, true, true}};

constexpr int k_most_jobs = 256;

/// The command line of one call.
class CommandLine {
 public:
  CommandLine() : app_("Shows how furniture tips over when the floor shakes.", "topple") {
    app_.set_version_flag("--version",
                          std::string("topple ") + TOPPLE_VERSION + "\nsolver for " + instruction_set());
    app_.require_subcommand(1);
    app_.footer(
        "Examples:\n  topple scenes\n  topple run paper-a -o paper-a.h5\n  topple render paper-a --mp4 "
        "paper-a.mp4\n"
        "Exit codes: 0 done, 1 the run failed, 2 bad usage or bad input, 130 interrupted.");
    add_run();
    add_view();
    add_render();
    add_export();
    add_modes();
    add_verify();
    add_study();
    add_compare();
    add_report();
    add_check();
    add_info();
    add_recover();
    add_scenes();
  }

  int carry_out(int argc, char** argv) {
    refuse_unknown_command(app_, argc, argv);
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& success) {
      return app_.exit(success);
    } catch (const CLI::ParseError& error) {
      throw BadInput(misuse(app_, error) + " (topple " + chosen() + "--help)");
    }
    return action_();
  }

  const CLI::App& table() const { return app_; }

 private:
  CLI::App& add_command(const char* name, const char* about, const char* example) {
    CLI::App& command = *app_.add_subcommand(name, about);
    command.footer(std::string("Example:\n  topple ") + example);
    return command;
  }
  static CLI::Option& add_path(CLI::App& command, const char* names, std::string& value, const char* type,
                               const char* about) {
    CLI::Option& option =
        *command.add_option(names, value, about)->type_name(type)->check(not_empty, "", "not empty");
    if (const std::string_view ending = ending_of(type); !ending.empty())
      option.check(not_of_another_kind(ending), "", "ending");
    return option;
  }
  static void add_set(CLI::App& command, std::vector<std::string>& overrides) {
    command.add_option("--set", overrides, "override a key of the scene: --set contact.alpha=\"5 kgf\"")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->take_all();
  }

  void add_run() {
    CLI::App& command = add_command("run", "step a scene to its end, record it, print a summary",
                                    "run paper-a --set shake.1.amplitude=\"150 gal\" --json -");
    add_path(command, "SCENE", run_.scene, "", "path or name of a built-in scene").required();
    add_path(command, "-o,--output", run_.recording, "REC.h5",
             "recording to write (HDF5), in place of an older one");
    add_set(command, run_.overrides);
    add_path(command, "--json", run_.json, "FILE|-", "write the summary as JSON; - for standard output");
    command.add_flag("--quiet", run_.quiet, "no progress");
    CLI::Option* const jobs =
        command.add_option("--jobs", jobs_, "threads for bodies that are apart, default as many as pay")
            ->type_name("N")
            ->check(whole_number_in(1, k_most_jobs), "", "count");
    command.add_flag("--profile", run_.profile, "tell where the time of steps goes, on one thread")
        ->excludes(jobs);
    command.add_flag(
        "--estimate", run_.estimate,
        "run it again at half the step (or a tenth of the tolerance) for the error, at three times "
        "the cost");
    command.callback([this] {
      run_.jobs = number_in<int>(jobs_);
      action_ = [this] { return run_command(run_); };
    });
  }

  void add_view() {
    CLI::App& command = add_command("view", "watch a scene in a window, shake it, rewind it; or a recording",
                                    "view paper-a --set contact.alpha=\"500 kgf\"");
    add_path(command, "SOURCE", view_.source, "", "scene or recording; without: choose");
    add_path(command, "-o,--output", view_.recording, "REC.h5",
             "recording to write, in place of an older one; default a new one in the state folder");
    add_set(command, view_.overrides);
    command.add_option("--lang", language_, "en or ja, default as last chosen, or that of the locale")
        ->type_name("LANGUAGE");
    command.callback([this] {
      if (!language_.empty()) view_.language = language_named(language_);
      action_ = [this] { return view_command(view_); };
    });
  }

  void add_render() {
    CLI::App& command = add_command("render", "draw pictures or a video of a scene or recording",
                                    "render paper-a --still tipping.png --at 2.3 --size 1920x1080");
    add_path(command, "SOURCE", render_.source, "", "scene or recording").required();
    auto* what = command.add_option_group("output", "what to write");
    add_path(*what, "--png", render_.png, "DIR", "folder for a sequence of PNG files");
    add_path(*what, "--mp4", render_.mp4, "FILE.mp4", "video (needs ffmpeg)");
    CLI::Option* still = &add_path(*what, "--still", render_.still, "FILE.png", "one picture");
    what->require_option(1);
    const auto add_time = [&](const char* name, double& value, const char* about) {
      return command.add_option(name, value, about)->type_name("SECONDS")->check(seconds, "", "seconds");
    };
    CLI::Option* at =
        add_time("--at", at_, "time of the still; statics: part of the way, 0..1")->needs(still);
    still->needs(at);
    CLI::Option* from = add_time("--from", from_, "first instant");
    CLI::Option* to = add_time("--to", to_, "last instant");
    command.add_option("--size", size_, "pixels, default 1280x720")->type_name("WxH");
    command.add_option("--fps", render_.fps, "pictures per second, default 30")
        ->type_name("RATE")
        ->check(whole_number_in(1, 1000), "", "rate");
    command
        .add_option("--camera", camera_,
                    "front, side, top, iso (default) or follow: iso, going along with the body of --inspect "
                    "or the first; "
                    "or AZIMUTH,ELEVATION,DISTANCE,X,Y,Z: of the eye from the point looked at, in degrees "
                    "and m; each "
                    "may end in ,follow or ,follow:BODY")
        ->type_name("NAME");
    add_set(command, render_.overrides);
    command.add_flag("--quiet", render_.quiet, "no progress");
    command.add_flag("--ui", render_.ui, "with the panels of the window around the scene");
    command.add_option("--lang", language_, "en (default) or ja")->type_name("LANGUAGE");
    command
        .add_option("--renderer", renderer_, "osmesa or egl, default osmesa, or egl where that is missing")
        ->type_name("NAME");
    add_picture(command);
    command.callback([this, at, from, to] {
      read_size(size_, !render_.mp4.empty(), render_);
      read_camera(camera_, render_);
      read_picture(picture_, render_.picture);
      render_.picture.alone = !render_.still.empty();
      if (!renderer_.empty()) render_.renderer = renderer_named(renderer_);
      if (!language_.empty()) render_.language = language_named(language_);
      if (*at) render_.at = at_;
      if (*from) render_.from = from_;
      if (*to) render_.to = to_;
      action_ = [this] { return render_command(render_); };
    });
  }

  void add_picture(CLI::App& command) {
    command
        .add_option("--colour", picture_.colour,
                    "stress (default), yield-ratio, axial, moment, torsion or displacement: what beams are "
                    "coloured by")
        ->type_name("QUANTITY");
    command.add_option("--map", picture_.map, "viridis (default) or cividis: colours of what has no sign")
        ->type_name("NAME");
    command
        .add_option("--range", picture_.range,
                    "run (default), instant, or the greatest value in the legend's unit: where colours end")
        ->type_name("RANGE");
    command
        .add_option("--exaggerate", picture_.exaggerate, "deformation drawn so many times as large, 1 to 200")
        ->type_name("FACTOR");
    command.add_flag("--forces", render_.picture.contact_forces,
                     "arrows of what floors, walls and other bodies do to bodies");
    command.add_flag("--no-panels", picture_.no_panels, "without the sheets of cabinets");
    command
        .add_option("--trails", picture_.trails,
                    "second or run: paths of centres of gravity and tops of bodies since then")
        ->type_name("SPAN");
    add_path(command, "--inspect", render_.inspect, "BODY[/MEMBER]",
             "look closely at a body or member: forces along the member; all values with --ui");
  }

  void add_export() {
    CLI::App& command =
        add_command("export", "data of a recording for spreadsheets and ParaView",
                    "export paper-a.h5 --csv paper-a-data\n  topple export paper-a.h5 --xdmf paper-a.xdmf");
    add_path(command, "RECORDING", export_.recording, "", "recording").required();
    auto* what = command.add_option_group("output", "what to write");
    add_path(*what, "--csv", export_.csv, "DIR",
             "folder for bodies.csv, nodes.csv, elements.csv, floor.csv, energy.csv, anchors.csv");
    add_path(*what, "--xdmf", export_.xdmf, "FILE.xdmf",
             "for ParaView 5.11 and later; the data go to FILE.xdmf.h5");
    add_path(*what, "--vtk", export_.vtk, "DIR",
             "folder for frames.pvd and a .vtp file a frame, for what reads VTK's own format");
    what->require_option(1);
    command.callback([this] { action_ = [this] { return export_command(export_); }; });
  }

  void add_modes() {
    CLI::App& command = add_command("modes", "natural frequencies and mode shapes of each body",
                                    "modes cantilever --count 5 --json modes.json");
    add_path(command, "SCENE", modes_.scene, "", "path or name of a built-in scene").required();
    command.add_option("--count", count_, "modes of each body, rigid ones among them; default 10")
        ->type_name("N")
        ->check(whole_number_in(1, 1000), "", "count");
    add_set(command, modes_.overrides);
    add_path(command, "--json", modes_.json, "FILE|-", "write the modes as JSON; - for standard output");
    command.callback([this] {
      modes_.count = number_in<int>(count_).value_or(modes_.count);
      action_ = [this] { return modes_command(modes_); };
    });
  }

  void add_verify() {
    CLI::App& command = add_command("verify", "compare with theory and published numbers",
                                    "verify --filter rocking --json verify.json");
    command
        .add_option("SCENES", verify_.scenes, "paths or names of scenes with [[expect]]; absent: all cases")
        ->type_name("");
    add_path(command, "--filter", verify_.filter, "TEXT", "cases with this in the name of scene or row");
    add_path(command, "--json", verify_.json, "FILE|-", "write the rows as JSON; - for standard output");
    command.add_flag("--quiet", verify_.quiet, "no progress");
    command.callback([this] { action_ = [this] { return verify_command(verify_); }; });
  }

  void add_study() {
    CLI::App& command = add_command("study", "a family of runs as table and charts",
                                    "study overturn paper-a -o overturn-study --ensemble 64 --spread 5%");
    command
        .add_option("KIND", kind_,
                    "overturn: what overturns over two keys of a scene, such as frequency and amplitude; "
                    "stability: where each time integration fails over two keys, such as step and alpha; "
                    "precision: error against CPU time of a scene's integrators, steps and models; "
                    "elements: error of the three schemes against elements and CPU time; penalty: what the "
                    "contact law of a scene does, and the alpha to take")
        ->required()
        ->type_name("");
    command
        .add_option("SCENE", study_.scene,
                    "path or built-in name; none for elements, which has scenes of its own")
        ->type_name("");
    add_path(command, "-o,--output", study_.folder, "DIR",
             "folder for KIND.csv, .json, .svg and .png (required)");
    add_set(command, study_.overrides);
    add_path(command, "--x", study_.x, "KEY=FROM..TO:N",
             "overturn, stability: N values of a key, log or lin behind N names the spacing (else log from a "
             "ratio of 5 on); default frequency or duration of the first shake; the step");
    add_path(command, "--y", study_.y, "KEY=FROM..TO:N",
             "overturn, stability: the same, default its amplitude; contact.alpha");
    CLI::Option* const ensemble =
        command
            .add_option("--ensemble", ensemble_,
                        "overturn: runs a point, with amplitudes varied at random: probabilities and a "
                        "fragility curve")
            ->type_name("N")
            ->check(whole_number_in(2, 10000), "", "count");
    command.add_option("--spread", spread_, "of the amplitudes, default 5%")
        ->type_name("PERCENT%")
        ->check(share, "", "share")
        ->needs(ensemble);
    command.add_flag("--resume", study_.resume,
                     "overturn, precision, stability: go on with the runs of one that was interrupted");
    command.add_flag(
        "--quick", study_.quick,
        "what can be done in 40 s; elements and penalty finish the runs that are then under way");
    command
        .add_option("--jobs", jobs_,
                    "runs at a time, of each rank under mpirun; default one per core, of elements, "
                    "penalty and precision 1, at which CPU times are undisturbed")
        ->type_name("N")
        ->check(whole_number_in(1, k_most_jobs), "", "count");
    command.add_flag("--quiet", study_.quiet, "no progress");
    command.callback([this] {
      check_study();
      study_.jobs = number_in<int>(jobs_);
      study_.ensemble = number_in<int>(ensemble_).value_or(1);
      study_.spread = ensemble_.empty() ? 0 : share_in(spread_).value();
      action_ = [this] { return study_called(kind_)->run(study_); };
    });
  }

  /// Null: there is none.
  static const Study* study_called(std::string_view kind) {
    const Study* const found = std::ranges::find(k_studies, kind, &Study::kind);
    return found == std::end(k_studies) ? nullptr : found;
  }

  void check_study() const {
    const Study* const study = study_called(kind_);
    if (!study) {
      std::string known;
      for (const Study& each : k_studies) known += (known.empty() ? "" : ", ") + std::string(each.kind);
      throw BadInput("\"" + kind_ + "\" is not a study; known: " + known);
    }
    if (!study->takes_scene && !study_.scene.empty())
      throw BadInput("study " + kind_ + ": has scenes of its own and takes none (found \"" + study_.scene +
                     "\")");
    if (!study->takes_scene && !study_.overrides.empty())
      throw BadInput("study " + kind_ + ": has no scene to --set a key of");
    if (study->takes_scene && study_.scene.empty())
      throw BadInput("study " + kind_ + ": SCENE is required (topple study --help)");
    for (const auto& [name, given, taken] : {std::tuple{"--x", !study_.x.empty(), study->has_axes},
                                             std::tuple{"--y", !study_.y.empty(), study->has_axes},
                                             std::tuple{"--ensemble", !ensemble_.empty(), study->varies},
                                             std::tuple{"--resume", study_.resume, study->sweeps}})
      if (given && !taken) throw BadInput(std::string(name) + ": not of study " + kind_);
    if (!study->sweeps && started_ranks() > 1)
      throw BadInput("mpirun: study " + kind_ +
                     " does not share its work among ranks; start it without mpirun");
    if (study_.folder.empty()) throw BadInput("--output is required (topple study --help)");
  }

  void add_compare() {
    CLI::App& command = add_command("compare", "what two scenes or recordings say and do differently",
                                    "compare weak.h5 strong.h5 --mp4 both.mp4");
    add_path(command, "A", compare_.a, "", "scene or recording").required();
    add_path(command, "B", compare_.b, "", "scene or recording").required();
    add_path(command, "--json", compare_.json, "FILE|-",
             "write the differences as JSON; - for standard output");
    add_path(command, "--mp4", compare_.mp4, "FILE.mp4",
             "video of both on one clock, A solid, B translucent (needs ffmpeg)");
    command.add_flag("--quiet", compare_.quiet, "no progress");
    command.callback([this] { action_ = [this] { return compare_command(compare_); }; });
  }

  void add_report() {
    CLI::App& command =
        add_command("report", "one page for an engineer: what falls, when, how certain that is",
                    "report paper-a -o paper-a.html --lang ja");
    add_path(command, "SCENE", report_.scene, "", "path or name of a built-in scene").required();
    add_path(command, "-o,--output", report_.file, "FILE.html", "page to write, default SCENE-report.html");
    command.add_option("--lang", report_.language, "en (default) or ja")->type_name("LANGUAGE");
    add_set(command, report_.overrides);
    command.add_option("--jobs", jobs_, "runs at a time, default one per core")
        ->type_name("N")
        ->check(whole_number_in(1, k_most_jobs), "", "count");
    command.add_flag("--quiet", report_.quiet, "no progress");
    command.callback([this] {
      language_named(report_.language);
      report_.jobs = number_in<int>(jobs_);
      action_ = [this] { return report_command(report_); };
    });
  }

  void add_check() {
    CLI::App& command = add_command("check", "validate scenes without running them",
                                    "check my-office.toml --set shake.1.amplitude=\"0.2 g\"");
    command.add_option("SCENES", scenes_, "paths or names")->required()->type_name("");
    add_set(command, check_overrides_);
    command.callback([this] { action_ = [this] { return check_command(scenes_, check_overrides_); }; });
  }

  void add_info() {
    CLI::App& command =
        add_command("info", "describe a scene or a recording", "info paper-a.h5 --verify --json -");
    add_path(command, "FILE", info_.file, "", "scene or recording").required();
    add_path(command, "--json", info_.json, "FILE|-", "write JSON; - for standard output");
    command.add_flag("--verify", info_.verify,
                     "run the recording again; name the first step and element that differ, and tell damage "
                     "from another arithmetic");
    command.callback([this] { action_ = [this] { return info_command(info_); }; });
  }

  void add_recover() {
    CLI::App& command = add_command("recover", "repair a recording whose writer was killed",
                                    "recover paper-a.h5 -o repaired.h5");
    add_path(command, "RECORDING", recover_.recording, "", "recording; it stays as it is").required();
    add_path(command, "-o,--output", recover_.output, "REC.h5",
             "closed copy of what can be read, in place of an older one; default NAME.recovered.h5");
    command.callback([this] { action_ = [this] { return recover_command(recover_); }; });
  }

  void add_scenes() {
    add_command("scenes", "list the built-in scenes", "scenes").callback([this] {
      action_ = [] { return scenes_command(); };
    });
  }

  std::string chosen() const {
    const auto commands = app_.get_subcommands();
    return commands.empty() ? "" : commands.front()->get_name() + " ";
  }

  CLI::App app_;
  std::function<int()> action_;
  RunOptions run_;
  RenderOptions render_;
  ViewOptions view_;
  std::string size_ = "1280x720", camera_ = "iso";
  PictureWords picture_;
  std::string language_, renderer_;
  double at_ = 0, from_ = 0, to_ = 0;
  ExportOptions export_;
  RecoverOptions recover_;
  std::vector<std::string> scenes_, check_overrides_;
  InfoOptions info_;
  ModesOptions modes_;
  VerifyOptions verify_;
  StudyOptions study_;
  CompareOptions compare_;
  ReportOptions report_;
  std::string kind_, jobs_, ensemble_, spread_ = "5%";
  std::string count_;
};

/// What went to standard output may still wait to be written, to a full disk for instance.
void flush_results() {
  if (std::fflush(stdout) != 0)
    throw std::runtime_error(std::string("standard output: cannot be written: ") + std::strerror(errno));
}

}  // namespace

void read_commands(const std::function<void(const CLI::App&)>& read) {
  read(CommandLine().table());
}

int run_command_line(int argc, char** argv) {
  if (argc == 3 && argv[1] == k_read_apart) return read_apart(argv[2]);
  catch_interrupts();
  try {
    const int code = CommandLine().carry_out(argc, argv);
    flush_results();
    return code;
  } catch (const BadInput& error) {
    if (started_rank() == 0) say(error.what());
    return k_bad_input;
  } catch (const io::InputError& error) {
    say(error.what());
    return k_bad_input;
  } catch (const std::bad_alloc&) {
    say("there is not enough memory for this");
    return k_failed;
  } catch (const std::exception& error) {
    say(error.what());
    return k_failed;
  }
}

}  // namespace topple::app
