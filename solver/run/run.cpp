#include "solver/run/run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/body/model_level.h"
#include "solver/body/step_control.h"
#include "solver/frame/integrator.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/model/excitation.h"
#include "solver/state/sections.h"
#include "solver/step/dense_output.h"

namespace topple {
namespace {

constexpr double k_rest_speed = 1e-4;  // m/s, stop_when = "at-rest"
constexpr double k_rest_floor = 1e-6;  // m/s^2
constexpr double k_rest_for = 0.5;     // s

/// Nothing has come of it yet.
RunPoint point_at(const Setup& setup, State state, Parameters parameters) {
  return {.state = std::move(state),
          .parameters = std::move(parameters),
          .outcome = Outcome(setup.model, setup.starts),
          .probes = std::vector<ProbeOutcome>(setup.probes.size()),
          .places = std::vector<PlaceOutcome>(setup.room.places.size())};
}

}  // namespace

Run::Run(const Setup& setup, Parameters parameters)
    : setup_(&setup),
      now_(point_at(setup, start_state(setup.model, setup.starts), std::move(parameters))),
      workspace_(setup.model) {
  start();
}

void Run::start() {
  const Model& model = setup_->model;
  const Parameters& parameters = now_.parameters;
  State state = start_state(model, setup_->starts);
  if (is_static()) {
    path_.emplace(model, setup_->run.statics);
    status_ = path_->start(parameters, setup_->run.settle, state);
    if (status_.ok()) resume(model, state, workspace_);
  } else {
    status_ = setup_->run.settle ? settle(model, parameters, state, workspace_) : StepStatus{};
    if (status_.ok()) {
      prepare(model, parameters, state, workspace_);
      status_ = look_at_numbers(model, parameters, state, true);
    }
  }
  if (!status_.ok()) return;
  now_ = point_at(*setup_, std::move(state), std::move(now_.parameters));
  placed_ = is_static();
  events_.clear();
  observe();
}

Run::Run(const Setup& setup, State state, Parameters parameters)
    : Run(setup, point_at(setup, std::move(state), std::move(parameters))) {
  if (!status_.ok()) return;
  now_.counted_from = now_.state.time;
  observe();
  events_.clear();
}

Run::Run(const Setup& setup, RunPoint point)
    : setup_(&setup), now_(std::move(point)), workspace_(setup.model) {
  status_ = look_at_numbers(setup.model, now_.parameters, now_.state, true);
  if (!status_.ok()) return;
  if (is_static()) path_.emplace(setup.model, setup.run.statics);
  resume(setup.model, now_.state, workspace_);
  find_acting(contact_forces(setup.model, now_.parameters, now_.state, workspace_), now_acting_);
}

const RunPoint& Run::point() const {
  if (!placed_) place_nodes(setup_->model, now_.state);
  placed_ = true;
  return now_;
}

StepStatus Run::advance() {
  if (path_) {
    advance_load();
    return status_;
  }
  placed_ = false;
  const double start = now_.state.time;
  status_ = topple::step(setup_->model, now_.parameters, now_.state, workspace_, setup_->run.duration);
  now_.newton_iterations += status_.newton_iterations;
  now_.rejected_steps += status_.rejected;
  if (status_.ok()) {
    const InPhase phase(&workspace_.profile(), Phase::observe);
    observe_stresses_since(start);
    observe_peaks();
    observe(contact_forces_after_step(now_.state, workspace_));
  } else {
    contact_forces(setup_->model, now_.parameters, now_.state, workspace_);  // not those of what was tried
  }
  return status_;
}

// A load step that fails leaves what converged of it. One that was to end the path where it does is none.
void Run::advance_load() {
  const double factor = now_.state.load_factor;
  status_ = path_->advance(now_.parameters, now_.state);
  now_.newton_iterations += status_.newton_iterations;
  now_.rejected_steps += status_.rejected;
  if (now_.state.load_factor != factor || status_.ok()) {
    now_.load_steps.push_back({now_.state.load_factor, true, path_->stability()});
    resume(setup_->model, now_.state, workspace_);
    observe();
  }
  if (status_.ok()) return;
  now_.load_steps.push_back({status_.load_factor, false, status_.stability});
  using Loss = Stability::Loss;
  const Loss loss = status_.stability.loss;
  now_.stopped_early =
      setup_->run.statics.stop_at_instability && loss != Loss::none && loss != Loss::fracture;
  if (now_.stopped_early) status_ = {};
}

void Run::edit(std::span<const Edit> edits) {
  for (const Edit& edit : edits) apply(edit, setup_->model, now_.state.time, now_.parameters);
  status_ = {};
  if (step() == 0) start();
}

bool Run::over() const {
  if (is_static())
    return !status_.ok() || now_.stopped_early || now_.state.step >= setup_->run.statics.load_steps;
  if (setup_->run.analysis == Analysis::modes) return true;
  const double slack = now_.parameters.adaptive ? k_least_step : now_.parameters.time_step / 2;
  return !status_.ok() || now_.stopped_early || now_.state.time > setup_->run.duration - slack;
}

std::optional<double> Run::stable_step() {
  const double share = stable_share(now_.parameters);
  const std::optional<double> limit = explicit_limit(workspace_);
  return limit && std::isfinite(share) ? std::optional(share * *limit) : std::nullopt;
}

void Run::find_acting(const std::vector<ContactForce>& contacts, Acting& acting) const {
  acting.contacts.reserve(setup_->model.contact_points.size() * setup_->model.planes.size());
  acting.contacts = contacts;
  acting.between_members = member_forces(workspace_);
  acting.sections_found = false;
}

Snapshot Run::view(const State& state, Acting& acting) const {
  if (!std::exchange(acting.sections_found, true)) {
    bool stressed = path_.has_value();
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      const LevelTraits& level = traits(state.bodies[b].level);
      stressed = stressed || level.has_stresses;
      if (level.has_modes) find_section_forces(state, static_cast<int>(b), workspace_);
    }
    if (stressed || acting.stressed)
      acting.sections = section_forces(workspace_);  // of a room, they are many
    acting.stressed = stressed;
    if (path_) path_->add_weight(now_.parameters, state, acting.sections);
  }
  return {state, acting.contacts, acting.between_members, acting.sections};
}

