#include "solver/body/parts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/body/frame_part.h"
#include "solver/body/planar_part.h"
#include "solver/body/reduced_part.h"
#include "solver/body/step_control.h"
#include "solver/element/damping.h"
#include "solver/frame/central_difference.h"
#include "solver/math/ranges.h"

namespace topple {
namespace {

constexpr std::size_t k_bodies_per_part = 16;  // of few unknowns: some microseconds

}  // namespace

void Forces::add(const MemberContacts& found, std::span<const MemberPair> pairs) {
  const std::size_t first = members.size();
  for (const MemberTouch& touch : found.touches) members.push_back(member_force(touch, pairs[touch.pair]));
  for (const MemberBlend& blend : found.blends)
    if (blend.touch >= 0)
      members[first + blend.touch].force -=
          blend.slope * blend.surplus * (blend.by_sine[0] + blend.by_sine[1]);  // of the nodes of a
}

Parts::Parts(const Model& model)
    : sections(model.elements.size(), {Vec3::Zero(), Vec3::Zero()}),
      model_(model),
      islands_(model),
      reduced_(model.bodies.size()),
      planar_(model.bodies.size()),
      divided_(islands_.divide({}, {})),
      all_bodies_(model.bodies.size(), true) {}

const std::vector<Island>& Parts::islands(const State& state) {
  std::vector<TiedBodies> tied = tied_bodies(model_, state);
  if (state.candidate_pairs == pairs_ && tied == tied_) return divided_;
  pairs_ = state.candidate_pairs;
  tied_ = std::move(tied);
  divided_ = islands_.divide(pairs_.all(), tied_);
  levels_.clear();
  return divided_;
}

// An island that can be stepped as one, or, while levels change, its elastic bodies and the others.
std::vector<Island> Parts::without_mixed(const Island& island) const {
  const auto is_elastic = [&](int body) { return !traits(levels_[body]).joins_frames; };
  const auto is_frame = [&](int body) { return traits(levels_[body]).moves_nodes; };
  if (ranges::none_of(island.bodies, is_frame) || ranges::none_of(island.bodies, is_elastic)) return {island};
  std::vector<ElementPair> kept;
  for (const ElementPair& pair : island.candidate_pairs) {
    std::vector<int> free;
    for (const int part : {pair.a, pair.b})
      if (const int body = body_of(model_, part); ranges::binary_search(island.bodies, body))
        free.push_back(body);
    if (is_elastic(free.front()) == is_elastic(free.back())) kept.push_back(pair);
  }
  std::vector<TiedBodies> tied;
  for (const TiedBodies& two : tied_)
    if (is_elastic(two[0]) == is_elastic(two[1])) tied.push_back(two);
  std::vector<Island> parts = islands_.divide(kept, tied);
  std::erase_if(
      parts, [&](const Island& part) { return !ranges::binary_search(island.bodies, part.bodies.front()); });
  return parts;
}

void Parts::arrange(const State& state) {
  const std::vector<Island>& islands = this->islands(state);
  if (ranges::equal(state.bodies, levels_, {}, &BodyState::level)) return;
  levels_.clear();
  for (const BodyState& s : state.bodies) levels_.push_back(s.level);
  parts_.clear();
  std::vector<ModelBody> some;
  std::vector<PlanarPart::Member> blocks;
  std::vector<BodySystem*> systems;
  std::vector<Coupled> coupled;
  const auto close_part = [&] {
    if (!some.empty()) parts_.push_back(std::make_shared<ReducedPart>(std::exchange(some, {})));
    if (!blocks.empty()) parts_.push_back(std::make_shared<PlanarPart>(std::exchange(blocks, {})));
  };
  const auto couple = [&](const Island& island) {
    std::vector<ModelLevel> own;
    for (const int b : island.bodies) own.push_back(levels_[b]);
    const auto same = ranges::find_if(
        coupled_, [&](const Coupled& known) { return known.island == island && known.levels == own; });
    if (same != coupled_.end()) return *same;
    std::vector<ModelBody> bodies;
    for (const int b : island.bodies) bodies.push_back({b, &reduced(state, b)});
    return Coupled{
        island, std::move(own),
        std::make_shared<IslandPart>(model_, std::move(bodies), island.candidate_pairs, state.bodies)};
  };
  with_frames_.assign(levels_.size(), false);
  sticks_of_.assign(levels_.size(), nullptr);
  for (const Island& island : islands)
    for (const Island& part : without_mixed(island)) {
      const int b = part.bodies.front();
      if (ranges::any_of(part.bodies, [&](int own) { return traits(levels_[own]).moves_nodes; })) {
        std::vector<int> rigid;
        for (const int own : part.bodies) {
          with_frames_[own] = true;
          if (!traits(levels_[own]).moves_nodes) rigid.push_back(own);
        }
        systems.push_back(islands_.system(part, rigid));
        for (const int own : part.bodies) sticks_of_[own] = &systems.back()->sticks();
      } else if (part.is_alone() && traits(levels_[b]).has_block) {
        blocks.push_back({b, &planar(b)});
        if (blocks.size() == k_bodies_per_part) close_part();
      } else if (part.is_alone()) {
        some.push_back({b, &reduced(state, b)});
        if (some.size() == k_bodies_per_part) close_part();
      } else {
        coupled.push_back(couple(part));
        for (const int own : part.bodies) sticks_of_[own] = &coupled.back().part->sticks();
      }
    }
  close_part();
  coupled_ = std::move(coupled);
  for (const Coupled& known : coupled_) parts_.push_back(known.part);
  islands_.keep(systems);
  for (BodySystem* system : systems) parts_.push_back(std::make_shared<FramePart>(*system, sections));
  moves_nodes_ = !systems.empty();
}

void Parts::find_sections(const State& state, int body) {
  reduced(state, body).section_forces(state.bodies[body], sections);
}

void Parts::clear_sections(int body) {
  std::fill_n(sections.begin() + model_.bodies[body].first_element, model_.bodies[body].element_count,
              SectionForces{Vec3::Zero(), Vec3::Zero()});
}

BodyEnergy Parts::balance(const Parameters& parameters, const StepInputs& now,
                          const std::vector<char>& marked, State& state) {
  BodyEnergy held;
  for (const auto& part : parts_)
    if (part->has(marked)) held += part->balance(parameters, now, marked, state);
  return held;
}

BodyEnergy Parts::balance(const Parameters& parameters, const StepInputs& now, State& state) {
  return balance(parameters, now, all_bodies_, state);
}

void Parts::find_forces(const StepInputs& now, const State& state, const std::vector<char>& marked) {
  for (const auto& part : parts_) part->find_forces(now, state, part->has(marked));
}

BodyEnergy Parts::energy(const StepInputs& now, const State& state) {
  BodyEnergy held;
  for (const auto& part : parts_) held += part->energy(now, state);
  return held;
}

double Parts::explicit_reach(const Parameters& parameters) {
  double reach = moves_nodes_ ? std::numeric_limits<double>::infinity() : 0;
  for (const auto& part : parts_) reach = std::min(reach, part->explicit_reach(parameters));
  return reach;
}

double Parts::time_limit(const Parameters& parameters, const State& state) {
  double limit = look_ahead(model_, parameters, state);
  for (const auto& part : parts_) limit = std::min(limit, part->time_limit(parameters, state));
  return std::max(limit, 2 * k_least_step);
}

std::optional<ExplicitLimit> Parts::explicit_limit(const Parameters& parameters, const State& state,
                                                   double damped) {
  const ContactLaw law = stiffest_law(parameters);
  std::optional<ExplicitLimit> least;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    BodySystem* const system = state.bodies[b].level == ModelLevel::frame ? islands_.alone(b) : nullptr;
    if (!system) continue;
    int node = -1;
    const double step =
        topple::explicit_limit(*system, &law, damped * damping_time(model_, parameters, b), &node);
    if (!least || step < least->step) least = {step, b, node, system->element_at(node)};
  }
  return least;
}

