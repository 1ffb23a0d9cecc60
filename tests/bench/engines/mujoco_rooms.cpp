#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/engines/mujoco_model.h"
#include "bench/engines/rooms.h"
#include "solver/math/rotation.h"
#include "solver/model/excitation.h"

namespace topple::bench {
namespace {

constexpr double k_rest = 1;  // s, to come to rest before t = 0 where the scene settles

struct Options {
  bool elliptic;
  double softness;  ///< s, root of mass over stiffness of a contact
  double damping;   ///< over the critical one
};

/// The box of centre lines about which a body of topple rocks; its faces are `radius` outside of it.
struct Box {
  Vec3 middle, half;  ///< m, reference pose
  double radius;      ///< m
};

Box box_of(const Model& model, const Body& body) {
  Eigen::AlignedBox3d lines;
  for (int n = 0; n < body.node_count; ++n) lines.extend(model.node_position[body.first_node + n]);
  return {lines.center(), lines.sizes() / 2, model.contact_points[body.first_contact_point].width / 2};
}

/// Of solref: a linear spring with this damping returns impacts with the restitution.
double damping_ratio(double restitution) {
  if (restitution <= 0) return 1;
  const double decay = -std::log(restitution);
  return decay / std::hypot(decay, std::numbers::pi);
}

/// Centre lines meet the floor, which is raised by their radius; faces meet each other.
std::string body_text(const Body& body, const Box& box) {
  const Vec3 arm = body.centre_of_gravity - box.middle, face = box.half.array() + box.radius;
  const Mat3& I = body.inertia;
  return fmt::format(
      R"(<body><freejoint/><inertial pos="{} {} {}" mass="{}" fullinertia="{} {} {} {} {} {}"/>
<geom class="base" size="{} {} {}"/><geom class="face" size="{} {} {}"/></body>
)",
      arm.x(), arm.y(), arm.z(), body.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2),
      box.half.x(), box.half.y(), box.half.z(), face.x(), face.y(), face.z());
}

/// solref is a time over the damping ratio, and that ratio: whatever bounces, the stiffness is the same.
std::string room_text(const Setup& setup, double h, const Options& options) {
  const Model& model = setup.model;
  std::string bodies;
  for (int b = 0; b < model.furniture_total(); ++b)
    bodies += body_text(model.bodies[b], box_of(model, model.bodies[b]));
  return fmt::format(
      R"(<mujoco><option timestep="{}" cone="{}" impratio="{}" solver="Newton"/>
<size nconmax="1000" njmax="5000"/>
<default><geom type="box" condim="3" friction="{} 0 0" solref="{} {}"/>
<default class="base"><geom contype="1" conaffinity="0"/></default>
<default class="face"><geom contype="2" conaffinity="2"/></default></default>
<worldbody><geom type="plane" size="100 100 1" pos="0 0 {}" contype="0" conaffinity="1"/>
{}</worldbody></mujoco>)",
      h, options.elliptic ? "elliptic" : "pyramidal", options.elliptic ? 10 : 1,
      setup.parameters.contact.friction, options.softness / options.damping, options.damping,
      box_of(model, model.bodies[0]).radius, bodies);
}

class MujocoRoom : public RoomSimulation {
 public:
  MujocoRoom(const Setup& setup, double h, const Options& options)
      : setup_(setup),
        h_(h),
        model_(mujoco_model(room_text(setup, h, options))),
        data_(mj_makeData(model_.get())) {
    for (int b = 0; b < setup.model.furniture_total(); ++b) place(b);
    const long settling = setup.run.settle ? std::lround(k_rest / h) : 0;
    for (long k = 0; k < settling && going_; ++k) step(Vec3::Zero());
  }

  bool advance() override {
    if (going_) step(floor_acceleration(setup_.parameters.shakes, (static_cast<double>(steps_) + 0.5) * h_));
    ++steps_;
    return going_;
  }
  double time() const override { return static_cast<double>(steps_) * h_; }
  long steps() const override { return steps_; }
  double tilt(int body) const override {
    const mjtNum* q = data_->qpos + 7 * body + 3;
    return std::acos(std::clamp(1 - 2 * (q[1] * q[1] + q[2] * q[2]), -1., 1.));
  }
  std::string failure() const override {
    for (int kind = 0; kind < mjNWARNING; ++kind)
      if (const mjWarningStat& warning = data_->warning[kind]; warning.number > 0)
        return mju_warningText(kind, warning.lastinfo);
    return "";
  }

 private:
  void place(int b) {
    const BodyStart& start = setup_.starts[b];
    const Quat turn = exp_quaternion(start.rotation);
    const Vec3 middle =
        start.pivot + turn * (box_of(setup_.model, setup_.model.bodies[b]).middle - start.pivot);
    const mjtNum q[] = {middle.x(), middle.y(), middle.z(), turn.w(), turn.x(), turn.y(), turn.z()};
    std::copy(std::begin(q), std::end(q), data_->qpos + 7 * b);
  }
  void step(const Vec3& floor) {
    const Vec3 felt = setup_.parameters.gravity - floor;
    std::copy(felt.begin(), felt.end(), model_->opt.gravity);
    mj_step(model_.get(), data_.get());
    going_ = !mujoco_gave_up(*data_);
  }

  const Setup& setup_;
  double h_;
  MujocoModel model_;
  MujocoData data_;
  long steps_ = 0;
  bool going_ = true;
};

}  // namespace

std::vector<RoomSetting> mujoco_room_settings(const Setup& setup) {
  silence_mujoco();
  std::vector<double> dampings{1};
  if (const double e = setup.parameters.contact.restitution; e > 0) dampings.push_back(damping_ratio(e));
  std::vector<RoomSetting> settings;
  for (const double damping : dampings)
    for (const bool elliptic : {true, false})
      for (const double softness : {0.02, 0.})
        for (const double h : {2e-3, 1e-3, 2.5e-4}) {
          const Options options{elliptic, softness > 0 ? softness : 2 * h, damping};
          settings.push_back(
              {"MuJoCo", mj_versionString(),
               fmt::format("{}, solref {}{}", elliptic ? "elliptic" : "pyramidal",
                           softness > 0 ? fmt::format("{:g} ms", 1e3 * softness) : "2 h",
                           damping < 1 ? ", bounces" : ""),
               h, [=](const Setup& room) { return std::make_unique<MujocoRoom>(room, h, options); }});
        }
  return settings;
}

}  // namespace topple::bench
