#include "solver/body/islands.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/body/ladder.h"
#include "solver/math/rotation.h"

namespace topple {
namespace {

constexpr double k_margin = 0.05;  // m, around surfaces: how far bodies come before they are looked for again

}  // namespace

double likely_travel(const Model& model, const State& state, double h) {
  double greatest = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (const BodyState& s = state.bodies[b]; s.rung != Rung::frame) {
      const double reach = body.reach;
      greatest = std::max(greatest, h * (s.velocity.norm() + reach * s.angular_velocity.norm() +
                                         h / 2 * s.force.norm() / body.mass));
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      greatest = std::max(greatest, h * state.velocity[i].norm() + h * h / 2 * state.acceleration[i].norm());
  }
  return greatest;
}

double greatest_travel(const Model& model, const State& from, const State& to) {
  double greatest = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (const BodyState& s = from.bodies[b], &e = to.bodies[b];
        s.rung != Rung::frame && e.rung != Rung::frame) {
      greatest =
          std::max(greatest, (e.position - s.position).norm() +
                                 body.reach * log_quaternion(s.rotation.conjugate() * e.rotation).norm());
      continue;
    }
    if (from.bodies[b].rung != to.bodies[b].rung) continue;  // where it changes nothing moves far
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      greatest = std::max(greatest, (to.position[i] - from.position[i]).norm());
  }
  return greatest;
}

void look_around(const Model& model, NearSearch& search, State& state, double travel) {
  if (model.bodies.size() < 2 || state.near_slack > 2 * travel) return;
  place_nodes(model, state);
  state.near_slack = std::max(k_margin, 4 * travel);
  state.near = search.find(state.position, state.near_slack);
}

Islands::Islands(const Model& model)
    : model_(model),
      held_(held_bodies(model)),
      frame_(model.bodies.size(), false),
      alone_(model.bodies.size()) {}

BodySystem* Islands::alone(int body) {
  if (!alone_[body] && !held_[body]) alone_[body] = std::make_unique<BodySystem>(model_, body);
  return alone_[body].get();
}

BodySystem* Islands::joined(const std::vector<int>& bodies, std::vector<ElementPair> near) {
  const auto same = std::find_if(joined_before_.begin(), joined_before_.end(), [&](const auto& system) {
    return system && system->bodies == bodies && system->near == near;
  });
  joined_.push_back(same != joined_before_.end()
                        ? std::move(*same)
                        : std::make_unique<BodySystem>(model_, bodies, std::move(near)));
  return joined_.back().get();
}

void Islands::arrange(const std::vector<BodyState>& states, const std::vector<ElementPair>& near) {
  const int count = static_cast<int>(model_.bodies.size());
  bool same = near == near_;
  for (int b = 0; b < count; ++b) {
    const bool frame = states[b].rung == Rung::frame && !held_[b];
    same = same && frame == frame_[b];
    frame_[b] = frame;
  }
  if (same) return;
  near_ = near;
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int b) {
    while (parent[b] != b) b = parent[b] = parent[parent[b]];
    return b;
  };
  const auto body_of = [&](int element) { return model_.members[model_.elements[element].member].body; };
  for (const ElementPair& pair : near) {
    const int a = body_of(pair.a), b = body_of(pair.b);
    if (held_[a] || held_[b]) continue;
    const int ra = root(a), rb = root(b);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  std::vector<std::vector<int>> bodies(count);
  std::vector<std::vector<ElementPair>> pairs(count);
  for (int b = 0; b < count; ++b)
    if (frame_[b]) bodies[root(b)].push_back(b);
  for (const ElementPair& pair : near) {
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
}

}  // namespace topple
