#include "solver/reduced/rigid_island.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>

#include "solver/math/disjoint_sets.h"
#include "solver/math/ranges.h"
#include "solver/reduced/rigid_motion.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_least_tolerance = 1e-3;  // below it TR-BDF2 is cheaper
constexpr double k_step = 7.5;              // over the tolerance, of sqrt(reach/g)
constexpr double k_most_growth = 6;         // of that step, for bodies at rest
constexpr double k_slow = 0.05;             // of sqrt(g reach), speed below which steps grow
constexpr double k_bounce_speed =
    0.05;                            // of sqrt(g reach), along the normal: what strikes faster is resolved
constexpr double k_bounce = 0.25;    // rad in a step, of a bounce that is resolved: a bound of it
constexpr double k_likely = 1.5;     // times the way that the motion at the start says: may be more
constexpr double k_more_way = 2e-4;  // m
constexpr double k_stale = 5e-4;     // m, by which bodies come nearer until a gap is found anew
constexpr double k_most_gap = 0.1;   // m, of pairs, about
constexpr double k_deep = 0.5;       // depth from which a centre line may have passed the other
constexpr std::size_t k_sets = 32;   // not used now, whose matrices are kept
constexpr std::size_t k_places = 5;  // of a pair, see MemberTouch

PackMat3 turned(const BodyState& s) {
  return rotation_matrix(packed(s.rotation));
}
double speed_of(const ReducedBody& body, const BodyState& s) {
  return s.velocity.norm() + body.reach() * s.angular_velocity.norm();
}
// Of a fall through the reach, m/s, about.
double fall_speed(const Parameters& parameters, const ReducedBody& body) {
  return std::sqrt(std::max(parameters.gravity.norm(), 0.01 * k_standard_gravity) * body.reach());
}
// Step of a body that moves, s.
double step_of(const Parameters& parameters, const ReducedBody& body) {
  return k_step * parameters.tolerance * body.reach() / fall_speed(parameters, body);
}

}  // namespace

RigidIsland::RigidIsland(const std::vector<ModelBody>& bodies, MemberCoupling& coupling)
    : bodies_(bodies), coupling_(coupling), buffers_(bodies.size()), place_(bodies.size()) {
  for (const MemberPair& pair : coupling.pairs()) {
    const auto [a, b] = coupling.bodies_of(pair);
    const int first = std::max(a, b), second = std::min(a, b);
    const auto same = [first, second](const BodyPair& both) {
      return both.first == first && both.second == second;
    };
    auto both = ranges::find_if(body_pairs_, same);
    if (both == body_pairs_.end()) {
      body_pairs_.push_back({.first = first, .second = second, .pairs = {}, .near = {}});
      both = body_pairs_.end() - 1;
    }
    both->least_L = std::min(both->least_L, pair.L);
    both->pairs.push_back(static_cast<int>(body_pair_of_.size()));
    body_pair_of_.push_back(static_cast<int>(both - body_pairs_.begin()));
  }
  open_until_.assign(body_pair_of_.size(), 0);
  seen_.assign(body_pair_of_.size(), 0);
}

bool takes_impulses(const Parameters& parameters) {
  return parameters.adaptive && parameters.tolerance >= k_least_tolerance &&
         traits(parameters.contact).sticks;
}

bool RigidIsland::takes(const Parameters& parameters, const ContactLaw& before, const ContactLaw& after,
                        const State& state) const {
  bool tied = false;
  coupling_.ties().each_in_place([&](int, int) { tied = true; });
  return !tied && takes_impulses(parameters) && before == after && traits(after).sticks &&
         ranges::all_of(bodies_, [&](const ModelBody& b) {
           return state.bodies[b.index].level == ModelLevel::rigid && b.body->is_free();
         });
}

double RigidIsland::time_limit(const Parameters& parameters, const State& state) const {
  double limit = k_longest_step;
  for (const auto& [index, body] : bodies_) {
    const BodyState& s = state.bodies[index];
    const double step = step_of(parameters, *body);
    limit = std::min(limit, s.substep > 0 ? std::min(s.substep, k_most_growth * step) : step);
    if (const double turning = s.angular_velocity.norm(); turning * limit > k_turn) limit = k_turn / turning;
  }
  return limit;
}

