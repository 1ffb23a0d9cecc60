#include "solver/body/islands.h"

#include <algorithm>

#include "solver/math/disjoint_sets.h"
#include "solver/math/ranges.h"

namespace topple {

Islands::Islands(const Model& model)
    : model_(model), held_(held_bodies(model)), alone_(model.bodies.size()) {}

std::vector<TiedBodies> tied_bodies(const Model& model, const State& state) {
  std::vector<TiedBodies> tied;
  for (std::size_t k = 0; k < model.anchors.size(); ++k)
    if (model.anchors[k].other.body >= 0 && state.anchors[k].hold == AnchorHold::in_place)
      tied.push_back({model.anchors[k].body, model.anchors[k].other.body});
  return tied;
}

std::vector<Island> Islands::divide(std::span<const ElementPair> candidate_pairs,
                                    const std::vector<TiedBodies>& tied) const {
  const int count = static_cast<int>(model_.bodies.size());
  DisjointSets sets(count);
  for (const ElementPair& pair : candidate_pairs) {
    const int a = body_of(model_, pair.a), b = body_of(model_, pair.b);
    if (!held_[a] && !held_[b]) sets.join(a, b);
  }
  for (const auto& [a, b] : tied) sets.join(a, b);
  std::vector<Island> islands(count);
  for (int b = 0; b < count; ++b)
    if (!held_[b]) islands[sets.first_of(b)].bodies.push_back(b);
  for (const ElementPair& pair : candidate_pairs) {
    const int a = body_of(model_, pair.a);
    islands[sets.first_of(held_[a] ? body_of(model_, pair.b) : a)].candidate_pairs.push_back(pair);
  }
  std::erase_if(islands, [](const Island& island) { return island.bodies.empty(); });
  return islands;
}

BodySystem* Islands::alone(int body) {
  if (!alone_[body] && !held_[body]) alone_[body] = std::make_unique<BodySystem>(model_, body);
  return alone_[body].get();
}

BodySystem* Islands::system(const Island& island, const std::vector<int>& rigid) {
  if (island.is_alone()) return alone(island.bodies.front());
  const auto same = ranges::find_if(joined_, [&](const auto& system) {
    return system->bodies == island.bodies && system->candidate_pairs == island.candidate_pairs &&
           ranges::equal(system->rigid, rigid, {}, &RigidInSystem::body);
  });
  if (same != joined_.end()) return same->get();
  return joined_
      .emplace_back(std::make_unique<BodySystem>(model_, island.bodies, island.candidate_pairs, rigid))
      .get();
}

void Islands::keep(const std::vector<BodySystem*>& systems) {
  std::erase_if(joined_,
                [&](const auto& system) { return ranges::find(systems, system.get()) == systems.end(); });
}

}  // namespace topple
