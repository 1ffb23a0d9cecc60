// What West's and Ishiyama's criteria say of a body of the scene as it is now, and where the run differs.
#pragma once

#include <numbers>
#include <optional>
#include <string>

#include "app/live/player.h"
#include "app/support/language.h"

namespace topple::app {

/// A shake on the diagram. Of a record the frequency at which a sine has its peak acceleration and velocity.
struct ShakePlace {
  double frequency, amplitude;  ///< Hz, m/s^2
  double share =
      0.5 * std::numbers::inv_pi;  ///< velocity that it gives the floor, over amplitude times period
  double velocity() const { return amplitude * share / frequency; }  ///< m/s
};

/// Of one body, towards the side that tips first.
struct CriteriaLimits {
  double west;          ///< m/s^2, on the contacts of the scene
  double rigid;         ///< m/s^2, on rigid contacts
  double ishiyama;      ///< m/s
  double base, height;  ///< m, from the edge to the centre of gravity, and up to it
};

/// Whether a body stands freely with an edge across the first shake, and lifts there before it slides.
bool has_limits(const Model& model, const Parameters& parameters, int body);

/// Soft contacts: of the block whose base is as much narrower as they take off the steady push that it
/// withstands (study::soft_limit). None: it has no limits.
std::optional<CriteriaLimits> limits_of(const Player& player, int body);

/// k_stays, k_rocks or k_may_overturn.
const Phrase& verdict(const CriteriaLimits& limits, const ShakePlace& shake);

/// Why a body has none: k_stands_not_freely, k_shaken_askew or k_slides_before.
const Phrase& why_no_limits(const Model& model, const Parameters& parameters, int body);

/// That a body with such an edge slides before it lifts. Empty: it does not.
std::string slides_in_words(const Model& model, const Parameters& parameters, int body);

/// That the criteria do not hold of a body that an anchor holds now, or a stopper leans. Empty: none does.
std::string held_in_words(const Player& player, int body);

/// Where the run up to the instant that is shown does not agree with the criteria: how, and why that may be.
/// That soft contacts have not let it lift is told after two periods of the shake as it is. Empty: it agrees.
std::string difference_in_words(const Player& player, int body, const CriteriaLimits& limits,
                                const ShakePlace& shake);

}  // namespace topple::app
