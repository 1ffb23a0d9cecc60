#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/batch/recorded_run.h"
#include "app/batch/summary.h"
#include "app/batch/ways_summary.h"
#include "app/cli/command.h"
#include "app/picture/ghost_video.h"
#include "app/picture/replay.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/foreign_recording.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/terms.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/edit/scene_difference.h"
#include "solver/io/edit/scene_save.h"
#include "solver/io/recording/recording.h"
#include "solver/io/recording/rerun.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct CompareOptions {
  std::string a, b;                ///< scenes or recordings
  std::string json;                ///< file, "-" or empty
  std::string mp4;                 ///< ghost video; empty: none
  std::optional<double> from, to;  ///< s, of it
  bool quiet = false;
  bool force = false;  ///< in place of files of any kind
};

constexpr std::size_t k_narrowest = 10, k_widest = 64;  // letters of a column

/// A scene that was run, or a recording.
struct Side {
  std::string source;
  io::Scene scene;
  io::Scene started;     ///< with edits made before the first step, which it began with
  ordered_json summary;  ///< null: of a recording whose run was interrupted
  int exit_code = k_done;
  std::vector<LoggedEdit> edits;  ///< while it ran
  ordered_json branch;            ///< of a recording that has several: the newest, which is compared
  std::unique_ptr<TemporaryFile> temporary;
  std::unique_ptr<io::Recording> recording;  ///< of a scene only when pictures are wanted
};

/// Takes edits made before the first step into what the run started with, where a scene can say it; keeps the
/// others.
void take_edits(Side& side, const History& history, std::int32_t branch) {
  const auto is_later = [](const LoggedEdit& edit) { return edit.step > 0; };
  side.started = side.scene;
  side.edits = history.edits_on_way_to(branch);
  if (std::ranges::all_of(side.edits, is_later)) return;
  try {
    const io::SavedScene saved =
        io::edited_scene(side.scene, parameters_at(side.scene.setup, history, branch, 0));
    side.started = io::parse_scene(saved.text, side.scene.name, {}, io::files_of(side.scene));
    std::erase_if(side.edits, [&](const LoggedEdit& edit) {
      return !is_later(edit) && traits(edit.edit.key).of != Edit::Of::node &&
             std::ranges::find(saved.given_up, io::edit_key(edit.edit)) == saved.given_up.end();
    });
  } catch (const io::InputError&) {  // they are told as made while it ran
  }
}

/// Reads a recording, or a scene without running it.
Side open_side(const std::string& source) {
  Side side;
  side.source = source;
  if (!io::is_recording(source)) {
    side.started = side.scene = io::load_scene(source);
    return side;
  }
  side.recording = std::make_unique<io::Recording>(open_foreign_recording(source));
  side.scene = io::recorded_scene(*side.recording);
  io::check_edits(side.recording->history(), side.scene.setup);
  const History& history = side.recording->history();
  take_edits(side, history, side.recording->newest_branch());
  if (history.branches.size() > 1) side.branch = side.recording->newest_branch();
  if (!side.recording->summary_json().empty())
    side.summary = ordered_json::parse(side.recording->summary_json());
  return side;
}

void check(const CompareOptions& options, const Side& a, const Side& b) {
  for (const Side* side : {&a, &b}) {
    if (side->scene.setup.run.analysis == Analysis::modes)
      throw BadInput(side->source + ": has run.analysis = \"modes\", which has no motion to compare");
    if (!options.mp4.empty() && is_static(side->scene.setup))
      throw BadInput("--mp4: " + side->source + " is static, and the video has a clock");
    if (side->recording && side->recording->frame_count() == 0)
      throw BadInput(side->source + ": holds no frames");
  }
  if (is_static(a.scene.setup) != is_static(b.scene.setup))
    throw BadInput("one of " + a.source + " and " + b.source + " is static, the other is not");
  const std::string sources[] = {a.source, b.source};
  for (const std::string& source : sources) {
    if (!options.json.empty() && options.json != "-")
      require_writable_text("--json", {options.json, options.force}, host::FileKind::json, source);
    if (!options.mp4.empty())
      require_writable_file("--mp4", {options.mp4, options.force}, host::FileKind::mp4, source);
  }
  if (options.from && options.to && *options.from > *options.to)
    throw BadInput(fmt::format("--from: {:g} s is after --to, {:g} s", *options.from, *options.to));
  if (!options.mp4.empty() && same_file(options.json, options.mp4))
    throw BadInput("--json: " + options.json + " is the video; choose another name");
}

