#include "solver/study/overturn/fragility_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "solver/io/scene/scene_file.h"
#include "solver/model/accelerogram.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/kept_rows.h"
#include "solver/study/common/measure.h"

namespace topple::study {
namespace {

using io::InputError;
using nlohmann::ordered_json;

constexpr std::array<StateTraits, k_states> k_damage_states{{
    {"uplift", "uplift", "lifts a side", [](const BodyEnd& fate, double) { return fate.lifted; }},
    {"slide", "sliding", "slides farther",
     [](const BodyEnd& fate, double slide) { return fate.slide > slide; }},
    {"overturn", "overturning", "overturns",
     [](const BodyEnd& fate, double) { return fate.fell.has_value(); }},
}};

constexpr int k_rigid_chunk = 4;
constexpr double k_most_runs = 1e8;
constexpr int k_draws = 400;  // of records anew

Setup read_setup(const io::Scene& scene, const std::vector<std::string>& set) {
  return io::parse_scene(scene.text, scene.name, set, io::kept_files(scene)).setup;
}

const MotionMeasure& measure_named(const std::string& name) {
  std::string known;
  for (const MotionMeasure& one : motion_measures()) {
    if (one.key.name == name) return one;
    known += (known.empty() ? "" : ", ") + std::string(one.key.name);
  }
  throw InputError("--x \"" + name + "\": is not a measure of the floor's motion; known: " + known);
}

Axis axis_of_levels(const MotionMeasure& measure, const std::string& text) {
  try {
    return parse_axis(text, measure.key);
  } catch (const InputError& error) {
    throw InputError(std::string("--x ") + error.what());
  }
}

/// The levels with intensities that a lognormal distribution is of.
std::vector<Level> intensities(const FragilityPlan& plan, std::vector<Level> levels) {
  for (Level& level : levels) level.intensity = plan.measure->intensity(level.intensity);
  return levels;
}

double in_unit(const FragilityPlan& plan, double intensity) {
  return plan.measure->value(intensity);
}

using LevelsOfRecords = std::vector<std::vector<Level>>;

std::vector<Level> sum_of(const LevelsOfRecords& records, const std::vector<int>& drawn) {
  std::vector<Level> sum = records.front();
  for (Level& level : sum) level.runs = level.hits = 0;
  for (const int r : drawn)
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i].runs += records[static_cast<std::size_t>(r)][i].runs;
      sum[i].hits += records[static_cast<std::size_t>(r)][i].hits;
    }
  return sum;
}

Interval middle_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double part) {
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.025), at(0.975)};
}

/// Bootstrap: B. Efron, Annals of Statistics 7, 1979, 1-26.
void draw_records(const FragilityPlan& plan, const LevelsOfRecords& records, FragilityCurve& curve) {
  const auto count = static_cast<std::uint64_t>(records.size());
  if (count < 2 || !curve.fit.fit) return;
  std::vector<double> medians, betas;
  for (std::uint64_t n = 0; n < k_draws; ++n) {
    std::vector<int> drawn;
    for (std::uint64_t r = 0; r < count; ++r)
      drawn.push_back(static_cast<int>(scattered(n, r) * static_cast<double>(count)));
    const Fragility fit = fit_fragility(intensities(plan, sum_of(records, drawn)));
    if (!fit.fit) continue;
    medians.push_back(in_unit(plan, fit.fit->median));
    betas.push_back(fit.fit->beta);
  }
  if (10 * medians.size() < 9 * k_draws) return;
  curve.median_of_records = middle_of(std::move(medians));
  curve.beta_of_records = middle_of(std::move(betas));
}

