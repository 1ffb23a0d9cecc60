#include "solver/body/model_switch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/body/body_pose.h"
#include "solver/element/plasticity.h"
#include "solver/frame/integrator.h"
#include "solver/math/ranges.h"
#include "solver/reduced/tipping.h"

namespace topple {
namespace {

// Greatest sqrt(f + 1) of a body's sections.
double yield_ratio(const Model& model, int b, const std::vector<SectionForces>& sections) {
  const Body& body = model.bodies[b];
  double greatest = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[e];
    if (!std::isfinite(element.capacity[0])) continue;
    for (const int end : {-1, 1})
      greatest = std::max(
          greatest,
          std::sqrt(1 + yield_function(element, forces_along(sections[e], element.length, element.s, end))));
  }
  return greatest;
}

// A body whose nodes or elements say that it must stay a frame.
bool is_bent(const Model& model, const State& state, int b) {
  const Body& body = model.bodies[b];
  const auto first = state.elements.begin() + body.first_element;
  return std::any_of(first, first + body.element_count, [](const ElementState& element) {
    return element.hinge != Hinge::none || !element.offset.gamma.isZero(0) || !element.offset.kappa.isZero(0);
  });
}

// It moves, tilted beyond its least critical angle.
bool is_falling(const Model& model, const Parameters& parameters, const State& state, int b) {
  const Body& body = model.bodies[b];
  return tilt(body_pose(model, state, b)) > least_tipping_angle(body) &&
         body_momentum(model, state, b).velocity.squaredNorm() / 2 >
             k_negligible * parameters.gravity.norm() * body.reach;
}

double strain_energy(const Model& model, int b, const std::vector<SectionForces>& sections) {
  const Body& body = model.bodies[b];
  double strain = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e)
    strain += section_energy(model.elements[e], sections[e]);
  return strain;
}

}  // namespace

struct ModelSwitch::Switching {
  const Model& model;
  const Parameters& parameters;
  const StepInputs& now;
  const StepInputs& end;
  State& state;
  Parts& parts;
};

ModelSwitch::ModelSwitch(const Model& model) : yields_(model.bodies.size()), changed_(model.bodies.size()) {}

void ModelSwitch::find_base(const Model& model, const Parameters& parameters) {
  if (!base_.empty()) return;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    base_.push_back(base_level(model, parameters, b));
    rigid_error_.push_back(rigid_error(model, parameters, b));
    watched_.push_back(parameters.want_stress && base_[b].level == ModelLevel::elastic &&
                       parameters.models[b] == BodyModel::automatic &&
                       model.bodies[b].elastic->mode_yield.any());
  }
}

// A frame makes those bodies of its island frames that are not stepped with it. One that is a frame for no
// other reason stays one until all of them are calm.
void ModelSwitch::choose_islands(const std::vector<Island>& islands, const Parameters& parameters,
                                 State& state) {
  const bool alone = traits(parameters.integrator).is_explicit;
  for (const Island& island : islands) {
    bool frame = false, by_itself = false;
    for (const int b : island.bodies) {
      frame = frame || choice_[b].level == ModelLevel::frame;
      by_itself =
          by_itself || (choice_[b].level == ModelLevel::frame && choice_[b].reason != LevelReason::near);
    }
    if (!frame || island.is_alone()) continue;
    for (const int b : island.bodies) {
      LevelChoice& choice = choice_[b];
      if (choice.level == ModelLevel::frame && choice.reason != LevelReason::near) continue;
      if (choice.level != ModelLevel::frame && traits(choice.level).joins_frames && !alone) continue;
      choice = {ModelLevel::frame, LevelReason::near};
      if (by_itself) state.bodies[b].calm_since = -1;
    }
  }
}

void ModelSwitch::find_near(const std::vector<Island>& islands) {
  near_.assign(base_.size(), false);
  near_yield_.assign(base_.size(), false);
  for (const Island& island : islands)
    if (!island.is_alone())
      for (const int b : island.bodies) {
        near_[b] = true;
        near_yield_[b] = ranges::any_of(island.bodies, [this](int other) { return watched_[other] != 0; });
      }
}

// Of the body's present level (model_level.h); a frame is what the others are measured by. Infinite: not
// known.
double ModelSwitch::error_estimate(const Model& model, const Parameters& parameters, const State& state,
                                   Parts& parts, int b) const {
  const BodyState& s = state.bodies[b];
  if (traits(s.level).moves_nodes) return 0;
  if (traits(s.level).has_block) return rigid_error_[b] + parts.planar(b).hard_floor_error(parameters, state);
  if (!traits(s.level).has_modes) return rigid_error_[b];
  const ReducedBody& elastic = parts.reduced(state, b);
  return elastic.lands_on_what_gives(parameters.contact.alpha)
             ? std::numeric_limits<double>::infinity()
             : elastic_error(model.bodies[b], parameters, elastic.rotation_bound(s));
}

