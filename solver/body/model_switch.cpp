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

// It moves, tilted beyond its least critical angle: a body that is no frame, or what reduce() made of one.
bool is_falling(const Body& body, const Parameters& parameters, const BodyState& s) {
  return tilt({s.position, s.rotation}) > least_tipping_angle(body) &&
         s.velocity.squaredNorm() / 2 > k_negligible * parameters.gravity.norm() * body.reach;
}

// J, of a body's energy.
double negligible(const Body& body, const Parameters& parameters, const State& state) {
  return k_negligible * std::min(body.mass * parameters.gravity.norm() * body.reach, state.energy.largest);
}

// A rigid body's motion, floor's frame.
struct Motion {
  BodyPose pose;
  Vec3 velocity, spin;  // m/s, rad/s
};

Motion motion_of(const Model& model, const State& state, int b) {
  const BodyPose pose = body_pose(model, state, b);
  const BodyMomentum momentum = body_momentum(model, state, b);
  const Vec3 own = pose.rotation.conjugate() * momentum.angular_momentum;
  return {pose, momentum.velocity, pose.rotation * (model.bodies[b].inertia.inverse() * own)};
}

// The contact points of a body, from its centre of gravity, reference axes.
Eigen::AlignedBox3d box_of(const Model& model, const Body& body) {
  Eigen::AlignedBox3d box;
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p)
    box.extend(model.node_position[model.contact_points[p].node] - body.centre_of_gravity);
  return box;
}

