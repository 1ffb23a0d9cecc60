#include <fmt/format.h>

#include <algorithm>

#include "bench/engines/block.h"
#include "bench/engines/mujoco_model.h"
#include "bench/engines/tosses.h"

namespace topple::bench {
namespace {

struct Options {
  double h, friction, time_constant, damping;  ///< solref; s, 1: critical
};

std::string description(const Options& options, double offset) {
  using Cube = study::TossedCube;
  return fmt::format(
      R"(<mujoco><option timestep="{}" cone="elliptic" impratio="10" solver="Newton" gravity="0 0 -9.80665"/>
<default><geom friction="{} 0 0" condim="3" solref="{} {}" solimp="0.9 0.95 0.001"/></default>
<worldbody><geom type="plane" size="10 10 1" pos="0 0 {}"/><body><freejoint/>
<inertial pos="0 0 0" mass="{}" diaginertia="{} {} {}"/>
<geom type="box" size="{} {} {}"/></body></worldbody></mujoco>)",
      options.h, options.friction, options.time_constant, options.damping, offset, Cube::mass, Cube::inertia,
      Cube::inertia, Cube::inertia, Cube::half_edge, Cube::half_edge, Cube::half_edge);
}

std::vector<study::CubePose> run(const study::Toss& toss, const mjModel& model, double h) {
  const MujocoData data(mj_makeData(&model));
  const study::CubePose& first = toss.rows.front();
  const Quat& q = first.rotation;
  const Vec3 spin = q.conjugate() * toss.angular_velocity;  // of a free joint in the body's axes
  const mjtNum place[] = {first.place.x(), first.place.y(), first.place.z(), q.w(), q.x(), q.y(), q.z()};
  const mjtNum speed[] = {toss.velocity.x(), toss.velocity.y(), toss.velocity.z(),
                          spin.x(),          spin.y(),          spin.z()};
  std::copy(std::begin(place), std::end(place), data->qpos);
  std::copy(std::begin(speed), std::end(speed), data->qvel);
  std::vector<study::CubePose> rows = stepped_toss(toss, h, [&] {
    mj_step(&model, data.get());
    const mjtNum* at = data->qpos;
    return study::CubePose{0, {at[0], at[1], at[2]}, Quat(at[3], at[4], at[5], at[6])};
  });
  return mujoco_gave_up(*data) ? std::vector<study::CubePose>{} : rows;
}

}  // namespace

std::vector<TossSetting> mujoco_toss_settings() {
  silence_mujoco();
  std::vector<TossSetting> all;
  for (const double h : k_toss_steps)
    for (const double constant : {0., 0.01, 0.02})
      for (const double damping : {0.3, 0.6, 1.})
        for (const double friction : k_toss_frictions) {
          const Options options{h, friction, constant > 0 ? constant : 2 * h, damping};
          all.push_back({"MuJoCo",
                         fmt::format("{:g} ms, friction {:g}, solref {:g} ms {:g}", 1e3 * h, friction,
                                     1e3 * options.time_constant, damping),
                         [options, model = std::shared_ptr<const mjModel>()](const study::Toss& toss,
                                                                             double offset) mutable {
                           if (!model) model = mujoco_model(description(options, offset));
                           return run(toss, *model, options.h);
                         }});
        }
  return all;
}

}  // namespace topple::bench