// Of a body on the level planar.
LevelChoice ModelSwitch::choose_of_block(const Switching& on, int b) {
  const BodyState& s = on.state.bodies[b];
  const LevelChoice& base = base_[b];
  const bool automatic = on.parameters.models[b] == BodyModel::automatic;
  if (base.level != ModelLevel::planar && !(automatic && base.level == ModelLevel::rigid)) return base;
  if (near_[b]) return {ModelLevel::rigid, LevelReason::neighbour};
  const auto reason = on.parts.planar(b).plan(on.parameters, on.now, on.end, on.state.blocks[b]);
  return reason ? LevelChoice{ModelLevel::rigid, *reason} : LevelChoice{s.level, s.reason};
}

// Whether a frame, as an elastic body, would be on what makes that one a frame.
bool ModelSwitch::would_lie(const Switching& on, ModelLevel level, int b) {
  if (!traits(level).has_modes) return false;
  ReducedBody& body = on.parts.reduced(on.state, b);
  body.remember(on.state.anchors);
  body.find_contacts(on.now, reduce(on.model, on.state, b, level), on.state.stick);
  return body.lands_on_what_gives(on.parameters.contact.alpha);
}

// Whether a frame, as an elastic body, would soon be on what makes it a frame again.
bool ModelSwitch::would_bend(const Switching& on, ModelLevel level, int b) {
  constexpr double k_soon = 0.5;  // of the accuracy
  if (!traits(level).has_modes || on.parameters.models[b] != BodyModel::automatic) return false;
  const double bound = on.parts.reduced(on.state, b).rotation_bound(reduce(on.model, on.state, b, level));
  return elastic_error(on.model.bodies[b], on.parameters, bound) > k_soon * on.parameters.accuracy;
}

// At the state of `on`, where the contacts of those that are not frames have been found.
LevelChoice ModelSwitch::choose(const Switching& on, int b) {
  const auto& [model, parameters, now, end, state, parts] = on;
  BodyState& s = state.bodies[b];
  LevelChoice base = base_[b];
  if (traits(base.level).has_block) base = {ModelLevel::rigid, s.reason};  // what left its plane stays so
  s.error_estimate = error_estimate(model, parameters, state, parts, b);
  if (traits(s.level).has_block) return choose_of_block(on, b);
  if (base.level == ModelLevel::frame) return base;
  if (s.level == ModelLevel::frame) {
    const Body& body = model.bodies[b];
    const bool calm = strain_energy(model, b, parts.sections) <
                          k_negligible * body.mass * parameters.gravity.norm() * body.reach &&
                      !is_bent(model, state, b) && yield_ratio(model, b, parts.sections) < k_calm_yield &&
                      !is_falling(model, parameters, state, b) && !would_bend(on, base.level, b);
    if (!calm)
      s.calm_since = -1;
    else if (s.calm_since < 0)
      s.calm_since = state.time;
    else if (state.time - s.calm_since >= k_calm_for && !would_lie(on, base.level, b))
      return {base.level, LevelReason::calm};
    return {s.level, s.reason};
  }
  const bool automatic = parameters.models[b] == BodyModel::automatic;
  if (automatic && s.level == ModelLevel::elastic && s.error_estimate > parameters.accuracy)
    return {ModelLevel::frame,
            std::isfinite(s.error_estimate) ? LevelReason::deformation : LevelReason::fall};
  // before the blow: an elastic body has a spring of its own at each contact point, a frame has not, and to
  // change within the blow would put energy into it
  if (automatic && s.level == ModelLevel::elastic && near_yield_[b] &&
      is_falling(model, parameters, state, b))
    return {ModelLevel::frame, LevelReason::neighbour};
  if (watched_[b] && traits(s.level).has_stresses) {
    if (yields_[b]) return {ModelLevel::frame, LevelReason::yield};
    ReducedBody& body = parts.reduced(state, b);
    if (body.yield_bound(s) > k_near_yield) {
      body.section_forces(s, parts.sections);
      if (yield_ratio(model, b, parts.sections) > k_near_yield)
        return {ModelLevel::frame, LevelReason::yield};
    }
  }
  return s.level == base.level ? LevelChoice{s.level, s.reason} : base;
}

