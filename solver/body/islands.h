// Islands: frames that may touch each other are stepped as one system of equations.
#pragma once

#include <memory>
#include <vector>

#include "solver/frame/body_system.h"
#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Connected components of the candidate pairs: what happens in one does not depend on the others. Bodies
/// whose nodes are all held by supports, and those on other levels, are in none.
class Islands {
 public:
  explicit Islands(const Model& model);
  /// Systems of the frames in `bodies` and of `candidate_pairs`, whose bodies are frames or held, in the
  /// order of their first bodies; those that nothing changes are kept. False: nothing changes.
  bool arrange(const std::vector<BodyState>& bodies, const std::vector<ElementPair>& candidate_pairs);
  const std::vector<BodySystem*>& systems() const { return systems_; }
  /// One body without the others, whatever its level; nullptr: held.
  BodySystem* alone(int body);

 private:
  BodySystem* joined(const std::vector<int>& bodies, std::vector<ElementPair> candidate_pairs);

  const Model& model_;
  std::vector<bool> held_;
  std::vector<char> frame_;        // not held
  std::vector<ElementPair> near_;  // pairs of the last arrange
  std::vector<std::unique_ptr<BodySystem>> alone_, joined_, joined_before_;
  std::vector<BodySystem*> systems_;
};

}  // namespace topple
