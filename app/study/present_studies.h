// Studies of the scene with the parameters as they are now, computed beside the window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/study/sweep.h"
#include "app/support/background.h"
#include "solver/run/edit.h"
#include "solver/study/overturn/neighbourhood.h"
#include "solver/study/precision/precision.h"

namespace topple::app {

/// What is known so far. `failure`: why there is nothing to know; empty: there is.
struct OverturnFound {
  std::string failure;
  std::shared_ptr<const study::OverturnPlan> plan = {};
  study::OverturnMap map = {};
  /// Per point: runs within its cell, where neighbours disagree and the scene is run as planar blocks.
  std::vector<std::optional<study::CellShare>> shares = {};
};
using OverturnSearch = Background<OverturnFound>;

/// Over the usual axes of `topple study overturn`: frequency (of a pulse: duration) and amplitude of the
/// first shake, coarse points first. `planar_only`: nothing but a failure where the scene is not run as
/// planar blocks.
std::unique_ptr<OverturnSearch> search_overturning(const io::Scene& scene, const Parameters& now,
                                                   bool planar_only = false);

/// The work of `topple study overturn`.
MakeWork work_on(const study::OverturnPlan& plan);

/// Like OverturnFound.
struct PrecisionFound {
  std::string failure;
  std::shared_ptr<const study::PrecisionPlan> plan = {};
  std::vector<Parameters> parameters = {};  ///< of each case
  study::PrecisionStudy study = {};
};
using PrecisionSearch = Background<PrecisionFound>;

/// With the scene's own contact alone, cheap settings first, for as long as `topple study precision --quick`.
std::unique_ptr<PrecisionSearch> search_precision(const io::Scene& scene, const Parameters& now);

/// Whether parameters of a model differ in a value that can be edited, but for those that `of_study` names.
bool parameters_differ(const Model& model, const Parameters& a, const Parameters& b,
                       const std::function<bool(Edit::Key key, int index)>& of_study);

}  // namespace topple::app
