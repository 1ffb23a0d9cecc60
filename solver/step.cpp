#include "solver/step.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <tuple>

#include "solver/body_system.h"
#include "solver/central_difference.h"
#include "solver/damping.h"
#include "solver/energy.h"
#include "solver/excitation.h"
#include "solver/generalized_alpha.h"
#include "solver/islands.h"
#include "solver/ladder.h"
#include "solver/overturn.h"
#include "solver/plasticity.h"
#include "solver/settle.h"
#include "solver/step_control.h"

namespace topple {
namespace {

constexpr int k_halvings = 6;
constexpr double k_time_slack = 1e-9;  // s, times are sums of rounded steps

std::string format(const char* pattern, double a) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, a);
  return text;
}

// Accelerations from the balance of forces at `state`. Leaves the body's motion in `motion`.
void balance_accelerations(BodySystem& s, const Parameters& parameters, State& state, BodyMotion& motion) {
  s.load(state, motion);
  s.load_memory(state);
  s.evaluate(parameters, state.time, motion, state.stick, motion.position);
  for (int i = 0; i < s.count; ++i) {
    const int g = s.node[i];
    for (int k = 0; k < 3; ++k) {
      if (s.fixed[i] >> k & 1) s.force[i][k] = 0;
      if (s.fixed[i] >> (3 + k) & 1) s.moment[i][k] = 0;
    }
    const Mat3& j = s.model.node_inertia[g];
    const Vec3& omega = state.angular_velocity[g];
    state.acceleration[g] = state.algorithmic_acceleration[g] = s.force[i] / s.model.node_mass[g];
    state.angular_acceleration[g] = state.algorithmic_angular_acceleration[g] =
        j.inverse() * (state.rotation[g].conjugate() * s.moment[i] - omega.cross(j * omega));
  }
}

}  // namespace

namespace {

// What became of a system, or of some bodies that are not frames, in a step.
struct PartOfStep {
  StepEnergy exchanged;
  BodyEnergy held;
  StepStatus status;
};

void add(const BodyEnergy& part, BodyEnergy& sum) {
  sum.kinetic += part.kinetic;
  sum.strain += part.strain;
  sum.contact += part.contact;
  sum.anchor += part.anchor;
}

void take(const BodyEnergy& held, EnergyLedger& energy) {
  energy.kinetic = held.kinetic;
  energy.strain = held.strain;
  energy.contact = held.contact;
  energy.anchor = held.anchor;
}

}  // namespace

struct Workspace::Impl {
  explicit Impl(const Model& model)
      : islands(model),
        search(model),
        reduced_bodies(model.bodies.size()),
        sections(model.elements.size(), {Vec3::Zero(), Vec3::Zero()}) {
    moving.reserve(model.bodies.size());
    parts.reserve(model.bodies.size());
    contact_forces.reserve(model.contact_points.size() * model.planes.size());
  }
  const std::vector<BodySystem*>& systems() const { return islands.systems(); }
  // With the anchors of `state`.
  ReducedBody& reduced(const Model& model, const State& state, int body) {
    if (!reduced_bodies[body]) reduced_bodies[body] = std::make_unique<ReducedBody>(model, body);
    reduced_bodies[body]->remember(state.anchors);
    return *reduced_bodies[body];
  }

  Islands islands;
  NearSearch search;
  std::vector<std::unique_ptr<ReducedBody>>
      reduced_bodies;                              // per body, once it was on another rung than frame
  std::vector<ReducedScratch> reduced_scratch{1};  // per worker
  std::vector<RungChoice> base;                    // per body, for the parameters below
  std::vector<BodyModel> base_models;
  bool base_stress = false;
  double base_alpha = 0, base_q = 0;
  std::vector<bool> near;                       // per body: another is
  std::vector<bool> new_frames;                 // per body: since the last step
  std::vector<bool> new_anchors;                // per body: one was switched or broke
  std::vector<IntegratorScratch> scratches{1};  // per worker
  ParallelFor parallel;
  Profile profile;
  std::vector<int> moving;  // bodies that are not frames
  std::vector<PartOfStep> parts;
  BodyMotion motion;
  Contacts contacts;
  std::vector<ContactForce> contact_forces;
  std::vector<MemberForce> member_forces;
  std::vector<SectionForces> sections;
  State next;
  int most_iterations = 0;               // of one system in the newest step
  std::optional<double> explicit_limit;  // s, the body that sets it and the law that it holds for
  int limiting_body = -1, limiting_node = -1;
  double limit_alpha = 0, limit_q = 0;
  std::vector<double> limit_damping;
};