/// A median beyond the levels is none that runs tell.
void drop_extrapolated(const FragilityPlan& plan, FragilityCurve& curve, const char* verb) {
  if (!curve.fit.fit) return;
  const double median = in_unit(plan, curve.fit.fit->median);
  if (median >= plan.levels.values.front() && median <= plan.levels.values.back()) return;
  const bool above = median > plan.levels.values.back();
  const auto share = [](const Level& at) {
    return at.runs > 0 ? static_cast<double>(at.hits) / at.runs : 0.;
  };
  const Level& end = above ? *std::ranges::max_element(curve.levels, {}, share)
                           : *std::ranges::min_element(curve.levels, {}, share);
  curve.fit.fit.reset();
  const Level& last = above ? curve.levels.back() : curve.levels.front();
  if (&end != &last && above == (share(end) >= 0.5)) {  // it was met, and left again
    curve.fit.why_not =
        fmt::format("it does not become more frequent steadily: {} of {} runs at {:.4g}, {} of {} at {:.4g}",
                    end.hits, end.runs, end.intensity, last.hits, last.runs, last.intensity);
    return;
  }
  curve.fit.why_not = fmt::format(
      "the median lies {} the levels, a run {} in {} {:.2g} % of the cases, at {:.4g}",
      above ? "above" : "below", verb, above ? "at most" : "at least", 100 * share(end), end.intensity);
}

/// No curve where what is more frequent at one level than at a higher one is so by more than chance.
void drop_falling(FragilityCurve& curve) {
  const auto share = [](const Level& at) { return wilson(at.hits, at.runs); };
  const Level* most = nullptr;
  for (const Level& level : curve.levels) {
    if (level.runs == 0 || !curve.fit.fit) continue;
    if (most && share(level).high < share(*most).low) {
      curve.fit.fit.reset();
      curve.fit.why_not =
          fmt::format("it becomes rarer again: {} of {} runs at {:.4g}, {} of {} at {:.4g}", most->hits,
                      most->runs, most->intensity, level.hits, level.runs, level.intensity);
    } else if (!most || share(level).low > share(*most).low) {
      most = &level;
    }
  }
}

FragilityCurve curve_of(const FragilityPlan& plan, const LevelsOfRecords& records, const char* verb) {
  std::vector<int> all;
  for (std::size_t r = 0; r < records.size(); ++r) all.push_back(static_cast<int>(r));
  FragilityCurve curve;
  curve.levels = sum_of(records, all);
  curve.fit = fit_fragility(intensities(plan, curve.levels), verb);
  drop_falling(curve);
  drop_extrapolated(plan, curve, verb);
  if (curve.fit.fit) {
    Lognormal fit = *curve.fit.fit;
    curve.scatter = fit.scatter();
    fit.median_error *= curve.scatter, fit.beta_error *= curve.scatter;
    const Interval median = fit.median_interval();
    curve.beta_of_runs = fit.beta_interval();
    curve.median = in_unit(plan, fit.median);
    curve.median_of_runs = {in_unit(plan, median.low), in_unit(plan, median.high)};
  }
  draw_records(plan, records, curve);
  return curve;
}

bool along_a_line(const Setup& setup) {
  const std::vector<Shake>& shakes = setup.parameters.shakes;
  return std::ranges::all_of(shakes, [&](const Shake& shake) {
    return shake.direction.cross(shakes.front().direction).norm() < 1e-9 &&
           (!shake.record || shake.record->components.size() == 1);
  });
}

/// Over the edge that the shakes lift it from first, where they go along one line; else the nearest.
PushedOver pushed(const Setup& setup, int body) {
  std::optional<PushedOver> least;
  if (along_a_line(setup))
    for (const double sense : {1., -1.})
      if (const auto at = pushed_over(setup.model, setup.parameters, body,
                                      sense * setup.parameters.shakes.front().direction))
        if (!least || at->limit() < least->limit()) least = at;
  return least ? *least : PushedOver{standing(setup.model, setup.parameters, body), 1};
}

std::string why_no_criteria(const Setup& setup, int body) {
  const std::vector<bool>& in_place = setup.parameters.anchors;
  for (std::size_t k = 0; k < setup.model.anchors.size(); ++k)
    if (const Anchor& anchor = setup.model.anchors[k];
        holds(setup.model, anchor, body) && (in_place.empty() || in_place[k]))
      return "is held by \"" + anchor.name + '"';
  return why_no_block(setup.model, body);
}

