#include "solver/body/model_level.h"

#include <algorithm>

#include "solver/body/body_pose.h"
#include "solver/math/ranges.h"
#include "solver/math/rotation.h"
#include "solver/reduced/elastic_basis.h"
#include "solver/reduced/tipping.h"

namespace topple {
namespace {

// Of supports and loads: such a body is a frame.
bool bears_on_nodes(const Model& model, int body) {
  const auto its = [&](const auto& at) { return model.node_body[at.node] == body; };
  return std::any_of(model.supports.begin(), model.supports.end(), its) ||
         std::any_of(model.loads.begin(), model.loads.end(), its);
}

template <ModelLevel level>
LevelChoice asked(const Model&, const Parameters&, int) {
  return {level, LevelReason::asked};
}

LevelChoice least_that_answers(const Model& model, const Parameters& parameters, int body) {
  if (model.bodies[body].solid) return {ModelLevel::rigid, LevelReason::solid};
  if (parameters.want_stress) return {ModelLevel::elastic, LevelReason::stress};
  if (rigid_error(model, parameters, body) > parameters.accuracy)
    return {ModelLevel::elastic, LevelReason::bending};
  return {ModelLevel::rigid, LevelReason::motion};
}

constexpr BodyModelTraits k_models[] = {
    {.kind = BodyModel::automatic,
     .word = "auto",
     .bends = true,
     .takes_supports = false,
     .may_be_frame = true,
     .of_solid = true,
     .lists_start = true,
     .choose = least_that_answers},
    {.kind = BodyModel::planar,
     .word = "planar",
     .bends = false,
     .takes_supports = false,
     .may_be_frame = false,
     .of_solid = true,
     .by_edit = false,
     .lists_start = true,
     .choose = asked<ModelLevel::planar>},
    {.kind = BodyModel::rigid,
     .word = "rigid",
     .bends = false,
     .takes_supports = false,
     .may_be_frame = false,
     .of_solid = true,
     .choose = asked<ModelLevel::rigid>},
    {.kind = BodyModel::elastic,
     .word = "elastic",
     .bends = true,
     .takes_supports = false,
     .may_be_frame = false,
     .lists_start = true,
     .choose = asked<ModelLevel::elastic>},
    {.kind = BodyModel::frame,
     .word = "frame",
     .bends = false,
     .takes_supports = true,
     .may_be_frame = true,
     .choose = asked<ModelLevel::frame>},
};

}  // namespace

const char* name(LevelReason reason) {
  switch (reason) {
    case LevelReason::asked:
      return "asked for";
    case LevelReason::motion:
      return "only motion is wanted";
    case LevelReason::stress:
      return "stresses are wanted";
    case LevelReason::blow:
      return "it strikes on contacts too stiff for an elastic body";
    case LevelReason::yield:
      return "a section is near yield";
    case LevelReason::deformation:
      return "deformations are no longer small";
    case LevelReason::near:
      return "a body computed as a frame is near";
    case LevelReason::calm:
      return "calm again";
    case LevelReason::bending:
      return "it bends too much for a rigid body";
    case LevelReason::neighbour:
      return "a wall or another body is near";
    case LevelReason::fall:
      return "another part of it meets the floor or a wall";
    case LevelReason::plane:
      return "it is moved out of its plane";
    case LevelReason::held:
      return "an anchor or a hand holds it";
    case LevelReason::contact:
      return "its contacts were edited";
    case LevelReason::jammed:
      return "it jams again and again";
    case LevelReason::solid:
      return "it is one solid piece";
  }
  return "";
}

const LevelTraits& level_called(std::string_view word) {
  return *ranges::find(k_model_levels, word, &LevelTraits::word);
}

std::span<const BodyModelTraits> body_models() {
  return k_models;
}

double elastic_error(const Body& body, const Parameters& parameters, double rotation) {
  return parameters.want_stress ? rotation / 2 : rotation * rotation / 2 / least_tipping_angle(body);
}

bool can_be(const Model& model, int body, BodyModel asked) {
  const BodyModelTraits& how = traits(asked);
  if (model.bodies[body].solid) return how.of_solid;
  if (bears_on_nodes(model, body) && !how.takes_supports) return false;
  return !how.bends || model.bodies[body].elastic;
}

LevelChoice base_level(const Model& model, const Parameters& parameters, int body) {
  BodyModel asked = parameters.models.empty() ? BodyModel::frame : parameters.models[body];
  if (model.bodies[body].solid && !can_be(model, body, asked)) asked = BodyModel::rigid;
  if (model.bodies[body].ground || !can_be(model, body, asked))
    return {ModelLevel::frame, LevelReason::asked};
  return traits(asked).choose(model, parameters, body);
}

void place_nodes(const Model& model, State& state) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyState& s = state.bodies[b];
    if (s.level == ModelLevel::frame) continue;
    const Body& body = model.bodies[b];
    const Mat3 r = s.rotation.toRotationMatrix();
    const bool bends = s.level == ModelLevel::elastic;
    Eigen::VectorXd shift, rate;
    if (bends) {
      const int modes = body.elastic->modes;
      shift = body.elastic->shape * s.amplitude.head(modes).matrix();
      rate = body.elastic->shape * s.rate.head(modes).matrix();
    }
    for (int i = 0; i < body.node_count; ++i) {
      const int g = body.first_node + i;
      Vec3 arm = model.node_position[g] - body.centre_of_gravity;
      state.rotation[g] = s.rotation;
      state.angular_velocity[g] = s.angular_velocity;
      Vec3 relative = Vec3::Zero();
      if (bends) {
        arm += shift.segment<3>(6 * i);
        relative = rate.segment<3>(6 * i);
        const Quat turn = exp_quaternion(shift.segment<3>(6 * i + 3));
        state.rotation[g] = s.rotation * turn;
        state.angular_velocity[g] = turn.conjugate() * (s.angular_velocity + rate.segment<3>(6 * i + 3));
      }
      state.position[g] = s.position + r * arm;
      state.velocity[g] = s.velocity + r * (s.angular_velocity.cross(arm) + relative);
      state.acceleration[g].setZero();
      state.angular_acceleration[g].setZero();
      state.algorithmic_acceleration[g].setZero();
      state.algorithmic_angular_acceleration[g].setZero();
    }
  }
}