Workspace::Workspace(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;

void Workspace::share(ParallelFor parallel) {
  impl_->scratches.resize(parallel.workers);
  impl_->reduced_scratch.resize(parallel.workers);
  impl_->parallel = std::move(parallel);
}

Profile& Workspace::profile() {
  return impl_->profile;
}

std::string StepStatus::message(const Model& model) const {
  if (ok()) return "ok";
  std::string where = body >= 0 ? "body \"" + model.bodies[body].name + "\"" : "the floor or an energy";
  if (element >= 0) {
    const Member& member = model.members[model.elements[element].member];
    where += ", member \"" + member.name + "\" (element " + std::to_string(element) + ")";
  }
  const std::string when = format("at %.6g s", time);
  switch (kind) {
    case Kind::newton_diverged:
      return "the step " + when + " has no converged solution: " + where + "; try a smaller time_step";
    case Kind::not_finite:
      return "the motion is no longer finite " + when + ": " + where + "; try a smaller time_step";
    case Kind::singular:
      return "the stiffness is singular " + when + ": " + where + "; a part may be free to move";
    case Kind::not_settled:
      return "before the first step, " + when + ": " + where +
             " does not come to rest under gravity; does it stand on something, and can alpha and the steel "
             "carry it? settle = false starts it as it is";
    case Kind::step_too_long:
      return where + format(": central-difference is stable up to a time_step of %.4g s", limit) + ", met " +
             when + "; try a smaller one, or generalized-alpha";
    case Kind::no_equilibrium:
      return format("no stable equilibrium was found at load factor %.6g: ", load_factor) + where +
             " gives way; a mechanism, or a load beyond what it carries (control = { node, dof } follows a "
             "path that turns down)";
    case Kind::passed_through:
      return "members would pass through each other unseen in the step " + when + ": " + where +
             "; try a smaller time_step";
    case Kind::energy_lost:
      return "a contact is not resolved: more than a tenth of the energy is unaccounted for after the step " +
             when + ": " + where + "; try a smaller time_step";
    case Kind::uncontrolled:
      return where + ": the loads do not move the controlled direction";
    case Kind::ok:
      break;
  }
  return "";
}

namespace {

// The floor's velocity jumps by `floor`: bodies keep their own, so they move the other way in the floor's
// frame. Returns the kinetic energy that they gain there.
double jump(const Model& model, const Vec3& floor, State& state) {
  double gain = 0;
  const auto push = [&](double mass, Vec3& velocity) {
    gain -= 0.5 * mass * velocity.squaredNorm();
    velocity -= floor;
    gain += 0.5 * mass * velocity.squaredNorm();
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (state.bodies[b].rung != Rung::frame) {
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

void find_base(const Model& model, const Parameters& p, Workspace::Impl& w) {
  if (!w.base.empty() && w.base_models == p.models && w.base_stress == p.want_stress &&
      w.base_alpha == p.contact.alpha && w.base_q == p.contact.q)
    return;
  w.base_models = p.models;
  w.base_stress = p.want_stress;
  w.base_alpha = p.contact.alpha;
  w.base_q = p.contact.q;
  w.base.clear();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) w.base.push_back(base_rung(model, p, b));
}

void find_near(const Model& model, const State& state, Workspace::Impl& w) {
  w.near.assign(model.bodies.size(), false);
  for (const ElementPair& pair : state.near)
    for (const int e : {pair.a, pair.b}) w.near[model.members[model.elements[e].member].body] = true;
}

// Every body on its base, or a frame where another is near. Nothing is booked: the run begins here.
void start_rungs(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  place_nodes(model, state);
  state.near_slack = 0;
  look_around(model, w.search, state, 0);
  find_base(model, parameters, w);
  find_near(model, state, w);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const RungChoice choice =
        w.near[b] && w.base[b].rung != Rung::frame ? RungChoice{Rung::frame, RungReason::near} : w.base[b];
    BodyState& s = state.bodies[b];
    if (s.rung == Rung::frame && choice.rung != Rung::frame) s = reduce(model, state, b, choice.rung);
    s.rung = choice.rung;
    s.reason = choice.reason;
  }
  w.islands.arrange(state.bodies, state.near);
}

}  // namespace

StepStatus settle(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  StepStatus status;
  start_rungs(model, parameters, state, w);
  w.new_anchors.assign(model.bodies.size(), false);
  switch_anchors(model, parameters, state, w.new_anchors);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (state.bodies[b].rung == Rung::frame) continue;
    if (!w.reduced(model, state, b).settle(parameters, state.bodies[b], state.stick)) {
      status.kind = StepStatus::Kind::not_settled;
      status.time = state.time;
      status.body = b;
      return status;
    }
  }
  for (auto& system : w.systems()) {
    status = settle_system(*system, parameters, state, w.scratches[0]);
    if (!status.ok()) return status;
  }
  return status;
}

namespace {

// Accelerations and contacts of all bodies; returns what they hold.
BodyEnergy balance_all(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  BodyEnergy held;
  const Instant now(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (state.bodies[b].rung != Rung::frame)
      add(w.reduced(model, state, b).balance(parameters, now, state.bodies[b], state.stick), held);
  for (BodySystem* system : w.systems()) {
    balance_accelerations(*system, parameters, state, w.motion);
    add(system->energy(now.law, w.motion, system->contacts, w.sections), held);
  }
  return held;
}

// Another law took hold: what contacts hold more with it is input.
void change_law(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  const double before = state.energy.contact;
  state.law = parameters.contact.kind;
  state.energy.contact = balance_all(model, parameters, state, w).contact;
  state.energy.input += state.energy.contact - before;
}

}  // namespace

void prepare(const Model& model, const Parameters& parameters, State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  start_rungs(model, parameters, state, w);
  EnergyLedger& energy = state.energy;
  w.new_anchors.assign(model.bodies.size(), false);
  switch_anchors(model, parameters, state, w.new_anchors);
  break_anchors(model, state, w.new_anchors);
  energy.released = 0;  // what settling left in them was never in the run
  const BodyEnergy held = balance_all(model, parameters, state, w);
  state.law = parameters.contact.kind;
  take(held, energy);
  energy.start_total = held.kinetic + held.strain + held.contact + held.anchor;
  energy.largest = std::max(held.kinetic, held.strain + held.contact + held.anchor);
}

void resume(const Model& model, const State& state, Workspace& workspace) {
  workspace.impl().islands.arrange(state.bodies, state.near);
  section_forces(model, state, workspace.impl().sections);
}

namespace {

constexpr double k_safety = 0.9;        // of the error that is aimed at
constexpr double k_most_growth = 2;     // from step to step
constexpr double k_most_shrinking = 5;  // of a step that is tried again
constexpr int k_many_iterations = 8;    // of Newton: the step does not grow
constexpr double k_explicit_share = 0.9;
constexpr int k_bodies_per_task = 16;    // that are not frames: some microseconds
constexpr double k_least_energy = 1e-6;  // J, below it a balance is rounding

// With the stiffer of the two laws of a passage.
void find_explicit_limit(const Model& model, const Parameters& parameters, const State& state,
                         Workspace::Impl& w) {
  ContactLaw law = parameters.contact;
  if (parameters.contact_passage.over > 0) {
    law.alpha = std::max(law.alpha, parameters.contact_before.alpha);
    law.q = std::max(law.q, parameters.contact_before.q);
  }
  if (w.explicit_limit && w.limit_alpha == law.alpha && w.limit_q == law.q &&
      w.limit_damping == parameters.damping)
    return;
  w.explicit_limit.reset();
  w.limit_alpha = law.alpha;
  w.limit_q = law.q;
  w.limit_damping = parameters.damping;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    BodySystem* const system = state.bodies[b].rung == Rung::frame ? w.islands.alone(b) : nullptr;
    if (!system) continue;
    int node = -1;
    const double limit = explicit_limit(*system, &law, damping_time(model, parameters, b), &node);
    if (limit >= w.explicit_limit.value_or(1e300)) continue;
    w.explicit_limit = limit;
    w.limiting_body = b;
    w.limiting_node = node;
  }
}

// Body and element with the greatest contact force of the newest step; false: nothing touches.
bool blame_hardest_contact(const Model& model, Workspace::Impl& w, StepStatus& status) {
  double greatest = 0;
  const auto blame = [&](const BodySystem& system, double force, int node) {
    if (!(force > greatest)) return;
    greatest = force;
    status.node = node;
    status.body = system.model.node_body[node];
    status.element = system.element_at(node);
  };
  for (std::size_t b = 0; b < w.next.bodies.size(); ++b) {
    if (w.next.bodies[b].rung == Rung::frame) continue;
    w.contact_forces.clear();
    w.reduced_bodies[b]->list_contacts(w.contact_forces);
    for (const ContactForce& force : w.contact_forces)
      if (force.normal > greatest) {
        greatest = force.normal;
        status.body = static_cast<int>(b);
        status.node = model.contact_points[force.point].node;
        status.element = -1;
      }
  }
  for (const BodySystem* system : w.systems()) {
    for (const TouchingPair& pair : system->contacts.planes)
      blame(*system, pair.out.normal, system->node[pair.node]);
    for (const MemberTouch& touch : system->contacts.members.touches)
      blame(*system, touch.out.normal, system->node[system->member_pairs()[touch.pair].node[0]]);
  }
  return greatest > 0;
}

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

// Nothing keeps a frame from coming down.
bool is_calm(const Model& model, const Parameters& parameters, const State& state, int b,
             Workspace::Impl& w) {
  const Body& body = model.bodies[b];
  double strain = 0;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const ElementState& element = state.elements[e];
    if (element.hinge != Hinge::none || !element.offset.gamma.isZero(0) || !element.offset.kappa.isZero(0))
      return false;
    strain += section_energy(model.elements[e], w.sections[e]);
  }
  return !w.near[b] && strain < k_negligible * body.mass * parameters.gravity.norm() * body.reach &&
         yield_ratio(model, b, w.sections) < k_calm_yield;
}

// The rung that a body takes at `state`. The contacts of those that are not frames have been found.
RungChoice choose_rung(const Model& model, const Parameters& parameters, State& state, int b,
                       Workspace::Impl& w) {
  BodyState& s = state.bodies[b];
  const RungChoice& base = w.base[b];
  if (base.rung == Rung::frame) return base;
  if (w.near[b]) return {Rung::frame, RungReason::near};
  if (s.rung == Rung::frame) {
    if (!is_calm(model, parameters, state, b, w))
      s.calm_since = -1;
    else if (s.calm_since < 0)
      s.calm_since = state.time;
    else if (state.time - s.calm_since >= k_calm_for)
      return {base.rung, RungReason::calm};
    return {s.rung, s.reason};
  }
  const bool automatic = parameters.models[b] == BodyModel::automatic;
  if (s.rung == Rung::elastic && automatic) {
    ReducedBody& body = w.reduced(model, state, b);
    if (body.rotation_bound(s) > k_small_rotation) return {Rung::frame, RungReason::deformation};
    if (body.yield_bound(s) > k_near_yield) {
      body.section_forces(s, w.sections);
      if (yield_ratio(model, b, w.sections) > k_near_yield) return {Rung::frame, RungReason::yield};
    }
  }
  return s.rung == base.rung ? RungChoice{s.rung, s.reason} : base;
}

// Takes a body to another rung. `now`: contacts of its present one have been found.
void change_rung(const Model& model, const Parameters& parameters, const Instant& now, RungChoice choice,
                 int b, State& state, Workspace::Impl& w) {
  BodyState& s = state.bodies[b];
  const auto total = [](const BodyEnergy& e) { return e.kinetic + e.strain + e.contact + e.anchor; };
  const auto of_frame = [&] {
    BodySystem& system = *w.islands.alone(b);
    system.load(state, w.motion);
    system.load_memory(state);
    system.find_contacts(now.law, w.motion, state.stick, w.motion.position, system.contacts);
    return total(system.energy(now.law, w.motion, system.contacts, w.sections));
  };
  ReducedBody& body = w.reduced(model, state, b);
  const double height = body_pose(model, state, b).centre.dot(parameters.gravity);
  const double before = s.rung == Rung::frame ? of_frame() : total(body.find_contacts(now, s, state.stick));
  if (choice.rung == Rung::frame) {
    place_nodes(model, state);
    body.add_residual(s, state);
    w.new_frames[b] = true;
  } else if (s.rung == Rung::frame) {
    s = reduce(model, state, b, choice.rung);
  } else if (choice.rung == Rung::rigid) {
    s.amplitude.setZero();
    s.rate.setZero();
  }
  s.rung = choice.rung;
  s.reason = choice.reason;
  s.calm_since = -1;
  const double after =
      s.rung == Rung::frame ? of_frame() : total(body.balance(parameters, now, s, state.stick));
  const double sunk = height - body_pose(model, state, b).centre.dot(parameters.gravity);
  state.energy.model_switch += after - before + model.bodies[b].mass * sunk;
  state.energy.gravity += model.bodies[b].mass * sunk;
}

// Contacts of what is not a frame, then the rungs on which `state` goes on.
void change_rungs(const Model& model, const Parameters& parameters, const Instant& now, State& state,
                  Workspace::Impl& w) {
  find_base(model, parameters, w);
  find_near(model, state, w);
  w.new_frames.assign(model.bodies.size(), false);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    BodyState& s = state.bodies[b];
    if (s.rung != Rung::frame) w.reduced(model, state, b).find_contacts(now, s, state.stick);
    const RungChoice choice = choose_rung(model, parameters, state, b, w);
    if (choice.rung == s.rung) {
      s.reason = choice.reason;
    } else {
      change_rung(model, parameters, now, choice, b, state, w);
    }
  }
  w.islands.arrange(state.bodies, state.near);
  for (BodySystem* system : w.systems())
    if (std::any_of(system->bodies.begin(), system->bodies.end(), [&](int b) { return w.new_frames[b]; }))
      balance_accelerations(*system, parameters, state, w.motion);
}