/// In the axis's unit; 0: the axis is neither of acceleration nor of velocity.
BodyCriteria criteria_of(const FragilityPlan& plan, int body, double frequency) {
  const Setup& setup = plan.scene.setup;
  BodyCriteria out;
  const bool acceleration = plan.measure->key.dimension == io::Dimension::acceleration,
             velocity = plan.measure->key.name == "pgv";
  out.why_not =
      !acceleration && !velocity ? "the measure is neither PGA nor PGV" : why_no_criteria(setup, body);
  if (!out.why_not.empty()) return out;
  const PushedOver pushed_at = pushed(setup, body);
  const Standing& at = pushed_at.edge;
  if (slides_first(setup.model, setup.parameters, body, pushed_at.limit())) {
    out.why_not = "slides before it lifts";
    return out;
  }
  out.along_a_line = along_a_line(setup);
  out.share = pushed_at.share;
  out.corner = evaluation_frequency(at);
  const double median = evaluation_acceleration(at), turn = 2 * k_pi * frequency;
  // of a floor that goes by acceleration below the corner, by velocity above
  const double of_evaluation = frequency <= out.corner ? median : median * frequency / out.corner;
  const double per = plan.levels.si * (velocity ? turn : 1) * out.share;
  out.west = west_acceleration(at) / per;
  out.evaluation = of_evaluation / per;
  out.ishiyama = ishiyama_velocity(at) * turn / per;
  return out;
}

// Of a steady sine its own, as in the criteria over frequency: it starts with a greater velocity.
double median_frequency(const FragilityPlan& plan) {
  std::vector<double> all;
  for (const io::Scene& scene : plan.scenes) {
    const std::vector<Shake>& shakes = scene.setup.parameters.shakes;
    if (shakes.size() == 1 && traits(shakes[0].kind).steady && !shakes[0].building &&
        plan.measure->key.name != "pgv") {
      all.push_back(shakes[0].frequency);
      continue;
    }
    const FloorPeak peak = floor_peak(shakes, scene.setup.run.duration);
    all.push_back(peak.velocity > 0 ? peak.acceleration / (2 * k_pi * peak.velocity) : 0);
  }
  std::ranges::sort(all);
  return (all[(all.size() - 1) / 2] + all[all.size() / 2]) / 2;
}

}  // namespace

const std::array<StateTraits, k_states>& damage_states() {
  return k_damage_states;
}

FragilityPlan plan_fragility(io::Scene scene, const std::string& levels, const Ensemble& ensemble,
                             double slide) {
  if (scene.setup.run.analysis != Analysis::dynamic)
    throw InputError("study fragility: " + scene.name + " is not dynamic; nothing overturns in it");
  if (scene.setup.model.furniture_total() == 0)
    throw InputError("study fragility: " + scene.name + " has no body that could overturn");
  FragilityPlan plan{};
  plan.factors = plan_factors(ensemble, scene);
  plan.scenes = scenes_of(plan.factors, scene);
  plan.scene = with_files_of(plan.scenes);
  if (plan.scene.setup.parameters.shakes.empty())
    throw InputError("study fragility: " + scene.name + " has no shake, and --vary names no records");
  const std::string text = levels.empty() ? motion_measures().front().usual : levels;
  plan.measure = &measure_named(axis_key(text));
  plan.levels = axis_of_levels(*plan.measure, text);
  plan.slide = slide;
  plan.set = overturn_settings(plan.scene);
  plan.runs = (ensemble.runs + plan.records() - 1) / plan.records();
  if (static_cast<double>(plan.levels.count()) * plan.records() * plan.runs > k_most_runs)
    throw InputError(fmt::format("--ensemble: {} levels of {} runs are more than {:g} runs",
                                 plan.levels.count(), plan.records() * plan.runs, k_most_runs));
  for (int r = 0; r < plan.records(); ++r) {
    const Setup& setup = plan.scenes[static_cast<std::size_t>(r)].setup;
    plan.own.push_back(plan.measure->of(setup.parameters.shakes, setup.run.duration));
    if (!(plan.measure->intensity(plan.own.back()) > 0) || !std::isfinite(plan.own.back()))
      throw InputError(fmt::format(
          "study fragility: {}: its {} is {:g}, which no factor brings to a level",
          plan.factors.records.empty() ? scene.name : plan.factors.records[static_cast<std::size_t>(r)],
          plan.measure->title, plan.own.back()));
  }
  plan.chunk = is_planar(plan) ? k_planar_chunk : k_rigid_chunk;
  return plan;
}

