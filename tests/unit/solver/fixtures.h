// Small models and measurements that the tests of the solver share.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "solver/element/beam.h"
#include "solver/frame/body_system.h"
#include "solver/math/rotation.h"
#include "solver/model/body_builder.h"
#include "solver/model/cabinet.h"
#include "solver/model/model.h"
#include "solver/model/parameters.h"
#include "solver/run/run.h"
#include "solver/state/state.h"
#include "solver/step/step.h"

namespace topple::test {

inline constexpr double k_g = k_standard_gravity;
inline constexpr double k_degrees = 180 / k_pi;

/// Contacts that take no energy.
inline ContactLaw elastic_law() {
  ContactLaw law;
  law.restitution = 1;
  law.friction = 0;
  return law;
}

inline Vec3 random_vector(std::mt19937& rng, double size = 1) {
  std::uniform_real_distribution<double> u(-size, size);
  const double x = u(rng), y = u(rng), z = u(rng);
  return {x, y, z};
}

inline Vec3 random_direction(std::mt19937& rng) {
  std::normal_distribution<double> n;
  const double x = n(rng), y = n(rng), z = n(rng);
  return Vec3(x, y, z).normalized();
}

inline Quat random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> n;
  const double w = n(rng), x = n(rng), y = n(rng), z = n(rng);
  return Quat(w, x, y, z).normalized();
}

inline Material steel() {
  Material m;
  m.name = "steel";
  m.young = 205e9;
  m.poisson = 0.3;
  m.density = 7850;
  return m;
}

/// Steel and a 30 x 30 x 1 mm post, both number 0; no planes.
inline Model steel_model() {
  Model model;
  model.materials.push_back(steel());
  Section post;
  post.name = "post";
  post.size_y = post.size_z = 0.03;
  post.thickness = 0.001;
  complete_section(post, model.materials[0].poisson);
  model.sections.push_back(post);
  return model;
}

inline Plane ground(double width = 0.09) {
  return {"floor", Vec3::Zero(), Vec3::UnitZ(), width};
}

/// A cabinet of the proportions of the paper's, of assumed steel.
inline CabinetSpec tall_cabinet() {
  CabinetSpec spec;
  spec.base = CabinetSpec::Base::edges;
  spec.name = "cabinet";
  spec.cg_height = 1.05;
  return spec;
}

/// A rigid uniform block, 0.38 x 0.88 x 1.79 m, 40 kg, on the four corners of its base, which weigh nothing.
inline Setup rocking_block(double tilt, double alpha, double h) {
  Setup setup;
  Material rigid = steel();
  rigid.young = 1e13;
  rigid.density = 1e-3;
  setup.model.materials.push_back(rigid);
  Section thick;
  thick.shape = Section::Shape::custom;
  thick.area = 0.1;
  thick.iy = thick.iz = thick.j = 0.01;
  thick.ky = thick.kz = 1;
  thick.size_y = thick.size_z = thick.width = 0.03;
  setup.model.sections.push_back(thick);
  FrameSpec spec;
  spec.name = "block";
  const Vec3 half(0.19, 0.44, 0.895), centre(0, 0, 0.015 + half.z());
  for (const double x : {-1, 1})
    for (const double y : {-1, 1}) spec.nodes.emplace_back(centre + half.cwiseProduct(Vec3(x, y, -1)));
  spec.nodes.push_back(centre);
  for (int corner = 0; corner < 4; ++corner) spec.members.push_back({{corner, 4}, 0, 0});
  const double mass = 40;
  const Vec3 square = half.cwiseAbs2();
  spec.masses.push_back({4, mass, mass / 3 * (Vec3::Constant(square.sum()) - square)});
  spec.tilt = tilt;
  setup.starts = add_frame(setup.model, spec);
  setup.model.planes.push_back(ground(0));
  setup.run.settle = tilt == 0;
  setup.parameters.contact.alpha = alpha;
  setup.parameters.contact.normal_speed = 1e-3;
  setup.parameters.time_step = h;
  return setup;
}

/// A cabinet on the floor; one that is tilted starts as it is, any other at rest.
inline Setup shaken(double duration, double tilt = 0) {
  Setup setup;
  setup.model = steel_model();
  CabinetSpec spec = tall_cabinet();
  spec.tilt = tilt;
  setup.starts.push_back(add_cabinet(setup.model, spec));
  setup.model.planes.push_back(ground());
  setup.run.duration = duration;
  setup.run.settle = tilt == 0;
  return setup;
}

