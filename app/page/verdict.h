// Who falls, in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/support/language.h"
#include "solver/run/run.h"

namespace topple::app {

/// What became of a piece of furniture.
struct BodyEnd {
  std::string name;
  std::optional<double> overturned;  ///< s
  double peak_tilt = 0;              ///< degrees
  std::optional<double> critical;    ///< degrees, in the direction of that
  bool held = false;                 ///< by an anchor
};

std::vector<BodyEnd> ends_of(const Run& run);

/// "“free” overturns 4.68 s after the start of the run."; the sentence of reports.
std::string verdict_in_words(const std::vector<BodyEnd>& bodies, Language language);

}  // namespace topple::app
