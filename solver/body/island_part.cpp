#include "solver/body/island_part.h"

#include <algorithm>
#include <utility>

#include "solver/math/disjoint_sets.h"
#include "solver/math/ranges.h"
#include "solver/reduced/bodies_at_rest.h"
#include "solver/state/profile.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_likely = 1.5;    // times the travel that the motion at the start says: may be more
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
                       std::span<const ElementPair> candidate_pairs, std::span<const BodyState> states)
    : ReducedPart(std::move(bodies)),
      model_(model),
      coupling_(model, indices(bodies_), candidate_pairs, states),
      rigid_(bodies_, coupling_) {}

void IslandPart::place(const State& state) {
  rigid_.forget();
  impulses_.reset();
  coupling_.ties().remember(state.anchors);
  coupling_.place_held(state);
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b)
    coupling_.place(b, state.bodies[bodies_[b].index]);
}

// Places the members, whose pairs start there with the springs of `state`.
void IslandPart::start_pairs(const State& state) {
  place(state);
  sticks_.load(state, coupling_.pairs());
  for (MemberPair& pair : coupling_.pairs()) pair.ahead = 0;
  coupling_.start();
}

// All that touches between members at `state`.
void IslandPart::find(const StepInputs& now, const State& state) {
  if (rigid_.knows(now.law, state)) {
    now_ = &rigid_.contacts();
    return;
  }
  now_ = &found_;
  start_pairs(state);
  find_member_contacts(now.law, coupling_.pairs(), coupling_.position(), coupling_.velocity(),
                       coupling_.position(), found_);
}

StepStatus IslandPart::settle(const Parameters& parameters, State& state, PartScratch&) {
  for (const auto& [index, body] : bodies_) body->remember(state.anchors);
  start_pairs(state);
  const StepStatus status = settle_bodies(bodies_, &coupling_, parameters, state);
  find_member_contacts(law_at_rest(parameters.contact), coupling_.pairs(), coupling_.position(),
                       coupling_.velocity(), coupling_.position(), found_);
  now_ = &found_;
  sticks_.store(found_.touches, coupling_.pairs());
  return status;
}

BodyEnergy IslandPart::balance(const Parameters& parameters, const StepInputs& now,
                               const std::vector<char>& marked, State& state) {
  if (!has(marked)) return {};
  find(now, state);
  const std::vector<BodyVelocity>& loads = coupling_.loads(*now_, coupling_.pairs());
  BodyEnergy held;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    BodyState& s = state.bodies[index];
    body->remember(state.anchors);
    held += body->balance(parameters, now, s, state.stick);
    add_load(loads[b], s);
  }
  held.anchor += coupling_.ties().energy();
  held.contact += stored_energy(now.law, *now_, coupling_.pairs());
  return held;
}

