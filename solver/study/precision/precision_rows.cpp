// The precision study as words and JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"
#include "solver/frame/integrator.h"
#include "solver/study/common/rows.h"
#include "solver/study/precision/precision.h"

namespace topple::study {
namespace {

using nlohmann::ordered_json;

ordered_json errors_as_json(const Errors& errors) {
  ordered_json json;
  for (int m = 0; m < k_measures; ++m)
    json[name(static_cast<Measure>(m))] = or_null(errors[static_cast<std::size_t>(m)]);
  return json;
}

ordered_json setting_as_json(const PrecisionPlan& plan, const PrecisionStudy& study, int k) {
  const PrecisionRow& row = study.rows[static_cast<std::size_t>(k)];
  return {{"case", k},
          {"setting", in_words(plan, k)},
          {"cpu_s_per_s", or_null(row.cost)},
          {"errors", errors_as_json(row.errors)}};
}

ordered_json reference_as_json(const PrecisionPlan& plan, const PrecisionStudy& study, int law) {
  const Reference& reference = study.references[static_cast<std::size_t>(law)];
  ordered_json json{{"law", in_words(plan.laws[static_cast<std::size_t>(law)])}};
  if (reference.run < 0) {
    json["why_not"] = reference.why_not;
    return json;
  }
  ordered_json bodies = ordered_json::array();
  for (std::size_t b = 0; b < reference.fell.size(); ++b)
    bodies.push_back({{"name", plan.scene.setup.model.bodies[b].name},
                      {"overturn_time_s", or_null(reference.fell[b])},
                      {"peak_tilt_rad", reference.peak_tilt[b]}});
  json.update({{"run", in_words(plan, reference.run)},
               {"check", in_words(plan, reference.check)},
               {"window_s", reference.window},
               {"end_s", reference.end},
               {"uncertainty", errors_as_json(reference.uncertainty)},
               {"order_observed", or_null(reference.order)},
               {"bodies", bodies}});
  return json;
}

ordered_json cheapest_as_json(const PrecisionPlan& plan, const PrecisionStudy& study, int law) {
  ordered_json levels = ordered_json::array();
  for (const double level : k_levels) {
    ordered_json entry{{"error", level}};
    for (int m = 0; m < k_measures; ++m) {
      const auto measure = static_cast<Measure>(m);
      const std::optional<int> k = cheapest(plan, study, law, measure, level);
      entry[name(measure)] = k ? setting_as_json(plan, study, *k) : ordered_json(nullptr);
    }
    levels.push_back(std::move(entry));
  }
  return levels;
}

}  // namespace

std::string in_words(const PrecisionPlan& plan, int k) {
  const Setting& setting = plan.setting_of(k);
  const std::string how = meaning(setting.method).name;
  return setting.tolerance > 0 ? fmt::format("{}, tolerance {:.3g}", how, setting.tolerance)
                               : fmt::format("{}, {:.4g} ms", how, 1e3 * setting.step);
}

std::string in_words(const ContactLaw& law) {
  return fmt::format("{}, {:.7g} kgf", traits(law).word, law.alpha / k_standard_gravity);
}

ordered_json rows_as_json(const PrecisionPlan& plan, const PrecisionStudy& study) {
  ordered_json rows = ordered_json::array();
  for (int k = 0; k < plan.cases(); ++k) {
    const PrecisionRow& row = study.rows[static_cast<std::size_t>(k)];
    const Setting& setting = plan.setting_of(k);
    const MethodMeaning& how = meaning(setting.method);
    const ContactLaw& law = plan.laws[static_cast<std::size_t>(plan.law_of(k))];
    const Reference& reference = study.references[static_cast<std::size_t>(plan.law_of(k))];
    const bool own = setting.method == Method::scene, frames = how.model == BodyModel::frame;
    const bool compared = row.errors[index(Measure::tilt)].has_value();
    rows.push_back(
        {{"law", traits(law).word},
         {"alpha_N", law.alpha},
         {"method", how.name},
         {"model", own ? ordered_json("scene") : ordered_json(traits(how.model).word)},
         {"integrator", own      ? ordered_json("scene")
                        : frames ? ordered_json(traits(how.integrator).word)
                                 : ordered_json(nullptr)},
         {"time_step_s", setting.step > 0 ? ordered_json(setting.step) : ordered_json(nullptr)},
         {"tolerance", setting.tolerance > 0 ? ordered_json(setting.tolerance) : ordered_json(nullptr)},
         {"status", row.status},
         {"steps", row.end ? ordered_json(row.steps) : ordered_json(nullptr)},
         {"simulated_s", or_null(row.end)},
         {"window_s", compared ? ordered_json(reference.window) : ordered_json(nullptr)},
         {"same_verdict", compared ? ordered_json(row.same_verdict) : ordered_json(nullptr)},
         {"tilt_error", or_null(row.errors[index(Measure::tilt)])},
         {"overturn_time_error", or_null(row.errors[index(Measure::overturn_time)])},
         {"peak_stress_error", or_null(row.errors[index(Measure::peak_stress)])},
         {"energy_error", or_null(row.errors[index(Measure::energy)])},
         {"cpu_s_per_s", or_null(row.cost)}});
  }
  return rows;
}

ordered_json findings_as_json(const PrecisionPlan& plan, const PrecisionStudy& study) {
  ordered_json references = ordered_json::array(), fronts = ordered_json::array(),
               levels = ordered_json::array(), places = ordered_json::object();
  for (int law = 0; law < static_cast<int>(plan.laws.size()); ++law) {
    const std::string words = in_words(plan.laws[static_cast<std::size_t>(law)]);
    references.push_back(reference_as_json(plan, study, law));
    levels.push_back({{"law", words}, {"within", cheapest_as_json(plan, study, law)}});
    ordered_json measures;
    for (int m = 0; m < k_measures; ++m) {
      const auto measure = static_cast<Measure>(m);
      measures[name(measure)] = front(plan, study, law, measure);
    }
    fronts.push_back({{"law", words}, {"cases", measures}});
  }
  for (int m = 0; m < k_measures; ++m) {
    const auto measure = static_cast<Measure>(m);
    const std::optional<DefaultPlace> place = place_of_default(plan, study, measure);
    places[name(measure)] =
        place ? ordered_json{{"times_dearer", place->cost_ratio}, {"times_coarser", place->error_ratio}}
              : ordered_json(nullptr);
  }
  return {{"references", references}, {"fronts", fronts}, {"cheapest", levels}, {"scene_default", places}};
}

}  // namespace topple::study