// Of points of one body against the other as they move at `state`, m/s: none is faster.
double RigidIsland::relative_speed(const BodyPair& both, const State& state) const {
  const auto& [last, of_last] = bodies_[both.second < 0 ? both.first : both.second];
  const Vec3 at = state.bodies[last].position;
  Vec3 speed = Vec3::Zero(), spin = Vec3::Zero();  // of the first to the second
  for (const int b : {both.first, both.second}) {
    if (b < 0) continue;
    const BodyState& s = state.bodies[bodies_[b].index];
    const double sign = b == both.first ? 1 : -1;
    const Vec3 own = s.rotation * s.angular_velocity;
    speed += sign * (s.velocity + own.cross(at - s.position));
    spin += sign * own;
  }
  return speed.norm() + (of_last->reach() + k_most_gap) * spin.norm();
}

// Bound of the way by which members of both bodies come nearer within h, m, as they move at the start. What
// acts on them is not asked: it is known only when this is.
double RigidIsland::coming(const BodyPair& both, const State& state, double h) const {
  return k_more_way + k_likely * h * relative_speed(both, state);
}

// The same of the way from here_.
double RigidIsland::came(const BodyPair& both, const std::vector<Known>& there) const {
  const auto motion = [&](int b) {
    const Known &from = here_[b], &to = there[b];
    return RigidMotion{from.position, bodies_[b].body->reach(), to.position - from.position,
                       to.rotation * from.rotation.conjugate()};
  };
  if (both.second < 0) return motion(both.first).way();
  return approach(motion(both.first), motion(both.second));
}

// Bodies are there, and their stick springs.
void RigidIsland::start(const State& state, const MemberSticks& sticks) {
  coupling_.place_held(state);
  go_to(state);
  sticks.load(state, coupling_.pairs());
}

void RigidIsland::go_to(const State& state) {
  std::vector<Known> there;
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    const BodyState& s = state.bodies[bodies_[b].index];
    there.push_back(known_of(s));
    coupling_.place(b, s);
  }
  if (here_.empty())
    for (const BodyPair& both : body_pairs_) take_gaps(both.pairs);
  else
    for (BodyPair& both : body_pairs_) both.closed += both.way = came(both, there);
  here_ = std::move(there);
}

bool RigidIsland::knows(const ContactLaw& law, const State& state) const {
  if (!law_ || !(*law_ == law)) return false;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (!(here_[b] == known_of(state.bodies[bodies_[b].index]))) return false;
  return true;
}

void RigidIsland::take_gaps(std::span<const int> which) {
  coupling_.start(which);
  for (const int p : which) {
    seen_[p] = body_pairs_[body_pair_of_[p]].closed;
    open_until_[p] = seen_[p] + coupling_.pairs()[p].gap;
  }
}

// What touches where the bodies are; with h > 0 what may within h, s, too, and without forces: there they
// came from start_. Stick springs are those at start_.
void RigidIsland::look(const ContactLaw& law, const State& state, double h) {
  const std::span<MemberPair> pairs = coupling_.pairs();
  chosen_.assign((pairs.size() + 63) / 64, 0);
  for (BodyPair& both : body_pairs_) {
    both.near.clear();
    both.ahead_before = std::exchange(both.ahead, h > 0 ? coming(both, state, h) : 0);
    if (both.least > both.closed + both.ahead) continue;
    both.least = std::numeric_limits<double>::infinity();
    for (const int p : both.pairs) {
      if (open_until_[p] > both.closed + both.ahead) {
        both.least = std::min(both.least, open_until_[p]);
        continue;
      }
      pairs[p].ahead = both.ahead;
      pairs[p].way = h > 0 ? both.way : 0;
      chosen_[p / 64] |= std::uint64_t{1} << p % 64;
    }
  }
  which_.clear();
  for (std::size_t word = 0; word < chosen_.size(); ++word)
    for (std::uint64_t left = chosen_[word]; left != 0; left &= left - 1)
      which_.push_back(static_cast<int>(64 * word) + std::countr_zero(left));
  find_merged_contacts(law, pairs, which_, coupling_.position(), coupling_.velocity(), start_, h == 0,
                       places_, now_);
  found_.assign(pairs.size(), 0);
  for (const auto* list : {&now_.touches, &now_.ahead})
    for (const MemberTouch& touch : *list) {
      body_pairs_[body_pair_of_[touch.pair]].near.push_back(&touch);
      now_.each_place(touch, [&](int pair, int place) { found_[pair] |= 1u << place; });
    }
  find_bounds();
}

