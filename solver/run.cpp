#include "solver/run.h"

#include <algorithm>
#include <cmath>

#include "solver/excitation.h"
#include "solver/rotation.h"

namespace topple {
namespace {

constexpr double k_rest_speed = 1e-4;  // m/s, stop_when = "at-rest"
constexpr double k_rest_floor = 1e-6;  // m/s^2
constexpr double k_rest_for = 0.5;     // s

}  // namespace

Run::Run(const Setup& setup)
    : setup_(&setup),
      state_(start_state(setup.model, setup.starts)),
      workspace_(setup.model),
      outcome_(setup.model),
      probes_(setup.probes.size()) {
  if (setup.run.settle) status_ = settle(setup.model, setup.parameters, state_, workspace_);
  if (!status_.ok()) return;
  prepare(setup.model, setup.parameters, state_, workspace_);
  observe();
}

Run::Run(const Setup& setup, State state)
    : setup_(&setup),
      state_(std::move(state)),
      workspace_(setup.model),
      outcome_(setup.model),
      probes_(setup.probes.size()) {
  resume(setup.model, state_, workspace_);
  observe();
}

StepStatus Run::advance() {
  status_ = step(setup_->model, setup_->parameters, state_, workspace_);
  newton_iterations_ += status_.newton_iterations;
  rejected_steps_ += status_.rejected;
  if (status_.ok()) observe();
  return status_;
}

bool Run::over() const {
  return !status_.ok() || stopped_early_ ||
         state_.time > setup_->run.duration - setup_->parameters.time_step / 2;
}

void Run::observe() {
  const Model& model = setup_->model;
  contacts_ = contact_forces(model, setup_->parameters, state_, workspace_);
  sections_ = section_forces(workspace_);
  outcome_.observe(model, setup_->parameters, state_, contacts_, sections_, events_);

  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const Probe& probe = setup_->probes[k];
    ProbeOutcome& out = probes_[k];
    if (probe.node >= 0) {
      out.displacement = state_.position[probe.node] - model.node_position[probe.node];
      out.rotation = log_quaternion(state_.rotation[probe.node]);
    } else {
      const BodyPose pose = body_pose(model, state_, probe.body);
      out.displacement = pose.centre - model.bodies[probe.body].centre_of_gravity;
      out.rotation = log_quaternion(pose.rotation);
    }
    for (int i = 0; i < 3; ++i)
      if (std::abs(out.displacement[i]) > std::abs(out.peak[i])) {
        out.peak[i] = out.displacement[i];
        out.peak_time[i] = state_.time;
      }
  }

  if (setup_->run.stop_when == StopWhen::all_overturned)
    stopped_early_ = outcome_.all_overturned(state_.time);
  if (setup_->run.stop_when == StopWhen::at_rest) {
    double speed = floor_acceleration(setup_->parameters.shakes, state_.time).norm() > k_rest_floor ? 1 : 0;
    for (const Vec3& v : state_.velocity) speed = std::max(speed, v.norm());
    if (speed > k_rest_speed)
      rest_since_.reset();
    else if (!rest_since_)
      rest_since_ = state_.time;
    stopped_early_ = rest_since_ && state_.time - *rest_since_ >= k_rest_for;
  }
}

}  // namespace topple