BodyEnergy IslandPart::energy(const StepInputs& now, const State& state) {
  BodyEnergy held = ReducedPart::energy(now, state);
  find(now, state);
  held.anchor += coupling_.ties().energy();
  held.contact += stored_energy(now.law, *now_, coupling_.pairs());
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
  start_pairs(next);
  start_.position = coupling_.position();
  start_.bodies.clear();
  start_.stick.clear();
  std::vector<double> travel;
  for (const auto& [index, body] : bodies_) {
    start_.bodies.push_back(next.bodies[index]);
    travel.push_back(k_likely * likely_travel(model_.bodies[index], next.bodies[index], span.h));
  }
  each_stick(next, [&](auto first, auto last) { start_.stick.insert(start_.stick.end(), first, last); });
  start_.gap.clear();
  start_.close.clear();
  for (const MemberPair& pair : coupling_.pairs()) {
    double way = 0;
    for (const int body : coupling_.bodies_of(pair)) way += body < 0 ? 0 : travel[body];
    start_.gap.push_back(pair.gap);
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
  const auto known = ranges::find_if(coupled_, [&](const auto& bodies) { return bodies->which() == which; });
  if (known != coupled_.end()) return **known;
  if (coupled_.size() == k_sets) coupled_.erase(coupled_.begin());
  return *coupled_.emplace_back(std::make_unique<CoupledBodies>(bodies_, std::move(which), coupling_));
}

// Bodies that close pairs connect together, the others each alone.
void IslandPart::advance_once(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  const int count = static_cast<int>(bodies_.size());
  const std::span<MemberPair> pairs = coupling_.pairs();
  DisjointSets sets(count);
  std::vector<std::vector<int>> which(count), own_pairs(count);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (!start_.close[p]) continue;
    const auto [a, b] = coupling_.bodies_of(pairs[p]);
    if (a >= 0 && b >= 0) sets.join(a, b);
  }
  coupling_.ties().each_in_place([&](int a, int b) { sets.join(a, b); });
  for (int b = 0; b < count; ++b) which[sets.first_of(b)].push_back(b);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [a, b] = coupling_.bodies_of(pairs[p]);
    if (start_.close[p]) own_pairs[sets.first_of(std::max(a, b))].push_back(static_cast<int>(p));
  }
  found_.clear();
  now_ = &found_;
  StepStatus& status = outcome.status;
  for (int b = 0; b < count; ++b) {
    if (which[b].empty()) continue;
    const auto& [index, body] = bodies_[b];
    for (const int own : which[b])
      bodies_[own].body->find_contacts(span.start, next.bodies[bodies_[own].index], next.stick);
    if (own_pairs[b].empty() && which[b].size() == 1) {
      status.kind = body->advance(span.parameters, span.start, span.end, span.h, next.bodies[index],
                                  next.stick, outcome.exchanged, scratch.reduced);
    } else {
      std::vector<MemberPair> close;
      for (const int p : own_pairs[b]) close.push_back(pairs[p]);
      CoupledBodies& together = coupled(which[b]);
      status.kind = together.advance(span, std::move(close), next, outcome.exchanged);
      for (MemberTouch touch : together.contacts().touches) {
        touch.pair = own_pairs[b][touch.pair];
        found_.touches.push_back(touch);
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
  for (const auto& [index, body] : bodies_) {
    body->remember(next.anchors);
    body->take(span.start.pulls);
  }
  coupling_.ties().remember(next.anchors);
  if (rigid_.takes(span.parameters, span.start.law, span.end.law, next))
    advance_by_impulses(span, next, outcome);
  else
    advance_by_substeps(span, next, scratch, outcome);
  if (!outcome.status.ok()) return;
  for (const auto& [index, body] : bodies_) outcome.held += body->energy(span.end.law, next.bodies[index]);
  outcome.held.anchor += coupling_.ties().energy();
  outcome.held.contact += stored_energy(span.end.law, *now_, coupling_.pairs());
}

void IslandPart::advance_by_impulses(const StepSpan& span, State& next, PartOutcome& outcome) {
  for (const auto& [index, body] : bodies_) body->find_contacts(span.start, next.bodies[index], next.stick);
  outcome.status.kind = rigid_.advance(span, next, sticks_, outcome.exchanged);
  outcome.status.time = span.end.time;
  outcome.status.body = bodies_.front().index;
  now_ = &rigid_.contacts();
  if (outcome.status.ok()) impulses_ = {span.start.time, span.end.time};
}

void IslandPart::advance_by_substeps(const StepSpan& span, State& next, PartScratch& scratch,
                                     PartOutcome& outcome) {
  begin(span, next);
  for (;;) {
    outcome = {};
    advance_once(span, next, scratch, outcome);
    if (!outcome.status.ok()) return;
    if (!missed(next)) break;
    begin_again(next);
    place(next);
  }
  sticks_.store(found_.touches, coupling_.pairs());
}

double IslandPart::time_limit(const Parameters& parameters, const State& state) {
  for (const auto& [index, body] : bodies_) body->remember(state.anchors);
  coupling_.ties().remember(state.anchors);
  if (const ContactLaw now = contact_law(parameters, state.time); rigid_.takes(parameters, now, now, state))
    return rigid_.time_limit(parameters, state);
  double limit = ReducedPart::time_limit(parameters, state);
  place(state);
  coupling_.start();
  for (const MemberPair& pair : coupling_.pairs()) {
    if (pair.gap > 0) continue;
    for (const int b : coupling_.bodies_of(pair)) {
      const double substep = b < 0 ? 0 : state.bodies[bodies_[b].index].substep;
      if (substep > 0) limit = std::min(limit, substep);
    }
  }
  const double touch = coupling_.next_touch(coupling_.pairs(), limit);
  if (!(touch < limit)) return limit;
  const ContactLaw law = contact_law(parameters, state.time);
  return std::max(touch, std::min(limit, first_substep(law, coupling_.pairs())));
}

void IslandPart::find_forces(const StepInputs& now, const State& state, bool with_members) {
  ReducedPart::find_forces(now, state, with_members);
  if (!with_members) return;
  find(now, state);
  const auto bends = [&](const ModelBody& b) { return traits(state.bodies[b.index].level).has_modes; };
  if (ranges::none_of(bodies_, bends)) return;
  for (const MemberTouch& touch : now_->touches) {
    const MemberForce force = member_force(touch, coupling_.pairs()[touch.pair]);
    const auto [a, b] = coupling_.bodies_of(coupling_.pairs()[touch.pair]);
    const auto push = [&](int body, int part, double t, double u, const Vec3& by) {
      if (body < 0) return;
      each_share(model_, part, t, u,
                 [&](int node, double share) { bodies_[body].body->add_member_force(node, share * by); });
    };
    push(a, force.elements.a, force.s, 0, force.force);
    push(b, force.elements.b, force.t, force.u, -force.force);
  }
  coupling_.ties().each_force([&](int node, const Vec3& force) {
    const int body = model_.node_body[node];
    ranges::find(bodies_, body, &ModelBody::index)->body->add_member_force(node, force);
  });
}

void IslandPart::list_forces(const Parameters& parameters, const StepInputs& now, const State& state,
                             Forces& forces) {
  // All through a step by impulses contacts push as they do at its end: where its bodies are on the way tells
  // nothing of that.
  if (impulses_ && impulses_->start < state.time && state.time < impulses_->end) {
    for (const auto& [index, body] : bodies_) body->list_contacts(forces.contacts);
  } else {
    ReducedPart::list_forces(parameters, now, state, forces);
  }
  forces.add(*now_, coupling_.pairs());
}

HardestContact IslandPart::hardest_contact(const HardestContact& hardest) {
  HardestContact found = hardest;
  for (const MemberTouch& touch : now_->touches) {
    if (!(touch.out.normal > found.force)) continue;
    const int element = coupling_.pairs()[touch.pair].elements.a, node = model_.elements[element].node[0];
    found = {touch.out.normal, model_.node_body[node], node, element};
  }
  return ReducedPart::hardest_contact(found);
}

}  // namespace topple