// Accelerations anew of bodies whose anchors changed.
void balance_again(const Model& model, const Parameters& parameters, const Instant& now, State& state,
                   Workspace::Impl& w) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (w.new_anchors[b] && state.bodies[b].rung != Rung::frame)
      w.reduced(model, state, b).balance(parameters, now, state.bodies[b], state.stick);
  for (BodySystem* system : w.systems())
    if (std::any_of(system->bodies.begin(), system->bodies.end(), [&](int b) { return w.new_anchors[b]; }))
      balance_accelerations(*system, parameters, state, w.motion);
}

// One step of size h from w.next, whose near elements are known, into w.next.
StepStatus try_known(const Model& model, const Parameters& parameters, const State& state, double h,
                     int halvings, Workspace::Impl& w) {
  const double t = state.time;
  const Instant start(parameters, t), end(parameters, t + h);
  {
    const InPhase phase(&w.profile, Phase::ladder);
    change_rungs(model, parameters, start, w.next, w);
    w.new_anchors.assign(model.bodies.size(), false);
    if (switch_anchors(model, parameters, w.next, w.new_anchors))
      balance_again(model, parameters, start, w.next, w);
    if (w.next.law != parameters.contact.kind) change_law(model, parameters, w.next, w);
  }
  const bool is_explicit = parameters.integrator == Integrator::central_difference;
  StepStatus status;
  if (is_explicit) {
    find_explicit_limit(model, parameters, w.next, w);
    if (w.explicit_limit && h > *w.explicit_limit) {
      status.kind = StepStatus::Kind::step_too_long;
      status.limit = *w.explicit_limit;
      status.time = t;
      status.body = w.limiting_body;
      status.node = w.limiting_node;
      status.element = w.islands.alone(w.limiting_body)->element_at(w.limiting_node);
      return status;
    }
  }
  State& next = w.next;
  if (parameters.adaptive) change_step(next, h);
  StepEnergy exchanged;
  if (const Vec3 floor = floor_velocity_jump(parameters.shakes, t - k_time_slack, t + h - k_time_slack);
      !floor.isZero(0)) {
    exchanged.input = jump(model, floor, next);
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
      if (next.bodies[b].rung != Rung::frame)
        w.reduced(model, next, b).balance(parameters, start, next.bodies[b], next.stick);
    for (auto& system : w.systems()) balance_accelerations(*system, parameters, next, w.motion);
  }

  w.moving.clear();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (next.bodies[b].rung != Rung::frame) w.moving.push_back(b);
  const int bodies = static_cast<int>(w.moving.size()),
            chunks = (bodies + k_bodies_per_task - 1) / k_bodies_per_task,
            systems = static_cast<int>(w.systems().size());
  w.parts.assign(chunks + systems, {});
  const auto move_bodies = [&](int chunk, int worker) {
    PartOfStep& part = w.parts[chunk];
    for (int k = chunk * k_bodies_per_task; k < std::min(bodies, (chunk + 1) * k_bodies_per_task); ++k) {
      const int b = w.moving[k];
      BodyEnergy holds;
      if (!w.reduced(model, next, b)
               .advance(parameters, start, end, h, next.bodies[b], next.stick, part.exchanged, holds,
                        w.reduced_scratch[worker])) {
        part.status.kind = StepStatus::Kind::newton_diverged;
        part.status.time = end.time;
        part.status.body = b;
        return;
      }
      add(holds, part.held);
    }
  };
  const auto move_system = [&](int s, int worker) {
    BodySystem& system = *w.systems()[s];
    PartOfStep& part = w.parts[chunks + s];
    IntegratorScratch& scratch = w.scratches[worker];
    scratch.profile = &w.profile;
    {
      const InPhase phase(scratch.profile, Phase::forces);
      part.status =
          is_explicit
              ? advance_central_difference(system, parameters, next, t, h, scratch, part.exchanged)
              : advance_generalized_alpha(system, parameters, next, t, h, halvings, scratch, part.exchanged);
    }
    if (!part.status.ok()) return;
    const InPhase phase(scratch.profile, Phase::energy);
    add(system.energy(end.law, scratch.trial, system.contacts, w.sections), part.held);
  };
  const auto move = [&](int task, int worker) {
    if (task < chunks) {
      const InPhase phase(&w.profile, Phase::reduced);
      move_bodies(task, worker);
    } else {
      move_system(task - chunks, worker);
    }
  };
  if (w.parallel.run && chunks + systems > 1 && !w.profile.clock) {
    for (BodySystem* system : w.systems()) system->take_sticks(next);
    w.parallel.run(chunks + systems, std::ref(move));
    for (BodySystem* system : w.systems()) system->give_sticks(next);
  } else {
    for (int task = 0; task < chunks + systems; ++task) move(task, 0);
  }
  BodyEnergy held;
  int iterations = 0, rejected = 0;
  w.most_iterations = 0;
  status = {};
  for (const PartOfStep& part : w.parts) {
    iterations += part.status.newton_iterations;
    w.most_iterations = std::max(w.most_iterations, part.status.newton_iterations);
    rejected += part.status.rejected;
    if (!status.ok()) continue;
    status = part.status;
    add(part.held, held);
    exchanged.input += part.exchanged.input;
    exchanged.gravity += part.exchanged.gravity;
    exchanged.friction += part.exchanged.friction;
    exchanged.normal_damping += part.exchanged.normal_damping;
    exchanged.numerical += part.exchanged.numerical;
    exchanged.plastic += part.exchanged.plastic;
    exchanged.damping += part.exchanged.damping;
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  if (!status.ok()) return status;

  next.step = state.step + 1;
  next.time = t + h;
  advance_floor(next.floor_displacement, next.floor_velocity, start.floor, end.floor, h);
  EnergyLedger& e = next.energy;
  e.input += exchanged.input;
  e.gravity += exchanged.gravity;
  e.friction += exchanged.friction;
  e.normal_damping += exchanged.normal_damping;
  e.numerical += exchanged.numerical;
  e.plastic += exchanged.plastic;
  e.damping += exchanged.damping;
  take(held, e);
  e.largest = std::max(
      {e.largest, std::abs(e.input), e.kinetic, std::abs(e.gravity), e.strain + e.contact + e.anchor});
  // central differences have looked at the accelerations
  if (!is_finite(next, !w.systems().empty() && !is_explicit)) {
    status.kind = StepStatus::Kind::not_finite;
    status.time = next.time;
    status.body = -1;
  } else if (e.balance_error() > k_lost_balance && std::abs(e.unexplained()) > k_least_energy &&
             blame_hardest_contact(model, w, status)) {
    status.kind = StepStatus::Kind::energy_lost;
    status.time = next.time;
  }
  return status;
}

// Whether a step needs the per-node arrays: there are frames, or `w` has never seen this state.
bool moves_nodes(const State& state, const Workspace::Impl& w) {
  return !w.systems().empty() || w.next.position.size() != state.position.size();
}

// One step of size h into w.next.
StepStatus try_step(const Model& model, const Parameters& parameters, const State& state, double h,
                    int halvings, Workspace::Impl& w) {
  constexpr int k_most_looks = 4;
  double travel = model.bodies.size() > 1 ? likely_travel(model, state, h) : 0;
  StepStatus status;
  for (int look = 0; look < k_most_looks; ++look) {
    {
      const InPhase phase(&w.profile, Phase::search);
      copy(state, w.next, moves_nodes(state, w));
      look_around(model, w.search, w.next, travel);
    }
    status = try_known(model, parameters, state, h, halvings, w);
    if (!status.ok() || model.bodies.size() < 2) return status;
    travel = greatest_travel(model, state, w.next);
    if (2 * travel < w.next.near_slack) {
      w.next.near_slack -= 2 * travel;
      return status;
    }
  }
  status.kind = StepStatus::Kind::passed_through;
  status.time = w.next.time;
  return status;
}

// The size to try next after one of size h with this error and these iterations.
double next_size(double h, double error, int iterations) {
  double growth = error > 0 ? k_safety / std::sqrt(error) : k_most_growth;
  if (iterations > k_many_iterations) growth = std::min(growth, 1.);
  return h * std::clamp(growth, 1 / k_most_shrinking, k_most_growth);
}

// At most h, so that what is left of the way takes no step much shorter than the others.
double fit(double h, double left) {
  if (left <= h) return left;
  return left < 2 * h ? left / 2 : h;
}

// look_ahead of all bodies.
double next_limit(const Model& model, const Parameters& parameters, const State& state, Workspace::Impl& w) {
  double limit = look_ahead(model, parameters, state);
  const ContactLaw law = contact_law(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (state.bodies[b].rung != Rung::frame)
      limit = std::min(limit, w.reduced(model, state, b).look_ahead(law, state.bodies[b]));
  return std::max(limit, 2 * k_least_step);
}

// The step in w.next is taken.
void accept(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w) {
  w.new_anchors.assign(model.bodies.size(), false);
  if (break_anchors(model, w.next, w.new_anchors))
    balance_again(model, parameters, Instant(parameters, w.next.time), w.next, w);
  std::swap(state, w.next);
}

StepStatus adaptive_step(const Model& model, const Parameters& parameters, State& state, Workspace::Impl& w,
                         double until) {
  const bool is_explicit = parameters.integrator == Integrator::central_difference;
  if (is_explicit) find_explicit_limit(model, parameters, state, w);
  const double left = std::min(until, next_kink(model, parameters, state.time)) - state.time;
  double h = state.step_size > 0 ? state.step_size : k_first_step;
  h = is_explicit ? k_explicit_share * *w.explicit_limit
                  : std::min(h, next_limit(model, parameters, state, w));
  h = fit(h, left);
  StepStatus status;
  int iterations = 0, rejected = 0;
  for (;;) {
    status = try_step(model, parameters, state, h, 0, w);
    iterations += status.newton_iterations;
    const double error = status.ok() && !is_explicit ? step_error(model, parameters, state, w.next, h) : 0;
    if (status.ok() && error <= 1) {
      if (h == left) w.next.time = state.time + left;
      const double wanted = std::min(next_size(h, error, w.most_iterations), k_longest_step);
      w.next.step_size = h;
      if (!is_explicit) change_step(w.next, std::min(wanted, next_limit(model, parameters, w.next, w)));
      accept(model, parameters, state, w);
      break;
    }
    if (is_explicit || h < 2 * k_least_step) {
      if (status.ok()) status.kind = StepStatus::Kind::newton_diverged;
      break;
    }
    ++rejected;
    h = std::max(status.ok() ? std::min(next_size(h, error, 0), h / 1.2) : h / 2, k_least_step);
  }
  status.newton_iterations = iterations;
  status.rejected = rejected;
  return status;
}

}  // namespace

StepStatus step(const Model& model, const Parameters& parameters, State& state, Workspace& workspace,
                double until) {
  Workspace::Impl& w = workspace.impl();
  if (parameters.adaptive) return adaptive_step(model, parameters, state, w, until);
  const double h = parameters.time_step;
  const StepStatus status = try_step(model, parameters, state, h, k_halvings, w);
  if (status.ok()) accept(model, parameters, state, w);
  return status;
}

std::optional<double> explicit_limit(Workspace& workspace) {
  return workspace.impl().explicit_limit;
}

const std::vector<ContactForce>& contact_forces(const Model& model, const Parameters& parameters,
                                                const State& state, Workspace& workspace) {
  Workspace::Impl& w = workspace.impl();
  w.contact_forces.clear();
  w.member_forces.clear();
  w.islands.arrange(state.bodies, state.near);
  const Instant now(parameters, state.time);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (state.bodies[b].rung == Rung::frame) continue;
    ReducedBody& body = w.reduced(model, state, b);
    body.find_contacts(now, state.bodies[b], state.stick);
    body.section_forces(state.bodies[b], w.sections);
    body.list_contacts(w.contact_forces);
  }
  for (auto& system : w.systems()) {
    system->load(state, w.motion);
    system->load_memory(state);
    system->find_contacts(contact_law(parameters, state.time), w.motion, state.stick, w.motion.position,
                          w.contacts);
    for (const TouchingPair& pair : w.contacts.planes)
      w.contact_forces.push_back({pair.point, pair.plane, pair.depth, pair.out.normal, pair.out.force});
    for (const MemberTouch& touch : w.contacts.members.touches)
      w.member_forces.push_back(
          {system->near[touch.pair], touch.at.s, touch.at.t, touch.depth, touch.out.force});
  }
  std::sort(w.contact_forces.begin(), w.contact_forces.end(),
            [](const ContactForce& a, const ContactForce& b) {
              return std::tie(a.point, a.plane) < std::tie(b.point, b.plane);
            });
  return w.contact_forces;
}

const std::vector<MemberForce>& member_forces(Workspace& workspace) {
  return workspace.impl().member_forces;
}

const std::vector<SectionForces>& section_forces(Workspace& workspace) {
  return workspace.impl().sections;
}

}  // namespace topple