// How far bodies may come nearer until pairs may touch, of those looked at.
void RigidIsland::find_bounds() {
  stale_.clear();
  const auto take_bound = [this](int p) {
    double& least = body_pairs_[body_pair_of_[p]].least;
    least = std::min(least, open_until_[p]);
  };
  for (const int p : which_) {
    const BodyPair& both = body_pairs_[body_pair_of_[p]];
    if (found_[p]) {
      open_until_[p] = seen_[p] = both.closed;
    } else if (both.closed > seen_[p] + k_stale) {
      stale_.push_back(p);
      continue;
    }
    take_bound(p);
  }
  take_gaps(stale_);
  for (const int p : stale_) take_bound(p);
}

RigidIsland::TouchingBodies& RigidIsland::together(const std::vector<int>& bodies) {
  const auto known = ranges::find_if(sets_, [&](const auto& set) { return set->bodies == bodies; });
  if (known != sets_.end()) return **known;
  std::vector<std::pair<int, int>> coupled;
  for (const BodyPair& both : body_pairs_)
    if (both.second >= 0 && ranges::binary_search(bodies, both.first) &&
        ranges::binary_search(bodies, both.second))
      coupled.emplace_back(place_[both.first], place_[both.second]);
  return *sets_.emplace_back(std::make_unique<TouchingBodies>(
      TouchingBodies{bodies, BlockLu(static_cast<int>(bodies.size()), coupled), {}, {}}));
}

// The oldest that are not used, beyond k_sets.
void RigidIsland::drop_sets() {
  std::size_t more = std::max(sets_.size(), k_sets + used_.size()) - (k_sets + used_.size());
  std::erase_if(sets_, [&](const auto& set) {
    const bool drop = more > 0 && ranges::find(used_, set.get()) == used_.end();
    more -= drop;
    return drop;
  });
}

// With their contacts with planes.
void RigidIsland::add_bodies(const StepSpan& span, const State& state, TouchingBodies& set) {
  const double h = span.h;
  const Vec3 field = span.parameters.gravity - (span.start.floor + span.end.floor) / 2;
  for (const int b : set.bodies) {
    const auto& [index, body] = bodies_[b];
    const BodyState& s = state.bodies[index];
    const PackMat3 r = turned(s);
    const PackVec3 linear = packed(s.velocity), angular = r * packed(s.angular_velocity),
                   turning = r * (body->inverse_inertia() * transposed_times(r, packed(s.moment)));
    const BodyVelocity& blend = blends_[b];
    set.impulses.add({body->mass(), body->least_inertia(), body->reach(), body->inertia_at(r), linear,
                      angular, packed(Vec3(body->mass() * field)) + blend.linear, blend.angular},
                     {mul_add(h / body->mass(), packed(s.force), linear), mul_add(h, turning, angular)});
  }
  for (int k = 0; k < static_cast<int>(set.bodies.size()); ++k) {
    const ReducedBody& body = *bodies_[set.bodies[k]].body;
    const BodyState& s = state.bodies[bodies_[set.bodies[k]].index];
    const double way = k_more_way + k_likely * h * (speed_of(body, s) + h / 2 * s.force.norm() / body.mass());
    const Vec3 spin = s.rotation * s.angular_velocity;
    const auto add = [&](NearContact contact) {
      contact.turning = h / 2 * spin.cross(spin.cross(contact.arm[0]));
      set.impulses.add(k, -1, body.contacts().grip(), false, contact);
    };
    const BodyState& before = start_of_[set.bodies[k]];
    body.contacts().each_near(span.end.law, before, turned(before), s, turned(s), state.stick, way, add);
  }
}

