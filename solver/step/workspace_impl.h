// What Workspace keeps between steps, for the sources of the step alone.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "solver/body/candidates.h"
#include "solver/body/model_switch.h"
#include "solver/body/parts.h"
#include "solver/step/workspace.h"

namespace topple {

struct Workspace::Impl {
  explicit Impl(const Model& model) : parts(model), models(model), search(model) {
    forces.contacts.reserve(model.contact_points.size() * model.planes.size());
  }
  /// Forgets what holds for the earlier parameters only.
  void invalidate_caches(const Parameters& now) {
    if (parameters == now) return;
    parameters = now;
    models.forget();
    parts.forget_parameters();
    reached.reset();
    forget_limits();
  }
  void forget_limits() {
    explicit_limit.reset();
    undamped_limit.reset();
  }

  /// Of a state that `parts` were arranged for; found once until the caches are invalidated.
  const std::optional<ExplicitLimit>& find_explicit_limit(const Parameters& now, const State& state) {
    if (!explicit_limit) explicit_limit = parts.explicit_limit(now, state);
    return explicit_limit;
  }
  /// As above, without damping; s. Infinite without frames.
  double find_undamped_limit(const Parameters& now, const State& state) {
    if (!undamped_limit) {
      const std::optional<ExplicitLimit> limit = parts.explicit_limit(now, state, 0);
      undamped_limit = limit ? limit->step : std::numeric_limits<double>::infinity();
    }
    return *undamped_limit;
  }
  /// Whether a step needs the per-node arrays: there are frames, or no step from such a state was tried yet.
  bool moves_nodes(const State& state) const {
    return parts.moves_nodes() || next.position.size() != state.position.size();
  }

  Parts parts;
  ModelSwitch models;
  NearSearch search;
  Approach approach;
  std::vector<PartScratch> scratches{1};        // per worker
  std::vector<PartOutcome> outcomes;            // per part, of the newest step
  std::optional<Parameters> parameters;         // seen last; for them hold:
  std::optional<StepInputs> reached;            //   the end of the last step that was tried,
  bool jumps = false;                           //   where the floor's acceleration jumps
  std::optional<ExplicitLimit> explicit_limit;  //   of the frames there are
  std::optional<double> undamped_limit;         //   likewise, s
  std::vector<char> changed;                    // per body: one of its anchors was switched or broke
  ParallelFor parallel;
  Profile profile;
  Forces forces;
  State next;
  int most_iterations = 0;  // of one part in the newest step
};

}  // namespace topple
