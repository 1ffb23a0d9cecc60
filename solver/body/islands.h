// Islands: bodies that may touch each other, or that an anchor ties together, are stepped together.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "solver/contact/proximity.h"
#include "solver/frame/body_system.h"
#include "solver/model/model.h"
#include "solver/state/state.h"

namespace topple {

/// Bodies that candidate pairs or anchors connect, in order, or one alone; what happens to them does not
/// depend on the others.
struct Island {
  std::vector<int> bodies;
  std::vector<ElementPair> candidate_pairs;  ///< of them, and with bodies that are held
  /// It has nothing to do with another body, a held one included.
  bool is_alone() const { return candidate_pairs.empty() && bodies.size() == 1; }
  bool operator==(const Island&) const = default;
};

/// Two bodies that an anchor ties together.
using TiedBodies = std::array<int, 2>;

/// Those of the anchors that are in place at `state`, in their order.
std::vector<TiedBodies> tied_bodies(const Model& model, const State& state);

/// Divides the bodies of a model. Those whose nodes are all held by supports are in no island.
class Islands {
 public:
  explicit Islands(const Model& model);
  /// In the order of their first bodies.
  std::vector<Island> divide(std::span<const ElementPair> candidate_pairs,
                             const std::vector<TiedBodies>& tied) const;
  /// An island as one system of equations, in which `rigid` are no frames; those that keep() keeps last.
  BodySystem* system(const Island& island, const std::vector<int>& rigid = {});
  /// One body without the others; nullptr: held.
  BodySystem* alone(int body);
  /// Forgets all systems of several bodies but these.
  void keep(const std::vector<BodySystem*>& systems);

 private:
  const Model& model_;
  const std::vector<bool> held_;
  std::vector<std::unique_ptr<BodySystem>> alone_, joined_;
};

}  // namespace topple
