#include "app/page/export_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/batch/summary.h"
#include "app/page/outcome_json.h"
#include "app/page/page_rows.h"
#include "app/page/page_template.h"
#include "app/page/page_words.h"
#include "app/page/verdict.h"
#include "app/picture/replay.h"
#include "app/report/svg_chart.h"
#include "app/support/base64.h"
#include "app/support/errors.h"
#include "app/support/terms.h"
#include "app/support/titles.h"
#include "render/gl/off_screen.h"
#include "render/output/picture.h"
#include "solver/io/document/scene_document.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_still_width = 640, k_still_height = 400;  // px

const Phrase& phrase_named(std::string_view name) {
  return std::ranges::find(page_words::k_all, name, &page_words::Named::name)->phrase;
}

struct PageRows {
  std::vector<io::FrameRow> kept;
  std::size_t stride = 1;
  std::vector<BodyEnd> ends;  ///< as far as rows tell
  std::optional<io::FrameRow> newest;
  io::FrameRow most_tilted;  ///< with the greatest tilt over critical angle
  double greatest_load = 0;  ///< factor of the greatest size, of a static run
  RunExtent extent;
};

/// What rows tell of a body: the tilt has been beyond the critical angle since, between two rows.
void observe(const io::FrameRow& row, PageRows& rows, double& greatest) {
  for (std::size_t b = 0; b < rows.ends.size(); ++b) {
    const io::BodyNumbers& body = row.body[b];
    BodyEnd& end = rows.ends[b];
    const bool has_angle = body.critical_angle > 0;
    if (const double tilt = body.tilt * k_degrees; tilt >= end.peak_tilt) {
      end.peak_tilt = tilt;
      end.critical = has_angle ? std::optional(body.critical_angle * k_degrees) : std::nullopt;
    }
    if (!has_angle || body.tilt <= body.critical_angle)
      end.overturned.reset();
    else if (!end.overturned) {
      const auto beyond = [b](const io::FrameRow& of) { return of.body[b].tilt - of.body[b].critical_angle; };
      const double now = beyond(row), before = rows.newest ? beyond(*rows.newest) : 0;
      end.overturned =
          before < 0 ? row.time - (row.time - rows.newest->time) * now / (now - before) : row.time;
    }
    if (const double share = has_angle ? body.tilt / body.critical_angle : 0; share > greatest)
      greatest = share, rows.most_tilted = row;
  }
}

std::optional<PageRows> rows_of(const io::Scene& scene, const PageRun& run,
                                const std::function<bool()>& proceed) {
  PageRows rows;
  const Model& model = scene.setup.model;
  for (int b = 0; b < model.furniture_total(); ++b)
    rows.ends.push_back({model.bodies[static_cast<std::size_t>(b)].name, {}, 0, {}});
  rows.stride = page_stride(model, run.rows);
  double greatest = 0;
  for (std::size_t i = 0; i < run.rows; ++i) {
    if (proceed && !proceed()) return std::nullopt;
    io::FrameRow row = run.row(i);
    if (!is_finite(row)) continue;
    rows.extent.add(scene.setup, scene.setup.parameters, row);
    if (rows.kept.empty()) rows.most_tilted = row;
    observe(row, rows, greatest);
    if (std::abs(row.load_factor) > std::abs(rows.greatest_load)) rows.greatest_load = row.load_factor;
    rows.newest = row;
    if (i % rows.stride == 0 || i + 1 == run.rows) rows.kept.push_back(std::move(row));
  }
  if (rows.kept.empty()) throw io::InputError("holds no instant that can be shown");
  return rows;
}

Json summary_of(const PageRun& run) {
  return run.summary.empty() ? Json::object() : Json::parse(run.summary);
}

