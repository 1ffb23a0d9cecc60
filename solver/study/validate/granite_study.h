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

/// The runs of predictions. `fitted_here`: on these tests, for which those of the fit tell how many of its
/// rocks fall.
int prediction_cases(const std::vector<GraniteTest>& tests, bool fitted_here);
std::string run_prediction_case(const std::vector<GraniteTest>& tests, const GraniteFit& fit,
                                bool fitted_here, int k, const std::function<bool()>& give_up);

/// A share right beside how sure that is.
struct Verdicts {
  std::vector<bool> falls;
  Scores scores;
};

/// One half of the tests predicted by the other.
struct HalfScores {
  Scores scores, plain, threshold, never;
  int only_model = 0, only_plain = 0;  ///< right, the other not

  /// The plain block is right where the model is not so much more often than the reverse that 95 % do not
  /// hold an even chance.
  bool behind_plain() const {
    return only_plain > 0 && wilson(only_plain, only_model + only_plain).low > 0.5;
  }
};

struct RockResults {
  std::vector<Forecast> forecasts;  ///< of each test; by the other folds where it was fitted here
  Scores scores, in_sample;         ///< in_sample: by what was fitted on all of them
  /// Whether the input times 0.95 to 1.05 leaves the verdict of the median rock as it is.
  std::vector<bool> sure;
  Scores of_sure, of_open;  ///< count 0: there is none
  Verdicts never, threshold, plain;
  Verdicts median, rigid;          ///< of the median rock, as a planar block and as a body of the rigid model
  double agreement = 0;            ///< of these two, share of tests
  std::vector<HalfScores> halves;  ///< as halves_of(); empty where nothing was fitted here
  double expected_missed = 0;      ///< were every probability true: sum of min(p, 1 - p)
  Fragility measured, computed;    ///< over the peak velocity, m/s
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

}  // namespace topple::study
