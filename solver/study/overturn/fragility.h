// Probability of overturning against intensity: a lognormal distribution by maximum likelihood.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/study/common/spread.h"

namespace topple::study {

/// Runs at one intensity.
struct Level {
  double intensity;  ///< > 0
  int runs, hits;    ///< hits: runs in which a body overturned
};

/// P = Phi(ln(a/median)/beta).
struct Lognormal {
  double median, beta;  ///< unit of the intensity; standard deviation of its logarithm
  double median_error;  ///< standard error, the median times that of its logarithm (Fisher's information)
  double beta_error;    ///< likewise
  double deviance;      ///< 2 sum of k ln(k/(n P)) + (n - k) ln((n - k)/(n (1 - P)))
  int freedom;          ///< levels with runs, less two: what the deviance is near when the curve fits

  double probability(double intensity) const;
  /// 95 % by the standard errors of the logarithms of both.
  Interval median_interval() const;
  Interval beta_interval() const;
  /// How many times as far as by chance shares scatter about the curve; 1: where chance explains it.
  double scatter() const;
};

struct Fragility {
  std::optional<Lognormal> fit;
  std::string why_not;  ///< "": there is a fit
};

/// Maximum likelihood by Fisher's scoring of the probit regression on ln a. There is no finite one when no
/// run or every run hits, when all intensities with hits are at or above all those with misses, or when the
/// share of hits does not grow. Source: J. W. Baker, Earthquake Spectra 31, 2015, 579-599; for when one
/// exists, M. J. Silvapulle, J. R. Stat. Soc. B 43, 1981, 310-313.
/// `verb`: what a run that hits does, for why_not.
Fragility fit_fragility(const std::vector<Level>& levels, const std::string& verb = "overturns");

}  // namespace topple::study