inline void shake(Setup& setup, double amplitude, double frequency) {
  Shake s;
  s.amplitude = amplitude;
  s.frequency = frequency;
  setup.parameters.shakes.push_back(s);
}

/// An edit of a number.
inline Edit set(Edit::Key key, double value, int index = 0) {
  return {.key = key, .index = index, .value = Vec3(value, 0, 0)};
}

inline Edit turn_to(const Vec3& direction) {
  return {.key = Edit::Key::direction, .value = direction};
}

inline BeamGradient beam_gradient(const Element& element, const ElementState& state, const BeamEnds& ends) {
  BeamGradient gradient;
  Mat12 tangent;
  beam_tangent(element, state, ends, gradient, tangent);
  return gradient;
}

inline constexpr unsigned k_clamped = 0x3f;

/// A section given by its numbers; contact width 30 mm.
inline Section plain_section(double area, double iy, double iz, double j, double ky, double kz) {
  Section s;
  s.name = "plain";
  s.shape = Section::Shape::custom;
  s.size_y = s.size_z = s.width = 0.03;
  s.area = area;
  s.iy = iy;
  s.iz = iz;
  s.j = j;
  s.ky = ky;
  s.kz = kz;
  return s;
}

/// A clamped chain of equal members along `direction`, two elements each, with a load on the tip (user's node
/// `members`) that grows with time from 0 at 0 s to 1 at 1 s.
inline Model cantilever(const Section& section, const Material& material, double length, int members,
                        const Vec3& force, const Vec3& moment, const Vec3& direction = Vec3::UnitX()) {
  Model model;
  model.materials.push_back(material);
  model.sections.push_back(section);
  FrameSpec spec;
  spec.name = "cantilever";
  for (int i = 0; i <= members; ++i) spec.nodes.push_back(direction * (length * i / members));
  for (int i = 0; i < members; ++i) spec.members.push_back({{i, i + 1}, 0, 0});
  spec.supports.push_back({0, k_clamped});
  spec.loads.push_back({members, force, moment, {{0, 0}, {1, 1}}});
  add_frame(model, spec);
  return model;
}

inline BodyMotion reference_motion(const Model& model) {
  BodyMotion motion;
  motion.position = model.node_position;
  motion.velocity.assign(model.node_total(), Vec3::Zero());
  motion.rotation.assign(model.node_total(), Quat::Identity());
  motion.angular_velocity.assign(model.node_total(), Vec3::Zero());
  return motion;
}

inline Parameters weightless() {
  Parameters p;
  p.gravity.setZero();
  return p;
}

/// One Newton correction of the static balance at time t: six numbers per node.
inline std::vector<double> static_correction(BodySystem& system, const Parameters& parameters, double t,
                                             const BodyMotion& motion) {
  const std::vector<Vec3> stick(system.model.contact_points.size() * system.model.planes.size(),
                                Vec3::Zero());
  system.lu.set_zero();
  system.evaluate_with_tangent(parameters, {parameters, t}, motion, stick, motion.position, 0);
  std::vector<double> b(6 * system.count);
  for (int i = 0; i < system.count; ++i)
    for (int k = 0; k < 6; ++k) {
      const bool fixed = system.fixed[i] >> k & 1;
      b[6 * i + k] = fixed ? 0 : k < 3 ? system.force[i][k] : system.moment[i][k - 3];
      if (fixed) system.lu.fix(i, k);
    }
  EXPECT_EQ(system.lu.factor(), -1);
  system.lu.solve(b.data());
  return b;
}

/// Newton at time t from `motion`. The number of iterations, or -1 when 30 do not suffice.
inline int solve_statics(BodySystem& system, const Parameters& parameters, double t, BodyMotion& motion) {
  double last = 1e300;
  for (int iteration = 1; iteration <= 30; ++iteration) {
    const std::vector<double> b = static_correction(system, parameters, t, motion);
    double size = 0;
    for (int i = 0; i < system.count; ++i) {
      const Vec3 shift(&b[6 * i]), spin(&b[6 * i + 3]);
      motion.position[i] += shift;
      motion.rotation[i] = (exp_quaternion(spin) * motion.rotation[i]).normalized();
      size = std::max({size, shift.norm() / system.size, spin.norm()});
    }
    if (!std::isfinite(size)) return -1;
    // quadratic until rounding stops it: below 1e-8 the next correction is noise
    if (last < 1e-8) return iteration;
    last = size;
  }
  return -1;
}