// Of a place that touched at the start: what its velocity will gain until the end as it has until the middle,
// with velocities of the bodies that stay.
Vec3 RigidIsland::turning_of(const MemberTouch& touch) const {
  const MemberTouch* was = nullptr;
  now_.each_place(touch, [&](int pair, int place) {
    if (const int k = at_start_[k_places * pair + place]; k >= 0 && !was) was = &last_.touches[k];
  });
  if (!was) return Vec3::Zero();
  const ContactInput& now = touch.input;
  const Vec3 gained = now.velocity - was->input.velocity;
  const double opening = now.normal.dot(now.velocity) - was->input.normal.dot(was->input.velocity);
  return gained + (opening - now.normal.dot(gained)) * now.normal;
}

void RigidIsland::add_contacts(const PreparedLaw& law, const BodyPair& both, TouchingBodies& set) {
  for (const MemberTouch* touch : both.near) {
    const MemberPair& pair = coupling_.pairs()[touch->pair];
    const ContactInput& in = touch->input;
    const double alpha = touch->weight * law.alpha;
    const auto [k, c] = StickSpring(alpha, in.L, in.mass);
    // the pair's first part may be of either body
    const bool same = coupling_.bodies_of(pair)[0] == both.first;
    const double sign = same ? 1 : -1;
    const NearContact contact{
        sign * in.normal,
        {coupling_.arm(*touch, pair, same ? 0 : 1), coupling_.arm(*touch, pair, same ? 1 : 0)},
        sign * in.stick,
        in.depth,
        in.L,
        alpha,
        k,
        c,
        sign * turning_of(*touch)};
    set.contacts.emplace_back(
        touch,
        set.impulses.add(place_[both.first], both.second < 0 ? -1 : place_[both.second], 1, true, contact));
  }
}

// The velocities at the end, of one set after the other.
bool RigidIsland::solve(const StepSpan& span, const State& state) {
  const PreparedLaw& law = span.end.law;
  const int count = static_cast<int>(bodies_.size());
  DisjointSets joined(count);
  for (const BodyPair& both : body_pairs_)
    if (!both.near.empty() && both.second >= 0) joined.join(both.first, both.second);
  std::vector<std::vector<int>> sets(count);
  for (int b = 0; b < count; ++b) {
    std::vector<int>& own = sets[joined.first_of(b)];
    place_[b] = static_cast<int>(own.size());
    own.push_back(b);
  }
  std::vector<TouchingBodies*> set_of(count);
  velocity_.resize(count);
  work_ = {};
  blends_ = coupling_.blend_loads(now_, coupling_.pairs());
  used_.clear();
  for (const std::vector<int>& bodies : sets) {
    if (bodies.empty()) continue;
    TouchingBodies& set = together(bodies);
    used_.push_back(&set);
    set.contacts.clear();
    set.impulses.begin(law, span.h);
    add_bodies(span, state, set);
    for (const int b : bodies) set_of[b] = &set;
  }
  drop_sets();
  at_start_.resize(k_places * body_pair_of_.size(), -1);
  const auto mark_start = [&](bool marked) {
    for (std::size_t k = 0; k < last_.touches.size(); ++k)
      last_.each_place(last_.touches[k], [&](int pair, int place) {
        at_start_[k_places * pair + place] = marked ? static_cast<int>(k) : -1;
      });
  };
  mark_start(true);
  for (const BodyPair& both : body_pairs_)
    if (!both.near.empty()) add_contacts(law, both, *set_of[both.first]);
  mark_start(false);
  double fall = std::numeric_limits<double>::infinity();
  for (const ModelBody& b : bodies_) fall = std::min(fall, fall_speed(span.parameters, *b.body));
  bounces_ = false;
  for (TouchingBodies* set : used_) {
    if (set->impulses.strikes(k_bounce_speed * fall)) {
      bounces_ = true;
      if (span.h * set->impulses.frequency() > k_bounce) return false;
    }
    if (!set->impulses.solve(set->matrix)) return false;
    const ContactImpulses::Work work = set->impulses.finish();
    work_.normal += work.normal;
    work_.friction += work.friction;
    for (std::size_t k = 0; k < set->bodies.size(); ++k) {
      const int b = set->bodies[k];
      const BodyState& s = state.bodies[bodies_[b].index];
      velocity_[b] = set->impulses.velocities()[k];
      work_.normal -=
          span.h / 2 *
          (dot(blends_[b].linear, packed(s.velocity) + velocity_[b].linear) +
           dot(blends_[b].angular, turned(s) * packed(s.angular_velocity) + velocity_[b].angular));
    }
  }
  return true;
}

