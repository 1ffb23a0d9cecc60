// The solver side of a Recorder: which instants are recorded.
#include <cmath>

#include "solver/excitation.h"
#include "solver/io/recording_writer.h"
#include "solver/plasticity.h"

namespace topple::io {
namespace {

constexpr double k_checkpoint_rate = 1;  // Hz, of simulated time
constexpr std::uint8_t k_frame_rung = 2;

/// Says when k / rate has been reached for the next k. Steps that do not divide 1 / rate do not drift.
class Schedule {
 public:
  bool due(double time, double rate) {
    constexpr double slack = 1e-6;  // of an interval: time is a sum of rounded steps
    const double passed = std::floor(time * rate + slack);
    if (passed < next_) return false;
    next_ = passed + 1;
    return true;
  }

 private:
  double next_ = -std::numeric_limits<double>::infinity();
};

RowShape shape_of(const Model& model) {
  const State state = start_state(model, std::vector<BodyStart>(model.bodies.size()));
  return {.nodes = model.node_position.size(),
          .elements = model.elements.size(),
          .contacts = model.contact_points.size() * model.planes.size(),
          .bodies = model.bodies.size(),
          .state = pack(state).size()};
}

/// Kinetic, strain and gravity energy of a body, the last relative to the reference pose, J.
double body_energy(const Run& run, const Body& body) {
  const Model& model = run.setup().model;
  const State& state = run.state();
  double energy = 0;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    // Angular velocity is in material axes, which are the world axes of the reference pose: so is the
    // inertia.
    const Vec3& w = state.angular_velocity[k];
    energy += 0.5 * model.node_mass[k] * state.velocity[k].squaredNorm() +
              0.5 * w.dot(model.node_inertia[k] * w) -
              model.node_mass[k] * run.parameters().gravity.dot(state.position[k] - model.node_position[k]);
  }
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const Element& element = model.elements[static_cast<std::size_t>(e)];
    const SectionForces& f = run.sections()[static_cast<std::size_t>(e)];
    energy += element.length / 2 *
              (f.normal.dot(f.normal.cwiseQuotient(element.normal_stiffness)) +
               f.moment.dot(f.moment.cwiseQuotient(element.bending_stiffness)));
  }
  return energy;
}

void fill_nodes(const State& state, FrameRow& row) {
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3& x = state.position[i];
    const Quat& q = state.rotation[i];
    const double rotation[4] = {q.w(), q.x(), q.y(), q.z()};
    for (int k = 0; k < 3; ++k) row.position[3 * i + k] = static_cast<float>(x[k]);
    for (int k = 0; k < 4; ++k) row.rotation[4 * i + k] = static_cast<float>(rotation[k]);
  }
}

void fill_elements(const Run& run, FrameRow& row) {
  const Model& model = run.setup().model;
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    const Hinge hinge = run.state().elements[e].hinge;
    const double place = hinge_place(element, hinge);
    row.s[e] = static_cast<float>(-place);
    row.hinge[e] = static_cast<std::uint8_t>(hinge);
    const SectionForces forces = forces_along(run.sections()[e], element.length, element.s, place);
    const double values[6] = {forces.normal[0], forces.normal[1], forces.normal[2],
                              forces.moment[0], forces.moment[1], forces.moment[2]};
    for (int k = 0; k < 6; ++k) row.section_force[6 * e + k] = static_cast<float>(values[k]);
  }
}

void fill_contacts(const Run& run, FrameRow& row) {
  const std::size_t planes = run.setup().model.planes.size();
  for (const ContactForce& contact : run.contacts()) {
    const std::size_t c =
        static_cast<std::size_t>(contact.point) * planes + static_cast<std::size_t>(contact.plane);
    row.contact_depth[c] = static_cast<float>(contact.depth);
    for (int k = 0; k < 3; ++k) row.contact_force[3 * c + k] = static_cast<float>(contact.force[k]);
  }
}

void fill_bodies(const Run& run, FrameRow& row) {
  const Model& model = run.setup().model;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int index = static_cast<int>(b);
    const BodyPose pose = body_pose(model, run.state(), index);
    const double critical = critical_angle(model, index, pose);
    const double values[11] = {pose.centre.x(),
                               pose.centre.y(),
                               pose.centre.z(),
                               pose.rotation.w(),
                               pose.rotation.x(),
                               pose.rotation.y(),
                               pose.rotation.z(),
                               tilt(pose),
                               slide(model, index, pose),
                               body_energy(run, model.bodies[b]),
                               std::isfinite(critical) ? critical : 0};
    std::copy_n(values, 11, row.body.data() + 11 * b);
    row.rung[b] = k_frame_rung;
  }
}

}  // namespace

FrameRow frame_row(const Run& run) {
  const Model& model = run.setup().model;
  const State& state = run.state();
  FrameRow row = blank_row({.nodes = model.node_position.size(),
                            .elements = model.elements.size(),
                            .contacts = model.contact_points.size() * model.planes.size(),
                            .bodies = model.bodies.size()});
  row.step = state.step;
  row.time = state.time;
  fill_nodes(state, row);
  fill_elements(run, row);
  fill_contacts(run, row);
  fill_bodies(run, row);
  const EnergyLedger& e = state.energy;
  row.energy = {e.input,    e.kinetic,        e.strain,    e.gravity,        e.contact,
                e.friction, e.normal_damping, e.numerical, e.balance_error()};
  const Vec3 acceleration = floor_acceleration(run.parameters().shakes, state.time);
  for (int k = 0; k < 3; ++k) {
    row.floor_acceleration[k] = acceleration[k];
    row.floor_displacement[k] = state.floor_displacement[k];
  }
  return row;
}

struct Recorder::Impl {
  Impl(const std::string& path, const std::string& scene_name, const std::string& scene_text,
       const Model& model)
      : writer(path, scene_name, scene_text, model, shape_of(model)) {}

  void frame(const Run& run) {
    writer.append(frame_row(run));
    last_frame = run.state().step;
  }
  void checkpoint(const Run& run) {
    const State& state = run.state();
    writer.append(Checkpoint{
        .branch = 0, .step = state.step, .time = state.time, .hash = hash(state), .state = pack(state)});
    last_checkpoint = state.step;
  }
  void events(const Run& run) {
    for (; events_seen < run.events().size(); ++events_seen) {
      const Event& event = run.events()[events_seen];
      writer.append(RecordedEvent{.branch = 0, .step = event.step, .time = event.time, .event = event});
    }
  }

  RecordingWriter writer;
  Schedule frames, checkpoints;
  std::int64_t last_frame = -1, last_checkpoint = -1;
  std::size_t events_seen = 0;
};

Recorder::Recorder(const std::string& path, const std::string& scene_name, const std::string& scene_text,
                   const Model& model)
    : impl_(std::make_unique<Impl>(path, scene_name, scene_text, model)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::observe(const Run& run) {
  const double time = run.state().time;
  impl_->events(run);
  if (impl_->checkpoints.due(time, k_checkpoint_rate)) impl_->checkpoint(run);
  if (impl_->frames.due(time, run.setup().run.output_rate)) impl_->frame(run);
  impl_->writer.flush_if_due();
}

void Recorder::flush() {
  impl_->writer.flush();
}

void Recorder::finish(const Run& run, const std::string& status, const std::string& summary_json) {
  const std::int64_t step = run.state().step;
  impl_->events(run);
  if (impl_->last_checkpoint != step) impl_->checkpoint(run);
  if (impl_->last_frame != step) impl_->frame(run);
  impl_->writer.finish(status, summary_json);
}

}  // namespace topple::io
