#include "app/panels/criteria.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/panels/teaching_words.h"
#include "app/picture/touching_bodies.h"
#include "solver/body/model_level.h"
#include "solver/model/excitation.h"
#include "solver/study/common/alone.h"
#include "solver/study/common/standing.h"
#include "solver/study/overturn/criteria.h"

namespace topple::app {

using namespace window_words;

const Phrase& verdict(const CriteriaLimits& limits, const ShakePlace& at) {
  if (at.amplitude < limits.west) return k_stays;
  return at.velocity() < limits.ishiyama ? k_rocks : k_may_overturn;
}

namespace {

constexpr double k_as_rigid = 0.99;  // of the push that it withstands on rigid contacts

/// Towards the nearer edge across the first shake of a body that stands freely; none: it has none.
std::optional<study::Standing> nearest_standing(const Model& model, const Parameters& parameters, int body) {
  if (!study::why_no_block(model, body).empty()) return std::nullopt;
  std::optional<study::Standing> least;
  for (const double sense : {1., -1.}) {
    const auto standing =
        study::standing_towards(model, parameters, body, sense * parameters.shakes.front().direction);
    if (standing && (!least || standing->rigid_limit() < least->rigid_limit())) least = standing;
  }
  return least;
}

}  // namespace

std::optional<CriteriaLimits> limits_of(const Player& player, int body) {
  const Parameters& parameters = player.parameters();
  if (!has_limits(player.scene().setup.model, parameters, body)) return std::nullopt;
  study::Standing standing = *nearest_standing(player.scene().setup.model, parameters, body);
  const auto row = player.row();
  const bool planar = row && row->level[static_cast<std::size_t>(body)] ==
                                 static_cast<std::uint8_t>(ModelLevel::planar);  // on a hard floor
  const double rigid = study::west_acceleration(standing), base = standing.base;
  const double share = study::tipping_limit(standing, parameters.contact) / standing.rigid_limit();
  if (!planar && share < k_as_rigid) standing.base *= share;
  return CriteriaLimits{study::west_acceleration(standing), rigid, study::ishiyama_velocity(standing), base,
                        standing.height};
}

bool has_limits(const Model& model, const Parameters& parameters, int body) {
  const auto standing = nearest_standing(model, parameters, body);
  return standing && !study::slides_first(model, parameters, body, standing->rigid_limit());
}

std::string slides_in_words(const Model& model, const Parameters& parameters, int body) {
  const auto standing = nearest_standing(model, parameters, body);
  if (!standing || !study::slides_first(model, parameters, body, standing->rigid_limit())) return "";
  return say(k_slides_first, model.bodies[static_cast<std::size_t>(body)].name, standing->rigid_limit());
}

const Phrase& why_no_limits(const Model& model, const Parameters& parameters, int body) {
  if (!study::why_no_block(model, body).empty()) return k_stands_not_freely;
  return nearest_standing(model, parameters, body) ? k_slides_before : k_shaken_askew;
}

std::string held_in_words(const Player& player, int body) {
  const Model& model = player.scene().setup.model;
  const auto row = player.row();
  std::string names;
  for (std::size_t k = 0; row && k < model.anchors.size(); ++k) {
    const Anchor& anchor = model.anchors[k];
    const float state = row->anchor[k].state;
    const bool in_place = state == io::k_anchor_holds || state == io::k_anchor_slack;
    if (in_place && study::holds(model, anchor, body))
      names += (names.empty() ? "" : say(k_comma)) + anchor.name;
  }
  if (!names.empty()) return say(k_is_held, model.bodies[static_cast<std::size_t>(body)].name, names);
  for (const Wedge& wedge : player.scene().setup.wedges)
    if (wedge.in_place() && wedge.body == body)
      return say(k_is_leaned, model.bodies[static_cast<std::size_t>(body)].name, wedge.name);
  return "";
}

namespace {

constexpr double k_swings = 2;  // periods after which a shake that would have lifted a body has

/// Since when the run that is shown goes on under what it is shaken by now, s; infinite: the floor is still.
double shaken_since(const Player& player) {
  const Shake& shake = player.parameters().shakes.front();
  if (!shake.on) return std::numeric_limits<double>::infinity();
  double since = shake.start + (traits(shake.kind).has_frequency ? shake.taper / shake.frequency : 0);
  for (const LoggedEdit& edit : player.edits())
    if (edit.time <= player.time()) since = std::max(since, edit.time);
  return since;
}

/// Edits of the start are what the run began with.
bool was_changed(const Player& player) {
  return std::ranges::any_of(player.edits(), [&](const LoggedEdit& edit) {
    return edit.step > 0 && edit.time < player.time() && !traits(edit.edit.key).setting;
  });
}

/// Something that holds it was changed.
bool was_fixed_otherwise(const Player& player, int body) {
  const Model& model = player.scene().setup.model;
  return std::ranges::any_of(player.edits(), [&](const LoggedEdit& edit) {
    return traits(edit.edit.key).of == Edit::Of::anchor && edit.time <= player.time() &&
           study::holds(model, model.anchors[static_cast<std::size_t>(edit.edit.index)], body);
  });
}

/// By another body, in a recorded frame up to the instant that is shown.
bool was_touched(const Player& player, int body) {
  const Body& own = player.scene().setup.model.bodies[static_cast<std::size_t>(body)];
  return std::ranges::any_of(player.way(), [&](const RowPtr& row) {
    return row->time <= player.time() && touches_another(own, *row);
  });
}

}  // namespace

std::string difference_in_words(const Player& player, int body, const CriteriaLimits& limits,
                                const ShakePlace& shake) {
  const Phrase& said = verdict(limits, shake);
  const auto is_set_here = [&](const LoggedEdit& edit) { return std::abs(edit.time - player.time()) < 1e-9; };
  if (std::ranges::any_of(player.history().edits, is_set_here)) return "";  // no step was taken with it
  bool lifted = false, overturned = false;
  for (const io::RecordedEvent& event : player.events()) {
    if (event.event.body != body || event.time > player.time()) continue;
    lifted = lifted || event.event.kind == Event::Kind::uplift;
    overturned = overturned || event.event.kind == Event::Kind::overturn;
  }
  const std::string& name = player.scene().setup.model.bodies[static_cast<std::size_t>(body)].name;
  const bool soft = limits.west < limits.rigid;
  if (soft && &said != &k_stays && !lifted && !was_fixed_otherwise(player, body) &&
      player.time() >= shaken_since(player) + k_swings / shake.frequency)
    return say(k_has_not_lifted, name);
  if (&said == &k_may_overturn || !(overturned || (lifted && &said == &k_stays))) return "";
  std::string words = say(k_run_differs, name, say(overturned ? k_has_overturned : k_has_lifted));
  if (soft) words += say(k_differs_soft);
  if (was_changed(player)) words += say(k_differs_changed);
  if (was_touched(player, body)) words += say(k_differs_others);
  return words + say(k_full_stop);
}

}  // namespace topple::app
