// `topple study`: the studies of the table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <tuple>

#include "app/cli/command.h"
#include "app/study/ranks.h"
#include "app/study/study.h"
#include "app/study/study_results.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "solver/io/common/units.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct StudyCall {
  std::string kind;
  StudyOptions study;
};

/// What its results say of a scene.
struct SceneHead {
  std::string name, title;
};

void write_findings(const Study& study, const host::Target& stem, const SceneHead& scene,
                    ordered_json settings, double wall_s, const Findings& found) {
  ordered_json json{{"topple", TOPPLE_VERSION}, {"schema", 1}, {"study", study.name}};
  if (study.takes_scene) json["scene"] = scene.name;
  json["title"] = found.title;
  if (study.takes_scene) json["scene_title"] = scene.title;
  json["units"] = found.units;
  json["units"]["wall_s"] = "s";
  json["machine"] = machine_json();
  settings.update(found.settings);
  json["settings"] = settings;
  json["wall_s"] = wall_s;
  json.update(found.entries);
  write_study(stem, json["rows"], json,
              [&](study::ChartFormat format) { return found.chart(origin_text(), format); });
}

int carry_out_sweep(const Study& study, const StudyOptions& options) {
  Crew crew(study.timed ? options.jobs.value_or(1) : options.jobs);
  defer_interrupts();
  if (!crew.leads()) {
    if (const auto parts = crew.receive_broadcast()) {
      const Sweep part = study.sweep(scene_from(*parts), options);
      if (part.receive) part.receive(parts->back());
      crew.serve(part.cases().make, options.quick);
    }
    return k_done;
  }
  io::Scene scene = io::load_scene(options.scene, options.overrides);
  const SceneHead head{scene.name, scene.title};
  const Sweep whole = study.sweep(std::move(scene), options);
  const std::string stem = place_for_results(options.folder, study.name, options.force);
  const auto start = Clock::now();
  const std::string prepared = whole.prepare ? whole.prepare() : "";
  SweepPlan plan = whole.cases();
  plan.label = std::string("study ") + study.name;
  plan.stem = stem;
  plan.start = start;
  if (whole.receive) plan.broadcast.push_back(prepared);
  const std::optional<SweepEnd> end = sweep(crew, plan, options);
  if (!end) return k_interrupted;
  const double wall_s = seconds_since(start);
  const Findings found = whole.gather(end->rows);
  write_findings(study, {stem, options.force}, head,
                 {{"jobs", crew.jobs()}, {"ranks", crew.ranks()}, {"quick", options.quick}}, wall_s, found);
  if (end->complete()) std::filesystem::remove(end->file);
  fmt::print("{}{} in {:.1f} s{}{}{}\n{}.csv, .json, .svg, .png\n", found.text,
             end->runs_in_words(found.each), wall_s,
             study.timed ? "" : fmt::format(", {:.3g} {}/s", (end->run - end->kept) / wall_s, end->unit),
             found.pace, end->left_in_words(options.quick, study.left_out), stem);
  return k_done;
}

int carry_out_whole(const Study& study, const StudyOptions& options) {
  io::Scene scene = study.takes_scene ? io::load_scene(options.scene, options.overrides) : io::Scene();
  const SceneHead head{scene.name, scene.title};
  const Solve solve = study.solve(std::move(scene), options);
  const std::string stem = place_for_results(options.folder, study.name, options.force);
  defer_interrupts();
  const auto start = Clock::now();
  std::optional<Progress> progress;
  const Findings found = solve([&](int done, int of) {
    if (!progress) progress.emplace(std::string("study ") + study.name, study.runs, of, options.quiet);
    progress->update(done);
    return !interrupted() && !(options.quick && seconds_since(start) > k_quick);
  });
  progress.reset();
  if (interrupted()) {
    log_message("interrupted before every case had run");
    return k_interrupted;
  }
  const double wall_s = seconds_since(start);
  write_findings(study, {stem, options.force}, head,
                 {{"jobs", options.jobs.value_or(1)}, {"quick", options.quick}}, wall_s, found);
  const std::string left = !options.quick          ? ""
                           : found.run == found.of ? ": --quick left nothing out"
                                                   : fmt::format(": --quick left out {}, {} first",
                                                                 found.of - found.run, study.left_out);
  fmt::print("{}{} of {} {} in {:.1f} s{}\n{}.csv, .json, .svg, .png\n", found.text, found.run, found.of,
             study.runs, wall_s, left, stem);
  return k_done;
}

/// "elements, penalty and precision", where `last` is " and ": the studies of which something holds.
std::string names_of(bool (*holds)(const Study& study), const char* last = ", ") {
  std::vector<std::string> names;
  for (const Study* study : k_studies)
    if (holds(*study)) names.emplace_back(study->name);
  std::ranges::sort(names);
  const std::string end = names.back();
  names.pop_back();
  return fmt::format("{}{}{}", fmt::join(names, ", "), names.empty() ? "" : last, end);
}