// The contacts of the body's present model have been found.
void ModelSwitch::change(const Switching& on, LevelChoice choice, int b) {
  const Model& model = on.model;
  State& state = on.state;
  BodyState& s = state.bodies[b];
  const double height = body_pose(model, state, b).centre.dot(on.parameters.gravity);
  if (traits(s.level).has_block) {
    on.parts.planar(b).sink(on.parameters, on.now, state);
    s.level = ModelLevel::rigid;
    on.parts.reduced(state, b).find_contacts(on.now, s, state.stick);
  }
  if (choice.level == ModelLevel::frame) {
    place_nodes(model, state);
    on.parts.reduced(state, b).add_residual(s, state);
  } else if (s.level == ModelLevel::frame) {
    s = reduce(model, state, b, choice.level);
  } else if (choice.level == ModelLevel::rigid) {
    s.amplitude.setZero();
    s.rate.setZero();
  }
  s.level = choice.level;
  s.reason = choice.reason;
  if (!traits(s.level).has_stresses) on.parts.clear_sections(b);
  s.calm_since = -1;
  s.error_estimate = error_estimate(model, on.parameters, state, on.parts, b);
  changed_[b] = true;
  std::erase_if(state.member_sticks,
                [&](const MemberStick& stick) {  // between other parts of it from here on
                  return body_of(model, stick.elements.a) == b || body_of(model, stick.elements.b) == b;
                });
  const double sunk = height - body_pose(model, state, b).centre.dot(on.parameters.gravity);
  state.energy.model_switch += model.bodies[b].mass * sunk;
  state.energy.gravity += model.bodies[b].mass * sunk;
}

// Where the body is one, and begins on the level rigid.
void ModelSwitch::begin_block(const Switching& on, int b) {
  BodyState& s = on.state.bodies[b];
  if (s.level != ModelLevel::rigid) return;
  const bool asked = traits(base_[b].level).has_block;
  if (!asked && on.parameters.models[b] != BodyModel::automatic) return;
  if (near_[b]) {
    if (asked) s.reason = LevelReason::neighbour;
    return;
  }
  const auto block = on.parts.planar(b).begin(on.parameters, on.state, asked);
  if (!block) return;
  on.state.blocks[b] = *block;
  s.level = ModelLevel::planar;
  on.parts.planar(b).balance(on.parameters, on.now, on.state);
}

bool ModelSwitch::yielded(const Model& model, const State& next, Parts& parts) {
  bool any = false;
  for (int b = 0; b < static_cast<int>(next.bodies.size()); ++b) {
    const BodyState& s = next.bodies[b];
    if (!watched_[b] || s.level != ModelLevel::elastic) continue;
    ReducedBody& body = parts.reduced(next, b);
    if (!(body.yield_bound(s) > 1)) continue;
    body.section_forces(s, parts.sections);
    yields_[b] = yield_ratio(model, b, parts.sections) > 1;
    any = any || yields_[b];
  }
  return any;
}

void ModelSwitch::start(const Model& model, const Parameters& parameters, State& state, Parts& parts) {
  find_base(model, parameters);
  choice_ = base_;
  choose_islands(parts.islands(state), parameters, state);
  find_near(parts.islands(state));
  const StepInputs now(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    LevelChoice choice = choice_[b];
    if (traits(choice.level).has_block) choice.level = ModelLevel::rigid;
    BodyState& s = state.bodies[b];
    if (s.level == ModelLevel::frame && choice.level != ModelLevel::frame)
      s = reduce(model, state, b, choice.level);
    s.level = choice.level;
    s.reason = choice.reason;
    if (!traits(s.level).has_stresses) parts.clear_sections(b);
    begin_block({model, parameters, now, now, state, parts}, b);
  }
  parts.arrange(state);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    state.bodies[b].error_estimate = error_estimate(model, parameters, state, parts, b);
}

bool ModelSwitch::update(const Model& model, const Parameters& parameters, const StepInputs& now,
                         const StepInputs& end, State& state, Parts& parts) {
  const Switching on{model, parameters, now, end, state, parts};
  find_base(model, parameters);
  parts.arrange(state);
  const std::vector<Island>& islands = parts.islands();
  find_near(islands);
  parts.find_forces(now, state, watched_);
  choice_.clear();
  const int count = static_cast<int>(model.bodies.size());
  for (int b = 0; b < count; ++b) choice_.push_back(choose(on, b));
  choose_islands(islands, parameters, state);
  const bool any = !ranges::equal(choice_, state.bodies, {}, &LevelChoice::level, &BodyState::level);
  if (any) {
    // as the newest step left it: parts may be arranged otherwise by now, with pairs that came near
    const EnergyLedger& held = state.energy;
    state.energy.model_switch -= state.law == parameters.contact.kind
                                     ? held.kinetic + held.strain + held.contact + held.anchor
                                     : parts.energy(now, state).sum();  // as under the law from here on
  }
  bool other_frames = false;
  for (int b = 0; b < count; ++b) {
    BodyState& s = state.bodies[b];
    const bool was_frame = s.level == ModelLevel::frame;
    if (was_frame) yields_[b] = false;
    if (choice_[b].level == s.level)
      s.reason = choice_[b].reason;
    else
      change(on, choice_[b], b);
    other_frames = other_frames || was_frame != (s.level == ModelLevel::frame);
  }
  if (any) {
    parts.arrange(state);
    parts.balance(parameters, now, changed_, state);
    ranges::fill(changed_, false);
    state.energy.model_switch += parts.energy(now, state).sum();
  }
  return other_frames;
}

}  // namespace topple