ReducedBody& Parts::reduced(const State& state, int body) {
  if (!reduced_[body]) reduced_[body] = std::make_unique<ReducedBody>(model_, body);
  reduced_[body]->remember(state.anchors);
  return *reduced_[body];
}

void Parts::forget_parameters() {
  for (const auto& body : planar_)
    if (body) body->forget_parameters();
}

PlanarBody& Parts::planar(int body) {
  if (!planar_[body]) planar_[body] = std::make_unique<PlanarBody>(model_, body);
  return *planar_[body];
}

double jump_floor(const Model& model, const Vec3& floor, State& state) {
  double gain = 0;
  const auto push = [&](double mass, Vec3& velocity) {
    gain -= 0.5 * mass * velocity.squaredNorm();
    velocity -= floor;
    gain += 0.5 * mass * velocity.squaredNorm();
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (traits(state.bodies[b].level).has_block) continue;  // PlanarBody does it, at the very instant
    if (state.bodies[b].level != ModelLevel::frame) {
      push(body.mass, state.bodies[b].velocity);
      continue;
    }
    for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
      push(model.node_mass[i], state.velocity[i]);
  }
  for (const Support& support : model.supports)
    for (int k = 0; k < 3; ++k)
      if (support.fixed >> k & 1) {
        double& v = state.velocity[support.node][k];
        gain -= 0.5 * model.node_mass[support.node] * v * v;
        v = 0;
      }
  state.floor_velocity += floor;
  return gain;
}

}  // namespace topple
