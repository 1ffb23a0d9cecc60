#include "solver/study/overturn/overturn_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/document/scene_document.h"
#include "solver/io/edit/edit_text.h"
#include "solver/io/scene/scene_file.h"
#include "solver/study/common/measure.h"
#include "solver/study/common/rows.h"

namespace topple::study {
namespace {

using io::InputError;
using nlohmann::ordered_json;

constexpr UsualAxes k_usual_axes[] = {
    {Shake::Kind::sine, "shake.1.frequency=0.2 Hz..5 Hz:24", "shake.1.amplitude=50 gal..1000 gal:24"},
    {Shake::Kind::pulse, "shake.1.duration=0.1 s..2 s:24", "shake.1.amplitude=100 gal..3000 gal:24"},
};

Axis axis_named(const std::string& option, const std::string& text, const char* UsualAxes::*usual,
                const io::Scene& scene) {
  const UsualAxes* const axes = usual_axes(scene.setup.parameters.shakes);
  if (text.empty() && !axes)
    throw InputError(option + " KEY=FROM..TO:N is required: the first shake is neither a sine nor a pulse");
  return axis_of(option, text.empty() ? axes->*usual : text, scene);
}

/// Before anything shakes. `edit`: of the key; value: SI.
void set_at_once(const Model& model, double value, Edit edit, Parameters& parameters) {
  edit.value = edited_value(parameters, edit.key, edit.index);
  edit.value.x() = value;
  apply(edit, model, 0, parameters);
}

}  // namespace

const UsualAxes* usual_axes(const std::vector<Shake>& shakes) {
  for (const UsualAxes& axes : k_usual_axes)
    if (!shakes.empty() && axes.kind == shakes.front().kind) return &axes;
  return nullptr;
}

FactorPlan plan_factors(const Ensemble& ensemble, const io::Scene& scene) {
  if (ensemble.runs == 1) return {};
  std::vector<std::string> texts = ensemble.vary;
  if (ensemble.spread > 0) {
    if (scene.setup.parameters.shakes.empty())
      throw InputError("--ensemble: " + scene.name + " has no shake, whose amplitude would be varied");
    if (std::ranges::any_of(texts, [](const std::string& text) { return text.starts_with("amplitude="); }))
      throw InputError("--spread: --vary varies the amplitude already");
    texts.insert(texts.begin(),
                 fmt::format("amplitude=uniform:{}..{}", 1 - ensemble.spread, 1 + ensemble.spread));
  }
  FactorPlan plan = plan_factors(texts, scene);
  plan.seed = ensemble.seed;
  return plan;
}

OverturnPlan plan_overturn(io::Scene scene, const std::string& x, const std::string& y,
                           const Ensemble& ensemble) {
  if (scene.setup.run.analysis != Analysis::dynamic)
    throw InputError("study overturn: " + scene.name + " is not dynamic; nothing overturns in it");
  if (scene.setup.model.furniture_total() == 0)
    throw InputError("study overturn: " + scene.name + " has no body that could overturn");
  OverturnPlan plan{.scene = {}, .x = {}, .y = {}, .ensemble = ensemble.runs};
  plan.factors = plan_factors(ensemble, scene);
  plan.scenes = scenes_of(plan.factors, scene);
  plan.scene = with_files_of(plan.scenes);
  plan.x = axis_named("--x", x, &UsualAxes::x, plan.scene);
  plan.y = axis_named("--y", y, &UsualAxes::y, plan.scene);
  check_axes(plan.scene, plan.x, plan.y);
  plan.set = overturn_settings(plan.scene);
  constexpr double k_most_runs = 1e7;  // rows are kept in memory
  if (static_cast<double>(plan.points()) * plan.ensemble > k_most_runs)
    throw InputError(fmt::format("--ensemble: {} points of {} runs are more than {:g} runs", plan.points(),
                                 plan.ensemble, k_most_runs));
  if (plan.ensemble > 1 && why_not_planar(plan).empty()) plan.chunk = std::min(plan.ensemble, k_planar_chunk);
  return plan;
}

ordered_json settings_of(const OverturnPlan& plan) {
  ordered_json settings = settings_of("overturn", plan.scene, plan.x, plan.y);
  settings["ensemble"] = plan.ensemble;
  settings["chunk"] = plan.chunk;
  settings["ways"] = plan.scene.setup.room.ways();
  settings.update(settings_of(plan.factors));
  return settings;
}

std::vector<int> case_order(const OverturnPlan& plan) {
  const std::vector<int> points = coarse_to_fine(plan.x.count(), plan.y.count());
  std::vector<int> order;
  for (int from = 0, to = 1; from < plan.chunks(); from = to, to *= 4)
    for (const int point : points)
      for (int chunk = from; chunk < std::min(to, plan.chunks()); ++chunk)
        order.push_back(point * plan.chunks() + chunk);
  return order;
}

namespace {

std::string run_text(const RunEnd& end) {
  std::string fell;
  bool lifted = false;
  for (const BodyEnd& fate : end.of_bodies) {
    fell += (fell.empty() ? "" : ",") + (fate.fell ? fmt::format("{}", *fate.fell) : "null");
    lifted |= fate.lifted;
  }
  std::string open;
  for (const bool way : end.open) open += (open.empty() ? "" : ",") + std::string(way ? "true" : "false");
  const std::string status =
      ordered_json(end.status).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return fmt::format("{{\"status\":{},\"fell\":[{}],\"lifted\":{},\"open\":[{}]{}}}", status, fell, lifted,
                     open, end.planar ? ",\"planar\":true" : "");
}

std::string row_text(const std::vector<RunEnd>& ends, double cpu) {
  std::string runs;
  for (const RunEnd& end : ends) runs += (runs.empty() ? "" : ",") + run_text(end);
  return fmt::format("{{\"cpu_s\":{},\"runs\":[{}]}}", cpu, runs);
}

io::Scene read_scene(const OverturnPlan& plan, const io::Scene& scene, std::vector<std::string> changes) {
  changes.insert(changes.begin(), plan.set.begin(), plan.set.end());
  return io::parse_scene(scene.text, scene.name, changes, io::kept_files(scene));
}

}  // namespace

io::Scene scene_of_runs(const OverturnPlan& plan) {
  return read_scene(plan, plan.scene, {});
}

std::optional<std::vector<Shake>> edited_shakes(const OverturnPlan& plan, const Setup& own, double x,
                                                double y) {
  Parameters parameters = own.parameters;
  for (const auto& [axis, value] : {std::pair(&plan.x, x), std::pair(&plan.y, y)}) {
    std::optional<Edit> edit = io::parse_edit_key(axis->key);
    if (axis->table != "shake" || !edit || !traits(edit->key).exists(own.model, parameters, edit->index))
      return std::nullopt;
    set_at_once(own.model, value, *edit, parameters);
  }
  for (std::size_t k = 0; k < parameters.shakes.size(); ++k)
    if (parameters.shakes[k].start != own.parameters.shakes[k].start) return std::nullopt;
  return parameters.shakes;
}

std::string why_not_planar(const OverturnPlan& plan) {
  std::string why;
  planar_cases(scene_of_runs(plan).setup, &why);
  return why;
}

OverturnRunner::OverturnRunner(const OverturnPlan& plan) : plan_(&plan) {
  for (const io::Scene& scene : plan.scenes) places_.push_back({.of = &scene});
}

void OverturnRunner::read(Place& place) const {
  place.scene.reset();
  place.trouble.clear();
  const int nx = plan_->x.count();
  try {
    place.scene =
        read_scene(*plan_, *place.of, {plan_->x.change(place.point % nx), plan_->y.change(place.point / nx)});
  } catch (const InputError& error) {
    place.trouble = error.what();
  }
}

void OverturnRunner::begin(Place& place, int point) const {
  const bool first = place.point < 0;
  const int nx = plan_->x.count();
  place.point = point;
  place.scene.reset();
  place.trouble.clear();
  place.planar.clear();
  if (first) {
    place.own = read_scene(*plan_, *place.of, {}).setup;
    if (planar_cases(*place.own).empty()) place.own.reset();
  }
  if (place.own)
    if (std::optional<std::vector<Shake>> shakes =
            edited_shakes(*plan_, *place.own, plan_->x.in_si(point % nx), plan_->y.in_si(point / nx))) {
      place.own->parameters.shakes = place.shakes = std::move(*shakes);
      place.duration = place.own->run.duration;
      place.planar = planar_cases(*place.own);
      if (!place.planar.empty()) return;
    }
  read(place);
  if (!place.scene) return;
  place.shakes = place.scene->setup.parameters.shakes;
  place.duration = place.scene->setup.run.duration;
  place.planar = planar_cases(place.scene->setup);
}

const io::Scene& OverturnRunner::scene_at(Place& place) const {
  if (!place.scene && place.trouble.empty()) read(place);
  if (!place.scene) throw InputError(place.trouble);
  return *place.scene;
}

std::string OverturnRunner::run(int k, const std::function<bool()>& give_up) {
  const int point = k / plan_->chunks(), begin_at = k % plan_->chunks() * plan_->chunk,
            end_at = std::min(plan_->ensemble, begin_at + plan_->chunk);
  const int records = static_cast<int>(places_.size());
  std::vector<RunEnd> ends;
  const double cpu = cpu_time_of(
      [&] {
        for (int member = begin_at; member < end_at; ++member)
          if (Place& place = places_[static_cast<std::size_t>(member % records)]; place.point != point)
            begin(place, point);
        std::vector<RunStart> starts;
        for (Place& place : places_)
          starts.push_back({place.planar, place.shakes, place.duration,
                            [&]() -> const io::Scene& { return scene_at(place); }});
        std::vector<VariedMember> members;
        for (int member = begin_at; member < end_at; ++member) {
          const int record = member % records;
          const auto stream = static_cast<std::uint64_t>(point) * static_cast<std::uint64_t>(records) +
                              static_cast<std::uint64_t>(record);
          members.push_back({&starts[static_cast<std::size_t>(record)],
                             plan_->factors.draw(stream, static_cast<std::uint32_t>(member / records))});
        }
        ends = run_varied(members, plan_->factors, give_up);
      },
      0);
  return ends.back().gave_up ? "" : row_text(ends, cpu);
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::not_computed:
      return "not computed";
    case Verdict::failed:
      return "failed";
    case Verdict::all:
      return "all overturn";
    case Verdict::some:
      return "some overturn";
    case Verdict::rocks:
      return "rocks";
    case Verdict::stands:
      return "stands";
  }
  return "";
}

