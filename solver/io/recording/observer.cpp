#include "solver/io/recording/observer.h"

#include <algorithm>
#include <cmath>

#include "solver/body/anchors.h"
#include "solver/body/body_pose.h"
#include "solver/element/plasticity.h"
#include "solver/math/ranges.h"
#include "solver/model/excitation.h"

namespace topple::io {
namespace {

constexpr double k_checkpoint_rate = 1;  // Hz, of simulated time

/// Multiples of 1 / rate up to `time`.
double intervals(double time, double rate) {
  return std::floor(time * rate + k_row_slack);
}

/// Kinetic, strain and gravity energy of a body, the last relative to the reference pose, J.
double body_energy(const Run& run, const Snapshot& at, const Body& body) {
  const Model& model = run.setup().model;
  const State& state = at.state;
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
    const SectionForces& f = at.sections[static_cast<std::size_t>(e)];
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

std::uint8_t hinge_code(const Element& element, const ElementState& state) {
  if (state.hinge != Hinge::none) return static_cast<std::uint8_t>(state.hinge);
  const Hinge flowed = flowed_at(element, state);
  return flowed == Hinge::none     ? 0
         : flowed == Hinge::first  ? k_flowed_first
         : flowed == Hinge::second ? k_flowed_second
                                   : k_flowed_both;
}

// Where the section forces of a row are told: at a hinge, else where they are integrated.
double stress_place(const Element& element, Hinge hinge) {
  return hinge == Hinge::first    ? element.hinge_place[0]
         : hinge == Hinge::second ? element.hinge_place[1]
                                  : -element.s;
}

void fill_elements(const Model& model, const Snapshot& at, FrameRow& row) {
  for (std::size_t e = 0; e < model.elements.size(); ++e) {
    const Element& element = model.elements[e];
    const Hinge hinge = at.state.elements[e].hinge;
    const double place = stress_place(element, hinge);
    row.s[e] = static_cast<float>(-place);
    row.hinge[e] = hinge_code(element, at.state.elements[e]);
    const SectionForces forces = forces_along(at.sections[e], element.length, element.s, place);
    const double values[6] = {forces.normal[0], forces.normal[1], forces.normal[2],
                              forces.moment[0], forces.moment[1], forces.moment[2]};
    for (int k = 0; k < 6; ++k) row.section_force[6 * e + k] = static_cast<float>(values[k]);
  }
}

void fill_contacts(const Model& model, const Snapshot& at, FrameRow& row) {
  const std::size_t planes = model.planes.size();
  for (const ContactForce& contact : at.contacts) {
    const std::size_t c =
        static_cast<std::size_t>(contact.point) * planes + static_cast<std::size_t>(contact.plane);
    row.contact_depth[c] = static_cast<float>(contact.depth);
    for (int k = 0; k < 3; ++k) row.contact_force[3 * c + k] = static_cast<float>(contact.force[k]);
  }
}

void fill_contacts_between(const Snapshot& at, FrameRow& row) {
  struct Resultant {
    Vec3 force = Vec3::Zero();
    double size = 0, t = 0, u = 0;  // sums of |force|, and of |force| times place
  };
  const std::size_t elements = row.member_contact.size() / 4, panels = row.panel_contact.size() / 5;
  std::vector<Resultant> all(elements + panels);
  const auto add = [&](int part, const Vec3& force, double t, double u) {
    Resultant& on = all[static_cast<std::size_t>(part)];
    const double size = force.norm();
    on.force += force;
    on.size += size;
    on.t += size * t;
    on.u += size * u;
  };
  for (const MemberForce& contact : at.between_members) {
    add(contact.elements.a, contact.force, contact.s, 0);
    add(contact.elements.b, -contact.force, contact.t, contact.u);
  }
  const auto fill = [](const Resultant& on, int places, float* to) {
    if (!(on.size > 0)) return;
    for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(on.force[k]);
    to[3] = static_cast<float>(on.t / on.size);
    if (places > 1) to[4] = static_cast<float>(on.u / on.size);
  };
  for (std::size_t e = 0; e < elements; ++e) fill(all[e], 1, &row.member_contact[4 * e]);
  for (std::size_t k = 0; k < panels; ++k) fill(all[elements + k], 2, &row.panel_contact[5 * k]);
}

void fill_bodies(const Run& run, const Snapshot& at, FrameRow& row) {
  const Model& model = run.setup().model;
  const std::vector<Bearer>& bearers = run.outcome().bearers();
  std::vector<BodyPose> poses;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    poses.push_back(body_pose(model, at.state, static_cast<int>(b)));
  std::vector<Stack> stacks;
  find_stacks(model, bearers, poses, stacks);
  for (std::size_t b = 0; b < poses.size(); ++b) {
    const int index = static_cast<int>(b);
    const BodyPose& pose = poses[b];
    const double critical = critical_angle(model, index, pose, stacks[b]);
    const Vec3& x = pose.centre;
    const Quat& q = pose.rotation;
    row.body[b] = {.x = x.x(),
                   .y = x.y(),
                   .z = x.z(),
                   .qw = q.w(),
                   .qx = q.x(),
                   .qy = q.y(),
                   .qz = q.z(),
                   .tilt = tilt(pose),
                   .slide = slide(model, index, pose, bearers[b], bearer_pose(poses, bearers[b].body)),
                   .energy = body_energy(run, at, model.bodies[b]),
                   .critical_angle = std::isfinite(critical) ? critical : 0};
    row.level[b] = static_cast<std::uint8_t>(at.state.bodies[b].level);
  }
}

void fill_anchors(const Model& model, const State& state, FrameRow& row) {
  const std::vector<AnchorForce> forces = anchor_forces(model, state);
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const AnchorState& anchor = state.anchors[k];
    const float look = anchor.hold == AnchorHold::away     ? k_anchor_away
                       : anchor.hold == AnchorHold::broken ? k_anchor_broken
                       : forces[k].tension == 0            ? k_anchor_slack
                                                           : k_anchor_holds;
    row.anchor[k] = {.tension = static_cast<float>(forces[k].tension),
                     .energy = static_cast<float>(forces[k].energy),
                     .natural_length = static_cast<float>(anchor.length),
                     .state = look};
  }
}

bool is_static(const Run& run) {
  return run.setup().run.analysis == Analysis::statics;
}

// Its time is a multiple of the output interval where it is but for rounding.
FrameRow row_of(const Run& run, const Snapshot& at) {
  const Model& model = run.setup().model;
  const State& state = at.state;
  FrameRow row = blank_row(row_shape(model));
  row.step = state.step;
  const double rate = run.setup().run.output_rate, multiple = std::round(state.time * rate);
  const bool rounded = std::abs(state.time * rate - multiple) < k_row_slack;
  row.time = rounded && !is_static(run) ? multiple / rate : state.time;
  fill_nodes(state, row);
  fill_elements(model, at, row);
  fill_contacts(model, at, row);
  fill_contacts_between(at, row);
  fill_bodies(run, at, row);
  for (const EnergyTraits& column : energy_columns(!model.anchors.empty()))
    row.energy[column.kind] = column.value(state.energy);
  fill_anchors(model, state, row);
  row.load_factor = state.load_factor;
  const Vec3 acceleration = floor_acceleration(run.parameters().shakes, state.time);
  for (int k = 0; k < 3; ++k) {
    row.floor_acceleration[k] = acceleration[k];
    row.floor_displacement[k] = state.floor_displacement[k];
  }
  return row;
}

}  // namespace

bool is_finite(const Checkpoint& checkpoint) {
  return std::isfinite(checkpoint.time) &&
         ranges::all_of(checkpoint.state, [](double x) { return std::isfinite(x); });
}

double kinetic_energy(const Model& model, const Vec3& gravity, const FrameRow& row, int index) {
  const Body& body = model.bodies[static_cast<std::size_t>(index)];
  double energy = row.body[static_cast<std::size_t>(index)].energy;
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 x(row.position[3 * k], row.position[3 * k + 1], row.position[3 * k + 2]);
    energy += model.node_mass[k] * gravity.dot(x - model.node_position[k]);
  }
  for (int i = body.first_element; i < body.first_element + body.element_count; ++i) {
    const auto e = static_cast<std::size_t>(i);
    const Element& element = model.elements[e];
    const float* f = &row.section_force[6 * e];
    energy -= section_energy(element, forces_along({{f[0], f[1], f[2]}, {f[3], f[4], f[5]}}, element.length,
                                                   row.s[e], -element.s));
  }
  return std::max(energy, 0.);
}

