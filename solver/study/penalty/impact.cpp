#include "solver/study/penalty/impact.h"

#include <algorithm>
#include <cmath>

#include "solver/body/body_pose.h"
#include "solver/contact/contact_law.h"
#include "solver/model/body_builder.h"
#include "solver/step/step.h"

namespace topple::study {
namespace {

constexpr int k_nodes = 3;  // of one member

/// f of the header: the normal force over P at the separating speed v.
double share(const ContactLaw& law, double v) {
  const auto [loss, smoothing] = traits(law).normal_loss(law);
  return 1 - loss * v / std::hypot(v, smoothing);
}

/// integral of v/f(sign v) from 0 to `speed`, with Simpson's rule.
double exchanged(const ContactLaw& law, double speed, double sign) {
  constexpr int k_intervals = 2000;
  constexpr double k_none = 1e-12;  // rounding of a share that vanishes
  const double h = speed / k_intervals;
  double sum = 0;
  for (int k = 0; k <= k_intervals; ++k) {
    const double v = k * h, weight = k == 0 || k == k_intervals ? 1 : k % 2 == 1 ? 4 : 2;
    sum += weight * v / std::max(share(law, sign * v), k_none);
  }
  return sum * h / 3;
}

/// A stiff bar whose nodes weigh the same and touch the floor all at once: one mass on three contacts.
Model bar(double mass, double L) {
  Model model;
  model.materials.push_back({.name = "rigid", .young = 1e13, .poisson = 0.3});
  Section section;
  section.shape = Section::Shape::solid;
  section.size_y = section.size_z = L;
  complete_section(section, model.materials.front().poisson);
  model.sections.push_back(section);
  BodyBuilder builder(model, "bar");
  for (const int node :
       builder.line("bar", {-1.7 * L, 0, L / 2}, {1.7 * L, 0, L / 2}, 1, 2, 0, 0, Vec3::UnitZ())) {
    model.node_mass[node] = mass / k_nodes;
    model.node_inertia[node] = mass * L * L * Mat3::Identity();
    builder.add_contact_point(node, L);
  }
  builder.close();
  model.planes.push_back({"floor", Vec3::Zero(), Vec3::UnitZ(), L});
  return model;
}

/// Time in which a linear contact would stop and return the mass, s.
double contact_time(const ImpactMass& body, const ContactLaw& law, double speed) {
  const double energy = 0.5 * body.mass * speed * speed / (body.contacts * law.alpha * body.L / (law.q + 1));
  const double depth = std::pow(energy, 1 / (law.q + 1));
  return k_pi * depth * body.L / speed;
}

}  // namespace

double restitution(const ContactLaw& law, double speed) {
  if (!traits(law).stores_energy) return 0;
  const double taken = exchanged(law, speed, -1);
  double low = 0, high = speed;
  while (high - low > 1e-10 * speed) {
    const double middle = (low + high) / 2;
    (exchanged(law, middle, 1) < taken ? low : high) = middle;
  }
  return high / speed;
}

ContactTrial impact(const ImpactMass& body, const Parameters& scene, double speed) {
  constexpr double k_long = 40;  // contact times
  const Model model = bar(body.mass * k_nodes / body.contacts, body.L);
  Parameters parameters = scene;
  parameters.gravity.setZero();
  parameters.shakes.clear();
  State state = start_state(model, {{.velocity = {0, 0, -speed}}});
  Workspace workspace(model);
  prepare(model, parameters, state, workspace);
  const double end = k_long * contact_time(body, parameters.contact, speed);
  bool met = false;
  while (state.time < end) {
    if (const StepStatus status = step(model, parameters, state, workspace); !status.ok())
      return {{}, status.kind == StepStatus::Kind::step_too_long ? "step too long" : "diverged"};
    const bool touches = !contact_forces(model, parameters, state, workspace).empty();
    if (met && !touches) return {body_momentum(model, state, 0).velocity.z() / speed};
    met = met || touches;
  }
  return {0., "does not leave the floor"};
}

}  // namespace topple::study
