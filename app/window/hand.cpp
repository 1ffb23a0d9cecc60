#include "app/window/hand.h"

#include <Eigen/LU>
#include <limits>

#include "app/picture/annotations.h"
#include "app/picture/row.h"
#include "app/picture/words.h"

namespace topple::app {
namespace {

using namespace window_words;

constexpr double k_hand_damping = 0.5;  // of critical, for the body's mass on the spring
constexpr double k_same_force = 0.02;   // of the hand's strength: no edit for less

}  // namespace

std::string Hand::grab(const render::SceneFrame& frame, const render::Pick& pick) {
  const io::Scene& scene = player_.scene();
  const Model& model = scene.setup.model;
  const std::optional<io::FrameRow> row = player_.row();
  if (pick.member >= model.members.size() || model.bodies[pick.body].ground || !row) return {};
  if (is_static(scene.setup)) return say(k_no_pull_of_loads);
  if (!player_.can_edit() || !player_.playing()) return say(k_pull_while_it_runs);
  const render::Tube& tube = frame.tubes[pick.tube];
  const auto station = [&](std::uint32_t k) {
    return Eigen::Vector3f(frame.stations[tube.first_station + k].position.data());
  };
  const Eigen::Vector3f from = station(pick.station);
  const Vec3 place = (from + pick.share * (station(pick.station + 1) - from)).cast<double>();
  const Body& body = model.bodies[pick.body];
  double least = std::numeric_limits<double>::infinity();
  for (int node = body.first_node; node < body.first_node + body.node_count; ++node) {
    const Vec3 at = position(*row, node);
    const double away = (at + floor_shift(*row) - place).norm();
    if (away >= least) continue;
    least = away;
    held_ = {node, Vec3::Zero(), at, row->time, Vec3::Zero()};
  }
  return {};
}

void Hand::pull(const render::Camera& camera, float width, float height, float x, float y) {
  const std::optional<io::FrameRow> row = player_.row();
  if (!held_ || !row || !is_finite(*row)) return;
  const Vec3 at = position(*row, held_->node), shift = floor_shift(*row);
  if (row->time > held_->time) {
    held_->velocity = (at - held_->at) / (row->time - held_->time);
    held_->at = at;
    held_->time = row->time;
  }
  const Eigen::Matrix4f to_clip = camera.projection * camera.view;
  const Eigen::Vector4f node = to_clip * Vec3(at + shift).cast<float>().homogeneous();
  const Eigen::Vector4f mouse =
      to_clip.inverse() * Eigen::Vector4f(2 * x / width - 1, 1 - 2 * y / height, node.z() / node.w(), 1);
  const Vec3 way = (mouse.head<3>() / mouse.w()).cast<double>() - shift - at;
  const Model& model = player_.scene().setup.model;
  const double most = hand_strength(model, held_->node), stiffness = most / k_hand_reach;
  const double mass = model.bodies[model.node_body[held_->node]].mass;
  Vec3 force = stiffness * way - 2 * k_hand_damping * std::sqrt(stiffness * mass) * held_->velocity;
  if (force.norm() > most) force *= most / force.norm();
  if (!((force - held_->force).norm() >= k_same_force * most)) return;  // nor what is not finite
  held_->force = force;
  player_.pull({.key = Edit::Key::pull, .index = held_->node, .value = force});
}

void Hand::let_go() {
  held_.reset();
  if (!player_.can_edit()) return;
  for (const Pull& pull : std::vector<Pull>(player_.parameters().pulls))
    if (!pull.force.isZero(0))
      player_.pull({.key = Edit::Key::pull, .index = pull.node, .value = Vec3::Zero()});
}

std::string Hand::words() const {
  const Model& model = player_.scene().setup.model;
  return say(k_pulling, model.bodies[model.node_body[held_->node]].name, hand_strength(model, held_->node));
}

}  // namespace topple::app
