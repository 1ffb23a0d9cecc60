#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/batch/recorded_run.h"
#include "app/batch/summary.h"
#include "app/cli/command.h"
#include "app/support/clock.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/support/progress.h"
#include "solver/io/scene/scene.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/parallel.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

struct VerifyOptions {
  std::vector<std::string> scenes;  ///< paths or names; empty: all verification scenes
  std::string filter;               ///< empty: every row
  std::string json;                 ///< file, "-" or empty
  bool quiet = false;
  bool force = false;  ///< in place of files of any kind
};

constexpr std::size_t k_columns = 100;
constexpr int k_modes = 20;  // of each body, analysis = "modes"

bool holds(const std::string& text, const std::string& part) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

/// Leaves the rows that the filter asks for: those of a scene so named, or rows so named.
void keep_rows(const std::string& filter, io::Scene& scene) {
  if (holds(scene.name, filter) || holds(scene.title, filter)) return;
  std::erase_if(scene.expectations, [&](const auto& expected) { return !holds(expected.name, filter); });
}

std::vector<io::Scene> load_scenes(const VerifyOptions& options) {
  std::vector<std::string> names = options.scenes;
  if (names.empty())
    for (const io::BuiltinScene& scene : io::verification_scenes()) names.emplace_back(scene.name);
  std::vector<io::Scene> scenes;
  for (const std::string& name : names) {
    scenes.push_back(io::load_scene(name));
    if (scenes.back().expectations.empty()) throw BadInput(name + ": has no [[expect]] to verify");
    keep_rows(options.filter, scenes.back());
  }
  std::erase_if(scenes, [](const io::Scene& scene) { return scene.expectations.empty(); });
  if (scenes.empty())
    throw BadInput("--filter: no case has \"" + options.filter + "\" in its name (topple verify)");
  return scenes;
}

/// Expected value in `summary`; null when the run did not come to it.
ordered_json computed(const io::Expectation& expected, const ordered_json& summary, bool broke_off) {
  const ordered_json::json_pointer pointer(expected.value);
  if (!summary.contains(pointer)) {
    if (broke_off) return nullptr;
    throw io::InputError(expected.place + "the summary of this scene has no " + expected.value);
  }
  const ordered_json& found = summary[pointer];
  if (found.is_boolean()) return found.get<bool>() ? 1 : 0;
  if (!found.is_number() && !found.is_null())
    throw io::InputError(expected.place + expected.value + " of the summary is not a number");
  return found;
}

ordered_json row(const io::Scene& scene, const io::Expectation& expected, const ordered_json& summary,
                 const std::string& trouble) {
  const ordered_json value = computed(expected, summary, !trouble.empty());
  ordered_json error;
  if (!value.is_null()) error = std::abs(value.get<double>() - expected.reference) / expected.scale;
  const bool passes = trouble.empty() && !error.is_null() && error.get<double>() <= expected.tolerance;
  ordered_json out{{"scene", scene.name},
                   {"title", scene.title},
                   {"name", expected.name},
                   {"value", expected.value},
                   {"computed", value},
                   {"reference", expected.reference},
                   {"scale", expected.scale},
                   {"error", error},
                   {"tolerance", expected.tolerance},
                   {"verdict", passes ? "pass" : "miss"},
                   {"source", expected.source},
                   {"reason", expected.reason}};
  if (!trouble.empty()) out["trouble"] = trouble;
  return out;
}

ordered_json rows_of(const io::Scene& scene) {
  ordered_json summary;
  std::string trouble;
  if (scene.setup.run.analysis == Analysis::modes) {
    summary = modes_summary(scene, k_modes);
  } else {
    RecordedRun run = record(scene, "", {.quiet = true, .jobs = 1});
    summary = std::move(run.summary);
    trouble = std::move(run.trouble);
  }
  ordered_json rows = ordered_json::array();
  for (const io::Expectation& expected : scene.expectations)
    rows.push_back(row(scene, expected, summary, trouble));
  return rows;
}

/// What a scene costs, roughly: steps times elements.
double work(const io::Scene& scene) {
  const auto elements = static_cast<double>(scene.setup.model.elements.size());
  if (scene.setup.run.analysis == Analysis::modes) return elements;
  if (scene.setup.run.analysis == Analysis::statics)
    return 5. * scene.setup.run.statics.load_steps * elements;
  return scene.setup.run.duration / scene.setup.parameters.time_step * elements;
}