bool is_planar(const FragilityPlan& plan) {
  return !planar_cases(read_setup(plan.scene, plan.set)).empty();
}

ordered_json settings_of(const FragilityPlan& plan) {
  ordered_json settings{{"study", "fragility"},       {"scene", plan.scene.name},
                        {"measure", plan.levels.key}, {"levels", plan.levels.values},
                        {"runs", plan.runs},          {"slide_m", plan.slide}};
  settings.update(settings_of(plan.factors));
  settings.update({{"scene text", plan.scene.text}, {"files", fingerprints(plan.scene.files)}});
  return settings;
}

std::vector<int> case_order(const FragilityPlan& plan) {
  std::vector<int> order;
  const std::vector<int> levels = coarse_to_fine(plan.levels.count(), 1);
  for (int chunk = 0; chunk < plan.chunks(); ++chunk)
    for (const int level : levels)
      for (int record = 0; record < plan.records(); ++record)
        order.push_back((level * plan.records() + record) * plan.chunks() + chunk);
  return order;
}

FragilityRunner::Place& FragilityRunner::place(int record) {
  places_.resize(static_cast<std::size_t>(plan_->records()));
  std::optional<Place>& at = places_[static_cast<std::size_t>(record)];
  if (!at) {
    const io::Scene& scene = plan_->scenes[static_cast<std::size_t>(record)];
    at.emplace();
    at->scene = io::parse_scene(scene.text, scene.name, plan_->set, io::kept_files(scene));
    at->planar = planar_cases(at->scene.setup);
  }
  return *at;
}

