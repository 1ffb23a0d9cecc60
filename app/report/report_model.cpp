// Sections of the report page: what the model assumes, and the settings.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/report/report_parts.h"
#include "app/support/integrators.h"
#include "app/support/model_words.h"
#include "app/support/models_in_brief.h"
#include "solver/body/model_level.h"
#include "solver/contact/contact_law.h"

namespace topple::app {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t k_listed_bodies = 12;

/// Five significant digits without an exponent.
std::string plain(double value) {
  return value < 1e5 ? short_shown(value, 5) : shown(value, 0);
}

/// Of all, and of pieces that have their own.
std::string frictions(const Setup& setup) {
  const double of_all = setup.parameters.contact.friction;
  std::string words = short_shown(of_all);
  for (const Body& body : setup.model.bodies)
    if (body.grip != 1) words += ", " + body.name + " " + short_shown(body.grip * of_all);
  return words;
}

struct LevelPhrase {
  ModelLevel kind;
  const Phrase& phrase;
};
constexpr LevelPhrase k_level_phrases[] = {{ModelLevel::planar, words::k_planar},
                                           {ModelLevel::rigid, words::k_rigid},
                                           {ModelLevel::elastic, words::k_elastic},
                                           {ModelLevel::frame, words::k_frame}};

const LevelPhrase& level_of(const ordered_json& model) {
  return row_of(k_level_phrases, level_called(model.get<std::string>()).kind);
}

std::string reason_in_words(const ReportPage& page, const std::string& reason) {
  for (const auto& [kind, words] : model_words::k_level_reasons)
    if (reason == name(kind)) return page.text(model_words::phrase_of(kind));
  return reason;
}

/// All models that a body was computed as, since when and why.
std::string models(const ReportPage& page, const ordered_json& body) {
  if (body["models"].empty()) return page.say(level_of(body["model"]).phrase);
  std::string out;
  for (const ordered_json& change : models_in_brief(body["models"])) {
    const std::string model = page.text(level_of(change["model"]).phrase),
                      reason = reason_in_words(page, change["reason"]), times = change["times"],
                      from = short_shown(change["from_s"].get<double>());
    out += out.empty()     ? model + " (" + reason + ")"
           : times.empty() ? "; " + page.text(words::k_model_from, model, from, reason)
                           : "; " + page.text(words::k_model_times, model, from, reason, times);
  }
  return escaped(out);
}

std::string of_frames(const ReportPage& page) {
  const Parameters& p = page.report().scene->setup.parameters;
  const std::string name = page.text(model_words::phrase_of_choice(traits(p.integrator).word));
  switch (p.integrator) {
    case Integrator::generalized_alpha:
      return fmt::format("{}, ρ∞ = {}", name, short_shown(p.spectral_radius));
    case Integrator::newmark:
      return fmt::format("{}, β = {}, γ = {}", name, short_shown(p.beta), short_shown(p.gamma));
    case Integrator::central_difference:
      break;
  }
  return name;
}

/// Of all bodies, floors and walls of beams included.
std::set<ModelLevel> levels_of(const ReportPage& page) {
  const Model& model = page.report().scene->setup.model;
  std::set<ModelLevel> levels;
  if (model.furniture_total() < static_cast<int>(model.bodies.size())) levels.insert(ModelLevel::frame);
  for (const ordered_json& body : page.bodies()) {
    levels.insert(level_of(body["model"]).kind);
    for (const ordered_json& change : body["models"]) levels.insert(level_of(change["model"]).kind);
  }
  return levels;
}

/// How what was computed stood on the floor: a planar block rocks on rigid corners, but on springs where
/// points lie between them.
struct Footing {
  bool springs = false, rigid = false;
};

Footing footing(const ReportPage& page) {
  const Model& model = page.report().scene->setup.model;
  Footing out;
  for (const ModelLevel level : levels_of(page)) out.springs |= !traits(level).has_block;
  for (std::size_t b = 0; b < page.bodies().size(); ++b) {
    const ordered_json& body = page.bodies()[b];
    bool is_block = traits(level_of(body["model"]).kind).has_block;
    for (const ordered_json& change : body["models"])
      is_block |= traits(level_of(change["model"]).kind).has_block;
    if (!is_block) continue;
    const bool corners = model.bodies[b].base_points.size() == model.bodies[b].support_polygon.size();
    (corners ? out.rigid : out.springs) = true;
  }
  return out;
}

/// What moved the bodies, whatever the scene asks of frames.
std::string integrators(const ReportPage& page) {
  const Model& model = page.report().scene->setup.model;
  const std::set<ModelLevel> levels = levels_of(page);
  std::string out;
  for (const ModelLevel level : levels) {
    const Phrase* const own =
        model_words::moved_by(level, moves_otherwise(level, model, page.report().scene->setup.parameters));
    const std::string words = own == nullptr ? of_frames(page) : page.text(*own);
    out += (out.empty() ? "" : "; ") +
           (levels.size() > 1 ? page.text(words::k_of_models, words, page.text(model_words::phrase_of(level)))
                              : words);
  }
  return escaped(out);
}

std::string step(const ReportPage& page) {
  const ordered_json& s = page.report().summary;
  const Parameters& p = page.report().scene->setup.parameters;
  const std::string mean =
      s["time_step_s"].is_null() ? "\u2013" : short_shown(1e3 * s["time_step_s"].get<double>());
  return (p.adaptive ? page.say(words::k_adaptive, short_shown(p.tolerance), mean) : mean + " ms") + "; " +
         page.say(words::k_steps, s["steps"].get<long>(), s["rejected_steps"].get<long>());
}

}  // namespace

