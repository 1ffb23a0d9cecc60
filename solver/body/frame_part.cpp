#include "solver/body/frame_part.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/frame/integrator.h"
#include "solver/frame/settle.h"
#include "solver/state/step_limits.h"

namespace topple {
namespace {

// Mean rotation of a body's nodes, rad/s.
double spin(const Body& body, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    sum += state.rotation[i] * state.angular_velocity[i];
  return sum.norm() / body.node_count;
}

double contact_limit(const Model& model, const Body& body, const ContactLaw& law, const State& state) {
  double stiffness = 0, limit = std::numeric_limits<double>::infinity();
  for (int p = body.first_contact_point; p < body.first_contact_point + body.contact_point_count; ++p) {
    const ContactPoint& point = model.contact_points[p];
    for (const Plane& plane : model.planes) {
      const double L = contact_length(point, plane);
      const double gap = plane.normal.dot(state.position[point.node] - plane.point) - point.width / 2;
      const ContactAhead ahead = contact_ahead(law, gap, -plane.normal.dot(state.velocity[point.node]), L);
      stiffness += ahead.stiffness;
      limit = std::min(limit, ahead.limit);
    }
  }
  return std::min(limit, bounce_limit(body.mass, stiffness));
}

// For the members of the system's bodies that are near each other.
double member_limit(const BodySystem& system, const ContactLaw& law, const State& state) {
  const Model& model = system.model;
  double limit = std::numeric_limits<double>::infinity();
  if (system.candidate_pairs.empty()) return limit;
  std::vector<double> stiffness(system.bodies.size(), 0.);
  const auto add = [&](int element, double more) {
    const auto own = std::ranges::find(system.bodies, model.members[model.elements[element].member].body);
    if (own != system.bodies.end()) stiffness[own - system.bodies.begin()] += more;
  };
  for (const ElementPair& pair : system.candidate_pairs) {
    const int *m = model.elements[pair.a].node, *n = model.elements[pair.b].node;
    const auto& x = state.position;
    const auto& v = state.velocity;
    const NearestPoints at = nearest_points(x[m[0]], x[m[1]], x[n[0]], x[n[1]]);
    const double L = contact_length(model, pair), l = at.between.norm();
    const Vec3 relative = (1 - at.s) * v[m[0]] + at.s * v[m[1]] - (1 - at.t) * v[n[0]] - at.t * v[n[1]];
    const ContactAhead ahead = contact_ahead(law, l - L, -relative.dot(at.between) / l, L, true);
    add(pair.a, ahead.stiffness);
    add(pair.b, ahead.stiffness);
    limit = std::min(limit, ahead.limit);
  }
  for (std::size_t b = 0; b < stiffness.size(); ++b)
    limit = std::min(limit, bounce_limit(model.bodies[system.bodies[b]].mass, stiffness[b]));
  return limit;
}

}  // namespace

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
  s.load_memory(state);
  s.evaluate(parameters, now, motion_, state.stick, motion_.position);
  for (int i = 0; i < s.count; ++i) {
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
    outcome.status = traits(span.parameters.integrator).advance(system_, span, next, w, outcome.exchanged);
  }
  if (!outcome.status.ok()) return;
  const InPhase phase(w.profile, Phase::energy);
  outcome.held = system_.energy(span.end.law, w.trial, system_.contacts, sections_);
}

double FramePart::time_limit(const Parameters& parameters, const State& state) {
  const ContactLaw law = contact_law(parameters, state.time);
  double limit = std::min(k_longest_step, member_limit(system_, law, state));
  for (const int b : system_.bodies) {
    const Body& body = system_.model.bodies[b];
    limit = std::min(limit, contact_limit(system_.model, body, law, state));
    if (const double omega = spin(body, state); omega * limit > k_turn) limit = k_turn / omega;
  }
  return limit;
}

void FramePart::find_contacts(const StepInputs& now, const State& state) {
  system_.load(state, motion_);
  system_.load_memory(state);
  system_.find_contacts(now.law, motion_, state.stick, motion_.position, contacts_);
}

void FramePart::list_forces(const StepInputs& now, const State& state, Forces& forces) {
  find_contacts(now, state);
  for (const TouchingPair& pair : contacts_.planes)
    forces.contacts.push_back({pair.point, pair.plane, pair.depth, pair.out.normal, pair.out.force});
  for (const MemberTouch& touch : contacts_.members.touches)
    forces.members.push_back(
        {system_.candidate_pairs[touch.pair], touch.at.s, touch.at.t, touch.depth, touch.out.force});
}

HardestContact FramePart::hardest_contact(const HardestContact& hardest) {
  HardestContact found = hardest;
  const auto look = [&](double force, int local) {
    if (!(force > found.force)) return;
    const int node = system_.node[local];
    found = {force, system_.model.node_body[node], node, system_.element_at(node)};
  };
  for (const TouchingPair& pair : system_.contacts.planes) look(pair.out.normal, pair.node);
  for (const MemberTouch& touch : system_.contacts.members.touches)
    look(touch.out.normal, system_.member_pairs()[touch.pair].node[0]);
  return found;
}

}  // namespace topple
