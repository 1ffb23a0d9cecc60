#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "bench/engines/block.h"

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
  World(const Case& c, double h, const Options& options) {
    const std::string text = description(h, options);
    auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "block.xml", static_cast<int>(text.size()));
    std::memcpy(files->filedata[0], text.data(), text.size());
    char error[200] = "";
    model_ = mj_loadXML("block.xml", files.get(), error, sizeof error);
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(std::string("MuJoCo: ") + error);
    data_ = mj_makeData(model_);
    const mjtNum start[] = {c.middle_x(), 0, c.middle_z(), std::cos(c.tilt / 2), 0, std::sin(c.tilt / 2), 0};
    std::copy(std::begin(start), std::end(start), data_->qpos);
    model_->opt.gravity[2] = -k_gravity;
  }
  ~World() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  bool step(double floor) {
    model_->opt.gravity[0] = -floor;
    mj_step(model_, data_);
    for (const mjWarningStat& warning : data_->warning)
      if (warning.number > 0) return false;
    return true;
  }
  double tilt() const {
    const mjtNum* q = data_->qpos + 3;
    return std::atan2(2 * (q[1] * q[3] + q[0] * q[2]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
  }

 private:
  mjModel* model_;
  mjData* data_;
};

}  // namespace

Engine mujoco_engine() {
  mju_user_warning = [](const char*) {
  };  // else it goes to a file in the working folder; World sees those that count
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