/// Runs the scenes on all cores, the longest first; rows come in the order of the scenes. Throws what the
/// longest of those that failed threw.
ordered_json run_all(const std::vector<io::Scene>& scenes, bool quiet) {
  const std::size_t count = scenes.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return work(scenes[a]) > work(scenes[b]); });
  std::vector<ordered_json> rows(count);
  Progress progress("verify", "scenes", static_cast<double>(count), quiet);
  study::for_each_case(
      static_cast<int>(count), study::core_count(),
      [&](int k, int) {
        const std::size_t scene = order[static_cast<std::size_t>(k)];
        rows[scene] = rows_of(scenes[scene]);
      },
      [&](int done) {
        progress.update(done);
        return !interrupted();
      });
  ordered_json all = ordered_json::array();
  for (const ordered_json& some : rows)
    for (const ordered_json& one : some) all.push_back(one);
  return all;
}

/// Text in lines of at most k_columns, the second and later ones indented by `indent`.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string out;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (column > indent && column + 1 + end - begin > k_columns) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (begin > 0) {
      out += " ";
      ++column;
    }
    out += text.substr(begin, end - begin);
    column += end - begin;
    begin = end + 1;
  }
  return out + "\n";
}

std::string number(const ordered_json& value, const char* format) {
  return value.is_null() ? "-" : fmt::format(fmt::runtime(format), value.get<double>());
}

/// The rows of one scene; what they share of source and reason stands once below them.
std::string block(const ordered_json& rows, std::size_t begin, std::size_t end) {
  std::string out =
      wrapped(rows[begin]["scene"].get<std::string>() + ": " + rows[begin]["title"].get<std::string>(), 2);
  for (std::size_t k = begin; k < end; ++k) {
    const ordered_json& r = rows[k];
    out += fmt::format("  {:<40} {:>12} {:>12} {:>9} {:>9}  {}\n", r["name"].get<std::string>(),
                       number(r["computed"], "{:.7g}"), number(r["reference"], "{:.7g}"),
                       number(r["error"], "{:.1e}"), number(r["tolerance"], "{:.1e}"),
                       r["verdict"].get<std::string>());
    if (r.contains("trouble")) out += wrapped("    " + r["trouble"].get<std::string>(), 4);
    for (const char* key : {"source", "reason"})
      if (k + 1 == end || rows[k + 1][key] != r[key])
        out += wrapped(
            (key == std::string("source") ? "    from " : "    owed: ") + r[key].get<std::string>(), 6);
  }
  return out;
}

std::string table(const ordered_json& out) {
  const ordered_json& rows = out["rows"];
  std::string text =
      fmt::format("  {:<40} {:>12} {:>12} {:>9} {:>9}\n", "", "computed", "reference", "error", "tolerance");
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin + 1;
    while (end < rows.size() && rows[end]["scene"] == rows[begin]["scene"]) ++end;
    text += block(rows, begin, end);
    begin = end;
  }
  const auto missed = out["missed"].get<std::size_t>();
  return text + fmt::format("{} rows, {} in {:.1f} s\n", rows.size(),
                            missed == 0 ? "all within tolerance" : fmt::format("{} missed", missed),
                            out["wall_s"].get<double>());
}

int verify_command(const VerifyOptions& options) {
  const std::vector<io::Scene> scenes = load_scenes(options);
  const bool to_output = options.json == "-";
  if (!options.json.empty() && !to_output)
    require_writable_text("--json", {options.json, options.force}, host::FileKind::json, "");
  defer_interrupts();
  const auto start = Clock::now();
  const ordered_json rows = run_all(scenes, options.quiet);
  if (interrupted()) {
    log_message("interrupted before every case had run");
    return k_interrupted;
  }
  const auto missed =
      std::count_if(rows.begin(), rows.end(), [](const auto& r) { return r["verdict"] == "miss"; });
  const ordered_json out{{"topple", TOPPLE_VERSION},
                         {"schema", 1},
                         {"wall_s", seconds_since(start)},
                         {"passed", rows.size() - static_cast<std::size_t>(missed)},
                         {"missed", missed},
                         {"rows", rows}};
  if (to_output) {
    fmt::print("{}\n", json_text(out, 2));
  } else {
    fmt::print("{}", table(out));
    if (!options.json.empty())
      write_whole_file({options.json, options.force}, host::FileKind::json, json_text(out, 2) + "\n");
  }
  return missed == 0 ? k_done : k_failed;
}

}  // namespace

void add_verify(Commands& commands) {
  const auto [command, verify] = commands.add("verify", "compare with theory and published numbers",
                                              "verify --filter rocking --json verify.json", verify_command);
  command.add_option("SCENES", verify.scenes, "paths or names of scenes with [[expect]]; absent: all cases")
      ->type_name("");
  add_path(command, "--filter", verify.filter, "TEXT", "cases with this in the name of scene or row");
  add_json(command, verify.json, "write the rows as JSON");
  add_force(command, verify.force);
  add_quiet(command, verify.quiet);
}

}  // namespace topple::app
