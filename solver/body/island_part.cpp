#include "solver/body/island_part.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solver/body/reduced_part.h"
#include "solver/reduced/bodies_at_rest.h"
#include "solver/state/profile.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_likely = 1.5;    // times the travel that the motion at the start says: may be more
constexpr double k_resolved = 0.3;  // rad, of the bounce of two members, in a step after a touch
constexpr std::size_t k_sets = 32;  // of bodies that were advanced together, whose matrices are kept

// What a node of a body travels within h, s, as it moves at `s`, m.
double likely_travel(const Body& body, const BodyState& s, double h) {
  const double spin = s.angular_velocity.norm(),
               turning = s.moment.norm() / body.inertia.diagonal().minCoeff() + spin * spin;
  return h * (s.velocity.norm() + body.reach * spin) +
         h * h / 2 * (s.force.norm() / body.mass + body.reach * turning);
}

std::vector<int> indices(const std::vector<ModelBody>& bodies) {
  std::vector<int> all;
  for (const ModelBody& body : bodies) all.push_back(body.index);
  return all;
}

}  // namespace

IslandPart::IslandPart(const Model& model, std::vector<ModelBody> bodies,
                       std::span<const ElementPair> candidate_pairs, std::span<const BodyState> states,
                       std::vector<SectionForces>& sections)
    : model_(model),
      bodies_(std::move(bodies)),
      coupling_(model, indices(bodies_), candidate_pairs, states),
      sections_(sections) {}

bool IslandPart::has(const std::vector<char>& marked) const {
  return std::ranges::any_of(bodies_, [&](const ModelBody& body) { return marked[body.index]; });
}

void IslandPart::place(const State& state) {
  coupling_.place_held(state);
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b)
    coupling_.place(b, state.bodies[bodies_[b].index]);
}

// All that touches between members at `state`.
void IslandPart::find(const StepInputs& now, const State& state) {
  place(state);
  sticks_.load(state, coupling_.pairs());
  for (MemberPair& pair : coupling_.pairs())
    for (int k = 0; k < 4; ++k) pair.start[k] = coupling_.position()[pair.node[k]];
  find_member_contacts(now.law, coupling_.pairs(), coupling_.position(), coupling_.velocity(),
                       coupling_.position(), now_);
}

StepStatus IslandPart::settle(const Parameters& parameters, State& state, PartScratch&) {
  for (const auto& [index, body] : bodies_) body->remember(state.anchors);
  place(state);
  sticks_.load(state, coupling_.pairs());
  for (MemberPair& pair : coupling_.pairs())
    for (int k = 0; k < 4; ++k) pair.start[k] = coupling_.position()[pair.node[k]];
  const StepStatus status = settle_bodies(bodies_, &coupling_, parameters, state);
  find_member_contacts(law_at_rest(parameters.contact), coupling_.pairs(), coupling_.position(),
                       coupling_.velocity(), coupling_.position(), now_);
  sticks_.store(now_.touches, coupling_.pairs(), state);
  return status;
}

BodyEnergy IslandPart::balance(const Parameters& parameters, const StepInputs& now,
                               const std::vector<char>& marked, State& state) {
  if (!has(marked)) return {};
  find(now, state);
  const std::vector<BodyVelocity>& loads = coupling_.loads(now_, coupling_.pairs());
  BodyEnergy held;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    BodyState& s = state.bodies[index];
    body->remember(state.anchors);
    held += body->balance(parameters, now, s, state.stick);
    add_load(loads[b], s);
  }
  held.contact += stored_energy(now.law, now_, coupling_.pairs());
  return held;
}

BodyEnergy IslandPart::energy(const StepInputs& now, const State& state) {
  BodyEnergy held;
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    body->find_contacts(now, state.bodies[index], state.stick);
    held += body->energy(now.law, state.bodies[index]);
  }
  find(now, state);
  held.contact += stored_energy(now.law, now_, coupling_.pairs());
  return held;
}

// f(first, one past the last) of the springs of each body's contact points.
template <class AnyState, class F>
void IslandPart::each_stick(AnyState& state, F f) const {
  const auto planes = static_cast<std::ptrdiff_t>(model_.planes.size());
  for (const ModelBody& one : bodies_) {
    const Body& body = model_.bodies[one.index];
    const auto first = state.stick.begin() + body.first_contact_point * planes;
    f(first, first + body.contact_point_count * planes);
  }
}

void IslandPart::begin(const StepSpan& span, const State& next) {
  place(next);
  sticks_.load(next, coupling_.pairs());
  const std::vector<Vec3>& position = coupling_.position();
  start_.position = position;
  start_.bodies.clear();
  start_.stick.clear();
  std::vector<double> travel;
  for (const auto& [index, body] : bodies_) {
    body->remember(next.anchors);
    start_.bodies.push_back(next.bodies[index]);
    travel.push_back(k_likely * likely_travel(model_.bodies[index], next.bodies[index], span.h));
  }
  each_stick(next, [&](auto first, auto last) { start_.stick.insert(start_.stick.end(), first, last); });
  start_.gap.clear();
  start_.close.clear();
  for (MemberPair& pair : coupling_.pairs()) {
    for (int k = 0; k < 4; ++k) pair.start[k] = position[pair.node[k]];
    double way = 0;
    for (const int body : coupling_.bodies_of(pair)) way += body < 0 ? 0 : travel[body];
    start_.gap.push_back(coupling_.gap(pair));
    start_.close.push_back(start_.gap.back() <= way);
  }
}

void IslandPart::begin_again(State& next) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) next.bodies[bodies_[b].index] = start_.bodies[b];
  auto from = start_.stick.begin();
  each_stick(next, [&](auto first, auto last) {
    std::copy(from, from + (last - first), first);
    from += last - first;
  });
}