// How fast, m/s, points of b reach the box around those of a within k_blow_ahead, or move so in it; 0: none.
double meets(const Model& model, const Body& a, const Motion& of_a, const Body& b, const Motion& of_b) {
  const Eigen::AlignedBox3d box = box_of(model, a);
  double fastest = 0;
  for (int p = b.first_contact_point; p < b.first_contact_point + b.contact_point_count; ++p) {
    const ContactPoint& point = model.contact_points[p];
    const Vec3 arm = of_b.pose.rotation * (model.node_position[point.node] - b.centre_of_gravity),
               from_a = of_b.pose.centre + arm - of_a.pose.centre,
               velocity = of_b.velocity + of_b.spin.cross(arm) - of_a.velocity - of_a.spin.cross(from_a);
    const Vec3 at = of_a.pose.rotation.conjugate() * from_a - box.center(),
               moves = of_a.pose.rotation.conjugate() * velocity,
               gaps = at.cwiseAbs() - box.sizes() / 2 - Vec3::Constant(point.width);
    int side;
    const double gap = gaps.maxCoeff(&side), nears = at[side] > 0 ? -moves[side] : moves[side];
    if (gap < k_blow_ahead * nears) fastest = std::max(fastest, nears);
  }
  return fastest;
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

// How fast bodies whose stresses are asked for will soon be struck by another one.
void ModelSwitch::find_meetings(const std::vector<Island>& islands, const Switching& on) {
  const auto& [model, parameters, now, end, state, parts] = on;
  meets_.assign(base_.size(), 0);
  if (!parameters.want_stress) return;
  for (const Island& island : islands) {
    std::array<int, 2> last{-1, -1};  // pairs of elements of two bodies stand together
    for (const ElementPair& pair : island.candidate_pairs) {
      const std::array<int, 2> two{body_of(model, pair.a), body_of(model, pair.b)};
      if (two == last) continue;
      last = two;
      const std::array<Motion, 2> motions{motion_of(model, state, two[0]), motion_of(model, state, two[1])};
      for (const int k : {0, 1}) {
        const int b = two[k], other = two[1 - k];
        if (base_[b].level != ModelLevel::elastic) continue;
        const Body &own = model.bodies[b], &its = model.bodies[other];
        meets_[b] = std::max({meets_[b], meets(model, own, motions[k], its, motions[1 - k]),
                              meets(model, its, motions[1 - k], own, motions[k])});
      }
    }
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
  return elastic_estimate(model, parameters, s, parts.reduced(state, b), b).error;
}

// Of a body, as elastic at `s`, where its contacts were found last.
ModelSwitch::Estimate ModelSwitch::elastic_estimate(const Model& model, const Parameters& parameters,
                                                    const BodyState& s, const ReducedBody& elastic,
                                                    int b) const {
  const Body& body = model.bodies[b];
  if (elastic.lands_on_what_gives(parameters.contact.alpha))
    return {std::numeric_limits<double>::infinity(), LevelReason::fall};
  const Estimate bends{elastic_error(body, parameters, elastic.rotation_bound(s)), LevelReason::deformation};
  if (!parameters.want_stress) return bends;
  double blow = elastic.blow_error(parameters.contact, false);
  if (blow > parameters.accuracy) {  // else it is allowed whatever strikes
    const auto error = [&](double speed, bool on_base) {
      return elastic.blow_error(parameters.contact, s, speed, on_base);
    };
    blow = error(std::max(elastic.speed_bound(s), meets_[b]), false);
    if (blow > 0) {
      const auto [on_base, aside] = elastic.strikes_soon(s);
      blow = std::max(error(on_base, true), error(std::max(aside, meets_[b]), false));
    }
  }
  return blow > bends.error ? Estimate{blow, LevelReason::blow} : bends;
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

// Whether a frame of this strain energy does not fall, and on this level keeps that and would not soon be a
// frame again.
bool ModelSwitch::may_descend_to(const Switching& on, ModelLevel level, int b, double strain) const {
  constexpr double k_soon = 0.5;  // of the accuracy
  const Body& body = on.model.bodies[b];
  const BodyState s = reduce(on.model, on.state, b, level);
  const double held =
      traits(level).has_modes ? (body.elastic->frequency * s.amplitude).square().sum() / 2 : 0;
  if (is_falling(body, on.parameters, s)) return false;
  const double lost = negligible(body, on.parameters, on.state);
  if (!traits(level).has_modes) return strain - held < lost;
  ReducedBody& elastic = on.parts.reduced(on.state, b);
  elastic.remember(on.state.anchors);
  elastic.find_contacts(on.now, s, on.state.stick);
  if (!(strain - held - elastic.residual_strain(s) < lost)) return false;
  const double allowed = on.parameters.models[b] == BodyModel::automatic ? k_soon * on.parameters.accuracy
                                                                         : std::numeric_limits<double>::max();
  return elastic_estimate(on.model, on.parameters, s, elastic, b).error <= allowed;
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
    constexpr double k_much = 10;  // times what is negligible: it is not looked at before
    const double strain = strain_energy(model, b, parts.sections);
    const bool quiet = strain < k_much * negligible(model.bodies[b], parameters, state) &&
                       !is_bent(model, state, b) && yield_ratio(model, b, parts.sections) < k_calm_yield;
    const bool calm = quiet && may_descend_to(on, base.level, b, strain);
    if (calm && s.calm_since >= 0 && state.time - s.calm_since >= k_calm_for)
      return {base.level, LevelReason::calm};
    if (!calm || s.calm_since < 0) s.calm_since = calm ? state.time : -1;
    return {s.level, s.reason};
  }
  const bool automatic = parameters.models[b] == BodyModel::automatic;
  if (automatic && s.level == ModelLevel::elastic && s.error_estimate > parameters.accuracy)
    return {ModelLevel::frame, elastic_estimate(model, parameters, s, parts.reduced(state, b), b).reason};
  // before the blow: an elastic body has a spring of its own at each contact point, a frame has not, and to
  // change within the blow would put energy into it
  if (automatic && s.level == ModelLevel::elastic && near_yield_[b] &&
      is_falling(model.bodies[b], parameters, s))
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
  if (traits(s.level).has_modes) on.parts.reduced(state, b).scale_sticks_to_frame(state.stick);
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
  if (traits(s.level).has_modes) {
    on.parts.reduced(state, b).find_contacts(on.now, s, state.stick);
    on.parts.reduced(state, b).scale_sticks_from_frame(state.stick);
  }
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
  find_meetings(parts.islands(state), {model, parameters, now, now, state, parts});
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
    if (!traits(state.bodies[b].level).has_modes)  // whose first step may be that of a frame
      state.bodies[b].error_estimate = error_estimate(model, parameters, state, parts, b);
}

bool ModelSwitch::update(const Model& model, const Parameters& parameters, const StepInputs& now,
                         const StepInputs& end, State& state, Parts& parts) {
  const Switching on{model, parameters, now, end, state, parts};
  find_base(model, parameters);
  parts.arrange(state);
  const std::vector<Island>& islands = parts.islands();
  find_near(islands);
  find_meetings(islands, on);
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