/// Runs a scene; false when Ctrl+C came.
bool run_side(Side& side, bool pictures, bool quiet) {
  if (side.recording) {
    if (side.summary.is_null())
      log_message("warning: " + side.source + ": its run was interrupted, so it has no outcome");
    return true;
  }
  if (pictures) side.temporary = std::make_unique<TemporaryFile>();
  RecordedRun run = record(side.scene, pictures ? side.temporary->path() : "", {.quiet = quiet});
  side.summary = std::move(run.summary);
  side.exit_code = run.exit_code;
  if (!run.trouble.empty()) log_message(run.trouble);
  if (run.recorded) side.recording = std::make_unique<io::Recording>(side.temporary->path());
  return run.exit_code != k_interrupted;
}

std::string in_words(const LoggedEdit& edit, const Model& model) {
  return fmt::format("{} = {} from {:.3f} s on", io::scene_key(edit.edit, model),
                     io::edit_value_text(edit.edit, io::EditSpelling::shown), edit.time);
}

ordered_json parameters(const Side& a, const Side& b) {
  ordered_json list = ordered_json::array();
  const auto text = [](const std::optional<std::string>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
  };
  for (const io::SceneDifference& d : io::differences(a.started, b.started))
    list.push_back({{"key", d.key}, {"a", text(d.a)}, {"b", text(d.b)}});
  for (std::size_t k = 0; k < std::max(a.edits.size(), b.edits.size()); ++k) {
    const auto edit = [k](const Side& side) {
      return k < side.edits.size() ? ordered_json(in_words(side.edits[k], side.scene.setup.model))
                                   : ordered_json(nullptr);
    };
    list.push_back({{"key", fmt::format("edit {} while it ran", k + 1)}, {"a", edit(a)}, {"b", edit(b)}});
  }
  return list;
}

/// Of a body in a summary; null: it is not there.
ordered_json outcome(const Side& side, const std::string& name) {
  if (side.summary.is_null()) return nullptr;
  for (const ordered_json& body : side.summary["bodies"]) {
    if (body["name"] != name) continue;
    ordered_json out;
    for (const char* key :
         {"overturned", "overturn_time_s", "peak_tilt_deg", "final_tilt_deg", "peak_slide_m", "final_slide_m",
          "first_uplift_s", "first_impact_s", "peak_stress_Pa", "hinges", "fractures"})
      out[key] = body[key];
    return out;
  }
  return nullptr;
}

ordered_json outcomes(const Side& a, const Side& b) {
  std::vector<std::string> names;
  for (const Side* side : {&a, &b})
    for (int body = 0; body < side->scene.setup.model.furniture_total(); ++body)
      if (const std::string& name = side->scene.setup.model.bodies[static_cast<std::size_t>(body)].name;
          std::ranges::find(names, name) == names.end())
        names.push_back(name);
  ordered_json list = ordered_json::array();
  for (const std::string& name : names)
    list.push_back({{"name", name}, {"a", outcome(a, name)}, {"b", outcome(b, name)}});
  return list;
}

/// The entries of a list of the summaries that have `key`, by its value: [{name, a, b}], null: it is not
/// there.
ordered_json paired(const Side& a, const Side& b, const char* list, const char* key) {
  ordered_json out = ordered_json::array();
  for (const bool of_b : {false, true}) {
    const ordered_json& summary = (of_b ? b : a).summary;
    if (summary.is_null() || !summary.contains(list)) continue;
    for (const ordered_json& entry : summary[list]) {
      const auto same = [&](const ordered_json& one) { return one["name"] == entry[key]; };
      const auto found = std::ranges::find_if(out, same);
      if (found != out.end())
        (*found)["b"] = entry;
      else
        out.push_back({{"name", entry[key]},
                       {"a", of_b ? ordered_json(nullptr) : entry},
                       {"b", of_b ? entry : ordered_json(nullptr)}});
    }
  }
  return out;
}

/// Of those of a static run that have an equilibrium; null: none has, or it is not one.
ordered_json greatest_load(const Side& side) {
  ordered_json greatest = nullptr;
  if (side.summary.is_null() || !side.summary.contains("static")) return greatest;
  for (const ordered_json& step : side.summary["static"])
    if (step["converged"].get<bool>() && (greatest.is_null() || step["factor"] > greatest))
      greatest = step["factor"];
  return greatest;
}

