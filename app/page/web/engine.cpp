// What the script of a live page calls: scenes, runs, rows and pictures, in a Worker and in the page alike.
// Each function that can fail answers with JSON, {"error": "one line"} where it failed. Texts that are handed
// out stay until the next call.
#include <emscripten.h>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/page/block_map.h"
#include "app/page/outcome_json.h"
#include "app/page/page_controls.h"
#include "app/page/page_rows.h"
#include "app/page/page_words.h"
#include "app/page/verdict.h"
#include "app/page/web/page_picture.h"
#include "app/picture/words.h"
#include "app/support/terms.h"
#include "solver/io/recording/observer.h"
#include "solver/state/state.h"

namespace topple::app {
namespace {

using Json = nlohmann::ordered_json;

struct Engine {
  std::vector<io::SceneFile> files;
  std::optional<io::Scene> original;  ///< as the page holds it
  std::vector<PageControl> controls;
  std::unique_ptr<io::Scene> scene;  ///< with changes
  std::unique_ptr<Run> run;
  std::optional<io::Observer> observer;
  std::vector<io::FrameRow> rows;
  std::unique_ptr<BlockMap> map;
  std::unique_ptr<PagePicture> picture;
  std::string answer;
};

Engine& engine() {
  static Engine one;
  return one;
}

const char* answer(std::string text) {
  engine().answer = std::move(text);
  return engine().answer.c_str();
}

/// What `make` makes, or its error.
template <class Make>
const char* answer_of(const Make& make) {
  try {
    return answer(make().dump(-1, ' ', false, Json::error_handler_t::replace));
  } catch (const std::exception& error) {
    return answer(Json({{"error", error.what()}}).dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

io::ReadSceneFile page_files() {
  return [](const std::string& name) {
    for (const io::SceneFile& file : engine().files)
      if (file.name == name) return file.bytes;
    throw io::InputError("the page does not hold the file " + name);
    return std::string();
  };
}

Json controls_json() {
  Json list = Json::array();
  for (const PageControl& one : engine().controls) {
    static constexpr const char* k_kinds[] = {"number", "angle", "toggle"};
    list.push_back({{"kind", k_kinds[static_cast<int>(one.kind)]},
                    {"key", one.key},
                    {"group", one.group},
                    {"heading", say(one.heading)},
                    {"label", say(one.label)},
                    {"unit", one.unit},
                    {"least", number(one.least)},
                    {"most", number(one.most)},
                    {"value", number(one.value)},
                    {"logarithmic", one.logarithmic},
                    {"follows", one.follows},
                    {"share", number(one.share)},
                    {"body", one.body}});
  }
  return list;
}

Json load(const std::string& name, const std::string& text, const Json& values) {
  Engine& e = engine();
  e.run.reset(), e.map.reset(), e.picture.reset();
  if (!e.original || e.original->text != text) {
    e.original = io::parse_scene(text, name + ".toml", {}, page_files());
    e.controls = page_controls(*e.original);
  }
  std::vector<double> numbers;
  for (const Json& one : values) numbers.push_back(one.is_number() ? one.get<double>() : NAN);
  e.scene = std::make_unique<io::Scene>(
      io::parse_scene(text, name + ".toml", changes(e.controls, numbers), page_files()));
  Json bodies = Json::array();
  for (int b = 0; b < e.scene->setup.model.furniture_total(); ++b)
    bodies.push_back(e.scene->setup.model.bodies[static_cast<std::size_t>(b)].name);
  return {{"title", e.scene->title.empty() ? e.scene->name : e.scene->title},
          {"duration", number(e.scene->setup.run.duration)},
          {"bodies", bodies},
          {"controls", controls_json()}};
}

void keep(io::Observation observation) {
  for (io::FrameRow& row : observation.frames) engine().rows.push_back(std::move(row));
}

std::string refusal() {
  const Run& run = *engine().run;
  return run.status().ok() ? "" : run.status().message(run.setup().model);
}

/// In English and Japanese: the reader may change the language later.
template <class... Of>
Json in_both(const Phrase& phrase, const Of&... of) {
  return {say_in(Language::english, phrase, of...), say_in(Language::japanese, phrase, of...)};
}

Json outcome() {
  const Run& run = *engine().run;
  const std::string trouble = refusal();
  return {{"bodies", ends_json(ends_of(run))},
          {"hits", hits_json(run.places())},
          {"hash", fmt::format("{:016x}", hash(run.state()))},
          {"trouble", trouble.empty()
                          ? Json(nullptr)
                          : in_both(page_words::k_diverged, fmt::format("{:.3g}", run.time()), trouble)}};
}

/// Steps for about `ms` of wall time.
Json advance(double ms) {
  Engine& e = engine();
  const double until = emscripten_get_now() + ms;
  while (!e.run->over() && emscripten_get_now() < until) {
    e.run->advance();
    keep(e.observer->observe(*e.run));
  }
  if (e.run->over()) keep(e.observer->last(*e.run));
  return {{"over", e.run->over()}, {"time", number(e.run->time())}};
}

Json start() {
  Engine& e = engine();
  e.rows.clear();
  e.run = std::make_unique<Run>(e.scene->setup);
  if (!e.run->status().ok()) throw io::InputError(refusal());
  e.observer.emplace();
  keep(e.observer->observe(*e.run));
  return {{"time", 0}};
}

Json map_json(int body, double ms) {
  Engine& e = engine();
  if (!e.map || e.map->body() != body) e.map = std::make_unique<BlockMap>(e.scene->setup, body);
  if (e.map->obstacle()) return {{"obstacle", in_both(*e.map->obstacle())}};
  const double until = emscripten_get_now() + ms;
  while (!e.map->complete() && emscripten_get_now() < until) e.map->add_point();
  return {{"columns", BlockMap::k_columns},
          {"rows", BlockMap::k_rows},
          {"frequency", BlockMap::k_frequency},
          {"amplitude", BlockMap::k_amplitude},
          {"points", e.map->points()},
          {"complete", e.map->complete()},
          {"here", {e.map->shake().frequency, e.map->shake().amplitude / k_gal}}};
}

/// Of each body its tilt as share of its critical angle; of the floor its acceleration, and up to which it is
/// shown, gal.
Json curves(const std::vector<io::FrameRow>& rows, const io::Scene& scene) {
  Json times = Json::array(), floor = Json::array(), bodies = Json::array();
  const std::vector<Shake>& shakes = scene.setup.parameters.shakes;
  for (int b = 0; b < scene.setup.model.furniture_total(); ++b) bodies.push_back(Json::array());
  for (const io::FrameRow& row : rows) {
    times.push_back(number(row.time));
    floor.push_back(number(floor_along(row, shakes) / k_gal));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const io::BodyNumbers& body = row.body[b];
      bodies[b].push_back(body.critical_angle > 0 ? number(body.tilt / body.critical_angle) : Json(nullptr));
    }
  }
  return {{"times", times},
          {"floor", floor},
          {"floor_scale", floor_scale(rows, shakes) / k_gal},
          {"bodies", bodies}};
}

}  // namespace
}  // namespace topple::app

extern "C" {

using namespace topple;       // NOLINT: what follows is called from the script alone
using namespace topple::app;  // NOLINT

EMSCRIPTEN_KEEPALIVE void page_language(int japanese) {
  window_language() = japanese ? Language::japanese : Language::english;
}

EMSCRIPTEN_KEEPALIVE const char* page_words_json() {
  return answer_of([] {
    Json all;
    for (const page_words::Named& one : page_words::k_all) {
      const bool english = window_language() == Language::english;
      all[std::string(one.name)] = english ? one.phrase.english : one.phrase.japanese;
    }
    return all;
  });
}

EMSCRIPTEN_KEEPALIVE void page_file(const char* name, const char* bytes, int size) {
  engine().files.push_back({name, std::string(bytes, static_cast<std::size_t>(size))});
}

/// The scene with `values` of its controls, a list as JSON.
EMSCRIPTEN_KEEPALIVE const char* page_load(const char* name, const char* text, const char* values) {
  return answer_of([&] { return load(name, text, Json::parse(values)); });
}

EMSCRIPTEN_KEEPALIVE const char* page_start() {
  return answer_of([] { return start(); });
}

EMSCRIPTEN_KEEPALIVE const char* page_advance(double ms) {
  return answer_of([&] { return advance(ms); });
}

EMSCRIPTEN_KEEPALIVE const char* page_outcome() {
  return answer_of([] { return outcome(); });
}

/// The rows of the run as bytes, of page_packed_size().
EMSCRIPTEN_KEEPALIVE const char* page_pack() {
  const std::vector<io::FrameRow>& rows = engine().rows;
  const std::size_t stride = page_stride(engine().scene->setup.model, rows.size());
  std::vector<io::FrameRow> kept;
  for (std::size_t i = 0; i < rows.size(); i += stride) kept.push_back(rows[i]);
  if ((rows.size() - 1) % stride != 0) kept.push_back(rows.back());
  return answer(pack_rows(kept));
}

EMSCRIPTEN_KEEPALIVE int page_packed_size() {
  return static_cast<int>(engine().answer.size());
}

/// Of a piece of furniture of the scene that was loaded last; more of it for about `ms` of wall time.
EMSCRIPTEN_KEEPALIVE const char* page_map(int body, double ms) {
  return answer_of([&] { return map_json(body, ms); });
}

/// Who falls, from a list of bodies as in page_outcome().
EMSCRIPTEN_KEEPALIVE const char* page_verdict(const char* bodies) {
  return answer_of([&] {
    return Json({{"words", verdict_in_words(ends_from(Json::parse(bodies)), window_language())}});
  });
}

/// Rows to be shown from now on, of the scene that was loaded last, and who is hit, a list as in
/// page_outcome().
EMSCRIPTEN_KEEPALIVE const char* page_show(const char* bytes, int size, const char* hits) {
  return answer_of([&] {
    Engine& e = engine();
    std::vector<io::FrameRow> rows =
        unpack_rows(e.scene->setup.model, {bytes, static_cast<std::size_t>(size)});
    if (rows.empty()) throw io::InputError(say(window_words::k_no_instants));
    Json found = curves(rows, *e.scene);
    e.picture = std::make_unique<PagePicture>(
        *e.scene, std::move(rows), hits_from(Json::parse(hits), e.scene->setup.room.places.size()));
    return found;
  });
}

/// What is happening at `time`, in words, and the legend of the colours.
EMSCRIPTEN_KEEPALIVE const char* page_at(double time, int colour) {
  return answer_of([&] {
    const render::SceneFrame& frame = engine().picture->at(time, colour);
    const render::Legend& legend = frame.legend;
    return Json({{"lines", frame.caption.lines},
                 {"most_lines", frame.caption.most_lines},
                 {"note", frame.caption.note},
                 {"quantity", legend.quantity},
                 {"unit", legend.unit},
                 {"minimum", number(legend.minimum)},
                 {"maximum", number(legend.maximum)},
                 {"signed", legend.is_signed},
                 {"square_root", legend.square_root},
                 {"mark", legend.mark_label.empty() ? Json(nullptr) : number(legend.mark)},
                 {"mark_label", legend.mark_label},
                 {"range", legend.range_policy},
                 {"notes", legend.notes}});
  });
}

/// Draws the instant of page_at() to the canvas of this selector.
EMSCRIPTEN_KEEPALIVE const char* page_draw(const char* canvas, int width, int height, int dark, int fine) {
  return answer_of([&] {
    draw_picture(*engine().picture, canvas, width, height, dark != 0,
                 fine != 0 ? render::Quality::still : render::Quality::interactive);
    return Json::object();
  });
}

/// Colours of a map, 256 of red, green and blue.
EMSCRIPTEN_KEEPALIVE const unsigned char* page_colour_map(int is_signed, int dark) {
  return render::colour_table(map_of(is_signed != 0, dark != 0)).front().data();
}

EMSCRIPTEN_KEEPALIVE const char* page_colours() {
  return answer_of([] {
    Json list = Json::array();
    for (const BeamQuantityTraits& of : beam_quantities()) list.push_back(say(of.name));
    return list;
  });
}

EMSCRIPTEN_KEEPALIVE void page_view(int view, double aspect) {
  if (engine().picture) look_from(*engine().picture, view, aspect);
}
EMSCRIPTEN_KEEPALIVE void page_rotate(double dx, double dy) {
  orbit().rotate(static_cast<float>(dx), static_cast<float>(dy));
}
EMSCRIPTEN_KEEPALIVE void page_pan(double dx, double dy, double height) {
  orbit().pan(static_cast<float>(dx), static_cast<float>(dy), static_cast<float>(height));
}
EMSCRIPTEN_KEEPALIVE void page_zoom(double factor, double x, double y, double width, double height) {
  orbit().zoom(static_cast<float>(factor), static_cast<float>(x), static_cast<float>(y),
               static_cast<float>(width), static_cast<float>(height));
}

}  // extern "C"
