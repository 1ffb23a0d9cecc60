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
  const double half = TossedCube::half_edge - k_width / 2;
  std::string nodes, members;
  for (int corner = 0; corner < 8; ++corner) {
    nodes += fmt::format("[{:.9f},{:.9f},{:.9f}],", at.x() + (corner & 1 ? half : -half),
                         at.y() + (corner & 2 ? half : -half), at.z() - offset + (corner & 4 ? half : -half));
    members += fmt::format("{{nodes=[{},8],section=\"post\",material=\"rigid\"}},", corner);
  }
  nodes += fmt::format("[{:.9f},{:.9f},{:.9f}]", at.x(), at.y(), at.z() - offset);
  const double inertia = TossedCube::inertia;
  return fmt::format(
      "topple = 1\n[run]\nduration = {:.6f}\nwant = [\"motion\"]\nsettle = false\ntime_step = \"auto\"\n"
      "[contact]\nfriction = {:.6f}\nrestitution = {:.6f}\n[floor]\ntype = \"plane\"\n"
      "[[material]]\nname = \"rigid\"\nyoung = 1e13\npoisson = 0.3\ndensity = 0.001\n"
      "[[section]]\nname = \"post\"\nshape = \"custom\"\narea = 0.0001\niy = 0.01\niz = 0.01\nj = 0.01\nky = "
      "1\n"
      "kz = 1\nwidth = {}\n[[frame]]\nname = \"cube\"\nmodel = \"rigid\"\nnodes = [{}]\nmembers = [{}]\n"
      "masses = [{{node=8,mass={},inertia=[{},{},{}]}}]\n",
      toss.rows.back().time + 1e-3, contact.friction, contact.restitution, k_width, nodes, members,
      TossedCube::mass, inertia, inertia, inertia);
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