/// The study that is called; throws BadInput on options that are not its own.
const Study& study_of(const StudyCall& call) {
  const auto& [kind, options] = call;
  const auto found =
      std::ranges::find(k_studies, kind, [](const Study* study) { return std::string_view(study->name); });
  if (found == std::end(k_studies))
    throw BadInput("\"" + kind + "\" is not a study; known: " + names_of([](const Study&) { return true; }));
  const Study& study = **found;
  if (!study.takes_scene && !options.scene.empty())
    throw BadInput("study " + kind + ": has scenes of its own and takes none (found \"" + options.scene +
                   "\")");
  if (!study.takes_scene && !options.overrides.empty())
    throw BadInput("study " + kind + ": has no scene to --set a key of");
  if (study.takes_scene && options.scene.empty())
    throw BadInput("study " + kind + ": SCENE is required (topple study --help)");
  for (const auto& [name, given, taken] :
       {std::tuple{"--x", !options.x.empty(), study.x != nullptr},
        std::tuple{"--y", !options.y.empty(), study.y != nullptr},
        std::tuple{"--ensemble", options.ensemble.has_value(), study.takes_ensemble},
        std::tuple{"--vary", !options.vary.empty(), study.takes_ensemble},
        std::tuple{"--slide", options.slide.has_value(), study.takes_slide},
        std::tuple{"--resume", options.resume, study.sweep != nullptr}})
    if (given && !taken) throw BadInput(std::string(name) + ": not of study " + kind);
  for (const auto& [name, given] :
       {std::pair{"--spread", options.spread.has_value()}, std::pair{"--vary", !options.vary.empty()}})
    if (given && options.ensemble.value_or(study.usual_runs) == 1)
      throw BadInput(std::string(name) + " requires --ensemble");
  if (!study.sweep && started_ranks() > 1)
    throw BadInput("mpirun: study " + kind + " does not share its work among ranks; start it without mpirun");
  if (options.folder.empty()) throw BadInput("--output is required (topple study --help)");
  return study;
}

/// "amplitude (amplitude or scale of every shake, together), phase (...)".
std::string factors_in_words() {
  std::vector<std::string> words;
  for (const study::FactorTraits& one : study::factor_table())
    words.push_back(fmt::format("{} ({})", one.word, one.about));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// "30 mm", "0.03": above 0.
Reader length(std::optional<double>& value) {
  return [&value](const std::string& text) {
    const std::optional<double> plain = number_in<double>(text);
    const io::Quantity read =
        plain ? io::Quantity{plain, ""} : io::parse_quantity(text, io::Dimension::length);
    if (!read.si) return '"' + text + "\" " + read.problem;
    if (!(*read.si > 0 && *read.si <= 100)) return '"' + text + "\" is not above 0 m up to 100 m";
    value = read.si;
    return std::string();
  };
}

int study_command(const StudyCall& call) {
  const Study& study = study_of(call);
  return study.sweep ? carry_out_sweep(study, call.study) : carry_out_whole(study, call.study);
}

}  // namespace

void add_study(Commands& commands) {
  const auto [command, call] =
      commands.add("study", "a family of runs as table and charts",
                   "study overturn paper-a -o overturn-study --ensemble 64 --spread 5%", study_command);
  StudyOptions& options = call.study;
  std::vector<std::string> kinds, x, y;
  for (const Study* study : k_studies) {
    kinds.push_back(std::string(study->name) + ": " + study->about);
    if (study->x) x.emplace_back(study->x);
    if (study->y) y.emplace_back(study->y);
  }
  const std::string with_axes = names_of([](const Study& study) { return study.x != nullptr; });
  command.add_option("KIND", call.kind, fmt::format("{}", fmt::join(kinds, "; ")))->required()->type_name("");
  command
      .add_option("SCENE", options.scene,
                  "path or built-in name; none for " + names_of([](const Study& study) {
                    return !study.takes_scene;
                  }) + ", which has scenes of its own")
      ->type_name("");
  add_path(command, "-o,--output", options.folder, "DIR",
           "folder for KIND.csv, .json, .svg and .png (required)");
  add_set(command, options.overrides);
  add_path(
      command, "--x", options.x, "KEY=FROM..TO:N",
      fmt::format("{}: N values of a key (of fragility: of a measure), log or lin behind N names the spacing "
                  "(else log from a ratio of 5 on); default {}",
                  with_axes, fmt::join(x, "; ")));
  add_path(command, "--y", options.y, "KEY=FROM..TO:N",
           fmt::format("{}: the same, default {}",
                       names_of([](const Study& study) { return study.y != nullptr; }), fmt::join(y, "; ")));
  const std::string with_ensemble = names_of([](const Study& study) { return study.takes_ensemble; });
  add_read(command, "--ensemble", "N", whole_number(options.ensemble, 2, 1000000),
           with_ensemble +
               ": runs a point or level (of fragility default 400), varied at random: "
               "probabilities and a fragility curve");
  add_read(command, "--spread", "PERCENT%", share(options.spread),
           "amplitudes of all shakes evenly within 1 -+ this, default 5% without --vary");
  command
      .add_option(
          "--vary", options.vary,
          fmt::format("{}: what an ensemble varies, once each: a factor with uniform:FROM..TO, normal:SD or "
                      "lognormal:SD, or records=FILE,FILE (a folder: its files). Factors: {}",
                      with_ensemble, factors_in_words()))
      ->type_name("FACTOR=DISTRIBUTION")
      ->allow_extra_args(false);
  add_read(command, "--seed", "N", whole_number(options.seed, 0, 2147483647),
           "of what is drawn, default 1; the same seed draws the same everywhere");
  add_read(command, "--slide", "LENGTH", length(options.slide),
           names_of([](const Study& study) { return study.takes_slide; }) +
               ": sliding farther counts, such as \"30 mm\", default 50 mm");
  command.add_flag("--resume", options.resume, names_of([](const Study& study) {
                                                 return study.sweep != nullptr;
                                               }) + ": go on with the runs of one that was interrupted");
  command.add_flag("--quick", options.quick,
                   "what can be done in 40 s; " +
                       names_of([](const Study& study) { return study.sweep == nullptr; }, " and ") +
                       " finish the runs that are then under way");
  add_jobs(command, options.jobs,
           "runs at a time, of each rank under mpirun; default one per core, of " +
               names_of([](const Study& study) { return study.timed; }, " and ") +
               " 1, at which CPU times are undisturbed");
  add_quiet(command, options.quiet);
  add_force(command, options.force);
}

}  // namespace topple::app
