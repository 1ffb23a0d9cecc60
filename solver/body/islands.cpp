#include "solver/body/islands.h"

#include <algorithm>
#include <numeric>

namespace topple {
Islands::Islands(const Model& model)
    : model_(model),
      held_(held_bodies(model)),
      frame_(model.bodies.size(), false),
      alone_(model.bodies.size()) {}

BodySystem* Islands::alone(int body) {
  if (!alone_[body] && !held_[body]) alone_[body] = std::make_unique<BodySystem>(model_, body);
  return alone_[body].get();
}

BodySystem* Islands::joined(const std::vector<int>& bodies, std::vector<ElementPair> candidate_pairs) {
  const auto same = std::find_if(joined_before_.begin(), joined_before_.end(), [&](const auto& system) {
    return system && system->bodies == bodies && system->candidate_pairs == candidate_pairs;
  });
  joined_.push_back(same != joined_before_.end()
                        ? std::move(*same)
                        : std::make_unique<BodySystem>(model_, bodies, std::move(candidate_pairs)));
  return joined_.back().get();
}

bool Islands::arrange(const std::vector<BodyState>& states, const std::vector<ElementPair>& candidate_pairs) {
  const int count = static_cast<int>(model_.bodies.size());
  bool same = candidate_pairs == near_;
  for (int b = 0; b < count; ++b) {
    const bool frame = states[b].level == ModelLevel::frame && !held_[b];
    same = same && frame == frame_[b];
    frame_[b] = frame;
  }
  if (same) return false;
  near_ = candidate_pairs;
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int b) {
    while (parent[b] != b) b = parent[b] = parent[parent[b]];
    return b;
  };
  const auto body_of = [&](int element) { return model_.members[model_.elements[element].member].body; };
  for (const ElementPair& pair : candidate_pairs) {
    const int a = body_of(pair.a), b = body_of(pair.b);
    if (held_[a] || held_[b]) continue;
    const int ra = root(a), rb = root(b);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  std::vector<std::vector<int>> bodies(count);
  std::vector<std::vector<ElementPair>> pairs(count);
  for (int b = 0; b < count; ++b)
    if (frame_[b]) bodies[root(b)].push_back(b);
  for (const ElementPair& pair : candidate_pairs) {
    const int a = body_of(pair.a);
    pairs[root(held_[a] ? body_of(pair.b) : a)].push_back(pair);
  }
  std::swap(joined_, joined_before_);
  joined_.clear();
  systems_.clear();
  for (int b = 0; b < count; ++b) {
    if (bodies[b].empty()) continue;
    systems_.push_back(pairs[b].empty() ? alone(b) : joined(bodies[b], std::move(pairs[b])));
  }
  joined_before_.clear();
  return true;
}

}  // namespace topple
