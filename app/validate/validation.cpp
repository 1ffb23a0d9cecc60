#include "app/validate/validation.h"

#include <fmt/format.h>

#include <filesystem>
#include <numeric>

#include "app/report/svg_chart.h"
#include "app/study/study_results.h"
#include "app/support/errors.h"
#include "app/support/files.h"
#include "app/support/interrupt.h"
#include "app/support/log.h"
#include "app/validate/validation_page.h"
#include "solver/study/common/gnuplot.h"

namespace topple::app {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

std::string call_text(const ValidationOptions& options) {
  std::string text = "topple validate " + options.kind;
  if (!options.data.empty()) text += " " + options.data;
  text += " -o " + options.folder;
  if (!options.fit.empty()) text += " --fit " + options.fit;
  return text + (options.keep_going ? " --keep-going" : "");
}

void write_page(const Validation& validation, const ValidationOptions& options, const std::string& stem,
                const Comparison& found) {
  std::string chart = study::run_gnuplot(found.chart(origin_text(), study::ChartFormat::svg));
  chart.erase(0, std::min(chart.find("<svg"), chart.size()));
  std::string body = found.page;
  if (const auto at = body.find(k_chart_here); at != std::string::npos)
    body.replace(at, std::string_view(k_chart_here).size(), "<figure>\n" + chart + "</figure>\n");
  if (!found.skipped.empty()) {
    std::string list;
    for (const std::string& line : found.skipped) list += "<li>" + escaped(line) + "</li>\n";
    body += html_section("Left out", "<ul>\n" + list + "</ul>\n");
  }
  write_whole_file({stem + ".html", options.force}, host::FileKind::html,
                   validation_page(found.title, validation.source, body, call_text(options)));
}

}  // namespace

std::optional<std::vector<std::string>> run_cases(const ValidationOptions& options, const std::string& label,
                                                  const std::string& stem, ordered_json settings, int count,
                                                  const MakeWork& make) {
  Crew crew(options.jobs);
  SweepPlan plan;
  plan.label = label;
  plan.stem = stem;
  plan.settings = std::move(settings);
  plan.order.resize(static_cast<std::size_t>(count));
  std::iota(plan.order.begin(), plan.order.end(), 0);
  plan.make = make;
  StudyOptions sweeping;
  sweeping.quiet = options.quiet, sweeping.resume = options.resume, sweeping.force = options.force;
  const std::optional<SweepEnd> end = sweep(crew, plan, sweeping);
  return end ? std::optional(end->rows) : std::nullopt;
}

int carry_out(const Validation& validation, const ValidationOptions& options) {
  const std::string stem = place_for_results(options.folder, validation.name, options.force);
  const std::string fit_file = (fs::path(options.folder) / "fit.json").string();
  require_writable_file("--output", {stem + ".html", options.force}, host::FileKind::html, "");
  const bool fits = validation.takes_fit && options.fit.empty();
  if (fits) require_writable_file("--output", {fit_file, options.force}, host::FileKind::json, "");
  defer_interrupts();
  const auto start = Clock::now();
  const std::optional<Comparison> found = validation.compare(options, stem);
  if (!found) return k_interrupted;
  for (const std::string& line : found->skipped) log_message("left out: " + line);
  ordered_json json{{"kind", validation.name}};
  json.update(found->entries);
  json["skipped"] = found->skipped;
  json["topple"] = TOPPLE_VERSION, json["schema"] = 1, json["title"] = found->title;
  json["source"] = validation.source;
  json["machine"] = machine_json();
  json["wall_s"] = seconds_since(start);
  if (found->fit) {
    ordered_json fit{{"topple", TOPPLE_VERSION}};
    fit.update(*found->fit);
    write_whole_file({fit_file, options.force}, host::FileKind::json, fit.dump(2) + "\n");
  }
  write_study({stem, options.force}, found->rows, json,
              [&](study::ChartFormat format) { return found->chart(origin_text(), format); });
  write_page(validation, options, stem, *found);
  for (const char* end : {".rows", "-fit.rows"}) fs::remove(stem + end);
  fmt::print("{}{:.1f} s; {}.csv, .json, .svg, .png, .html{}\n", found->text, seconds_since(start), stem,
             found->fit ? " and " + fit_file : "");
  return k_done;
}

}  // namespace topple::app
