#include "solver/study/penalty/contact_trials.h"
#include "solver/body/body_pose.h"
#include "solver/contact/contact_law.h"

#include <algorithm>
#include <cmath>

namespace topple::study {
namespace {

ContactTrial failed(const StepStatus& status) {
  switch (status.kind) {
    case StepStatus::Kind::not_settled:
      return {{}, "not settled"};
    case StepStatus::Kind::step_too_long:
      return {{}, "step too long"};
    default:
      return {{}, "diverged"};
  }
}

}  // namespace

ContactTrial settled_depth(const Setup& body) {
  const Run run(body);
  if (!run.status().ok()) return failed(run.status());
  double deepest = 0;
  for (const ContactForce& contact : run.contacts()) deepest = std::max(deepest, contact.depth);
  return {deepest};
}

ContactTrial creep(const Setup& body, double duration) {
  Setup setup = body;
  setup.run.duration = duration;
  Run run(setup);
  const std::vector<Vec3> start = run.state().position;
  while (!run.over()) run.advance();
  if (!run.status().ok()) return failed(run.status());
  double way = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    way = std::max(way, (run.state().position[i] - start[i]).norm());
  return {way};
}

ContactTrial settled_frequency(const Setup& body, double expected) {
  constexpr int k_steps = 100, k_periods = 4;  // a period
  constexpr double k_heavier = 1.05;
  Setup setup = body;
  Parameters& p = setup.parameters;
  p.contact = law_at_rest(p.contact);
  p.integrator = Integrator::generalized_alpha;
  p.spectral_radius = 1;
  p.adaptive = false;
  p.time_step = 1 / (k_steps * expected);
  const Run settled(setup);
  if (!settled.status().ok()) return failed(settled.status());
  State state = settled.state();
  p.gravity *= k_heavier;
  Workspace workspace(setup.model);
  prepare(setup.model, p, state, workspace);
  double before = 0, first = 0, last = 0;
  int upturns = 0;
  for (int k = 0; k < k_steps * (k_periods + 1); ++k) {
    const StepStatus status = step(setup.model, p, state, workspace);
    if (!status.ok()) return failed(status);
    const double speed = body_momentum(setup.model, state, 0).velocity.z();
    if (before < 0 && speed >= 0) {
      last = state.time - p.time_step * speed / (speed - before);
      if (upturns++ == 0) first = last;
    }
    before = speed;
  }
  if (upturns < 2) return {{}, "does not oscillate"};
  return {(upturns - 1) / (last - first)};
}

ContactTrial settled_tipping_limit(const Setup& body, const Standing& theory) {
  constexpr double k_exact = 1e-4;
  Setup setup = body;
  StepStatus status;
  const auto holds = [&](double push) {
    setup.parameters.gravity = theory.gravity * (push * theory.direction - Vec3::UnitZ());
    status = Run(setup).status();
    return status.ok();
  };
  if (!holds(0)) return failed(status);
  double low = 0, high = 1.05 * theory.rigid_limit();
  while (high - low > k_exact * theory.rigid_limit()) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return {(low + high) / 2};
}

ContactTrial fall_back(const Setup& body, const Standing& theory) {
  Setup setup = body;
  setup.run.settle = false;
  setup.run.duration = 10 / theory.p();
  const Vec3 axis = Vec3::UnitZ().cross(theory.direction);
  setup.starts = {{.pivot = theory.edge, .rotation = theory.critical() / 2 * axis}};
  Run run(setup);
  double before = theory.critical() / 2, time = 0;
  while (!run.over()) {
    run.advance();
    const Vec3 up = body_pose(setup.model, run.state(), 0).rotation * Vec3::UnitZ();
    const double lean = std::atan2(theory.direction.dot(up), up.z()), now = run.state().time;
    if (lean <= 0) return {now - (now - time) * lean / (lean - before)};
    if (lean > 1.2 * theory.critical()) return {{}, "falls over"};
    before = lean;
    time = now;
  }
  return run.status().ok() ? ContactTrial{{}, "no return"} : failed(run.status());
}

ContactTrial overturning_half_sine(const Setup& body, const Standing& theory, double ratio, double expected) {
  constexpr double k_exact = 1e-3;
  constexpr double k_tried[] = {0.96, 0.88, 0.75, 0.55, 0.3};  // of what is expected, downwards
  Setup setup = body;
  Shake pulse;
  pulse.kind = Shake::Kind::pulse;
  pulse.shape = Shake::Shape::half_sine;
  pulse.direction = -theory.direction;  // of the floor
  pulse.duration = k_pi / (ratio * theory.p());
  setup.run.duration = pulse.duration + 20 / theory.p();
  StepStatus status;
  const auto falls = [&](double amplitude) {
    pulse.amplitude = amplitude * theory.gravity;
    setup.parameters.shakes = {pulse};
    Run run(setup);
    double peak = 0;
    while (!run.over()) {
      run.advance();
      const double tilt = run.outcome().bodies()[0].tilt;
      peak = std::max(peak, tilt);
      if (run.state().time < pulse.duration) continue;
      if (tilt > 1.2 * theory.critical()) return true;
      if (tilt < 0.9 * peak) return false;
    }
    if (!run.status().ok()) status = run.status();
    return false;
  };
  double low = expected, high = 1.04 * expected;
  if (!falls(high)) {
    low = high;
    high = 1.3 * expected;
    if (status.ok() && !falls(high) && status.ok()) return {{}, "stands at 1.3 of theory"};
  } else {
    for (const double share : k_tried) {
      low = share * expected;
      if (!status.ok() || !falls(low)) break;
      high = low;
    }
    if (high == low) return {{}, "falls at 0.3 of theory"};
  }
  while (status.ok() && high - low > k_exact * expected) {
    const double middle = (low + high) / 2;
    (falls(middle) ? high : low) = middle;
  }
  if (!status.ok()) return failed(status);
  return {(low + high) / 2};
}

}  // namespace topple::study