std::optional<double> OverturnPoint::probability() const {
  return runs > 0 ? std::optional(static_cast<double>(overturned) / runs) : std::nullopt;
}

std::optional<Interval> OverturnPoint::interval() const {
  return runs > 0 ? std::optional(wilson(overturned, runs)) : std::nullopt;
}

std::optional<double> OverturnPoint::time(double part) const {
  if (times.empty()) return std::nullopt;
  const double at = part * static_cast<double>(times.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, times.size() - 1);
  return std::lerp(times[below], times[above], at - static_cast<double>(below));
}

namespace {

bool is_intensity(const Axis& axis) {
  return axis.table == "shake" && (axis.name == "amplitude" || axis.name == "scale") &&
         axis.values.front() > 0;
}

/// Place of the value nearest to the scene's.
int own_place(const Axis& axis) {
  if (!axis.own) return axis.count() / 2;
  const auto distance = [&](double value) {
    return axis.logarithmic ? std::abs(std::log(value / *axis.own)) : std::abs(value - *axis.own);
  };
  const auto nearest =
      std::ranges::min_element(axis.values, [&](double a, double b) { return distance(a) < distance(b); });
  return static_cast<int>(nearest - axis.values.begin());
}

/// Adds one run; counts[verdict].
void add_run(OverturnPoint& point, const ordered_json& row, int counts[]) {
  const std::string status = row["status"].get<std::string>();
  if (status != "completed") {
    if (point.failed++ == 0) point.status = status;
    return;
  }
  if (point.failed == 0) point.status = status;
  ++point.runs;
  std::optional<double> first;
  int fallen = 0;
  point.fell.resize(row["fell"].size());
  for (std::size_t b = 0; b < row["fell"].size(); ++b) {
    if (row["fell"][b].is_null()) continue;
    const double time = row["fell"][b].get<double>();
    first = std::min(first.value_or(time), time);
    ++point.fell[b];
    ++fallen;
  }
  for (std::size_t p = 0; p < point.open.size(); ++p) point.open[p] += row["open"][p].get<bool>();
  if (first) {
    ++point.overturned;
    point.times.push_back(*first);
  }
  const Verdict verdict = fallen == static_cast<int>(row["fell"].size()) ? Verdict::all
                          : fallen > 0                                   ? Verdict::some
                          : row["lifted"].get<bool>()                    ? Verdict::rocks
                                                                         : Verdict::stands;
  ++counts[static_cast<int>(verdict)];
}

}  // namespace