/// Advances a model and keeps all that belongs together.
class Simulation {
 public:
  Simulation(Model model_in, std::vector<BodyStart> starts, Parameters parameters_in, bool settled = false)
      : model(std::move(model_in)),
        parameters(std::move(parameters_in)),
        state(start_state(model, starts)),
        workspace_(model) {
    if (settled) {
      const StepStatus status = settle(model, parameters, state, workspace_);
      EXPECT_TRUE(status.ok()) << status.message(model);
    }
    prepare(model, parameters, state, workspace_);
  }

  StepStatus advance() { return step(model, parameters, state, workspace_); }
  /// False, and a failure of the test, when a step fails.
  bool advance(int steps) {
    for (int i = 0; i < steps; ++i) {
      const StepStatus status = advance();
      if (!status.ok()) {
        ADD_FAILURE() << status.message(model);
        return false;
      }
    }
    return true;
  }
  const std::vector<ContactForce>& contacts() { return contact_forces(model, parameters, state, workspace_); }
  Workspace& workspace() { return workspace_; }

  const Model model;
  Parameters parameters;
  State state;

 private:
  Workspace workspace_;
};

/// A light body whose three nodes lie on one line and weigh the same: it meets a floor flat, without rocking,
/// as one mass on three equal contacts. `bottom`: height of the nodes.
inline Model sled(double mass, double width, double bottom) {
  Model model = steel_model();
  BodyBuilder builder(model, "sled");
  const std::vector<int> nodes =
      builder.line("bar", {-0.1, 0, bottom}, {0.1, 0, bottom}, 1, 2, 0, 0, Vec3::UnitZ());
  for (int node : nodes) {
    model.node_mass[node] = mass / 3;
    model.node_inertia[node] = mass * 1e-3 * Mat3::Identity();
    builder.add_contact_point(node, width);
  }
  builder.close();
  model.planes.push_back(ground(width));
  return model;
}

// One element, clamped at its first node, whose second moves along it only: exactly linear, w^2 = EA/(L m).
inline constexpr double k_oscillation = 50;  // rad/s

inline Model oscillator() {
  Model model;
  Material unit = steel();
  unit.young = 1e6;
  model.materials.push_back(unit);
  model.sections.push_back(plain_section(1e-2, 1e-6, 1e-6, 1e-6, 1, 1));
  BodyBuilder builder(model, "oscillator");
  builder.line("spring", Vec3::Zero(), Vec3::UnitX(), 1, 1, 0, 0, Vec3::UnitZ());
  const double mass = 1e4 / (k_oscillation * k_oscillation);
  model.node_mass = {mass, mass};
  model.node_inertia = {Mat3::Identity(), Mat3::Identity()};
  builder.close();
  model.supports = {{0, k_clamped}, {1, 0x3e}};
  return model;
}

inline Vec3 linear_momentum(const Model& model, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < model.node_total(); ++i) sum += model.node_mass[i] * state.velocity[i];
  return sum;
}

/// About the origin.
inline Vec3 angular_momentum(const Model& model, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < model.node_total(); ++i)
    sum += model.node_mass[i] * state.position[i].cross(state.velocity[i]) +
           state.rotation[i] * (model.node_inertia[i] * state.angular_velocity[i]);
  return sum;
}

inline double kinetic_energy(const Model& model, const State& state) {
  double sum = 0;
  for (int i = 0; i < model.node_total(); ++i)
    sum += 0.5 * model.node_mass[i] * state.velocity[i].squaredNorm() +
           0.5 * state.angular_velocity[i].dot(model.node_inertia[i] * state.angular_velocity[i]);
  return sum;
}

inline Vec3 centre_of_mass(const Model& model, const State& state) {
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (int i = 0; i < model.node_total(); ++i) {
    sum += model.node_mass[i] * state.position[i];
    mass += model.node_mass[i];
  }
  return sum / mass;
}

}  // namespace topple::test
