#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "bench/engines/block.h"
#include "bench/engines/mujoco_model.h"

namespace topple::bench {
namespace {

struct Options {
  const char* integrator;
  bool elliptic;
  double time_constant, damping;  ///< solref; s, 1: critical
  const char* impedance;          ///< the first two of solimp
};

std::string description(double h, const Options& options) {
  return fmt::format(
      R"(<mujoco><option timestep="{}" integrator="{}" cone="{}" impratio="{}" solver="Newton"/>
<default><geom friction="{} 0 0" condim="3" solref="{} {}" solimp="{} 0.001"/></default>
<worldbody><geom type="plane" size="10 10 1"/><body><freejoint/>
<geom type="box" mass="{}" size="{} {} {}"/></body></worldbody></mujoco>)",
      h, options.integrator, options.elliptic ? "elliptic" : "pyramidal", options.elliptic ? 10 : 1,
      k_friction, options.time_constant, options.damping, options.impedance, k_mass, k_size[0] / 2,
      k_size[1] / 2, k_size[2] / 2);
}

class World {
 public:
  World(const Case& c, double h, const Options& options)
      : model_(mujoco_model(description(h, options))), data_(mj_makeData(model_.get())) {
    const mjtNum start[] = {c.middle_x(), 0, c.middle_z(), std::cos(c.tilt / 2), 0, std::sin(c.tilt / 2), 0};
    std::copy(std::begin(start), std::end(start), data_->qpos);
    model_->opt.gravity[2] = -k_gravity;
  }
  bool step(double floor) {
    model_->opt.gravity[0] = -floor;
    mj_step(model_.get(), data_.get());
    return !mujoco_gave_up(*data_);
  }
  double tilt() const {
    const mjtNum* q = data_->qpos + 3;
    return std::atan2(2 * (q[1] * q[3] + q[0] * q[2]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
  }

 private:
  MujocoModel model_;
  MujocoData data_;
};

}  // namespace

Engine mujoco_engine() {
  silence_mujoco();
  Engine engine{"MuJoCo", mj_versionString(), "Newton solver, box on a plane", {}};
  // implicit differs from Euler in the derivatives of velocity-dependent forces: here only by its cost
  for (const char* integrator : {"Euler", "RK4"})
    for (const bool elliptic : {true, false})
      for (const double constant : {0., 0.002, 0.02})
        for (const double damping : {1., 2.})
          for (const char* impedance : {"0.9 0.95", "0.99 0.9999"})
            for (const double h : k_steps) {
              if (constant > 0 && constant < 2 * h) continue;  // MuJoCo would raise it to 2 h
              const Options options{integrator, elliptic, constant > 0 ? constant : 2 * h, damping,
                                    impedance};
              engine.grid.push_back(
                  {h,
                   fmt::format(
                       "{}, {}, solref {} {:g}, solimp {}", integrator, elliptic ? "elliptic" : "pyramidal",
                       constant > 0 ? fmt::format("{:g} ms", 1e3 * constant) : "2 h", damping, impedance),
                   [=](const Case& c) {
                     auto world = std::make_shared<World>(c, h, options);
                     return stepped(
                         c, h, [world](double floor) { return world->step(floor); },
                         [world] { return world->tilt(); });
                   }});
            }
  return engine;
}

}  // namespace topple::bench
