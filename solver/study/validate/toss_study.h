// Tossed cubes against what is computed of them: settings, scores, what is fitted.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/study/common/spread.h"
#include "solver/study/validate/toss_run.h"

namespace topple::study {

/// The settings among which friction and restitution are fitted: that of the least mean over the tosses of
///   min(position over the edge + angle in rad, k_astray),
/// both means over time. One that went another way, or failed, counts as k_astray, wherever it ended.
const std::vector<CubeContact>& contact_grid();
inline constexpr double k_astray = 0.5;

struct TossFit {
  CubeContact contact, low, high;  ///< low, high: 95 % each for itself, by drawing tosses anew
  double offset = 0;               ///< m, of the data's zero off the board
  int tosses = 0;                  ///< that it was made of
};

/// What became of the tosses under one setting; none: the run failed.
using TossOutcomes = std::vector<std::optional<TossErrors>>;

/// Row of one setting: all tosses; empty: gave up.
std::string run_toss_case(const std::vector<Toss>& tosses, const CubeContact& contact, double offset,
                          const std::function<bool()>& give_up);
TossOutcomes outcomes_in(const std::string& row);

/// Index of the setting that is best on the tosses of weight > 0.
std::size_t best_contact(const std::vector<TossOutcomes>& grid, const std::vector<double>& weight);
/// `grid`: outcomes of contact_grid().
TossFit fit_tosses(const std::vector<TossOutcomes>& grid, double offset);
/// Each toss under what is best on the other nine tenths.
TossOutcomes cross_validated(const std::vector<TossOutcomes>& grid);

/// Median and 90 % of something.
struct Quantiles {
  double median = 0, ninetieth = 0;
};
Quantiles quantiles_of(std::vector<double> values);

struct TossScores {
  int tosses = 0, failed = 0, face_right = 0;
  Interval face_interval{};                                  ///< 95 % (Wilson), of all tosses
  Quantiles place, place_share, yaw, rest, position, angle;  ///< m, 1, deg, s, m, deg
  struct Instant {
    double time;
    int tosses;
    Quantiles position, angle;  ///< m, deg
  };
  std::vector<Instant> over_time;
};
TossScores scored_tosses(const TossOutcomes& outcomes);

/// Under what was fitted and under what the authors of the data state.
struct TossResults {
  TossOutcomes fitted, published;
  TossScores of_fitted, of_published;
  bool fitted_here = false;
};

nlohmann::ordered_json scores_json(const TossScores& scores);
nlohmann::ordered_json tosses_json(const TossFit& fit, const TossResults& results);
nlohmann::ordered_json toss_rows(const std::vector<Toss>& tosses, const TossResults& results);
nlohmann::ordered_json fit_as_json(const TossFit& fit);
/// Throws io::InputError, with `name`, on what is no such file.
TossFit toss_fit_from_json(const std::string& text, const std::string& name);
std::string fingerprint(const std::vector<Toss>& tosses);

}  // namespace topple::study