FrameRow frame_row(const Run& run) {
  return row_of(run, run.snapshot());
}

FrameRow frame_row(const Run& run, double time) {
  return row_of(run, run.snapshot(time));
}

bool is_ahead(const Run& run, double time) {
  return (time - run.time()) * run.setup().run.output_rate > k_row_slack;
}

FrameRow frame_row_due(const Run& run, double time) {
  const bool within = (run.time() - time) * run.setup().run.output_rate > k_row_slack;
  return within ? frame_row(run, time) : frame_row(run);
}

void Observer::add_frame(FrameRow row, Observation& out) {
  out.frames.push_back(std::move(row));
  out.frames.back().branch = branch_;
  last_frame_ = out.frames.back().step;
}

void Observer::add_checkpoint(const Run& run, Observation& out) {
  const State& state = run.state();
  out.checkpoint = {
      .branch = branch_, .step = state.step, .time = state.time, .hash = hash(state), .state = pack(state)};
  last_checkpoint_ = state.step;
}

std::vector<RecordedEvent> events_on(const std::vector<Stretch>& way, const std::vector<RecordedEvent>& all) {
  std::vector<RecordedEvent> found;
  for (const Stretch& stretch : way)
    for (const RecordedEvent& event : all)
      if (event.branch == stretch.branch && event.step <= stretch.last_step) found.push_back(event);
  std::int32_t starts = -1;
  for (const RecordedEvent& event : found)
    if (event.step == 0) starts = event.branch;
  std::erase_if(found, [&](const RecordedEvent& event) { return event.step == 0 && event.branch != starts; });
  return found;
}

