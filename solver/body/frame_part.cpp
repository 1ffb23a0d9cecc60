#include "solver/body/frame_part.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/element/damping.h"
#include "solver/frame/central_difference.h"
#include "solver/frame/integrator.h"
#include "solver/frame/settle.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

constexpr double k_explicit_share = 0.9;  // of the greatest stable substep
constexpr int k_most_substeps = 7;        // cost half of what an implicit step does

// Mean rotation of a body's nodes, of which `first` is the first one, rad/s.
double spin(const Body& body, const BodyMotion& motion, int first) {
  Vec3 sum = Vec3::Zero();
  for (int i = first; i < first + body.node_count; ++i)
    sum += motion.rotation[i] * motion.angular_velocity[i];
  return sum.norm() / body.node_count;
}

double contact_limit(const Model& model, const Body& body, const ContactLaw& law, const BodyMotion& motion,
                     int first) {
  double stiffness = 0, limit = std::numeric_limits<double>::infinity();
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
    const ContactPoint& point = model.contact_points[p];
    const int node = first + point.node - body.first_node;
    for (const Plane& plane : model.planes) {
      const double L = contact_length(point, plane);
      const double gap = plane.normal.dot(motion.position[node] - plane.point) - point.width / 2;
      const ContactAhead ahead = contact_ahead(law, gap, -plane.normal.dot(motion.velocity[node]), L);
      stiffness += ahead.stiffness;
      limit = std::min(limit, ahead.limit);
    }
  }
  return std::min(limit, bounce_limit(body.mass, stiffness));
}

// For the members of the system's bodies that are near each other and open. How those bounce that are closed,
// light bodies among them on contacts that are stiff enough for heavy ones, the error of a step sees.
double member_limit(const BodySystem& system, const BodyMotion& motion) {
  double limit = std::numeric_limits<double>::infinity();
  if (system.candidate_pairs.empty()) return limit;
  for (const MemberPair& pair : system.member_pairs()) {
    const NearestShares near = nearest_shares(pair, gather(pair, motion.position));
    for (int k = 0; k < near.count; ++k) {
      const NearestShares::At& at = near.at[k];
      if (at.gap < 0) continue;
      Vec3 relative = Vec3::Zero();
      for (int i = 0; i < pair.nodes(); ++i) relative += at.share[i] * motion.velocity[pair.node[i]];
      limit = std::min(limit, closing_limit(at.gap, -relative.dot(at.between) / at.between.norm(), pair.L));
    }
  }
  return limit;
}

}  // namespace

bool may_take_substeps(const Model& model, const Parameters& parameters, int body) {
  return parameters.adaptive && parameters.integrator == Integrator::generalized_alpha &&
         !model.bodies[body].ground && !parameters.models.empty() &&
         parameters.models[body] == BodyModel::automatic;
}

bool FramePart::has(const std::vector<char>& marked) const {
  return std::any_of(system_.bodies.begin(), system_.bodies.end(), [&](int b) { return marked[b]; });
}

StepStatus FramePart::settle(const Parameters& parameters, State& state, PartScratch& scratch) {
  return settle_system(system_, parameters, state, scratch.frame);
}

BodyEnergy FramePart::balance(const Parameters& parameters, const StepInputs& now,
                              const std::vector<char>& marked, State& state) {
  if (!has(marked)) return {};
  BodySystem& s = system_;
  s.load(state, motion_);
  s.load_memory(state, motion_);
  s.evaluate(parameters, now, motion_, state.stick, motion_.position);
  for (const RigidInSystem& one : s.rigid) {
    state.bodies[one.body].force = s.force[one.own];
    state.bodies[one.body].moment = s.moment[one.own];
  }
  for (int i = 0; i < s.count; ++i) {
    if (!s.is_of_frame(i)) continue;
    const int g = s.node[i];
    s.clear_fixed(i, s.force[i], s.moment[i]);
    const Mat3& j = s.model.node_inertia[g];
    const Vec3& omega = state.angular_velocity[g];
    state.acceleration[g] = state.algorithmic_acceleration[g] = s.force[i] / s.model.node_mass[g];
    state.angular_acceleration[g] = state.algorithmic_angular_acceleration[g] =
        j.inverse() * (state.rotation[g].conjugate() * s.moment[i] - omega.cross(j * omega));
  }
  return s.energy(now.law, motion_, s.contacts, sections_);
}