/// From the summary where there is one: its times are those of steps.
std::vector<BodyEnd> ends_of(const Json& summary, std::vector<BodyEnd> rows) {
  if (!summary.contains("bodies")) return rows;
  for (BodyEnd& end : rows)
    for (const Json& body : summary["bodies"])
      if (body["name"] == end.name) {
        const auto number = [&](const char* key) {
          return body[key].is_number() ? std::optional(body[key].get<double>()) : std::nullopt;
        };
        end = {end.name, number("overturn_time_s"), number("peak_tilt_deg").value_or(end.peak_tilt),
               number("critical_tilt_deg")};
      }
  return rows;
}

/// Likewise.
std::vector<PlaceOutcome> hits_of(const Json& summary, const Model& model, const PageRows& rows) {
  if (!summary.contains("ways")) return rows.extent.hits;
  std::vector<PlaceOutcome> out(summary["ways"].size());
  for (std::size_t p = 0; p < out.size(); ++p)
    for (const Json& hit : summary["ways"][p]["hit_by"])
      for (int b = 0; b < model.furniture_total(); ++b)
        if (model.bodies[static_cast<std::size_t>(b)].name == hit["body"])
          out[p].hits.push_back({b, hit["time_s"].get<double>()});
  return out;
}

/// What loads that grow came to, and did.
std::string loads_in_words(const PageRows& rows, const Json& summary, Language language) {
  std::string out = say_in(language, page_words::k_greatest_load, rows.greatest_load);
  if (!summary.contains("bodies")) return out;
  for (const auto& [key, phrase] : {std::pair("hinges", &page_words::k_load_hinges),
                                    std::pair("fractures", &page_words::k_load_breaks)}) {
    int count = 0;
    for (const Json& body : summary["bodies"]) count += body.value(key, 0);
    if (count > 0) out += say_in(language, *phrase, count);
  }
  return out;
}

/// Pictures with captions of the beginning, the greatest tilt and the end. Empty where nothing can draw.
std::string stills(const io::Scene& scene, const PageRun& run, const PageRows& rows) try {
  const Bridge bridge(scene, rows.extent);
  const std::unique_ptr<render::Context> context = render::make_off_screen_context(render::Renderer::any);
  render::Picture picture(context->get_proc(), k_still_width, k_still_height);
  std::string html;
  for (const io::FrameRow* const row : {&rows.kept.front(), &rows.most_tilted, &rows.kept.back()}) {
    const render::SceneFrame frame = bridge.frame(*row, run.parameters(*row));
    const render::Camera camera = render::fit_camera(render::NamedView::iso, frame, picture.aspect());
    const std::vector<std::uint8_t> png =
        render::encode_png(picture.draw(frame, camera, {.map = {}, .overlay = false}));
    const std::string caption = escaped(fmt::format("{:.2f} s", row->time));
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        caption, base64({reinterpret_cast<const char*>(png.data()), png.size()}));
  }
  return html;
} catch (const std::runtime_error&) {
  return "";
}

/// JSON that no text within can lead out of <script>.
std::string script_json(const Json& value) {
  std::string out;
  for (const char c : json_text(value)) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

/// `values` in place of the names; what is put in is not looked through again.
std::string filled(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string out;
  while (!text.empty()) {
    std::size_t first = text.size(), length = 0;
    const std::string* value = nullptr;
    for (const auto& [name, content] : values)
      if (const std::size_t at = text.find(name); at < first)
        first = at, length = name.size(), value = &content;
    out += text.substr(0, first);
    if (value == nullptr) break;
    out += *value;
    text.remove_prefix(first + length);
  }
  return out;
}

/// Whole seconds.
std::string estimate_of(const ReplayOnly& only) {
  return fmt::format("{:.0f}", std::ceil(only.seconds));
}

Json page_data(const io::Scene& scene, const PageRows& rows, const std::vector<BodyEnd>& ends,
               const std::vector<PlaceOutcome>& hits, const ReplayOnly& only, const Json& summary,
               Language language) {
  Json files = Json::array(), loads;  // of a static run, of which no engine tells
  if (is_static(scene.setup))
    loads = {{"en", loads_in_words(rows, summary, Language::english)},
             {"ja", loads_in_words(rows, summary, Language::japanese)}};
  for (const io::SceneFile& file : scene.files)
    files.push_back({{"name", file.name}, {"base64", base64(file.bytes)}});
  return {{"name", scene.name},
          {"text", scene.text},
          {"files", files},
          {"rows", base64(pack_rows(rows.kept))},
          {"stride", rows.stride},
          {"bodies", ends_json(ends)},
          {"hits", hits_json(hits)},
          {"live", only.word.empty()},
          {"reason", only.word},
          {"estimate_s", estimate_of(only)},
          {"language", language == Language::japanese ? "ja" : "en"},
          {"loads", std::move(loads)},
          {"no_engine", say_in(language, phrase_named("no_engine"))}};
}

}  // namespace