std::vector<Level> levels(const OverturnPlan& plan, const OverturnMap& map, int k) {
  const Axis& axis = map.fragility_along_y ? plan.y : plan.x;
  std::vector<Level> out;
  for (int i = 0; i < axis.count(); ++i) {
    const int point = map.fragility_along_y ? i * plan.x.count() + k : k * plan.x.count() + i;
    const OverturnPoint& at = map.points[static_cast<std::size_t>(point)];
    out.push_back({axis.values[static_cast<std::size_t>(i)], at.runs, at.overturned});
  }
  return out;
}

std::vector<FloorPeak> floor_peaks(const OverturnPlan& plan, const OverturnMap& map, int k) {
  const Setup& own = plan.scene.setup;
  const Axis &along = map.fragility_along_y ? plan.y : plan.x,
             &other = map.fragility_along_y ? plan.x : plan.y;
  std::vector<FloorPeak> out;
  for (int i = 0; i < along.count(); ++i) {
    Parameters parameters = own.parameters;
    std::vector<std::string> changes;  // of what no edit reaches, such as what a building makes of the ground
    for (const auto& [axis, place] : {std::pair(&other, k), std::pair(&along, i)}) {
      if (!axis->key.starts_with("shake.")) continue;
      changes.push_back(axis->change(place));
      const std::optional<Edit> edit = io::parse_edit_key(axis->key);
      if (edit && traits(edit->key).exists(own.model, parameters, edit->index))
        set_at_once(own.model, axis->in_si(place), *edit, parameters);
      else
        parameters.shakes.clear();
    }
    if (parameters.shakes.empty() && !changes.empty()) try {
        parameters = read_scene(plan, plan.scene, changes).setup.parameters;
      } catch (const InputError&) {
        return {};
      }
    out.push_back(floor_peak(parameters.shakes, own.run.duration));
  }
  return out;
}