BodyEnergy FramePart::energy(const StepInputs& now, const State& state) {
  find_contacts(now, state);
  return system_.energy(now.law, motion_, contacts_, sections_);
}

void FramePart::advance(const StepSpan& span, State& next, PartScratch& scratch, PartOutcome& outcome) {
  IntegratorScratch& w = scratch.frame;
  {
    const InPhase phase(w.profile, Phase::forces);
    outcome.status =
        span.h <= explicit_reach(span.parameters)
            ? advance_in_substeps(span, next, w, outcome.exchanged)
            : traits(span.parameters.integrator).advance(system_, span, next, w, outcome.exchanged);
  }
  if (!outcome.status.ok()) return;
  const InPhase phase(w.profile, Phase::energy);
  outcome.held = system_.energy(span.end.law, w.trial, system_.contacts, sections_);
}

StepStatus FramePart::advance_in_substeps(const StepSpan& span, State& next, IntegratorScratch& w,
                                          StepEnergy& energy) {
  // as many in a shorter step: it is shorter so that its energy adds up
  const int count = static_cast<int>(std::ceil(k_most_substeps * span.parameters.substep_refinement));
  StepStatus status;
  StepInputs from = span.start;
  for (int k = 1; k <= count && status.ok(); ++k) {
    const StepInputs to =
        k == count ? span.end : StepInputs(span.parameters, span.start.time + k * span.h / count, from);
    status = advance_damped_central_difference(system_, {span.parameters, from, to, span.h / count, 0}, next,
                                               w, energy);
    from = to;
  }
  return status;
}

double FramePart::explicit_reach(const Parameters& parameters) {
  const Model& model = system_.model;
  if (!system_.rigid.empty() || std::any_of(system_.bodies.begin(), system_.bodies.end(),
                                            [&](int b) { return !may_take_substeps(model, parameters, b); }))
    return 0;
  const ContactLaw law = stiffest_law(parameters);
  double damping = 0;
  for (const int b : system_.bodies) damping = std::max(damping, damping_time(model, parameters, b));
  if (!substep_ || substep_->damping != damping || !(substep_->law == law))
    substep_ = {law, damping, k_explicit_share * explicit_limit(system_, &law, damping)};
  return k_most_substeps * substep_->step;
}

double FramePart::time_limit(const Parameters& parameters, const State& state) {
  const ContactLaw law = contact_law(parameters, state.time);
  system_.load(state, motion_);
  double limit = std::min(k_longest_step, member_limit(system_, motion_));
  int first = 0;
  for (const int b : system_.bodies) {
    const Body& body = system_.model.bodies[b];
    limit = std::min(limit, contact_limit(system_.model, body, law, motion_, first));
    if (const double omega = spin(body, motion_, first); omega * limit > k_turn) limit = k_turn / omega;
    first += body.node_count;
  }
  // the substeps are to resolve it, not the step that they make up
  return std::max(limit, std::min(k_most_substeps * limit, explicit_reach(parameters)));
}

void FramePart::find_contacts(const StepInputs& now, const State& state) {
  system_.load(state, motion_);
  system_.load_memory(state, motion_);
  system_.find_contacts(now.law, motion_, state.stick, motion_.position, contacts_);
}

void FramePart::list_forces(const Parameters&, const StepInputs& now, const State& state, Forces& forces) {
  find_contacts(now, state);
  for (const TouchingPair& pair : contacts_.planes)
    forces.contacts.push_back({pair.point, pair.plane, pair.depth, pair.out.normal, pair.out.force});
  forces.add(contacts_.members, system_.member_pairs());
  for (const RigidInSystem& one : system_.rigid) {
    const Body& body = system_.model.bodies[one.body];
    std::fill_n(sections_.begin() + body.first_element, body.element_count,
                SectionForces{Vec3::Zero(), Vec3::Zero()});
  }
}

HardestContact FramePart::hardest_contact(const HardestContact& hardest) {
  HardestContact found = hardest;
  const auto look = [&](double force, int local) {
    if (!(force > found.force)) return;
    const int node = system_.node[local];
    found = {force, system_.model.node_body[node], node, system_.element_at(node)};
  };
  for (const TouchingPair& pair : contacts_.planes) look(pair.out.normal, pair.node);
  for (const MemberTouch& touch : contacts_.members.touches)
    look(touch.out.normal, system_.member_pairs()[touch.pair].node[0]);
  return found;
}

}  // namespace topple