CoupledBodies& IslandPart::coupled(std::vector<int> which) {
  const auto known =
      std::ranges::find_if(coupled_, [&](const auto& bodies) { return bodies->which() == which; });
  if (known != coupled_.end()) return **known;
  if (coupled_.size() == k_sets) coupled_.erase(coupled_.begin());
  return *coupled_.emplace_back(std::make_unique<CoupledBodies>(bodies_, std::move(which), coupling_));
}

// Bodies that close pairs connect together, the others each alone.
void IslandPart::advance_once(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  const int count = static_cast<int>(bodies_.size());
  const std::span<MemberPair> pairs = coupling_.pairs();
  std::vector<int> parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int b) {
    while (parent[b] != b) b = parent[b] = parent[parent[b]];
    return b;
  };
  std::vector<std::vector<int>> which(count), own_pairs(count);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!start_.close[p]) continue;
    const auto [a, b] = coupling_.bodies_of(pairs[p]);
    if (a < 0 || b < 0) continue;
    const int ra = root(a), rb = root(b);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  for (int b = 0; b < count; ++b) which[root(b)].push_back(b);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [a, b] = coupling_.bodies_of(pairs[p]);
    if (start_.close[p]) own_pairs[root(std::max(a, b))].push_back(static_cast<int>(p));
  }
  now_.clear();
  StepStatus& status = outcome.status;
  for (int b = 0; b < count; ++b) {
    if (which[b].empty()) continue;
    const auto& [index, body] = bodies_[b];
    for (const int own : which[b])
      bodies_[own].body->find_contacts(span.start, next.bodies[bodies_[own].index], next.stick);
    if (own_pairs[b].empty()) {
      status.kind = body->advance(span.parameters, span.start, span.end, span.h, next.bodies[index],
                                  next.stick, outcome.exchanged, scratch.reduced);
    } else {
      std::vector<MemberPair> close;
      for (const int p : own_pairs[b]) close.push_back(pairs[p]);
      CoupledBodies& together = coupled(which[b]);
      status.kind = together.advance(span, std::move(close), next, outcome.exchanged);
      for (MemberTouch touch : together.contacts().touches) {
        touch.pair = own_pairs[b][touch.pair];
        now_.touches.push_back(touch);
      }
    }
    if (!status.ok()) {
      status.time = span.end.time;
      status.body = index;
      return;
    }
  }
}

// Marks pairs as close that were not taken for it and may have closed.
bool IslandPart::missed(const State& next) {
  bool any = false;
  place(next);
  std::vector<double> travel(bodies_.size(), 0.);
  coupling_.each_node([&](int node, int body) {
    if (body >= 0)
      travel[body] = std::max(travel[body], (coupling_.position()[node] - start_.position[node]).norm());
  });
  for (std::size_t p = 0; p < start_.gap.size(); ++p) {
    double way = 0;
    for (const int body : coupling_.bodies_of(coupling_.pairs()[p])) way += body < 0 ? 0 : travel[body];
    if (start_.close[p] || !(start_.gap[p] <= way)) continue;
    start_.close[p] = true;
    any = true;
  }
  return any;
}

void IslandPart::advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  const InPhase phase(scratch.frame.profile, Phase::reduced);
  begin(span, next);
  for (;;) {
    outcome = {};
    advance_once(span, next, scratch, outcome);
    if (!outcome.status.ok()) return;
    if (!missed(next)) break;
    begin_again(next);
    place(next);
  }
  sticks_.store(now_.touches, coupling_.pairs(), next);
  for (const auto& [index, body] : bodies_) outcome.held += body->energy(span.end.law, next.bodies[index]);
  outcome.held.contact += stored_energy(span.end.law, now_, coupling_.pairs());
}

double IslandPart::time_limit(const Parameters& parameters, const State& state) {
  const ContactLaw law = contact_law(parameters, state.time);
  double limit = k_longest_step;
  place(state);
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    limit = std::min(limit, body->look_ahead(law, state.bodies[index]));
  }
  double first = limit;
  for (const MemberPair& pair : coupling_.pairs()) {
    first = std::min(first, k_resolved * std::sqrt(pair.mass * pair.L / (law.alpha * std::max(1., law.q))));
    if (coupling_.gap(pair) > 0) continue;
    for (const int b : coupling_.bodies_of(pair)) {
      if (b < 0) continue;
      if (const double substep = state.bodies[bodies_[b].index].substep; substep > 0)
        limit = std::min(limit, substep);
    }
  }
  if (const double touch = coupling_.next_touch(coupling_.pairs(), limit); touch < limit)
    limit = std::max(touch, std::min(limit, first));
  return limit;
}

void IslandPart::list_forces(const StepInputs& now, const State& state, Forces& forces) {
  for (const auto& [index, body] : bodies_) {
    body->remember(state.anchors);
    body->find_contacts(now, state.bodies[index], state.stick);
    body->section_forces(state.bodies[index], sections_);
    body->list_contacts(forces.contacts);
  }
  find(now, state);
  for (const MemberTouch& touch : now_.touches) forces.members.push_back(coupling_.force(touch));
}

HardestContact IslandPart::hardest_contact(const HardestContact& hardest) {
  HardestContact found = hardest;
  for (const MemberTouch& touch : now_.touches) {
    if (!(touch.out.normal > found.force)) continue;
    const int element = coupling_.pairs()[touch.pair].elements.a, node = model_.elements[element].node[0];
    found = {touch.out.normal, model_.node_body[node], node, element};
  }
  return hardest_on_planes(bodies_, found);
}

}  // namespace topple