std::string assumptions_section(ReportPage& page) {
  const Setup& setup = page.report().scene->setup;
  const Model& model = setup.model;
  const bool all_rigid = std::ranges::all_of(
      page.report().summary["bodies"], [](const auto& body) { return body["peak_stress_Pa"].is_null(); });
  const auto some = [&](auto what) { return !all_rigid && std::ranges::any_of(model.materials, what); };
  std::vector<std::string> list{page.say(words::k_as_given), page.say(words::k_contents)};
  if (!model.planes.empty()) list.push_back(page.say(words::k_rigid_floor));
  if (model.furniture_total() < static_cast<int>(model.bodies.size()))
    list.push_back(page.say(words::k_beam_floor));
  const Footing contacts = footing(page);
  if (contacts.springs) list.push_back(page.say(words::k_friction, frictions(setup)));
  if (contacts.rigid) list.push_back(page.say(words::k_rigid_friction, frictions(setup)));
  if (some([](const Material& m) { return m.yield > 0; }))
    list.push_back(
        page.say(words::k_frames_plastic, some([](const Material& m) { return m.fracture_strain > 0; })
                                              ? page.text(words::k_frames_break)
                                              : std::string()));
  else
    list.push_back(page.say(words::k_frames_elastic));
  if (!page.report().without_anchors) list.push_back(page.say(words::k_no_anchors));
  list.push_back(page.say(words::k_ends, short_shown(page.report().summary["simulated_s"].get<double>())));
  list.push_back(page.say(words::k_not_validated));
  std::string out = "<ul>\n";
  for (const std::string& item : list) out += "<li>" + item + "</li>\n";
  return page.section(words::k_assumptions, out + "</ul>\n");
}

std::string settings_section(ReportPage& page) {
  const Report& report = page.report();
  const Setup& setup = report.scene->setup;
  const Parameters& p = setup.parameters;
  const std::string simulated = short_shown(report.summary["simulated_s"].get<double>());
  std::vector<std::vector<std::string>> rows{
      {page.say(words::k_version), std::string("topple ") + TOPPLE_VERSION},
      {page.say(words::k_simulated),
       report.summary["status"] == "stopped" ? page.say(words::k_stopped, simulated) : simulated + " s"},
      {page.say(words::k_integrator), integrators(page)},
      {page.say(words::k_step), step(page)}};
  const bool springs = footing(page).springs;
  const std::string law(traits(p.contact).word);
  rows.push_back({page.say(words::k_contact), springs ? law : page.say(words::k_no_springs, law)});
  if (springs) {
    rows.push_back(
        {page.say(words::k_alpha),
         fmt::format("{} kgf ({} N)", plain(p.contact.alpha / k_standard_gravity), plain(p.contact.alpha))});
    rows.push_back({page.say(words::k_member_share), short_shown(p.contact.member_share)});
    rows.push_back({page.say(words::k_q), short_shown(p.contact.q)});
  }
  rows.push_back({page.say(words::k_mu), frictions(setup)});
  if (springs && traits(p.contact).has_restitution) {
    rows.push_back({page.say(words::k_restitution), short_shown(p.contact.restitution)});
    rows.push_back({page.say(words::k_normal_speed), short_shown(p.contact.normal_speed) + " m/s"});
  }
  rows.push_back({page.say(words::k_gravity),
                  fmt::format("({}, {}, {}) m/s²", short_shown(p.gravity.x(), 6),
                              short_shown(p.gravity.y(), 6), short_shown(p.gravity.z(), 6))});
  for (std::size_t b = 0; b < std::min(page.bodies().size(), k_listed_bodies); ++b)
    rows.push_back({page.say(words::k_bodies, page.name(b)),
                    short_shown(setup.model.bodies[b].mass) + " kg; " + models(page, page.bodies()[b])});
  if (page.bodies().size() > k_listed_bodies)
    rows.push_back({page.say(words::k_more_bodies, page.bodies().size() - k_listed_bodies), ""});
  std::string changes;
  for (const std::string& change : report.overrides)
    changes += (changes.empty() ? "" : "<br>") + escaped(change);
  if (!changes.empty()) rows.push_back({page.say(words::k_overrides), changes});
  return page.section(words::k_settings, page.table({}, rows, false));
}

}  // namespace topple::app