std::vector<Level> levels_over(const GroundMeasure& measure, std::vector<Level> levels,
                               const std::vector<FloorPeak>& peaks) {
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i].intensity = peaks[i].*measure.value / measure.si;
  return levels;
}

OverturnMap gather(const OverturnPlan& plan, const std::vector<std::string>& rows) {
  OverturnMap map;
  const Model& model = plan.scene.setup.model;
  for (int b = 0; b < model.furniture_total(); ++b) map.bodies.push_back(model.bodies[b].name);
  const Room& room = plan.scene.setup.room;
  for (std::size_t p = 0; p < room.ways(); ++p) map.ways.push_back(room.places[p].name);
  map.of = plan.runs();
  for (int p = 0; p < plan.points(); ++p) {
    OverturnPoint point;
    point.fell.resize(map.bodies.size());
    point.open.resize(map.ways.size());
    int counts[static_cast<int>(Verdict::stands) + 1] = {};
    for (int chunk = 0; chunk < plan.chunks(); ++chunk) {
      const std::string& row = rows[static_cast<std::size_t>(p * plan.chunks() + chunk)];
      if (row.empty()) continue;
      const ordered_json read = ordered_json::parse(row);
      point.cpu += read["cpu_s"].get<double>();
      for (const ordered_json& run : read["runs"]) {
        ++map.run;
        map.planar += run.value("planar", false);
        add_run(point, run, counts);
      }
    }
    std::ranges::sort(point.times);
    if (point.runs > 0)
      point.verdict = static_cast<Verdict>(std::ranges::max_element(counts) - std::begin(counts));
    else if (point.failed > 0)
      point.verdict = Verdict::failed;
    map.points.push_back(std::move(point));
  }
  map.criteria = plan.criteria ? *plan.criteria : criteria(plan.scene.setup, plan.x, plan.y);
  if (!is_intensity(plan.y) && !is_intensity(plan.x)) return map;
  map.fragility_along_y = is_intensity(plan.y);
  const Axis& other = map.fragility_along_y ? plan.x : plan.y;
  map.own_column = own_place(other);
  for (int k = 0; k < other.count(); ++k) map.fragility.push_back(fit_fragility(levels(plan, map, k)));
  return map;
}

}  // namespace topple::study
