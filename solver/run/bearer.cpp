#include "solver/run/bearer.h"

#include <algorithm>
#include <cmath>

#include "solver/math/rotation.h"
#include "solver/run/footprint.h"

namespace topple {
namespace {

Vec2 centre_in_plan(const Model& model, std::span<const Vec3> position, const Body& body) {
  Vec3 sum = Vec3::Zero();
  for (int i = body.first_node; i < body.first_node + body.node_count; ++i)
    sum += model.node_mass[i] * position[i];
  return sum.head<2>() / body.mass;
}

}  // namespace

Heights heights(const Model& model, std::span<const Vec3> position, int index) {
  const Body& body = model.bodies[index];
  Heights found;
  for (int e = body.first_element; e < body.first_element + body.element_count; ++e) {
    const double half = model.sections[model.members[model.elements[e].member].section].width / 2;
    for (const int node : model.elements[e].node) {
      found.low = std::min(found.low, position[node].z() - half);
      found.high = std::max(found.high, position[node].z() + half);
    }
  }
  return found;
}

Below below(const Model& model, std::span<const Vec3> position, int index, bool floor) {
  constexpr double k_any_height = std::numeric_limits<double>::max();
  const double bottom = heights(model, position, index).low;
  const auto print = footprint(model, position, index, k_any_height);
  Below found;
  if (floor) found.top = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Heights of = heights(model, position, b);
    if (b == index || of.low > bottom || of.high < found.top - k_hangs) continue;
    const auto other = footprint(model, position, b, k_any_height);
    if (nearest_points(print->core, other->core).distance > print->radius + other->radius) continue;
    const bool one_of_two = of.high < found.top + k_hangs;
    found = {b, std::max(of.high, found.top),
             one_of_two ? 0 : other->distance(centre_in_plan(model, position, model.bodies[index]))};
  }
  return found;
}

int bearer_of(const Model& model, std::span<const Vec3> position, int index) {
  const double bottom = heights(model, position, index).low;
  if (bottom < k_top_of) return -1;
  const Below under = below(model, position, index, true);
  const bool bears =
      under.body >= 0 && !model.bodies[under.body].ground && std::abs(bottom - under.top) < k_top_of;
  return bears ? under.body : -1;
}

namespace {

// As seen along the axis of the body, where that leans.
int bearer_in(const Model& model, const State& state, const BodyPose& pose, int index) {
  const int bearer = bearer_of(model, state.position, index);
  const double lean = tilt(pose);
  if (bearer >= 0 || lean == 0 || lean > k_pi / 4 ||
      heights(model, state.position, index).low < k_top_of)  // it leans on the floor
    return bearer;
  std::vector<Vec3> turned = state.position;
  const double lift = pose.centre.norm() + model.bodies[index].reach + 2 * k_top_of;  // off the floor
  for (Vec3& x : turned) x = pose.rotation.conjugate() * x + lift * Vec3::UnitZ();
  return bearer_of(model, turned, index);
}

}  // namespace

std::vector<Bearer> bearers_of(const Model& model, const std::vector<BodyStart>& starts) {
  const State state = start_state(model, starts);
  std::vector<BodyPose> poses;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Quat turn = exp_quaternion(starts[b].rotation);
    poses.push_back({starts[b].pivot + turn * (model.bodies[b].centre_of_gravity - starts[b].pivot), turn});
  }
  std::vector<Bearer> bearers;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const int under = bearer_in(model, state, poses[b], b);
    bearers.push_back(
        {under, under < 0 ? model.bodies[b].base_centre : place_on(model, b, poses[b], under, poses[under])});
  }
  return bearers;
}

BodyPose bearer_pose(std::span<const BodyPose> poses, int bearer) {
  return bearer < 0 ? BodyPose{Vec3::Zero(), Quat::Identity()} : poses[bearer];
}

Vec3 place_on(const Model& model, int index, const BodyPose& pose, int bearer, const BodyPose& on) {
  const Body& body = model.bodies[index];
  const Vec3 now = pose.centre + pose.rotation * (body.base_centre - body.centre_of_gravity);
  return bearer < 0 ? now
                    : on.rotation.conjugate() * (now - on.centre) + model.bodies[bearer].centre_of_gravity;
}

}  // namespace topple