BodyState reduce(const Model& model, const State& state, int index, ModelLevel level) {
  const Body& body = model.bodies[index];
  const BodyPose pose = body_pose(model, state, index);
  const BodyMomentum momentum = body_momentum(model, state, index);
  BodyState s = state.bodies[index];
  s.level = level;
  s.position = pose.centre;
  s.rotation = pose.rotation;
  s.velocity = momentum.velocity;
  s.angular_velocity = body.inertia.inverse() * (pose.rotation.conjugate() * momentum.angular_momentum);
  s.amplitude.setZero();
  s.rate.setZero();
  if (level == ModelLevel::rigid) return s;
  const ElasticBasis& basis = *body.elastic;
  Eigen::VectorXd shift(6 * body.node_count), rate(6 * body.node_count);
  for (int i = 0; i < body.node_count; ++i) {
    const int g = body.first_node + i;
    const double m = model.node_mass[g];
    const Mat3& j = model.node_inertia[g];
    const Vec3 arm = pose.rotation.conjugate() * (state.position[g] - pose.centre);
    const Quat turn = pose.rotation.conjugate() * state.rotation[g];
    shift.segment<3>(6 * i) = m * (arm - (model.node_position[g] - body.centre_of_gravity));
    shift.segment<3>(6 * i + 3) = j * log_quaternion(turn);
    rate.segment<3>(6 * i) = m * (pose.rotation.conjugate() * (state.velocity[g] - momentum.velocity) -
                                  s.angular_velocity.cross(arm));
    rate.segment<3>(6 * i + 3) = j * (turn * state.angular_velocity[g] - s.angular_velocity);
  }
  s.amplitude.head(basis.modes) = (basis.shape.transpose() * shift).array();
  s.rate.head(basis.modes) = (basis.shape.transpose() * rate).array();
  return s;
}

}  // namespace topple