Snapshot Run::snapshot() const {
  return view(state(), now_acting_);
}

Snapshot Run::snapshot(double time) const {
  look_within(time);
  place_nodes(setup_->model, within_);
  return view(within_, within_acting_);
}

void Run::look_within(double time) const {
  const Model& model = setup_->model;
  state_within_step(model, now_.state, time, workspace_, within_);
  find_acting(contact_forces(model, now_.parameters, within_, workspace_), within_acting_);
  view(within_, within_acting_);
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (traits(within_.bodies[b].level).moves_nodes)
      section_forces(model, within_, static_cast<int>(b), within_acting_.sections);
  contact_forces(model, now_.parameters, now_.state, workspace_);  // as the newest step left them
}

void Run::observe_stresses_since(double start) {
  const double rate = setup_->run.output_rate, end = now_.state.time;
  const auto has_stresses = [](const BodyState& body) { return traits(body.level).has_stresses; };
  if (ranges::none_of(now_.state.bodies, has_stresses)) return;
  if (within_.bodies.empty()) look_within(end);  // takes its memory with the first step
  for (double row = std::floor(start * rate + k_row_slack) + 1; row < end * rate - k_row_slack; ++row) {
    look_within(row / rate);
    for (std::size_t b = 0; b < within_.bodies.size(); ++b)
      if (has_stresses(within_.bodies[b]))
        now_.outcome.observe_stresses(setup_->model, static_cast<int>(b), within_acting_.sections);
  }
}

// Of an elastic body they are found only where they may be more than before. Its state's peak does not know
// the times within steps, which go by what is recorded, and is a checkpoint's own.
void Run::observe_stresses() {
  const std::vector<SectionForces>& sections =
      path_ ? view(now_.state, now_acting_).sections : section_forces(workspace_);
  for (std::size_t b = 0; b < now_.state.bodies.size(); ++b) {
    const LevelTraits& level = traits(now_.state.bodies[b].level);
    const BodyOutcome& o = now_.outcome.bodies()[b];
    double& peak = now_.state.bodies[b].peak_stress;
    const int body = static_cast<int>(b);
    if (!level.has_stresses) continue;
    if (level.has_modes) {
      const double least = std::min(peak, o.peak_stress);
      if (least > 0 && !may_exceed(now_.state, body, least, o.peak_yield_ratio.value_or(0), workspace_))
        continue;
      find_section_forces(now_.state, body, workspace_);
    }
    const double greatest = now_.outcome.observe_stresses(setup_->model, body, sections);
    if (setup_->model.bodies[b].elastic && now_.state.time > now_.counted_from)
      peak = std::max(peak, greatest);
  }
}

void Run::observe_peaks() {
  if (within_.bodies.empty()) within_ = now_.state;  // takes its memory with the first step
  now_.outcome.observe_peaks(setup_->model, now_.state, [this](double time) -> const State& {
    state_within_step(setup_->model, now_.state, time, workspace_, within_);
    return within_;
  });
}

void Run::observe() {
  observe(contact_forces(setup_->model, now_.parameters, now_.state, workspace_));
}

void Run::observe(const std::vector<ContactForce>& contact_forces) {
  const Model& model = setup_->model;
  const State& state = now_.state;
  find_acting(contact_forces, now_acting_);
  if (!setup_->probes.empty() || !now_.places.empty() || setup_->run.stop_when == StopWhen::at_rest) point();
  observe_stresses();
  now_.outcome.observe(model, now_.parameters, state, contacts(), member_contacts(), events_);

  for (std::size_t k = 0; k < now_.probes.size(); ++k) {
    const Probe& probe = setup_->probes[k];
    ProbeOutcome& out = now_.probes[k];
    if (probe.node >= 0) {
      out.displacement = state.position[probe.node] - model.node_position[probe.node];
      out.rotation = log_quaternion(state.rotation[probe.node]);
    } else {
      const BodyPose pose = body_pose(model, state, probe.body);
      out.displacement = pose.centre - model.bodies[probe.body].centre_of_gravity;
      out.rotation = log_quaternion(pose.rotation);
    }
    for (int i = 0; i < 3; ++i)
      if (std::abs(out.displacement[i]) > std::abs(out.peak[i])) {
        out.peak[i] = out.displacement[i];
        out.peak_time[i] = state.time;
      }
  }

  if (!now_.places.empty()) observe_hits(setup_->room, model, state.position, state.time, now_.places);
  if (is_static()) return;
  if (setup_->run.stop_when == StopWhen::all_overturned)
    now_.stopped_early = now_.outcome.all_overturned(state.time);
  if (setup_->run.stop_when == StopWhen::at_rest) {
    double speed = floor_acceleration(now_.parameters.shakes, state.time).norm() > k_rest_floor ? 1 : 0;
    for (const Vec3& v : state.velocity) speed = std::max(speed, v.norm());
    if (speed > k_rest_speed)
      now_.rest_since.reset();
    else if (!now_.rest_since)
      now_.rest_since = state.time;
    now_.stopped_early = now_.rest_since && state.time - *now_.rest_since >= k_rest_for;
  }
}

}  // namespace topple