// Freely, with their angular momenta.
void RigidIsland::move(double h, State& state, StepEnergy& booked) {
  from_ = coupling_.position();
  for (const auto& [index, body] : bodies_) {
    BodyState& s = state.bodies[index];
    const PackMat3& inertia = body->inertia();
    const auto energy = [&] {
      const PackVec3 omega = packed(s.angular_velocity);
      return 0.5 * dot(omega, inertia * omega);
    };
    const double before = energy();
    body->drift(h, s);
    booked.numerical += before - energy();
  }
  go_to(state);
}

// Whether something has met at the end that was not near enough in the middle to be looked at. Where it is
// asked does not depend on the steps before, as bounds do.
bool RigidIsland::missed() const {
  return ranges::any_of(now_.touches, [this](const MemberTouch& touch) {
    bool missed = false;
    now_.each_place(touch, [&](int p, int) {
      if (found_before_[p]) return;
      const MemberPair& pair = coupling_.pairs()[p];
      missed |= nearest_gap(pair, gather(pair, from_)) > body_pairs_[body_pair_of_[p]].ahead_before;
    });
    return missed;
  });
}

// Whether a pair went through each other in the newest move.
bool RigidIsland::passed() const {
  const auto is_fast = [](const BodyPair& both) { return both.way > both.least_L / 2; };
  if (ranges::any_of(body_pairs_, is_fast))
    for (const int p : which_)
      if (is_fast(body_pairs_[body_pair_of_[p]]) &&
          moved_unseen(coupling_.pairs()[p], from_, coupling_.position()))
        return true;
  for (const MemberTouch& touch : now_.touches) {
    if (touch.input.depth < k_deep) continue;
    bool other_side = false;
    for (const auto* list : {&last_.touches, &last_.ahead})
      for (const MemberTouch& was : *list)
        last_.each_place(was, [&](int pair, int place) {
          other_side |=
              pair == touch.pair && place == touch.place && was.input.normal.dot(touch.input.normal) < 0;
        });
    if (other_side) return true;
  }
  return false;
}

// The stick springs that the step leaves.
void RigidIsland::take_sticks() {
  const std::span<MemberPair> pairs = coupling_.pairs();
  for (const int p : which_) pairs[p].stick.fill(Vec3::Zero());
  for (const TouchingBodies* set : used_)
    for (const auto& [touch, number] : set->contacts) {
      const bool same =
          coupling_.bodies_of(pairs[touch->pair])[0] == body_pairs_[body_pair_of_[touch->pair]].first;
      const Vec3 stick = (same ? 1 : -1) * set->impulses.stick(number);
      now_.each_place(*touch, [&](int pair, int place) { pairs[pair].stick[place] = stick; });
    }
}

RigidIsland::Held RigidIsland::held(const ContactLaw& law) const {
  Held held{stored_energy(law, now_, coupling_.pairs()), 0};
  for (const ModelBody& b : bodies_) held.all += b.body->contacts().energy(law);
  for (const MemberTouch& touch : now_.touches) held.sticks += touch.out.stick_energy;
  return held;
}

void RigidIsland::book(const StepSpan& span, const State& next, StepEnergy& booked) {
  const Vec3 floor = (span.start.floor + span.end.floor) / 2;
  const Held before = std::exchange(held_, held(span.end.law)), &now = held_;
  double in_sticks = now.sticks - before.sticks;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    const Vec3 shift = next.bodies[index].position - start_of_[b].position;
    in_sticks += body->contacts().stick_energy_gained();
    booked.gravity -= body->mass() * span.parameters.gravity.dot(shift);
    booked.input -= body->mass() * floor.dot(shift);
  }
  booked.friction += work_.friction - in_sticks;
  booked.normal_damping += work_.normal - (now.all - before.all - in_sticks);
}

