#include "solver/study/validate/toss_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "solver/body/body_pose.h"
#include "solver/io/scene/scene.h"
#include "solver/run/run.h"

namespace topple::study {
namespace {

constexpr double k_rest_place = 0.002, k_rest_angle = 2 * k_pi / 180;  // m, rad
constexpr double k_width = 0.002;                                      // m, contact
constexpr double k_far = 0.02;                                         // m, least travel that a share is of

std::string scene_text(const Toss& toss, const CubeContact& contact, double offset) {
  const Vec3& at = toss.rows.front().place;
  const double size = 2 * TossedCube::half_edge - k_width, inertia = TossedCube::inertia;
  return fmt::format(
      "topple = 1\n[run]\nduration = {:.6f}\nwant = [\"motion\"]\nsettle = false\ntime_step = \"auto\"\n"
      "[contact]\nfriction = {:.6f}\nrestitution = {:.6f}\n[floor]\ntype = \"plane\"\n"
      "[[block]]\nname = \"cube\"\nmodel = \"rigid\"\nsize = [{},{},{}]\nwidth = {}\nmass = {}\n"
      "inertia = [{},{},{}]\nat = [{:.9f},{:.9f},{:.9f}]\n",
      toss.rows.back().time + 1e-3, contact.friction, contact.restitution, size, size, size, k_width,
      TossedCube::mass, inertia, inertia, inertia, at.x(), at.y(), at.z() - offset - TossedCube::half_edge);
}

double angle_between(const Quat& a, const Quat& b) {
  return a.angularDistance(b);
}

double horizontal(const Vec3& v) {
  return v.head<2>().norm();
}

}  // namespace

std::vector<CubePose> computed_toss(const Toss& toss, const CubeContact& contact, double offset,
                                    const std::function<bool()>& give_up) {
  Setup setup = io::parse_scene(scene_text(toss, contact, offset), "cube").setup;
  BodyStart& start = setup.starts.front();
  const Eigen::AngleAxisd turn(toss.rows.front().rotation);
  start.pivot = setup.model.bodies.front().centre_of_gravity;
  start.rotation = turn.angle() * turn.axis();
  start.velocity = toss.velocity;
  start.angular_velocity = toss.angular_velocity;
  Run run(setup);
  std::vector<CubePose> rows{toss.rows.front()};
  const auto keep = [&](double time, const State& state) {
    const BodyPose pose = body_pose(setup.model, state, 0);
    rows.push_back({time, pose.centre + Vec3(0, 0, offset), pose.rotation});
  };
  while (rows.size() < toss.rows.size() && run.status().ok() && !run.over()) {
    if (give_up() || !run.advance().ok()) return {};
    while (rows.size() < toss.rows.size() && toss.rows[rows.size()].time <= run.time()) {
      const double time = toss.rows[rows.size()].time;
      keep(time, run.snapshot(time).state);
    }
  }
  return rows.size() == toss.rows.size() ? rows : std::vector<CubePose>{};
}

int face_up(const Quat& rotation) {
  const Vec3 up = rotation.conjugate() * Vec3::UnitZ();
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (up[axis] < 0);
}

double time_to_rest(const std::vector<CubePose>& rows) {
  const CubePose& last = rows.back();
  std::size_t n = rows.size();
  while (n > 0 && (rows[n - 1].place - last.place).norm() <= k_rest_place &&
         angle_between(rows[n - 1].rotation, last.rotation) <= k_rest_angle)
    --n;
  return n < rows.size() ? rows[n].time : last.time;
}

TossErrors errors_of(const Toss& toss, const std::vector<CubePose>& computed) {
  const std::vector<CubePose>& measured = toss.rows;
  TossErrors out;
  const Vec3 travel = measured.back().place - measured.front().place;
  out.place = horizontal(computed.back().place - measured.back().place);
  out.place_share = out.place / std::max(horizontal(travel), k_far);
  out.face = face_up(computed.back().rotation) == face_up(measured.back().rotation);
  const Quat turn = computed.back().rotation * measured.back().rotation.conjugate();
  out.yaw = std::abs(2 * std::atan2(turn.z(), turn.w()));
  if (out.yaw > k_pi) out.yaw = 2 * k_pi - out.yaw;
  out.rest = std::abs(time_to_rest(computed) - time_to_rest(measured));
  std::size_t next = 0;
  for (std::size_t n = 0; n < measured.size(); ++n) {
    const double place = (computed[n].place - measured[n].place).norm(),
                 angle = angle_between(computed[n].rotation, measured[n].rotation);
    out.position += place / static_cast<double>(measured.size());
    out.angle += angle / static_cast<double>(measured.size());
    if (next < k_instants.size() && measured[n].time >= k_instants[next]) {
      out.position_at.push_back(place), out.angle_at.push_back(angle);
      ++next;
    }
  }
  const CubePose &last = measured.back(), &end = computed.back();
  out.position_at.resize(k_instants.size(), (end.place - last.place).norm());
  out.angle_at.resize(k_instants.size(), angle_between(end.rotation, last.rotation));
  return out;
}

}  // namespace topple::study