PageRun page_run(const io::Scene& scene, const io::Recording& recording) {
  const auto replay = std::make_shared<const Replay>(recording);
  return {.rows = static_cast<std::size_t>(replay->frame_count()),
          .row = [replay](std::size_t i) { return replay->frame(static_cast<std::int64_t>(i)); },
          .parameters = [replay, &scene](const io::FrameRow& row) { return replay->parameters(scene, row); },
          .summary = recording.summary_json(),
          .edited = !recording.history().edits_on_way_to(recording.newest_branch()).empty()};
}

ReplayOnly why_replay_only(const io::Scene& scene, const PageRun& run) {
  if (is_static(scene.setup)) return {"replay_static"};
  if (run.edited) return {"replay_edits"};
  const Json summary = summary_of(run);
  if (!summary.contains("wall_s") || !summary["wall_s"].is_number()) return {};
  const double seconds = summary["wall_s"].get<double>() * k_browser_factor;
  if (seconds > k_most_live)
    return {scene.setup.parameters.want_stress ? "replay_stress" : "replay_only", seconds};
  return {};
}

std::string in_words(const ReplayOnly& only, Language language) {
  return only.word.empty() ? "" : say_in(language, phrase_named(only.word), estimate_of(only));
}

bool can_make_pages() {
  return !page_template().empty();
}

void require_pages(const std::string& option) {
  if (!can_make_pages())
    throw BadInput(option +
                   ": this program was built without emscripten (Debian package emscripten), which live "
                   "pages need");
}

std::string page_of(const io::Scene& scene, const PageRun& run, Language language,
                    const std::function<bool()>& proceed) {
  const std::optional<PageRows> rows = rows_of(scene, run, proceed);
  if (!rows) return "";
  const Json summary = summary_of(run);
  const std::vector<BodyEnd> ends = ends_of(summary, rows->ends);
  const std::vector<PlaceOutcome> hits = hits_of(summary, scene.setup.model, *rows);
  const ReplayOnly only = why_replay_only(scene, run);
  std::string title = scene.title.empty() ? scene.name : scene.title;
  if (run.edited && !title.ends_with(io::k_title_changed)) title += io::k_title_changed;
  title = title_in(language, title);
  return filled(page_template(),
                {{"@LANGUAGE@", language == Language::japanese ? "ja" : "en"},
                 {"@TITLE@", escaped(title)},
                 {"@STILLS@", stills(scene, run, *rows)},
                 {"@VERDICT@", escaped(is_static(scene.setup) ? loads_in_words(*rows, summary, language)
                                                              : verdict_in_words(ends, language))},
                 {"@ONLY@", escaped(in_words(only, language))},
                 {"@NOSCRIPT@", escaped(say_in(language, phrase_named("no_engine")))},
                 {"@VERSION@", TOPPLE_VERSION},
                 {"@DATA@", script_json(page_data(scene, *rows, ends, hits, only, summary, language))}});
}

std::string in_frame(const std::string& page, const std::string& title, int height) {
  return fmt::format(
      "<iframe title=\"{}\" style=\"width: 100%; height: {}px; border: 0\" srcdoc=\"{}\"></iframe>",
      escaped(title), height, escaped(page));
}

}  // namespace topple::app
