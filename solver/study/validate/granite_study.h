// Shake-table tests of rocks against what is computed of them: cases, forecasts, their scores.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "solver/study/overturn/fragility.h"
#include "solver/study/validate/granite_fit.h"
#include "solver/study/validate/scores.h"

namespace topple::study {

/// What is known of the rocks before tests are predicted.
struct GraniteFit {
  std::array<RockFindings, k_rocks> rocks;  ///< read from a file: without what each test was found to be
  int tests = 0;                            ///< that it was made of
};

/// Fewest tests that a fit is made of.
inline constexpr std::size_t k_fewest_tests = 20;
/// Throws io::InputError when they are fewer.
void expect_enough(const std::vector<GraniteTest>& tests);

/// The runs of a fit, cases 0..fit_cases()-1. A row holds what became of one rock in every test.
int fit_cases();
std::string run_fit_case(const std::vector<GraniteTest>& tests, int k, const std::function<bool()>& give_up);
GraniteFit fit_granite(const std::vector<GraniteTest>& tests, const std::vector<std::string>& rows);

nlohmann::ordered_json fit_as_json(const GraniteFit& fit);
/// Throws io::InputError, with `name`, on what is no such file.
GraniteFit fit_from_json(const std::string& text, const std::string& name);

/// The runs of predictions.
int prediction_cases(const std::vector<GraniteTest>& tests);
std::string run_prediction_case(const std::vector<GraniteTest>& tests, const GraniteFit& fit, int k,
                                const std::function<bool()>& give_up);

/// A share right beside how sure that is.
struct Verdicts {
  std::vector<bool> falls;
  Scores scores;
};

struct RockResults {
  std::vector<Forecast> forecasts;  ///< of each test; by the other folds where it was fitted here
  Scores scores, in_sample;         ///< in_sample: by what was fitted on all of them
  /// Whether the input times 0.95 to 1.05 leaves the verdict of the median rock as it is.
  std::vector<bool> sure;
  Scores of_sure, of_open;  ///< count 0: there is none
  Verdicts never, threshold, plain, rigid;
  double agreement = 0;          ///< of the rigid model with the planar one, share of tests
  double expected_missed = 0;    ///< were every probability true: sum of min(p, 1 - p)
  Fragility measured, computed;  ///< over the peak velocity, m/s
};

struct GraniteResults {
  std::array<RockResults, k_rocks> rocks;
  bool fitted_here = false;
  int both_missed = 0;  ///< tests in which the verdicts on all rocks are wrong
};
GraniteResults gather_granite(const std::vector<GraniteTest>& tests, const GraniteFit& fit, bool fitted_here,
                              const std::vector<std::string>& rows);

nlohmann::ordered_json granite_rows(const std::vector<GraniteTest>& tests, const GraniteResults& results);
nlohmann::ordered_json granite_json(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                                    const GraniteResults& results);

/// What a fit and its rows depend on: a hash of the tests.
std::string fingerprint(const std::vector<GraniteTest>& tests);

/// A rock in the rigid model, which lands as Housner has it: whether it falls. `rock.restitution` is not its.
bool rigid_falls(const RockTraits& traits, const Rock& rock, const GraniteTest& test,
                 const std::function<bool()>& give_up);

}  // namespace topple::study
