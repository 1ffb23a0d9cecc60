// The alpha that the penalty study recommends, and why.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/study/penalty/penalty.h"

namespace topple::study {

/// What one alpha does, over all bodies.
struct AlphaVerdict {
  double alpha = 0;                 ///< N
  bool complete = false;            ///< every run that its bounds need was made
  std::vector<std::string> kept;    ///< "cabinet: depth at rest 0.44 % of L"
  std::vector<std::string> missed;  ///< likewise
  bool good() const { return complete && missed.empty(); }
  bool undecided() const { return !complete && missed.empty(); }
};

struct Advice {
  /// N. The smallest tried that keeps every bound, as the next larger one does; none: no such alpha, or
  /// `undecided`.
  std::optional<double> alpha;
  bool undecided = false;  ///< none, for runs are missing that would decide it
  /// s, the greatest that resolves its bounce, at most the scene's; none with an adaptive step.
  std::optional<double> time_step;
  bool resolved = false;              ///< the scene's own step does
  std::vector<std::string> reasons;   ///< sentences
  AlphaVerdict of_scene, of_default;  ///< what the scene's alpha and the program's do
};

/// alpha: N, one of PenaltyStudy::alphas.
AlphaVerdict verdict(const PenaltyStudy& study, double alpha);
Advice advise(const PenaltyStudy& study);
nlohmann::ordered_json advice_as_json(const Advice& advice);

/// "50 kgf" of 490.3325 N; four digits.
std::string kgf_text(double alpha);

}  // namespace topple::study