ordered_json side_json(const Side& side) {
  return {{"source", side.source},
          {"branch", side.branch},
          {"scene", side.scene.name},
          {"title", side.scene.title},
          {"status", side.summary.is_null() ? ordered_json("interrupted") : side.summary["status"]},
          {"counted_from_s", side.summary.is_null() ? 0. : side.summary.value("counted_from_s", 0.)},
          {"simulated_s", side.summary.is_null() ? ordered_json(nullptr) : side.summary["simulated_s"]},
          {"greatest_load_factor", greatest_load(side)}};
}

/// A table of three columns.
class Table {
 public:
  void row(const std::string& name, const std::string& a, const std::string& b) {
    rows_.push_back({name, a, b});
  }
  std::string text() const {
    std::size_t width[3] = {k_narrowest, k_narrowest, 0};
    for (const auto& row : rows_)
      for (int c = 0; c < 2; ++c) width[c] = std::max(width[c], std::min(letters(row[c]), k_widest));
    std::string out;
    for (const auto& row : rows_) {
      for (int c = 0; c < 2; ++c)
        out += row[c] + std::string(std::max(width[c], letters(row[c])) - letters(row[c]) + 2, ' ');
      out += row[2] + "\n";
    }
    return out;
  }

 private:
  std::vector<std::array<std::string, 3>> rows_;
};

std::string text(const ordered_json& body, const char* key, double unit, int decimals) {
  if (body.is_null() || body[key].is_null()) return "-";
  return fmt::format("{:.{}f}", body[key].get<double>() / unit, decimals);
}

std::string load_factor(const ordered_json& factor) {
  return factor.is_null() ? "-" : fmt::format("{:.6g}", factor.get<double>());
}

void add_outcome(Table& table, const ordered_json& body) {
  const std::string name = body["name"];
  const ordered_json &a = body["a"], &b = body["b"];
  const auto row = [&](const char* what, const auto& value) {
    table.row(name + ": " + what, value(a), value(b));
  };
  row("overturns at, s", [](const ordered_json& o) {
    return o.is_null()                   ? "-"
           : o["overturned"].get<bool>() ? text(o, "overturn_time_s", 1, 4)
                                         : std::string("no");
  });
  const auto number = [&](const char* what, const char* key, double unit, int decimals) {
    row(what, [&](const ordered_json& o) { return text(o, key, unit, decimals); });
  };
  number("peak tilt, deg", "peak_tilt_deg", 1, 3);
  number("base moved, mm", "peak_slide_m", 1e-3, 2);
  number("first uplift, s", "first_uplift_s", 1, 3);
  number("first impact, s", "first_impact_s", 1, 3);
  number("peak stress, MPa", "peak_stress_Pa", 1e6, 2);
  const auto any = [](const ordered_json& o, const char* key) { return !o.is_null() && o[key] != 0; };
  for (const char* key : {"hinges", "fractures"})
    if (any(a, key) || any(b, key)) number(key, key, 1, 0);
}

std::string holds(const ordered_json& anchor) {
  if (anchor.is_null()) return "-";
  if (was_never_in_place(anchor)) return "not in place";
  const std::string peak = text(anchor, "peak_force_N", 1, 1);
  if (anchor["broke"].get<bool>()) return peak + ", broke at " + text(anchor, "break_time_s", 1, 3) + " s";
  if (anchor["strength_N"].is_null() || anchor["peak_force_N"].is_null()) return peak;
  return peak + ", " + percent_of(anchor["peak_force_N"].get<double>(), anchor["strength_N"].get<double>()) +
         " of its strength";
}

std::string leads_out(const ordered_json& way) {
  if (way.is_null() || way["open"].is_null()) return "-";
  return (way["open"].get<bool>() ? "open, " : "closed, ") + text(way, "widest_m", 1, 2) + " m";
}

std::string hit_by(const ordered_json& way) {
  const std::string hits = way.is_null() ? "-" : hits_in_words(way);
  return hits.empty() ? "nothing" : hits;
}