std::string FragilityRunner::run(int k, const std::function<bool()>& give_up) {
  const int chunk = k % plan_->chunks(), record = k / plan_->chunks() % plan_->records(),
            level = k / plan_->chunks() / plan_->records();
  const auto stream = static_cast<std::uint64_t>(level * plan_->records() + record);
  int runs = 0, failed = 0, planar = 0;
  std::string status = "completed";
  std::vector<std::array<int, k_states>> hits;
  std::vector<int> closed(plan_->scene.setup.room.ways(), 0);
  bool gave_up = false;
  const double cpu = cpu_time_of(
      [&] {
        Place& at = place(record);
        const double factor = amplitude_factor(*plan_->measure, plan_->own[static_cast<std::size_t>(record)],
                                               plan_->levels.in_si(level));
        const std::vector<Shake> shakes = shaken_by(at.scene.setup.parameters.shakes, factor);
        const RunStart start{at.planar, shakes, at.scene.setup.run.duration,
                             [&]() -> const io::Scene& { return at.scene; }};
        const std::size_t bodies = static_cast<std::size_t>(at.scene.setup.model.furniture_total());
        hits.assign(bodies + 1, {});
        const int last = std::min(plan_->runs, (chunk + 1) * plan_->chunk);
        std::vector<VariedMember> members;
        for (int member = chunk * plan_->chunk; member < last; ++member)
          members.push_back({&start, plan_->factors.draw(stream, static_cast<std::uint32_t>(member))});
        for (const RunEnd& end : run_varied(members, plan_->factors, give_up)) {
          gave_up |= end.gave_up;
          if (end.of_bodies.empty()) {
            if (failed++ == 0) status = end.status;
            continue;
          }
          ++runs;
          planar += end.planar;
          for (std::size_t p = 0; p < end.open.size(); ++p) closed[p] += !end.open[p];
          for (std::size_t s = 0; s < k_states; ++s) {
            bool any = false;
            for (std::size_t b = 0; b < bodies; ++b) {
              const bool hit = k_damage_states[s].is_there(end.of_bodies[b], plan_->slide);
              hits[b][s] += hit;
              any |= hit;
            }
            hits[bodies][s] += any;
          }
        }
      },
      0);
  if (gave_up) return "";
  const ordered_json row{{"runs", runs}, {"failed", failed}, {"planar", planar}, {"status", status},
                         {"hits", hits}, {"closed", closed}, {"cpu_s", cpu}};
  return row.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::optional<Interval> FragilityCurve::step() const {
  std::optional<double> low, high;
  for (std::size_t i = 0; i < levels.size() && levels[i].runs > 0 && levels[i].hits == 0; ++i)
    low = levels[i].intensity;
  for (std::size_t i = levels.size(); i-- > 0 && levels[i].runs > 0 && levels[i].hits == levels[i].runs;)
    high = levels[i].intensity;
  return low && high ? std::optional(Interval{*low, *high}) : std::nullopt;
}

double FragilityCurve::probability(const FragilityPlan& plan, double value) const {
  return fit.fit->probability(plan.measure->intensity(value));
}

FragilityResults gather(const FragilityPlan& plan, const std::vector<std::string>& rows) {
  FragilityResults out;
  const Model& model = plan.scene.setup.model;
  const int bodies = model.furniture_total();
  for (int b = 0; b < bodies; ++b) out.bodies.push_back(model.bodies[static_cast<std::size_t>(b)].name);
  if (bodies > 1) out.bodies.emplace_back("any body");
  std::vector<Level> none;
  for (const double value : plan.levels.values) none.push_back({value, 0, 0});
  const LevelsOfRecords empty(static_cast<std::size_t>(plan.records()), none);
  std::vector<std::array<LevelsOfRecords, k_states>> counts(out.bodies.size());
  for (auto& body : counts) body.fill(empty);
  std::vector<LevelsOfRecords> closed(plan.scene.setup.room.ways(), empty);
  out.of = static_cast<long>(plan.levels.count()) * plan.records() * plan.runs;
  for (int k = 0; k < plan.cases(); ++k) {
    if (rows[static_cast<std::size_t>(k)].empty()) continue;
    const ordered_json row = ordered_json::parse(rows[static_cast<std::size_t>(k)]);
    const int runs = row["runs"].get<int>(), failed = row["failed"].get<int>();
    if (failed > 0 && out.failed == 0) out.status = row["status"].get<std::string>();
    out.runs += runs + failed, out.failed += failed, out.planar += row["planar"].get<int>();
    out.cpu += row["cpu_s"].get<double>();
    const auto record = static_cast<std::size_t>(k / plan.chunks() % plan.records()),
               level = static_cast<std::size_t>(k / plan.chunks() / plan.records());
    if (runs == 0) continue;
    for (std::size_t b = 0; b < counts.size(); ++b)
      for (std::size_t s = 0; s < k_states; ++s) {
        Level& at = counts[b][s][record][level];
        at.runs += runs;
        at.hits += row["hits"][b][s].get<int>();
      }
    for (std::size_t p = 0; p < closed.size(); ++p) {
      closed[p][record][level].runs += runs;
      closed[p][record][level].hits += row["closed"][p].get<int>();
    }
  }
  for (const auto& body : counts) {
    std::array<FragilityCurve, k_states> curves;
    for (std::size_t s = 0; s < k_states; ++s) curves[s] = curve_of(plan, body[s], k_damage_states[s].verb);
    out.curves.push_back(std::move(curves));
  }
  for (const LevelsOfRecords& place : closed) out.closed.push_back(curve_of(plan, place, "closes the way"));
  out.frequency = median_frequency(plan);
  for (int b = 0; b < bodies; ++b) out.criteria.push_back(criteria_of(plan, b, out.frequency));
  planar_cases(read_setup(plan.scene, plan.set), &out.why_not_planar);
  return out;
}

}  // namespace topple::study