void Observer::add_events(const Run& run, Observation& out) {
  const std::vector<Event>& events = run.events();
  // a branch of the start has a start of its own
  if (!begun_ && branch_ != 0 && run.step() > 0) events_seen_ = events.size();
  begun_ = true;
  for (; events_seen_ < events.size(); ++events_seen_) {
    const Event& event = events[events_seen_];
    out.events.push_back({.branch = branch_, .step = event.step, .time = event.time, .event = event});
  }
}

Observation Observer::observe(const Run& run) {
  const double time = run.time(), rate = run.setup().run.output_rate;
  const bool load_steps = is_static(run);
  Observation out;
  const bool first = !begun_;
  add_events(run, out);
  if (const double reached = intervals(time, k_checkpoint_rate); reached >= next_checkpoint_) {
    next_checkpoint_ = reached + 1;
    add_checkpoint(run, out);
  }
  if (first) next_frame_ = intervals(time, rate) + 1;
  if (first || load_steps) add_frame(frame_row(run), out);
  if (load_steps) return out;
  for (const double reached = intervals(time, rate); next_frame_ <= reached; ++next_frame_)
    add_frame(frame_row_due(run, next_frame_ / rate), out);
  return out;
}

Observation Observer::last(const Run& run) {
  const std::int64_t step = run.step();
  Observation out;
  add_events(run, out);
  if (last_checkpoint_ != step) add_checkpoint(run, out);
  if (last_frame_ != step) add_frame(frame_row(run), out);
  return out;
}

}  // namespace topple::io