// Per body, m/s: the greatest against what it touches, where nothing its own. What is carried along is slow.
std::vector<double> RigidIsland::speeds(const State& state) const {
  std::vector<double> speed(bodies_.size(), -1);
  for (const BodyPair& both : body_pairs_) {
    if (both.near.empty()) continue;
    const double relative = relative_speed(both, state);
    for (const int b : {both.first, both.second})
      if (b >= 0) speed[b] = std::max(speed[b], relative);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    if (speed[b] < 0 || body->contacts().any())
      speed[b] = std::max(speed[b], speed_of(*body, state.bodies[index]));
  }
  return speed;
}

// s, that is tried next at `state`.
double RigidIsland::next_step(const Parameters& parameters, double h, const State& state) const {
  const std::vector<double> speeds = this->speeds(state);
  double limit = bounces_ ? h : k_most_growth * h;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const ReducedBody* const body = bodies_[b].body;
    const double slow = k_slow * fall_speed(parameters, *body), speed = speeds[b];
    limit = std::min(limit, step_of(parameters, *body) *
                                (speed * k_most_growth > slow ? std::max(1., slow / speed) : k_most_growth));
  }
  return limit;
}

StepStatus::Kind RigidIsland::advance(const StepSpan& span, State& next, MemberSticks& sticks,
                                      StepEnergy& booked) {
  const PreparedLaw& law = span.end.law;
  std::deque<BodyContacts::ScratchLease> leases;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    leases.emplace_back(bodies_[b].body->contacts(), buffers_[b]);
  if (!knows(law, next)) {
    start(next, sticks);
    start_ = coupling_.position();
    look(law, next, 0);
    held_ = held(law);
  }
  forget();  // until it has succeeded
  start_of_.clear();
  for (const ModelBody& b : bodies_) start_of_.push_back(next.bodies[b.index]);
  move(span.h / 2, next, booked);
  std::swap(last_, now_);
  start_ = from_;
  look(law, next, span.h / 2);
  if (passed()) return StepStatus::Kind::passed_through;
  if (!solve(span, next)) return StepStatus::Kind::newton_diverged;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodyState& s = next.bodies[bodies_[b].index];
    s.velocity = unpacked(velocity_[b].linear);
    s.angular_velocity = unpacked(transposed_times(turned(s), velocity_[b].angular));
  }
  move(span.h / 2, next, booked);
  take_sticks();
  std::swap(last_, now_);
  std::swap(found_before_, found_);
  start_ = coupling_.position();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto& [index, body] = bodies_[b];
    body->find_contacts_after(start_of_[b], law, next.bodies[index], next.stick);
  }
  look(law, next, 0);
  if (missed() || passed()) return StepStatus::Kind::passed_through;
  book(span, next, booked);
  finish(span, next, sticks);
  return StepStatus::Kind::ok;
}

// What acts at the end, and what is tried next.
void RigidIsland::finish(const StepSpan& span, State& next, MemberSticks& sticks) {
  const double wanted = next_step(span.parameters, span.h, next);
  const std::vector<BodyVelocity>& loads = coupling_.loads(now_, coupling_.pairs());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    BodyState& s = next.bodies[bodies_[b].index];
    bodies_[b].body->finish_substep(span.end.law, span.parameters.gravity - span.end.floor, s, next.stick);
    add_load(loads[b], s);
    here_[b].substep = s.substep = wanted;
  }
  // what is open at the end holds none
  const std::span<MemberPair> pairs = coupling_.pairs();
  for (const int p : which_) pairs[p].stick.fill(Vec3::Zero());
  for (MemberTouch& touch : now_.touches) {
    touch.out.stick = touch.input.stick;
    now_.each_place(touch, [&](int pair, int place) { pairs[pair].stick[place] = touch.input.stick; });
  }
  sticks.store(which_, found_, pairs);
  law_ = span.end.law;
}

}  // namespace topple