std::string tables(const ordered_json& result) {
  const auto called = [](const char* letter, const ordered_json& side) {
    return fmt::format("{}: {}{}", letter, side["source"].get<std::string>(),
                       side["branch"].is_null() ? "" : fmt::format(", branch {}", side["branch"].get<int>()));
  };
  const std::string a = called("A", result["a"]), b = called("B", result["b"]);
  Table parameters, outcomes;
  parameters.row("parameter", a, b);
  const auto value = [](const ordered_json& v) {
    return v.is_null() ? std::string("-") : v.get<std::string>();
  };
  for (const ordered_json& p : result["parameters"]) parameters.row(p["key"], value(p["a"]), value(p["b"]));
  outcomes.row("outcome", a, b);
  outcomes.row("status", result["a"]["status"], result["b"]["status"]);
  if (result["a"]["simulated_s"] != result["b"]["simulated_s"])
    outcomes.row("simulated, s", text(result["a"], "simulated_s", 1, 3),
                 text(result["b"], "simulated_s", 1, 3));
  if (result["a"]["counted_from_s"] != result["b"]["counted_from_s"])
    outcomes.row("peaks, times and anchors counted from, s", text(result["a"], "counted_from_s", 1, 3),
                 text(result["b"], "counted_from_s", 1, 3));
  if (const char* const key = "greatest_load_factor";
      result["a"][key] != nullptr || result["b"][key] != nullptr)
    outcomes.row("greatest load factor", load_factor(result["a"][key]), load_factor(result["b"][key]));
  for (const ordered_json& body : result["bodies"]) add_outcome(outcomes, body);
  for (const ordered_json& one : result["anchors"])
    outcomes.row(fmt::format("{} on {}: greatest force, N", one["name"].get<std::string>(),
                             one[one["a"].is_null() ? "b" : "a"]["body"].get<std::string>()),
                 holds(one["a"]), holds(one["b"]));
  for (const ordered_json& one : result["ways"]) {
    const std::string place = one["name"];
    outcomes.row("way out from " + place, leads_out(one["a"]), leads_out(one["b"]));
    outcomes.row(place + ": hit by", hit_by(one["a"]), hit_by(one["b"]));
  }
  return (result["parameters"].empty() ? "no parameter differs\n" : parameters.text()) + "\n" +
         outcomes.text();
}

int compare_command(const CompareOptions& options) {
  Side a = open_side(options.a), b = open_side(options.b);
  check(options, a, b);
  defer_interrupts();
  const bool pictures = !options.mp4.empty();
  if (!run_side(a, pictures, options.quiet) || !run_side(b, pictures, options.quiet)) return k_interrupted;
  int code = std::max(a.exit_code, b.exit_code);
  const ordered_json result{{"topple", TOPPLE_VERSION},
                            {"schema", 1},
                            {"a", side_json(a)},
                            {"b", side_json(b)},
                            {"parameters", parameters(a, b)},
                            {"bodies", outcomes(a, b)},
                            {"anchors", paired(a, b, "anchors", "name")},
                            {"ways", paired(a, b, "ways", "place")}};
  if (pictures && a.recording && b.recording) {
    const Replay of_a(*a.recording), of_b(*b.recording);
    const int drawn = draw_ghost_video({options.mp4, options.force}, {a.source, a.scene, of_a},
                                       {b.source, b.scene, of_b}, options.from, options.to, options.quiet);
    if (drawn != k_done) return drawn;
  }
  if (options.json == "-") {
    fmt::print("{}\n", json_text(result, 2));
    return code;
  }
  fmt::print("{}", tables(result));
  if (pictures && code == k_done) fmt::print("\nvideo: {}\n", options.mp4);
  if (!options.json.empty())
    write_whole_file({options.json, options.force}, host::FileKind::json, json_text(result, 2) + "\n");
  return code;
}

}  // namespace

void add_compare(Commands& commands) {
  const auto [command, compare] =
      commands.add("compare", "what two scenes or recordings say and do differently",
                   "compare weak.h5 strong.h5 --mp4 both.mp4", compare_command);
  add_path(command, "A", compare.a, "", "scene or recording").required();
  add_path(command, "B", compare.b, "", "scene or recording").required();
  add_json(command, compare.json, "write the differences as JSON");
  add_force(command, compare.force);
  CLI::Option& video = add_path(command, "--mp4", compare.mp4, "FILE.mp4",
                                "video of both on one clock, A solid, B translucent (needs ffmpeg)");
  add_read(command, "--from", "SECONDS", seconds(compare.from), "first instant of it").needs(&video);
  add_read(command, "--to", "SECONDS", seconds(compare.to), "last instant of it").needs(&video);
  add_quiet(command, compare.quiet);
}

}  // namespace topple::app
